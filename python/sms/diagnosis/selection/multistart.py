"""Effects that are far from where the model stands: a rig file that is wrong by ten, heat far from its coefficient.

A linear step says little of a long way, and its windows disagree so much on the step that its test calls it chance. So
where all that was fitted leaves most of a large error, what promises most is fitted whatever its test says, from
whichever of several sizes leaves least, and tested by what the fit took: by how many windows have less, and how much.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.stats import wilcoxon

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, fit, residual_of
from sms.diagnosis.thresholds import LARGE_ERROR, MOST_LEFT, MULTIPLES, STARTED_AFAR
from sms.estimation.block_statistics import sum_by
from sms.estimation.least_squares import changed
from sms.estimation.windows import Runs
from sms.parameters import common_parameter


def much_is_left(current: Fitted, fits: Iterable[Fitted], runs: Runs) -> bool:
    """Whether the error is large, and each of these fits leaves most of it."""
    noise = float(np.sum(runs.floor(current.fit.residual)[runs.channel]))
    excess = float(np.sum(current.fit.residual**2)) - noise
    left = min((float(np.sum(f.fit.residual**2)) for f in fits), default=noise + excess)
    return excess > LARGE_ERROR * noise and left - noise > MOST_LEFT * excess


def may_be_elsewhere(effects: Sequence[Effect], promise: Array) -> list[int]:
    """Places of the few that promise most, and of those whose sensitivity depends on a second parameter."""
    first = [int(k) for k in np.argsort(-promise)[:STARTED_AFAR] if promise[k] > 0.0]
    shaped = [k for k, e in enumerate(effects) if e.step is not None and len(e.parameters) > 1]
    return list(dict.fromkeys(first + shaped))


def multistart_fit(effect: Effect, current: Fitted, data: Data, guess: _core.Params) -> Fitted:
    """The fit from whichever of several sizes leaves least; `guess` is one of them."""
    name = effect.parameters[0]
    declared = data.rig.declared(common_parameter(name)).value
    low, high = effect.plausible_range(declared)
    starts = [guess]
    if effect.kind == "shifted" and not effect.absolute:
        starts += [
            changed(current.params, [name], np.array([factor * declared]))
            for factor in MULTIPLES
            if low <= factor * declared <= high
        ]
    left = [float(np.sum(residual_of(data.identify, at) ** 2)) for at in starts]
    hypothesis = current.hypothesis.with_effect(effect)
    return fit(hypothesis, data.identify, starts[int(np.argmin(left))])


def chance(current: Fitted, fitted: Fitted, runs: Runs, tried: int) -> float:
    """That so many windows have less by chance (signed ranks, Wilcoxon 1945), of the best of all that were tried."""
    groups = int(runs.block.max()) + 1
    less = sum_by(runs.block, current.fit.residual**2 - fitted.fit.residual**2, groups)
    found = wilcoxon(less, alternative="greater", zero_method="zsplit")
    return min(1.0, tried * float(found.pvalue))
