"""Least squares within bounds: what is at a bound, and what only looks so on a range of many decades."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import Params
from sms.estimation.least_squares import Free, fit_windows

from validation.random_cases import draw

Array = NDArray[np.float64]
TURBULENCE, FRICTION = "supply_line_turbulence", "coulomb_force"


@dataclass(frozen=True)
class Straight:
    """Ten readings of each of two parameters, in units of their noise."""

    turbulence: float
    friction: float
    misses: float = 0.0
    """What no value makes up for: of every reading, in units of its noise."""
    rows = 20
    noise = (1e5, 1.0)

    def evaluate(self, params: Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        values = (params[TURBULENCE] - self.turbulence, params[FRICTION] - self.friction)
        residual = np.repeat(np.divide(values, self.noise), 10)
        residual += self.misses * (-1.0) ** np.arange(self.rows)
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


def test_a_stated_value_is_where_the_minimum_is_however_much_is_left() -> None:
    """A newton away is worth 10 of a chi-square of 2,000: nothing for a comparison."""
    problem, start = Straight(2e6, 40.0, misses=10.0), Params()
    start[FRICTION] = 41.0
    free = [Free(FRICTION, 0.0, 500.0, 0.0, 41.0)]
    compared = fit_windows(problem, start, free)
    stated = fit_windows(problem, start, free, window=np.repeat(np.arange(5), 4))
    assert compared.params[FRICTION] == 41.0
    assert stated.params[FRICTION] == pytest.approx(40.0, abs=1e-6)
    assert stated.counted is None


@dataclass(frozen=True)
class Breaking:
    """Windows of four readings, straight lines of two parameters around 40 and 60 N; of some the piston breaks away,
    and they miss by far more, above the Coulomb force at which the others begin."""

    lines: Array  # (windows, 4, 2)
    breaking: int
    names = (FRICTION, "stiction_force")
    begin = 38.0
    steep = 1e3

    @property
    def rows(self) -> int:
        return 4 * len(self.lines)

    @property
    def window(self) -> NDArray[np.int64]:
        return np.repeat(np.arange(len(self.lines)), 4)

    def evaluate(self, params: Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        off = np.array([params[n] for n in self.names]) - (40.0, 60.0)
        residual, slope = self.lines @ off, self.lines.copy()
        above = max(0.0, params[FRICTION] - self.begin)
        residual[: self.breaking] += self.steep * above
        if above > 0.0:
            slope[: self.breaking, :, 0] += self.steep
        columns = [self.names.index(n) for n in free]
        return residual.reshape(-1), slope.reshape(self.rows, 2)[:, columns]

    def errors(self, params: Params) -> Array:
        return self.evaluate(params)[0]


@pytest.mark.parametrize(("breaking", "moves"), [(0, True), (2, True), (3, False)])
def test_windows_that_break_off_their_slopes_are_set_aside_if_they_are_few(
    breaking: int, moves: bool
) -> None:
    rng = draw("breaking windows")
    problem = Breaking(rng.uniform(0.5, 1.5, (10, 4, 2)), breaking)
    start = Params(**dict(zip(Breaking.names, (Breaking.begin, 50.0), strict=True)))
    free = [Free(n, 0.0, 500.0, 0.0, start[n]) for n in Breaking.names]
    found = fit_windows(problem, start, free, window=problem.window)
    values = [found.params[n] for n in Breaking.names]
    assert (np.abs(np.subtract(values, (40.0, 60.0))).max() < 1e-3) == moves
    assert (found.counted is not None) == (breaking > 0 and moves)
    if found.counted is not None:
        assert set(problem.window) - set(problem.window[found.counted]) == set(range(breaking))
    if breaking:  # and the fit that counts all windows does not move at all
        held = fit_windows(problem, start, free)
        assert [held.params[n] for n in Breaking.names] == [Breaking.begin, 50.0]
