"""A random hidden input as a part of the statistics: its covariance, its size, and what it does to a fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from sms import _core
from sms.arrays import Array
from sms.estimation.discrepancy import KNOTS, Discrepancy, Whitened
from sms.estimation.least_squares import Free, fit_windows
from sms.estimation.nuisance import Joint, Nuisance, pulls
from sms.estimation.variance_components import most_likely

from validation.random_cases import draw

WINDOWS, SAMPLES, EQUATIONS = 12, 60, 2


@dataclass
class Drawn:
    """Windows whose equations have inputs with random responses."""

    inputs: Array
    windows: list[Any]
    jumping: Array
    """(rows, 1): with the time of a jump, s."""

    def hidden(self, params: _core.Params, knots: int) -> Array:
        assert knots == KNOTS
        return self.inputs

    def jumps(self, params: _core.Params) -> Array:
        return self.jumping


def drawn(random: np.random.Generator) -> Drawn:
    rows = WINDOWS * SAMPLES
    windows = [SimpleNamespace(record=0, row=k * SAMPLES, rows=SAMPLES) for k in range(WINDOWS)]
    smooth = np.cumsum(random.normal(size=(rows, EQUATIONS * KNOTS)), axis=0)
    return Drawn(smooth / np.sqrt(SAMPLES), windows, random.normal(0.0, 1e3, size=(rows, 1)))


def residual_of(problem: Drawn, tau: Sequence[float], random: np.random.Generator) -> Array:
    """Noise and what inputs of these sizes leave."""
    out = random.normal(size=len(problem.inputs))
    for w in problem.windows:
        knots = np.repeat(tau, KNOTS) * random.normal(size=EQUATIONS * KNOTS)
        out[w.row : w.row + w.rows] += problem.inputs[w.row : w.row + w.rows] @ knots
    return out


def test_whitening_undoes_the_covariance_and_colouring_undoes_whitening() -> None:
    random = draw("whitening")
    problem = drawn(random)
    residual = residual_of(problem, (1.0, 0.3), random)
    found = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual)
    root = found.whitener
    values = random.normal(size=(len(residual), 3))
    assert root.colour(root.whiten(values)) == pytest.approx(values, abs=1e-9)
    first = found.rows[0]
    tau = np.repeat(found.tau * found.larger[0], KNOTS)
    covariance = np.eye(SAMPLES) + problem.inputs[first] * tau**2 @ problem.inputs[first].T
    padded = np.zeros((len(residual), SAMPLES))
    padded[first] = covariance
    half = root.whiten(padded)[first]
    padded[first] = half.T
    assert root.whiten(padded)[first] == pytest.approx(np.eye(SAMPLES), abs=1e-8)


def test_the_sizes_of_the_inputs_are_found_and_that_of_one_that_is_not_there_goes_to_nothing() -> (
    None
):
    random = draw("sizes of hidden inputs")
    problem = drawn(random)
    true = 10.0 ** random.uniform(0.0, 1.0)
    residual = residual_of(problem, (true, 0.0), random)
    found = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual)
    assert found.tau[0] == pytest.approx(true, rel=0.4)  # 252 draws, five standard errors
    assert found.tau[1] ** 2 < 5.0 * standard_error_at_nothing(problem, true)
    white = found.whitener.whiten(residual)
    assert np.mean(white**2) == pytest.approx(1.0, abs=0.3)


def test_a_window_that_a_fit_sets_aside_does_not_say_how_large_alike_inputs_are() -> None:
    random = draw("windows set aside")
    problem = drawn(random)
    residual = residual_of(problem, (1.0, 0.3), random)
    plain = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual, alike=True)
    wild = residual.copy()
    wild[plain.rows[5]] *= 1e3
    others = np.delete(np.arange(WINDOWS), 5)
    found = plain.fitted_to(wild, others)
    assert np.all(plain.fitted_to(wild).tau > 10.0 * plain.tau)
    assert found.tau == pytest.approx(plain.fitted_to(residual, others).tau)
    assert np.all(found.tau < 1.5 * plain.tau)


def test_the_times_of_a_command_s_jumps_are_one_more_input_of_known_size() -> None:
    random = draw("times of jumps")
    problem = drawn(random)
    deviation = 10.0 ** random.uniform(-2.5, -1.5)
    ahead = np.repeat(deviation * random.normal(size=WINDOWS), SAMPLES)
    residual = residual_of(problem, (1.0, 0.0), random) + problem.jumping[:, 0] * ahead
    plain = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual)
    found = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual, jumping=(deviation,))
    assert found.tau[-1] == 1.0
    assert np.all(np.broadcast_to(found.larger, (WINDOWS, EQUATIONS + 1))[:, -1] == 1.0)
    assert found.tau[0] == pytest.approx(1.0, rel=0.4)
    white = (one.whitener.whiten(residual) for one in (found, plain))
    left, left_by_equations_alone = (float(np.mean(w**2)) for w in white)
    assert left == pytest.approx(1.0, abs=0.3)
    assert left_by_equations_alone > 2.0
    sized = Discrepancy.sized(problem, _core.Params(), found.tau, (deviation,))
    assert sized.whitener.whiten(residual) == pytest.approx(
        replace(found, larger=1.0).whitener.whiten(residual)
    )


def test_the_expected_inputs_are_those_that_were_there_wherever_the_simulation_has_them() -> None:
    random = draw("expected inputs")
    problem = drawn(random)
    problem.jumping[:] *= 100.0  # told to a hundredth of its deviation, and better
    ahead = 1e-2 * random.normal(size=WINDOWS)
    moved = problem.jumping[:, 0] * np.repeat(ahead, SAMPLES)
    noise = residual_of(problem, (1.0, 0.0), random)
    sized = Discrepancy.sized(problem, _core.Params(), np.array([1.0, 0.0, 1.0]), (1e-2,))
    found = sized.expected(noise - moved)
    assert 1e-2 * found[:, -1] == pytest.approx(ahead, abs=1e-3)
    at = np.zeros(found.shape)
    at[:, -1] = random.normal(size=WINDOWS)
    there = problem.jumping[:, 0] * np.repeat(1e-2 * at[:, -1], SAMPLES)
    assert sized.expected(noise - moved + there, at) == pytest.approx(found, abs=1e-6)


def standard_error_at_nothing(problem: Drawn, first: float) -> float:
    """Of the second input's variance, where it is nothing: its Fisher information under the marginal likelihood."""
    information = 0.0
    for w in problem.windows:
        inputs = problem.inputs[w.row : w.row + w.rows]
        covariance = np.eye(SAMPLES) + first**2 * inputs[:, :KNOTS] @ inputs[:, :KNOTS].T
        seen = inputs[:, KNOTS:].T @ np.linalg.solve(covariance, inputs[:, KNOTS:])
        information += 0.5 * float(np.sum(seen**2))
    return information**-0.5


@dataclass
class Line:
    """A problem that is linear in one parameter."""

    column: Array
    target: Array

    @property
    def rows(self) -> int:
        return len(self.target)

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        residual = self.column * params["coulomb_force"] - self.target
        return residual, np.repeat(self.column[:, None], len(free), axis=1)


def test_the_standard_error_is_that_of_the_estimates_where_noise_alone_would_claim_too_much() -> (
    None
):
    random = draw("standard errors beside a discrepancy")
    problem = drawn(random)
    column = np.cumsum(random.normal(size=len(problem.inputs)))
    column /= np.sqrt(SAMPLES)
    free = [Free("coulomb_force", -1e6, 1e6, 0.0, 38.0)]
    missed, claimed = [], []
    for _ in range(60):
        left = residual_of(problem, (1.0, 0.5), random)
        line = Line(column, 38.0 * column - left)
        found = Discrepancy.of(problem, _core.Params(), EQUATIONS, left)
        root = found.whitener
        fit = fit_windows(
            Whitened(line, root),  # type: ignore[arg-type]
            _core.Params(coulomb_force=38.0),
            free,
        )
        missed.append(fit.params["coulomb_force"] - 38.0)
        claimed.append(1.0 / float(np.linalg.norm(root.whiten(column))))
    by_noise = 1.0 / float(np.linalg.norm(column))
    scatter = float(np.sqrt(np.mean(np.square(missed))))
    assert scatter == pytest.approx(np.mean(claimed), rel=0.6)  # 60 draws, six standard errors
    assert scatter > 2.0 * by_noise


def test_an_omitted_parameter_leaves_the_marginal_of_what_is_known_of_the_others() -> None:
    random = draw("marginal of a joint covariance")
    root = random.normal(size=(4, 4))
    joint = Joint(("a", "b", "c", "d"), root @ root.T + 0.1 * np.eye(4))
    known = {
        n: float(s) for n, s in zip(joint.names, np.sqrt(np.diag(joint.covariance)), strict=True)
    }
    names = ["a", "x", "b", "c", "d"]
    full = Nuisance(names, np.zeros((3, 5)), pulls(names, known, joint), random.normal(size=5))
    pull = full.without("b").pull
    keep = [0, 2, 3]
    expected = np.linalg.inv(joint.covariance[np.ix_(keep, keep)])
    precision = pull.T @ pull
    assert precision[np.ix_([0, 2, 3], [0, 2, 3])] == pytest.approx(expected, rel=1e-6)
    assert precision[1] == pytest.approx(np.zeros(4))  # nothing is known of x
    alone = pulls(["a", "x"], known)
    assert np.diag(alone) == pytest.approx([1.0 / known["a"], 0.0])


def test_standard_deviations_of_random_effects_are_recovered() -> None:
    """Two groups that are there and one that is not, over sets of data that share nothing but these."""
    random = draw("random effects")
    truth, each, sets, rows = np.array([0.5, 3.0, 0.0]), 10, 40, 60
    group = np.repeat(np.arange(3), each)
    columns = random.normal(size=(sets, rows, len(group)))
    effects = truth[group] * random.normal(size=(sets, len(group)))
    data = np.einsum("sij,sj->si", columns, effects) + random.normal(size=(sets, rows))
    products = np.einsum("sij,sik->sjk", columns, columns)
    score = np.einsum("sij,si->sj", columns, data)
    start, least = np.ones(3), np.full(3, 1e-3)
    found, larger = most_likely(products, score, group, start, least, 60)
    assert found[:2] == pytest.approx(
        truth[:2], rel=0.2
    )  # of 400 each: 3.5 % is one standard error
    assert found[2] < 0.1  # what noise alone looks like: 0.03
    there, noise = larger[:, :2], found[2] * larger[:, 2]
    assert there == pytest.approx(np.ones((sets, 2)), abs=1.2)  # 0.85 at most in 300 draws
    assert noise.max() < 0.35  # 0.19 at most


def test_a_few_sets_with_far_larger_effects_do_not_say_how_large_all_are() -> None:
    random = draw("sets with larger effects")
    truth, each, sets, rows = 1.0, 10, 30, 40
    group = np.zeros(each, dtype=int)
    times = np.ones(sets)
    times[:2] = 10.0 ** random.uniform(1.5, 3.0, size=2)
    columns = random.normal(size=(sets, rows, each))
    effects = truth * times[:, None] * random.normal(size=(sets, each))
    data = np.einsum("sij,sj->si", columns, effects) + random.normal(size=(sets, rows))
    products = np.einsum("sij,sik->sjk", columns, columns)
    score = np.einsum("sij,si->sj", columns, data)
    found, larger = most_likely(products, score, group, np.ones(1), np.full(1, 1e-3), 60)
    assert found[0] == pytest.approx(truth, rel=0.3)  # of 280: 4 % is one standard error
    assert found[0] * larger[:2, 0] == pytest.approx(times[:2], rel=0.8)  # of 10 each


def test_a_window_in_which_nothing_moves_does_not_drown_the_others() -> None:
    """A piston that hangs on its stop hardly answers a force: what is left there asks for an enormous one."""
    random = draw("a window that hangs")
    problem = drawn(random)
    residual = residual_of(problem, (3.0, 1.0), random)
    usual = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual)
    hangs = problem.windows[int(random.integers(WINDOWS))]
    rows = slice(hangs.row, hangs.row + hangs.rows)
    problem.inputs[rows] *= 1e-2
    residual[rows] += 100.0 * random.normal(size=hangs.rows)
    found = Discrepancy.of(problem, _core.Params(), EQUATIONS, residual)
    assert found.tau == pytest.approx(usual.tau, rel=0.5)
    white = found.whitener.whiten(residual)
    others = np.ones(len(residual), dtype=bool)
    others[rows] = False
    assert np.mean(white[others] ** 2) == pytest.approx(1.0, abs=0.3)
