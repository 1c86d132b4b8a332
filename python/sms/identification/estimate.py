"""One fit and its diagnostics: standard errors, correlations, warnings.

`estimate` fits a Problem of the core and gives the covariance with coloured residuals, and
warnings at bounds and at a bad condition. Intervals of what is hardly identifiable: profile.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from sms import _core
from sms.arrays import Array
from sms.estimation.coloured_noise import Colour, colour_of, coloured_meat
from sms.parameters import PARAMETERS

BAD_CONDITION = 1e4
"""Condition number beyond which two parameters are nearly collinear; exact derivatives reach 1e7."""
LIMIT_95 = float(chi2.ppf(0.95, 1))


@dataclass(frozen=True)
class Free:
    """A parameter to fit, within bounds, and what is known of it before."""

    name: str
    lower: float
    upper: float
    known_to: float = 0.0
    """Standard uncertainty of its start; 0: unknown."""

    @classmethod
    def of(cls, name: str, known_to: float = 0.0) -> Free:
        """Within the bounds of params.def."""
        return cls(name, PARAMETERS[name].lower, PARAMETERS[name].upper, known_to)


@dataclass(frozen=True)
class Estimate:
    """The result of one fit. Arrays follow `free`; SI units."""

    problem: _core.Problem
    start: _core.Params
    free: tuple[Free, ...]
    weight: Array
    huber: float
    params: _core.Params
    value: Array
    covariance: Array
    """(k, k); rows and columns of a parameter at its bound, or without effect there, are nan."""
    inflation: Array
    """(k,): variance with coloured residuals over that with white ones."""
    variance: float
    """Of a weighted residual: 1 when the weights are the noise's."""
    colours: tuple[Colour, ...]
    """The memory of the residual, one a series."""
    residual: Array
    jacobian: Array
    cost: float
    condition: float
    """With what is known before; large: some parameters are one."""
    at_bound: tuple[bool, ...]
    converged: bool
    iterations: int
    starts: int = 1
    minima: int = 1
    """Distinct minima that the starts ended in."""

    @property
    def scale(self) -> float:
        """Root mean square of a weighted residual."""
        return float(np.sqrt(self.variance))

    def index(self, name: str) -> int:
        """Where a parameter stands in the arrays."""
        return [f.name for f in self.free].index(name)

    def sd(self, name: str) -> float:
        """Standard uncertainty from the fit alone; nan at a bound."""
        i = self.index(name)
        return float(np.sqrt(self.covariance[i, i]))

    @property
    def correlation(self) -> Array:
        """(k, k)"""
        sd = np.sqrt(np.diag(self.covariance))
        return np.asarray(self.covariance / np.outer(sd, sd))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know before the numbers."""
        said = []
        for f, bound, value in zip(self.free, self.at_bound, self.value, strict=True):
            if bound:
                said.append(f"{f.name} ended at its bound, {value:g}: no estimate")
        if self.condition > BAD_CONDITION:
            said.append(
                f"condition number {self.condition:.2g}: some parameters are nearly collinear on "
                "these records; see the correlation map"
            )
        if not self.converged:
            said.append(f"the fit did not converge in {self.iterations} steps")
        return tuple(said)


def estimate(
    problem: _core.Problem,
    starts: Sequence[_core.Params],
    free: Sequence[Free],
    weight: Array,
    counted: NDArray[np.bool_] | None = None,
    huber: float = 0.0,
    series: Sequence[NDArray[np.intp]] = (),
    states: int = 0,
    tolerance: float = 1e-8,
    last_steps: int = 0,
) -> Estimate:
    """Fit `free` to a problem from each of `starts` and keep the best.

    Args:
        problem: whose rows follow each other in time.
        starts: of all parameters; those that are not free stay as in the first.
        free: what to fit.
        weight: (rows,), 1 over the standard deviation of a row.
        counted: (rows,), the rows that the noise is judged on; by default all.
        huber: weighted residuals beyond it count with their size; 0: least squares.
        series: the rows of each signal, in time; every one has a noise of its own. Empty: all rows are one.
        states: how many numbers the problem fits inside, initial states and the like.
        tolerance: relative, on cost and on parameters.
        last_steps: Gauss-Newton steps at the end that compare no costs. Where a problem searches for initial states
            up to a threshold, its cost is known to that only, and a comparison of costs ends too early.

    Raises: ValueError for a start outside its bounds or a parameter to which the records are insensitive.
    """
    bounds = [(f.name, f.lower, f.upper, 1.0 / f.known_to if f.known_to else 0.0) for f in free]
    fits = [
        _core.fit(problem, start, bounds, weight, tolerance=tolerance, huber=huber)
        for start in starts
    ]
    lowest = min(fits, key=lambda fit: fit.cost)
    best = _Solution.of(lowest)
    for _ in range(last_steps):
        best = _last_step(problem, best, starts[0], free, weight, huber)
    jacobian = best.jacobian * weight[:, None]
    weighted = best.residual * weight
    if huber > 0.0:
        weighted = np.clip(weighted, -huber, huber)
    every = series or (np.arange(weighted.size),)
    spent = (len(free) + states) // len(every)
    of_series = [rows if counted is None else rows[counted[rows]] for rows in every]
    colours = [colour_of(weighted[rows], spent) for rows in of_series]
    covariance, inflation = _covariance(
        jacobian, free, best.at_bound, list(zip(every, colours, strict=True))
    )
    sizes = np.array([rows.size for rows in of_series])
    variance = float(np.average([c.variance for c in colours], weights=sizes))
    level = LIMIT_95 * max(variance, 1e-300)
    higher = {round(fit.cost / level) for fit in fits if fit.cost > lowest.cost + level}
    return Estimate(
        problem=problem,
        start=starts[0],
        free=tuple(free),
        weight=weight,
        huber=huber,
        params=best.params,
        value=np.array([best.params[f.name] for f in free]),
        covariance=covariance,
        inflation=inflation,
        variance=variance,
        colours=tuple(colours),
        residual=best.residual,
        jacobian=best.jacobian,
        cost=lowest.cost,
        condition=_condition(jacobian, free),
        at_bound=tuple(best.at_bound),
        converged=lowest.converged,
        iterations=lowest.iterations,
        starts=len(fits),
        minima=1 + len(higher),
    )


@dataclass(frozen=True)
class _Solution:
    """Where a fit stands; arrays as those of Fit."""

    params: _core.Params
    residual: Array
    jacobian: Array
    at_bound: tuple[bool, ...]

    @classmethod
    def of(cls, fit: _core.Fit) -> _Solution:
        return cls(fit.params, fit.residual, fit.jacobian, tuple(fit.at_bound))


def _last_step(
    problem: _core.Problem,
    at: _Solution,
    start: _core.Params,
    free: Sequence[Free],
    weight: Array,
    huber: float,
) -> _Solution:
    """One Gauss-Newton step within the bounds; none where it would lead far, beyond four standard deviations."""
    inside = np.flatnonzero(~np.array(at.at_bound))
    if inside.size == 0:
        return at
    moved = [free[int(i)] for i in inside]
    pull = np.array([1.0 / f.known_to if f.known_to else 0.0 for f in moved])
    off = np.array([at.params[f.name] - start[f.name] for f in moved])
    r = at.residual * weight
    soft = np.sqrt(huber / np.maximum(np.abs(r), huber)) if huber > 0.0 else np.ones(r.size)
    j = np.vstack([at.jacobian[:, inside] * (weight * soft)[:, None], np.diag(pull)])
    length = np.maximum(np.linalg.norm(j, axis=0), 1e-300)
    bread = np.linalg.pinv((j / length).T @ (j / length), rcond=1e-14, hermitian=True)
    step = -bread @ ((j / length).T @ np.concatenate([r * soft, pull * off]))
    if np.max(np.abs(step) / np.sqrt(np.maximum(np.diag(bread), 1e-300))) > 4.0:
        return at
    params = at.params.copy()
    for f, change in zip(moved, step / length, strict=True):
        params[f.name] = float(np.clip(params[f.name] + change, f.lower, f.upper))
    residual, jacobian = problem.evaluate(params, [f.name for f in free])
    return _Solution(params, residual, jacobian, at.at_bound)


def _condition(jacobian: Array, free: Sequence[Free]) -> float:
    """Of columns of length one, with what is known before as further rows; 1 for one parameter."""
    known = np.array([1.0 / f.known_to**2 if f.known_to else 0.0 for f in free])
    normal = jacobian.T @ jacobian + np.diag(known)
    length = np.sqrt(np.diag(normal))
    inside = length > 0.0
    scaled = normal[np.ix_(inside, inside)] / np.outer(length[inside], length[inside])
    values = np.linalg.eigvalsh(scaled) if inside.any() else np.ones(1)
    return float(np.sqrt(values[-1] / max(values[0], 1e-16)))


def _covariance(
    jacobian: Array,
    free: Sequence[Free],
    at_bound: Sequence[bool],
    series: Sequence[tuple[NDArray[np.intp], Colour]],
) -> tuple[Array, Array]:
    """Covariance (k, k) and inflation (k,); a parameter at a bound or without effect is taken as fixed."""
    k = len(free)
    felt = np.linalg.norm(jacobian, axis=0) > 0.0
    inside = np.flatnonzero(felt & ~np.array(at_bound, dtype=bool))
    known = np.array([1.0 / f.known_to**2 if f.known_to else 0.0 for f in free])
    prior = np.diag(known[inside])
    columns = jacobian[:, inside]
    length = np.sqrt(np.maximum(np.sum(columns**2, axis=0) + np.diag(prior), 1e-300))
    columns, prior = columns / length, prior / np.outer(length, length)
    bread = np.linalg.pinv(columns.T @ columns + prior, rcond=1e-14)
    white, coloured = prior.copy(), prior.copy()
    for rows, colour in series:
        own = columns[rows]
        white += colour.variance * (own.T @ own)
        coloured += coloured_meat(own, colour)
    white, coloured = bread @ white @ bread, bread @ coloured @ bread
    covariance = np.full((k, k), np.nan)
    covariance[np.ix_(inside, inside)] = coloured / np.outer(length, length)
    inflation = np.ones(k)
    inflation[inside] = np.diag(coloured) / np.maximum(np.diag(white), 1e-300)
    return covariance, inflation


def sensitivity(found: Estimate, names: Sequence[str]) -> Array:
    """d(estimate) / d(known parameter), (k, names): by how much a wrong one would shift the fit."""
    _, columns = found.problem.evaluate(found.params, list(names))
    weighted = found.jacobian * found.weight[:, None]
    inside = np.flatnonzero(np.isfinite(np.diag(found.covariance)))
    length = np.linalg.norm(weighted[:, inside], axis=0)
    j = weighted[:, inside] / length
    prior = np.array([1.0 / f.known_to**2 if f.known_to else 0.0 for f in found.free])[inside]
    normal = j.T @ j + np.diag(prior / length**2)
    shift = -np.linalg.pinv(normal, rcond=1e-14) @ (j.T @ (columns * found.weight[:, None]))
    out = np.zeros((len(found.free), len(names)))
    out[inside] = shift / length[:, None]
    return out


def with_start(params: _core.Params, **values: float) -> _core.Params:
    """A copy with some parameters set."""
    out = params.copy()
    for name, value in values.items():
        out[name] = value
    return out
