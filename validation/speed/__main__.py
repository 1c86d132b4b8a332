"""How fast is it, and against what? `./dev bench [--peers] [--json FILE]`.

Every row is one measurement beside the peer that a user would take today: same data, same result,
one run on this machine. The machine's speed is in both numbers; the ratio carries over to others.
"""

from __future__ import annotations

import argparse
import subprocess
from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.table import Table
from sms.io.json_files import json_text

from validation.speed import flow, friction, mechanism, other_simulators, plant
from validation.speed.timing import Row

COMPILED = Path("build/bench/libsms/bench/sms_bench")


def compiled_values() -> dict[str, float]:
    """What the timing programs of libsms/bench print: nanoseconds of one call by name."""
    lines = subprocess.run([COMPILED], check=True, capture_output=True, text=True).stdout
    return {name: float(time) for name, time, _ in (s.split("\t") for s in lines.splitlines())}


def measurements(install_peers: bool) -> list[Row]:
    """Every row, subject by subject."""
    compiled = compiled_values()
    return [
        *friction.friction_rows(compiled),
        *friction.fit_rows(),
        *flow.measurements(),
        *mechanism.inverse_rows(compiled),
        *mechanism.motion_rows(compiled),
        *other_simulators.simulation_rows(compiled["simulation step"] * 1e-3, install_peers),
        *mechanism.batch_rows(compiled),
        *plant.plant_rows(compiled, install_peers),
        *mechanism.instruction_rows(COMPILED, mechanism.COUNTED + plant.COUNTED),
    ]


def table_of(rows: list[Row]) -> Table:
    """The rows as a person reads them."""
    table = Table(title="measured on this machine, in one run")
    for heading in ("measurement", "value", "peer", "peer's value", "ratio", "goal", "met"):
        table.add_column(heading, justify="left" if heading in ("measurement", "peer") else "right")
    for r in rows:
        table.add_row(
            r.name,
            f"{r.value:.3g} {r.unit}",
            r.peer or "",
            "" if r.peer_value is None else f"{r.peer_value:.3g} {r.unit}",
            "" if r.ratio is None else f"{r.ratio:.1f}x",
            r.goal or "",
            {True: "[green]yes[/]", False: "[red]no[/]", None: ""}[r.met],
        )
    return table


def main() -> None:
    """Measure, print the table, write the rows."""
    parser = argparse.ArgumentParser(prog="./dev bench", description=__doc__)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write one row a measurement")
    parser.add_argument(
        "--peers", action="store_true", help="install the simulators to compare with, 1.1 GB"
    )
    options = parser.parse_args()
    rows = measurements(options.peers)
    Console(width=120).print(table_of(rows))
    if options.json:
        options.json.write_text(json_text("measurements", {"rows": [asdict(r) for r in rows]}))


if __name__ == "__main__":
    main()
