"""Whether something has changed, and since when: a generalised likelihood ratio over the onset.

For each test (healthy.py) and each stretch of n segments up to now the size is estimated and compared with the
healthy one:

    b = U / K - b_H,    z = b / error(b)

which is the square root of the likelihood ratio of a change of unknown size at that onset (Basseville and Nikiforov,
Detection of Abrupt Changes, 1993, chapter 2.4). Onsets are looked for in a window, on a grid that is coarser the
further back (Lai, J. R. Statist. Soc. B 57, 1995): a change that lies between two of them loses a tenth of z.

A segment counts at most half the threshold, in its standard deviations (Huber 1965), so an alarm takes four of them,
20 s: a window of which the search for an initial state went astray, or one motion that the model does worse than
others, is no change of the machine.

False alarms. Where nothing has changed, z is Student's with the freedom that the scatter of the healthy machine was
told with. If every test at every onset in every segment exceeds its threshold with a chance of

    rate / (segments in a day * onsets * tests)

then at most `rate` of them do so a day, however they depend on each other (Boole's inequality): that is a bound on
the number of false alarms, and a cautious one. It rests on healthy stretches that the machine was watched in while
it was learned: another motion, another load or a cold morning, of which nothing was learned, are a change.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from sms.arrays import Array
from sms.watch.healthy import Baseline, Sums
from sms.watch.segments import SEGMENT

LAGS = (1, 2, 3, 4, 6, 8, 12, 18, 27, 40, 60)
"""Segments since the onset: up to five minutes."""
FEWEST = 4
"""Segments that an alarm takes at least: longer than one motion of ten seconds. Judgement."""
DAY = 86400.0 / SEGMENT
"""Segments."""


@dataclass(frozen=True, eq=False)
class Look:
    """What one segment brings. l onsets that are far enough from the beginning, t tests."""

    begin: float
    end: float
    z: Array
    """(l, t)"""
    exceeds: Array
    """(l, t): z over its threshold; from 1 on it is an alarm. 0 of a sign that cannot be."""
    lags: tuple[int, ...]

    @property
    def highest(self) -> float:
        """1 and more: an alarm."""
        return float(self.exceeds.max())

    @property
    def test(self) -> int:
        """Number of the test that is highest."""
        return int(np.argmax(self.exceeds.max(axis=0)))

    @property
    def lag(self) -> int:
        """Segments since the onset that fits it best."""
        return self.lags[int(np.argmax(self.exceeds[:, self.test]))]


class Detector:
    """Looks at segment after segment. It holds the sums of as many as the longest lag has."""

    def __init__(
        self, baseline: Baseline, false_alarms_per_day: float, fewest: int = FEWEST
    ) -> None:
        """fewest: segments that an alarm takes; 0: a segment counts whole."""
        self.baseline = baseline
        self.rate = false_alarms_per_day
        self.thresholds = thresholds(baseline, false_alarms_per_day)
        self.most = self.thresholds / np.sqrt(fewest) if fewest else np.inf * self.thresholds
        """(t,): standard deviations that a segment counts."""
        self.sums: deque[Sums] = deque(maxlen=LAGS[-1])
        self._signs = np.array([[t.low, t.high] for t in baseline.tests]).T

    def push(self, sums: Sums) -> Look:
        """Another segment."""
        self.sums.append(sums)
        lags = tuple(n for n in LAGS if n <= len(self.sums))
        z = np.array([self.z(n) for n in lags])
        low, high = self._signs
        right = np.where(z < 0.0, low, high)
        return Look(
            sums.begin, sums.end, z, np.where(right, np.abs(z) / self.thresholds, 0.0), lags
        )

    def z(self, lag: int) -> Array:
        """(t,) of the last segments."""
        b = self.baseline
        last = self.last(lag)
        response, variance = (
            np.array([getattr(s, name) for s in last]) for name in ("response", "variance")
        )
        deviation = np.array([s.shift for s in last]) - b.mean * response
        room = self.most * np.sqrt(b.inflation * variance)
        clipped = np.clip(deviation, -room, room).sum(axis=0)
        k, v = response.sum(axis=0), variance.sum(axis=0)
        scale = np.sqrt(b.inflation * (v + k**2 * b.mean_variance))
        return np.asarray(np.where(scale > 0.0, clipped / np.maximum(scale, 1e-300), 0.0))

    def last(self, lag: int) -> list[Sums]:
        """Those of the last segments."""
        return list(self.sums)[-lag:]


def thresholds(baseline: Baseline, false_alarms_per_day: float) -> Array:
    """(t,): of |z|, for at most so many false alarms a day."""
    tests = len(baseline.tests)
    chance = false_alarms_per_day / (DAY * len(LAGS) * tests)
    sides = np.array([t.low + t.high for t in baseline.tests])
    return np.asarray(student.isf(chance / sides, baseline.freedom))
