"""Since when a size is another one: a generalised likelihood ratio over a series of estimates.

Under the null hypothesis the size is one constant. Under the alternative it is constant up to a diagnosis, and from
then on another constant (a step), or grows in proportion to the time since (a ramp). Each moment and both courses are
tried, which is what a CUSUM for a change of unknown size does (Page 1954; Basseville and Nikiforov 1993, section 2.4),
for a series that is complete: the largest gain in 2 log likelihood, that is the weighted sum of squares that the course
takes away, is compared with the chi-square that each of them would have alone, divided by how many were tried
(Bonferroni). Where what is left scatters more than the standard errors say, the gain counts in units of that scatter.
The moments whose likelihood is within 3.84 of the best, 95 percent of the chi-square of one parameter, are the
interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.stats import chi2

from sms.arrays import Array

FEWEST = 4
"""Estimates: with fewer a course of two numbers and a moment explains all. Judgement."""
WITHIN = float(chi2.ppf(0.95, 1))


@dataclass(frozen=True)
class ChangePoint:
    """Where a series changes. Numbers are places in the series."""

    course: Literal["step", "ramp"]
    first: int
    """The first estimate that is changed."""
    earliest: int
    latest: int
    """Of the first changed one, 95 percent."""
    p_value: float
    """Of a change so clear anywhere if there were none."""


def change_point(time: Array, size: Array, error: Array) -> ChangePoint | None:
    """The change that explains sizes (n,) with standard errors (n,) at ascending times (n,) in s best; None for fewer
    than four. Whether it is one, its p value says."""
    n = len(time)
    if n < FEWEST:
        return None
    root = 1.0 / error
    constant = _left(root, size, np.empty((n, 0)))
    tried = [("step", k, (np.arange(n) >= k).astype(float)) for k in range(1, n)]
    # A ramp that begins at estimate k - 1 changes estimate k first; one that begins at the last is a step there.
    tried += [
        ("ramp", k, np.maximum(time - time[k - 1], 0.0) / max(time[-1] - time[0], 1.0))
        for k in range(1, n - 1)
        if time[k] > time[k - 1]
    ]
    left = np.array([_left(root, size, course[:, None]) for _, _, course in tried])
    best = int(np.argmin(left))
    scatter = max(float(left[best]) / max(n - 3, 1), 1.0)
    p_value = min(1.0, len(tried) * float(chi2.sf((constant - left[best]) / scatter, 1)))
    near = [
        k for (_, k, _), r in zip(tried, left, strict=True) if r - left[best] <= WITHIN * scatter
    ]
    course: Literal["step", "ramp"] = "step" if tried[best][0] == "step" else "ramp"
    return ChangePoint(course, tried[best][1], min(near), max(near), p_value)


def _left(root: Array, size: Array, courses: Array) -> float:
    """Weighted sum of squares that a constant and these courses (n, k) leave."""
    design = root[:, None] * np.column_stack([np.ones(len(size)), courses])
    reading = root * size
    found = np.linalg.lstsq(design, reading, rcond=None)[0]
    return float(np.sum((reading - design @ found) ** 2))
