"""Runs as in chapter 6 of the source: a cylinder without a load, moved by its own pressures.

    python -m validation.twins.friction_runs --out FOLDER [--seed N]

The motion is prescribed (a sine with a little of its third harmonic, so that acceleration and speed
are not one signal), and the pressures are those that the motion needs: inertia, friction by eq. 6.5
written here a second time, and a mean pressure that swings. Friction differs from run to run, as
lubrication does. The position is read with the source's noise at 1 kHz, the pressures with theirs.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BORE, ROD, MASS, AMBIENT = 0.100, 0.025, 3.639, 86e3
LOWER_AREA = np.pi / 4 * BORE**2
UPPER_AREA = LOWER_AREA - np.pi / 4 * ROD**2
POSITION_NOISE, PRESSURE_NOISE = 37.5e-6, 270.0


@dataclass(frozen=True)
class Friction:
    """Eq. 6.5 with both branches alike."""

    coulomb: float = 38.0  # N
    stiction: float = 77.27  # N
    viscous: float = 530.0  # N s/m
    stribeck_velocity: float = 0.05  # m/s
    exponent: float = 1.4
    factor: float = 0.9  # s^2/m
    ramp: float = 0.005  # m/s

    def force(self, v: Array, a: Array) -> Array:
        """N, over velocity (n,) and acceleration (n,)."""
        speed = np.abs(v)
        width = np.abs(a) * self.factor * self.stribeck_velocity
        starting = v * a > 0.0
        ratio = np.divide(speed, width, out=np.full_like(v, 1e3), where=width > 0.0)
        fall = np.where(starting, np.exp(-(np.minimum(ratio, 1e3) ** self.exponent)), 0.0)
        dry = self.coulomb + (self.stiction - self.coulomb) * fall
        alpha = np.where(speed < self.ramp, np.sin(np.pi / 2 * speed / self.ramp), 1.0)
        return np.asarray(alpha * (np.sign(v) * dry + self.viscous * v))


@dataclass(frozen=True)
class Run:
    """One prescribed motion."""

    frequency: float  # Hz
    amplitude: float  # m
    duration: float  # s
    role: str


RUNS = (
    Run(0.10, 0.10, 40.0, "identify"),
    Run(0.20, 0.10, 30.0, "identify"),
    Run(0.33, 0.08, 30.0, "identify"),
    Run(0.45, 0.06, 20.0, "identify"),
    Run(0.25, 0.11, 30.0, "validate"),
)


def simulate(
    run: Run, friction: Friction, rng: np.random.Generator, rate: float = 1000.0
) -> dict[str, Array]:
    """The record of one run: project signals, (n,) each, SI, pressures absolute."""
    t = np.arange(round(run.duration * rate)) / rate
    w = 2 * np.pi * run.frequency
    phase = rng.uniform(0.0, 2 * np.pi)
    x = 0.2 + run.amplitude * (np.sin(w * t + phase) + 0.08 * np.sin(3 * w * t + phase))
    v = run.amplitude * w * (np.cos(w * t + phase) + 0.24 * np.cos(3 * w * t + phase))
    a = -run.amplitude * w**2 * (np.sin(w * t + phase) + 0.72 * np.sin(3 * w * t + phase))
    needed = MASS * a + friction.force(v, a)
    upper = 300e3 + 15e3 * np.sin(0.7 * w * t)
    lower = AMBIENT + (needed + (upper - AMBIENT) * UPPER_AREA) / LOWER_AREA
    return {
        "time": t,
        "extension": x + POSITION_NOISE * rng.standard_normal(t.size),
        "chamber_pressure_lower": lower + PRESSURE_NOISE * rng.standard_normal(t.size),
        "chamber_pressure_upper": upper + PRESSURE_NOISE * rng.standard_normal(t.size),
        "valve_command": np.full(t.size, 5.0) + 0.5 * np.sign(v),
    }


def draw(
    out: Path,
    seed: int,
    runs: tuple[Run, ...] = RUNS,
    scatter: float = 0.03,
    rate: float = 1000.0,
) -> Path:
    """Write records and rig file; friction differs by `scatter` (relative sd) from run to run."""
    from sms.io import write_record  # noqa: PLC0415 (the generator itself needs nothing of it)

    rng = np.random.default_rng(seed)
    text = (
        '[rig]\nkind = "bench"\ntitle = "Virtual cylinder without a load"\n\n'
        '[data]\nspeed_above = "2 mm/s"\n\n[parameters]\nmoving_mass = "3.639 kg"\n'
        'coulomb_force = "30 N"\nviscous_friction = "300 N*s/m"\n'
    )
    out.mkdir(parents=True, exist_ok=True)
    for number, run in enumerate(runs, 1):
        factor = 1.0 + scatter * rng.standard_normal(2)
        friction = Friction(coulomb=38.0 * factor[0], viscous=530.0 * factor[1])
        write_record(out / f"run_{number}.csv.gz", simulate(run, friction, rng, rate))
        text += f'\n[[records]]\nfile = "run_{number}.csv.gz"\nrole = "{run.role}"\n'
    path = out / "rig.toml"
    path.write_text(text)
    return path


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m validation.twins.friction_runs")
    parser.add_argument("--out", type=Path, required=True, help="folder for rig file and records")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    print(draw(options.out, options.seed))


if __name__ == "__main__":
    main()
