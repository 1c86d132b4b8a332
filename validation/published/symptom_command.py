"""The source's own symptom (symptom.py): its table, its picture, or sealed records of it.

python -m validation.published.symptom_command [--picture docs/symptom.svg]
python -m validation.published.symptom_command --out records --truth truth.json
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table

from validation.published import symptom, symptom_experiments, symptom_picture

BEST = 6
"""Experiments that are printed."""


def show(options: argparse.Namespace) -> None:
    """The table and the experiments, or records."""
    if options.out is not None:
        if options.truth is None:
            raise ValueError("--out needs --truth, a file outside it")
        symptom.write_records(options.seed, options.out, options.truth)
        return
    table = Table(title="87 mm made 81 mm: what it takes, and the lag at three inputs")
    for column in ("cause", "size", "travel [mm]", "lag [ms]"):
        table.add_column(column)
    rows = symptom.table()
    for row in rows:
        size = "-" if row.size is None else f"{row.size:.4g}"
        travels = ", ".join(f"{1e3 * x:.1f}" for x in row.travels) or "not within reason"
        table.add_row(row.cause, size, travels, ", ".join(f"{1e3 * x:.0f}" for x in row.lags))
    console = Console(width=120)
    console.print(table)
    if options.picture is not None:
        options.picture.write_text(symptom_picture.picture(rows))
    menu = Table(title="which experiment tells the causes of the smaller travel apart")
    for column in ("inputs", "what is read", "the two it tells worst", "apart by"):
        menu.add_column(column)
    for e in symptom_experiments.experiments()[:BEST]:
        one, other, apart = e.worst
        sines = "; ".join(f"{amplitude:g} V at {hertz:g} Hz" for amplitude, hertz in e.inputs)
        menu.add_row(sines, ", ".join(e.signals), f"{one}, {other}", f"{apart:.1f}")
    console.print(menu)


def main() -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m validation.published.symptom_command")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, help="folder for rig and records")
    parser.add_argument("--truth", type=Path, help="file for the sealed truth")
    parser.add_argument("--picture", type=Path, help="also draw the table as SVG to this file")
    try:
        show(parser.parse_args())
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
