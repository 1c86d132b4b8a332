"""Short runs of a healthy actuator on the bench, for fits: records and rig file; the truth is handed back.

    python -m validation.twins.actuator_runs --out FOLDER [--seed N] [--machine other]

Two machines, neither of which knows the core:

  published   the source's equations written a second time (actuator_twin.py)
  other       validation/twins with nothing hidden: its friction rises from rest by another curve and has no
              Stribeck term, its valve's map is another interpolation

Every number that the rig file declares lies somewhere within what is declared.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from sms import Params

from validation.twins.actuator import move
from validation.twins.air import Array
from validation.twins.bench_rig import BenchRig
from validation.twins.declared import AIR, Declared, as_declared, drawn
from validation.twins.draw import Run, write_trial
from validation.twins.draw import Trial as Drawn
from validation.twins.instruments import CHANNELS, converted, noise
from validation.twins.measured import sample_times
from validation.twins.truth import Truth

Machine = Literal["published", "other"]
EXCITED_BY = ("multisine", "chirp", "steps")
DURATION = 3.0  #: s of a run
DECLARED = (
    Declared("moving_mass", "moving_mass", 3.639, 0.11, "kg"),
    Declared("coulomb_force", "coulomb_force", 38.0, 4.0, "N"),
    Declared("viscous_friction", "viscous_friction", 530.0, 50.0, "N s/m"),
    Declared("stiction_force", "stiction_force", 77.27, 4.67, "N"),
    Declared("stribeck_acceleration_factor", "stribeck_acceleration_factor", 0.9, 0.2, "s^2/m"),
    Declared("stiction_velocity", "stiction_velocity", 5.0e-3, 5e-4, "m/s"),
    *AIR,
)
"""What the owner of the published machine knows."""
SIGNALS = ("extension", "chamber_pressure_lower", "chamber_pressure_upper", "supply_pressure")


def runs_of(excited_by: Sequence[str], validate: Sequence[str]) -> list[Run]:
    """Those to identify with, then those to validate with."""
    return [
        Run(f"{role}_{i + 1}_{name}", role, name)
        for role, names in (("identify", excited_by), ("validate", validate))
        for i, name in enumerate(names)
    ]


def draw(
    out: Path,
    seed: int,
    machine: Machine = "published",
    excited_by: Sequence[str] = EXCITED_BY,
    validate: Sequence[str] = (),
    duration: float = DURATION,
) -> dict[str, float]:
    """Write records and `rig.toml`; the true numbers by their names."""
    rig = BenchRig()
    rig.duration = duration
    runs = runs_of(excited_by, validate)
    rng = np.random.default_rng([seed, 5])
    if machine == "published":
        return _published(out, rig, runs, rng)
    truth = drawn(as_declared(Truth(), rig.declared), rig.declared, (), rng)
    with tempfile.TemporaryDirectory() as folder:
        sealed = Path(folder) / "truth.json"
        write_trial(Drawn(rig, runs, truth, (), seed), out, sealed)
        content: dict[str, Any] = json.loads(sealed.read_text())
    numbers: dict[str, float] = content["truth"]["machine"]
    return numbers


def _published(
    out: Path, rig: BenchRig, runs: Sequence[Run], rng: np.random.Generator
) -> dict[str, float]:
    from sms.io import write_record  # noqa: PLC0415 (the generator itself needs nothing of it)

    truth = Params()
    for d in DECLARED:
        truth[d.parameter] = d.value + d.half_width * float(rng.uniform(-1.0, 1.0))
    out.mkdir(parents=True, exist_ok=True)
    for run in runs:
        write_record(out / f"{run.name}.csv", _record(truth, rig, run, rng))
    (out / "rig.toml").write_text(_rig_file(runs))
    return {d.parameter: truth[d.parameter] for d in DECLARED}


def _record(truth: Params, rig: BenchRig, run: Run, rng: np.random.Generator) -> dict[str, Array]:
    plan = rig.plan(run.excited_by, rng)
    time = sample_times(rig.duration, rig.sample_step)
    off = {s: noise(CHANNELS[s], time.size, rig.sample_step, rng) for s in SIGNALS}
    commands, signals = move(truth, plan, rig.sample_step, off["extension"])
    return {
        "time": time,
        "valve_command": converted(CHANNELS["valve_command"], commands),
        **{s: converted(CHANNELS[s], signals[s] + off[s]) for s in SIGNALS},
    }


def _rig_file(runs: Sequence[Run]) -> str:
    lines = ["[rig]", 'kind = "bench"', 'title = "Virtual actuator on the bench"', "", "[signals]"]
    lines += [f'{name} = "{name}"' for name in ("time", "valve_command")]
    for signal in SIGNALS:
        c = CHANNELS[signal]
        lines.append(
            f'{signal} = {{ column = "{signal}", noise = "{c.deviation:.3g} {c.unit}", '
            f'resolution = "{c.step:.4g} {c.unit}" }}'
        )
    lines += ["", "[parameters]"]
    for d in DECLARED:
        value, width = (
            f"{v:g}" if d.unit == "1" else f'"{v:g} {d.unit}"' for v in (d.value, d.half_width)
        )
        lines.append(f"{d.parameter} = {{ value = {value}, uncertainty = {width} }}")
    for run in runs:
        lines += ["", "[[records]]", f'file = "{run.name}.csv"', f'role = "{run.role}"']
    return "\n".join(lines) + "\n"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m validation.twins.actuator_runs")
    parser.add_argument("--out", type=Path, required=True, help="folder for rig file and records")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--machine", choices=("published", "other"), default="published")
    options = parser.parse_args()
    draw(options.out, options.seed, options.machine, validate=("holds", "sine"))
    print(options.out / "rig.toml")


if __name__ == "__main__":
    main()
