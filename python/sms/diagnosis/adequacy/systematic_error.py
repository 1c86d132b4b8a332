"""Standard errors where what a model leaves follows its signals.

A random input of each equation (estimation/discrepancy.py) averages out over a record. An error of a friction law or
of a flow does not: it is the same wherever the signals are, and an estimate is off by what of it the parameter can
imitate. So each equation may also have an unknown function of each signal (localisation/signal_functions.py): a normal
process along it that bends over half the signal's range, with the standard deviation under which the residual is most
likely (estimation/variance_components.py). To first order that gives the estimates with these functions beside the
parameters: a covariance, and how far the estimates would move. The stated variance is the sum of that covariance and of
the square of the move. A zero that a converter's rounding leaves unknown adds its own part (a consider parameter of
Schmidt's: not estimated, and counted).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.diagnosis.fitting import departure, fit, fit_with_discrepancy, nuisance_of, residual_of
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.localisation.signal_functions import (
    alike,
    alike_signals,
    hats,
    of_input,
    points,
    signals_of,
    through_plant,
)
from sms.diagnosis.localisation.unknown_inputs import thinned
from sms.diagnosis.thresholds import BENDS
from sms.estimation.discrepancy import Discrepancy
from sms.estimation.least_squares import changed
from sms.estimation.nuisance import Nuisance
from sms.estimation.variance_components import most_likely
from sms.estimation.windows import Runs

ITERATIONS = 40
"""Of the fixed point of the standard deviations. Run time: it settles within some percent."""
LEAST = 1e-3
"""Standard deviations of the noise: a function that moves readings by less is nothing. Numerics."""
ACCURACY = 0.02
"""Of its length, to which the sensitivity to a function is right: what parameters leave of less is none of its own.
Numerics: of a tank, a function proportional to the pressure's rate is the volume's sensitivity to 1 %; twice that.
"""


def generalised(fitted: Fitted, data: Data) -> Fitted:
    """The same model, its values and their errors by generalised least squares, systematic errors counted.

    The discrepancy is that of the healthy machine where reference records told it; else what is left with these causes
    and every known number as declared: on a machine that is only roughly the model, numbers that have all been fitted
    have taken a part of what no parameter explains, and where other records need another part they are wrong.
    """
    h, runs = fitted.hypothesis, data.identify
    start, allowed = fitted.params, data.allowed(runs)
    if allowed is not None:
        found = fit(h, runs, start, discrepancy=allowed, stated=True)
        return with_systematic_error(found, runs)
    of_causes = {n for cause in h.causes for n in cause.parameters}
    known = [n for n in h.known if n not in of_causes]
    start = changed(start, known, np.array([h.start[n] for n in known]))
    allowed = runs.discrepancy(start, residual_of(runs, start))
    return with_systematic_error(_from_either(fitted, start, allowed, runs), runs)


def _from_either(
    fitted: Fitted, start: _core.Params, discrepancy: Discrepancy, runs: Runs
) -> Fitted:
    """Generalised least squares from `start`; and from the fitted model's values where that has ended in no minimum:
    where these, as they are, leave less. The better of the two.
    """

    def left(params: _core.Params, residual: Array) -> float:
        white = discrepancy.whitener.whiten(residual)
        return float(white @ white) + departure(fitted.hypothesis, params)

    def fit_from(params: _core.Params) -> Fitted:
        return fit(fitted.hypothesis, runs, params, discrepancy=discrepancy, stated=True)

    found = fit_from(start)
    reached = left(found.params, found.fit.residual)
    if left(fitted.params, fitted.fit.residual) >= reached:
        return found
    other = fit_from(fitted.params)
    return other if left(other.params, other.fit.residual) < reached else found


def sized(fitted: Fitted, data: Data) -> Fitted:
    """The same model with the values and errors that are stated of it."""
    return better_predicting(generalised(fitted, data), fitted, data)


def better_predicting(final: Fitted, fitted: Fitted, data: Data) -> Fitted:
    """`final`, a fitted model by generalised least squares; or the same with the discrepancy that the model leaves
    itself, where that predicts the validation records better: a machine that is nearly the model has a smaller one."""
    if data.healthy is not None:
        return final
    other = fit_with_discrepancy(fitted.hypothesis, data.identify, fitted.params)

    def left(found: Fitted) -> float:
        return float(np.mean(residual_of(data.validate, found.params) ** 2))

    return with_systematic_error(other, data.identify) if left(other) < left(final) else final


def _less_sure(fitted: Fitted, least: Array) -> Fitted:
    """With standard errors (free,) of so much at least, but of what a bound holds."""
    error = np.sqrt(np.maximum(np.diag(fitted.covariance), 0.0))
    grown = np.maximum(np.divide(least, error, out=np.ones(len(error)), where=error > 0.0), 1.0)
    return replace(fitted, covariance=fitted.covariance * np.outer(grown, grown))


def with_systematic_error(fitted: Fitted, runs: Runs) -> Fitted:
    """The same estimates; their covariance (free, free) with what systematic errors of the equations could imitate.

    Unchanged for a model that was not fitted with a discrepancy or has no equation for it. Never smaller than it was.
    """
    if fitted.discrepancy is None or not fitted.movable:
        return fitted
    nuisance = nuisance_of(fitted, white=True)
    functions = _functions(fitted.discrepancy, nuisance, runs)
    if functions is None:
        return fitted
    stacked = np.vstack([nuisance.jacobian, nuisance.pull])
    scale = np.maximum(np.linalg.norm(stacked, axis=0), 1e-300)
    jacobian = thinned(runs, stacked / scale)
    residual = np.concatenate([fitted.whiten(fitted.fit.residual), nuisance.departure])
    systematic = Systematic.of(
        jacobian,
        functions.columns,
        thinned(runs, residual[:, None])[:, 0],
        functions.group,
        fitted.hypothesis.inflation,
    )
    free = list(fitted.hypothesis.free)
    place = [free.index(n) for n in fitted.movable]
    least = np.zeros(len(free))
    variance = np.diag(systematic.covariance) + systematic.move**2
    zeros = nuisance.with_declared(_unknown_zeros(fitted, runs))
    moved = np.linalg.lstsq(stacked / scale, zeros, rcond=1e-12)[0]
    least[place] = np.sqrt(variance + np.sum(moved**2, axis=1)) / scale
    return _less_sure(fitted, least)


def _unknown_zeros(fitted: Fitted, runs: Runs) -> Array:
    """(rows, zeros): by how much half a step changes the residual, white, of each sensor whose converter may round
    down, and whose zero is no parameter of the fit."""
    half = {n: h for n, h in runs.rig.unknown_zeros.items() if n not in fitted.hypothesis.free}
    if not half:
        return np.zeros((len(fitted.fit.residual), 0))
    _, raw = runs.problem.evaluate(fitted.params, list(half))
    return fitted.whiten(raw.astype(np.float64) * np.array(list(half.values())))


@dataclass(frozen=True)
class Functions:
    """Sensitivities (m, functions) to unknown functions of signals in the equations: white, thinned, zero for what is
    declared."""

    columns: Array
    group: Index
    """(functions,): to which pair of an equation and a signal each belongs."""


def _functions(discrepancy: Discrepancy, nuisance: Nuisance, runs: Runs) -> Functions | None:
    """Every equation with every signal; equations that every leg has are one, with the signals of each. None without
    an equation or a signal that moves."""
    hidden, signals = discrepancy.inputs, signals_of(runs)
    by_leg = alike(tuple(runs.kind.hidden))
    single = {
        e: [k] for k, e in enumerate(runs.kind.hidden) if all(k not in n for n in by_leg.values())
    }
    parts = []
    for numbers in (single | by_leg).values():
        of_equation = (
            alike_signals(signals) if len(numbers) > 1 else {s: [v] for s, v in signals.items()}
        )
        for values in of_equation.values():
            at = points(np.concatenate(values))
            if np.ptp(at) > 0.0:
                each = zip(numbers, values, strict=True)
                moved = sum(
                    through_plant(runs, of_input(hidden, k), process(v, at)) for k, v in each
                )
                white = discrepancy.whitener.whiten(np.asarray(moved))
                parts.append(thinned(runs, nuisance.with_declared(white)))
    if not parts:
        return None
    group = np.repeat(np.arange(len(parts)), [p.shape[1] for p in parts])
    return Functions(np.hstack(parts), group)


def process(values: Array, at: Array) -> Array:
    """(n, pieces): functions of a signal (n,) that, each times an independent normal number, add up to the process."""
    place = at / np.ptp(at)
    covariance = np.exp(-0.5 * ((place[:, None] - place) / BENDS) ** 2)
    root = np.linalg.cholesky(covariance + 1e-6 * np.eye(len(at)))
    return np.asarray(hats(values, at) @ root)


def _resolved(off: Array, functions: Array, group: Index) -> Array:
    """Of what parameters leave of functions (rows, functions), without what is less than these are accurate to: a group
    and the parameters share all directions whose angle to each other has a sine below ACCURACY.
    """
    out = np.zeros_like(off)
    for number in range(int(group.max()) + 1):
        of_group = group == number
        _, length, axes = np.linalg.svd(functions[:, of_group], full_matrices=False)
        axes, length = axes[length > 1e-12 * length[0]], length[length > 1e-12 * length[0]]
        left, sine, turned = np.linalg.svd(off[:, of_group] @ axes.T / length, full_matrices=False)
        kept = sine > ACCURACY
        out[:, of_group] = (left[:, kept] * sine[kept]) @ (turned[kept] * length) @ axes
    return out


@dataclass(frozen=True)
class Systematic:
    """Parameters and functions estimated together, to first order."""

    covariance: Array
    """(parameters, parameters)"""
    move: Array
    """(parameters,): by which the estimates move."""
    size: Array
    """(groups,): by how much the functions of a group change a residual, root mean square in units of the noise."""

    @classmethod
    def of(
        cls, jacobian: Array, functions: Array, residual: Array, group: Index, inflation: float
    ) -> Systematic:
        """jacobian (rows, parameters), functions (rows, functions), residual (rows,), with what is declared as rows."""
        noise = inflation * float(np.mean(residual**2))
        count = jacobian.shape[1]
        basis, _ = np.linalg.qr(jacobian)
        imitated = basis @ (basis.T @ functions)
        off = _resolved(functions - imitated, functions, group)
        functions = imitated + off
        products, score = off.T @ off / noise, off.T @ residual / noise
        moved = np.sqrt(np.bincount(group, np.diag(products)) / np.bincount(group))
        unit = 1.0 / np.maximum(moved, 1e-300)
        sigma = unit * float(np.linalg.norm(residual)) / np.sqrt(noise * len(group))
        least = LEAST * unit
        sigma, _ = most_likely(
            products[None], score[None], group, sigma, least, ITERATIONS, alike=True
        )
        d = sigma[group]
        together = np.hstack([jacobian, functions * d])
        information = together.T @ together
        information[count:, count:] += noise * np.eye(len(d))
        inverse = np.linalg.pinv(information, rcond=1e-12, hermitian=True)
        move = -(inverse @ (together.T @ residual))[:count]
        return cls(noise * inverse[:count, :count], move, sigma * moved / np.sqrt(len(residual)))
