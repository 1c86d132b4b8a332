"""A hypothesis fitted to records: least squares, generalised by a discrepancy, with covariances robust to blocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.hypothesis import Fitted, Hypothesis
from sms.estimation.block_statistics import (
    covariance_from,
    covariance_of,
    leveraged_covariance,
    project_off,
)
from sms.estimation.discrepancy import Discrepancy
from sms.estimation.least_squares import MOST_STEPS, Free, WindowFit, counted_rows
from sms.estimation.nuisance import Nuisance, pulls
from sms.estimation.windows import Runs
from sms.parameters import SPECIMENS, common_parameter

TURNS, SETTLED = 2, 0.2
"""Of parameters and discrepancy, each for the other; and the change of the logarithm of tau that ends it. Run time."""


def fit(
    hypothesis: Hypothesis,
    runs: Runs,
    initial: _core.Params | None = None,
    most_steps: int = MOST_STEPS,
    nearby: Mapping[str, Array] | None = None,
    discrepancy: Discrepancy | None = None,
    roughly: bool = False,
    stated: bool = False,
) -> Fitted:
    """Least squares over the hypothesis' free parameters, with a covariance that is robust to blocks.

    most_steps: Jacobians that are worked out at most. nearby: parameter -> (rows,) change of the residual with it near
    the initial ones. roughly: of what two specimens of a type differ by, those serve to the end. stated: its values are
    (fit_windows).
    """
    free = free_of(hypothesis)
    names = [f.name for f in free]
    slopes = {n: column for n, column in (nearby or {}).items() if n in names}
    kept = {n for n in slopes if roughly and common_parameter(n) in SPECIMENS}
    pull = weights_of(hypothesis, names)
    start = initial or hypothesis.start
    found = runs.fit(start, free, pull, most_steps, slopes, kept, discrepancy, stated)
    fitted = Fitted(hypothesis, found, np.empty((0, 0)), discrepancy)
    covariance = _covariance(fitted, pull, runs)
    held = np.array(found.at_bound, dtype=bool)
    covariance[held, :] = covariance[:, held] = 0.0
    return replace(fitted, covariance=covariance)


def fit_with_discrepancy(
    hypothesis: Hypothesis,
    runs: Runs,
    initial: _core.Params | None = None,
    alike: bool = False,
) -> Fitted:
    """Generalised least squares: parameters and the size of what no parameter explains, in turn (discrepancy.py).

    alike: that size is one for all windows, as it has to be to hold on other records.
    """
    start = initial or hypothesis.start
    now = runs.discrepancy(start, residual_of(runs, start), alike)
    return settled(fit(hypothesis, runs, start, discrepancy=now, stated=True), runs)


def settled(fitted: Fitted, runs: Runs) -> Fitted:
    """The same hypothesis with the discrepancy that it leaves itself, and fitted again with that."""
    for _ in range(TURNS):
        before = fitted.discrepancy
        if before is None:
            return fitted
        counted = np.unique(runs.window[counted_rows(fitted.fit)])
        now = before.fitted_to(fitted.fit.residual, counted)
        felt = before.tau > 0.0
        if np.all(np.abs(np.log(now.tau[felt] / before.tau[felt])) < SETTLED):
            break
        fitted = fit(
            fitted.hypothesis,
            runs,
            fitted.params,
            nearby=fitted.slopes,
            discrepancy=now,
            stated=True,
        )
    return fitted


def free_of(hypothesis: Hypothesis) -> list[Free]:
    """The free parameters, each pulled to what is declared."""
    h = hypothesis
    return [
        Free(n, low, high, h.sample / h.known[n] if n in h.known else 0.0, h.start[n])
        for n, (low, high) in h.free.items()
    ]


def weights_of(hypothesis: Hypothesis, names: list[str]) -> Array:
    """(names, names): rows that pull parameters to what is declared, beside residuals as they are counted."""
    h = hypothesis
    return h.sample * float(np.sqrt(h.inflation)) * pulls(names, h.known, h.joint)


def cost_of_departure(fitted: Fitted) -> float:
    """How far the values are from what is declared, as chi-square."""
    return departure(fitted.hypothesis, fitted.params)


def departure(h: Hypothesis, params: _core.Params) -> float:
    """The same of other values than the fitted ones."""
    names = list(h.free)
    off = np.array([params[n] - h.start[n] for n in names])
    return float(np.sum((weights_of(h, names) @ off) ** 2))


def _covariance(fitted: Fitted, pull: Array, runs: Runs) -> Array:
    """(free, free), by the scatter of blocks; by the noise where it is declared and says more, since few blocks hardly
    tell their scatter."""
    found, covariance = fitted.fit, np.zeros((pull.shape[1], pull.shape[1]))
    # Where a bound holds a parameter its sensitivities are left in the residual: it had no part in the fit.
    moved = np.flatnonzero(~np.array(found.at_bound, dtype=bool))
    weight = fitted.hypothesis.sample**2 * fitted.hypothesis.inflation
    known = pull[:, moved].T @ pull[:, moved] / weight
    if not runs.whitened:
        if len(moved):
            covariance[np.ix_(moved, moved)] = covariance_of(
                found.jacobian[:, moved], found.residual, runs.block, known, weight
            )
        return covariance
    rows = counted_rows(fitted.fit)
    jacobian, residual = fitted.whiten(found.jacobian)[rows], fitted.whiten(found.residual)[rows]
    block = runs.block[rows]
    bread = covariance_from(jacobian.T @ jacobian + pull.T @ pull)
    noise = max(float(np.mean(residual**2)), 1e-12) * fitted.hypothesis.inflation
    by_noise = np.diag(noise * bread)
    robust = leveraged_covariance(jacobian[:, moved], residual, block, known, weight)
    by_blocks = np.zeros(len(by_noise))
    by_blocks[moved] = np.diag(robust)
    inflate = np.sqrt(np.maximum(by_blocks / np.maximum(by_noise, 1e-300), 1.0))
    return np.asarray(noise * bread * np.outer(inflate, inflate))


def without_sensitivities(fitted: Fitted) -> Fitted:
    """The same model for whoever asks for its values: a round of the search holds dozens of them."""
    if not isinstance(fitted.fit, WindowFit) or not (len(fitted.fit.jacobian) or fitted.columns):
        return fitted
    none = np.empty((0, len(fitted.hypothesis.free)))
    return replace(fitted, fit=replace(fitted.fit, jacobian=none), columns={})


def with_sensitivities(fitted: Fitted, runs: Runs) -> Fitted:
    """The same model on its records with all sensitivities, worked out there if it has forgotten them."""
    if not isinstance(fitted.fit, WindowFit) or len(fitted.fit.jacobian):
        return fitted
    residual, jacobian = runs.problem.evaluate(fitted.params, list(fitted.hypothesis.free))
    return replace(
        fitted, fit=replace(fitted.fit, residual=residual, jacobian=jacobian), columns={}
    )


def residual_of(runs: Runs, params: _core.Params) -> Array:
    residual, _ = runs.problem.evaluate(params)
    return np.asarray(residual)


def sensitivities(fitted: Fitted, runs: Runs, names: list[str]) -> Array:
    """(rows, names): how the residual changes with each parameter, beyond what the free ones can undo."""
    nuisance = [n for n in fitted.movable if n not in names]
    _, jacobian = runs.problem.evaluate(fitted.params, nuisance + names)
    return project_off(jacobian[:, len(nuisance) :], jacobian[:, : len(nuisance)])


def nuisance_of(fitted: Fitted, white: bool = False, held: bool = False) -> Nuisance:
    """The free parameters that are not held by a bound, at the solution; their sensitivities whitened if asked for.

    held: those too that are held by one.
    """
    h = fitted.hypothesis
    movable = list(h.free) if held else fitted.movable
    slopes = fitted.fit.jacobian[:, [list(h.free).index(n) for n in movable]].astype(np.float64)
    return Nuisance(
        movable,
        fitted.whiten(slopes) if white else slopes,
        weights_of(h, movable),
        np.array([fitted.params[n] - h.start[n] for n in movable]),
    )
