"""Which copy of the compiled core is loaded; nowhere else is that chosen.

A wheel carries two: `_core`, which every x86-64 processor runs, and `_core_avx2`, with which a fit takes a third of the
time. `SMS_AVX2=OFF` and `SMS_AVX2=ON` force one of them, `AUTO` or nothing leaves it to the processor. A core that was
compiled where it runs is a single copy, and is what it was compiled to be.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType

CHOICES = ("AUTO", "ON", "OFF")


def second_copy() -> Path | None:
    """The one with AVX2, where this installation carries two."""
    folder = Path(__file__).parent
    files = (folder / f"_core_avx2{suffix}" for suffix in EXTENSION_SUFFIXES)
    return next((file for file in files if file.is_file()), None)


def takes_second(wanted: str, runs_avx2: bool) -> bool:
    """Whether of two copies the one with AVX2 is loaded."""
    if wanted == "ON" and not runs_avx2:
        raise ImportError(
            "SMS_AVX2=ON asks for the core with AVX2, which this processor does not run; "
            "unset SMS_AVX2, or set it to OFF"
        )
    return wanted != "OFF" and runs_avx2


def decide() -> None:
    """Decides which copy will be sms._core; imported only where the environment asks for one of them."""
    wanted = os.environ.get("SMS_AVX2", "").upper() or "AUTO"
    if wanted not in CHOICES:
        raise ImportError(
            f"SMS_AVX2 is one of {', '.join(CHOICES)}, not '{os.environ['SMS_AVX2']}'"
        )
    file = second_copy()
    if file is not None:
        from sms import _cpu  # noqa: PLC0415  # carried beside a second copy alone

        if takes_second(wanted, _cpu.runs_avx2()):
            sys.meta_path.insert(0, _SecondCopy(file))
    if wanted == "AUTO":
        return
    from sms import _core  # noqa: PLC0415  # only now is decided which

    if _core.uses_avx2() != (wanted == "ON"):
        raise ImportError(
            f"SMS_AVX2={wanted}: this installation has a single core, compiled "
            f"{'with' if _core.uses_avx2() else 'without'} AVX2; unset SMS_AVX2, "
            f"or build with -Ccmake.define.SMS_AVX2={wanted}"
        )


class _SecondCopy:
    """Finds it where sms._core is imported."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return spec_from_file_location(fullname, self.file) if fullname == "sms._core" else None


def _decide_or_say() -> None:
    """For the command `sms` a wrong SMS_AVX2 is a wrong input like any other: one sentence and exit 2."""
    try:
        decide()
    except ImportError as wrong:
        if Path(sys.argv[0]).stem == "sms" and "SMS_AVX2" in str(wrong):
            print(f"sms: {wrong}", file=sys.stderr)
            sys.exit(2)
        raise


_decide_or_say()
