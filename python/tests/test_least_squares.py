"""Least squares within bounds: what is at a bound, and what only looks so on a range of many decades."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import Params
from sms.estimation.least_squares import Free, fit_windows

Array = NDArray[np.float64]
TURBULENCE, FRICTION = "supply_line_turbulence", "coulomb_force"


@dataclass(frozen=True)
class Straight:
    """Ten readings of each of two parameters, in units of their noise."""

    turbulence: float
    friction: float
    rows = 20
    noise = (1e5, 1.0)

    def evaluate(self, params: Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        values = (params[TURBULENCE] - self.turbulence, params[FRICTION] - self.friction)
        residual = np.repeat(np.divide(values, self.noise), 10)
        jacobian = np.zeros((self.rows, len(free)))
        for k, name in enumerate(free):
            own = 0 if name == TURBULENCE else 1
            jacobian[10 * own : 10 * own + 10, k] = 1.0 / self.noise[own]
        return residual, jacobian

    def errors(self, params: Params) -> Array:
        return self.evaluate(params)[0]


@pytest.mark.parametrize(
    ("turbulence", "friction", "held"),
    [
        (
            2e6,
            40.0,
            [False, False],
        ),  # a millionth of what is expected of it, and forty of its errors
        (-1e6, 40.0, [True, False]),
        (2e6, 600.0, [False, True]),
    ],
)
def test_what_a_bound_holds(turbulence: float, friction: float, held: list[bool]) -> None:
    start = Params()
    free = [
        Free(TURBULENCE, 0.0, 1e13, 1.0 / 2.5e12, 0.0),
        Free(FRICTION, 0.0, 500.0, 0.0, start[FRICTION]),
    ]
    found = fit_windows(Straight(turbulence, friction), start, free)
    assert found.at_bound == held
    assert found.params[TURBULENCE] == pytest.approx(max(turbulence, 0.0), rel=1e-3, abs=1.0)
    assert found.params[FRICTION] == pytest.approx(min(friction, 500.0), rel=1e-3)
