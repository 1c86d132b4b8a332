"""What every model of a machine leaves beside noise, as a part of the statistics: a random input of each equation.

Kennedy and O'Hagan (2001) put one random function between a simulator's output and the data. Here it sits where a
model is wrong, in its equations: each has an unknown input that is random at knots 50 ms apart, linear in between,
of a standard deviation tau. Carried through the simulation to first order (H, libsms/estimation/shooting.hpp), the
residual of a window has the covariance

  V = I + H diag(tau^2) H'

in units of the noise. One more input of each window are the times at which its command jumped: what a logger has of a
controller that is faster tells to within its sampling period when the valve was switched (command_jumps.hpp), and so
large they are.

A window in which the piston hangs on a stop or breaks away asks for inputs far larger than the
others do: they are larger there, and say little of tau (Student's t, variance_components.py). Generalised least squares
with V asks of a parameter what a wandering input cannot do as well: a standard error grows where the discrepancy can
imitate it, and no parameter is driven to its bound by a friction or a flow that is a little off. The tau come from the
data, by maximum marginal likelihood; of an equation that is right they go to nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.arrays import Array, Index
from sms.estimation.problem import Problem, Window
from sms.estimation.variance_components import most_likely

KNOTS = 21
"""Knots per window of 1 s, 50 ms apart. Run time: the noise hides anything faster."""
ITERATIONS = 12
"""Of the fixed point of tau. Run time: it settles within some percent."""
LEAST = 1e-3
"""Standard deviations of the noise: an input that moves readings by less is nothing. Numerics."""


class Shot(Protocol):
    """A problem of windows whose equations have inputs."""

    @property
    def windows(self) -> Sequence[Window]: ...

    def hidden(self, params: _core.Params, knots: int) -> Array: ...

    def jumps(self, params: _core.Params) -> Array: ...


@dataclass(frozen=True)
class Discrepancy:
    """The hidden inputs of a problem's windows, and how large they are."""

    rows: tuple[slice, ...]
    """Of each window."""
    inputs: Array
    """(rows, equations * KNOTS + jumps): change of the residual with each input at each knot of its window, then with
    the time of each jump of its command, in standard deviations."""
    products: Array
    """(windows, inputs, inputs): of the inputs with each other."""
    group: Index
    """(inputs,): the equation whose input each is; the last group are the jumps, if there are any."""
    tau: Array
    """(groups,): standard deviation of each equation's input; of the jumps' times, 1."""
    known: NDArray[np.bool_]
    """(groups,): of which that is known; the others are as the data have it."""
    larger: Array | float = 1.0
    """(windows, groups): by which factor it is larger in a window."""
    alike: bool = False
    """Whether it is the same in all windows, as one is that has to hold on other records."""

    @classmethod
    def of(
        cls,
        problem: Shot,
        params: _core.Params,
        equations: int,
        residual: Array,
        alike: bool = False,
        jumping: Sequence[float] = (),
    ) -> Discrepancy:
        """As likely as can be for the residual (rows,) of a model with these parameters. jumping: how nearly it is
        known of each record when its commands jumped, s; empty where there are none."""
        groups = equations + (1 if jumping else 0)
        blank = replace(cls.sized(problem, params, np.zeros(groups), jumping), alike=alike)
        level = max(float(np.linalg.norm(residual)) / np.sqrt(len(blank.rows) * KNOTS), LEAST)
        start = np.where(blank.known, blank.tau, blank.moving(level))
        return replace(blank, tau=start).fitted_to(residual)

    @classmethod
    def sized(
        cls, problem: Shot, params: _core.Params, tau: Array, jumping: Sequence[float] = ()
    ) -> Discrepancy:
        """With standard deviations (groups,) that are known from elsewhere."""
        rows = tuple(slice(w.row, w.row + w.rows) for w in problem.windows)
        inputs = np.asarray(problem.hidden(params, KNOTS))
        group = np.repeat(np.arange(inputs.shape[1] // KNOTS), KNOTS)
        if jumping:
            deviation = np.concatenate(
                [np.full(w.rows, jumping[w.record]) for w in problem.windows]
            )
            jumps = problem.jumps(params) * deviation[:, None]
            inputs = np.hstack([inputs, jumps])
            group = np.concatenate([group, np.full(jumps.shape[1], len(tau) - 1)])
            tau = np.append(tau[:-1], 1.0)
        products = np.array([inputs[r].T @ inputs[r] for r in rows])
        known = np.arange(len(tau)) >= len(tau) - (1 if jumping else 0)
        return cls(rows, inputs, products, group, np.asarray(tau), known)

    def moving(self, level: float) -> Array:
        """(groups,): tau of inputs that each move the readings by so much; 0 where none does."""
        squares = np.bincount(self.group, np.einsum("wii->i", self.products)) / np.bincount(
            self.group
        )
        size = np.sqrt(squares)
        return np.where(size > 0.0, level / np.where(size > 0.0, size, 1.0), 0.0)

    def fitted_to(self, residual: Array, counted: Index | None = None) -> Discrepancy:
        """With the standard deviations under which the residual (rows,) is most likely.

        counted: the windows that tell them where they are alike in all, those that a fit has not set aside; None: all.
        """
        least = self.moving(LEAST * np.sqrt(len(self.rows)))
        score = np.array([self.inputs[r].T @ residual[r] for r in self.rows])
        start = np.where(self.known, self.tau, np.maximum(self.tau, 30.0 * least))
        which = counted if self.alike and counted is not None else np.arange(len(self.rows))
        tau, larger = most_likely(
            self.products[which],
            score[which],
            self.group,
            start,
            least,
            ITERATIONS,
            self.alike,
            self.known,
        )
        return replace(self, tau=tau, larger=1.0 if self.alike else larger)

    def expected(self, residual: Array, at: Array | float = 0.0) -> Array:
        """(windows, inputs): the inputs that explain the residual (rows,) of a simulation in which they are `at`
        (windows, inputs): their mean, given that."""
        at = np.broadcast_to(at, (len(self.rows), len(self.group)))
        tau = self.tau * np.broadcast_to(self.larger, (len(self.rows), len(self.tau)))
        found = np.empty(at.shape)
        for k, (r, d) in enumerate(zip(self.rows, tau[:, self.group], strict=True)):
            inner = np.eye(len(d)) + d[:, None] * self.products[k] * d
            pulled = self.inputs[r].T @ (self.inputs[r] @ at[k] - residual[r])
            found[k] = d * np.linalg.solve(inner, d * pulled)
        return found

    @cached_property
    def whitener(self) -> Whitener:
        """Multiplies by the inverse root of the covariance."""
        tau = self.tau * np.broadcast_to(self.larger, (len(self.rows), len(self.tau)))
        d = tau[:, self.group]
        value, vector = np.linalg.eigh(d[:, :, None] * self.products * d[:, None, :])
        value = np.maximum(value, 1e-12)
        bases = [
            self.inputs[r] @ (size[:, None] * v / np.sqrt(s))
            for r, size, s, v in zip(self.rows, d, value, vector, strict=True)
        ]
        return Whitener(self.rows, bases, np.sqrt(1.0 + value))


@dataclass(frozen=True)
class Whitener:
    """The root of a covariance of windows, V = I + B diag(root^2 - 1) B' with orthonormal B."""

    rows: tuple[slice, ...]
    bases: Sequence[Array]
    root: Array
    """(windows, columns)"""

    def whiten(self, values: Array) -> Array:
        """(rows,) or (rows, m): times V^(-1/2)."""
        return self._times(1.0 / self.root - 1.0, values)

    def colour(self, values: Array) -> Array:
        """(rows,) or (rows, m): times V^(1/2)."""
        return self._times(self.root - 1.0, values)

    def whiten_in_place(self, values: Array) -> Array:
        """The same of an array that nobody else needs."""
        return self._times(1.0 / self.root - 1.0, values, values)

    def _times(self, factor: Array, values: Array, out: Array | None = None) -> Array:
        out = np.array(values, dtype=np.float64) if out is None else out
        for r, basis, f in zip(self.rows, self.bases, factor, strict=True):
            part = basis.T @ out[r]
            out[r] += basis @ (f * part.T).T
        return out


@dataclass(frozen=True)
class Whitened:
    """A problem whose residuals are as independent as noise."""

    problem: Problem
    whitener: Whitener

    @property
    def rows(self) -> int:
        return self.problem.rows

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        """As Problem has them, both times the inverse root of the covariance."""
        residual, jacobian = self.problem.evaluate(params, free)
        white = self.whitener.whiten_in_place
        return white(residual), white(jacobian) if len(free) else jacobian
