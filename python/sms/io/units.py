"""Numbers with units: from what a person writes ("25 mm") to SI and back, by `pint`.

SI units are given as pint-readable text ("m", "N s/m", "s^2/m"); "1" is dimensionless.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pint
from numpy.typing import NDArray

from sms.errors import InputError, nearest

_NUMBER_AND_UNIT = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_DIMENSIONLESS = ("", "1", "-")
_COMMON_UNITS = (
    *("s", "ms", "min", "m", "mm", "cm", "m/s", "mm/s", "Pa", "kPa", "MPa", "hPa", "bar", "mbar"),
    *("psi", "N", "kN", "mN", "lbf", "N s/m", "kg", "g", "K", "degC", "V", "mV", "deg", "rad"),
)
_ANGLES = ("radian", "degree", "turn", "arcminute", "arcsecond")
_GAUGE_UNIT = re.compile(r"(m?bar|psi|[kMh]?Pa)[ _]?\(?(g|gauge)\)?", re.IGNORECASE)


@cache
def _registry() -> pint.UnitRegistry[Any]:
    return pint.UnitRegistry()


def _parse_unit(unit: str, where: str) -> pint.Unit:
    if unit in _DIMENSIONLESS:
        return _registry().Unit("")
    gauge = _GAUGE_UNIT.fullmatch(unit)  # first: pint would read "bar(g)" as bar times gram
    if not gauge:
        try:
            return _registry().Unit(unit)
        except Exception:  # pint answers bad text with many kinds, AssertionError for "m/" too
            pass
    if gauge:
        remedy = f"write '{gauge[1]}', and gauge = true in [signals]"
    elif unit.startswith(","):
        remedy = "write numbers with a decimal point"
    elif (near := nearest(unit, _COMMON_UNITS)) is not None:
        remedy = f"did you mean '{near}'?"
    else:
        remedy = 'write it like "mm", "bar" or "N s/m"'
    raise InputError(f"{where}: '{unit}' is not a unit; {remedy}")


def _check_dimension(unit: str, si_unit: str, where: str) -> pint.Unit:
    """The parsed unit; InputError unless it measures the same thing as `si_unit`."""
    parsed = _parse_unit(unit, where)
    if parsed.dimensionality != _parse_unit(si_unit, where).dimensionality:
        expected = "no unit (a plain number)" if si_unit == "1" else f"a unit like '{si_unit}'"
        raise InputError(f"{where}: the unit '{unit}' does not fit; {expected} is expected here")
    return parsed


def split_quantity(text: str | float, si_unit: str, where: str) -> tuple[float, str]:
    """Split "25 mm" into (25.0, "mm"). A plain number is right only for dimensionless quantities.

    `where` says file, table and key, and opens the sentence of the InputError.
    """
    if isinstance(text, (int, float)):
        if si_unit != "1":
            raise InputError(f'{where}: {text} has no unit; write it like "{text} {si_unit}"')
        return float(text), ""
    match = _NUMBER_AND_UNIT.fullmatch(text)
    if match is None:
        example = "0.9" if si_unit == "1" else f"0.1 {si_unit}"
        raise InputError(f'{where}: "{text}" is no number with a unit; write it like "{example}"')
    number, unit = float(match[1]), match[2]
    if not unit and si_unit != "1":
        raise InputError(f'{where}: "{text}" has no unit; write it like "{number:g} {si_unit}"')
    if not np.isfinite(number):
        raise InputError(f'{where}: "{text}" is too large a number')
    return number, unit


def to_si(text: str | float, si_unit: str, where: str) -> float:
    """The value of "25 mm" in `si_unit` ("m"): 0.025. InputError when the dimension is another."""
    number, unit = split_quantity(text, si_unit, where)
    return float(array_to_si(np.array([number]), unit, si_unit, where)[0])


def interval_to_si(text: str | float, si_unit: str, where: str) -> float:
    """As `to_si`, for a difference such as an uncertainty: "2 degC" are 2 K, not 275.15 K."""
    number, unit = split_quantity(text, si_unit, where)
    ends = array_to_si(np.array([0.0, number]), unit, si_unit, where)
    return float(ends[1] - ends[0])


def array_to_si(
    values: NDArray[np.float64], unit: str, si_unit: str, where: str
) -> NDArray[np.float64]:
    """Convert `values`, any shape, from `unit` to `si_unit`. InputError for another dimension."""
    parsed = _check_dimension(unit, si_unit, where)
    with np.errstate(over="ignore"):  # infinity is refused where the range is known
        converted = _registry().Quantity(values, parsed).to(_parse_unit(si_unit, where)).magnitude
    return np.asarray(converted, dtype=np.float64)


def si_unit_of(unit: str, where: str) -> str:
    """The unit without prefix in which a quantity of `unit` is kept: "mm" "m", "bar" "Pa"."""
    parsed = _parse_unit(unit, where)
    dimension = parsed.dimensionality
    if any(word in str(parsed) for word in _ANGLES) and parsed.dimensionless:
        return "rad"
    for known in ("1", "s", "m", "m/s", "m/s^2", "Pa", "N", "V", "K", "kg", "kg/s"):
        if dimension == _parse_unit(known, where).dimensionality:
            return known
    if dimension == _parse_unit("rad/s", where).dimensionality:
        return "Hz" if unit.lower().endswith("hz") else "rad/s"
    return str(_registry().Quantity(1.0, _parse_unit(unit, where)).to_base_units().units)


def base_exponents(si_unit: str) -> dict[str, int]:
    """Powers of kg, m, s, A, K, mol, cd and rad of a unit of the core, in which no factor is hidden: "N s/m"."""
    short = {"kilogram": "kg", "meter": "m", "second": "s", "ampere": "A", "kelvin": "K"}
    short |= {"mole": "mol", "candela": "cd", "radian": "rad"}
    one = _registry().Quantity(1.0, _parse_unit(si_unit, "params.def")).to_base_units()
    return {short[str(name)]: int(f"{power:g}") for name, power in one.unit_items()}


def from_si(value: float, unit: str, si_unit: str, where: str) -> str:
    """Text for `value` (in `si_unit`) in a person's unit: 0.025 (m) with "mm" is "25 mm"."""
    parsed = _check_dimension(unit, si_unit, where)
    quantity = _registry().Quantity(value, _parse_unit(si_unit, where)).to(parsed)
    return f"{quantity.magnitude:.12g} {unit}".strip()


def interval_from_si(value: float, unit: str, si_unit: str, where: str) -> str:
    """As `from_si`, for a difference: 2 K are "2 degC"."""
    step = 1.0 / interval_to_si(f"1 {unit}", si_unit, where)
    return f"{value * step:.12g} {unit}".strip()


def split_column_name(name: str) -> tuple[str, str | None]:
    """Split "stroke [mm]" into ("stroke", "mm"); the unit is None when there is no bracket."""
    match = re.fullmatch(r"\s*(.*?)\s*\[([^\[\]]*)\]\s*", name, re.DOTALL)
    if match is None:
        return name.strip(), None
    return match[1], match[2].strip()
