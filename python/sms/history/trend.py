"""A straight line through sizes with standard errors, and when it reaches a limit.

Weighted least squares. Where the sizes scatter more about the line than their standard errors say (from day to day,
from mounting to mounting), all errors are enlarged by the Birge ratio sqrt(chi^2 / degrees) (Birge 1932), never made
smaller, and Student's t takes the place of the normal distribution.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import norm, t

from sms.arrays import Array

FEWEST = 3
"""Sizes for a line that can be wrong. Convention."""
DAY = 86400.0
MONTH = 365.25 / 12.0 * DAY


@dataclass(frozen=True)
class Line:
    """size = level + slope * (time - middle). SI; slope per second."""

    middle: float
    level: float
    level_error: float
    slope: float
    slope_error: float
    """Both uncorrelated, since `middle` is the weighted mean of the times."""
    birge: float
    """Factor by which the errors were enlarged, 1 at least."""
    quantile: float
    """Errors to either side of an estimate for 95 percent."""
    p_value: float
    """Of a slope so large if there were none."""

    def at(self, time: float) -> float:
        """Its value, (SI)."""
        return self.level + self.slope * (time - self.middle)


def line_through(time: Array, size: Array, error: Array) -> Line | None:
    """The line through sizes (n,) with standard errors (n,) at times (n,) in s; None for fewer than three times."""
    if len(time) < FEWEST or np.unique(time).size < FEWEST:
        return None
    weight = 1.0 / error**2
    middle = float(np.average(time, weights=weight))
    away = time - middle
    level = float(np.average(size, weights=weight))
    moment = float(np.sum(weight * away**2))
    slope = float(np.sum(weight * away * size)) / moment
    degrees = len(time) - 2
    left = float(np.sum(weight * (size - level - slope * away) ** 2)) / degrees
    birge = math.sqrt(max(left, 1.0))
    errors = birge / math.sqrt(float(weight.sum())), birge / math.sqrt(moment)
    enlarged = birge > 1.0
    quantile = float(t.ppf(0.975, degrees) if enlarged else norm.ppf(0.975))
    z = abs(slope) / errors[1]
    p_value = float(2.0 * (t.sf(z, degrees) if enlarged else norm.sf(z)))
    return Line(middle, level, errors[0], slope, errors[1], birge, quantile, p_value)


@dataclass(frozen=True)
class Reached:
    """When a line is at a limit, s since 1970, with half the width of its 95 percent interval."""

    limit: float
    time: float
    half_width: float


def reaches(line: Line, limit: float) -> Reached | None:
    """When; None where the slope may be zero, so that the line may never get there. To first order in the errors."""
    if abs(line.slope) <= line.quantile * line.slope_error:
        return None
    ahead = (limit - line.level) / line.slope
    error = math.hypot(line.level_error, ahead * line.slope_error) / abs(line.slope)
    return Reached(limit, line.middle + ahead, line.quantile * error)
