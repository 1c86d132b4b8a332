"""Records of a valve whose spool is measured, as in section 4.1.2.2.1 of the source but also in motion.

    python -m validation.twins.spool_runs --out FOLDER [--seed N]

The spool is scipy's linear system (second order, dead time), driven by a command that runs straight between samples,
for which its solution is exact on a grid that holds every kink; then the polynomial of eq. 4.1, its ends, and a probe
with noise.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lsim

Array = NDArray[np.float64]

NOISE = 2e-6  #: m, of the probe
STEP = 1e-6  #: m, of its display
LIMIT = 1.9e-3  #: m
GRID = 5e-5  #: s; dead times are whole numbers of it


@dataclass(frozen=True)
class Spool:
    """One valve."""

    cubic: tuple[float, float, float, float] = (
        -1.9286e-3,
        2.917e-4,
        2.88e-5,
        -2.0e-6,
    )  # m, from V^0
    frequency: float = 65.0  # Hz
    damping: float = 0.7071
    delay: float = 0.0  # s

    @property
    def centre(self) -> float:
        """V, where it stands in the middle."""
        roots = np.roots(self.cubic[::-1])
        real = roots[np.abs(roots.imag) < 1e-9].real
        return float(real[np.argmin(np.abs(real - 5.0))])


@dataclass(frozen=True)
class Run:
    """One command."""

    name: str
    role: str
    rate: float = 1000.0  # samples a second
    duration: float = 2.5  # s


RUNS = (
    Run("steps", "identify"),
    Run("sweep", "identify"),
    Run("triangle", "identify"),
    Run("multisine", "validate"),
)


def command(run: Run, rng: np.random.Generator) -> Array:
    """V, (n,)."""
    t = np.arange(round(run.duration * run.rate)) / run.rate
    if run.name == "steps":
        level = rng.uniform(0.5, 9.5, int(run.duration / 0.1) + 1)
        return np.asarray(level[(t / 0.1).astype(int)])
    if run.name == "sweep":
        low, high = 1.0, 90.0
        rate = np.log(high / low) / run.duration
        return np.asarray(5.0 + 2.5 * np.sin(2 * np.pi * low * (np.exp(rate * t) - 1.0) / rate))
    if run.name == "triangle":
        return np.asarray(10.0 * np.abs(2.0 * np.mod(t / run.duration, 1.0) - 1.0))
    frequency = np.geomspace(0.5, 60.0, 9) * rng.uniform(0.95, 1.05, 9)
    phase = rng.uniform(0.0, 2 * np.pi, 9)
    wave = np.sin(2 * np.pi * frequency * t[:, None] + phase).sum(axis=1)
    return np.asarray(5.0 + 3.0 * wave / np.max(np.abs(wave)))


def simulate(spool: Spool, run: Run, rng: np.random.Generator) -> dict[str, Array]:
    """The record of one run, SI."""
    u = command(run, rng)
    t = np.arange(u.size) / run.rate
    every = round(1.0 / (run.rate * GRID))
    fine = GRID * np.arange((t.size - 1) * every + 1)
    late = np.interp(fine - spool.delay, t, u)
    omega = 2.0 * np.pi * spool.frequency
    system = ([omega**2], [1.0, 2.0 * spool.damping * omega, omega**2])
    _, follows, _ = lsim(system, late - u[0], fine)
    place = np.polynomial.Polynomial(spool.cubic)(follows[::every] + u[0])
    probe = np.clip(place, -LIMIT, LIMIT) + NOISE * rng.standard_normal(t.size)
    return {
        "time": t,
        "valve_command": u,
        "spool_position": np.asarray(np.round(probe / STEP) * STEP),
    }


def draw_spool(rng: np.random.Generator) -> Spool:
    """A valve near the source's."""
    c0, c1, c2, c3 = Spool().cubic
    return Spool(
        (
            c0 * rng.uniform(0.97, 1.03),
            c1 * rng.uniform(0.95, 1.05),
            c2,
            c3 * rng.uniform(0.9, 1.1),
        ),
        float(rng.uniform(50.0, 80.0)),
        float(rng.uniform(0.5, 0.9)),
        GRID * int(rng.integers(4, 40)),
    )


def draw(out: Path, seed: int, runs: tuple[Run, ...] = RUNS) -> Spool:
    """Write records and `rig.toml`; the valve that made them."""
    from sms.io import write_record  # noqa: PLC0415 (the generator itself needs nothing of it)

    rng = np.random.default_rng(seed)
    spool = draw_spool(rng)
    out.mkdir(parents=True, exist_ok=True)
    text = '[rig]\nkind = "spool_test"\ntitle = "Virtual valve, spool measured"\n'
    for run in runs:
        write_record(out / f"{run.name}.csv", simulate(spool, run, rng))
        text += f'\n[[records]]\nfile = "{run.name}.csv"\nrole = "{run.role}"\n'
    (out / "rig.toml").write_text(text)
    return spool


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m validation.twins.spool_runs")
    parser.add_argument("--out", type=Path, required=True, help="folder for rig file and records")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    draw(options.out, options.seed)
    print(options.out / "rig.toml")


if __name__ == "__main__":
    main()
