"""python -m validation.twins {draw,limits} ..."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from rich.progress import track

from validation.twins import effects, limits
from validation.twins.draw import LIMIT_SEED, PAIRS, RIGS, draw


def _draw(options: argparse.Namespace) -> None:
    draw(
        options.rig,
        options.seed,
        options.out,
        options.truth,
        options.effect,
        options.multiple,
        options.imperfection,
    )


def _limits(options: argparse.Namespace) -> None:
    rig = RIGS[options.rig]
    every = effects.on(rig.kind, (*effects.CATALOGUE, *effects.GEOMETRY, *effects.OUT_OF_CATALOGUE))
    rows = [
        limits.table(rig, every, pair, LIMIT_SEED, 2 if rig.kind == "platform" else 1)
        for pair in track(PAIRS[rig.kind], "pairs of excitations")
    ]
    path = limits.path_of(rig.kind)
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps(rows, indent=2) + "\n")


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.twins",
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
    drawing.add_argument(
        "--imperfection",
        type=float,
        default=0.0,
        metavar="PERCENT",
        help="by which the machine is off from what a rig file can declare",
    )
    drawing.set_defaults(run=_draw)
    limiting = commands.add_parser("limits", help="compute the table of detection limits")
    limiting.add_argument("rig", choices=sorted(RIGS))
    limiting.set_defaults(run=_limits)
    options = parser.parse_args(arguments)
    try:
        options.run(options)
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
