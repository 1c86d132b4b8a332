"""The test matrix as records on disk with their rig file: what `sms identify flow` reads.

python -m validation.twins.flow_runs --out FOLDER [--seed N]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from validation.twins.flow_test import Charging, delayed, matrix, read, sensor_of, simulate

HEAD = """\
[rig]
kind = "flow_test"
title = "Virtual valve, 28 positions, two supplies, charge and discharge"
notes = "Made by an independent simulator (validation/twins)."

[signals]
time = "time"
tank_pressure = "tank_pressure"

[parameters]
tank_volume = { value = "5 l", uncertainty = "0.02 l" }
ambient_pressure = { value = "86 kPa", uncertainty = "0.1 kPa" }
supply_pressure = { value = "486 kPa", uncertainty = "2 kPa" }
air_temperature = { value = "293 K", uncertainty = "1 K" }
"""


def draw(out: Path, seed: int, tests: list[tuple[float, Charging]] | None = None) -> Path:
    """Write records and rig file into a folder; the rig file's path."""
    rng = np.random.default_rng(seed)
    text = HEAD
    out.mkdir(parents=True, exist_ok=True)
    for spool, ideal in matrix() if tests is None else tests:
        test = delayed(ideal, rng)
        time, pressure = simulate(test)
        reading = read(pressure, sensor_of(test), rng)
        way = "charge" if test.charge else "discharge"
        name = f"{way}_{1e-3 * test.supply:.0f}kPa_{1e3 * spool:.3f}mm"
        np.savetxt(
            out / f"{name}.csv", np.column_stack((time, reading)), fmt=("%.2f", "%.1f"),
            delimiter=",", header="time [s],tank_pressure [Pa]", comments="",
        )  # fmt: skip
        text += (
            f'\n[[records]]\nfile = "{name}.csv"\nrole = "identify"\n'
            f'conditions = {{ spool_position = "{1e3 * spool:.3f} mm", '
            f'supply_pressure = "{1e-3 * test.supply:.0f} kPa" }}\n'
        )
    path = out / "rig.toml"
    path.write_text(text)
    return path


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m validation.twins.flow_runs")
    parser.add_argument("--out", type=Path, required=True, help="folder for rig file and records")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    print(draw(options.out, options.seed))


if __name__ == "__main__":
    main()
