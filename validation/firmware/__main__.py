"""The float archive on an emulated Cortex-M4F: instructions, size, stack, symbols, and whether the bits are the desk's.

    ./dev firmware

Then the application and the processor in the loop: validation/firmware/application.py. Exit code 1 when a goal is
missed, when a symbol is called that libsms/firmware_symbols.txt does not list, or when a kinematic result differs from
the host's in any bit; else what was printed is written to docs/firmware.md.
"""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

from validation.firmware import application

ROOT = Path(__file__).parents[2]
OUT = ROOT / "build" / "firmware"
PAGE = ROOT / "docs" / "firmware.md"
EMULATION = ROOT / "libsms" / "firmware" / "emulation"
SYMBOLS = ROOT / "libsms" / "firmware_symbols.txt"
MOST_INSTRUCTIONS = {"inverse kinematics": 3000, "forward kinematics": 6000}
MOST_CODE = 16 * 1024
"""Bytes of the kinematics: both directions and what they alone call."""
KINEMATICS = r"sms_(inverse|forward)_kinematicsf$|sms_(geometry_from_params|rest_pose)f$"
MACHINE = "qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none -icount shift=0"


@dataclass(frozen=True)
class Count:
    """One function: instructions of a call, and a hash over the bits of all its results."""

    name: str
    least: int
    mean: int
    most: int
    bits: str

    @property
    def goal(self) -> int | None:
        return next((most for name, most in MOST_INSTRUCTIONS.items() if name in self.name), None)


HEAD = """\
# The firmware on the emulated target

Printed by `./dev firmware`, which writes this page when no goal is missed: the float archive and the application, built
for a Cortex-M4F (`-mcpu=cortex-m4 -mfloat-abi=hard`) and run by QEMU, which counts instructions, not cycles. What could
not be tried without the DSP stands in [porting to a DSP](porting_to_dsp.md).

```text
"""


def run(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=1800).stdout


def counts(text: str) -> list[Count]:
    rows = (line.split(";") for line in text.splitlines())
    return [Count(n, int(least), int(mean), int(most), bits) for n, least, mean, most, bits in rows]


def called_symbols() -> set[str]:
    """What the archive calls and does not hold."""
    archive = str(OUT / "libsmsf.arm.a")
    called = set(re.findall(r" U (\S+)", run("arm-none-eabi-nm", "-u", archive)))
    held = set(re.findall(r" [TDRB] (\S+)", run("arm-none-eabi-nm", archive)))
    return called - held


def allowed_symbols() -> set[str]:
    lines = SYMBOLS.read_text(encoding="utf-8").splitlines()
    return {line.split("#")[0].strip() for line in lines} - {""}


def code_size() -> int:
    """Bytes of the kinematics in the linked program."""
    symbols = run("arm-none-eabi-nm", "-S", "--demangle", str(OUT / "count.elf"))
    rows = re.findall(r"^\S+ ([0-9a-f]+) [tTwWrR] (.+)$", symbols, re.MULTILINE)
    return sum(
        int(size, 16) for size, name in rows if re.search(KINEMATICS, name) or "sms::" in name
    )


def deepest_frame() -> tuple[int, str]:
    """The largest stack frame among the kinematic functions, bytes."""
    text = (OUT / "mechanism_float.arm.su").read_text(encoding="utf-8")
    rows = re.findall(r"^\S+?:\d+:\d+:(.+)\t(\d+)\t", text, re.MULTILINE)
    frames = [(int(size), name) for name, size in rows if re.search("kinematics|geometry", name)]
    return max(frames)


def main() -> int:
    console = Console(width=110, record=True)
    run("sh", str(EMULATION / "build.sh"), str(OUT))
    semihosting = (
        "-semihosting-config",
        "enable=on,target=native",
        "-kernel",
        str(OUT / "count.elf"),
    )
    target = counts(run(*MACHINE.split(), *semihosting))
    host = {c.name: c.bits for c in counts(run(str(OUT / "count.host")))}
    failures = []

    table = Table(title="instructions of one call, float, emulated Cortex-M4F, 2000 poses")
    for column in ("function", "least", "mean", "most", "goal", "bits against the host's"):
        table.add_column(column, justify="left" if column == "function" else "right")
    for count in target:
        same = count.bits == host[count.name]
        goal = f"<= {count.goal}" if count.goal else ""
        bits = "the same" if same else "differ: powf, expf, sinf are newlib's there, glibc's here"
        table.add_row(count.name, str(count.least), str(count.mean), str(count.most), goal, bits)
        if count.goal is not None and count.most > count.goal:
            failures.append(
                f"{count.name} takes {count.most} instructions, the goal is {count.goal}"
            )
        if "kinematics" in count.name and not same:
            failures.append(f"{count.name}: other bits than on the host")
    console.print(table)

    size, (frame, where) = code_size(), deepest_frame()
    console.print(
        f"code of the kinematics in the linked program: {size} bytes (goal < {MOST_CODE})"
    )
    console.print(f"largest stack frame: {frame} bytes, in {where.split('(')[0]}")
    console.print(f"nm -u, of the core's archive: {' '.join(sorted(called_symbols()))}")
    if size >= MOST_CODE:
        failures.append(f"the kinematics take {size} bytes, the goal is below {MOST_CODE}")
    if strangers := called_symbols() - allowed_symbols():
        failures.append(
            f"called but not in {SYMBOLS.relative_to(ROOT)}: {' '.join(sorted(strangers))}"
        )
    failures += application.check(console, allowed_symbols())
    for failure in failures:
        console.print(f"[red]{failure}[/red]")
    if not failures:
        lines = (line.rstrip() for line in console.export_text().strip("\n").splitlines())
        PAGE.write_text(HEAD + "\n".join(lines) + "\n```\n", encoding="utf-8")
        console.print(f"written: {PAGE.relative_to(ROOT)}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
