"""Covariance of least-squares parameters when neighbouring residuals are alike.

Residuals of a transient are seldom white: what the model lacks lasts longer than a sample. Taken as
stationary, their memory is an autoregression whose order the data choose (Yule-Walker, Bayesian
information criterion; order 0 is white noise), and least squares keep their estimate but not their
error: cov = N^-1 (J' G J) N^-1 with N = J'J and G the covariance of the residuals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_toeplitz
from scipy.signal import fftconvolve

from sms.diagnosis.result import Array

LARGEST_ORDER = 12
PATIENCE = 3
"""Orders tried without gain before the search for the memory's length ends."""
FORGOTTEN = 1e-3
"""Of its autocorrelation, below which a residual has forgotten its past."""


@dataclass(frozen=True)
class Colour:
    """The memory of a residual."""

    variance: float
    coefficients: Array
    """(order,) of the autoregression; empty: white."""

    def autocovariance(self, longest: int) -> Array:
        """(m,) at lags 0 .. m - 1, up to where it is forgotten, at the most `longest`."""
        order = self.coefficients.size
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
    return Colour(variance, chosen)


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
