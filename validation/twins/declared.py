"""What the owner of a rig knows: numbers with half widths within which the truth lies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from validation.twins.effects import Effect
from validation.twins.truth import Truth


@dataclass(frozen=True)
class Declared:
    """One parameter of the rig file."""

    parameter: str  #: the rig file's name
    name: str | None  #: the truth's; None when it is the truth's business how it is met
    value: float
    half_width: float
    unit: str


FRICTION = (
    Declared("coulomb_force", "coulomb_force", 38.0, 4.0, "N"),
    Declared("viscous_friction", "viscous_friction", 530.0, 50.0, "N s/m"),
    # The twin's way through rest and sin(pi v / (2 eps)) are alike for eps = pi/2 creep_velocity.
    Declared("stiction_velocity", None, 4.5e-3, 0.7e-3, "m/s"),
    Declared("stribeck_acceleration_factor", None, 0.0, 0.0, "s^2/m"),
    Declared("exponential_friction_force", None, 0.0, 0.0, "N"),
)
AIR = (
    Declared("ambient_pressure", "ambient_pressure", 86.0e3, 300.0, "Pa"),
    Declared("air_temperature", "air_temperature", 293.0, 2.0, "K"),
    Declared("supply_pressure", "supply_pressure", 486.0e3, 2.0e3, "Pa"),
    Declared("valve_centre", "valve_centre", 5.0, 0.03, "V"),
    Declared("valve_frequency", "valve_frequency", 65.0, 6.0, "Hz"),
    Declared("mass_flow_gain", "mass_flow_gain", 1.2, 0.1, "1"),
    Declared("dead_volume_lower", "dead_volume_lower", 1.2e-4, 2.0e-5, "m^3"),
    Declared("dead_volume_upper", "dead_volume_upper", 1.2e-4, 2.0e-5, "m^3"),
    Declared("compression_heat_ratio", "compression_heat_ratio", 1.2, 0.03, "1"),
)
PAYLOAD = (
    Declared("payload_mass", "payload_mass", 255.08, 2.0, "kg"),
    Declared("payload_cog_x", "payload_cog_x", 0.0, 5e-3, "m"),
    Declared("payload_cog_y", "payload_cog_y", 0.0, 5e-3, "m"),
    Declared("payload_cog_z", "payload_cog_z", -1.3922, 1e-2, "m"),
)
PLATFORM = (*PAYLOAD, *FRICTION, *AIR)
BENCH = (Declared("moving_mass", "moving_mass", 3.639, 0.11, "kg"), *FRICTION, *AIR)

TANK = (
    Declared("tank_volume", "tank_volume", 5.0e-3, 5.0e-5, "m^3"),
    *(d for d in AIR if d.parameter in ("ambient_pressure", "air_temperature", "supply_pressure")),
    Declared("valve_centre", "valve_centre", 5.0, 0.03, "V"),
    Declared("valve_frequency", "valve_frequency", 65.0, 6.0, "Hz"),
    # The tables were measured on a tank.
    Declared("mass_flow_gain", "mass_flow_gain", 1.0, 0.0, "1"),
)


FLOW_MAP = {0.6: 0.15, 0.75: 0.07, 0.95: 0.05, 1.25: 0.03, 1.8: 0.03, 3.0: 0.03}
"""Opening (V from the centre) -> half width, as a share of the flow, within which the core takes the valve's map to be
known; linear in between."""
PRESSURES = ("chamber_pressure_lower", "chamber_pressure_upper", "tank_pressure")
"""The signals of pressure sensors; on the platform with the leg's number behind."""
PRESSURE_SENSORS = {"offset": 1.0e3, "gain": 0.0025}
"""Half widths within which the core takes their zero (Pa) and gain to be known, where nothing is declared."""


def pressure_sensors(signals: Sequence[str]) -> dict[str, float]:
    """Half widths of the numbers of the pressure sensors among the signals, by the truth's names."""
    return {
        f"{signal}.{field}": half
        for signal in signals
        if signal.startswith(PRESSURES)
        for field, half in PRESSURE_SENSORS.items()
    }


def half_width(declared: Sequence[Declared], effect: Effect) -> float:
    """Half width of the number that an effect shifts; 0 for an extra term."""
    known = pressure_sensors([effect.target] if effect.target else [])
    known |= {d.name: d.half_width for d in declared if effect.shifts and d.name}
    return max((known.get(name, 0.0) for name in effect.names), default=0.0)


def drawn(
    truth: Truth, declared: Sequence[Declared], kept: Sequence[str], rng: np.random.Generator
) -> Truth:
    """The declared numbers anywhere within their half widths, but the `kept` ones as declared."""
    for entry in declared:
        position = float(rng.uniform(-1.0, 1.0))
        if entry.name is not None:
            off = 0.0 if entry.name in kept else position * entry.half_width
            truth = truth.having(**{entry.name: entry.value + off})
    return truth.having(creep_velocity=float(rng.uniform(2.5e-3, 3.2e-3)))


def as_declared(truth: Truth, declared: Sequence[Declared]) -> Truth:
    """The truth with every declared number as declared."""
    return truth.having(**{entry.name: entry.value for entry in declared if entry.name})
