"""Covariance of least-squares parameters when neighbouring residuals are alike.

Residuals of a transient are seldom white: what the model lacks lasts longer than a sample. Taken as
stationary, their memory is an autoregression whose order the data choose (Yule-Walker, Bayesian
information criterion; order 0 is white noise), or white noise over a slow part that fades
exponentially, where that explains more: a small slow part hardly shows from one sample to the next
and still decides how well a mean over many is known. Least squares keep their estimate but not their
error: cov = N^-1 (J' G J) N^-1 with N = J'J and G the covariance of the residuals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_toeplitz
from scipy.signal import fftconvolve, lfilter

from sms.arrays import Array

LARGEST_ORDER = 12
PATIENCE = 3
"""Orders tried without gain before the search for the memory's length ends."""
MEMORIES = (3.0, 5.0, 8.0, 13.0, 20.0, 30.0, 50.0, 80.0)
"""Samples over which a slow part may fade to 1/e."""
FORGOTTEN = 1e-3
"""Of its autocorrelation, below which a residual has forgotten its past."""


@dataclass(frozen=True)
class Colour:
    """The memory of a residual."""

    variance: float
    coefficients: Array
    """(order,) of the autoregression; empty: white."""
    slow: tuple[float, float] = (0.0, 0.0)
    """Share of the variance that is slow, and what of it is left after one sample; instead of an autoregression."""

    def autocovariance(self, longest: int) -> Array:
        """(m,) at lags 0 .. m - 1, up to where it is forgotten, at the most `longest`."""
        order = self.coefficients.size
        share, keep = self.slow
        if share > 0.0:
            lags = np.arange(min(longest, 1 + int(np.log(FORGOTTEN / share) / np.log(keep))))
            return self.variance * np.where(lags == 0, 1.0, share * keep**lags)
        if order == 0:
            return np.array([self.variance])
        rho = list(self._first())
        while len(rho) < longest and max(np.abs(rho[-order:])) > FORGOTTEN:
            rho.append(float(self.coefficients @ np.array(rho[-1 : -order - 1 : -1])))
        return self.variance * np.array(rho[:longest])

    def _first(self) -> Array:
        """Autocorrelation at lags 0 .. order, from the Yule-Walker equations."""
        order = self.coefficients.size
        system = np.eye(order + 1)
        for lag in range(1, order + 1):
            for k, a in enumerate(self.coefficients, 1):
                system[lag, abs(lag - k)] -= a
        right = np.zeros(order + 1)
        right[0] = 1.0
        return np.asarray(np.linalg.solve(system, right))

    @property
    def samples_as_one(self) -> float:
        """How many samples say as much as one of white noise."""
        rho = self.autocovariance(100_000) / self.variance if self.variance > 0.0 else np.ones(1)
        return max(float(2.0 * rho.sum() - 1.0), 1.0)


def colour_of(residual: Array, spent: int) -> Colour:
    """The memory of a residual (n,) that `spent` parameters were fitted to."""
    n = residual.size
    variance = float(residual @ residual) / max(n - spent, 1)
    largest = min(LARGEST_ORDER, n // 10)
    if largest < 1 or variance == 0.0:
        return Colour(variance, np.empty(0))
    r = np.array([residual[: n - lag] @ residual[lag:] for lag in range(largest + 1)]) / n
    best, chosen = n * np.log(r[0]), np.empty(0)
    for order in range(1, largest + 1):
        if order > chosen.size + PATIENCE:
            break
        a = solve_toeplitz(r[:order], r[1 : order + 1])
        left = r[0] - float(a @ r[1 : order + 1])
        score = n * np.log(max(left, 1e-300)) + order * np.log(n)
        if score < best:
            best, chosen = score, a
    slow, score = _slow_part(residual)
    if score < best:
        return Colour(variance, np.empty(0), slow)
    return Colour(variance, chosen)


def _slow_part(residual: Array) -> tuple[tuple[float, float], float]:
    """White noise over a part that fades: (share, left after a sample) and its score; inf where there is none.

    The share is fitted to the autocovariance at the lags over which it fades; its likelihood is that of the
    innovations, white noise over an autoregression of order one being an ARMA(1, 1) process.
    """
    n = residual.size
    best: tuple[tuple[float, float], float] = (0.0, 0.0), float("inf")
    total = float(residual @ residual)
    usable = [m for m in MEMORIES if 3.0 * m < n / 10]
    if not usable:
        return best
    longest = int(3.0 * usable[-1])
    r = np.array([residual[: n - lag] @ residual[lag:] for lag in range(1, longest + 1)]) / total
    for memory in usable:
        keep = float(np.exp(-1.0 / memory))
        fades = keep ** np.arange(1, int(3.0 * memory) + 1)
        share = float(r[: fades.size] @ fades / (fades @ fades))
        if not 0.0 < share < 0.98:
            continue
        ratio = keep * (share - 1.0) / (1.0 + keep**2 * (1.0 - 2.0 * share))
        moving = (1.0 - np.sqrt(max(1.0 - 4.0 * ratio**2, 0.0))) / (2.0 * ratio)
        innovations = lfilter([1.0, -keep], [1.0, moving], residual)
        score = n * np.log(float(innovations @ innovations) / n) + 2.0 * np.log(n)
        if score < best[1]:
            best = (share, keep), float(score)
    return best


def coloured_meat(jacobian: Array, colour: Colour) -> Array:
    """J' G J (k, k) of a jacobian (n, k) whose rows follow each other in time."""
    gamma = colour.autocovariance(jacobian.shape[0])
    if gamma.size == 1:
        return np.asarray(gamma[0] * (jacobian.T @ jacobian))
    kernel = np.concatenate((gamma[:0:-1], gamma))[:, None]
    spread = fftconvolve(jacobian, kernel, mode="full", axes=0)
    spread = spread[gamma.size - 1 : gamma.size - 1 + jacobian.shape[0]]
    meat = jacobian.T @ spread
    return np.asarray(0.5 * (meat + meat.T))
