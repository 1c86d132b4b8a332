"""Whether the records contradict each other: each is explained by itself, but with another value of one parameter.

A regulator that was turned between two runs, loggers started by hand, a gauge that was changed: no single model is
right for all records, and a search that holds all of them against one model finds nothing, or a compromise. So each
record is fitted alone, with the effect that would take most if it were free in each of them. If that explains the
records, and the values differ by far more than their errors, the records do not belong together.

Asked is only for what a hand changes between two runs. A leak or a friction that each record wants of another size is a
law that depends on something else, which is unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import fit, nuisance_of
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted_with_slopes
from sms.diagnosis.selection.identifiability import raw_columns
from sms.diagnosis.thresholds import DIFFERS, DIFFERS_BY, EXPLAINS, TRIED_BY_RECORD
from sms.estimation.least_squares import changed
from sms.estimation.nuisance import Nuisance, project
from sms.estimation.windows import Runs

BETWEEN_RUNS = (
    "supply_setpoint",
    "ambient_pressure",
    "moving_mass",
    "centre_of_gravity",
    "dead_volume",
    "valve_centre_offset",
    "command_delay",
    "controller_mismatch",
    "clock_skew",
    "sensor_gain",
    "sensor_offset",
)
"""Ids of effects whose size may be another in the next run."""


@dataclass(frozen=True)
class Inconsistency:
    """One effect and its parameter's value in each record with its standard error."""

    effect: Effect
    values: dict[str, tuple[float, float]]
    unit: str


def inconsistency(
    baseline: Fitted, data: Data, effects: Sequence[Effect], floor: Array
) -> Inconsistency | None:
    """The effect that each record has with a value of its own; None if there is no such. floor: (channels,)."""
    parts = [(data.identify, baseline), (data.validate, refitted_with_slopes(baseline, data))]
    effects = [e for e in effects if e.id in BETWEEN_RUNS]
    if not effects or sum(len(runs.motions) for runs, _ in parts) < 3:
        return None
    promise = sum(_promises(runs, at, effects) for runs, at in parts)
    noise = sum(float(np.sum(floor[runs.channel])) for runs, _ in parts)
    excess = sum(float(np.sum(at.fit.residual**2)) for _, at in parts) - noise
    for k in np.argsort(-np.asarray(promise))[:TRIED_BY_RECORD]:
        values, left = _each_alone(parts, effects[int(k)])
        if left - noise <= (1.0 - EXPLAINS) * excess and _differ(values, effects[int(k)], data):
            unit = data.rig.table[effects[int(k)].parameters[0]].unit
            return Inconsistency(effects[int(k)], values, unit)
    return None


def _promises(runs: Runs, at: Fitted, effects: Sequence[Effect]) -> Array:
    """(effects,): chi-square that each would take, linearly, free in every record; known parameters likewise."""
    columns = raw_columns(at, runs, effects)
    nuisance = nuisance_of(at)
    taken = np.zeros(len(effects))
    for number in range(len(runs.motions)):
        rows = runs.record == number
        own = Nuisance(nuisance.names, nuisance.jacobian[rows], nuisance.pull, nuisance.off)
        sensitivity = project(own, columns[rows], [e.parameters[0] for e in effects])
        size = np.maximum(np.sum(sensitivity**2, axis=0), 1e-300)
        full = np.concatenate([at.fit.residual[rows], own.departure])
        taken += (sensitivity.T @ full) ** 2 / size
    return taken


def _each_alone(
    parts: Sequence[tuple[Runs, Fitted]], effect: Effect
) -> tuple[dict[str, tuple[float, float]], float]:
    """Value and error in each record, and the chi-square that is left in all of them."""
    values, left = {}, 0.0
    name = effect.parameters[0]
    for runs, at in parts:
        for run in runs.motions:
            alone = replace(runs, motions=(run,))
            hypothesis = at.hypothesis.with_effect(effect)
            found = fit(hypothesis, alone, _start(effect, at))
            values[run.name] = (found.params[name], max(found.standard_error(name), 1e-12))
            left += float(np.sum(found.fit.residual**2))
    return values, left


def _start(effect: Effect, at: Fitted) -> _core.Params:
    """Where there is no slope, from the size at which the sensitivity is taken."""
    if effect.step is None:
        return at.params
    return changed(at.params, [effect.parameters[0]], np.array([effect.step]))


def _differ(values: dict[str, tuple[float, float]], effect: Effect, data: Data) -> bool:
    return differ(list(values.values()), data.rig.declared(effect.parameters[0]).value)


def differ(found: Sequence[tuple[float, float]], declared: float) -> bool:
    """Whether values with standard errors differ by far more than these, and by much of their shift."""
    found = sorted(found)
    (low, low_error), (high, high_error) = found[0], found[-1]
    shift = max(abs(low - declared), abs(high - declared))
    apart = high - low
    return apart > DIFFERS * float(np.hypot(low_error, high_error)) and apart > DIFFERS_BY * shift
