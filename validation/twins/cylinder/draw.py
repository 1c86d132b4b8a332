"""Draws one hidden effect and writes the records, the rig file and the sealed truth.

    python -m validation.twins.cylinder.draw --seed 7 --out records --truth truth.json

The truth goes where the caller says, outside the records' folder; the folder only gets its
SHA-256, so that nobody can change the answer after the verdict.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from validation.twins.cylinder import detection, effects
from validation.twins.cylinder.motion import ExtraFriction, Motion, simulate
from validation.twins.cylinder.rig import Rig, Run, draw_rig
from validation.twins.cylinder.sensors import (
    Reading,
    Samples,
    SensorErrors,
    read,
    sample,
    time_stamps,
)


def move(rig: Rig, run: Run, extra: ExtraFriction) -> Motion:
    """The true motion of one record."""
    return simulate(rig.cylinder, run.plan, run.pressure, extra, run.bristle_at_rest)


def take_samples(run: Run, motion: Motion) -> Samples:
    """The true values at the logger's instants, which do not depend on the effect."""
    clock = np.random.default_rng(run.clock_seed)
    return sample(motion, *time_stamps(float(motion.time[-1]), clock))


def take_reading(rig: Rig, run: Run, samples: Samples, errors: SensorErrors) -> Reading:
    """The noisy record."""
    return read(samples, rig.sensors, errors, np.random.default_rng(run.noise_seed))


def _draw_effect(rng: np.random.Generator, name: str | None) -> tuple[effects.Effect, float]:
    """Which effect and which sign; `none` is as likely as any other id."""
    ids = sorted({effect.id for effect in effects.CATALOGUE} | {effects.NONE.id})
    drawn, sensor, sign = rng.integers(len(ids)), rng.integers(2**32), rng.choice([-1.0, 1.0])
    options = effects.find(name if name is not None else ids[int(drawn)])
    effect = options[int(sensor) % len(options)]
    return effect, float(sign) if effect.signed else 1.0


def draw(
    seed: int,
    out: Path | str,
    truth_path: Path | str,
    effect: str | None = None,
    multiple: float = 3.0,
) -> None:
    """Write records, `rig.toml` and `truth.sha256` to `out`, the truth to `truth_path`.

    `effect` is an id, or `id:signal` for one sensor; by default it is drawn. Its size is
    `multiple` times its detection limit. The same seed gives the same rig, motion and noise
    whatever the effect. Raises `ValueError` for an unknown effect, a size that is not positive
    or a truth inside `out`.
    """
    out, truth_path = Path(out), Path(truth_path)
    if not (np.isfinite(multiple) and multiple > 0.0):
        raise ValueError(f"multiple is {multiple}; it must be a positive number")
    if truth_path.resolve().is_relative_to(out.resolve()):
        raise ValueError(f"the truth ({truth_path}) must lie outside the records' folder ({out})")
    if seed < 0:
        raise ValueError(f"seed is {seed}; it must not be negative")
    for_rig, for_effect, for_salt = np.random.SeedSequence(seed).spawn(3)
    rig = draw_rig(np.random.default_rng(for_rig))
    kind, sign = _draw_effect(np.random.default_rng(for_effect), effect)

    neutral = {
        run.name: take_samples(run, move(rig, run, rig.shape))
        for run in rig.runs
        if run.role == "identify" or kind.signal is not None or kind is effects.NONE
    }
    limit = None
    if kind is not effects.NONE:
        records = [neutral[run.name] for run in rig.runs if run.role == "identify"]
        limit = detection.detection_limit(
            kind,
            records,
            rig.cylinder,
            rig.sensors,
            shape=rig.shape,
            uncertainty=rig.uncertainty,
        )
    value = 0.0 if limit is None else sign * multiple * limit
    extra, errors = effects.hidden(kind, value, rig.shape)
    readings = []
    for run in rig.runs:
        known = neutral.get(run.name) if extra == rig.shape else None
        samples = known if known is not None else take_samples(run, move(rig, run, extra))
        readings.append(take_reading(rig, run, samples, errors))

    truth: dict[str, Any] = {
        "effect": kind.id,
        "signal": kind.signal,
        "value": value,
        "unit": kind.unit,
        "detection_limit": limit,
        "multiple": multiple if limit is not None else 0.0,
        "seed": seed,
        "salt": np.random.default_rng(for_salt).bytes(16).hex(),
        "extra_friction": asdict(extra),
        "sensor_errors": asdict(errors),
        "cylinder": asdict(rig.cylinder),
        "sensors": asdict(rig.sensors),
        "records": {run.name: {"role": run.role, "pressure": run.pressure} for run in rig.runs},
    }
    out.mkdir(parents=True, exist_ok=True)
    truth_path.parent.mkdir(parents=True, exist_ok=True)
    sealed = (json.dumps(truth, indent=2) + "\n").encode()
    (out / "truth.sha256").write_text(hashlib.sha256(sealed).hexdigest() + "\n")
    truth_path.write_bytes(sealed)
    for run, reading in zip(rig.runs, readings, strict=True):
        _write_record(out / _file_name(run), reading)
    (out / "rig.toml").write_text(_rig_file(rig))


def open_truth(truth_path: Path | str, out: Path | str) -> dict[str, Any]:
    """The truth, after checking that it is the one sealed in the records' folder `out`."""
    sealed = Path(truth_path).read_bytes()
    if hashlib.sha256(sealed).hexdigest() != (Path(out) / "truth.sha256").read_text().strip():
        raise ValueError(f"{truth_path} is not the truth that was sealed in {out}")
    truth: dict[str, Any] = json.loads(sealed)
    return truth


def _file_name(run: Run) -> str:
    return f"{run.name.replace(' ', '_')}.csv"


def _write_record(path: Path, reading: Reading) -> None:
    table = np.column_stack(
        (reading.time, reading.extension, reading.gauge_pressure, reading.rod_force)
    )
    np.savetxt(
        path,
        table,
        fmt=("%.3f", "%.7f", "%.0f", "%.4f"),
        delimiter=",",
        header="time [s],extension [m],chamber_pressure_lower [Pa],rod_force [N]",
        comments="",
    )


def _rig_file(rig: Rig) -> str:
    """What the rig's owner knows; nothing in it depends on the effect."""
    d, u = rig.declared, rig.uncertainty
    records = "\n".join(
        f'[[records]]\nfile = "{_file_name(run)}"\nrole = "{run.role}"\nname = "{run.name}"\n'
        for run in rig.runs
    )
    return f"""\
[rig]
kind = "cylinder"
title = "Virtual cylinder pushed in and out at constant pressure"
notes = "Single-acting, the upper chamber is open. Made by an independent simulator."

[data]
speed_above = "4 mm/s"

[signals]
time = "time"
extension = "extension"
chamber_pressure_lower = {{ column = "chamber_pressure_lower", gauge = true }}
rod_force = "rod_force"

[parameters]
bore_diameter = {{ value = "{d["bore_diameter"] * 1e3:.1f} mm", \
uncertainty = "{u.bore_diameter * 1e3:g} mm" }}
rod_diameter = "{d["rod_diameter"] * 1e3:.1f} mm"
stroke = "{d["stroke"] * 1e3:.1f} mm"
moving_mass = {{ value = "{d["moving_mass"]:.2f} kg", uncertainty = "{u.moving_mass:g} kg" }}
ambient_pressure = {{ value = "{d["ambient_pressure"]:.0f} Pa", uncertainty = "50 Pa" }}
coulomb_force = {{ fit = true, value = "{d["coulomb_force"]:.2f} N" }}
stiction_force = "{d["stiction_force"]:.1f} N"
viscous_friction = {{ value = "{d["viscous_friction"]:g} N*s/m", \
uncertainty = "{u.viscous_friction:g} N*s/m" }}
stribeck_acceleration_factor = "0 s^2/m"

{records}"""


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.twins.cylinder.draw",
        description="Hide one effect in virtual measurements of a pneumatic cylinder.",
    )
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--out", type=Path, required=True, help="folder for rig and records")
    parser.add_argument("--truth", type=Path, required=True, help="file for the sealed truth")
    parser.add_argument("--effect", help="id, or id:signal; drawn when left out")
    parser.add_argument("--multiple", type=float, default=3.0, help="of the detection limit")
    options = parser.parse_args(arguments)
    try:
        draw(options.seed, options.out, options.truth, options.effect, options.multiple)
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
