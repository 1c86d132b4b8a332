"""python -m validation.hidden_effects.machines {draw,limits,symptom,score} ..."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table

from validation.hidden_effects.machines import (
    effects,
    limits,
    scoring,
    symptom,
    symptom_experiments,
    symptom_picture,
)
from validation.hidden_effects.machines.draw import LIMIT_SEED, PAIRS, RIGS, draw

BEST = 6
"""Experiments that are printed."""


def _draw(options: argparse.Namespace) -> None:
    draw(
        options.rig,
        options.seed,
        options.out,
        options.truth,
        options.effect,
        options.multiple,
    )


def _limits(options: argparse.Namespace) -> None:
    rig = RIGS[options.rig]
    every = effects.on(rig.kind, (*effects.CATALOGUE, *effects.OUT_OF_CATALOGUE))
    rows = [
        limits.table(rig, every, pair, LIMIT_SEED, 2 if rig.kind == "platform" else 1)
        for pair in track(PAIRS[rig.kind], "pairs of excitations")
    ]
    path = limits.path_of(rig.kind)
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(rows, indent=2) + "\n")


def _symptom(options: argparse.Namespace) -> None:
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


def _score(options: argparse.Namespace) -> None:
    outcomes = [outcome for path in options.files for outcome in scoring.load(path)]
    if not outcomes:
        raise ValueError("there is no outcome in these files")
    console = Console(width=200)
    for kind in sorted({outcome.kind for outcome in outcomes}):
        own = [outcome for outcome in outcomes if outcome.kind == kind]
        console.print(f"[bold]{kind}[/bold], {len(own)} trials")
        console.print(scoring.confusion_table(own))
        console.print(scoring.goal_table(own))


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.hidden_effects.machines",
        description="Virtual measurements of a bench actuator, a platform or a tank with one "
        "hidden effect.",
    )
    commands = parser.add_subparsers(required=True)
    drawing = commands.add_parser("draw", help="write records, rig file and sealed truth")
    drawing.add_argument("rig", choices=sorted(RIGS))
    drawing.add_argument("--seed", type=int, required=True)
    drawing.add_argument("--out", type=Path, required=True, help="folder for rig and records")
    drawing.add_argument("--truth", type=Path, required=True, help="file for the sealed truth")
    drawing.add_argument(
        "--effect", action="append", help="id, or id:target; twice for two; drawn when left out"
    )
    drawing.add_argument("--multiple", type=float, default=3.0, help="of the detection limit")
    drawing.set_defaults(run=_draw)
    limiting = commands.add_parser("limits", help="compute the table of detection limits")
    limiting.add_argument("rig", choices=sorted(RIGS))
    limiting.set_defaults(run=_limits)
    showing = commands.add_parser("symptom", help="the source's own symptom: table, or records")
    showing.add_argument("--seed", type=int, default=1)
    showing.add_argument("--out", type=Path, help="folder for rig and records")
    showing.add_argument("--truth", type=Path, help="file for the sealed truth")
    showing.add_argument("--picture", type=Path, help="also draw the table as SVG to this file")
    showing.set_defaults(run=_symptom)
    scored = commands.add_parser(
        "score", help="confusion matrix and goals of outcomes (JSON lines)"
    )
    scored.add_argument("files", type=Path, nargs="+")
    scored.set_defaults(run=_score)
    options = parser.parse_args(arguments)
    try:
        options.run(options)
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
