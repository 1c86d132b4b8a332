"""Judgements on coloured residuals.

Samples 10 ms apart are not independent: what a seal does at one spot of the bore it does for the next
hundred samples. Counting them as independent makes a tool name a cause on healthy data every time. Here
the unit is the block: a stroke (one run of samples in one direction), or several in a row where noise
lasts long against a stroke. Scores are summed over a block before they are compared with their own scatter
(cluster-robust, Liang & Zeger 1986), the largest of all candidates is held against its own distribution
under random signs of whole blocks (wild score bootstrap, Kline & Santos 2012: any correlation within a
block and between candidates is respected, and so is the fact that many were tried), and intervals come
from resampling blocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from sms.arrays import Array, Index

MOST_LEVERAGE = 0.999
"""Of a block on its own fit. Numerics: what a parameter of its own makes of it is not known."""
BLOCK = 5.0
"""Correlation lengths of the noise that a block holds at least."""


def project_off(columns: Array, nuisance: Array) -> Array:
    """What of columns (n, m) cannot be had by moving the nuisance (n, k): the least-squares remainder."""
    if nuisance.shape[1] == 0:
        return columns
    scaled = nuisance / np.maximum(np.linalg.norm(nuisance, axis=0), 1e-300)
    q, r = np.linalg.qr(scaled)
    keep = np.abs(np.diag(r)) > 1e-10
    q = q[:, keep]
    return np.asarray(columns - q @ (q.T @ columns))


def sum_by(group: Index, values: Array, groups: int) -> Array:
    """Sums of values (n,) or (n, m) over groups: (groups,) or (groups, m)."""
    rows = len(group)
    member = csr_array((np.ones(rows), group, np.arange(rows + 1)), shape=(rows, groups))
    return np.asarray(member.T @ values)


@dataclass(frozen=True)
class Scores:
    """Score statistics of m candidates."""

    statistic: Array
    """(m,): sum of the blocks' scores over their scatter; about standard normal without the effect."""
    p_value: Array
    """(m,): chance of so large a statistic anywhere among the m, without any effect."""


def score_test(
    columns: Array, residual: Array, block: Index, rng: np.random.Generator, draws: int = 9999
) -> Scores:
    """Is the residual (n,) arranged along any of the columns (n, m), already projected off the nuisance?"""
    scores = sum_by(block, columns * residual[:, None], int(block.max()) + 1)
    scatter = np.sqrt(np.sum(scores**2, axis=0))
    scatter[scatter == 0.0] = np.inf
    statistic = scores.sum(axis=0) / scatter
    signs = rng.choice([-1.0, 1.0], size=(draws, len(scores)))
    largest = np.max(np.abs(signs @ (scores / scatter)), axis=1, initial=0.0)
    exceed = np.sum(largest[:, None] >= np.abs(statistic)[None, :] * (1.0 - 1e-12), axis=0)
    return Scores(statistic, np.asarray((1.0 + exceed) / (1.0 + draws)))


def covariance_of(
    jacobian: Array,
    residual: Array,
    block: Index,
    known: Array | None = None,
    weight: float = 1.0,
) -> Array:
    """Covariance (k, k) of least-squares parameters, robust to any correlation within blocks.

    known: (k, k), the inverse covariance of what was known of the parameters before; the fit minimised
    |residual|^2 + weight |departure|^2, the departure in standard deviations of that, residuals (n,) in any unit.
    """
    gram = jacobian.T @ jacobian
    scatter = scatter_of_scores(jacobian, residual, block)
    if known is not None:
        gram, scatter = gram + weight * known, scatter + weight**2 * known
    scale = np.maximum(np.sqrt(np.diag(gram)), 1e-150)  # its square is a number still
    units = np.outer(scale, scale)
    bread = np.linalg.pinv(gram / units, rcond=1e-12)
    return np.asarray(bread @ (scatter / units) @ bread / units)


def scatter_of_scores(jacobian: Array, residual: Array, block: Index) -> Array:
    """(k, k): covariance of J'r by the scatter of its blocks, corrected for their number."""
    groups = int(block.max()) + 1
    n, k = jacobian.shape
    scores = np.empty((groups, k))
    for column in range(k):  # of all at once the products would take as much memory as the Jacobian
        scores[:, column] = np.bincount(block, jacobian[:, column] * residual, groups)
    small_sample = groups / max(groups - 1, 1) * (n - 1) / max(n - k, 1)
    return np.asarray(small_sample * scores.T @ scores)


def leveraged_covariance(
    jacobian: Array, residual: Array, block: Index, known: Array, weight: float = 1.0
) -> Array:
    """Covariance (k, k) as by `covariance_of`, each block's residuals as large as they would be had it had no part in
    the fit: (I - J_b B J_b')^(-1/2) r_b, with B the inverse of J'J and of what was known (CR2; Bell and McCaffrey
    2002). That counts where parameters are many for the number of blocks.
    """
    scale, bread = _scaled_inverse(jacobian.T @ jacobian + weight * known)
    units = np.outer(scale, scale)
    value, vector = np.linalg.eigh(bread)
    root = vector * np.sqrt(np.maximum(value, 0.0))
    scores = []
    for rows in np.split(np.argsort(block, kind="stable"), np.cumsum(np.bincount(block))[:-1]):
        own = jacobian[rows] / scale
        inner, score = own.T @ own, own.T @ residual[rows]
        leverage, axes = np.linalg.eigh(root.T @ inner @ root)
        left = np.sqrt(1.0 - np.clip(leverage, 0.0, MOST_LEVERAGE))
        grown = axes @ ((axes.T @ (root.T @ score)) / (left * (1.0 + left)))
        scores.append(score + inner @ (root @ grown))
    scatter = np.transpose(scores) @ scores + weight**2 * known / units
    return np.asarray(bread @ scatter @ bread / units)


def covariance_from(information: Array) -> Array:
    """(k, k): the inverse of an information matrix (k, k), whatever the units of its rows; 0 where there is none."""
    scale, inverse = _scaled_inverse(information)
    return np.asarray(inverse / np.outer(scale, scale))


def _scaled_inverse(information: Array) -> tuple[Array, Array]:
    """Units (k,) in which its diagonal is one, and its inverse (k, k) in these."""
    scale = np.sqrt(np.maximum(np.diag(information), 1e-300))
    scaled = information / np.outer(scale, scale)
    return scale, np.asarray(np.linalg.pinv(scaled, rcond=1e-12, hermitian=True))


def resampled(record: Index, block: Index, rng: np.random.Generator, draws: int = 999) -> Array:
    """(draws, blocks): how often each block occurs when each record's blocks are drawn with replacement."""
    counts = np.zeros((draws, int(block.max()) + 1))
    for r in np.unique(record):
        members = np.unique(block[record == r])
        drawn = rng.choice(members, size=(draws, len(members)))
        for b in range(draws):
            np.add.at(counts[b], drawn[b], 1.0)
    return counts


def weighted_ms(squared: Array, block: Index, counts: Array) -> Array:
    """(draws,): mean of squared (n,) in each resample of blocks."""
    groups = counts.shape[1]
    totals = sum_by(block, squared, groups)
    sizes = sum_by(block, np.ones(len(squared)), groups)
    return np.asarray((counts @ totals) / (counts @ sizes))


def interval(values: Array) -> tuple[float, float]:
    """The middle 95 percent."""
    low, high = np.quantile(values, [0.025, 0.975])
    return float(low), float(high)


# ---- how long noise lasts ----------------------------------------------------------------------------------


def correlation_length(residual: Array, stroke: Index, longest: int = 1000) -> float:
    """Samples that count as one: 1 + 2 times the sum of the autocorrelation, up to where it first vanishes.

    Only pairs within one stroke are compared. A pattern that repeats in every stroke is no noise: take it
    off before (`without_repeats`).
    """
    centred = residual - residual.mean()
    power = float(np.mean(centred**2))
    length = 1.0
    for lag in range(1, min(longest, len(residual) - 1)):
        together = stroke[lag:] == stroke[:-lag]
        if not np.any(together) or power == 0.0:
            break
        correlation = float(np.mean((centred[lag:] * centred[:-lag])[together])) / power
        if correlation < 0.05:
            break
        length += 2.0 * correlation
    return length


def windows_per_block(residual: Array, record: Index, stroke: Index) -> int:
    """How many strokes make a block of BLOCK correlation lengths, at the most a quarter of a record's."""
    strokes = int(stroke.max()) + 1
    wanted = BLOCK * correlation_length(residual, stroke) * strokes / len(residual)
    fewest = min(len(np.unique(stroke[record == r])) for r in np.unique(record))
    return int(np.clip(np.ceil(wanted), 1, max(fewest // 4, 1)))


def merge_windows(record: Index, window: Index, together: int) -> Index:
    """(n,): number of the block of `together` windows in a row of one record, counted from 0."""
    first = {r: int(window[record == r].min()) for r in np.unique(record)}
    within = (window - np.vectorize(first.get)(record)) // together
    key = record * (int(window.max()) + 1) + within
    return np.unique(key, return_inverse=True)[1].astype(np.int64)
