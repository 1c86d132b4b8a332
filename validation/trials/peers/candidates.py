"""The best of the same candidates by Akaike's criterion, with nothing else asked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import fit
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import unseen
from sms.diagnosis.selection.candidates import score_effects
from sms.estimation.windows import Runs

from validation.trials.peers.scoring import Said

MOST_FITS = 5
"""Where a fit simulates every record: those that promise most by a linear step are fitted in full."""


def key_of(effect: Effect) -> str:
    return effect.id if effect.signal is None else f"{effect.id}:{effect.signal}"


# ---- a force balance fed with measured signals -------------------------------------------


def best_by_aic(
    baseline: Fitted, data: Data, effects: Sequence[Effect], trial: str, sort: str, hidden: str
) -> Said:
    """Each effect on top of the baseline, one parameter more each: the least criterion wins."""
    best, criterion, chosen = baseline, _criterion(baseline), None
    for effect in effects:
        fitted = fit(baseline.hypothesis.with_effect(effect), data.identify)
        if _criterion(fitted) < criterion:
            best, criterion, chosen = fitted, _criterion(fitted), effect
    before, after = (float(np.mean(unseen(f, data) ** 2)) for f in (baseline, best))
    named = ((key_of(chosen),),) if chosen else ()
    gain = 1.0 - float(np.sqrt(after / before))
    return Said("best AIC, same candidates", trial, sort, hidden, named, chosen is not None, gain)


def _criterion(fitted: Fitted) -> float:
    """2 k - 2 log likelihood, the noise estimated."""
    rows = len(fitted.fit.residual)
    squared = float(np.sum(fitted.fit.residual**2))
    return rows * float(np.log(squared / rows)) + 2.0 * len(fitted.hypothesis.free)


# ---- a simulation held against records ---------------------------------------------------


def single_causes(
    baseline: Fitted, data: Data, effects: Sequence[Effect]
) -> list[tuple[Effect, Fitted]]:
    """Fits of the effects that promise most by a linear step, each alone on top of the baseline."""
    promised = score_effects(baseline, data, effects, np.random.default_rng(1)).gain
    tried = [effects[int(k)] for k in np.argsort(-promised)[:MOST_FITS]]
    return [(e, fit(baseline.hypothesis.with_effect(e), data.identify)) for e in tried]


def chosen_by_aic(
    baseline: Fitted, fits: Sequence[tuple[Effect, Fitted]], runs: Runs, *, independent: bool
) -> tuple[Effect | None, Fitted, float]:
    """The least criterion: effect, model, and by how much it beats the baseline.

    The noise of each reading is estimated, and what is declared of a parameter counts as a sample of it. independent:
    count samples as if each were news; else as many as they are worth by how long the best fit's error lasts.
    """
    worth = np.ones(len(runs.channels))
    if not independent:
        best = min((f for _, f in fits), key=lambda f: float(np.sum(f.fit.residual**2)))
        worth = 1.0 / _lasting(best.fit.residual, runs)

    def criterion(fitted: Fitted) -> float:
        h = fitted.hypothesis
        off = [(fitted.params[n] - h.start[n]) / u for n, u in h.known.items() if n in h.free]
        total = float(np.sum(np.square(off))) + 2.0 * len(h.free)
        for channel, weight in enumerate(worth):
            r = fitted.fit.residual[runs.channel == channel]
            total += float(weight) * len(r) * float(np.log(np.mean(r**2)))
        return total

    none: list[tuple[Effect | None, Fitted]] = [(None, baseline)]
    effect, fitted = min(none + list(fits), key=lambda pair: criterion(pair[1]))
    return effect, fitted, criterion(baseline) - criterion(fitted)


def _lasting(residual: Array, runs: Runs) -> Array:
    """(channels,): samples that say the same: 1 + 2 x the sum of the autocorrelation up to where it vanishes."""
    out = np.empty(len(runs.channels))
    for channel in range(len(runs.channels)):
        r, window = (x[runs.channel == channel] for x in (residual, runs.block))
        power, total = float(np.mean(r**2)), 0.0
        for lag in range(1, 200):
            same = window[lag:] == window[:-lag]
            rho = float(np.mean((r[lag:] * r[:-lag])[same])) / power
            if rho <= 0.0:
                break
            total += rho
        out[channel] = 1.0 + 2.0 * total
    return out
