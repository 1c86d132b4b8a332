"""One round of forward selection: every effect of the catalogue tested on top of the present model.

The promising ones are fitted, and judged on the validation records (validation.py); forward_selection.py goes on until
nothing more is found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import (
    Data,
    Fitted,
    fit,
    nuisance_of,
    residual_of,
    sensitivities,
    unseen,
)
from sms.diagnosis.selection import multistart
from sms.diagnosis.selection.identifiability import raw_columns
from sms.diagnosis.selection.score_test import ScoreTests, score_tests
from sms.diagnosis.thresholds import ALIKE, FAR, MOST_FITS, SIGNIFICANT, WORTH_A_FIT, WORTH_A_LOOK
from sms.estimation.block_statistics import score_test
from sms.estimation.least_squares import changed
from sms.estimation.nuisance import project
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.parameters import common_parameter


@dataclass
class Trial:
    """One effect tried in one round."""

    effect: Effect
    fitted: Fitted
    p_value: float
    squared: Array
    """(rows,) squared residuals on the validate records."""
    gain: float = 0.0
    gain_interval: tuple[float, float] = (0.0, 0.0)
    similarity: dict[str, float] = field(default_factory=dict)
    accepted: bool = False
    reason: str = ""
    identified: Array = field(default_factory=lambda: np.empty(0))
    """(rows,) squared residuals on the identify records, where both count in the comparison of rivals."""
    support: float = 0.0
    """Share of resamples of the windows or strokes in which it is the best of its round."""
    seen_share: float = 0.0
    """Share of what the model before it leaves beyond the noise, on the records it was fitted to; `gain` on the others."""
    lower: float = 0.0
    """By how much it lowers the sum over windows and signals of the logarithm of what is left."""
    share: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Share of the baseline's error beyond the noise that it takes on validation records, and its 95 percent interval."""
    cross_validated: bool = False
    """Whether the validation records are insensitive to it: judged on the fitted ones (cross_validation.py)."""


def try_effects(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> list[Trial]:
    """The effects fitted on top of the current model, with their p-values among all of them."""
    if data.identify.whitened:
        return _try_on_runs(current, data, effects, rng)
    names = [e.parameters[0] for e in effects]
    columns = np.column_stack([sensitivities(current, data.identify, [n])[:, 0] for n in names])
    scores = score_test(columns, current.fit.residual, data.identify.block, rng)
    trials = []
    for effect, p_value in zip(effects, scores.p_value, strict=True):
        fitted = fit(current.hypothesis.with_effect(effect), data.identify)
        squared = residual_of(data.validate, fitted.params) ** 2
        trials.append(Trial(effect, fitted, float(p_value), squared))
    both = np.vstack([_unit(columns), _unit_columns(current, data.validate, names)])
    cosine = np.abs(both.T @ both) / 2.0
    for i, trial in enumerate(trials):
        trial.similarity = {e.key: float(cosine[i, j]) for j, e in enumerate(effects)}
    return trials


def score_effects(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> ScoreTests:
    """The tests of all effects on top of the current model, each by one linear step."""
    nuisance = nuisance_of(current)
    columns = raw_columns(current, data.identify, effects)
    sensitivity = project(nuisance, columns, [e.parameters[0] for e in effects])
    room = np.array([room_of(e, current, data.rig) for e in effects])
    allowed = np.column_stack([room[:, 0] < 0.0, room[:, 1] > 0.0])
    return score_tests(
        sensitivity, nuisance, current.fit.residual, data.identify.block, allowed, rng
    )


def room_of(effect: Effect, current: Fitted, rig: Rig) -> tuple[float, float]:
    """By how much the effect's parameter may still fall (negative), and rise."""
    name = effect.parameters[0]
    low, high = effect.plausible_range(rig.declared(common_parameter(name)).value)
    low, high = max(low, rig.table[name].lower), min(high, rig.table[name].upper)
    return low - current.params[name], high - current.params[name]


def _try_on_runs(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> list[Trial]:
    """All effects are screened; those that speak loudest are fitted in full."""
    found = score_effects(current, data, effects, rng)
    room = np.array([room_of(e, current, data.rig) for e in effects])
    promise = found.promise(np.minimum(room[:, 0], 0.0), np.maximum(room[:, 1], 0.0))
    before = unseen(current, data) ** 2
    here = float(np.sum(current.fit.residual**2))
    share = WORTH_A_FIT * min(1.0, FAR * len(current.fit.residual) / max(here, 1e-300))
    promising = [
        int(k)
        for k in np.argsort(-promise)[:MOST_FITS]
        if found.p_value[k] <= SIGNIFICANT and promise[k] > share * promise.max()
    ]
    # What a step promises may be little where the way is long, as from a volume ten times too large; and of an effect
    # without a slope it is what the effect takes with its other parameters as they stand.
    promising += [
        k
        for k, effect in enumerate(effects)
        if k not in promising
        and found.p_value[k] <= SIGNIFICANT
        and (
            any(found.cosine[k, other] > ALIKE for other in promising[:1])
            or (effect.step is not None and len(effect.parameters) > 1)
        )
    ]
    fits = {
        k: fit(
            current.hypothesis.with_effect(effects[k]),
            data.identify,
            _first_guess(effects[k], current, found, k),
        )
        for k in promising
    }
    p_values = found.p_value.copy()
    if multistart.much_is_left(current, fits.values(), data.identify):
        for k in multistart.may_be_elsewhere(effects, promise):
            if k not in fits:
                guess = _first_guess(effects[k], current, found, k)
                fits[k] = multistart.multistart_fit(effects[k], current, data, guess)
                chance = multistart.chance(current, fits[k], data.identify, len(effects))
                p_values[k] = min(p_values[k], chance)
    taken = {k: here - float(np.sum(f.fit.residual**2)) for k, f in fits.items()}
    cosine = found.cosine
    trials = []
    for k, effect in enumerate(effects):
        p_value = float(p_values[k])
        trial = Trial(effect, current, p_value, before, identified=current.fit.residual**2)
        if k in fits and taken[k] >= WORTH_A_LOOK * max(taken.values()):
            fitted = fits[k]
            squared = unseen(fitted, data) ** 2
            trial = Trial(effect, fitted, p_value, squared, identified=fitted.fit.residual**2)
        elif p_value <= SIGNIFICANT:
            trial.reason = "explains much less than the best effect of this round"
        trial.similarity = {e.key: float(cosine[k, j]) for j, e in enumerate(effects)}
        trials.append(trial)
    return trials


def _first_guess(effect: Effect, current: Fitted, found: ScoreTests, k: int) -> _core.Params:
    """Where a fit begins: at the current model, or where there is no slope at a first estimate."""
    name = effect.parameters[0]
    if effect.step is None:
        return current.params
    upper = current.hypothesis.table[name].upper
    least = max(0.1 * effect.step, effect.plausible[0] if effect.kind == "missing" else 0.0)
    size = float(np.clip(current.params[name] + found.estimate[k], least, upper))
    return changed(current.params, [name], np.array([size]))


def _unit(columns: Array) -> Array:
    return np.asarray(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300))


def _unit_columns(current: Fitted, comparison: Runs, names: list[str]) -> Array:
    return _unit(np.column_stack([sensitivities(current, comparison, [n])[:, 0] for n in names]))
