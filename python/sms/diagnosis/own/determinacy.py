"""Which of a model's free parameters its records can tell, and which only together.

The baseline's Jacobian, in units of the noise and with what is declared known as rows of its own, is taken by the
logarithm of each parameter (one that may change its sign: by its range). A direction in which parameters may move from
bound to bound within three standard errors is one of which nothing is known. Where it is that of two parameters, they
are known in a product, a ratio or a sum: the plant holds them nowhere else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from sms.arrays import Array
from sms.diagnosis.fitting import weights_of
from sms.diagnosis.hypothesis import Fitted
from sms.diagnosis.own.model import Model, Parameter
from sms.diagnosis.result import Finding, Undetermined
from sms.diagnosis.thresholds import DETECTION
from sms.units_display import format_quantity

SINGULAR = 1e-6
"""Of the largest singular value: what central differences cannot tell from zero. Numerics."""
TAKES_PART = 0.03
"""Of the largest part in a direction. Numerics: derivatives are good to better than that."""
DENOMINATOR, NEAR = 4, 0.02
"""Of an exponent that is written as a fraction, and how near to it is the same. Judgement."""


@dataclass(frozen=True)
class _Axis:
    """A parameter along which a direction may go."""

    parameter: Parameter
    logarithm: bool
    """Whether by its logarithm: it keeps its sign between its bounds."""
    size: float
    """Change of the parameter a unit along the axis."""
    room: float
    """Units from one bound to the other."""

    @classmethod
    def of(cls, p: Parameter, value: float) -> _Axis:
        """At a value that it has."""
        if p.lower * p.upper > 0.0:
            return cls(p, True, abs(value), abs(float(np.log(p.upper / p.lower))))
        return cls(p, False, p.upper - p.lower, 1.0)


def undetermined(model: Model, fitted: Fitted) -> tuple[Undetermined, ...]:
    """What the fit of the baseline leaves open, and the parameters of `fit=True` that leave no trace at all."""
    h = fitted.hypothesis
    blind = [p for p in model.parameters if p.fit and p.name not in h.free]
    found = [
        Undetermined(
            (p.name,),
            "",
            f"{p.name} leaves no trace in these records: its value is where it began, "
            f"{format_quantity(p.value, p.unit, p.name)}, and no estimate. Declare it, or take a record that it moves.",
        )
        for p in blind
    ]
    names = [p.name for p in model.parameters if p.name in h.free]
    if not names:
        return tuple(found)
    axes = [_Axis.of(model.parameter(n), fitted.params[n]) for n in names]
    place = [list(h.free).index(n) for n in names]
    slopes = np.vstack([fitted.fit.jacobian[:, place].astype(np.float64), weights_of(h, names)])
    slopes = slopes * np.array([a.size for a in axes])
    return (*found, *(_said(axes, direction) for direction in _open(slopes, axes)))


def _open(slopes: Array, axes: Sequence[_Axis]) -> Array:
    """(directions, axes): each with as few parameters as may be."""
    _, s, turned = np.linalg.svd(slopes, full_matrices=False)
    room = np.array([a.room for a in axes])
    reach = np.min(room / np.maximum(np.abs(turned), 1e-300), axis=1)
    free = (s <= SINGULAR * s[0]) | (reach * s < DETECTION)
    return _few(turned[free])


def _few(directions: Array) -> Array:
    """The same space by rows that have one parameter each to themselves (Gauss-Jordan with column pivots)."""
    rows = directions.copy()
    taken: list[int] = []
    for k in range(len(rows)):
        size = np.abs(rows[k])
        size[taken] = 0.0
        pivot = int(np.argmax(size))
        taken.append(pivot)
        rows[k] /= rows[k, pivot]
        others = np.arange(len(rows)) != k
        rows[others] -= np.outer(rows[others, pivot], rows[k])
    return np.asarray(rows)


def _said(axes: Sequence[_Axis], direction: Array) -> Undetermined:
    large = np.abs(direction) > TAKES_PART * np.max(np.abs(direction))
    parts = [(a, float(d)) for a, d, takes in zip(axes, direction, large, strict=True) if takes]
    names = tuple(a.parameter.name for a, _ in parts)
    listed = f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else names[0]
    if len(parts) == 1:
        return Undetermined(
            names,
            "",
            f"These records do not tell {listed}: anything between its bounds fits as well; its value is no estimate. "
            "Declare it with an uncertainty, or take a record that it moves.",
        )
    known = _known(parts) if len(parts) == 2 else ""
    only = (
        f"Only {known} is known"
        if known
        else f"Of {listed} only what they do together is known, not the value of each"
    )
    return Undetermined(
        names,
        known,
        f"{only}: the values of {listed} are no estimates. Declare one of them with an uncertainty, or take a record "
        "that tells them apart.",
    )


def _known(parts: Sequence[tuple[_Axis, float]]) -> str:
    """ "the product resistance x compliance": what does not change along a direction; empty without a short name."""
    (first, by_first), (second, by_second) = parts
    one, other = first.parameter.name, second.parameter.name
    if first.logarithm != second.logarithm:
        return ""
    if not first.logarithm:
        factor = -(by_first * first.size) / (by_second * second.size)
        if abs(abs(factor) - 1.0) < NEAR:
            return f"the {'sum' if factor > 0.0 else 'difference'} {one} {'+' if factor > 0.0 else '-'} {other}"
        return f"the sum {one} {'+' if factor > 0.0 else '-'} {abs(factor):.3g} {other}"
    exponent = -by_first / by_second
    near = Fraction(exponent).limit_denominator(DENOMINATOR)
    if abs(float(near) - exponent) > NEAR * abs(exponent) or not near:
        return ""
    a, b = near.denominator, abs(near.numerator)
    left, right = (n if power == 1 else f"{n}^{power}" for n, power in ((one, a), (other, b)))
    return f"the product {left} x {right}" if near > 0 else f"the ratio {left} / {right}"


def at_bounds(model: Model, fitted: Fitted) -> tuple[Finding, ...]:
    """Parameters of the baseline that end where they may go no further."""
    found = []
    for name, held in zip(fitted.hypothesis.free, fitted.fit.at_bound, strict=True):
        p, value = model.parameter(name), fitted.params[name]
        if not held:
            continue
        low, high = fitted.hypothesis.free[name]
        end = "lower" if value - low < high - value else "upper"
        at = format_quantity(value, p.unit, name)
        if p.fit:
            said = f"fitted, {name} ends at its {end} bound, {at}, which is no estimate"
            remedy = "widen its bounds if it may be beyond, or look for what it makes up for"
        else:
            said = f"{name} ends at the {end} end of its declared uncertainty, {at}"
            remedy = "check what is declared of it, or look for what it makes up for"
        found.append(Finding("warning" if p.fit else "note", model.title, None, None, said, remedy))
    return tuple(found)
