"""A simulation whose derivatives or errors leave the numbers: a fit beside it goes on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import Params, _core
from sms.estimation.chosen_windows import ChosenWindows
from sms.estimation.divergence import LARGEST, WithinNumbers
from sms.estimation.least_squares import Free, fit_windows
from sms.parameters import PARAMETERS
from sms.rigs.mixed_loops import Mixed, Part

Array = NDArray[np.float64]
NAME = "coulomb_force"
TRUTH = 40.0


@dataclass(frozen=True)
class Stretch:
    record: int
    first: int
    samples: int
    row: int
    rows: int


@dataclass
class Growing:
    """Two windows, linear in one parameter; beyond `edge` the second grows as `how` says."""

    edge: float
    error: float
    slope: float

    rows = 20
    windows = (Stretch(0, 0, 10, 0, 10), Stretch(0, 10, 10, 10, 10))
    settled: float | None = None

    def settle(self, params: _core.Params) -> None:
        self.settled = params[NAME]

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        residual = np.full(20, params[NAME] - TRUTH)
        jacobian = np.ones((20, len(free)))
        if params[NAME] > self.edge:
            residual[12:] = self.error
            jacobian[12:] = self.slope
        return residual, jacobian

    def errors(self, params: _core.Params) -> Array:
        return self.evaluate(params)[0]

    def hidden(self, params: _core.Params, knots: int) -> Array:
        return self.evaluate(params, [NAME] * knots)[1]


@dataclass(frozen=True)
class Answering:
    """A window of one sample for each answer to a hidden input."""

    answers: tuple[float, ...]

    @property
    def rows(self) -> int:
        return len(self.answers)

    @property
    def windows(self) -> Sequence[Stretch]:
        return [Stretch(0, k, 1, k, 1) for k in range(self.rows)]

    def settle(self, params: _core.Params) -> None:
        """There is no initial state."""

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        return np.zeros(self.rows), np.zeros((self.rows, len(free)))

    def errors(self, params: _core.Params) -> Array:
        return np.zeros(self.rows)

    def hidden(self, params: _core.Params, knots: int) -> Array:
        return np.repeat(np.array(self.answers)[:, None], knots, axis=1)


def test_searches_are_let_begin_elsewhere_through_every_wrapper() -> None:
    inner = Growing(100.0, np.nan, np.nan)
    params = Params()
    params[NAME] = 42.0
    chosen = ChosenWindows(WithinNumbers(inner, PARAMETERS), (1,))
    Mixed((Part(chosen, (0,), 1),), 1, 0).settle(params)
    assert inner.settled == 42.0


def test_what_stays_within_numbers_is_left_as_it_is() -> None:
    plain = Growing(100.0, np.nan, np.nan)
    params = Params()
    held = WithinNumbers(plain, PARAMETERS)
    for got, meant in zip(
        held.evaluate(params, [NAME]), plain.evaluate(params, [NAME]), strict=True
    ):
        assert got.tobytes() == meant.tobytes()
    assert held.hidden(params, 3).tobytes() == plain.hidden(params, 3).tobytes()
    assert (held.rows, held.windows) == (plain.rows, plain.windows)


@pytest.mark.parametrize("error", [np.nan, np.inf, -np.inf, 1e300])
@pytest.mark.parametrize("slope", [np.nan, np.inf, -1e300, 1e10])
def test_a_window_that_runs_away_has_a_large_error_and_no_slope(error: float, slope: float) -> None:
    params = Params()
    params[NAME] = 50.0
    held = WithinNumbers(Growing(45.0, error, slope), PARAMETERS)
    residual, jacobian = held.evaluate(params, [NAME])
    assert residual[0] == 10.0 and np.all(np.abs(residual[12:]) == LARGEST)
    assert np.all(jacobian[:10] == 1.0) and np.all(jacobian[10:] == 0.0)
    if not abs(slope) < 1e100:
        assert np.all(held.hidden(params, 2)[10:] == 0.0)
    assert np.all(np.isfinite(held.errors(params)))


@pytest.mark.parametrize("error", [np.nan, 3.0])
@pytest.mark.parametrize("slope", [np.nan, 9e302])
def test_a_fit_that_begins_where_a_window_runs_away_ends_at_the_truth(
    error: float, slope: float
) -> None:
    start = Params()
    start[NAME] = 60.0
    held = WithinNumbers(Growing(50.0, error, slope), PARAMETERS)
    found = fit_windows(held, start, [Free(NAME, 0.0, 500.0, 0.0, 60.0)])
    assert found.params[NAME] == pytest.approx(TRUTH, rel=1e-4)
    assert np.all(np.isfinite(found.jacobian))


def test_a_hidden_input_that_one_window_answers_without_bound_is_not_answered_there() -> None:
    """Whitened with it, residuals would be 1e154 and more, whose squares are no numbers."""
    held = WithinNumbers(Answering((1.0, 3.0, 1e40, 0.5, 2.0)), PARAMETERS)
    inputs = held.hidden(Params(), 1)
    assert [float(w) for w in inputs[:, 0]] == [1.0, 3.0, 0.0, 0.5, 2.0]
    unanswered = WithinNumbers(Answering((0.0, 0.0, 0.0, 0.5, 2.0)), PARAMETERS)
    assert float(unanswered.hidden(Params(), 1)[3, 0]) == 0.5
