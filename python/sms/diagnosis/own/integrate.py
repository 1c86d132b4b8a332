"""Many windows at once: Runge-Kutta of the fourth order over a batch, its time loop in Python, the rest in numpy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
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


def simulate(model: Model, values: Values, batch: Batch, push: Push | None = None) -> Array:
    """Predicted readings (samples, outputs, n). Not finite where the model cannot go on."""
    samples, _, n = batch.inputs.shape
    longest = model.longest_step or np.inf
    inner = max(1, int(np.ceil(float(batch.step.max()) / longest - 1e-9)))
    h = batch.step / inner
    held = np.array([i.held for i in model.inputs], dtype=bool)[:, None]
    x = batch.start
    out = np.empty((samples, len(model.outputs), n))

    def rate(time: float, x: Array, u: Array) -> Array:
        found = _rows(model.derivative, values, x, u, len(model.states))
        return found if push is None else found + push(time)

    with np.errstate(all="ignore"):
        for k in range(samples):
            u = batch.inputs[k]
            out[k] = _rows(model.output, values, x, u, len(model.outputs))
            if k + 1 == samples:
                break
            slope = np.where(held, 0.0, batch.inputs[k + 1] - u)
            for i in range(inner):
                t = i / inner
                middle, end = t + 0.5 / inner, t + 1.0 / inner
                half = u + middle * slope
                k1 = rate(k + t, x, u + t * slope)
                k2 = rate(k + middle, x + 0.5 * h * k1, half)
                k3 = rate(k + middle, x + 0.5 * h * k2, half)
                k4 = rate(k + end, x + h * k3, u + end * slope)
                x = x + (h / 6.0) * (k1 + 2.0 * (k2 + k3) + k4)
    return out


def _rows(function: Equation, values: Values, x: Array, u: Array, rows: int) -> Array:
    found = function(values, x, u)
    out = np.empty((rows, x.shape[1]))
    for i in range(rows):
        out[i] = found[i]
    return out
