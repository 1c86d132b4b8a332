"""The peers on a simulated plant: each is given what its equations lack, and the residual of its readings.

    build/diagnosis_peers/bin/python -m validation.trials.peers.on_equations

reads names of files (exchange.py) from standard input, one a line, and answers each with a line of JSON:
method -> answer. What an equation lacks comes averaged over a tenth of a second, with the noise's covariance.
Free numbers are chosen on the validate records, which favours these methods.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pysindy as ps
from scipy.linalg import solve_triangular
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from validation.trials.peers import in_their_environment as on_residual
from validation.trials.peers.exchange import Array, Averages, Equation, PlantAnswer, Question, load
from validation.trials.peers.regime_local import regime_local

THRESHOLDS = np.geomspace(0.05, 5.0, 15)
"""Of sequentially thresholded least squares, in standard deviations of the noise."""
DEGREE = 2
"""Of the library's products."""
SPARSE_HELPS = 0.005
GP_HELPS = 0.02
"""Least reduction of an equation's RMS error on the validate records that counts as something found."""
RESTARTS = 1
"""Of the Gaussian process's search for its length scales."""
READING_POINTS = 150
"""Samples of each reading from which a Gaussian process learns."""

Scaled = Callable[[Array], Array]


def scaling(parts: Sequence[Averages]) -> Scaled:
    """Inputs about their mean, over their spread, on the identify records."""
    every = np.vstack([p.inputs for p in parts])
    centre, spread = every.mean(axis=0), np.maximum(every.std(axis=0), 1e-12)
    return lambda inputs: np.asarray((inputs - centre) / spread)


def over_noise(part: Averages, columns: Array) -> Array:
    """Columns (m,) or (m, k) over the factor of the noise's covariance: independent errors of size 1."""
    return np.asarray(solve_triangular(part.factor, columns, lower=True))


def left_of(parts: Sequence[Averages], terms: Sequence[Array]) -> float:
    """Mean square over the noise of what a missing term (m,) leaves in each record."""
    left = [over_noise(p, p.missing - t) for p, t in zip(parts, terms, strict=True)]
    return float(np.mean(np.concatenate(left) ** 2))


# ---- sparse regression -------------------------------------------------------------------


def sparse(equation: Equation) -> list[Array]:
    """The sparse polynomial of the signals that predicts best what the validate records lack; zeros for none.

    PySINDy's library and its sequentially thresholded least squares, weighed by the noise's covariance.
    """
    scaled = scaling(equation.identify)
    library = ps.PolynomialLibrary(degree=DEGREE).fit(scaled(equation.identify[0].inputs))

    def columns(part: Averages) -> Array:
        return np.asarray(library.transform(scaled(part.inputs)))

    there = [columns(p) for p in equation.validate]
    a = np.vstack([over_noise(p, columns(p)) for p in equation.identify])
    y = np.concatenate([over_noise(p, p.missing) for p in equation.identify])
    scale = np.maximum(np.sqrt(np.mean(a**2, axis=0)), 1e-12)
    nothing = [np.zeros(len(p.missing)) for p in equation.validate]
    least = left_of(equation.validate, nothing) * (1.0 - SPARSE_HELPS) ** 2
    best = nothing
    for threshold in THRESHOLDS:
        fit = ps.STLSQ(threshold=threshold, alpha=1e-6, normalize_columns=False)
        fit.fit(a / scale, y)
        x = np.asarray(fit.coef_).ravel() / scale
        terms = [c @ x for c in there]
        if (left := left_of(equation.validate, terms)) < least:
            least, best = left, terms
    return best


# ---- Gaussian process --------------------------------------------------------------------


def gaussian_process(equation: Equation) -> list[Array]:
    """What the equation lacks as a smooth function of the signals; the noise of every average is given."""
    scaled = scaling(equation.identify)
    inputs = np.vstack([scaled(p.inputs) for p in equation.identify])
    missing = np.concatenate([p.missing for p in equation.identify])
    noise = np.concatenate([np.sum(p.factor**2, axis=1) for p in equation.identify])
    size = max(float(np.std(missing)), 1e-300)
    kernel = ConstantKernel(1.0) * RBF(np.ones(inputs.shape[1])) + WhiteKernel(0.1)
    process = GaussianProcessRegressor(
        kernel, alpha=noise / size**2, n_restarts_optimizer=RESTARTS, random_state=1
    )
    process.fit(inputs, missing / size)
    terms = [size * process.predict(scaled(p.inputs)) for p in equation.validate]
    nothing = [np.zeros(len(p.missing)) for p in equation.validate]
    left = left_of(equation.validate, terms) / left_of(equation.validate, nothing)
    return terms if left < (1.0 - GP_HELPS) ** 2 else nothing


def gaussian_process_on_readings(question: Question) -> PlantAnswer:
    """Each reading's error as a smooth function of the signals, after Kennedy and O'Hagan (2001)."""
    begin = time.process_time()
    here, there = question.identify, question.validate
    rng = np.random.default_rng(1)
    centre, spread = here.inputs.mean(axis=0), np.maximum(here.inputs.std(axis=0), 1e-12)
    before, after = [], []
    for channel in np.unique(here.channel):
        rows, unseen = (np.flatnonzero(p.channel == channel) for p in (here, there))
        rows = rng.choice(rows, min(READING_POINTS, len(rows)), replace=False)
        kernel = ConstantKernel(1.0) * RBF(np.ones(here.inputs.shape[1])) + WhiteKernel(1.0)
        process = GaussianProcessRegressor(kernel, normalize_y=True, random_state=1)
        process.fit((here.inputs[rows] - centre) / spread, here.residual[rows])
        said = process.predict((there.inputs[unseen] - centre) / spread)
        before.append(float(np.mean(there.residual[unseen] ** 2)))
        after.append(min(before[-1], float(np.mean((there.residual[unseen] - said) ** 2))))
    helped = [1.0 - float(np.sqrt(a / b)) for a, b in zip(after, before, strict=True)]
    strength = max(helped)
    seconds = time.process_time() - begin
    return PlantAnswer(strength > GP_HELPS, strength, "", seconds, {}, after)


# ---- answers -----------------------------------------------------------------------------


def over_equations(question: Question, method: Callable[[Equation], list[Array]]) -> PlantAnswer:
    """Equation by equation; the one whose error on the validate records falls most is where it sees the error."""
    begin = time.process_time()
    terms, fallen = {}, {}
    for equation in question.equations:
        found = method(equation)
        nothing = [np.zeros(len(t)) for t in found]
        if not any(np.any(t) for t in found):
            continue
        terms[equation.name] = [t.tolist() for t in found]
        fallen[equation.name] = left_of(equation.validate, nothing) - left_of(
            equation.validate, found
        )
    best = max(fallen, key=lambda name: fallen[name], default="")
    seconds = time.process_time() - begin
    return PlantAnswer(bool(terms), fallen.get(best, 0.0), best, seconds, terms)


def whiteness(question: Question) -> PlantAnswer:
    """Ljung and Box; the strength is the largest statistic of a window's reading."""
    begin = time.process_time()
    alarm, largest = on_residual.ljung_box(question.identify)
    return PlantAnswer(alarm, largest, "", time.process_time() - begin, {})


METHODS: dict[str, Callable[[Question], PlantAnswer]] = {
    "sparse regression": lambda question: over_equations(question, sparse),
    "Gaussian process, equations": lambda question: over_equations(question, gaussian_process),
    "Gaussian process, readings": gaussian_process_on_readings,
    "regime-local laws": lambda question: over_equations(question, regime_local),
    "whiteness": whiteness,
}


def main() -> None:
    """See the module's text."""
    warnings.simplefilter("ignore")
    for line in sys.stdin:
        question = load(Path(line.strip()))
        said = {name: asdict(method(question)) for name, method in METHODS.items()}
        print(json.dumps(said), flush=True)


if __name__ == "__main__":
    main()
