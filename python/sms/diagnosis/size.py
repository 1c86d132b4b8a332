"""How large a cause is: in one record alone, and where a signal is low or high.

A law that is right has one number. Estimated from a part of the windows it comes out the same, whichever part: a leak
that is twice as large at high pressure as the law says is another leak, however well a compromise may fit. So the
windows are halved along each signal, and the two halves asked for the number separately. What else is free may move in
each of them by itself, within what is declared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sms.diagnosis.catalogue import Effect
from sms.diagnosis.evidence import value_of
from sms.diagnosis.hypothesis import Data, Fitted, nuisance_of, refitted
from sms.diagnosis.result import Array, ParameterValue
from sms.diagnosis.runs import Runs
from sms.diagnosis.statistics import Index
from sms.diagnosis.visible import raw_columns

APART = 10.0
"""Standard errors between the halves' sizes from which a law counts as another one."""
APART_BY = 0.2
"""Of the size itself, besides: no description of friction or flow is right to the last tenth everywhere."""

Estimate = tuple[float, float]
"""Value and standard error."""


@dataclass(frozen=True)
class OtherLaw:
    """A cause that is of one size where a signal is low, and of another where it is high."""

    effect: Effect
    signal: str
    """Signal with its SI unit, "chamber_pressure_lower [Pa]"; the mean over a window counts."""
    cut: float
    """Between low and high, SI."""
    low: Estimate
    high: Estimate


@dataclass(frozen=True)
class _ByWindow:
    """The normal equations of a cause's parameter beside all that is free, for each window of one role's records."""

    value: float
    gram: Array
    """(windows, k + 2, k + 2): products of the columns of what is free, of the cause, and of the residual."""
    pull: Array
    """(k,) squared, per unit of the columns."""
    pulled: Array
    """(k,) the same times the distance from what is declared."""
    scale: float
    """Of the cause's column."""
    rows: Index
    """(windows,)"""
    names: list[str]
    """Of the records."""
    record: Index
    """(windows,): place in them."""
    mean: dict[str, Array]
    """(windows,) of each signal."""

    def size(self, chosen: NDArray[np.bool_]) -> Estimate | None:
        """The parameter as these windows alone have it; None where they do not show it."""
        k = len(self.pull)
        gram = self.gram[chosen].sum(axis=0)
        free = gram[:k, :k] + np.diag(self.pull)
        undone = np.linalg.pinv(free, rcond=1e-12, hermitian=True) @ gram[:k, k]
        information = float(gram[k, k] - gram[:k, k] @ undone)
        if information <= 1e-12 * float(gram[k, k]):
            return None
        score = float(gram[k, k + 1] - undone @ (gram[:k, k + 1] + self.pulled))
        left = float(gram[k + 1, k + 1]) / float(self.rows[chosen].sum())
        return (
            self.value - score / information / self.scale,
            float(np.sqrt(left / information)) / self.scale,
        )


def found_value(fitted: Fitted, effect: Effect, data: Data) -> ParameterValue:
    """A cause's parameter. Its error is that of the fit or that between records, whichever is larger."""
    name = effect.parameters[0]
    own = fitted.standard_error(name)
    estimates = list(record_by_record(fitted, effect, data).values())
    weight = np.array([1.0 / e**2 for _, e in estimates])
    values = np.array([v for v, _ in estimates])
    between = 0.0
    if len(values) > 1:
        centre = float(np.sum(weight * values) / np.sum(weight))
        between = float(
            np.sqrt(np.sum(weight * (values - centre) ** 2) / np.sum(weight) / (len(values) - 1))
        )
    return value_of(fitted, name, data.rig.declared(name).value, max(own, between))


def record_by_record(fitted: Fitted, effect: Effect, data: Data) -> dict[str, Estimate]:
    """Record -> the parameter refitted on it alone with its error, the free parameters within what is declared."""
    out = {}
    for part in _parts(fitted, effect, data):
        for number, name in enumerate(part.names):
            found = part.size(part.record == number)
            if found is not None:
                out[name] = found
    return out


def other_law(fitted: Fitted, effect: Effect, data: Data) -> OtherLaw | None:
    """The signal along which a cause's size differs most, if it is not the same everywhere."""
    parts = _parts(fitted, effect, data)
    shift = abs(parts[0].value - data.rig.declared(effect.parameters[0]).value)
    found, most = None, APART
    for signal in (n for n in parts[0].mean if all(n in p.mean for p in parts)):
        cut = float(np.median(np.concatenate([p.mean[signal] for p in parts])))
        low = _together([p.size(p.mean[signal] <= cut) for p in parts])
        high = _together([p.size(p.mean[signal] > cut) for p in parts])
        if low is None or high is None:
            continue
        apart = abs(high[0] - low[0])
        errors = apart / float(np.hypot(low[1], high[1]))
        if errors > most and apart > APART_BY * shift:
            found, most = OtherLaw(effect, signal, cut, low, high), errors
    return found


def _together(estimates: Sequence[Estimate | None]) -> Estimate | None:
    """The weighted mean of independent estimates."""
    known = [e for e in estimates if e is not None]
    if not known:
        return None
    weight = np.array([1.0 / e**2 for _, e in known])
    mean = float(np.sum(weight * np.array([v for v, _ in known])) / np.sum(weight))
    return mean, float(1.0 / np.sqrt(np.sum(weight)))


def _parts(fitted: Fitted, effect: Effect, data: Data) -> list[_ByWindow]:
    """Of the records that were fitted, and of those that were not."""
    assert isinstance(data.identify, Runs) and isinstance(data.validate, Runs)
    return [
        _by_window(data.identify, fitted, effect),
        _by_window(data.validate, refitted(fitted, data), effect),
    ]


def _by_window(runs: Runs, at: Fitted, effect: Effect) -> _ByWindow:
    name = effect.parameters[0]
    residual = at.fit.residual
    column = _column(runs, at, effect)
    nuisance = nuisance_of(at)
    if name in nuisance.names:
        nuisance = nuisance.without(name)
    columns = np.column_stack([nuisance.jacobian, column])
    scale = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    stacked = np.column_stack([columns / scale, residual])
    first = np.flatnonzero(np.diff(runs.block, prepend=-1))
    parts = np.split(stacked, first[1:])
    rows = np.array([len(part) for part in parts])
    pull = nuisance.pull / scale[:-1]
    return _ByWindow(
        at.params[name],
        np.array([part.T @ part for part in parts]),
        pull**2,
        pull * nuisance.pull * nuisance.off,
        float(scale[-1]),
        rows,
        [run.name for run in runs.motions],
        runs.record[first],
        {n: np.add.reduceat(v, first) / rows for n, v in _drawn_over(runs).items()},
    )


def _column(runs: Runs, at: Fitted, effect: Effect) -> Array:
    """(rows,): change of the residual with the cause's parameter."""
    free = list(at.hypothesis.free)
    if effect.step is None and effect.parameters[0] in free:
        return at.fit.jacobian[:, free.index(effect.parameters[0])]
    return raw_columns(at, runs, [effect])[:, 0]


def _drawn_over(runs: Runs) -> dict[str, Array]:
    """(rows,) each: what the machine was doing; of what goes both ways, how far too."""
    inputs = runs.inputs
    both = {n: v for n, v in inputs.items() if np.min(v) < 0.0 < np.max(v)}
    return inputs | {f"magnitude of {n}": np.abs(v) for n, v in both.items()}
