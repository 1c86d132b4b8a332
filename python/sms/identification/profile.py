"""Profile likelihood: the cost over one parameter with all others fitted again.

Its interval is where the cost stays below a chi-squared limit; where that never rises the parameter is not
identifiable, whatever number the fit ended on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.identification.estimate import LIMIT_95, Estimate

_REFITS = 14  # a side of a profile


@dataclass(frozen=True)
class Profile:
    """The cost over one parameter with all others fitted again."""

    name: str
    value: Array
    """(points,), rising"""
    rise: Array
    """(points,): cost above its minimum, in units in which LIMIT_95 is the 95 percent limit."""
    lower: float
    upper: float
    closed_below: bool
    closed_above: bool
    """False where the parameter's bound was reached first: any value up to there fits."""

    @property
    def closed(self) -> bool:
        """Whether the data alone hold the parameter on both sides."""
        return self.closed_below and self.closed_above

    @property
    def half_width(self) -> float:
        """Half of the interval."""
        return 0.5 * (self.upper - self.lower)


def profile(found: Estimate, name: str) -> Profile:
    """The 95 percent interval of one parameter by its profile likelihood, coloured residuals and all."""
    i = found.index(name)
    unit = max(found.variance, 1e-300) * float(found.inflation[i])
    total = _total_cost(found, found.params)
    others = [f for f in found.free if f.name != name]
    # A breath of a pull where none is declared: what the held value leaves without effect stays put.
    bounds = [
        (f.name, f.lower, f.upper, 1.0 / (f.known_to or 1e6 * (f.upper - f.lower))) for f in others
    ]

    def rise_at(value: float, near: _core.Params) -> tuple[float, _core.Params]:
        moved = near.copy()
        moved[name] = value
        for f in others:  # the pull is towards the start of the whole fit
            start = found.start[f.name] if f.known_to else near[f.name]
            moved[f.name] = min(max(start, f.lower), f.upper)
        fit = _core.fit(
            found.problem, moved, bounds, found.weight, tolerance=1e-7, huber=found.huber
        )
        return (_total_cost(found, fit.params) - total) / unit, fit.params

    points = [(float(found.value[i]), 0.0)]
    ends = [
        _walk(points, rise_at, found, i, sign, bound)
        for sign, bound in ((-1.0, found.free[i].lower), (1.0, found.free[i].upper))
    ]
    points.sort()
    value, rise = np.array(points).T
    (lower, below), (upper, above) = ends
    return Profile(name, value, np.maximum(rise, 0.0), lower, upper, below, above)


def _total_cost(found: Estimate, params: _core.Params) -> float:
    """What the fit minimises, pulls included."""
    residual, _ = found.problem.evaluate(params)
    size = np.abs(residual * found.weight)
    if found.huber > 0.0:
        soft = size > found.huber
        size = np.where(soft, np.sqrt(np.maximum(found.huber * (2 * size - found.huber), 0)), size)
    pulls = [(params[f.name] - found.start[f.name]) / f.known_to for f in found.free if f.known_to]
    return float(size @ size) + float(np.sum(np.square(pulls)))


def _walk(
    points: list[tuple[float, float]],
    rise_at: Callable[[float, _core.Params], tuple[float, _core.Params]],
    found: Estimate,
    i: int,
    sign: float,
    bound: float,
) -> tuple[float, bool]:
    """Out from the estimate until the rise passes the limit; (end of the interval, whether it did)."""
    centre = float(found.value[i])
    if sign * (bound - centre) <= 1e-9 * max(abs(bound), 1.0):
        return centre, False
    sd = float(np.sqrt(found.covariance[i, i]))
    step = 1.5 * sd if np.isfinite(sd) and sd > 0.0 else 0.05 * abs(bound - centre)
    inside, inside_rise, near = centre, 0.0, found.params
    outside: tuple[float, float] | None = None
    for _ in range(_REFITS):
        if outside is None:
            trial = inside + sign * step
            trial = bound if sign * (trial - bound) > 0.0 else trial
            step *= 2.0
        else:  # sqrt(rise) is nearly straight
            low, high = np.sqrt(max(inside_rise, 0.0)), np.sqrt(outside[1])
            share = (np.sqrt(LIMIT_95) - low) / max(high - low, 1e-12)
            trial = inside + float(np.clip(share, 0.05, 0.95)) * (outside[0] - inside)
        rise, moved = rise_at(trial, near)
        points.append((trial, rise))
        if rise > LIMIT_95:
            outside = (trial, rise)
        else:
            inside, inside_rise, near = trial, rise, moved
            if trial == bound:
                return bound, False
        if abs(rise - LIMIT_95) < 0.15:
            return trial, True
    return (outside[0], True) if outside is not None else (inside, False)
