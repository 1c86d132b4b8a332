"""The effects that can be hidden, and how the force balance would show each.

A sensitivity is the change, per unit of the effect, of

    residual = measured rod_force - (area x measured gauge pressure - Coulomb friction)

on the moving samples of one record: what a person with these readings sees.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from validation.twins.cylinder.motion import Array, Cylinder, ExtraFriction
from validation.twins.cylinder.sensors import Samples, SensorErrors


@dataclass(frozen=True)
class Effect:
    """One drawable effect: catalogue id, the measured signal it sits on, unit of its value."""

    id: str
    signal: str | None
    unit: str
    signed: bool  # whether a negative value is physical

    @property
    def field(self) -> str:
        """Name of the number in `ExtraFriction` or `SensorErrors` that carries it."""
        kind = self.id.removeprefix("sensor_")
        return self.id if self.signal is None else f"{self.signal}_{kind}"

    @property
    def key(self) -> str:
        """Unique name: the id, with the signal after a colon for a sensor effect."""
        return self.id if self.signal is None else f"{self.id}:{self.signal}"


NONE = Effect("none", None, "1", False)

CATALOGUE = (
    Effect("pressure_dependent_friction", None, "N/Pa", False),
    Effect("direction_dependent_friction", None, "N", True),
    Effect("position_dependent_friction", None, "1/m", True),
    Effect("sensor_gain", "rod_force", "1", True),
    Effect("sensor_gain", "chamber_pressure_lower", "1", True),
    Effect("sensor_offset", "rod_force", "N", True),
    Effect("sensor_offset", "chamber_pressure_lower", "Pa", True),
)
"""What the default trial draws from, beside `NONE`. The extension's gain and offset cannot be
seen by this rig and are left out."""

OUT_OF_CATALOGUE = (
    Effect("bore_scratch", None, "N", False),
    Effect("position_ripple", None, "N", True),
    Effect("friction_drift", None, "N", False),
)
"""Never drawn by default: the right verdict on these is `unknown`."""


def find(name: str) -> list[Effect]:
    """All effects called `name` (an id, or `id:signal`); raises `ValueError` for none."""
    everything = (NONE, *CATALOGUE, *OUT_OF_CATALOGUE)
    found = [effect for effect in everything if name in (effect.id, effect.key)]
    if not found:
        names = ", ".join(sorted({effect.id for effect in everything}))
        raise ValueError(f"there is no effect '{name}' to hide; choose one of: {names}")
    return found


def hidden(
    effect: Effect, value: float, shape: ExtraFriction
) -> tuple[ExtraFriction, SensorErrors]:
    """The neutral model with `effect` set to `value`; `shape` holds places and lengths."""
    if effect.id == NONE.id:
        return shape, SensorErrors()
    if effect.signal is None:
        numbers = {**vars(shape), effect.field: value}
        return ExtraFriction(**numbers), SensorErrors()
    return shape, SensorErrors(**{effect.field: value})


def sensitivity(
    effect: Effect, samples: Samples, cylinder: Cylinder, shape: ExtraFriction
) -> Array:
    """Change of the residual [N] per unit of `effect` while moving, shape (n,)."""
    direction = np.sign(samples.velocity)
    x = samples.extension
    ones = np.ones_like(x)
    if effect.id == "sensor_gain":
        of_pressure = -cylinder.piston_area * samples.gauge_pressure
        return samples.rod_force if effect.signal == "rod_force" else of_pressure
    if effect.id == "sensor_offset":
        return ones if effect.signal == "rod_force" else -cylinder.piston_area * ones
    bell = np.exp(-0.5 * ((x - shape.scratch_centre) / shape.scratch_width) ** 2)
    friction = {
        "pressure_dependent_friction": direction * samples.gauge_pressure,
        "direction_dependent_friction": ones,
        "position_dependent_friction": direction
        * cylinder.coulomb_force
        * (x - 0.5 * cylinder.stroke),
        "bore_scratch": direction * bell,
        "position_ripple": direction
        * np.sin(2.0 * np.pi * x / shape.ripple_length + shape.ripple_phase),
        "friction_drift": direction * np.exp(-samples.time / shape.drift_time),
    }
    return np.asarray(-friction[effect.id], dtype=np.float64)
