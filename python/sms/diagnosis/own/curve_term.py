"""The measured curve of a missing term, as a term of a model's equation: it predicts, and explains nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from sms.arrays import Array
from sms.diagnosis.own.model import Model, Values
from sms.diagnosis.remainder import Shape

Read = Callable[[Values, Array, Array], Array]


def with_curve(model: Model, shape: Shape) -> Model | None:
    """The model with as much of a curve (localisation/unknown_inputs.py) as the records confirm of it.

    Beyond its ends it goes on level. None for a curve over time, for one over a reading of itself, and for a
    model that an integrator of CasADi runs.
    """
    name = shape.signal.split(" [")[0]
    read = _reader(model, name)
    if read is None or (model.exact is not None and model.exact.adaptive):
        return None  # CasADi's integrators take no curve
    model = replace(model, exact=None)
    at, value = np.array(shape.at), shape.confirmed * np.array(shape.value)

    def term(p: Values, x: Array, u: Array) -> Array:
        return np.asarray(np.interp(read(p, x, u), at, value))

    place = model.equations.get(shape.equation)
    if place is not None:
        return replace(model, derivative=_added(model.derivative, place, term))
    outputs = [o.name for o in model.outputs]
    reading = shape.equation.removeprefix("reading of ")
    if reading not in outputs or reading == name:
        return None
    return replace(model, output=_added(model.output, outputs.index(reading), term))


def _added(
    equation: Callable[[Values, Array, Array], Sequence[Array] | Array], place: int, term: Read
) -> Callable[[Values, Array, Array], Sequence[Array]]:
    def extended(p: Values, x: Array, u: Array) -> Sequence[Array]:
        found = list(equation(p, x, u))
        found[place] = found[place] + term(p, x, u)
        return found

    return extended


def _reader(model: Model, name: str) -> Read | None:
    """Of an output, a state or an input by its name: what is simulated goes before what is recorded."""
    states, outputs, inputs = (
        [s.name for s in part] for part in (model.states, model.outputs, model.inputs)
    )
    if name in outputs:
        number = outputs.index(name)
        return lambda p, x, u: np.asarray(model.output(p, x, u)[number])
    if name in states:
        number = states.index(name)
        return lambda p, x, u: x[number]
    if name in inputs:
        number = inputs.index(name)
        return lambda p, x, u: u[number]
    return None
