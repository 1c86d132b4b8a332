"""The parameter table of the core (params.def), as Python sees it. Python keeps no second copy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from sms import _core


@dataclass(frozen=True)
class Parameter:
    """One row of params.def. Numbers are in `unit`, an SI unit as pint-readable text."""

    name: str
    unit: str  #: "m", "N s/m", ...; "1" is dimensionless
    lower: float  #: smallest value allowed
    default: float
    upper: float  #: largest value allowed
    uncertainty: float  #: half width within which the default may be moved unasked
    source: str  #: published (where), derived (how) or assumed (why)
    doc: str


def _read_table() -> Mapping[str, Parameter]:
    rows = (
        Parameter(
            name=row.name,
            unit=row.unit,
            lower=row.lower,
            default=row.default,
            upper=row.upper,
            uncertainty=row.uncertainty,
            source=row.source,
            doc=row.doc,
        )
        for row in _core.parameter_table()
    )
    return MappingProxyType({row.name: row for row in rows})


PARAMETERS: Mapping[str, Parameter] = _read_table()
"""Every parameter of the model by its name, in the order of params.def."""

FLOW_MAP = tuple(name for name in PARAMETERS if name.startswith("flow_map_"))
"""Relative errors of the flow through the valve, at some openings."""
FRICTION_MAP = tuple(name for name in PARAMETERS if name.startswith("friction_map_"))
"""Relative errors of the friction curve, at some speeds."""
MAPS = FLOW_MAP + FRICTION_MAP
"""Of curves that were measured, none of them exactly."""
LINEARITY = tuple(
    name
    for name, row in PARAMETERS.items()
    if name.startswith("sensor_linearity_") and row.uncertainty > 0.0
)
"""By how much sensors deviate from their best straight lines, of their spans."""
SENSORS = tuple(n for n, p in PARAMETERS.items() if n.startswith("sensor_") and p.uncertainty > 0.0)
"""Zero and gain of pressure sensors, which are calibrated to so much, and the linearity of all."""
GEOMETRY = tuple(n for n in PARAMETERS if "_joint_" in n or "_length_offset_" in n)
"""Where the joints are, and by how much the links are longer than these are apart at rest."""
SPECIMENS = MAPS + tuple(n for n in SENSORS if n.rpartition("_")[2] not in ("roll", "pitch"))
"""What two valves, cylinders or sensors of one type differ by: each leg of a machine with three has its own."""


# ---- machines with three legs ----------------------------------------------------------------------


def common_parameter(name: str) -> str:
    """ "coulomb_force:2", by how much that of leg 2 is larger, -> "coulomb_force", that of all legs."""
    return name.partition(":")[0]


def is_of_leg(name: str) -> bool:
    """Whether a parameter is what one leg has more than all."""
    return ":" in name


def _of_legs() -> Mapping[str, Parameter]:
    """What one leg has more: none, and within bounds in which the leg's own value keeps to those of params.def.

    What is known of a curve or a sensor is known of each leg's own, and nothing besides of what they have in common.
    """
    common = {n: replace(row, uncertainty=0.0) for n, row in PARAMETERS.items() if n in SPECIMENS}
    more = {
        f"{name}:{leg}": replace(
            row,
            name=f"{name}:{leg}",
            lower=row.lower - row.default,
            default=0.0,
            upper=row.upper - row.default,
            uncertainty=row.uncertainty if name in SPECIMENS else 0.0,
        )
        for name, row in PARAMETERS.items()
        for leg in (1, 2, 3)
    }
    return MappingProxyType(dict(PARAMETERS) | common | more)


LEG_PARAMETERS: Mapping[str, Parameter] = _of_legs()
"""The parameters of a machine with three legs: those of all, and those of each."""
