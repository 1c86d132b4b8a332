"""Sensitivity of the residual to an effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.estimation.least_squares import changed
from sms.estimation.problem import Problem
from sms.parameters import Parameter


def sensitivity_columns(
    problem: Problem,
    params: _core.Params,
    residual: Array,
    effects: Sequence[Effect],
    table: Mapping[str, Parameter],
) -> Array:
    """(rows, m): change of the residual with the first parameter of each effect; by a step where it has no slope."""
    smooth = [e.parameters[0] for e in effects if e.step is None]
    jacobian = problem.evaluate(params, smooth)[1] if smooth else np.empty((len(residual), 0))
    columns = np.empty((len(residual), len(effects)))
    place = 0
    for i, effect in enumerate(effects):
        if effect.step is None:
            columns[:, i] = jacobian[:, place]
            place += 1
            continue
        name = effect.parameters[0]
        step = effect.step if params[name] == table[name].default else 0.02 * params[name]
        step = -step if params[name] + step > table[name].upper else step
        there, _ = problem.evaluate(changed(params, [name], np.array([params[name] + step])))
        columns[:, i] = (there - residual) / step
    return columns
