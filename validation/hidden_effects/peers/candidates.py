"""The best of the same candidates by Akaike's criterion, with nothing else asked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from sms.diagnosis.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, fit, unseen
from sms.diagnosis.search import screen_effects

from validation.hidden_effects.peers.scoring import Said

MOST_FITS = 8
"""Where a fit simulates every record: those that promise most by a linear step are fitted in full."""


def key_of(effect: Effect) -> str:
    return effect.id if effect.signal is None else f"{effect.id}:{effect.signal}"


def best_by_aic(
    baseline: Fitted, data: Data, effects: Sequence[Effect], trial: str, sort: str, hidden: str
) -> Said:
    """Each effect on top of the baseline, one parameter more each: the least criterion wins."""
    tried = list(effects)
    if data.identify.whitened:
        promised = screen_effects(baseline, data, tried, np.random.default_rng(1)).gain
        tried = [tried[int(k)] for k in np.argsort(-promised)[:MOST_FITS]]
    best, criterion, chosen = baseline, _criterion(baseline, data), None
    for effect in tried:
        fitted = fit(baseline.hypothesis.with_effect(effect), data.identify)
        if _criterion(fitted, data) < criterion:
            best, criterion, chosen = fitted, _criterion(fitted, data), effect
    before, after = (float(np.mean(unseen(f, data) ** 2)) for f in (baseline, best))
    named = ((key_of(chosen),),) if chosen else ()
    gain = 1.0 - float(np.sqrt(after / before))
    return Said("best AIC, same candidates", trial, sort, hidden, named, chosen is not None, gain)


def _criterion(fitted: Fitted, data: Data) -> float:
    """2 k - 2 log likelihood: with the noise known where residuals are in its units, else with the noise estimated."""
    squared = float(np.sum(fitted.fit.residual**2))
    rows = len(fitted.fit.residual)
    fit_term = squared if data.identify.whitened else rows * float(np.log(squared / rows))
    return fit_term + 2.0 * len(fitted.hypothesis.free)
