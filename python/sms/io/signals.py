"""The measured signals, as the core's signals.def has them, and which of them each kind of rig needs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from sms import _core
from sms._core import SignalInfo


@dataclass(frozen=True)
class Kind:
    """What can be measured on one kind of rig."""

    needed: tuple[str, ...]
    optional: tuple[str, ...]

    @property
    def signals(self) -> tuple[str, ...]:
        """Every signal of this kind, the needed ones first."""
        return self.needed + self.optional


def with_controller_simulated(kind: Kind, commanded: bool = False) -> Kind:
    """The same where a simulated controller drives the valve: its set-point is needed, the command is not.

    commanded: in other records it is not simulated, so that they need their command.
    """
    setpoints = tuple(s for s in kind.optional if without_leg(s) == "setpoint")
    commands = tuple(s for s in kind.needed if without_leg(s) == "valve_command")
    spared = () if commanded else commands
    return Kind(
        tuple(s for s in kind.needed if s not in spared) + setpoints,
        spared + tuple(s for s in kind.optional if s not in setpoints),
    )


LEGS = (1, 2, 3)
"""The platform's actuators; a signal of one of them ends in its number: extension_2."""

SIGNALS: Mapping[str, SignalInfo] = MappingProxyType({s.name: s for s in _core.signal_table()})
"""What signals.def says of each signal: unit, label, usual range; without the numbers of legs."""


def of_legs(*signals: str) -> tuple[str, ...]:
    """The names of signals that each leg of the platform has: extension -> extension_1 .. extension_3."""
    return tuple(f"{signal}_{leg}" for signal in signals for leg in LEGS)


def without_leg(signal: str) -> str:
    """extension_2 -> extension"""
    stem, _, leg = signal.rpartition("_")
    return stem if leg in map(str, LEGS) else signal


SIGNAL_UNITS: Mapping[str, str] = MappingProxyType(
    {"time": "s"}
    | {name: signal.unit for name, signal in SIGNALS.items()}
    | {leg: s.unit for name, s in SIGNALS.items() if s.of_leg for leg in of_legs(name)}
)
"""SI, of every column that a record can have."""


def with_units(*signals: str) -> tuple[tuple[str, str], ...]:
    """("extension", "m"), ..."""
    return tuple((signal, SIGNAL_UNITS[signal]) for signal in signals)


def label(signal: str) -> str:
    """In words: "lower chamber pressure", "position of leg 2"."""
    words = SIGNALS[without_leg(signal)].label
    return words if without_leg(signal) == signal else f"{words} of leg {signal[-1]}"


SIMULATED = ("tank", "bench", "platform")
"""Kinds whose records are held against a simulation from the first sample on."""

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        # Without the upper chamber's pressure that chamber is taken as open to ambient.
        "cylinder": Kind(
            needed=("time", "extension", "chamber_pressure_lower", "rod_force"),
            optional=("chamber_pressure_upper",),
        ),
        # A tank charged or discharged through a component whose opening is held.
        "flow_test": Kind(
            needed=("time", "tank_pressure"),
            optional=("supply_pressure", "tank_temperature"),
        ),
        "tank": Kind(
            needed=("time", "valve_command", "tank_pressure"),
            optional=("tank_temperature", "supply_pressure"),
        ),
        "bench": Kind(
            needed=(
                "time",
                "valve_command",
                "extension",
                "chamber_pressure_lower",
                "chamber_pressure_upper",
            ),
            optional=("supply_pressure", "setpoint", "rod_force", "spool_position"),
        ),
        # The valve alone, its spool's position measured.
        "spool_test": Kind(needed=("time", "valve_command", "spool_position"), optional=()),
        "platform": Kind(
            needed=(
                "time",
                *of_legs(
                    "valve_command",
                    "extension",
                    "chamber_pressure_lower",
                    "chamber_pressure_upper",
                ),
            ),
            optional=("supply_pressure", "roll", "pitch", *of_legs("setpoint")),
        ),
    }
)


def is_pressure(signal: str) -> bool:
    """Whether `signal` is a pressure, the only signals that may be measured against ambient."""
    return SIGNAL_UNITS[signal] == "Pa"


def column_name(signal: str) -> str:
    """The project's own column name of a signal: "extension [m]"."""
    return f"{signal} [{SIGNAL_UNITS[signal]}]"
