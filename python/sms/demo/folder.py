"""The folder of a demonstration: there whole or not at all."""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sms.errors import InputError
from sms.io.write import check_output_folder

SEAL = "truth.sha256"
MARKS = (SEAL, "cylinder_o_ring")
"""Names by which a folder is known as an earlier demonstration's."""


def check_demo_folder(out: Path) -> None:
    """InputError, before any work, where nothing can be written or somebody else's files lie."""
    check_output_folder(out)
    if out.exists() and any(out.iterdir()) and not any((out / mark).exists() for mark in MARKS):
        raise InputError(
            f"{out}: this folder holds files that are no demonstration's; choose another --out"
        )


@contextmanager
def whole_folder(out: Path) -> Iterator[Path]:
    """A new folder that takes the place of `out` once all is in it; if anything goes wrong nothing is left of it.

    It lies beside `out`, so that paths relative to it hold afterwards. What an earlier demonstration wrote is replaced,
    file by file.
    """
    check_demo_folder(out)
    out = out.absolute()
    made = [p for p in (out.parent, *out.parent.parents) if not p.exists()]
    temporary = out.with_name(f".{out.name}.{secrets.token_hex(4)}.tmp")
    try:
        temporary.mkdir(parents=True)
        yield temporary
        if not out.exists():
            temporary.rename(out)
        for file in sorted(p for p in temporary.rglob("*") if p.is_file()):
            place = out / file.relative_to(temporary)
            place.parent.mkdir(exist_ok=True)
            file.replace(place)
    except BaseException as problem:
        shutil.rmtree(temporary, ignore_errors=True)
        for parent in made:  # from the innermost
            if parent.is_dir() and not any(parent.iterdir()):
                parent.rmdir()
        if isinstance(problem, OSError):
            raise InputError(
                f"{out}: cannot be written ({problem.strerror}); choose another --out"
            ) from None
        raise
    shutil.rmtree(temporary, ignore_errors=True)
