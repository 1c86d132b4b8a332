"""Cross-validation of an effect to which the validation records are insensitive: fast friction, slow records.

Such records can speak neither for it nor against it, and few windows cannot exclude chance. What is left is to hold the
fitted records against each other: the effect's size comes from a part of them, and has to predict the rest. A part is a
record, where more than one feels the effect; else every other window of all. As on unseen records, what is known may
move within what is declared, and the causes are held. Each part is one linear step away from the fit to all, so that
nothing is simulated again.
"""

from __future__ import annotations

import numpy as np

from sms.arrays import Array, Index
from sms.diagnosis.fitting import nuisance_of, with_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted
from sms.estimation.block_statistics import interval, resampled, weighted_ms
from sms.estimation.nuisance import Nuisance
from sms.estimation.windows import Runs


def change_on_validation(trial: Fitted, current: Fitted, data: Data) -> float:
    """By how much the validation records change with an effect: mean square, in units of the declared noise."""
    change = refitted(trial, data).fit.residual - refitted(current, data).fit.residual
    return float(np.mean(change**2))


def objection(
    trial: Fitted, current: Fitted, data: Data, floor: float, rng: np.random.Generator
) -> str:
    """Why the fitted records, held against each other, do not have the effect; empty if they do.

    floor: mean square of the noise. It must help with 95 percent confidence, be worth more than what two
    descriptions of one machine differ by, and make no record worse by as much.
    """
    runs = data.identify
    least = runs.kind.practically_significant[0] * floor
    parts = _parts(trial.fit.residual - current.fit.residual, runs, least)
    before, after = (predicted(with_sensitivities(f, runs), parts) ** 2 for f in (current, trial))
    counts = resampled(runs.record, runs.block, rng)
    gain = weighted_ms(before, runs.block, counts) - weighted_ms(after, runs.block, counts)
    worth = before - after
    if interval(gain)[0] <= 0.0:
        return "the identification records disagree on its value"
    if float(np.mean(worth)) < least:
        return "it improves the identification records little"
    for number, run in enumerate(runs.motions):
        if float(np.mean(worth[runs.record == number])) < -least:
            return f"the value estimated from the other records makes '{run.name}' worse"
    return ""


def _parts(change: Array, runs: Runs, least: float) -> Index:
    """(rows,): which part a row belongs to, from how each record changes with the effect."""
    of_record = [np.mean(change[runs.record == r] ** 2) for r in range(len(runs.motions))]
    return runs.record if sum(c > least for c in of_record) > 1 else runs.block % 2


def predicted(fitted: Fitted, parts: Index) -> Array:
    """(rows,) residuals: each part by the causes' sizes that the others ask for, what is known free in it."""
    free, residual = nuisance_of(fitted), fitted.fit.residual
    white = nuisance_of(fitted, white=True), fitted.whiten(residual)
    held = {n for cause in fitted.hypothesis.causes for n in cause.parameters}
    cause = np.array([n in held for n in free.names], dtype=np.bool_)
    others, white_others = free.without(*held), white[0].without(*held)
    out = np.empty(len(residual))
    for part in np.unique(parts):
        rows = parts == part
        step = _step(white[0].jacobian[~rows], white[1][~rows], free)
        moved = residual[rows] + free.jacobian[rows][:, cause] @ step[cause]
        asked = white[1][rows] + white[0].jacobian[rows][:, cause] @ step[cause]
        known = _step(white_others.jacobian[rows], asked, others)
        out[rows] = moved + others.jacobian[rows] @ known
    return out


def _step(jacobian: Array, residual: Array, free: Nuisance) -> Array:
    """(k,): the step that minimises |residual + jacobian step|^2 + |pull (off + step)|^2."""
    stacked = np.vstack([jacobian, free.pull])
    scale = np.maximum(np.linalg.norm(stacked, axis=0), 1e-300)
    target = -np.concatenate([residual, free.departure])
    found = np.linalg.lstsq(stacked / scale, target, rcond=1e-10)[0]
    return np.asarray(found / scale)
