"""One law, one number: whether a cause is of the same size everywhere, as that of a law that is right.

A leak that is twice as large at high pressure as the law says is another leak, however well a compromise may fit. So
the records are halved along each signal, and the two halves asked for the size separately. Halved are the windows, by
their means: what else is free may move in each half by itself. And halved are the moments at which the cause acts
(localisation/activity.py): that is sharper, because a signal runs further within a second than means of seconds do, and
because on a machine with legs each leg counts by its own signal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
from sms.diagnosis.hypothesis import Data, Fitted, refitted
from sms.diagnosis.localisation.activity import Activity, activity, own_signals
from sms.diagnosis.thresholds import APART, APART_BY, APART_IN_TIME
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


def inconstancy(fitted: Fitted, effect: Effect, data: Data) -> Inconstancy | None:
    """The signal along which a cause's size differs most, if it is not the same everywhere."""
    now = fitted.params[effect.parameters[0]]
    shift = abs(now - data.rig.declared(effect.parameters[0]).value)
    windows, moments = (ask(fitted, effect, data) for ask in (_halves_of_windows, _halves_in_time))
    apart = [h for h in windows if h.apart > max(APART_BY * shift, APART * h.error)]
    apart += [h for h in moments if h.apart > max(APART_IN_TIME * shift, APART * h.error)]
    return max(apart, key=lambda h: h.apart / h.error).law if apart else None


@dataclass(frozen=True)
class _Halves:
    law: Inconstancy
    error: float
    """Of the difference between the two sizes."""

    @property
    def apart(self) -> float:
        return abs(self.law.high[0] - self.law.low[0])


def _halves_of_windows(fitted: Fitted, effect: Effect, data: Data) -> Iterator[_Halves]:
    """Windows with the lower means, and the others."""
    parts = parts_of(fitted, effect, data)
    for signal in (n for n in parts[0].mean if all(n in p.mean for p in parts)):
        cut = float(np.median(np.concatenate([p.mean[signal] for p in parts])))
        low = _together([p.size(p.mean[signal] <= cut) for p in parts])
        high = _together([p.size(p.mean[signal] > cut) for p in parts])
        if low is not None and high is not None:
            error = float(np.hypot(low[1], high[1]))
            yield _Halves(Inconstancy(effect, signal, cut, low, high), error)


def _halves_in_time(fitted: Fitted, effect: Effect, data: Data) -> Iterator[_Halves]:
    """Moments at which the signal is lower, and the others."""
    parts = [
        _in_time(data.identify, fitted, effect),
        _in_time(data.validate, refitted(fitted, data), effect),
    ]
    known = [part for part in parts if part is not None]
    if len(known) < len(parts):
        return
    now = fitted.params[effect.parameters[0]]
    rows = sum(len(part.activity.column) for part in known)
    for signal in (n for n in known[0].signals if all(n in part.signals for part in known)):
        cut = float(np.median(np.concatenate([part.signals[signal].ravel() for part in known])))
        found = linear(np.sum([part.halved(signal, cut) for part in known], axis=0), rows)
        if found is not None:
            step, covariance = found[0], inflation_of(data) * found[1]
            low, high = (
                (now + float(d), float(e))
                for d, e in zip(step, np.sqrt(np.diag(covariance)), strict=True)
            )
            difference = np.array([-1.0, 1.0])
            error = float(np.sqrt(difference @ covariance @ difference))
            yield _Halves(Inconstancy(effect, signal, cut, low, high), error)


@dataclass(frozen=True)
class _InTime:
    """When a cause acts, for one role's records."""

    activity: Activity
    signals: dict[str, Array]
    """(windows, inputs x knots) each."""
    beside: Beside

    def halved(self, signal: str, cut: float) -> Array:
        """(3, 3): products of the sensitivities where the signal is below the cut, above it, and of the residual."""
        low = self.activity.where(self.signals[signal] <= cut)
        return self.beside.gram(np.column_stack([low, self.activity.column - low]))


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
