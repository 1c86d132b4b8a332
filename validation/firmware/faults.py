"""Every fault of the application, made and measured: detected within how many ms, reaction, way back.

    python -m validation.firmware.faults [--write]

Runs build/package/libsms/firmware/tests/sms_fault_table, the application on a bench. Exit code 1 when a fault is not as
docs/faults.md states it. --write puts the table into that page.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "package" / "libsms" / "firmware" / "tests" / "sms_fault_table"
PAGE = ROOT / "docs" / "faults.md"
BEGIN, END = "<!-- begin: python -m validation.firmware.faults -->\n", "<!-- end -->\n"


@dataclass(frozen=True)
class Row:
    """One fault: what it is, detected within so many ms at most, and when it was."""

    name: str
    cause: str
    most: int
    measured: int
    reaction: str
    way_back: str
    as_stated: bool


def rows() -> list[Row]:
    """The faults, each made once; raises FileNotFoundError when the program is not built."""
    text = subprocess.run(
        [str(PROGRAM)], capture_output=True, text=True, check=False, timeout=300
    ).stdout
    cells = (line.split("|") for line in text.splitlines())
    return [
        Row(n, c, int(most), int(ms), r, b, yes == "yes") for n, c, most, ms, r, b, yes in cells
    ]


def table(found: list[Row]) -> str:
    """The table of docs/faults.md."""
    head = (
        "| fault | how it is made | detected within [ms] | measured [ms] | the platform | comes back |\n"
        "|---|---|---|---|---|---|\n"
    )
    return head + "".join(
        f"| {r.name} | {r.cause} | {r.most} | {r.measured} | {r.reaction} | {r.way_back} |\n"
        for r in found
    )


def page(found: list[Row]) -> str:
    """docs/faults.md with this table."""
    before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
    return before + BEGIN + table(found) + END + rest.split(END, 1)[1]


def main() -> int:
    """Print the table; with --write, put it into the page."""
    if not PROGRAM.exists():
        print(f"{PROGRAM.relative_to(ROOT)} is not built; ./dev build makes it", file=sys.stderr)
        return 2
    found = rows()
    print(table(found), end="")
    if "--write" in sys.argv[1:]:
        PAGE.write_text(page(found), encoding="utf-8")
    wrong = [r.name for r in found if not r.as_stated]
    for name in wrong:
        print(f"not as stated: {name}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
