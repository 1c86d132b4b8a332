"""Sentences of a diagnosis that name an equation and the signal along which something is missing there."""

from __future__ import annotations

from dataclasses import replace

from sms.diagnosis.remainder import Hidden, Shape, Unexplained
from sms.diagnosis.result import Cause, ParameterValue
from sms.diagnosis.wording import explained
from sms.diagnosis.wording_simulated import remainder_in_words, sentence, shape_in_words

LOWER, READING = "balance of the lower tank", "reading of level_lower"
SHAPE = Shape(LOWER, "level_lower [m]", (0.0, 0.1), (0.0, 1e-6), (1e-7, 1e-7), "m^3/s", 0.43)


def hidden(shape: Shape) -> Hidden:
    return Hidden({LOWER: (0.6, 0.5, 0.7), READING: (0.5, 0.4, 0.6)}, {}, shape)


def test_the_curve_of_the_equation_itself_is_said_without_naming_it_twice() -> None:
    said = sentence("unknown", (), hidden(SHAPE))
    assert "arises in the balance of the lower tank; as a function of level lower it" in said
    assert said.count("lower tank") == 1
    assert "43 %" in said


def test_a_curve_in_another_equation_is_not_said_of_the_one_named() -> None:
    said = shape_in_words(hidden(replace(SHAPE, equation=READING)))
    assert "one in the reading of level lower over level lower explains most, 43 %" in said
    assert "it explains" not in said
    assert "(reading" not in said


def test_what_is_left_lies_along_a_signal_of_its_own_equation_only() -> None:
    left = Unexplained(
        {"level_lower": 1e-2}, {"level_lower": 1e-3}, {"level_lower": 2e-3}, 0.4, True, LOWER,
        "level_lower [m]", SHAPE, "",
    )  # fmt: skip
    units = {"level_lower": "m"}
    assert remainder_in_words(left, units).endswith(
        "the balance of the lower tank, along level lower."
    )
    other = replace(left, curve=replace(SHAPE, equation=READING))
    assert remainder_in_words(other, units).endswith("the balance of the lower tank.")


def test_further_parameters_of_a_cause_are_named_beside_its_size() -> None:
    leak = Cause(
        "valve_leakage", None, "missing term", "valve", "leakage past the valve spool", "",
        ("valve_leakage",), (),
        (
            ParameterValue("valve_leakage", 3.66e-10, 0.69e-10, "m^3/(s Pa)", 0.0),
            ParameterValue("leakage_critical_ratio", 0.0, 0.0, "1", 0.0),
            ParameterValue("leakage_index", 1.1, 0.21, "1", 2.0),
        ),
        1e-6, {}, "", 1.0,
    )  # fmt: skip
    assert explained(leak) == (
        "leakage past the valve spool (0.0366 ± 0.0069 l/s per bar, leakage critical ratio 0, "
        "leakage index 1.10 ± 0.21)"
    )
