"""A model held against records by multiple shooting: what libsms/estimation/shooting.hpp does for the core's plants.

A record is cut into windows, each simulated from the state that fits it best; what that state can undo of a parameter's
sensitivity does not count. All windows of all records are simulated at once. Derivatives are central differences, one
simulation for all parameters together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.diagnosis.own.delayed import Delayed
from sms.diagnosis.own.integrate import (
    Batch,
    Push,
    Slopes,
    simulate,
    simulate_with_slopes,
    trajectory,
)
from sms.diagnosis.own.model import Model, Numbers, Values
from sms.diagnosis.thresholds import DIFFERENCE, INTEGRATION_ERROR, MOST_HALVINGS

Thing = TypeVar("Thing")
LARGEST_BATCH = 4000
"""Simulations side by side: more do not fit a processor's cache."""
MOST_STEPS = 12


@dataclass(frozen=True)
class Stretch:
    """One record as the problem needs it. Arrays (samples, inputs), (samples, outputs), (samples, states)."""

    step: float
    """s between samples"""
    inputs: Array
    measured: Array
    guess: Array
    conditions: Mapping[str, float]
    """Parameter -> by how much it is larger in this record."""
    window: float | None = None
    """s: of the windows it is cut into; None: as those of all."""
    clipped: NDArray[np.bool_] | None = None
    """(samples, outputs): readings at the end of their range, compared with nothing."""


@dataclass(frozen=True)
class Window:
    """Where a window lies."""

    record: int
    first: int
    """Sample of the record."""
    samples: int
    row: int
    """Where its rows begin: sample by sample, all outputs of one after the other."""
    rows: int


@dataclass(frozen=True)
class Shot:
    """All windows at their best initial states."""

    start: Array
    """(states, windows)"""
    residual: Array
    """(samples, outputs, windows): (predicted - measured) / noise, zero beyond a window's end."""
    basis: Array
    """(windows, samples * outputs, states): orthonormal, what the initial state can do."""


class ShootingProblem:
    """Residuals and derivatives of a model on several records, in units of the noise."""

    def __init__(
        self, model: Model, stretches: Sequence[Stretch], noise: Array, window: float
    ) -> None:
        self.model = model
        self.windows = list(_cut(stretches, window, model))
        self.rows = sum(w.rows for w in self.windows)
        longest = max(w.samples for w in self.windows)
        place = [
            np.minimum(w.first + np.arange(longest), w.first + w.samples - 1) for w in self.windows
        ]
        of = [stretches[w.record] for w in self.windows]
        self._step = np.array([s.step for s in of])
        self._inputs = np.stack([s.inputs[p] for s, p in zip(of, place, strict=True)], axis=-1)
        self._measured = np.stack([s.measured[p] for s, p in zip(of, place, strict=True)], axis=-1)
        self._noise = noise[:, None]
        self._samples = np.array([w.samples for w in self.windows])
        inside = np.arange(longest)[:, None] < self._samples
        self._used = np.repeat(inside[:, None], len(model.outputs), axis=1)
        for k, (s, p) in enumerate(zip(of, place, strict=True)):
            if s.clipped is not None:
                self._used[..., k] &= ~s.clipped[p]
        record, first = (
            np.array([getattr(w, a) for w in self.windows]) for a in ("record", "first")
        )
        self._delayed = [
            Delayed.of(j, i.delay, i.held, [s.inputs[:, j] for s in stretches], record, first)
            for j, i in enumerate(model.inputs)
            if i.delay
        ]
        self._shift = {
            name: np.array([s.conditions.get(name, 0.0) for s in of])
            for name in {n for s in stretches for n in s.conditions}
        }
        self._scale = np.array([s.scale for s in model.states])
        self._start = np.stack([s.guess[w.first] for s, w in zip(of, self.windows, strict=True)], 1)
        self._last: tuple[dict[str, Numbers], Array, Shot] | None = None

    # ---- what the search asks for ----------------------------------------------------------------

    def settle(self, params: Values) -> None:
        """Let later searches for initial states begin at the best ones of these parameters."""
        self._start = self._shoot(params).start

    def evaluate(self, params: Values, names: Sequence[str] = ()) -> tuple[Array, Array]:
        """Residual (rows,) and its derivatives (rows, names), less what initial states could undo."""
        shot = self._shoot(params)
        columns = np.empty((self.rows, len(names)))
        if names:
            self._start = shot.start
        late = {i.delay for i in self.model.inputs}
        plant = self.model.exact
        exact = [n for n in names if n not in late] if plant and plant.by_parameters else []
        if exact:
            for name, slope in zip(
                exact, self._exact_slopes(params, shot.start, exact), strict=True
            ):
                columns[:, list(names).index(name)] = self._flat(self._off(shot, slope))
        others = [k for k, name in enumerate(names) if name not in exact]
        for first, part in _parts(
            [names[k] for k in others], LARGEST_BATCH // (2 * len(self.windows))
        ):
            steps = [self._difference(params, name) for name in part]
            changes = [{n: s} for n, pair in zip(part, steps, strict=True) for s in pair]
            found = self._errors(params, shot.start, changes)
            for k, (down, up) in enumerate(steps):
                slope = (found[..., 2 * k + 1, :] - found[..., 2 * k, :]) / (up - down)
                columns[:, others[first + k]] = self._flat(self._off(shot, slope))
        return self._flat(shot.residual), columns

    def errors(self, params: Values) -> Array:
        """(rows,) predicted less measured over the noise, from the best initial states."""
        return self._flat(self._shoot(params).residual)

    def states(self, params: Values, start: Array | None = None) -> tuple[Array, Array]:
        """Readings (samples, outputs, windows) and states (samples, states, windows) from these initial states (states,
        windows); None: from the best."""
        start = self._shoot(params).start if start is None else start
        values = self._shifted(params, 1)
        return trajectory(self.model, values, self._batch(start, 1))

    def hidden(self, params: Values, knots: int) -> Array:
        """(rows, equations * knots): derivatives against inputs hidden in the model's equations.

        Each equation's input has `knots` values a window, linear in between; a window's rows belong to its own.
        """
        shot = self._shoot(params)
        equations = list(self.model.equations.values())
        every = [(e, k) for e in equations for k in range(knots)]
        columns = np.empty((self.rows, len(every)))
        for first, part in _parts(every, LARGEST_BATCH // (2 * len(self.windows))):
            size = [DIFFERENCE * self._scale[e] / float(self._step.min()) for e, _ in part]
            found = self._pushed(params, shot.start, part, size, knots)
            for k in range(len(part)):
                slope = (found[..., 2 * k + 1, :] - found[..., 2 * k, :]) / (2.0 * size[k])
                columns[:, first + k] = self._flat(self._off(shot, slope))
        return columns

    def with_fine_step(self) -> Model:
        """The model with its longest step; without one it is found from the predictions as declared.

        A change of all predictions by one standard deviation of their noise in all moves no estimate by more than its
        standard error.
        """
        if self.model.longest_step is not None:
            return self.model
        values, step = self.model.values(), float(self._step.max())
        before = self._errors(values, self._start)
        for _ in range(MOST_HALVINGS):
            self.model = replace(self.model, longest_step=0.5 * step)
            now = self._errors(values, self._start)
            change = np.where(np.isfinite(now - before), now - before, np.inf)[:, :, 0]
            if np.sum(change**2) < INTEGRATION_ERROR**2:
                break
            step, before = 0.5 * step, now
        self.model, self._last = replace(self.model, longest_step=step), None
        return self.model

    # ---- simulations, side by side ---------------------------------------------------------------

    def _errors(
        self, params: Values, start: Array, changes: Sequence[Mapping[str, float]] = ({},)
    ) -> Array:
        """(samples, outputs, changes, windows): the whitened errors, once for each set of changed parameters."""
        copies, windows = len(changes), len(self.windows)
        values = params.copy()
        touched = {n for change in changes for n in change} | set(self._shift)
        for name in touched:
            of_copy = np.array([change.get(name, params[name]) for change in changes])
            values[name] = np.add.outer(of_copy, self._shift.get(name, np.zeros(windows))).ravel()
        return self._compare(values, np.tile(start, copies), copies)

    def _pushed(
        self,
        params: Values,
        start: Array,
        places: Sequence[tuple[int, int]],
        size: Sequence[float],
        knots: int,
    ) -> Array:
        """As _errors, for hidden inputs of -size and +size at each (state, knot)."""
        windows = len(self.windows)
        copies = 2 * len(places)
        amplitude = np.zeros((len(self.model.states), copies, windows))
        of_knot = np.empty(copies)
        for k, (state, knot) in enumerate(places):
            amplitude[state, 2 * k], amplitude[state, 2 * k + 1] = -size[k], size[k]
            of_knot[2 * k : 2 * k + 2] = knot
        last = np.maximum(self._samples - 1, 1)

        def push(time: float) -> Array:
            away = np.abs(time / last * (knots - 1) - of_knot[:, None])
            added = amplitude * np.maximum(0.0, 1.0 - away)
            return np.asarray(added.reshape(len(amplitude), -1))

        values = self._shifted(params, copies)
        return self._compare(values, np.tile(start, copies), copies, push)

    def _shifted(self, params: Values, copies: int) -> Values:
        """The parameters with what is otherwise in some records, for so many copies of all windows."""
        values = params.copy()
        for name, shift in self._shift.items():
            values[name] = np.tile(params[name] + shift, copies)
        return values

    def _batch(self, start: Array, copies: int) -> Batch:
        delayed = [d.copies(copies) for d in self._delayed]
        return Batch(np.tile(self._step, copies), np.tile(self._inputs, copies), start, delayed)

    def _compare(
        self, values: Values, start: Array, copies: int, push: Push | None = None
    ) -> Array:
        found = simulate(self.model, values, self._batch(start, copies), push)
        found = found.reshape(*found.shape[:2], copies, len(self.windows))
        error = (found - self._measured[:, :, None, :]) / self._noise[:, :, None]
        return np.where(self._used[:, :, None, :], error, 0.0)

    def _with_slopes(self, params: Values, start: Array, by_parameters: bool) -> Slopes:
        values, batch = self._shifted(params, 1), self._batch(start, 1)
        return simulate_with_slopes(self.model, values, batch, by_parameters)

    def _exact_slopes(self, params: Values, start: Array, names: Sequence[str]) -> Iterator[Array]:
        """(samples, outputs, windows) for each parameter."""
        found = self._with_slopes(params, start, by_parameters=True).by_parameter
        place = {p.name: k for k, p in enumerate(self.model.parameters)}
        for name in names:
            yield np.where(self._used, found[:, :, place[name]] / self._noise, 0.0)

    def _difference(self, params: Values, name: str) -> tuple[float, float]:
        """The two values between which a parameter's derivative is taken, within its bounds."""
        p = self.model.parameter(name)
        scale = p.uncertainty or max(abs(p.value), abs(params[name])) or 1e-2 * (p.upper - p.lower)
        step = DIFFERENCE * scale
        return max(params[name] - step, p.lower), min(params[name] + step, p.upper)

    # ---- initial states --------------------------------------------------------------------------

    def _by_start(self, params: Values, start: Array) -> tuple[Array, Array]:
        """Errors (samples, outputs, windows), and (windows, samples * outputs, states) by state over its scale."""
        states = len(self._scale)
        if self.model.exact is not None and self.model.exact.by_state:
            there = self._with_slopes(params, start, by_parameters=False)
            error = np.where(self._used, (there.out - self._measured) / self._noise, 0.0)
            scaled = there.by_start * self._scale[:, None] / self._noise[:, None]
            scaled = np.where(self._used[:, :, None], scaled, 0.0)
            return error, scaled.transpose(3, 0, 1, 2).reshape(len(self.windows), -1, states)
        step = DIFFERENCE * self._scale
        moved = [start]
        for k in range(states):
            for sign in (-1.0, 1.0):
                other = start.copy()
                other[k] += sign * step[k]
                moved.append(other)
        values = self._shifted(params, len(moved))
        found = self._compare(values, np.hstack(moved), len(moved))
        slope = (found[:, :, 2::2] - found[:, :, 1::2]) / (2.0 * DIFFERENCE)
        samples, outputs, _, windows = slope.shape
        by_start = slope.transpose(3, 0, 1, 2).reshape(windows, samples * outputs, states)
        return found[:, :, 0], by_start

    def _shoot(self, params: Values) -> Shot:
        """The windows at their best initial states; a fit asks for residuals and then for slopes at the same values."""
        values = dict(params.__dict__)
        if self._last is not None and self._last[1] is self._start and self._last[0] == values:
            return self._last[2]
        shot = self._shot(params)
        self._last = (values, self._start, shot)
        return shot

    def _shot(self, params: Values) -> Shot:
        """Levenberg-Marquardt over the initial state of every window, until a step gains next to nothing."""
        start = self._start.copy()
        residual, by_start = self._by_start(params, start)
        damping = np.full(len(self.windows), 1e-6)
        going = np.ones(len(self.windows), dtype=bool)
        states = np.arange(len(self._scale))
        for _ in range(MOST_STEPS):
            e = _by_window(residual)
            normal = by_start.transpose(0, 2, 1) @ by_start
            normal[:, states, states] *= 1.0 + damping[:, None]
            normal[:, states, states] += 1e-3
            gradient = np.einsum("wrs,wr->ws", by_start, e)
            move = np.linalg.solve(normal, gradient[..., None])[..., 0]
            cost = np.sum(e**2, axis=1)
            enough = 0.1 + 1e-3 * cost
            going &= np.sum(gradient * move, axis=1) > enough
            if not np.any(going):
                break
            tried = start - np.where(going, move.T * self._scale[:, None], 0.0)
            there, tried_by_start = self._by_start(params, tried)
            gain = cost - np.sum(_by_window(there) ** 2, axis=1)
            better = going & (gain > 0.0)
            start = np.where(better, tried, start)
            residual = np.where(better, there, residual)
            by_start = np.where(better[:, None, None], tried_by_start, by_start)
            going &= np.where(better, gain >= enough, damping <= 1e3)
            damping = np.where(
                better, np.maximum(0.1 * damping, 1e-9), np.maximum(100.0 * damping, 1e-2)
            )
        return Shot(start, residual, _orthonormal(by_start))

    def _off(self, shot: Shot, columns: Array) -> Array:
        """Columns (samples, outputs, windows) less what the initial states can do."""
        flat = _by_window(columns)
        inside = np.einsum("wrs,wr->ws", shot.basis, flat)
        rest = flat - np.einsum("wrs,ws->wr", shot.basis, inside)
        return np.asarray(rest.T.reshape(columns.shape))

    def _flat(self, columns: Array) -> Array:
        """(rows,) window by window, sample by sample, output by output."""
        by_window = columns.transpose(2, 0, 1)
        return np.concatenate(
            [by_window[k, : w.samples].ravel() for k, w in enumerate(self.windows)]
        )


def _by_window(columns: Array) -> Array:
    """(samples, outputs, windows) -> (windows, samples * outputs)."""
    return np.asarray(columns.reshape(-1, columns.shape[-1]).T)


def _orthonormal(columns: Array) -> Array:
    """(windows, rows, r): bases of columns (windows, rows, states), zeros in the place of what leaves no trace."""
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(u * (s > 1e-9 * np.maximum(s[:, :1], 1e-300))[:, None, :])


def _cut(stretches: Sequence[Stretch], length: float, model: Model) -> Iterator[Window]:
    """Windows of about `length`, a record cut evenly after its longest dead time: what acted before is unknown."""
    row, outputs = 0, len(model.outputs)
    for record, s in enumerate(stretches):
        lead = samples_before(model, s.step)
        samples = len(s.measured) - lead
        parts = max(1, int(samples * s.step / (s.window or length) + 0.5))
        for part in range(parts):
            first, end = (lead + samples * p // parts for p in (part, part + 1))
            yield Window(record, first, end - first, row, (end - first) * outputs)
            row += (end - first) * outputs


def samples_before(model: Model, step: float) -> int:
    """Samples of a record from which its inputs alone are used: the longest dead time that a parameter may have."""
    longest = max((model.parameter(i.delay).upper for i in model.inputs if i.delay), default=0.0)
    return int(np.ceil(longest / step - 1e-9))


def _parts(things: list[Thing], size: int) -> Iterator[tuple[int, list[Thing]]]:
    """Lists of at most `size`, each with the place of its first."""
    size = max(size, 1)
    for first in range(0, len(things), size):
        yield first, things[first : first + size]
