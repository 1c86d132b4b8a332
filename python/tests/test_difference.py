"""Two diagnoses of which one names an effect, and the other says how large it was at most, or was."""

from __future__ import annotations

import json

import numpy as np
import pytest
from sms.history import Answer, compare

from validation.trials.history import LEAK, drawn_answer, read

ERROR = 2e-11
"""kg/(s Pa), of the leak in either diagnosis."""


def well(estimate: float | None) -> Answer:
    """Nothing named; with so large a leak stated all the same."""
    content = json.loads(drawn_answer(np.random.default_rng(1), {}))
    assert content["verdict"] == "no-evidence"
    for hidden in content["still_hidden"]:
        hidden |= {"estimate": None, "standard_error": None}
        if hidden["parameter"] == LEAK and estimate is not None:
            hidden |= {"estimate": estimate, "standard_error": ERROR}
    return read(json.dumps(content), "well")


def ill(size: float) -> Answer:
    content = json.loads(drawn_answer(np.random.default_rng(2), {LEAK: 30.0}))
    (cause,) = content["causes"]
    cause["parameters"][0] |= {"value": size, "standard_error": ERROR}
    return read(json.dumps(content), "ill")


@pytest.mark.parametrize("before", [-1e-11, 0.0, 5e-11])
def test_what_is_named_is_compared_with_what_the_other_states_of_it(before: float) -> None:
    size = 9e-11
    (item,) = [i for i in compare(well(before), ill(size)).items if i.about == "cause"]
    assert (item.absent, item.selected) == ("a", True)
    assert item.difference == pytest.approx(size - before)
    assert item.z == pytest.approx((size - before) / (np.sqrt(2.0) * ERROR))
    assert (item.change == "changed") == (item.z > 2.3)
    (back,) = [i for i in compare(ill(size), well(before)).items if i.about == "cause"]
    assert (back.absent, back.z) == ("b", pytest.approx(-item.z))


def test_without_an_estimate_only_what_goes_beyond_its_limit_counts() -> None:
    (item,) = [i for i in compare(well(None), ill(9e-11)).items if i.about == "cause"]
    assert not item.selected
    limit = 3.0 * ERROR
    assert item.z == pytest.approx((9e-11 - limit) / (np.sqrt(2.0) * ERROR))


def test_being_named_by_one_of_two_counts_twice() -> None:
    """A difference of 2.1 standard errors is none, where being named chose it."""
    size = 8e-11
    before = size - 2.1 * np.sqrt(2.0) * ERROR
    (item,) = [i for i in compare(well(before), ill(size)).items if i.about == "cause"]
    assert item.p_value == pytest.approx(2.0 * 0.0357, rel=0.01)
    assert item.change != "changed"


def test_of_several_sizes_the_one_farthest_from_nothing_is_compared() -> None:
    """A supply line whose loss is all turbulent: its linear share, the first parameter, is nothing."""
    content = json.loads(drawn_answer(np.random.default_rng(2), {LEAK: 30.0}))
    (cause,) = content["causes"]
    linear = cause["parameters"][0] | {"value": 0.3 * ERROR, "standard_error": ERROR}
    turbulent = linear | {"name": "another_size", "old_value": 0.0, "value": 0.5}
    cause["parameters"] = [linear, turbulent | {"standard_error": 0.05}]
    (item,) = [
        i for i in compare(well(0.0), read(json.dumps(content), "ill")).items if i.about == "cause"
    ]
    assert (item.parameter, item.chosen_from, item.selected) == ("another_size", 2, False)
    assert item.z == pytest.approx((0.5 - 0.15) / (np.sqrt(2.0) * 0.05))
    assert item.p_value == pytest.approx(2.0 * 7.4e-7, rel=0.05)
    assert item.change == "changed"
