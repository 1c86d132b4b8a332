"""Which equation is wrong, a second way: each fed with measured signals, none simulated.

Every signal is smoothed by local cubics over 50 ms, which bring its derivatives too; the core puts them into each
equation (libsms/estimation/measured.hpp), and what is left over is that equation's own error, in its own unit, averaged
over a tenth of a second. The signals' noise is carried through smoother, equation and average to first order: the
equations are differenced over one standard deviation either way, the smoother is linear. A derivative's noise in one
average is the neighbour's with the other sign, so averages are weighed by their covariance; without it a leak, a small
flow that goes on and on, would drown. The free parameters are fitted anew to each equation alone, within what is
declared known; the squares of what is left, beyond the noise's, are summed.

An error found here stays in its equation. A hidden input (localisation/unknown_inputs.py) is found through the
simulation, where an error of one equation moves every signal. So the two ways fail differently, and where they point to
different equations something is wrong that belongs to no equation: mostly a reading.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg import solve_triangular
from scipy.signal import savgol_coeffs, savgol_filter

from sms import _core
from sms.arrays import Array, Index
from sms.diagnosis.fitting import free_of
from sms.diagnosis.hypothesis import Fitted
from sms.diagnosis.remainder import EquationError, ErrorCurve, FedEquations
from sms.diagnosis.thresholds import AVERAGE, DRAWS, ENDS, SMOOTHING, STRETCH, TOLERANCE
from sms.estimation.block_statistics import sum_by
from sms.estimation.kind import Equations
from sms.estimation.least_squares import Free, changed, fit_windows
from sms.estimation.problem import Problem
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.parameters import MAPS, common_parameter


@dataclass(frozen=True)
class Fed:
    """One record's equations, their errors averaged."""

    run: Run
    problem: Problem
    mean: sparse.csr_matrix
    """(m, n): averages of a record's samples."""
    factor: Array
    """(equations, m, m): lower factors of the covariances that the signals' noise gives each equation's averages."""

    @property
    def time(self) -> Array:
        """(m,) s from the beginning of the record."""
        return np.asarray(self.mean @ (self.run.time - self.run.time[0]))

    @property
    def noise(self) -> Array:
        """(m, equations): standard deviation of an average."""
        return np.asarray(np.sqrt(np.sum(self.factor**2, axis=2)).T)

    def at(self, number: int, params: _core.Params, free: Sequence[str]) -> tuple[Array, Array]:
        """Errors (m,) of one equation, model less measured, in units of their noise, and slopes (m, free)."""
        error, slope = self.problem.evaluate(params, list(free))
        own = slice(number, None, len(self.factor))
        averaged = self.mean @ np.column_stack([error, slope])[own]
        white = solve_triangular(self.factor[number], averaged, lower=True)
        return white[:, 0], white[:, 1:]

    def missing(self, number: int, error: Array) -> Array:
        """(m,): what one equation lacks, in its unit, from its errors in units of their noise."""
        return np.asarray(-self.factor[number] @ error)


def fed_equations(runs: Runs, fitted: Fitted, rng: np.random.Generator) -> FedEquations | None:
    """The error of each equation and its share of what is not noise; None for a kind without such equations."""
    if runs.kind.equations is None:
        return None
    units = runs.kind.equations.units(runs.channels)
    fed, left = errors_of(runs, fitted, runs.kind.equations)
    excess = np.column_stack([np.concatenate(parts) for parts in left]) ** 2 - 1.0
    shares, low, high = _shares(excess, _stretches(fed), rng)
    missing = [
        np.column_stack([f.missing(k, parts[number]) for k, parts in enumerate(left)])
        for number, f in enumerate(fed)
    ]
    every, all_noise = np.vstack(missing), np.vstack([f.noise for f in fed])
    return FedEquations(
        SMOOTHING,
        AVERAGE,
        tuple(
            EquationError(
                name,
                unit,
                rms=float(np.sqrt(np.mean(every[:, k] ** 2))),
                noise=float(np.sqrt(np.mean(all_noise[:, k] ** 2))),
                times_noise=float(np.sqrt(1.0 + np.mean(excess[:, k]))),
                share=(float(shares[k]), float(low[k]), float(high[k])),
            )
            for k, (name, unit) in enumerate(units.items())
        ),
        bool(np.max(np.mean(excess, axis=0)) > TOLERANCE),
        tuple(
            ErrorCurve(
                name,
                unit,
                f.run.name,
                tuple(map(float, f.time)),
                tuple(map(float, rows[:, k])),
                tuple(map(float, 2.0 * f.noise[:, k])),
            )
            for f, rows in zip(fed, missing, strict=True)
            for k, (name, unit) in enumerate(units.items())
        ),
    )


def errors_of(
    runs: Runs, fitted: Fitted, equations: Equations
) -> tuple[list[Fed], list[list[Array]]]:
    """The records fed, and of each equation in each record the errors (m,) in units of their noise.

    What is not known exactly is fitted to each equation alone, within what is declared.
    """
    floor = runs.floor(fitted.fit.residual)
    noise = {
        s: runs.noise[s] * float(np.sqrt(f)) for s, f in zip(runs.channels, floor, strict=True)
    }
    fed = [
        feed(runs, run, equations, fitted.params, noise)
        for run in runs.motions
        if _averaging(run).shape[0]
    ]
    # An error of the maps would take any flow or friction that is missing.
    free = [f for f in free_of(fitted.hypothesis) if common_parameter(f.name) not in MAPS]
    neutral = [n for n in fitted.hypothesis.free if common_parameter(n) in MAPS]
    params = changed(fitted.params, neutral, np.zeros(len(neutral)))
    felt = _felt(fed, params, [f.name for f in free])
    return fed, [
        _beyond_parameters(fed, k, params, [free[i] for i in numbers])
        for k, numbers in enumerate(felt)
    ]


# ---- errors and their noise ----------------------------------------------------------------------


def smoothed(values: Array, step: float, derivatives: int) -> Array:
    """(n, 1 + derivatives): a signal and its derivatives by local cubics."""
    width = _width(step)
    parts = [savgol_filter(values, width, 3, k, step) for k in range(derivatives + 1)]
    return np.column_stack(parts)


def _width(step: float) -> int:
    return max(5, 2 * round(0.5 * SMOOTHING / step) + 1)


def feed(
    runs: Runs, run: Run, equations: Equations, params: _core.Params, noise: Mapping[str, float]
) -> Fed:
    """The equations of one record, and what the signals' noise makes of their errors."""
    count, samples = len(equations.units(runs.channels)), len(run.time)
    mean = _averaging(run)
    # A reading that never changes shows no noise; it has what is declared of it.
    noise = {s: size if size > 0.0 else runs.noise[s] for s, size in noise.items()}
    clean = {
        s: smoothed(run.signals[s], run.step, d)
        for s, d in equations.derivatives.items()
        if s in runs.channels
    }

    def moved(signal: str, derivative: int, by: float) -> Array:
        changed = clean[signal].copy()
        changed[:, derivative] += by
        there, _ = equations.make(runs.rig, run, clean | {signal: changed}).evaluate(params)
        return np.asarray(there).reshape(samples, count)

    covariance = np.zeros((count, mean.shape[0], mean.shape[0]))
    for signal, columns in clean.items():
        through = [sparse.csr_matrix(mean.shape) for _ in range(count)]
        for derivative in range(columns.shape[1]):
            weights = _weights(run.step, derivative)
            by = noise[signal] * float(np.linalg.norm(weights))
            slope = (moved(signal, derivative, by) - moved(signal, derivative, -by)) / (2.0 * by)
            for k in range(count):
                through[k] += mean @ sparse.diags(slope[:, k]) @ _banded(weights, samples)
        for k in range(count):
            covariance[k] += noise[signal] ** 2 * (through[k] @ through[k].T).toarray()
    problem = equations.make(runs.rig, run, clean)
    return Fed(run, problem, mean, np.array([_factor(c) for c in covariance]))


def _factor(covariance: Array) -> Array:
    """Lower Cholesky factor; a thousandth of the mean variance is added, which no noise is known better than."""
    size = np.mean(np.diag(covariance))
    return np.asarray(np.linalg.cholesky(covariance + 1e-3 * size * np.eye(len(covariance))))


def _averaging(run: Run) -> sparse.csr_matrix:
    """(m, n): means over AVERAGE, the ends of the record left out, and what a clipped reading is smoothed into."""
    each, skipped = max(1, round(AVERAGE / run.step)), round(ENDS / run.step)
    count = max(1, (len(run.time) - 2 * skipped) // each)
    columns = skipped + np.arange(count * each)
    rows = np.repeat(np.arange(count), each)
    mean = sparse.csr_matrix(
        (np.full(count * each, 1.0 / each), (rows, columns)), shape=(count, len(run.time))
    )
    if not run.clipped:
        return mean
    clipped = np.any(list(run.clipped.values()), axis=0)
    spoilt = np.convolve(clipped, np.ones(_width(run.step)), "same") > 0.5
    return mean[np.flatnonzero(mean @ spoilt == 0.0)]


def _weights(step: float, derivative: int) -> Array:
    """(width,): of the samples around one, in its smoothed derivative."""
    return np.asarray(savgol_coeffs(_width(step), 3, deriv=derivative, delta=step, use="dot"))


def _banded(weights: Array, samples: int) -> sparse.csr_matrix:
    """(n, n): what the smoother does to a record, away from its ends."""
    half = len(weights) // 2
    return sparse.diags(weights, range(-half, half + 1), shape=(samples, samples)).tocsr()


# ---- shares --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class OneEquation:
    """One equation's errors in all records, in units of their noise, as a fit asks for them."""

    fed: list[Fed]
    number: int

    @property
    def rows(self) -> int:
        return sum(f.factor.shape[1] for f in self.fed)

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        errors, slopes = zip(*(f.at(self.number, params, free) for f in self.fed), strict=True)
        return np.concatenate(errors), np.vstack(slopes)


def _felt(fed: list[Fed], params: _core.Params, names: list[str]) -> list[list[int]]:
    """Of each equation: which of these parameters it feels."""
    count = len(fed[0].factor)
    slopes = np.vstack([f.problem.evaluate(params, names)[1] for f in fed])
    return [np.flatnonzero(np.any(slopes[k::count] != 0.0, axis=0)).tolist() for k in range(count)]


def _beyond_parameters(
    fed: list[Fed], number: int, params: _core.Params, free: list[Free]
) -> list[Array]:
    """(m,) of each record: an equation's errors in units of their noise, the free parameters fitted to it alone.

    To it alone: a parameter that two equations share would carry the error of one into the other.
    """
    found = fit_windows(OneEquation(fed, number), params, free)
    ends = np.cumsum([f.factor.shape[1] for f in fed])[:-1]
    return np.split(np.asarray(found.residual), ends)


def _stretches(fed: list[Fed]) -> Index:
    """(rows,) number of the second of a record that a row lies in."""
    second = np.concatenate([np.floor((f.time - f.time[0]) / STRETCH) for f in fed])
    record = np.repeat(np.arange(len(fed)), [len(f.time) for f in fed])
    _, number = np.unique(np.column_stack([record, second]), axis=0, return_inverse=True)
    return np.asarray(number, dtype=np.int64).ravel()


def _shares(excess: Array, stretch: Index, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """(equations,) of what is not noise, and the ends of their 95 percent intervals."""
    sums = sum_by(stretch, excess, int(stretch.max()) + 1)
    drawn = rng.integers(len(sums), size=(DRAWS, len(sums)))

    def share(total: Array) -> Array:
        positive = np.maximum(total, 0.0)
        return np.asarray(positive / np.maximum(positive.sum(axis=-1, keepdims=True), 1e-300))

    low, high = np.quantile(share(sums[drawn].sum(axis=1)), [0.025, 0.975], axis=0)
    return share(sums.sum(axis=0)), low, high
