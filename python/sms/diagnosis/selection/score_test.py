"""Which effects a residual in units of the noise speaks for: the sensitivities of all of them, and a test of each.

A sensitivity is the change of the residual with an effect, less what the free parameters can undo within what is
declared known about them. Its score is summed over windows. Noise is declared here, so the scatter of a score is
known two ways: from the noise, and from the windows after the effect has been taken out. The larger holds. (Scatter
taken before would count a strong effect as its own noise.) The largest statistic of all effects is held against its
distribution under random signs of whole windows, as in estimation/block_statistics.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array, Index
from sms.estimation.block_statistics import sum_by
from sms.estimation.nuisance import Nuisance


@dataclass(frozen=True)
class ScoreTests:
    """The tests of m effects at one point. Arrays (m,) and sensitivities (rows + known, m)."""

    sensitivity: Array
    statistic: Array
    """Estimate over its standard error."""
    p_value: Array
    """Chance of so large a statistic anywhere among the m, without any effect; 1 for a sign that cannot be."""
    estimate: Array
    """Linear estimate of the effect's size, as a shift of its parameter."""
    error: Array
    """Its standard error."""
    gain: Array
    """Chi-square that the linear estimate takes away."""

    def promise(self, lower: Array, upper: Array) -> Array:
        """(m,): the gain where the shifts stay within (m,) bounds: an estimate beyond all reason promises little."""
        step = np.clip(self.estimate, lower, upper)
        size = np.sum(self.sensitivity**2, axis=0)
        within = size * step * (2.0 * self.estimate - step)
        return np.asarray(np.where(self.gain > 0.0, np.maximum(within, 0.0), 0.0))

    @cached_property
    def cosine(self) -> Array:
        """(m, m): similarity of sensitivities, 0..1."""
        return cosines(self.sensitivity)


def cosines(columns: Array) -> Array:
    """(m, m): similarity of columns (rows, m), 0..1."""
    unit = columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    return np.asarray(np.abs(unit.T @ unit))


def score_tests(
    sensitivity: Array,
    nuisance: Nuisance,
    residual: Array,
    block: Index,
    allowed: NDArray[np.bool_],
    rng: np.random.Generator,
    draws: int = 999,
) -> ScoreTests:
    """Test sensitivities (rows + known, m). allowed (m, 2): whether the estimate may be negative, and positive."""
    full = np.concatenate([residual, nuisance.departure])
    blocks = np.concatenate([block, np.full(len(nuisance.pull), int(block.max()) + 1)])
    groups = int(blocks.max()) + 1
    size = np.sum(sensitivity**2, axis=0)
    size[size == 0.0] = np.inf
    scores = sum_by(blocks, sensitivity * full[:, None], groups)
    total = scores.sum(axis=0)
    estimate = -total / size
    after = scores + estimate * sum_by(blocks, sensitivity**2, groups)
    scale = max(float(np.mean(residual**2)), 1e-12)
    left = np.maximum(np.sum(full**2) - total**2 / size, 0.0) / len(residual)
    by_noise = np.sqrt(np.minimum(left, scale) * size)
    by_windows = np.sqrt(np.sum(after**2, axis=0) * groups / max(groups - 1, 1))
    scatter = np.maximum(np.maximum(by_noise, by_windows), 1e-300)
    statistic = -total / scatter
    wild = rng.choice([-1.0, 1.0], size=(draws, groups)) @ (after / np.maximum(by_windows, 1e-300))
    largest = np.sort(np.max(np.abs(wild), axis=1, initial=0.0))
    exceed = draws - np.searchsorted(largest, np.abs(statistic) * (1.0 - 1e-12))
    p_value = (1.0 + exceed) / (1.0 + draws)
    right_sign = np.where(statistic < 0.0, allowed[:, 0], allowed[:, 1])
    return ScoreTests(
        sensitivity,
        statistic,
        np.where(right_sign, p_value, 1.0),
        estimate,
        scatter / size,
        np.where(right_sign, total**2 / size, 0.0),
    )
