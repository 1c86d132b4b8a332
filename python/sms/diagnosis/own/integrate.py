"""Many windows at once: Runge-Kutta of the fourth order over a batch, its time loop in Python, the rest in numpy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.own.delayed import Delayed
from sms.diagnosis.own.model import Equation, Model, Values

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
                t, middle, end = (i + part for part in (0.0, 0.5, 1.0))
                first, half, last = felt.during(k, i)
                k1 = rate(k + t / inner, x, first)
                k2 = rate(k + middle / inner, x + 0.5 * h * k1, half)
                k3 = rate(k + middle / inner, x + 0.5 * h * k2, half)
                k4 = rate(k + end / inner, x + h * k3, last)
                x = x + (h / 6.0) * (k1 + 2.0 * (k2 + k3) + k4)
                if model.jump is not None:
                    x = _rows(model.jump, values, x, last, len(model.states))
    return out


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
