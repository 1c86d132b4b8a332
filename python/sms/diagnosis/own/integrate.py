"""Many windows at once: Runge-Kutta of the fourth order over a batch, its time loop in Python, the rest in numpy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.own.delayed import Delayed
from sms.diagnosis.own.model import Equation, Model, Values
from sms.diagnosis.own.steps import runge_kutta

Push = Callable[[float], Array]
"""Of the time in samples since the window began to what is added to the derivative (states, n)."""


@dataclass(frozen=True)
class Batch:
    """n simulations, side by side."""

    step: Array
    """(n,) s between samples."""
    inputs: Array
    """(samples, inputs, n)"""
    start: Array
    """(states, n)"""
    delayed: Sequence[Delayed] = ()
    """The inputs that act later; what stands for them in `inputs` is not looked at."""


def simulate(model: Model, values: Values, batch: Batch, push: Push | None = None) -> Array:
    """Predicted readings (samples, outputs, n). Not finite where the model cannot go on."""
    return _run(model, values, batch, push, None)


def trajectory(model: Model, values: Values, batch: Batch) -> tuple[Array, Array]:
    """The same, and the states (samples, states, n)."""
    states = np.empty((len(batch.inputs), len(model.states), len(batch.step)))
    return _run(model, values, batch, None, states), states


def _run(
    model: Model, values: Values, batch: Batch, push: Push | None, states: Array | None
) -> Array:
    samples, _, n = batch.inputs.shape
    longest = model.longest_step or np.inf
    inner = max(1, int(np.ceil(float(batch.step.max()) / longest - 1e-9)))
    h = batch.step / inner
    felt = _Felt(model, values, batch, inner)
    exact, none = model.exact, np.zeros_like(batch.start)
    numbers = exact.numbers(values, n) if exact is not None else none
    x = batch.start
    out = np.empty((samples, len(model.outputs), n))

    def rate(time: float, x: Array, u: Array) -> Array:
        found = _rows(model.derivative, values, x, u, len(model.states))
        return found if push is None else found + push(time)

    with np.errstate(all="ignore"):
        for k in range(samples):
            out[k] = _rows(model.output, values, x, felt.at(k), len(model.outputs))
            if states is not None:
                states[k] = x
            if k + 1 == samples:
                break
            for i in range(inner):
                first, half, last = felt.during(k, i)
                if exact is not None:
                    ends = [none if push is None else push(k + at / inner) for at in (i, i + 1)]
                    x = exact.advance(numbers, x, (first, last), (ends[0], ends[1]), h)
                    continue
                inputs = {0.0: first, 0.5: half, 1.0: last}
                x = runge_kutta(lambda part, x: rate(k + (i + part) / inner, x, inputs[part]), x, h)  # noqa: B023
                if model.jump is not None:
                    x = _rows(model.jump, values, x, last, len(model.states))
    return out


@dataclass(frozen=True)
class Slopes:
    """A simulation with its exact derivatives."""

    out: Array
    """(samples, outputs, n)"""
    by_start: Array
    """(samples, outputs, states, n): by the initial state."""
    by_parameter: Array
    """(samples, outputs, parameters, n): by all parameters in their order; of none, if not asked for."""


def simulate_with_slopes(model: Model, values: Values, batch: Batch, by_parameters: bool) -> Slopes:
    """As `simulate`, with derivatives: those of each step, chained. For a model from CasADi."""
    exact = model.exact
    assert exact is not None
    samples, _, n = batch.inputs.shape
    longest = model.longest_step or np.inf
    inner = max(1, int(np.ceil(float(batch.step.max()) / longest - 1e-9)))
    felt, numbers = _Felt(model, values, batch, inner), exact.numbers(values, n)
    states, outputs = len(model.states), len(model.outputs)
    count = len(model.parameters) if by_parameters else 0
    x, start = batch.start, np.tile(np.eye(states), (n, 1, 1))
    parameter = np.zeros((n, states, count))
    out = np.empty((samples, outputs, n))
    by_start = np.empty((samples, outputs, states, n))
    by_parameter = np.empty((samples, outputs, count, n))
    with np.errstate(all="ignore"):
        for k in range(samples):
            out[k], c, *d = exact.output_slopes(numbers, x, felt.at(k), by_parameters)
            by_start[k] = (c @ start).transpose(1, 2, 0)
            if by_parameters:
                by_parameter[k] = (c @ parameter + d[0]).transpose(1, 2, 0)
            for i in range(inner if k + 1 < samples else 0):
                first, _, last = felt.during(k, i)
                h = batch.step / inner
                x, a, *b = exact.step_slopes(numbers, x, (first, last), h, by_parameters)
                start = a @ start
                if by_parameters:
                    parameter = a @ parameter + b[0]
    return Slopes(out, by_start, by_parameter)


class _Felt:
    """The inputs (inputs, n) as the plant feels them, between their samples too."""

    def __init__(self, model: Model, values: Values, batch: Batch, inner: int) -> None:
        self._inputs = batch.inputs
        self._delayed = [(d, values[d.parameter] / batch.step) for d in batch.delayed]
        self._inner = inner
        held = np.array([i.held for i in model.inputs], dtype=bool)
        self._held = held[:, None]
        self._constant = bool(held.all()) and not batch.delayed

    def at(self, k: int) -> Array:
        """At a sample."""
        u: Array = self._inputs[k]
        if self._delayed:
            u = u.copy()
            for d, late in self._delayed:
                u[d.number] = d.at(k - late)
        return u

    def during(self, k: int, i: int) -> tuple[Array, Array, Array]:
        """At the beginning, the middle and the end of a step of the integration."""
        u = self._inputs[k]
        if self._constant:
            return u, u, u
        slope = np.where(self._held, 0.0, self._inputs[k + 1] - u)
        places = [(i + part) / self._inner for part in (0.0, 0.5, 1.0)]
        first, half, last = (u + place * slope for place in places)
        for d, late in self._delayed:
            if d.held:
                mean = d.mean(k + places[0] - late, 1.0 / self._inner)
                first[d.number] = half[d.number] = last[d.number] = mean
            else:
                for place, part in zip(places, (first, half, last), strict=True):
                    part[d.number] = d.at(k + place - late)
        return first, half, last


def _rows(function: Equation, values: Values, x: Array, u: Array, rows: int) -> Array:
    found = function(values, x, u)
    out = np.empty((rows, x.shape[1]))
    for i in range(rows):
        out[i] = found[i]
    return out
