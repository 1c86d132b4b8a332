"""One round of forward selection: every effect of the catalogue tested on top of the present model.

The promising ones are fitted, and judged on the validation records (validation.py); forward_selection.py goes on until
nothing more is found.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import (
    fit,
    nuisance_of,
    residual_of,
    sensitivities,
    without_sensitivities,
)
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.selection.identifiability import raw_columns
from sms.diagnosis.selection.score_test import ScoreTests, score_tests
from sms.estimation.block_statistics import score_test
from sms.estimation.nuisance import project
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.parameters import common_parameter

Key = TypeVar("Key")


@dataclass
class Trial:
    """One effect tried in one round."""

    effect: Effect
    fitted: Fitted
    p_value: float
    squared: Array = field(default_factory=lambda: np.empty(0))
    """(rows,) squared residuals on the validate records, where rivals are compared by them (validation.py)."""
    by_step: float = 0.0
    """By how much the best finite step lowers the logarithms of what is left on an excerpt."""
    gain: float = 0.0
    gain_interval: tuple[float, float] = (0.0, 0.0)
    similarity: dict[str, float] = field(default_factory=dict)
    accepted: bool = False
    reason: str = ""
    support: float = 0.0
    """Share of resamples of the windows or strokes in which it is the best of its round."""
    seen_share: float = 0.0
    """Share of what the model before it leaves beyond the noise that it takes, on identification records."""
    helps: bool = False
    """Whether it takes more than next to nothing where it was fitted (judgement.no_help)."""
    lower: float = 0.0
    """By how much it lowers the sum over windows and signals of the logarithm of what is left."""
    share: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Share of the baseline's error beyond the noise that it takes on validation records; its 95 percent interval."""
    cross_validated: bool = False
    """Whether the validation records are insensitive to it: judged on the fitted ones (cross_validation.py)."""
    by_own_signal: bool = False
    """Whether its shares are of what is left in the signal that its equation gives alone (judgement.py)."""


def try_effects(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> list[Trial]:
    """The effects fitted on top of the current model, with their p-values among all of them."""
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
    nuisance = nuisance_of(current, white=True)
    columns = current.whiten(raw_columns(current, data.identify, effects))
    sensitivity = project(nuisance, columns, [e.parameters[0] for e in effects])
    room = np.array([room_of(e, current.params, data.rig) for e in effects])
    allowed = np.column_stack([room[:, 0] < 0.0, room[:, 1] > 0.0])
    return score_tests(
        sensitivity,
        nuisance,
        current.whiten(current.fit.residual),
        data.identify.block,
        allowed,
        rng,
    )


def room_of(effect: Effect, params: _core.Params, rig: Rig) -> tuple[float, float]:
    """By how much the effect's parameter may still fall (negative), and rise."""
    name = effect.parameters[0]
    low, high = effect.plausible_range(rig.declared(common_parameter(name)).value)
    low, high = max(low, rig.table[name].lower), min(high, rig.table[name].upper)
    return low - params[name], high - params[name]


def moved(effect: Effect, params: _core.Params, change: float, rig: Rig) -> float:
    """The effect's parameter so much larger, within its bounds whatever the sum is rounded to."""
    name = effect.parameters[0]
    return float(np.clip(params[name] + change, rig.table[name].lower, rig.table[name].upper))


def converged(fitted: Fitted, data: Data) -> Fitted:
    """A candidate's fit, carried on to its end with all sensitivities its own."""
    return fit(
        fitted.hypothesis,
        data.identify,
        fitted.params,
        nearby=fitted.slopes,
        discrepancy=data.allowed(data.identify),
    )


def leaders_settled(
    fits: Mapping[Key, Fitted],
    left_by: Callable[[Fitted], float],
    alike: Callable[[Key, Key], bool],
    data: Data,
) -> dict[Key, Fitted]:
    """Candidates are fitted with few Jacobians, most of whose columns are those of the model before. Whichever leaves
    least is carried on to its end, and with it those that are alike to it, until that one has been: an effect far from
    where the model stood bends the sensitivities of all else, and is not judged half way, nor are its rivals.
    """
    settled, rough = dict(fits), set(fits)
    while settled:
        best = min(settled, key=lambda k: left_by(settled[k]))
        near = [k for k in settled if k in rough and (k == best or alike(best, k))]
        if not near:
            break
        for k in near:
            rough.remove(k)
            settled[k] = without_sensitivities(converged(settled[k], data))
    return settled


def _unit(columns: Array) -> Array:
    return np.asarray(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300))


def _unit_columns(current: Fitted, comparison: Runs, names: list[str]) -> Array:
    return _unit(np.column_stack([sensitivities(current, comparison, [n])[:, 0] for n in names]))
