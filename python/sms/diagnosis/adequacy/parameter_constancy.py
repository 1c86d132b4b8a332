"""One law, one number: whether a cause is of the same size everywhere, as that of a law that is right.

A leak that is twice as large at high pressure as the law says is another leak, however well a compromise may fit. So
the records are divided along each signal, and each part asked for the size separately. Divided are the windows, by
their means: what else is free may move in each part by itself. And divided are the moments at which the cause acts
(localisation/activity.py): that is sharper, because a signal runs further within a second than means of seconds do, and
because on a machine with legs each leg counts by its own signal.

No law is right everywhere to the last percent, and where the rest of the model is a little wrong a small leak is of
another size in each part. So sizes of its own for each part are an extension of the model like any other, and have to
take what a cause has to take: most of what is left (partial R^2, from the F statistic of a Chow test over the parts).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.adequacy.subset_estimates import (
    Beside,
    Estimate,
    beside,
    column_of,
    drawn_over,
    inflation_of,
    linear,
    parts_of,
)
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.localisation.activity import Activity, activity, own_signals
from sms.diagnosis.other_records import refitted_with_slopes
from sms.diagnosis.thresholds import APART_BY, LEAST_SHARE
from sms.estimation.windows import Runs


@dataclass(frozen=True)
class Inconstancy:
    """A cause that is of one size where a signal is low, and of another where it is high."""

    effect: Effect
    signal: str
    """Signal with its SI unit, "chamber_pressure_lower [Pa]"."""
    cut: float
    """Between low and high, SI."""
    low: Estimate
    high: Estimate
    takes: float
    """Of the squares of what the model leaves: what a size for each quarter of the signal would take."""

    @property
    def apart(self) -> float:
        return abs(self.high[0] - self.low[0])


def inconstancy(fitted: Fitted, effect: Effect, data: Data) -> Inconstancy | None:
    """The signal along which sizes of a cause would take most, if it is not the same everywhere."""
    now = fitted.params[effect.parameters[0]]
    shift = abs(now - data.rig.declared(effect.parameters[0]).value)
    parted = [law for ask in (_by_windows, _by_moments) for law in ask(fitted, effect, data)]
    other = [law for law in parted if law.takes > LEAST_SHARE and law.apart > APART_BY * shift]
    return max(other, key=lambda law: law.takes, default=None)


def _by_windows(fitted: Fitted, effect: Effect, data: Data) -> Iterator[Inconstancy]:
    """Windows divided by their means."""
    parts = parts_of(fitted, effect, data)
    rows = sum(int(part.rows.sum()) for part in parts)

    def sizes(signal: str, cuts: Array) -> Sizes | None:
        found = [
            _together([p.size(np.digitize(p.mean[signal], cuts, right=True) == k) for p in parts])
            for k in range(len(cuts) + 1)
        ]
        if any(f is None for f in found):
            return None
        value, error = np.array([f for f in found if f is not None]).T
        return Sizes(value, np.diag(error**2))

    for signal in (n for n in parts[0].mean if all(n in p.mean for p in parts)):
        values = np.concatenate([p.mean[signal] for p in parts])
        if (law := _law(effect, signal, values, sizes, rows / inflation_of(data))) is not None:
            yield law


def _by_moments(fitted: Fitted, effect: Effect, data: Data) -> Iterator[Inconstancy]:
    """Moments divided by the signal then."""
    roles = [
        _in_time(data.identify, fitted, effect),
        _in_time(data.validate, refitted_with_slopes(fitted, data), effect),
    ]
    known = [role for role in roles if role is not None]
    if len(known) < len(roles):
        return
    now = fitted.params[effect.parameters[0]]
    rows = sum(len(role.activity.column) for role in known)

    def sizes(signal: str, cuts: Array) -> Sizes | None:
        found = linear(np.sum([role.parted(signal, cuts) for role in known], axis=0), rows)
        return None if found is None else Sizes(now + found[0], inflation_of(data) * found[1])

    for signal in (n for n in known[0].signals if all(n in role.signals for role in known)):
        values = np.concatenate([role.signals[signal].ravel() for role in known])
        if (law := _law(effect, signal, values, sizes, rows / inflation_of(data))) is not None:
            yield law


@dataclass(frozen=True)
class Sizes:
    """Of a cause, one for each part."""

    value: Array
    covariance: Array

    def takes(self, rows: float) -> float:
        """Partial R^2 of sizes of its own for each part against one size: q / (q + rows), as of any regression."""
        weight = np.linalg.inv(self.covariance)
        together = float(weight.sum(axis=0) @ self.value / weight.sum())
        off = self.value - together
        q = float(off @ weight @ off)
        return q / (q + rows)

    def estimate(self, part: int) -> Estimate:
        return float(self.value[part]), float(np.sqrt(self.covariance[part, part]))


def _law(
    effect: Effect,
    signal: str,
    values: Array,
    sizes: Callable[[str, Array], Sizes | None],
    rows: float,
) -> Inconstancy | None:
    """Halves say how the size changes; quarters what a law of any smooth shape would take."""
    cut = float(np.median(values))
    halves = sizes(signal, np.array([cut]))
    if halves is None:
        return None
    quarters = sizes(signal, np.unique(np.quantile(values, [0.25, 0.5, 0.75]))) or halves
    return Inconstancy(
        effect, signal, cut, halves.estimate(0), halves.estimate(1), quarters.takes(rows)
    )


@dataclass(frozen=True)
class _InTime:
    """When a cause acts, for one role's records."""

    activity: Activity
    signals: dict[str, Array]
    """(windows, inputs x knots) each."""
    beside: Beside

    def parted(self, signal: str, cuts: Array) -> Array:
        """(m + 1, m + 1): products of the sensitivities in each of m parts of the signal, and of the residual."""
        part = np.digitize(self.signals[signal], cuts, right=True)
        columns = [self.activity.where(part == k) for k in range(len(cuts))]
        columns.append(self.activity.column - np.sum(columns, axis=0))
        return self.beside.gram(np.column_stack(columns))


def _in_time(runs: Runs, at: Fitted, effect: Effect) -> _InTime | None:
    """None for a cause that does not act on the equations."""
    found = activity(runs, at.params, column_of(runs, at, effect))
    if found is None:
        return None
    return _InTime(found, own_signals(runs, drawn_over(runs)), beside(at, effect))


def _together(estimates: Sequence[Estimate | None]) -> Estimate | None:
    """The weighted mean of independent estimates."""
    known = [e for e in estimates if e is not None]
    if not known:
        return None
    weight = np.array([1.0 / e**2 for _, e in known])
    mean = float(np.sum(weight * np.array([v for v, _ in known])) / np.sum(weight))
    return mean, float(1.0 / np.sqrt(np.sum(weight)))
