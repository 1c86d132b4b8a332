"""What could still be hidden where nothing was found: of each effect, the size from which these records would show it.

With it stands the shift that would fit them best, to first order, whatever it is: that it is small says how small the
effect was on that day, and a later diagnosis that names it is compared with that (history/difference.py).

An effect is looked at once the error that it makes beyond what the free parameters can imitate is more than two fair
descriptions of one machine differ by (kind.Kind.practically_significant), and it is three standard errors at least. A
shift of a number that is known with an uncertainty counts from the end of that: within it, it is no error of the model.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import nuisance_of
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.result import StillHidden
from sms.diagnosis.selection.candidates import room_of
from sms.diagnosis.selection.identifiability import raw_columns
from sms.diagnosis.thresholds import DETECTION
from sms.estimation.block_statistics import scatter_of_scores
from sms.estimation.nuisance import Nuisance, project
from sms.estimation.windows import Runs


def still_hidden(fitted: Fitted, data: Data, effects: Sequence[Effect]) -> tuple[StillHidden, ...]:
    """Of each of these effects, in their order; to first order from the model as it stands."""
    if not effects:
        return ()
    runs = data.identify
    names = [e.parameters[0] for e in effects]
    raw = raw_columns(fitted, runs, effects)
    moving = nuisance_of(fitted)
    reduced = project(moving, raw, names)
    rows = len(fitted.fit.residual)
    size = np.linalg.norm(reduced[:rows], axis=0)
    level = np.sqrt(max(float(np.mean(fitted.fit.residual**2)), 1.0))
    least = np.maximum(
        DETECTION * level, np.sqrt(2.0 * runs.kind.practically_significant[0] * rows)
    )
    found = []
    # What is held by a bound is where it is since something is wrong, which may be this effect: it may move back.
    nuisance = nuisance_of(fitted, held=True)
    if nuisance.names != moving.names:
        reduced = project(nuisance, raw, names)
    estimates = [
        None if name in nuisance.names else _best_shift(column, nuisance, fitted, runs, level)
        for name, column in zip(names, reduced.T, strict=True)
    ]
    for effect, name, own, best in zip(effects, names, size, estimates, strict=True):
        largest = max(abs(end) for end in room_of(effect, fitted.params, data.rig))
        within = fitted.hypothesis.known.get(name, 0.0)
        shift, unit = within + float(least / max(own, 1e-300)), data.rig.table[name].unit
        found.append(
            StillHidden(
                effect.id, effect.signal, effect.title, name, shift, unit, largest, *(best or ())
            )
        )
    return tuple(found)


def _best_shift(
    column: Array, nuisance: Nuisance, fitted: Fitted, runs: Runs, level: float
) -> tuple[float, float] | None:
    """The least-squares shift along a column (rows + known,) that no free parameter imitates, and its standard error.

    The error is that of the noise, at the level of the residual, or that by which the scores of blocks scatter: the
    larger one. None for a column of nothing.
    """
    residual = fitted.fit.residual
    rows, information = len(residual), float(column @ column)
    if not 0.0 < information < np.inf:
        return None
    seen, known = column[:rows], column[rows:]
    shift = -float(seen @ residual + known @ nuisance.departure) / information
    scatter = float(scatter_of_scores(seen[:, None], residual, runs.block)[0, 0])
    variance = max(level**2 * information, scatter + float(known @ known))
    return shift, float(np.sqrt(variance)) / information
