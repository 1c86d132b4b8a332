"""How much of a prediction error a better model could take: what is left beyond what changes within 25 ms.

The floor comes from the data: a declared noise may be a third off, which in squares is as large as a real effect. What
the readings do from one sample to a few later is noise to any model of this machine; what lasts longer is not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import unseen
from sms.estimation.windows import Runs


@dataclass(frozen=True)
class LackOfFit:
    """Mean squares of the prediction error, in units of the noise floor's. Arrays (channels,)."""

    floor: Array
    """The noise floor in units of the declared noise."""
    identify: Array
    """Beyond the floor, on the records that were fitted."""
    validate: Array
    """The same on those that were not."""
    practically_significant: tuple[float, float]
    """As kind.Kind has it."""

    @property
    def total(self) -> float:
        """Over all channels and records."""
        return float(np.mean((self.identify + self.validate) / 2.0))

    @property
    def worst(self) -> float:
        """Of the channel that is worst off, over all records."""
        return float(np.max((self.identify + self.validate) / 2.0))


def lack_of_fit(fitted: Fitted, data: Data) -> LackOfFit:
    """What this model leaves."""
    seen, held = fitted.fit.residual, unseen(fitted, data)
    floor = 0.5 * (data.identify.floor(seen) + data.validate.floor(held))
    parts = _beyond(seen, data.identify, floor), _beyond(held, data.validate, floor)
    return LackOfFit(floor, *parts, data.identify.kind.practically_significant)


def _beyond(residual: Array, runs: Runs, floor: Array) -> Array:
    mean = [np.mean(residual[runs.channel == c] ** 2) for c in range(len(runs.channels))]
    return np.asarray(np.array(mean) / floor - 1.0)
