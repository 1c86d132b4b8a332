"""A sampled position controller, its command held from one sample to the next.

Parallel PID (eq. 7.4 of the source by the bilinear transform), a step over the dead band (eq. 7.5), clipped to the
valve's range. It reads the converter that the logger reads, at the same instants.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from math import atan, pi, sqrt

import numpy as np

from validation.reference.compiled import compiled
from validation.twins.air import Array
from validation.twins.machine import Machine


@dataclass(frozen=True)
class Controller:
    """Numbers of the controller, SI; those of the bench by default."""

    proportional: float = 12.0  # V/m
    integral: float = 5.0  # V/(m s)
    derivative: float = 0.2  # V s/m
    corner: float = 60.0  # rad/s, of the derivative's filter
    step: float = 0.5  # V, over the dead band
    sharpness: float = 20.0  # 1/V

    @property
    def gains(self) -> Array:
        """Its numbers in their order."""
        return np.array(astuple(self))


PLATFORM_CONTROLLER = Controller(proportional=18.0, derivative=0.5)
"""Under the platform, where a piston carries more."""
IN_RIG_FILE = {
    "proportional_gain": ("proportional", "V/m"),
    "integral_gain": ("integral", "V/(m s)"),
    "derivative_gain": ("derivative", "V s/m"),
    "differentiator_corner": ("corner", "rad/s"),
    "dead_band_step": ("step", "V"),
    "dead_band_sharpness": ("sharpness", "1/V"),
}
"""Name in the rig file -> that of Controller, unit."""


@compiled
def answered(gains: Array, period: float, memory: Array, error: float) -> float:
    """V of a controller that sees an error, m; gains: Controller's numbers in their order.

    memory: the last error, its integral, its slope; a controller begins with (first error, 0, 0).
    """
    proportional, integral, derivative, corner, step, sharpness = gains
    before = memory[0]
    memory[0] = error
    memory[1] += 0.5 * period * (error + before)
    memory[2] = ((2.0 - corner * period) * memory[2] + 2.0 * corner * (error - before)) / (
        2.0 + corner * period
    )
    u = proportional * error + integral * memory[1] + derivative * memory[2]
    u = min(5.0, max(-5.0, u))
    scale = (5.0 - 2.0 * step / pi * atan(5.0 * sharpness)) / 5.0
    u = scale * u + 2.0 * step / pi * atan(sharpness * u)
    return float(min(10.0, max(0.0, 5.0 + u)))


@compiled
def read(truth: float, noise: float, count: float) -> float:
    """A position as the converter gives it, m; count: its step."""
    return float(np.round((truth + noise) / count) * count)


@compiled
def sample_at_valve(sample: int, time: float, late: float, period: float) -> int:
    """Which sample's command is at the valve, `time` after sample; negative: none yet."""
    return sample + int(np.floor((time - late) / period + 1e-9))


@compiled
def delay(p: Machine) -> float:
    """s from the controller to the valve."""
    speed_of_sound = sqrt(p.kappa * p.gas_constant * p.air_temperature)
    return p.command_delay + p.tube_length / speed_of_sound
