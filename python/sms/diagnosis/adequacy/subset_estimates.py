"""How large a cause is: over all records, in one of them alone, and in any part of their windows.

A part is asked by itself: what else is free may move in it as it likes, within what is declared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array, Index
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.evidence import value_of
from sms.diagnosis.fitting import nuisance_of, with_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted_with_slopes
from sms.diagnosis.result import ParameterValue
from sms.diagnosis.selection.identifiability import raw_columns
from sms.estimation.nuisance import Nuisance
from sms.estimation.windows import Runs

Estimate = tuple[float, float]
"""Value and standard error."""


@dataclass(frozen=True)
class ByWindow:
    """The normal equations of a cause's parameter beside all that is free, for each window of one role's records."""

    value: float
    gram: Array
    """(windows, k + 2, k + 2): products of the columns of what is free, of the cause, and of the residual."""
    pull: Array
    """(k, k): product of the rows that pull to what is declared with themselves, per unit of the columns."""
    pulled: Array
    """(k,): the same with how far the values are from it."""
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
    inflation: float
    """How many times larger the variance of an estimate is than residuals as they are counted have it."""

    def size(self, chosen: NDArray[np.bool_]) -> Estimate | None:
        """The parameter as these windows alone have it; None where they do not show it."""
        k = len(self.pull)
        gram = self.gram[chosen].sum(axis=0)
        free = gram[:k, :k] + self.pull
        undone = np.linalg.pinv(free, rcond=1e-12, hermitian=True) @ gram[:k, k]
        information = float(gram[k, k] - gram[:k, k] @ undone)
        if information <= 1e-12 * float(gram[k, k]):
            return None
        score = float(gram[k, k + 1] - undone @ (gram[:k, k + 1] + self.pulled))
        left = float(gram[k + 1, k + 1]) / float(self.rows[chosen].sum())
        return (
            self.value - score / information / self.scale,
            float(np.sqrt(self.inflation * left / information)) / self.scale,
        )


def found_value(fitted: Fitted, effect: Effect, data: Data) -> ParameterValue:
    """A cause's parameter. To its error comes by how much records differ beyond theirs, in the mean of those fitted."""
    name = effect.parameters[0]
    own = fitted.standard_error(name)
    identified, validated = (estimates_of(part) for part in parts_of(fitted, effect, data))
    every = [*identified.values(), *validated.values()]
    weight = np.array([1.0 / error**2 for _, error in (identified.values() or every)])
    shared = (
        variance_between(every) * float(np.sum(weight**2) / np.sum(weight) ** 2) if every else 0.0
    )
    return value_of(
        fitted, name, data.rig.declared(name).value, float(np.hypot(own, np.sqrt(shared)))
    )


def variance_between(estimates: Sequence[Estimate]) -> float:
    """By how much the values of records vary beyond their standard errors, as a variance; 0 where they vary by less.

    One size for each record, drawn about a mean (random effects; DerSimonian and Laird, Controlled Clinical Trials 7,
    1986).
    """
    value, error = np.array(estimates, dtype=np.float64).reshape(-1, 2).T
    if len(value) < 2:
        return 0.0
    weight = 1.0 / error**2
    total = float(weight.sum())
    spread = float(weight @ (value - weight @ value / total) ** 2)
    return max(0.0, (spread - (len(value) - 1)) / (total - float(weight @ weight) / total))


def record_by_record(fitted: Fitted, effect: Effect, data: Data) -> dict[str, Estimate]:
    """Record -> the parameter refitted on it alone with its error, the free parameters within what is declared."""
    return {n: e for part in parts_of(fitted, effect, data) for n, e in estimates_of(part).items()}


def estimates_of(part: ByWindow) -> dict[str, Estimate]:
    """The same of the records of one role."""
    found = {name: part.size(part.record == number) for number, name in enumerate(part.names)}
    return {name: estimate for name, estimate in found.items() if estimate is not None}


def parts_of(fitted: Fitted, effect: Effect, data: Data) -> list[ByWindow]:
    """A cause window by window, of the records that were fitted and of those that were not."""
    return [
        _by_window(
            data.identify, with_sensitivities(fitted, data.identify), effect, inflation_of(data)
        ),
        _by_window(data.validate, refitted_with_slopes(fitted, data), effect, inflation_of(data)),
    ]


def inflation_of(data: Data) -> float:
    """How many times larger the variance of an estimate is than residuals as they are counted have it."""
    return 1.0 if data.healthy is None else data.healthy.inflation


def _by_window(runs: Runs, at: Fitted, effect: Effect, inflation: float) -> ByWindow:
    name = effect.parameters[0]
    residual = at.whiten(at.fit.residual)
    column = at.whiten(column_of(runs, at, effect))
    nuisance = _others_free(at, effect)
    columns = np.column_stack([nuisance.jacobian, column])
    size = np.linalg.norm(columns, axis=0)
    scale = np.where(size > 0.0, size, 1.0)
    stacked = np.column_stack([columns / scale, residual])
    first = np.flatnonzero(np.diff(runs.block, prepend=-1))
    parts = np.split(stacked, first[1:])
    rows = np.array([len(part) for part in parts])
    pull = nuisance.pull / scale[:-1]
    return ByWindow(
        at.params[name],
        np.array([part.T @ part for part in parts]),
        pull.T @ pull,
        pull.T @ nuisance.departure,
        float(scale[-1]),
        rows,
        [run.name for run in runs.motions],
        runs.record[first],
        {n: np.add.reduceat(v, first) / rows for n, v in drawn_over(runs).items()},
        inflation,
    )


@dataclass(frozen=True)
class Beside:
    """What all else that is free cannot undo of a cause, at one model."""

    at: Fitted
    nuisance: Nuisance
    """Whitened."""
    basis: Array
    residual: Array
    """(rows + known,), whitened, less what the others can undo."""

    def gram(self, columns: Array) -> Array:
        """(m + 1, m + 1): products of sensitivities (rows, m) and of the residual, less what the others can undo."""
        full = self.nuisance.with_declared(self.at.whiten(columns))
        left = np.column_stack([full - self.basis @ (self.basis.T @ full), self.residual])
        return np.asarray(left.T @ left)


def beside(at: Fitted, effect: Effect) -> Beside:
    nuisance = _others_free(at, effect)
    basis = nuisance.basis()
    full = np.concatenate([at.whiten(at.fit.residual), nuisance.departure])
    return Beside(at, nuisance, basis, full - basis @ (basis.T @ full))


def linear(gram: Array, rows: int) -> tuple[Array, Array] | None:
    """The step (m,) from such products, summed over records, and its covariance (m, m); None where one is not seen."""
    information, score = gram[:-1, :-1], gram[:-1, -1]
    if np.linalg.det(information) <= 1e-12 * float(np.prod(np.diag(information))):
        return None
    inverse = np.linalg.inv(information)
    step = -inverse @ score
    return step, inverse * float(gram[-1, -1] + score @ step) / rows


def _others_free(at: Fitted, effect: Effect) -> Nuisance:
    nuisance, name = nuisance_of(at, white=True), effect.parameters[0]
    return nuisance.without(name) if name in nuisance.names else nuisance


def column_of(runs: Runs, at: Fitted, effect: Effect) -> Array:
    """(rows,): change of the residual with the cause's parameter."""
    free = list(at.hypothesis.free)
    if effect.step is None and effect.parameters[0] in free:
        return at.fit.jacobian[:, free.index(effect.parameters[0])]
    return raw_columns(at, runs, [effect])[:, 0]


def drawn_over(runs: Runs) -> dict[str, Array]:
    """(rows,) each: what the machine was doing; of what goes both ways, how far too."""
    inputs = runs.inputs
    both = {n: v for n, v in inputs.items() if np.min(v) < 0.0 < np.max(v)}
    return inputs | {f"magnitude of {n}": np.abs(v) for n, v in both.items()}
