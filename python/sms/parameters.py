"""The parameter table of the core (params.def), as Python sees it. Python keeps no second copy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
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
