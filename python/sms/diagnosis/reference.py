"""What records of the healthy machine tell: its numbers, how nearly, and what its model leaves anyway."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sms.diagnosis.hypothesis import (
    MOST_INFLATED,
    WIDE,
    Data,
    Fitted,
    Healthy,
    Hypothesis,
    fit_with_discrepancy,
    weights_of,
)
from sms.estimation.block_statistics import covariance_from, covariance_of
from sms.estimation.nuisance import Joint

SAME_MACHINE = 0.03
"""Of what is declared: by how much a number may differ between a day when the machine was well and today. Judgement: an
uncertainty is what is not known of a number, and hardly any of that is its change.
"""


def from_reference(hypothesis: Hypothesis, data: Data) -> tuple[Hypothesis, Data]:
    """What records of the healthy machine tell of it: where its numbers lie and how nearly, and what its model leaves
    anyway. The others are then asked what has changed.

    Such records tell combinations of the numbers far better than each (the flow at an opening, not its gain and its
    table apart), so what they tell is a covariance. It is wider than noise alone would have it, by as much as the
    scatter between blocks is (`Healthy.inflation`); a number's change from day to day is added.
    """
    assert data.reference is not None
    h, runs = hypothesis, data.reference
    fitted = fit_with_discrepancy(h, runs)
    healthy = _healthy(fitted, data)
    white = fitted.whiten(fitted.fit.jacobian)
    pull = weights_of(h, list(h.free))
    told = covariance_from(white.T @ white / healthy.inflation + pull.T @ pull)
    names = [n for n in h.free if n in h.known]
    place = [list(h.free).index(n) for n in names]
    drift = np.diag([(SAME_MACHINE * h.known[n]) ** 2 for n in names])
    covariance = np.asarray(told[np.ix_(place, place)] + drift)
    start, free = h.start.copy(), dict(h.free)
    for name in h.free:
        start[name] = fitted.params[name]
    for name, variance in zip(names, np.diag(covariance), strict=True):
        room, bounds = WIDE * float(np.sqrt(variance)), h.table[name]
        free[name] = (max(bounds.lower, start[name] - room), min(bounds.upper, start[name] + room))
    known = h.known | dict(zip(names, map(float, np.sqrt(np.diag(covariance))), strict=True))
    joint = Joint(tuple(names), covariance)
    told_by = replace(
        h, start=start, free=free, known=known, joint=joint, inflation=healthy.inflation
    )
    return told_by, replace(data, healthy=healthy)


def _healthy(fitted: Fitted, data: Data) -> Healthy:
    """What a fit to the reference records leaves of them, carried over to the others."""
    assert data.reference is not None and fitted.discrepancy is not None
    runs, tau = data.reference, fitted.discrepancy.tau
    white = fitted.whiten(np.column_stack([fitted.fit.jacobian, fitted.fit.residual]))
    jacobian, residual = white[:, :-1], white[:, -1]
    pull = weights_of(fitted.hypothesis, list(fitted.hypothesis.free))
    noise = np.diag(covariance_from(jacobian.T @ jacobian + pull.T @ pull))
    blocks = np.diag(covariance_of(jacobian, residual, runs.block))
    ratio = np.clip(blocks[noise > 0.0] / noise[noise > 0.0], 1.0, MOST_INFLATED**2)
    level, plain = np.ones((2, len(data.identify.channels)))
    spread = np.zeros(len(data.identify.channels))
    for c, name in enumerate(data.identify.channels):
        if name in runs.channels:
            of_channel = runs.channel == runs.channels.index(name)
            by_record = [
                float(np.mean(residual[of_channel & (runs.record == r)] ** 2))
                for r in range(len(runs.motions))
            ]
            level[c] = np.mean(residual[of_channel] ** 2)
            plain[c] = np.mean(fitted.fit.residual[of_channel] ** 2)
            spread[c] = max(by_record) / level[c] - 1.0
    return Healthy(
        data.identify.discrepancy_of(fitted.params, tau),
        data.validate.discrepancy_of(fitted.params, tau),
        level,
        plain,
        spread,
        float(np.exp(np.mean(np.log(ratio)))),
    )
