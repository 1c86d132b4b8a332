"""Which effects these records can show at all, and why not the others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.effects.sensitivity import sensitivity_columns
from sms.diagnosis.fitting import nuisance_of, sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.result import NotTestable
from sms.diagnosis.selection.excitation import missing_excitation
from sms.diagnosis.thresholds import DETECTION
from sms.estimation.block_statistics import covariance_of
from sms.estimation.nuisance import project
from sms.estimation.windows import Runs
from sms.parameters import common_parameter
from sms.units_display import format_quantity


def identifiable(
    fitted: Fitted, data: Data, effects: Sequence[Effect]
) -> tuple[list[Effect], list[NotTestable]]:
    """The effects that the identify records can show, and why they cannot show the others."""
    possible: list[Effect] = []
    blind: list[NotTestable] = []
    for effect in effects:
        reason = _why_not_asked(effect, data)
        if reason:
            blind.append(NotTestable(effect.id, effect.signal, reason))
        else:
            possible.append(effect)
    raw = raw_columns(fitted, data.identify, possible)
    reduced = _reduced_columns(fitted, data.identify, possible, raw)
    seen: list[Effect] = []
    for k, effect in enumerate(possible):
        reason = _why_blind(effect, fitted, data, raw[:, k], reduced[:, k])
        if reason:
            blind.append(NotTestable(effect.id, effect.signal, reason))
        else:
            seen.append(effect)
    return seen, blind


def raw_columns(fitted: Fitted, comparison: Runs, effects: Sequence[Effect]) -> Array:
    """(rows, effects): change of the residual with each effect, on the records that were fitted; worked out once."""
    new = [e for e in effects if e.key not in fitted.columns]
    table = fitted.hypothesis.table
    columns = sensitivity_columns(
        comparison.problem, fitted.params, fitted.fit.residual, new, table
    )
    fitted.columns.update({e.key: columns[:, k] for k, e in enumerate(new)})
    return np.column_stack([fitted.columns[e.key] for e in effects])


def _reduced_columns(
    fitted: Fitted, comparison: Runs, effects: Sequence[Effect], raw: Array
) -> Array:
    """(rows, effects): less what the free parameters can undo."""
    names = [e.parameters[0] for e in effects]
    if comparison.whitened:
        return project(nuisance_of(fitted), raw, names)[: len(raw)]
    return np.column_stack([sensitivities(fitted, comparison, [n])[:, 0] for n in names])


def _why_not_asked(effect: Effect, data: Data) -> str:
    signals = data.identify.motions[0].signals
    if reason := effect.not_measured(signals):
        return reason
    if all(data.rig.declared(n).fit for n in effect.parameters):
        return "declared as unknown and fitted anyway: its value is part of the baseline"
    return ""


def _why_blind(effect: Effect, fitted: Fitted, data: Data, raw: Array, column: Array) -> str:
    if not np.all(np.isfinite(raw)):
        return "with it the simulation breaks down on these records"
    if not np.any(raw):
        return "it leaves no trace in the signals of this rig"
    if effect.needs:
        stroke = data.rig.declared("stroke").value
        reason = missing_excitation(effect.needs, data.identify, stroke)
        if reason:
            return reason
    if np.linalg.norm(column) < 1e-6 * np.linalg.norm(raw):
        return (
            "all it would leave is undone by parameters that are fitted, or that may move this far within "
            "their declared uncertainty"
        )
    name = effect.parameters[0]
    low, high = effect.plausible_change(data.rig.declared(common_parameter(name)).value)
    if data.identify.whitened:  # the residual still holds what the effect itself may have left
        error = 1.0 / float(np.linalg.norm(column))
    else:
        covariance = covariance_of(column[:, None], fitted.fit.residual, data.identify.block)
        error = float(np.sqrt(covariance[0, 0]))
    if error * DETECTION > max(abs(low), abs(high)):
        least = format_quantity(DETECTION * error, data.rig.table[name].unit, name)
        return f"these records would show it from {least} on only, more than is plausible"
    return ""
