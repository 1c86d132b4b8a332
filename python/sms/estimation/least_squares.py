"""Least squares in few evaluations, for problems whose evaluation is a simulation of every window.

Gauss-Newton with bounds: each step solves the linearised problem within the bounds exactly (bounded-variable least
squares, Stark and Parker 1995), shortens it while it does not help, and stops when it promises or gains next to
nothing. The residuals are in units of the noise, so that is a number: 0.5 of chi-square, and more for a model
that is only compared with others and misses by far more than the noise.

A window in which a piston breaks away does not follow its slopes: the moment at which it does so has a kink, and where
the minimum of that window lies on the kink no step that the others ask for gains anything. A fit that may set windows
aside does so with those that alone take back what a step promises.

A Jacobian costs as much as many residuals. While steps bring about what they promise it is kept, corrected by what each
step has shown (Broyden 1965); a fit ends with a Jacobian that was worked out where it ends, if it may work out so many.
Sensitivities to what hardly moves may be taken over from a model nearby, and are then only corrected so.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from sms import _core
from sms.arrays import Array, Index
from sms.estimation.problem import Problem

ENOUGH = 0.5
"""Of chi-square, which is about one a row: what a step has to gain to be followed by another."""
LEAST_SHARE, MOST_SHARE = 1e-4, 1e-2
"""Of chi-square itself, besides, of a model that is only compared: from one at the noise to one that misses by ten
times its variance."""
AS_PROMISED = 0.5
"""Of the promised gain: with at least as much, the Jacobian is kept for the next step. Run time."""
SECANTS = 4
"""Steps with one Jacobian, in the mean, before a fit is given up. Run time."""
MOST_STEPS = 12
MOST_HALVINGS = 3
MOST_ASIDE = 0.2
"""Share of the windows that a fit may set aside. Judgement: what is left is still what it is asked about."""
ON_BOUND, ON_EXPECTED = 1e-6, 1e-9
"""Of a parameter's scale: nearer to a bound it is on it; the second of a bound that is the expected value. Numerics."""


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
    counted: Index | None = None
    """The rows of the windows that were not set aside; None: all."""


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


def counted_rows(fit: Solution) -> Index:
    """The rows of the windows that a fit has not set aside."""
    counted = fit.counted if isinstance(fit, WindowFit) else None
    return np.arange(len(fit.residual)) if counted is None else counted


def changed(params: _core.Params, names: list[str], values: Array) -> _core.Params:
    """The same parameters but for some."""
    copy = params.copy()
    for name, value in zip(names, values, strict=True):
        copy[name] = float(value)
    return copy


class _Objective:
    """|residual|^2 + |pull (value - centre)|^2 of the parameters over their scales, value (free,), and its bounds."""

    def __init__(
        self,
        problem: Problem,
        initial: _core.Params,
        free: list[Free],
        pull: Array | None,
        window: Index | None,
    ) -> None:
        self._problem = problem
        self._window = window
        self._aside = np.zeros(0 if window is None else int(window.max(initial=-1)) + 1, dtype=bool)
        self._initial = initial
        self._free = free
        self._names = [f.name for f in free]
        self.scale = np.array([f.scale for f in free])
        self.pull = (np.diag([f.pull for f in free]) if pull is None else pull) * self.scale
        self.lower = np.array([f.lower for f in free]) / self.scale
        self.upper = np.array([f.upper for f in free]) / self.scale
        self.centre = np.array([f.centre for f in free]) / self.scale

    @property
    def start(self) -> Array:
        return self.within(np.array([self._initial[n] for n in self._names]) / self.scale)

    def within(self, value: Array) -> Array:
        return np.asarray(np.clip(value, self.lower, self.upper))

    def at_bound(self, value: Array) -> NDArray[np.bool_]:
        """(free,) whether a bound holds it.

        One that is the expected value itself does not hold a small share of a range of many decades: a supply line
        whose pressure loss is a little turbulent is not at the end of what can be.
        """
        low = np.where(self.lower < self.centre, ON_BOUND, ON_EXPECTED)
        high = np.where(self.upper > self.centre, ON_BOUND, ON_EXPECTED)
        return np.asarray((value <= self.lower + low) | (value >= self.upper - high))

    def params(self, value: Array) -> _core.Params:
        low, high = [f.lower for f in self._free], [f.upper for f in self._free]
        return changed(self._initial, self._names, np.clip(value * self.scale, low, high))

    def residual(self, value: Array) -> Array:
        return self._problem.evaluate(self.params(value), ())[0]

    def begun(self, value: Array, nearby: Mapping[str, Array]) -> _Iterate:
        """With the sensitivities of a model nearby; those that it does not have are worked out."""
        new = [k for k, name in enumerate(self._names) if name not in nearby]
        residual, jacobian = self._worked_out(value, new)
        if len(new) == len(self._names):
            return _Iterate(value, residual, jacobian, exact=True)
        slope = np.empty((len(residual), len(self._names)))
        slope[:, new] = jacobian
        for k, name in enumerate(self._names):
            if name in nearby:
                slope[:, k] = nearby[name] * self.scale[k]
        return _Iterate(value, residual, slope, exact=False)

    def work_out(self, at: _Iterate, kept: Collection[str]) -> None:
        """Residual and Jacobian where it stands, but for the sensitivities that are kept."""
        new = [k for k, name in enumerate(self._names) if name not in kept]
        if anew := len(new) == len(self._names):
            at.slope = np.empty((0, 0))  # its memory is needed now
        at.residual, jacobian = self._worked_out(at.value, new)
        at.exact = True
        if anew:
            at.slope = jacobian
        else:
            at.slope[:, new] = jacobian

    def _worked_out(self, value: Array, numbers: list[int]) -> tuple[Array, Array]:
        """Residual (rows,) and the Jacobian (rows, numbers) of some of the parameters."""
        names = [self._names[k] for k in numbers]
        residual, jacobian = self._problem.evaluate(self.params(value), names)
        jacobian *= self.scale[numbers]
        return residual, jacobian

    def counted(self, rows: Array) -> Array:
        """The rows of a residual or a Jacobian (rows, ...) that no window set aside has."""
        which = self.which_count()
        return rows if which is None else np.asarray(rows[which])

    def which_count(self) -> Index | None:
        """The numbers of these rows; None where all count."""
        if self._window is None or not self._aside.any():
            return None
        return np.flatnonzero(~self._aside[self._window])

    def cost(self, residual: Array, value: Array) -> float:
        counted = self.counted(residual)
        return float(counted @ counted + np.sum((self.pull @ (value - self.centre)) ** 2))

    def step(self, at: _Iterate) -> Array:
        """To where the linearised problem is solved."""
        slope, residual = self.counted(at.slope), self.counted(at.residual)
        low, high = self.lower - at.value, self.upper - at.value
        return _linear_step(slope, residual, self.pull, at.value - self.centre, low, high)

    def set_aside(self, expected: Array, after: Array, promised: float) -> bool:
        """The windows of which each alone leaves more than expected, residuals (rows,), by all that a step promised, if
        there are any and not too many."""
        if self._window is None:
            return False
        more = np.bincount(self._window, after**2 - expected**2, len(self._aside))
        spoil = (more > promised) & ~self._aside
        if not spoil.any() or np.sum(self._aside | spoil) > MOST_ASIDE * len(self._aside):
            return False
        self._aside |= spoil
        return True


@dataclass
class _Iterate:
    """Where a fit stands: parameters over their scales, what they leave, and the Jacobian that is gone by."""

    value: Array
    residual: Array
    slope: Array
    exact: bool  # the Jacobian was worked out here, not corrected by steps


def fit_windows(
    problem: Problem,
    initial: _core.Params,
    free: list[Free],
    most_steps: int = MOST_STEPS,
    pull: Array | None = None,
    nearby: Mapping[str, Array] | None = None,
    kept: Collection[str] = (),
    window: Index | None = None,
) -> WindowFit:
    """Minimise |residual|^2 + |pull (value - centre)|^2 within the bounds, from `initial`.

    pull: (r, free) per unit; each parameter's own if left out. most_steps: Jacobians that are worked out at most.
    nearby: (rows,) sensitivity to each parameter to begin with; those of the parameters in `kept` are never worked out.
    window: (rows,) which window each row belongs to, if the values are stated. Windows that do not follow their slopes
    may then be set aside, and a step is worth ENOUGH, however much is left: of a model that is a little wrong
    everywhere a share of that is a standard error of a size.
    """
    objective = _Objective(problem, initial, free, pull, window)
    at = objective.begun(objective.start, nearby or {})
    worked_out, converged = int(at.exact), not free
    for _ in range(SECANTS * most_steps if free else 0):
        little = ENOUGH + (_worthless(at.residual, at.slope) if window is None else 0.0)
        tried, after, gained, promised = _line_search(objective, at, little)
        moved = tried - at.value
        if gained > 0.0:
            at.value = tried
        if at.exact and gained < little:
            converged = True
            if gained > 0.0:
                objective.work_out(at, kept)
            break
        if gained >= max(little, AS_PROMISED * promised):
            missed = (after - at.residual - at.slope @ moved) / max(float(moved @ moved), 1e-300)
            at.slope += np.outer(missed, moved)
            at.residual, at.exact = after, False
        elif worked_out < most_steps:
            objective.work_out(at, kept)
            worked_out += 1
        else:
            at.residual = after if gained > 0.0 else at.residual
            break
    if not at.exact and worked_out < most_steps:
        objective.work_out(at, kept)
    held = objective.at_bound(at.value)
    return WindowFit(
        objective.params(at.value),
        np.asarray(at.residual),
        np.asarray(at.slope / objective.scale),
        held.tolist(),
        converged,
        objective.which_count(),
    )


def _line_search(
    objective: _Objective, at: _Iterate, little: float
) -> tuple[Array, Array, float, float]:
    """Where the linearised problem is solved, or nearer while that gains nothing.

    The parameters tried last, what they leave, what they gain of the cost, and what the full step promised. A corrected
    Jacobian is given one trial only.
    """
    here, step = objective.cost(at.residual, at.value), objective.step(at)
    promised = here - objective.cost(at.residual + at.slope @ step, at.value + step)
    tried, after, gained, length = at.value, at.residual, 0.0, 1.0
    for _ in range(MOST_HALVINGS + 1 if at.exact else 1):
        if promised * length * (2.0 - length) < little:
            break
        tried = objective.within(at.value + length * step)
        after = objective.residual(tried)
        gained = here - objective.cost(after, tried)
        if gained > 0.0:
            break
        if at.exact and length == 1.0:
            expected = at.residual + at.slope @ (tried - at.value)
            if objective.set_aside(expected, after, promised):
                return _line_search(objective, at, little)
        length *= 0.4
    return tried, after, gained, promised


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
