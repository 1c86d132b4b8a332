"""How much a model leaves beyond the noise, window by window, and whether that is little.

Counted by window and signal, in units of the noise, on a logarithmic scale: a window in which a piston sticks where the
machine slides would outweigh all others in a sum of squares, and it says no more than they do.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.stats import chi2

from sms.arrays import Array
from sms.diagnosis.fitting import cost_of_departure, weights_of
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted
from sms.diagnosis.thresholds import DEPARTS, LEAST_OF_NOISE, TOLERATED
from sms.estimation.windows import Runs


def energies(runs: Runs, residual: Array) -> Array:
    """(windows, channels): mean square of the residual (rows,), in units of the declared noise."""
    channels = len(runs.channels)
    first = np.array([w.row for w in runs.problem.windows])
    samples = np.array([w.samples for w in runs.problem.windows])
    squares = residual.reshape(-1, channels) ** 2
    sums = np.add.reduceat(squares, first // channels, axis=0)
    return np.asarray(sums / samples[:, None])


Role = Literal["identify", "validate"]
ROLES: tuple[Role, Role] = ("identify", "validate")


@dataclass(frozen=True)
class Left:
    """What a model leaves, window by window: (windows, channels) on records of either role.

    On validation records its causes are held, and what is known may move within what is declared: whether the model is
    of the right form is one question, how well its fitted values predict another (other_records.unseen).

    With records of the healthy machine the unit is what its own model leaves. What is known is then known so well that
    how far it had to move is a measurement too, and counts in every window alike.
    """

    identify: Array
    validate: Array

    @classmethod
    def by(cls, fitted: Fitted, data: Data) -> Left:
        models = (data.identify, fitted), (data.validate, refitted(fitted, data))
        identify, validate = (_left(data, runs, model) for runs, model in models)
        return cls(identify, validate, data.healthy is not None)

    def where_fitted(self, fitted: Fitted, data: Data) -> Left:
        """By another model on the fitted records; on the validation records what this one leaves."""
        return replace(self, identify=_left(data, data.identify, fitted))

    absolute: bool = False
    """Whether the unit is what the healthy machine's model leaves."""

    @property
    def by_window(self) -> Array:
        """(windows,): what counts in comparisons, on the fitted records and then the others: the sum over the channels
        of the logarithms, the unit added. That is the likelihood of Student's t, in which a window that no model
        follows has no more to say than any other."""
        return np.asarray(np.log1p(np.vstack([self.identify, self.validate])).sum(axis=1))

    def energy(self, role: Role) -> Array:
        """(windows, channels)"""
        return self.identify if role == "identify" else self.validate

    def of(self, channel: int) -> Left:
        """In one signal."""
        return Left(self.identify[:, [channel]], self.validate[:, [channel]], self.absolute)

    def excess(self, role: Role) -> float:
        """Mean square beyond the noise; beyond what the healthy machine's model leaves, where the unit is that."""
        energy = self.energy(role)
        return max(float(np.mean(energy)) - 1.0, 0.0) if self.absolute else excess(energy)

    def share_taken(self, after: Left, role: Role) -> float:
        """Of that, the share that another model takes."""
        return 1.0 - after.excess(role) / max(self.excess(role), 1e-12)


def _left(data: Data, runs: Runs, model: Fitted) -> Array:
    energy = energies(runs, beyond_healthy(data, runs, model.fit.residual))
    if data.healthy is None:
        return energy
    by_chance = data.healthy.inflation * len(model.hypothesis.known)
    moved = max(cost_of_departure(model) - by_chance, 0.0) / runs.problem.rows
    return np.asarray((energy + moved) / data.healthy.level)


def beyond_healthy(data: Data, runs: Runs, residual: Array) -> Array:
    """A residual (rows,) in units of the noise and, where records told it, of the healthy machine's discrepancy."""
    allowed = data.allowed(runs)
    return residual if allowed is None else allowed.whitener.whiten(residual)


def logarithms(runs: Runs, residual: Array) -> float:
    """Sum over windows and signals of the logarithm of what a residual (rows,) leaves, the noise of a sample added."""
    return float(np.sum(np.log1p(energies(runs, residual))))


def taken_beyond_floor(before: Fitted, after: Fitted, data: Data) -> tuple[float, float]:
    """Of what one model leaves beyond the noise floor, the share that another takes: on identification records, and on
    validation records with what is known fitted again.

    One floor for both: what changes within `kind.short`, and the declared noise at least. What a converter's steps add
    to the declared noise is left by every model.
    """
    seen = seen_beyond_floor(before, after, data.identify)
    return seen, seen_beyond_floor(refitted(before, data), refitted(after, data), data.validate)


def seen_beyond_floor(before: Fitted, after: Fitted, runs: Runs) -> float:
    """Of what one model leaves beyond the noise floor, the share that another takes on records both were fitted to."""
    residuals = before.fit.residual, after.fit.residual
    floor = np.maximum(np.minimum(*(runs.floor(r) for r in residuals)), 1.0)
    was, now = (
        float(np.mean(np.maximum(energies(runs, r).mean(axis=0) - floor, 0.0))) for r in residuals
    )
    return 1.0 - now / max(was, 1e-12)


def excess(energy: Array) -> float:
    """Of (windows, channels): mean square beyond the noise, the channels' mean."""
    return float(np.mean(np.maximum(energy.mean(axis=0) - 1.0, 0.0)))


def tolerated(baseline: Fitted, data: Data) -> Array:
    """(channels,): mean square, in units of the noise, that a model may leave beyond it.

    All that is declared uncertain moves the predictions; TOLERATED of that is not practically significant.
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
    """Whether a model leaves hardly more than noise: less than twice what fair descriptions differ by; where records of
    the healthy machine told what its own leaves, hardly more than that.
    """
    if left.absolute:
        return all(left.excess(role) < LEAST_OF_NOISE for role in ROLES)
    total, worst = data.identify.kind.practically_significant
    beyond = 0.5 * (left.identify.mean(axis=0) + left.validate.mean(axis=0)) - 1.0
    return float(beyond.mean()) < 2.0 * total and float(beyond.max()) < 2.0 * worst


def departs(fitted: Fitted) -> bool:
    """Whether what is known had to move farther from what is declared than chance has it, for a model to fit so well.

    Chi-square, with as many degrees of freedom as these records tell of what is known. A spoilt machine may be
    described by maps that are at the end of what may be wrong with them, and then little is left.
    """
    h, names = fitted.hypothesis, list(fitted.hypothesis.free)
    jacobian, pull = fitted.fit.jacobian.astype(np.float64), weights_of(h, names)
    information, declared = jacobian.T @ jacobian, pull.T @ pull
    scale = np.sqrt(np.maximum(np.diag(information + declared), 1e-300))
    information, declared = (m / np.outer(scale, scale) for m in (information, declared))
    told = np.trace(np.linalg.pinv(information + declared, hermitian=True) @ information)
    by_records_alone = sum(n not in h.known for n in names)
    return bool(chi2.sf(cost_of_departure(fitted), max(told - by_records_alone, 1.0)) < DEPARTS)


def differs_when_well(data: Data) -> Array:
    """(channels,): by how much one record of the healthy machine is above the level of all, the least being
    LEAST_OF_NOISE: what another record may leave beyond that level too."""
    assert data.healthy is not None
    return np.maximum(data.healthy.spread, LEAST_OF_NOISE)
