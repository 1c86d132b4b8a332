"""What could still be hidden where nothing was found: of each effect, the size from which these records would show it.

An effect is looked at once the error that it makes beyond what the free parameters can imitate is more than two fair
descriptions of one machine differ by (kind.Kind.practically_significant), and it is three standard errors at least.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, nuisance_of
from sms.diagnosis.result import StillHidden
from sms.diagnosis.selection.candidates import room_of
from sms.diagnosis.selection.identifiability import raw_columns
from sms.diagnosis.thresholds import DETECTION
from sms.estimation.nuisance import project


def still_hidden(fitted: Fitted, data: Data, effects: Sequence[Effect]) -> tuple[StillHidden, ...]:
    """Of each of these effects, in their order; to first order from the model as it stands."""
    if not effects:
        return ()
    runs = data.identify
    names = [e.parameters[0] for e in effects]
    reduced = project(nuisance_of(fitted), raw_columns(fitted, runs, effects), names)
    size = np.linalg.norm(reduced[: len(fitted.fit.residual)], axis=0)
    rows = len(fitted.fit.residual)
    level = np.sqrt(max(float(np.mean(fitted.fit.residual**2)), 1.0))
    least = np.maximum(
        DETECTION * level, np.sqrt(2.0 * runs.kind.practically_significant[0] * rows)
    )
    found = []
    for effect, name, own in zip(effects, names, size, strict=True):
        largest = max(abs(end) for end in room_of(effect, fitted.params, data.rig))
        shift, unit = float(least / max(own, 1e-300)), data.rig.table[name].unit
        found.append(
            StillHidden(effect.id, effect.signal, effect.title, name, shift, unit, largest)
        )
    return tuple(found)
