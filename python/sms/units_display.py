"""How a number is shown to a person: 7.5e-6 N/Pa is "0.75 N per bar", a gain of 0.0102 "+1.02 %".

Inside, everything is SI; only text, tables and plots pass through here. A value and its standard
error are rounded together: the error to two significant digits, the value to the same place.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

MISSING = "n/a"
"""Stands where a number is not a number."""

_MINUS = "\N{MINUS SIGN}"
_PLUS_MINUS = "\N{PLUS-MINUS SIGN}"
_ARROW = "\N{RIGHTWARDS ARROW}"


@dataclass(frozen=True)
class DisplayUnit:
    """A unit for people. `factor` times the SI value is the number shown; `label` follows it."""

    label: str
    factor: float

    def scale(self, value: float) -> float:
        """The number shown for `value` in SI."""
        return value * self.factor


# SI unit -> (smallest magnitude in SI from which on it is used, unit), the largest unit first.
_SCALES: Mapping[str, tuple[tuple[float, DisplayUnit], ...]] = MappingProxyType(
    {
        "m": ((1.0, DisplayUnit("m", 1.0)), (0.0, DisplayUnit("mm", 1e3))),
        "m/s": ((0.5, DisplayUnit("m/s", 1.0)), (0.0, DisplayUnit("mm/s", 1e3))),
        "s": ((0.1, DisplayUnit("s", 1.0)), (0.0, DisplayUnit("ms", 1e3))),
        "Pa": ((1e4, DisplayUnit("bar", 1e-5)), (0.0, DisplayUnit("mbar", 1e-2))),
        "N": ((1e4, DisplayUnit("kN", 1e-3)), (0.0, DisplayUnit("N", 1.0))),
        "kg": ((0.1, DisplayUnit("kg", 1.0)), (0.0, DisplayUnit("g", 1e3))),
        "N/Pa": ((0.0, DisplayUnit("N per bar", 1e5)),),
        "1/m": ((0.0, DisplayUnit("% per mm", 0.1)),),
        "N s/m": ((0.0, DisplayUnit("N per m/s", 1.0)),),
        "m/s^2": ((0.0, DisplayUnit("m/s²", 1.0)),),
        "s^2/m": ((0.0, DisplayUnit("s²/m", 1.0)),),
        "rad": ((0.0, DisplayUnit("°", 180.0 / math.pi)),),
        "Pa s": ((0.0, DisplayUnit("µPa s", 1e6)),),
        "Pa s/kg": ((0.0, DisplayUnit("bar s/kg", 1e-5)),),
        "Pa s^2/kg^2": ((0.0, DisplayUnit("bar s²/kg²", 1e-5)),),
        "1/Pa": ((0.0, DisplayUnit("% per bar", 1e7)),),
        "kg/(s Pa)": ((0.0, DisplayUnit("g/s per bar", 1e8)),),
        "kg/s": ((0.0, DisplayUnit("g/s", 1e3)),),
        "m/V": ((0.0, DisplayUnit("mm/V", 1e3)),),
        "m/V^2": ((0.0, DisplayUnit("µm/V²", 1e6)),),
        "m/V^3": ((0.0, DisplayUnit("µm/V³", 1e6)),),
        "m^2": ((0.0, DisplayUnit("mm²", 1e6)),),
        "m^3/(s V)": ((0.0, DisplayUnit("ml/s per V", 1e6)),),
        "m^3": ((1e-3, DisplayUnit("l", 1e3)), (0.0, DisplayUnit("cm³", 1e6))),
        "m^3/(s Pa)": ((0.0, DisplayUnit("l/s per bar", 1e8)),),
        "1": ((0.0, DisplayUnit("", 1.0)),),
    }
)
# Axes keep one unit whatever the size of the numbers on them.
_AXES: Mapping[str, DisplayUnit] = MappingProxyType(
    {
        "m": DisplayUnit("mm", 1e3),
        "m/s": DisplayUnit("mm/s", 1e3),
        "s": DisplayUnit("s", 1.0),
        "Pa": DisplayUnit("bar", 1e-5),
        "N": DisplayUnit("N", 1.0),
        "kg": DisplayUnit("kg", 1.0),
    }
)
_PERCENT = DisplayUnit("%", 100.0)
_RELATIVE = ("sensor_gain_",)


def display_unit(unit: str, magnitude: float = math.nan, name: str = "") -> DisplayUnit:
    """The unit in which a quantity of SI unit `unit` is shown.

    `magnitude` (SI) chooses between mm and m and the like; NaN takes the smallest. `name` is the
    parameter's: a sensor's gain has no unit but is shown in percent.
    """
    if unit == "1" and name.startswith(_RELATIVE):
        return _PERCENT
    scales = _SCALES.get(unit)
    if scales is None:
        return DisplayUnit(unit.replace("^2", "²").replace("^3", "³"), 1.0)
    for smallest, display in scales:
        if abs(magnitude) >= smallest:
            return display
    return scales[-1][1]


def axis_unit(unit: str) -> DisplayUnit:
    """The unit of a plot's axis for a signal of SI unit `unit`."""
    return _AXES.get(unit) or display_unit(unit)


def round_number(value: float, decimals: int, signed: bool = False) -> str:
    """`value` with so many decimals (negative ones round to tens), a true minus, no "-0"."""
    if not math.isfinite(value):
        return MISSING
    rounded = round(value, decimals) + 0.0
    text = f"{abs(rounded):.{max(decimals, 0)}f}"
    if rounded < 0.0:
        return _MINUS + text
    return f"+{text}" if signed and rounded > 0.0 else text


def significant(value: float, digits: int = 3) -> str:
    """`value` with so many significant digits: "3.5", "0.00012"; powers of ten only when tiny."""
    if not math.isfinite(value):
        return MISSING
    if value == 0.0:
        return "0"
    if abs(value) < 1e-5 or abs(value) >= 1e7:
        mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
        return f"{mantissa}e{int(exponent)}".replace("-", _MINUS)
    return round_number(value, _decimals(value, digits))


def _decimals(value: float, digits: int) -> int:
    """Decimals that leave `digits` significant ones; the exponent is that of the rounded value."""
    exponent = int(f"{abs(value):.{digits - 1}e}".partition("e")[2])
    return digits - 1 - exponent


def _has_error(standard_error: float) -> bool:
    return math.isfinite(standard_error) and standard_error > 0.0


def _join(number: str, label: str) -> str:
    return f"{number} {label}" if label else number


def format_quantity(value: float, unit: str, name: str = "", digits: int = 3) -> str:
    """`value` (SI `unit`) for a person: "3.51 N", "25.0 mm", MISSING for NaN."""
    if not math.isfinite(value):
        return MISSING
    display = display_unit(unit, value, name)
    return _join(significant(display.scale(value), digits), display.label)


def format_aligned(
    values: Sequence[float], unit: str, name: str = "", digits: int = 3
) -> list[str]:
    """Numbers that are read together: one unit and one number of decimals, set by the largest."""
    largest = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    display = display_unit(unit, largest, name)
    decimals = _decimals(display.scale(largest), digits) if largest > 0.0 else 0
    return [
        _join(round_number(display.scale(value), decimals), display.label)
        if math.isfinite(value)
        else MISSING
        for value in values
    ]


def format_estimate(
    value: float, standard_error: float, unit: str, name: str = "", signed: bool = False
) -> str:
    """A value and its standard error (SI `unit`): "0.749 ± 0.012 N per bar", "+1.02 ± 0.03 %".

    Without a usable error (zero, NaN, infinite) the value stands alone with three digits.
    """
    if not math.isfinite(value):
        return MISSING
    if not _has_error(standard_error):
        text = format_quantity(value, unit, name)
        return f"+{text}" if signed and value > 0.0 else text
    display = display_unit(unit, max(abs(value), standard_error), name)
    error = display.scale(standard_error)
    decimals = _decimals(error, 2)
    if not -3 <= decimals <= 6:
        number = f"{significant(display.scale(value))} {_PLUS_MINUS} {significant(error, 2)}"
    else:
        shown = round_number(display.scale(value), decimals, signed)
        number = f"{shown} {_PLUS_MINUS} {round_number(error, decimals)}"
    return _join(number, display.label)


def format_change(old: float, new: float, standard_error: float, unit: str, name: str = "") -> str:
    """A parameter before and after: "25.000 → 24.871 ± 0.004 mm"."""
    if not (math.isfinite(old) and math.isfinite(new)):
        return f"{format_quantity(old, unit, name)} {_ARROW} {format_quantity(new, unit, name)}"
    display = display_unit(unit, max(abs(old), abs(new)), name)
    before, after = display.scale(old), display.scale(new)
    has_error = _has_error(standard_error)
    error = display.scale(standard_error) if has_error else abs(after - before) or abs(after) or 1.0
    decimals = max(_decimals(error, 2), 0)

    def shown(value: float) -> str:
        return round_number(value, decimals) if decimals <= 6 else significant(value, 4)

    text = f"{shown(before)} {_ARROW} {shown(after)}"
    if has_error:
        small = round_number(error, decimals) if decimals <= 6 else significant(error, 2)
        text += f" {_PLUS_MINUS} {small}"
    return _join(text, display.label)


def format_percent(share: float, decimals: int = 0, signed: bool = False) -> str:
    """A share of one: "66 %"."""
    number = round_number(100.0 * share, decimals, signed)
    return number if number == MISSING else f"{number} %"


def format_interval(low: float, high: float, signed: bool = False) -> str:
    """Two shares of one: "53 to 75 %"."""
    return f"{round_number(100.0 * low, 0, signed)} to {format_percent(high, 0, signed)}"


def format_p_value(p_value: float) -> str:
    """A probability: "p = 0.03", "p < 0.001"; MISSING for NaN."""
    if not math.isfinite(p_value):
        return MISSING
    if p_value < 1e-3:
        return "p < 0.001"
    return f"p = {significant(p_value, 2)}"


def capital(text: str) -> str:
    """`text` as it opens a sentence or a heading; identifiers as words."""
    return words(text[:1].upper() + text[1:])


def words(identifier: str) -> str:
    """An identifier as words: "pressure_dependent_friction" "pressure dependent friction"."""
    return identifier.replace("_", " ").strip()
