"""One drawn rig: everything the diagnosis is not asked about, perturbed within reason."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from validation.twins.cylinder.detection import Uncertainty
from validation.twins.cylinder.motion import Cylinder, ExtraFriction, StrokePlan
from validation.twins.cylinder.sensors import Sensors

LONGEST_RECORD = 60.0
"""Seconds a record lasts at most."""


@dataclass(frozen=True)
class Run:
    """One record to be made."""

    name: str
    role: str
    pressure: float  # Pa, gauge, of the regulator
    plan: StrokePlan
    bristle_at_rest: float
    clock_seed: int
    noise_seed: int


@dataclass(frozen=True)
class Rig:
    """One drawn rig: how it truly is, how it is measured and what its owner declares."""

    cylinder: Cylinder
    sensors: Sensors
    shape: ExtraFriction  # places and lengths of the effects outside the catalogue
    uncertainty: Uncertainty
    declared: dict[str, float]
    runs: tuple[Run, ...]


def draw_rig(rng: np.random.Generator) -> Rig:
    """Perturb everything that the diagnosis is not asked about."""
    uncertainty = Uncertainty()
    declared = {
        "bore_diameter": 25e-3,
        "rod_diameter": float(rng.choice([0.0, 10e-3])),
        "stroke": 40e-3,
        "moving_mass": round(float(rng.uniform(0.2, 0.6)), 2),
        "ambient_pressure": round(float(rng.uniform(86e3, 102e3)), -2),
        "viscous_friction": 15.0,
    }

    def near(name: str, half_width: float) -> float:
        return declared[name] + half_width * float(rng.uniform(-1.0, 1.0))

    def between(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    def log_between(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    coulomb = between(4.0, 9.0)
    cylinder = Cylinder(
        bore_diameter=near("bore_diameter", uncertainty.bore_diameter),
        stroke=declared["stroke"],
        moving_mass=near("moving_mass", uncertainty.moving_mass),
        ambient_pressure=near("ambient_pressure", 50.0),
        coulomb_force=coulomb,
        stiction_force=coulomb * between(1.1, 1.5),
        stribeck_velocity=between(0.3e-3, 0.7e-3),
        viscous_friction=near("viscous_friction", uncertainty.viscous_friction),
        bristle_stiffness=log_between(2e6, 6e6),
        bristle_damping=between(100.0, 300.0),
        cell_stiffness=log_between(5e5, 2e6),
        cell_damping=between(100.0, 300.0),
        line_volume=between(1e-4, 2e-4),
        gas_exponent=between(1.05, 1.3),
        regulator_dead_band=between(2e3, 3.5e3),
        regulator_conductance=log_between(0.8e-3, 2.5e-3),
    )
    sensors = Sensors(
        force_white=log_between(0.05, 0.3),
        force_coloured=between(0.15, 0.25),
        force_correlation_time=log_between(0.05, 0.3),
        pressure_noise=between(100.0, 300.0),
        extension_noise=between(5e-6, 20e-6),
        spike_rate=log_between(0.03, 1.0),
        spike_size=between(0.2e-3, 0.4e-3),
    )
    shape = ExtraFriction(
        scratch_centre=between(8e-3, 32e-3),
        scratch_width=between(0.7e-3, 2e-3),
        ripple_length=between(4e-3, 9e-3),
        ripple_phase=between(0.0, 2.0 * np.pi),
        drift_time=between(8.0, 25.0),
    )
    declared["coulomb_force"] = coulomb * float(rng.choice([0.7, 1.3]))
    declared["stiction_force"] = cylinder.stiction_force * between(0.9, 1.1)
    return Rig(cylinder, sensors, shape, uncertainty, declared, _draw_runs(rng))


def _draw_runs(rng: np.random.Generator) -> tuple[Run, ...]:
    """Four records: 1 and 5 bar to identify, 3 and 7 bar to validate."""
    fast, slow = float(rng.uniform(12e-3, 18e-3)), float(rng.uniform(10e-3, 13e-3))
    sag = float(rng.uniform(0.0, 0.3))  # how much the load slows the drive down at 7 bar
    runs = []
    for bar in (1, 3, 5, 7):
        inwards = slow * (1.0 - sag * bar / 7.0)
        turning = float(rng.uniform(0.2, 0.4))
        cycle = 35e-3 / fast + 35e-3 / inwards + turning
        strokes = min(10, int((LONGEST_RECORD - 4.0) / cycle))
        plan = StrokePlan(
            tuple((fast * rng.uniform(0.98, 1.02, strokes)).tolist()),
            tuple((inwards * rng.uniform(0.98, 1.02, strokes)).tolist()),
            rest=float(rng.uniform(0.3, 0.7)),
            turning_time=turning,
            ripple=float(rng.uniform(0.01, 0.06)),
            lead=float(rng.uniform(2e-3, 6e-3)),
        )
        runs.append(
            Run(
                name=f"{bar} bar",
                role="identify" if bar in (1, 5) else "validate",
                pressure=bar * 1e5 * float(rng.uniform(0.97, 1.03)),
                plan=plan,
                bristle_at_rest=float(rng.uniform(-0.5, 0.5)),
                clock_seed=int(rng.integers(2**62)),
                noise_seed=int(rng.integers(2**62)),
            )
        )
    return tuple(runs)
