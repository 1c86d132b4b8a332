"""Friction over velocity: what a record measured, and what a law says of it."""

from __future__ import annotations

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.cylinder import friction as friction_force
from sms.identification.friction_fit import LawFit, problem_of
from sms.rigs.cylinder import Motion


def friction_map(motion: Motion, params: _core.Params) -> Array:
    """The measured friction of one record, N, (n,): what eq. 6.4 leaves over."""
    problem, _ = problem_of([motion], "acceleration_dependent")
    missed, _ = problem.evaluate(params)
    return np.asarray(missed + modelled(motion, params))


def modelled(motion: Motion, params: _core.Params) -> Array:
    """Eq. 6.5 over the record's motion, N, (n,)."""
    ambient = params.ambient_pressure

    def absolute(name: str) -> Array:
        signal = motion.signals.get(name, np.full(motion.time.size, ambient))
        return np.asarray(signal + (ambient if name in motion.gauge else 0.0))

    return friction_force(
        motion.velocity,
        motion.acceleration,
        motion.signals["extension"],
        absolute("chamber_pressure_lower"),
        absolute("chamber_pressure_upper"),
        params,
    )


def law_over_record(motion: Motion, fit: LawFit, measured: Array, params: _core.Params) -> Array:
    """What a law says of the record's friction, N, (n,); `measured` is its friction_map at params."""
    problem, _ = problem_of([motion], fit.law)
    missed, _ = problem.evaluate(fit.found.params)
    reference, _ = problem_of([motion], "acceleration_dependent")[0].evaluate(params)
    return np.asarray(measured - missed + (reference - (measured - modelled(motion, params))))
