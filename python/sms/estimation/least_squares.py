"""Least squares in few evaluations, for problems whose evaluation is a simulation of every window.

Gauss-Newton with bounds: each step solves the linearised problem within the bounds exactly (bounded-variable least
squares, Stark and Parker 1995), shortens it while it does not help, and stops when it promises or gains next to
nothing. The residuals are in units of the noise, so that is a number: 0.5 of chi-square, and more for a model
that misses by far more than the noise, whose last digit nobody reads.

A Jacobian costs as much as many residuals. While steps bring about what they promise it is kept, corrected by what each
step has shown (Broyden 1965); a fit ends with a Jacobian that was worked out where it ends, if it may work out so many.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.optimize import lsq_linear

from sms import _core
from sms.arrays import Array
from sms.estimation.problem import Problem

ENOUGH = 0.5
"""Of chi-square, which is about one a row: what a step has to gain to be followed by another."""
LEAST_SHARE, MOST_SHARE = 1e-4, 1e-2
"""Of chi-square itself, besides: from a model at the noise to one that misses by ten times its variance."""
AS_PROMISED = 0.5
"""Of the promised gain: with at least as much, the Jacobian is kept for the next step. Run time."""
SECANTS = 4
"""Steps with one Jacobian, in the mean, before a fit is given up. Run time."""
MOST_STEPS = 12
MOST_HALVINGS = 3


class Solution(Protocol):
    """What a fit brings, the core's or this one's."""

    @property
    def params(self) -> _core.Params: ...
    @property
    def residual(self) -> Array: ...
    @property
    def jacobian(self) -> Array: ...
    @property
    def at_bound(self) -> list[bool]: ...
    @property
    def converged(self) -> bool: ...


@dataclass(frozen=True)
class WindowFit:
    """Residual (rows,) and Jacobian (rows, free) at the solution."""

    params: _core.Params
    residual: Array
    jacobian: Array
    at_bound: list[bool]
    converged: bool


@dataclass(frozen=True)
class Free:
    """A parameter that may move between two bounds, pulled to `centre` with the weight `pull` per unit."""

    name: str
    lower: float
    upper: float
    pull: float
    centre: float

    @property
    def scale(self) -> float:
        if self.pull > 0.0:
            return 1.0 / self.pull
        return max(abs(self.centre), 1e-3 * (self.upper - self.lower))


def changed(params: _core.Params, names: list[str], values: Array) -> _core.Params:
    """The same parameters but for some."""
    copy = params.copy()
    for name, value in zip(names, values, strict=True):
        copy[name] = float(value)
    return copy


def fit_windows(
    problem: Problem,
    initial: _core.Params,
    free: list[Free],
    most_steps: int = MOST_STEPS,
    pull: Array | None = None,
    slopes: Array | None = None,
) -> WindowFit:
    """Minimise |residual|^2 + |pull (value - centre)|^2 within the bounds, from `initial`.

    pull: (r, free) per unit; each parameter's own if left out. slopes: (rows, free), a Jacobian from nearby to begin
    with. most_steps: Jacobians that are worked out at most.
    """
    names = [f.name for f in free]
    scale = np.array([f.scale for f in free])
    pull = (np.diag([f.pull for f in free]) if pull is None else pull) * scale
    lower = np.array([f.lower for f in free]) / scale
    upper = np.array([f.upper for f in free]) / scale
    centre = np.array([f.centre for f in free]) / scale
    value = np.clip(np.array([initial[n] for n in names]) / scale, lower, upper)

    def at(value: Array) -> _core.Params:
        within = np.clip(value * scale, [f.lower for f in free], [f.upper for f in free])
        return changed(initial, names, within)

    def cost(residual: Array, value: Array) -> float:
        return float(residual @ residual + np.sum((pull @ (value - centre)) ** 2))

    def slopes_at(value: Array) -> tuple[Array, Array]:
        residual, jacobian = problem.evaluate(at(value), names)
        return residual, jacobian * scale

    exact = slopes is None
    residual, slope = (
        slopes_at(value) if slopes is None else (problem.evaluate(at(value), ())[0], slopes * scale)
    )
    worked_out, converged = int(exact), not free
    for _ in range(SECANTS * most_steps if free else 0):
        here = cost(residual, value)
        little = ENOUGH + _worthless(residual, slope)
        step = _linear_step(slope, residual, pull, value - centre, lower - value, upper - value)
        promised = here - cost(residual + slope @ step, value + step)
        gained, length, tried = 0.0, 1.0, value
        for _ in range(MOST_HALVINGS + 1 if exact else 1):
            if promised * length * (2.0 - length) < little:
                break
            tried = np.clip(value + length * step, lower, upper)
            after, _ = problem.evaluate(at(tried))
            gained = here - cost(after, tried)
            if gained > 0.0:
                break
            length *= 0.4
        moved, value = tried - value, tried if gained > 0.0 else value
        if exact and gained < little:
            converged = True
            if gained > 0.0:
                residual, slope = slopes_at(value)
            break
        if gained >= max(little, AS_PROMISED * promised):
            missed = (after - residual - slope @ moved) / max(float(moved @ moved), 1e-300)
            slope += np.outer(missed, moved)
            residual, exact = after, False
        elif worked_out < most_steps:
            residual, slope = slopes_at(value)
            exact, worked_out = True, worked_out + 1
        else:
            residual = after if gained > 0.0 else residual
            break
    if not exact and worked_out < most_steps:
        residual, slope = slopes_at(value)
    margin = 1e-6
    held = ((value <= lower + margin) | (value >= upper - margin)).tolist()
    return WindowFit(at(value), np.asarray(residual), np.asarray(slope / scale), held, converged)


def _worthless(residual: Array, jacobian: Array) -> float:
    """Of chi-square, what is next to nothing for a model that leaves so much where it has a slope at all."""
    felt = residual[np.any(jacobian, axis=1)]
    if not felt.size:
        return 0.0
    left = float(felt @ felt)
    share = 0.1 * MOST_SHARE * (left / felt.size - 1.0)
    return min(max(LEAST_SHARE, share), MOST_SHARE) * left


def _triangular(gram: Array) -> Array:
    """Upper triangle R with R'R = gram: that of a QR decomposition, from products that are a hundred times smaller."""
    value, vector = np.linalg.eigh(gram)
    root = np.sqrt(np.maximum(value, 0.0))[:, None] * vector.T
    return np.asarray(np.linalg.qr(root, mode="r"))


def _linear_step(
    jacobian: Array, residual: Array, pull: Array, off: Array, low: Array, high: Array
) -> Array:
    """The step that minimises the linearised cost with low <= step <= high."""
    k = jacobian.shape[1]
    gram = np.empty((k + 1, k + 1))
    gram[:k, :k] = jacobian.T @ jacobian + pull.T @ pull
    gram[:k, k] = gram[k, :k] = jacobian.T @ residual + pull.T @ (pull @ off)
    gram[k, k] = float(residual @ residual + np.sum((pull @ off) ** 2))
    r = _triangular(gram)
    damped = np.vstack([r[:k, :k], 1e-6 * np.diag(np.linalg.norm(r[:k, :k], axis=0) + 1e-12)])
    target = np.concatenate([-r[:k, k], np.zeros(k)])
    room = np.maximum(high - low, 1e-12)
    found = lsq_linear(
        damped,
        target,
        (np.minimum(low, 0.0) - 1e-12 * room, np.maximum(high, 0.0) + 1e-12 * room),
        method="bvls",
    )
    return np.asarray(found.x)
