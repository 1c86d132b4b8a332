"""What records of the healthy machine tell: its numbers, how nearly, and what its model leaves anyway."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sms.arrays import Array, Index
from sms.diagnosis.fitting import fit, fit_with_discrepancy, weights_of
from sms.diagnosis.hypothesis import WIDE, Data, Fitted, Healthy, Hypothesis
from sms.estimation.block_statistics import covariance_from, scatter_of_scores
from sms.estimation.jump_times import with_jump_times
from sms.estimation.least_squares import counted_rows
from sms.estimation.nuisance import Joint
from sms.estimation.windows import Runs

SAME_MACHINE = 0.03
"""Of what is declared: by how much a number may differ between a day when the machine was well and today. Judgement: an
uncertainty is what is not known of a number, and hardly any of that is its change.
"""
MOST_INFLATED = 100.0
"""How many times larger variances may be by the scatter of blocks than by the noise: with few blocks, that scatter is
hardly known itself. Judgement."""


def from_reference(hypothesis: Hypothesis, data: Data) -> tuple[Hypothesis, Data]:
    """What records of the healthy machine tell of it: where its numbers lie and how nearly, and what its model leaves
    anyway. The others are then asked what has changed.

    Such records tell combinations of the numbers far better than each (the flow at an opening, not its gain and its
    table apart), so what they tell is a covariance. It is wider than noise alone would have it, by as much as the
    scatter between blocks is (`Healthy.inflation`); a number's change from day to day is added.
    """
    assert data.reference is not None
    h = hypothesis
    # Jumps that are taken in the middle of their period leave so much that the machine's numbers make up for them, and
    # jumps found beside such numbers agree with them: so what is declared has the first word.
    runs = with_jump_times(data.reference, h.start)
    runs = with_jump_times(data.reference, _fitted_when_well(h, runs).params)
    fitted = _fitted_when_well(h, runs)
    rows = counted_rows(fitted.fit)
    residual = fitted.whiten(fitted.fit.residual)
    jacobian = fitted.whiten(fitted.fit.jacobian)[rows]
    pull = weights_of(h, list(h.free))
    inflation = _inflation(jacobian, residual[rows], pull, runs.block[rows])
    told = covariance_from(jacobian.T @ jacobian / inflation + pull.T @ pull)
    names = [n for n in h.free if n in h.known]
    place = [list(h.free).index(n) for n in names]
    drift = np.diag([(SAME_MACHINE * h.known[n]) ** 2 for n in names])
    joint = Joint(tuple(names), np.asarray(told[np.ix_(place, place)] + drift))
    deviation = {
        n: float(s) for n, s in zip(names, np.sqrt(np.diag(joint.covariance)), strict=True)
    }
    start, free = h.start.copy(), dict(h.free)
    for name in h.free:
        start[name] = fitted.params[name]
    for name, sigma in deviation.items():
        low, high = start[name] - WIDE * sigma, start[name] + WIDE * sigma
        free[name] = max(h.table[name].lower, low), min(h.table[name].upper, high)
    known = h.known | deviation
    machine = replace(h, start=start, free=free, known=known, joint=joint, inflation=inflation)
    data = replace(data, reference=runs).timed(fitted.params)
    return machine, replace(data, healthy=_healthy(fitted, residual, data, inflation))


def _fitted_when_well(hypothesis: Hypothesis, runs: Runs) -> Fitted:
    """Generalised least squares from what is declared. That may be off by so much that all it leaves counts as
    discrepancy, beside which nothing moves; then from ordinary least squares."""
    fitted = fit_with_discrepancy(hypothesis, runs, alike=True)
    if any(fitted.params[n] != hypothesis.start[n] for n in hypothesis.free):
        return fitted
    plainly = fit(hypothesis, runs, stated=True)
    return fit_with_discrepancy(hypothesis, runs, plainly.params, alike=True)


def _inflation(jacobian: Array, residual: Array, pull: Array, block: Index) -> float:
    """By what factor the scatter of the blocks' scores is larger than the information of whitened residuals (for
    independent ones both are the same): the geometric mean over the directions of the parameters, each counted by the
    share of what is known of it that these records tell. What they do not tell has no scatter to be measured.
    """
    information, declared = jacobian.T @ jacobian, pull.T @ pull
    scatter = scatter_of_scores(jacobian, residual, block)
    scale = np.sqrt(np.maximum(np.diag(information + declared), 1e-300))
    information, declared, scatter = (
        x / np.outer(scale, scale) for x in (information, declared, scatter)
    )
    total, axes = np.linalg.eigh(information + declared)
    known = total > 1e-12 * total[-1]
    axes = axes[:, known] / np.sqrt(total[known])
    share, turned = np.linalg.eigh(axes.T @ information @ axes)
    axes = axes @ turned
    told = share > 0.5
    if not np.any(told):
        return 1.0
    ratio = np.einsum("ki,kl,li->i", axes, scatter, axes)[told] / share[told]
    mean = np.average(np.log(np.maximum(ratio, 1e-300)), weights=share[told])
    return float(np.clip(np.exp(mean), 1.0, MOST_INFLATED))


def _healthy(fitted: Fitted, white: Array, data: Data, inflation: float) -> Healthy:
    """What a fit to the reference records leaves of them, carried over to the others. white (rows,): its residual."""
    assert data.reference is not None and fitted.discrepancy is not None
    runs, tau = data.reference, fitted.discrepancy.tau
    level, plain = np.ones((2, len(data.identify.channels)))
    spread = np.zeros(len(data.identify.channels))
    for c, name in enumerate(data.identify.channels):
        if name not in runs.channels:
            continue
        of_channel = runs.channel == runs.channels.index(name)
        by_record = [
            float(np.mean(white[of_channel & (runs.record == r)] ** 2))
            for r in range(len(runs.motions))
        ]
        level[c] = np.mean(white[of_channel] ** 2)
        plain[c] = np.mean(fitted.fit.residual[of_channel] ** 2)
        spread[c] = max(by_record) / level[c] - 1.0
    return Healthy(
        data.identify.discrepancy_of(fitted.params, tau),
        data.validate.discrepancy_of(fitted.params, tau),
        level,
        plain,
        spread,
        inflation,
    )
