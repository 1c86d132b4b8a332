"""Many tests at once: Holm's procedure (1979), which holds its level whatever the tests have to do with each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import norm

LEVEL = 0.05
"""Chance of one wrong "changed" or more among all that is asked of two diagnoses. Convention: 5 percent."""
COVERAGE = float(norm.ppf(0.975))
"""Standard errors to either side of an estimate. Convention: 95 percent."""
POWER = 0.8
"""Chance with which a change is seen that is called the smallest to be seen. Convention: 80 percent."""


def holm(p_values: Sequence[float]) -> list[float]:
    """Each p value as it is to be compared with `LEVEL`, in their order; NaN stays and does not count."""
    p = np.asarray(p_values, dtype=np.float64)
    adjusted = np.full(p.size, np.nan)
    order = [int(i) for i in np.argsort(p) if np.isfinite(p[i])]
    largest = 0.0
    for rank, index in enumerate(order):
        largest = max(largest, min(1.0, (len(order) - rank) * float(p[index])))
        adjusted[index] = largest
    return [float(value) for value in adjusted]


def two_sided(z: float) -> float:
    """Chance of so many standard errors to either side."""
    return float(2.0 * norm.sf(abs(z)))


def seen_from(tests: int) -> float:
    """Standard errors of a change that is seen with `POWER` where it is one of so many tests."""
    return float(norm.isf(0.5 * LEVEL / max(tests, 1)) + norm.ppf(POWER))
