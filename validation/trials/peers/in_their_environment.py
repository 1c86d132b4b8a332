"""Sparse regression (PySINDy), a Gaussian process (scikit-learn) and a whiteness test, on the same residuals.

    build/diagnosis_peers/bin/python -m validation.trials.peers.in_their_environment FOLDER

reads every trial *.npz in the folder and prints one JSON: trial -> method -> answer. Each method is used as its manual
says, with its own free numbers chosen on the validate records, which favours it.
"""

from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Callable
from dataclasses import asdict
from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np
import pysindy as ps
from scipy.stats import chi2
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from validation.trials.peers.exchange import Answer, Array, Part, Question, load

THRESHOLDS = np.geomspace(0.02, 2.0, 15)
"""Of sequentially thresholded least squares, in standard deviations of the noise."""
SPARSE_HELPS = 0.005
"""Least reduction of the validate error for which a term is kept: with less, the empty model stands."""
POINTS = 400
"""Samples that the Gaussian process learns from; its cost grows with their cube."""
GP_ALARM = 0.02
"""Reduction of the validate error from which the Gaussian process counts as having found something."""
LAGS = 20
SIGNIFICANT = 0.01


# ---- sparse regression -----------------------------------------------------------------


def library(question: Question, part: Part) -> tuple[list[str], Array]:
    """All products of at most two inputs, the constant included; direction times itself is that already."""
    names, inputs = question.names, part.inputs
    columns, titles = [np.ones(len(inputs))], ["1"]
    for degree in (1, 2):
        for chosen in combinations_with_replacement(range(len(names)), degree):
            title = "*".join(sorted(names[i] for i in chosen))
            if title != "direction*direction":
                columns.append(np.prod(inputs[:, chosen], axis=1))
                titles.append(title)
    return titles, np.column_stack(columns)


def sparse(question: Question) -> Answer:
    """STLSQ for each reading apart, its threshold chosen on the validate records."""
    kept: list[str] = []
    before = question.validate.residual**2
    after = before.copy()
    for channel in np.unique(question.identify.channel):
        here, there = (
            np.flatnonzero(p.channel == channel) for p in (question.identify, question.validate)
        )
        titles, columns = library(question, question.identify)
        scale = np.maximum(np.sqrt(np.mean(columns[here] ** 2, axis=0)), 1e-12)
        a = columns[here] / scale
        b = library(question, question.validate)[1][there] / scale
        best, found = float(np.mean(before[there])) * (1.0 - SPARSE_HELPS), np.zeros(len(titles))
        for threshold in THRESHOLDS:
            fit = ps.STLSQ(threshold=threshold, alpha=1e-6, normalize_columns=False)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                fit.fit(a, question.identify.residual[here])
            x = np.asarray(fit.coef_).ravel()
            error = float(np.mean((question.validate.residual[there] - b @ x) ** 2))
            if error < best:
                best, found = error, x
        after[there] = (question.validate.residual[there] - b @ found) ** 2
        kept += [t for t, x in zip(titles, found, strict=True) if x != 0.0]
    return Answer(tuple(dict.fromkeys(kept)), bool(kept), _gain(before, after))


# ---- Gaussian process --------------------------------------------------------------------


def gaussian_process(question: Question) -> Answer:
    """The residual as a smooth function of the inputs: corrects, and says nothing about why."""
    rng = np.random.default_rng(1)
    before = question.validate.residual**2
    after = before.copy()
    centre = question.identify.inputs.mean(axis=0)
    spread = np.maximum(question.identify.inputs.std(axis=0), 1e-12)
    for channel in np.unique(question.identify.channel):
        here, there = (
            np.flatnonzero(p.channel == channel) for p in (question.identify, question.validate)
        )
        here = rng.choice(here, min(POINTS, len(here)), replace=False)
        kernel = ConstantKernel(1.0) * RBF(np.ones(len(question.names))) + WhiteKernel(1.0)
        process = GaussianProcessRegressor(kernel, normalize_y=True, random_state=1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            process.fit(
                (question.identify.inputs[here] - centre) / spread, question.identify.residual[here]
            )
            said = process.predict((question.validate.inputs[there] - centre) / spread)
        after[there] = (question.validate.residual[there] - said) ** 2
    gain = _gain(before, after)
    return Answer((), gain > GP_ALARM, gain)


# ---- whiteness ----------------------------------------------------------------------------


def whiteness(question: Question) -> Answer:
    """Is the fitted model's residual white?"""
    return Answer((), ljung_box(question.identify)[0])


def ljung_box(part: Part) -> tuple[bool, float]:
    """Ljung and Box (1978) over 20 lags: whether some series is not white, and the largest statistic."""
    smallest, largest, tests = 1.0, 0.0, 0
    for number in np.unique(part.series):
        r = part.residual[part.series == number]
        if len(r) <= 2 * LAGS:
            continue
        r = r - r.mean()
        lags = np.arange(1, LAGS + 1)
        rho = np.array([r[k:] @ r[:-k] for k in lags]) / max(float(r @ r), 1e-300)
        n = len(r)
        q = n * (n + 2) * float(np.sum(rho**2 / (n - lags)))
        smallest, tests = min(smallest, float(chi2.sf(q, LAGS))), tests + 1
        largest = max(largest, q)
    return smallest * tests < SIGNIFICANT, largest


def _gain(before: Array, after: Array) -> float:
    return 1.0 - float(np.sqrt(np.mean(after) / np.mean(before)))


METHODS: dict[str, Callable[[Question], Answer]] = {
    "sparse regression": sparse,
    "Gaussian process": gaussian_process,
    "whiteness": whiteness,
}


def main() -> None:
    answers = {}
    for path in sorted(Path(sys.argv[1]).glob("*.npz")):
        question = load(path)
        answers[path.stem] = {name: asdict(method(question)) for name, method in METHODS.items()}
    json.dump(answers, sys.stdout)


if __name__ == "__main__":
    main()
