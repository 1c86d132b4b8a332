"""Steffen's monotone slopes, for whoever draws a curve through the valve's table."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def steffen_slopes(x: Array, y: Array) -> Array:
    """Slopes at the rows after M. Steffen (1990); zero at the first and the last."""
    h, s = np.diff(x), np.diff(y) / np.diff(x)
    mean = (s[:-1] * h[1:] + s[1:] * h[:-1]) / (h[:-1] + h[1:])
    smallest = np.minimum(np.minimum(abs(s[:-1]), abs(s[1:])), 0.5 * abs(mean))
    return np.concatenate(([0.0], (np.sign(s[:-1]) + np.sign(s[1:])) * smallest, [0.0]))
