"""Units: what a person writes, converted to SI and back."""

from __future__ import annotations

import numpy as np
import pytest
from sms.io import InputError
from sms.io.units import (
    array_to_si,
    from_si,
    interval_from_si,
    interval_to_si,
    si_unit_of,
    split_column_name,
    to_si,
)

from validation.random_cases import draw

PAIRS = [
    ("mm", "m"),
    ("inch", "m"),
    ("bar", "Pa"),
    ("psi", "Pa"),
    ("kN", "N"),
    ("lbf", "N"),
    ("ms", "s"),
    ("mm/s", "m/s"),
    ("N s/mm", "N s/m"),
    ("ms^2/mm", "s^2/m"),
    ("g", "kg"),
    ("degC", "K"),
    ("percent", "1"),
    ("N/bar", "N/Pa"),
]


@pytest.mark.parametrize(("text", "unit", "expected"), [
    ("25 mm", "m", 0.025),
    ("25mm", "m", 0.025),
    ("1.2 bar", "Pa", 120e3),
    ("-4.5e-1 kN", "N", -450.0),
    (".5 s", "s", 0.5),
    ("20 degC", "K", 293.15),
    ("1 percent", "1", 0.01),
    ("0.9", "1", 0.9),
    (0.9, "1", 0.9),
    ("3 N·s/m", "N s/m", 3.0),
    ("7 µs", "s", 7e-6),
])  # fmt: skip
def test_what_a_person_writes_becomes_si(text: str | float, unit: str, expected: float) -> None:
    assert to_si(text, unit, "here") == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(("unit", "si_unit"), PAIRS)
def test_there_and_back_again_with_random_values(unit: str, si_unit: str) -> None:
    random = draw(f"units {unit}")
    values = random.normal(size=20) * 10.0 ** random.uniform(-6, 6, size=20)
    for value in values.tolist():
        written = f"{value!r} {unit}"
        back = from_si(to_si(written, si_unit, "here"), unit, si_unit, "here")
        # from_si writes 12 digits; an offset unit loses the digits of its offset besides.
        assert float(back.split()[0]) == pytest.approx(value, rel=1e-11, abs=1e-10)
        step = interval_from_si(interval_to_si(written, si_unit, "here"), unit, si_unit, "here")
        assert float(step.split()[0]) == pytest.approx(value, rel=1e-11, abs=1e-10)


def test_arrays_convert_like_single_values() -> None:
    values = draw("arrays").normal(size=100)
    together = array_to_si(values, "psi", "Pa", "here")
    single = [to_si(f"{value!r} psi", "Pa", "here") for value in values.tolist()]
    np.testing.assert_array_equal(together, single)


def test_a_difference_of_temperature_has_no_offset() -> None:
    assert interval_to_si("2 degC", "K", "here") == pytest.approx(2.0, rel=1e-12)
    assert interval_from_si(2.0, "degC", "K", "here") == "2 degC"


@pytest.mark.parametrize(("text", "unit", "words"), [
    ("25 kg", "m", ["rig.toml, [parameters] bore", "'kg'", "does not fit", "'m'"]),
    ("25", "m", ["has no unit", '"25 m"']),
    (25, "m", ["25 has no unit", '"25 m"']),
    ("25 mmm", "m", ["'mmm' is not a unit", "did you mean 'mm'?"]),
    ("3 Bar", "Pa", ["'Bar' is not a unit", "did you mean 'bar'?"]),
    ("3 barg", "Pa", ["'barg' is not a unit", "gauge = true"]),
    ("3 bar(g)", "Pa", ["'bar(g)' is not a unit", "gauge = true"]),
    ("much", "m", ["is no number with a unit", '"0.1 m"']),
    ("much", "1", ["is no number with a unit", '"0.9"']),
    ("1,5 mm", "m", ["',5 mm' is not a unit", "decimal point"]),
    ("3 m/", "m", ["'m/' is not a unit"]),
    ("1 mm", "1", ["'mm' does not fit", "plain number"]),
    ("1e999 m", "m", ["too large"]),
])  # fmt: skip
def test_a_wrong_quantity_is_named_with_its_place(
    text: str | float, unit: str, words: list[str]
) -> None:
    with pytest.raises(InputError) as caught:
        to_si(text, unit, "rig.toml, [parameters] bore")
    for word in ["rig.toml, [parameters] bore", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize(("name", "expected"), [
    ("stroke [mm]", ("stroke", "mm")),
    ("  pressure sensor [V] ", ("pressure sensor", "V")),
    ("friction[N s/m]", ("friction", "N s/m")),
    ("stroke", ("stroke", None)),
    ("ratio []", ("ratio", "")),
])  # fmt: skip
def test_column_names_carry_their_unit(name: str, expected: tuple[str, str | None]) -> None:
    assert split_column_name(name) == expected


@pytest.mark.parametrize(
    ("unit", "si"),
    [
        *(
            ("mm", "m"),
            ("bar", "Pa"),
            ("deg", "rad"),
            ("percent", "1"),
            ("1", "1"),
            ("deg/s", "rad/s"),
        ),
        *(("kHz", "Hz"), ("mV", "V"), ("g/s", "kg/s"), ("m^3/s", "meter ** 3 / second")),
    ],
)
def test_the_unit_in_which_a_quantity_is_kept(unit: str, si: str) -> None:
    assert si_unit_of(unit, "here") == si
