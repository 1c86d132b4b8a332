"""What the core hands out is finite, or its status says why not: at any input that a float can hold."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import sms
from sms import _core

from validation.random_cases import draw

CASES = 20_000


@pytest.mark.parametrize("largest", [1e3, 1e6, 1e307])
def test_forward_dynamics_is_finite_or_says_why_not(largest: float) -> None:
    random = draw("forward dynamics")
    q = random.uniform(-1.0, 1.0, (CASES, 3)) * [1.5, 1.5, 1.0] + [0.0, 0.0, 1.0]
    rate = random.normal(size=(CASES, 3)) * 10.0 ** random.uniform(-3.0, 3.0, (CASES, 1))
    force = random.uniform(-largest, largest, (CASES, 3))
    none = np.zeros((CASES, 3))
    answer, status = _core.forward_dynamics(sms.Params(), 0, q, rate, force, none, none)
    assert np.all(np.isfinite(np.asarray(answer)[np.asarray(status).ravel() == 0]))
    assert np.any(np.asarray(status) == 0) or largest > 1e300


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", range(5))
@pytest.mark.parametrize("equation", [_core.friction, _core.rod_force])
def test_a_force_of_what_is_no_number_is_none(
    equation: Callable[..., float], place: int, wrong: float
) -> None:
    piston = [0.2, 0.1, 0.5, 4e5, 3e5]  # extension, velocity, acceleration, pressures
    assert np.isfinite(equation(sms.Params(), *piston))
    piston[place] = wrong
    assert np.isnan(equation(sms.Params(), *piston))
