"""The project's names of measured signals, their SI units, and what each kind of rig needs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Kind:
    """What can be measured on one kind of rig."""

    needed: tuple[str, ...]
    optional: tuple[str, ...]

    @property
    def signals(self) -> tuple[str, ...]:
        """Every signal of this kind, the needed ones first."""
        return self.needed + self.optional


SIGNAL_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "time": "s",
        "extension": "m",
        "chamber_pressure_lower": "Pa",
        "chamber_pressure_upper": "Pa",
        "rod_force": "N",
    }
)

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        # Without the upper chamber's pressure that chamber is taken as open to ambient.
        "cylinder": Kind(
            needed=("time", "extension", "chamber_pressure_lower", "rod_force"),
            optional=("chamber_pressure_upper",),
        ),
    }
)


def is_pressure(signal: str) -> bool:
    """Whether `signal` is a pressure, the only signals that may be measured against ambient."""
    return SIGNAL_UNITS[signal] == "Pa"


def column_name(signal: str) -> str:
    """The project's own column name of a signal: "extension [m]"."""
    return f"{signal} [{SIGNAL_UNITS[signal]}]"
