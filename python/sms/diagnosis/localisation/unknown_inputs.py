"""Which equation is wrong, and how: hidden inputs in the simulation.

To the force balance a hidden force is added, to either chamber a hidden mass flow, to each reading a hidden error. What
each of them would have to be is not guessed: it is any smooth function of one of the signals (velocity, extension,
command, a pressure, time), a chain of straight lines over the signal's quantiles. Their sensitivities are the core's
derivatives against an input at points of time, put together by the function's values there. How much of the excess
each equation takes alone, by ridge regression, is its share. The shape of the missing term is the function of a single
signal that takes most of one record with the values that the others ask for: a curve over the wrong signal follows the
noise of the record it was fitted to, and takes nothing of another.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.diagnosis.localisation.signal_functions import (
    alike,
    alike_signals,
    belong_together,
    hats,
    of_input,
    points,
    signals_of,
    through_plant,
    without_leg,
)
from sms.diagnosis.remainder import Hidden, Shape
from sms.diagnosis.thresholds import CURVE_RIDGE, DRAWS, MOST_ROWS
from sms.estimation.block_statistics import sum_by
from sms.estimation.discrepancy import KNOTS
from sms.estimation.nuisance import Nuisance
from sms.estimation.windows import Runs


@dataclass(frozen=True)
class Basis:
    """Functions of one signal: their sensitivities (rows + known, pieces) and where their points lie."""

    equation: str
    signal: str
    sensitivity: Array
    at: Array
    """(pieces,) values of the signal."""
    unit: str


def bases_of(runs: Runs, nuisance: Nuisance, params: _core.Params) -> list[Basis]:
    """Every equation with every signal, less what the free parameters can undo."""
    q = nuisance.basis()

    def off(columns: Array) -> Array:
        full = nuisance.with_declared(columns)
        return thinned(runs, full - q @ (q.T @ full))

    hidden = runs.problem.hidden(params, KNOTS)
    signals = signals_of(runs)
    found = []
    for signal, values in signals.items():
        at = points(values)
        if np.ptp(at) == 0.0:
            continue
        functions = hats(values, at)
        for equation, unit in equations_of(runs).items():
            if belong_together(equation.removeprefix("reading of "), signal):
                columns = _columns(runs, hidden, equation, functions)
                found.append(Basis(equation, signal, off(columns), at, unit))
    moving = {without_leg(name) for name in signals}
    for equation, numbers in alike(tuple(runs.kind.hidden)).items():
        unit = list(runs.kind.hidden.values())[numbers[0]]
        for signal, of_leg in alike_signals(runs.inputs).items():
            if signal not in moving:
                continue
            at = points(np.concatenate(of_leg))
            if np.ptp(at) == 0.0:
                continue
            columns = np.sum(
                [
                    through_plant(runs, of_input(hidden, number), hats(values, at))
                    for number, values in zip(numbers, of_leg, strict=True)
                ],
                axis=0,
            )
            found.append(Basis(equation, signal, off(columns), at, unit))
    return found


def equations_of(runs: Runs) -> dict[str, str]:
    """Where a term may be missing -> its unit: the plant's equations, and the readings."""
    readings = {
        f"reading of {channel}": runs.kind.units[channel]
        for channel in runs.channels
        if channel not in runs.kind.computed
    }
    return dict(runs.kind.hidden) | readings


def _columns(runs: Runs, hidden: Array, equation: str, functions: Array) -> Array:
    """(rows, pieces): sensitivity of a hidden term that follows functions (rows, pieces) of a signal."""
    equations = list(runs.kind.hidden)
    if equation in equations:
        return through_plant(runs, of_input(hidden, equations.index(equation)), functions)
    channel = equation.removeprefix("reading of ")
    here = runs.channel == runs.channels.index(channel)
    return _free_of_start(runs, functions * here[:, None] / runs.noise[channel])


def with_curve(runs: Runs, nuisance: Nuisance, params: _core.Params, shape: Shape) -> Array:
    """(rows,): how the residual changes, to first order, when the simulation carries a curve as a term.

    As much of it as is confirmed. These records need not move the signal that the curve follows: at rest they have its
    value there.
    """
    carried = shape.confirmed * np.array(shape.value)
    equations = tuple(runs.kind.hidden)
    if shape.equation in alike(equations):  # the same curve in each leg, over that leg's own signal
        legs = [equations[number] for number in alike(equations)[shape.equation]]
        values = alike_signals(runs.inputs)[shape.signal]
    else:
        legs, values = [shape.equation], [runs.inputs[shape.signal]]
    at = np.array(shape.at)
    terms = {leg: hats(own, at) @ carried for leg, own in zip(legs, values, strict=True)}
    return with_terms(runs, nuisance, params, terms)


def with_terms(
    runs: Runs, nuisance: Nuisance, params: _core.Params, terms: Mapping[str, Array]
) -> Array:
    """(rows,): the same for any terms, equation -> (rows,) in its unit."""
    hidden = runs.problem.hidden(params, KNOTS)
    columns = np.sum([_columns(runs, hidden, e, v[:, None]) for e, v in terms.items()], axis=0)
    full = nuisance.with_declared(columns[:, 0])
    q = nuisance.basis()
    return np.asarray((full - q @ (q.T @ full))[: len(columns)])


def thinned(runs: Runs, columns: Array) -> Array:
    """(rows + known, m) with sums of neighbouring samples in place of them, scaled so that noise stays what it is."""
    every = thinning(runs)
    if every == 1:
        return columns
    parts = []
    for w in runs.problem.windows:
        of_window = columns[w.row : w.row + w.rows].reshape(w.samples, -1, columns.shape[1])
        firsts = np.arange(0, w.samples, every)
        sums = np.add.reduceat(of_window, firsts, axis=0)
        sizes = np.diff(np.append(firsts, w.samples))
        parts.append((sums / np.sqrt(sizes)[:, None, None]).reshape(-1, columns.shape[1]))
    return np.vstack([*parts, columns[runs.problem.rows :]])


def thinning(runs: Runs) -> int:
    """How many samples are added up."""
    return -(-runs.problem.rows // MOST_ROWS)


# ---- sensitivities ------------------------------------------------------------------------------------------


def _free_of_start(runs: Runs, columns: Array) -> Array:
    """Errors of a reading less their mean in each window and channel, which an initial state undoes at the least."""
    key = runs.block * len(runs.channels) + runs.channel
    sizes = np.bincount(key).astype(float)
    mean = sum_by(key, columns, len(sizes)) / sizes[:, None]
    return np.asarray(columns - mean[key])


def estimate_unknown_inputs(
    runs: Runs,
    nuisance: Nuisance,
    residual: Array,
    params: _core.Params,
    excess: float,
    rng: np.random.Generator,
) -> Hidden:
    """Shares of the equations and the shape of the missing term; excess is the chi-square that is not noise."""
    bases = bases_of(runs, nuisance, params)
    full = thinned(runs, np.concatenate([residual, nuisance.departure])[:, None])[:, 0]
    blocks = _blocks(runs, len(nuisance.pull))
    taken = {(b.equation, b.signal): _taken(b.sensitivity, full) for b in bases}
    shares = {}
    for equation in dict.fromkeys(b.equation for b in bases):
        together = np.hstack([b.sensitivity for b in bases if b.equation == equation])
        low, high = _interval(together, full, blocks, rng)
        share = _taken(together, full) / max(excess, 1e-12)
        shares[equation] = (
            min(share, 1.0),
            min(low / max(excess, 1e-12), 1.0),
            min(high / max(excess, 1e-12), 1.0),
        )
    parts = _parts(runs, len(nuisance.pull))
    carried = [confirmed(b.sensitivity, full, parts) for b in bases]
    order = [(c.taken, taken[(b.equation, b.signal)]) for b, c in zip(bases, carried, strict=True)]
    first = max(range(len(bases)), key=lambda k: order[k])
    best = bases[first]
    share = taken[(best.equation, best.signal)] / max(excess, 1e-12)
    return Hidden(
        shares,
        {f"{e} over {s}": t / max(excess, 1e-12) for (e, s), t in taken.items()},
        _shape(best, full, blocks, share, carried[first].part),
    )


def _blocks(runs: Runs, known: int) -> Index:
    """Which window a row of a sensitivity belongs to; what is declared is a block of its own."""
    every, channels = thinning(runs), len(runs.channels)
    rows = [-(-w.samples // every) * channels for w in runs.problem.windows]
    return np.repeat(np.arange(len(rows) + 1), [*rows, known])


def _parts(runs: Runs, known: int) -> Index:
    """Which part a row of a sensitivity belongs to: a record, or of a single one every other window."""
    windows = runs.problem.windows
    records = np.array([w.record for w in windows])
    part = records if np.ptp(records) else np.arange(len(windows)) % 2
    return np.append(part, -1)[_blocks(runs, known)]


@dataclass(frozen=True)
class Confirmed:
    """What a curve takes of each part with the values that the other parts ask for."""

    part: float
    """Of the curve, 0..1: with this much of it the others' values take most."""
    taken: float
    """Of chi-square, with that."""


def confirmed(columns: Array, full: Array, parts: Index) -> Confirmed:
    """columns (n, pieces) against full (n,); what is declared, with parts (n,) -1, is in no part and asked in all."""
    predicted = np.zeros(len(full))
    for part in np.unique(parts[parts >= 0]):
        here = parts == part
        x, _ = _solve(columns[~here], full[~here])
        predicted[here] = columns[here] @ x
    norm = max(float(predicted @ predicted), 1e-300)
    part = float(np.clip(-(predicted @ full) / norm, 0.0, 1.0))
    return Confirmed(part, float(full @ full - np.sum((full + part * predicted) ** 2)))


def _solve(columns: Array, full: Array) -> tuple[Array, Array]:
    """Ridge estimate and its sensitivity's scale."""
    scale = np.maximum(np.linalg.norm(columns, axis=0), 1e-100)
    a = columns / scale
    x = np.linalg.solve(a.T @ a + CURVE_RIDGE * np.eye(a.shape[1]), -a.T @ full)
    return np.asarray(x / scale), scale


def _taken(columns: Array, full: Array) -> float:
    x, _ = _solve(columns, full)
    return float(full @ full - np.sum((full + columns @ x) ** 2))


def _interval(
    columns: Array, full: Array, blocks: Index, rng: np.random.Generator
) -> tuple[float, float]:
    """95 percent of what is taken, windows resampled."""
    x, _ = _solve(columns, full)
    taken = full**2 - (full + columns @ x) ** 2
    by_block = np.bincount(blocks, taken)
    drawn = rng.integers(len(by_block), size=(DRAWS, len(by_block)))
    low, high = np.quantile(by_block[drawn].sum(axis=1), [0.025, 0.975])
    return float(low), float(high)


def _shape(basis: Basis, full: Array, blocks: Index, share: float, part: float) -> Shape:
    """The curve of the missing term with its band, from the scatter between windows."""
    x, scale = _solve(basis.sensitivity, full)
    a = basis.sensitivity / scale
    bread = np.linalg.inv(a.T @ a + CURVE_RIDGE * np.eye(a.shape[1]))
    left = full + basis.sensitivity @ x
    scores = sum_by(blocks, a * left[:, None], int(blocks.max()) + 1)
    covariance = bread @ (scores.T @ scores) @ bread / np.outer(scale, scale)
    return Shape(
        basis.equation,
        basis.signal,
        tuple(map(float, basis.at)),
        tuple(map(float, x - np.mean(x) if basis.equation.startswith("reading") else x)),
        tuple(2.0 * float(np.sqrt(v)) for v in np.diag(covariance)),
        basis.unit,
        share,
        part,
    )
