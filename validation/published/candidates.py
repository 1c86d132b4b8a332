"""What may be missing in the plant, or be read differently: one number each, and its range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from sms._core import Params
from sms.arrays import Array


@dataclass(frozen=True)
class Candidate:
    """Parameters that one number moves together."""

    name: str
    kind: str  #: "physics" or "reading"
    parameters: tuple[str, ...]
    low: float
    high: float
    logarithmic: bool = True
    factor: bool = False  #: the number multiplies the parameters' defaults
    weights: tuple[float, ...] = ()  #: or these, one a parameter

    def settings(self, value: float) -> dict[str, float]:
        """The parameters at this value, SI."""
        defaults = Params()
        weights = self.weights or tuple(
            float(defaults[name]) if self.factor else 1.0 for name in self.parameters
        )
        return {name: value * w for name, w in zip(self.parameters, weights, strict=True)}

    def grid(self, count: int) -> Array:
        """Values over the range, evenly on its own scale."""
        if self.logarithmic:
            return np.geomspace(self.low, self.high, count)
        return np.linspace(self.low, self.high, count)

    def between(self, one: float, other: float) -> float:
        """The middle of two values on its own scale."""
        return float(np.sqrt(one * other)) if self.logarithmic else 0.5 * (one + other)


STATE_FEEDBACK = (
    Candidate("exponential friction F_UE, N", "physics", ("exponential_friction_force",), 0.3, 300),
    Candidate("viscous friction, times", "physics", ("viscous_friction",), 0.5, 20, factor=True),
    Candidate("dry friction, times", "physics", ("coulomb_force", "stiction_force"), 0.5, 20, factor=True),
    Candidate("joint damping, N m s/rad", "physics", ("panhard_friction",), 10, 1e5),
    Candidate("mass-flow gain", "physics", ("mass_flow_gain",), 0.2, 3),
    Candidate("exhaust flow change", "physics", ("exhaust_flow_change",), -0.9, 1, False),
    Candidate("supply pressure, Pa", "physics", ("supply_pressure",), 2.5e5, 8e5),
    Candidate("spool frequency, Hz", "physics", ("valve_frequency",), 5, 1000),
    Candidate("dead volumes, m^3", "physics", ("dead_volume_lower", "dead_volume_upper"), 1e-5, 3e-3),
    Candidate("compression ratio", "physics", ("compression_heat_ratio",), 1, 1.4, False),
    Candidate("piston leakage, kg/(s Pa)", "physics", ("piston_leakage",), 1e-10, 1e-7),
    Candidate("valve leakage, m^3/(s Pa)", "physics", ("valve_leakage",), 1e-11, 1e-8),
    Candidate("command delay, s", "physics", ("command_delay",), 1e-3, 0.03),
    Candidate("dead band change, V", "reading", ("dead_band_change",), -0.4, 0.6, False),
    Candidate("valve centre, V", "reading", ("valve_centre",), 4.8, 5.2, False),
    Candidate("dead-band step, V", "reading", ("dead_band_step",), 0, 1.2, False),
    Candidate("differentiators' corner, rad/s", "reading", ("differentiator_corner",), 10, 2000),
    Candidate("K_p, V/m", "reading", ("position_gain",), 1, 100),
    Candidate("K_v, V s/m", "reading", ("velocity_gain",), 0.2, 40),
    Candidate("K_a, V s^2/m", "reading", ("acceleration_gain",), -0.2, 0.5, False),
    Candidate("K_v = 1 and K_a = +0.005, times", "reading", ("velocity_gain", "acceleration_gain"), 1, 30,
              weights=(1.0, 0.005)),
)  # fmt: skip

ACTUATOR = (
    Candidate("exhaust flow change", "reading", ("exhaust_flow_change",), -0.5, 1.0, False),
    Candidate("exponential friction F_UE, N", "physics", ("exponential_friction_force",), 0.1, 30),
    Candidate("viscous friction, times", "physics", ("viscous_friction",), 0.2, 10, factor=True),
    Candidate("dead band change, V", "reading", ("dead_band_change",), -0.4, 0.4, False),
    Candidate("compression ratio", "physics", ("compression_heat_ratio",), 1.0, 1.4, False),
    Candidate("supply pressure, Pa", "physics", ("supply_pressure",), 3e5, 8e5),
    Candidate("dead volumes, m^3", "physics", ("dead_volume_lower", "dead_volume_upper"), 1e-5, 2e-3),
    Candidate("valve leakage, m^3/(s Pa)", "physics", ("valve_leakage",), 1e-12, 1e-9),
    Candidate("tube length, m", "physics", ("tube_length",), 0.01, 5),
)  # fmt: skip

Settings = Mapping[str, float]
