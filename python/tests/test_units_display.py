"""Numbers for people: the unit, the digits, and what happens to NaN."""

from __future__ import annotations

import math
from functools import cache

import pint
import pytest
from sms.parameters import PARAMETERS
from sms.units_display import (
    MISSING,
    axis_unit,
    capital,
    display_unit,
    format_aligned,
    format_change,
    format_estimate,
    format_interval,
    format_p_value,
    format_percent,
    format_quantity,
    significant,
    words,
)

NAN = math.nan

# What each label means to pint, the independent reference of the factors.
MEANING = {
    "": "",
    "%": "percent",
    "% per mm": "percent/mm",
    "°": "degree",
    "N per bar": "N/bar",
    "N per m/s": "N/(m/s)",
    "l/s per bar": "liter/s/bar",
    "m/s²": "m/s^2",
    "s²/m": "s^2/m",
}
MAGNITUDES = (1e-9, 1e-3, 0.4, 3.0, 2e4, 1e6)


def shown_units() -> list[tuple[str, str, float]]:
    """(SI unit, label, factor) of everything that can be shown."""
    units = {row.unit for row in PARAMETERS.values()} | {"rad", "kg/s", "m^3/(s Pa)", "s"}
    found = {(u, display_unit(u, m)) for u in units for m in MAGNITUDES}
    found |= {(u, axis_unit(u)) for u in units}
    found.add(("1", display_unit("1", 0.01, "sensor_gain_rod_force")))
    return sorted((unit, shown.label, shown.factor) for unit, shown in found)


@cache
def registry() -> pint.UnitRegistry[float]:
    """Half a second to read; it is not changed."""
    return pint.UnitRegistry()


@pytest.mark.parametrize(("si_unit", "label", "factor"), shown_units())
def test_factor_agrees_with_pint(si_unit: str, label: str, factor: float) -> None:
    one = registry().Quantity(1.0, "" if si_unit == "1" else si_unit)
    expected = one.to(MEANING.get(label, label)).magnitude
    assert factor == pytest.approx(expected, rel=1e-12)


def test_every_parameter_has_a_readable_unit() -> None:
    for row in PARAMETERS.values():
        text = format_quantity(1.25, row.unit, row.name)
        assert text != MISSING and "^" not in text and "Pa" not in text.replace("µPa s", ""), (
            row.name
        )


def plain(text: str) -> str:
    """With the minus sign of the keyboard."""
    return text.replace("\N{MINUS SIGN}", "-")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (format_estimate(7.49e-6, 1.2e-7, "N/Pa"), "0.749 ± 0.012 N per bar"),
        (
            format_estimate(0.0102, 0.0003, "1", "sensor_gain_rod_force", signed=True),
            "+1.020 ± 0.030 %",
        ),
        (format_estimate(-0.0102, 0.0031, "1", "sensor_gain_extension"), "-1.02 ± 0.31 %"),
        (format_estimate(1.4, 0.2, "1", "stribeck_exponent"), "1.40 ± 0.20"),
        (format_estimate(38.0, 4.0, "N"), "38.0 ± 4.0 N"),
        (format_estimate(0.0995, 0.00996, "1"), "0.100 ± 0.010"),
        (format_estimate(38.0, 0.0, "N"), "38.0 N"),
        (format_estimate(38.0, NAN, "N", signed=True), "+38.0 N"),
        (format_estimate(0.1, 250.0, "N"), "0 ± 250 N"),
        (format_estimate(NAN, 1.0, "N"), MISSING),
        (format_change(0.025, 0.02487, 4e-6, "m"), "25.0000 → 24.8700 ± 0.0040 mm"),
        (format_change(0.025, 0.02487, 0.0, "m"), "25.00 → 24.87 mm"),
        (format_change(0.025, 0.025, 0.0, "m"), "25 → 25 mm"),
        (format_change(NAN, 0.025, 0.0, "m"), f"{MISSING} → 25.0 mm"),
        (format_quantity(800.0, "Pa"), "8.00 mbar"),
        (format_quantity(1e5, "Pa"), "1.00 bar"),
        (format_quantity(0.0, "N"), "0 N"),
        (format_quantity(math.inf, "N"), MISSING),
        (format_quantity(5.0, "1/m"), "0.500 % per mm"),
        (format_quantity(3.0, "furlong^2"), "3.00 furlong²"),
        (significant(999.6), "1000"),
        (significant(3.2e-9), "3.20e-9"),
        (format_percent(-0.655, signed=True), "-66 %"),
        (format_percent(-0.001, signed=True), "0 %"),
        (format_interval(-0.7, 0.02, signed=True), "-70 to +2 %"),
        (format_interval(NAN, 0.02), f"{MISSING} to 2 %"),
        (format_p_value(2e-9), "p < 0.001"),
        (format_p_value(0.0312), "p = 0.031"),
        (format_p_value(NAN), MISSING),
        (capital("seal_friction grows"), "Seal friction grows"),
        (capital(""), ""),
        (words("chamber_pressure_lower"), "chamber pressure lower"),
    ],
)
def test_text(text: str, expected: str) -> None:
    assert plain(text) == expected


def test_aligned_numbers_share_unit_and_decimals() -> None:
    assert [plain(t) for t in format_aligned([4.01, 0.584, NAN], "N")] == [
        "4.01 N",
        "0.58 N",
        MISSING,
    ]
    assert format_aligned([], "N") == []
    assert [plain(t) for t in format_aligned([0.0, 0.0], "N")] == ["0 N", "0 N"]


def test_value_and_error_share_their_last_digit() -> None:
    """Whatever the size: the value is rounded where the error ends, and stays within it."""
    for exponent in range(-3, 6):
        error = 1.3 * 10.0**-exponent
        text = plain(format_estimate(2.0 + error, error, "s/m")).split(" ")
        value, shown = float(text[0]), float(text[2])
        assert abs(value - (2.0 + error)) <= 0.5 * 10.0 ** -(exponent + 1) + 1e-9
        assert shown == pytest.approx(error, rel=0.05)
