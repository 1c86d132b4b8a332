"""How much a model leaves beyond the noise, window by window, and whether that is little.

Counted by window and signal, in units of the noise, on a logarithmic scale: a window in which a piston sticks where the
machine slides would outweigh all others in a sum of squares, and it says no more than they do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.hypothesis import Data, Fitted, refitted
from sms.diagnosis.thresholds import LEAST_OF_NOISE, TOLERATED, WELL
from sms.estimation.windows import Runs


def energies(runs: Runs, residual: Array) -> Array:
    """(windows, channels): mean square of the residual (rows,), in units of the declared noise."""
    channels = len(runs.channels)
    first = np.array([w.row for w in runs.problem.windows])
    samples = np.array([w.samples for w in runs.problem.windows])
    squares = residual.reshape(-1, channels) ** 2
    sums = np.add.reduceat(squares, first // channels, axis=0)
    return np.asarray(sums / samples[:, None])


@dataclass(frozen=True)
class Left:
    """What a model leaves, window by window: (windows, channels) on records of either role.

    On validation records its causes are held, and what is known may move within what is declared: whether the model is
    of the right form is one question, how well its fitted values predict another (hypothesis.unseen).
    """

    identify: Array
    validate: Array

    @classmethod
    def by(cls, fitted: Fitted, data: Data) -> Left:
        return cls(
            energies(data.identify, fitted.fit.residual),
            energies(data.validate, refitted(fitted, data).fit.residual),
        )

    @property
    def logarithms(self) -> Array:
        """(windows,): sum over the channels, the noise of a sample added, on the fitted records and then the others."""
        return np.asarray(np.log1p(np.vstack([self.identify, self.validate])).sum(axis=1))


def logarithms(runs: Runs, residual: Array) -> float:
    """Sum over windows and signals of the logarithm of what a residual (rows,) leaves, the noise of a sample added."""
    return float(np.sum(np.log1p(energies(runs, residual))))


def excess(energy: Array) -> float:
    """Of (windows, channels): mean square beyond the noise, the channels' mean."""
    return float(np.mean(np.maximum(energy.mean(axis=0) - 1.0, 0.0)))


def tolerated(baseline: Fitted, data: Data) -> Array:
    """(channels,): mean square, in units of the noise, that a model may leave beyond it.

    All that is declared uncertain moves the predictions; TOLERATED of that is not worth a word.
    """
    h, runs = baseline.hypothesis, data.identify
    uncertainty = np.array([h.known.get(n, 0.0) for n in h.free])
    moved = np.sum((baseline.fit.jacobian * uncertainty) ** 2, axis=1)
    by_channel = np.array([np.mean(moved[runs.channel == c]) for c in range(len(runs.channels))])
    return np.asarray(TOLERATED**2 * by_channel)


def small(left: Left, least: Array) -> bool:
    """Whether what is left beyond the noise is within what is tolerated (channels,), on the records of each role."""
    return all(
        float(np.mean(np.maximum(e.mean(axis=0) - 1.0, 0.0) / np.maximum(least, 1e-12))) < 1.0
        for e in (left.identify, left.validate)
    )


def nothing_left(left: Left, data: Data) -> bool:
    """Whether a model leaves hardly more than noise: less than twice what fair descriptions differ by."""
    total, worst = data.identify.kind.honest
    beyond = 0.5 * (left.identify.mean(axis=0) + left.validate.mean(axis=0)) - 1.0
    return float(beyond.mean()) < 2.0 * total and float(beyond.max()) < 2.0 * worst


def left_when_well(healthy: Fitted, runs: Runs) -> Array:
    """(channels,): the same from records of the healthy machine, whose own error is no fault of it.

    healthy: the baseline as these records (runs) have it. One and a half times that, and a tenth of the noise at least.
    """
    beyond = np.maximum(energies(runs, healthy.fit.residual).mean(axis=0) - 1.0, 0.0)
    return np.asarray(WELL * beyond + LEAST_OF_NOISE)
