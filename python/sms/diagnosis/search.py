"""The search for causes, round by round: fit, screen, judge on unseen records, merge what looks alike.

A model at one moment is a `Hypothesis`: the baseline's free parameters, each within its declared uncertainty
or its bounds, and the causes found so far. A round tries every effect of the catalogue on top of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from sms import _core
from sms.diagnosis.catalogue import Effect
from sms.diagnosis.excitation import missing_excitation
from sms.diagnosis.prepare import Comparison
from sms.diagnosis.result import Array, NotTestable
from sms.diagnosis.statistics import (
    covariance_of,
    interval,
    project_off,
    resampled,
    score_test,
    weighted_ms,
)
from sms.io.rig import Rig
from sms.parameters import PARAMETERS
from sms.units_display import format_quantity

SIGNIFICANT = 0.01
"""Largest chance, over all candidates of a round together, of naming one on data without any effect."""
WORTH = 0.01
"""Least share of the original squared error beyond the noise floor that a cause must take on unseen records."""
WORTH_OF_NOISE = 0.02
"""The same, as a share of the noise floor itself: a healthy machine has hardly any error beyond it."""
ALIKE = 0.95
"""Cosine of two footprints in the data above which two effects cannot be told apart."""
DETECTION = 3.0
"""Standard errors at which an effect counts as seen."""


@dataclass(frozen=True)
class Hypothesis:
    """Which parameters may move, and how far: name -> (lower, upper). `start` has every other one.

    A parameter in `known` (name -> declared uncertainty) is pulled to its declared value as by one sample.
    """

    start: _core.Params
    free: dict[str, tuple[float, float]]
    known: dict[str, float]
    causes: tuple[Effect, ...] = ()

    def with_effect(self, effect: Effect) -> Hypothesis:
        """The effect's parameters freed within the bounds of params.def."""
        wide = {
            name: (PARAMETERS[name].lower, PARAMETERS[name].upper) for name in effect.parameters
        }
        known = {name: u for name, u in self.known.items() if name not in wide}
        return replace(self, free=self.free | wide, known=known, causes=(*self.causes, effect))


@dataclass(frozen=True)
class Fitted:
    """A hypothesis fitted to the identify records."""

    hypothesis: Hypothesis
    fit: _core.Fit
    covariance: Array
    """(free, free), robust to correlation within blocks; zero rows for a parameter at its bound."""

    @property
    def params(self) -> _core.Params:
        return self.fit.params

    def standard_error(self, name: str) -> float:
        k = list(self.hypothesis.free).index(name)
        return float(np.sqrt(max(self.covariance[k, k], 0.0)))

    @property
    def movable(self) -> list[str]:
        """Free parameters that are not held by a bound."""
        return [
            n for n, held in zip(self.hypothesis.free, self.fit.at_bound, strict=True) if not held
        ]


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


@dataclass(frozen=True)
class Data:
    """The records of a rig, by role."""

    rig: Rig
    identify: Comparison
    validate: Comparison


# ---- fits --------------------------------------------------------------------------------------------------


def baseline_hypothesis(data: Data, effects: Sequence[Effect]) -> Hypothesis:
    """Parameters as declared; free are those to be fitted, and those that have a declared uncertainty.

    A free parameter that leaves no trace in the identify records stays where it is.
    """
    rig = data.rig
    start = _core.Params(**{name: declared.value for name, declared in rig.parameters.items()})
    names = [n for n, d in rig.parameters.items() if d.fit]
    known = [n for e in effects for n in e.parameters if n not in names]
    free: dict[str, tuple[float, float]] = {}
    uncertain: dict[str, float] = {}
    for name in dict.fromkeys(names + known):
        declared, bounds = rig.declared(name), PARAMETERS[name]
        if declared.fit:
            free[name] = (bounds.lower, bounds.upper)
        elif declared.uncertainty > 0.0:
            uncertain[name] = declared.uncertainty
            free[name] = (
                max(bounds.lower, declared.value - declared.uncertainty),
                min(bounds.upper, declared.value + declared.uncertainty),
            )
    _, jacobian = data.identify.problem.evaluate(start, list(free))
    seen = np.linalg.norm(jacobian, axis=0) > 0.0
    return Hypothesis(
        start, {n: b for n, b, s in zip(free, free.values(), seen, strict=True) if s}, uncertain
    )


def fit(hypothesis: Hypothesis, comparison: Comparison) -> Fitted:
    """Least squares over the hypothesis' free parameters, with block-robust covariance."""
    before, _ = comparison.problem.evaluate(hypothesis.start)
    sample = float(np.sqrt(np.mean(before**2)))
    free = [
        (name, *bounds, sample / hypothesis.known[name] if name in hypothesis.known else 0.0)
        for name, bounds in hypothesis.free.items()
    ]
    result = _core.fit(comparison.problem, hypothesis.start, free)
    covariance = np.zeros((len(free), len(free)))
    moved = np.flatnonzero(~np.array(result.at_bound, dtype=bool))
    if len(moved):
        covariance[np.ix_(moved, moved)] = covariance_of(
            result.jacobian[:, moved], result.residual, comparison.block
        )
    return Fitted(hypothesis, result, covariance)


def residual_of(comparison: Comparison, params: _core.Params) -> Array:
    residual, _ = comparison.problem.evaluate(params)
    return np.asarray(residual)


def footprints(fitted: Fitted, comparison: Comparison, names: list[str]) -> Array:
    """(rows, names): how the residual changes with each parameter, beyond what the free ones can undo."""
    nuisance = [n for n in fitted.movable if n not in names]
    _, jacobian = comparison.problem.evaluate(fitted.params, nuisance + names)
    return project_off(jacobian[:, len(nuisance) :], jacobian[:, : len(nuisance)])


# ---- which effects can be seen at all ------------------------------------------------------------------------


def testable(
    fitted: Fitted, data: Data, effects: Sequence[Effect]
) -> tuple[list[Effect], list[NotTestable]]:
    """The effects that the identify records can show, and why they cannot show the others."""
    seen: list[Effect] = []
    blind: list[NotTestable] = []
    stroke = data.rig.declared("stroke").value
    for effect in effects:
        reason = _why_blind(effect, fitted, data, stroke)
        if reason:
            blind.append(NotTestable(effect.id, effect.signal, reason))
        else:
            seen.append(effect)
    return seen, blind


def _why_blind(effect: Effect, fitted: Fitted, data: Data, stroke: float) -> str:
    signals = data.identify.motions[0].signals
    if effect.signal is not None and effect.signal not in signals:
        return f"{effect.signal} is not measured"
    if all(data.rig.declared(n).fit for n in effect.parameters):
        return "declared as unknown and fitted anyway: its value is part of the baseline"
    names = list(effect.parameters)
    _, jacobian = data.identify.problem.evaluate(fitted.params, names)
    raw = np.linalg.norm(jacobian, axis=0)
    if np.all(raw == 0.0):
        return "it leaves no trace in the signals of this rig"
    reason = missing_excitation(effect.needs, data.identify, stroke)
    if reason:
        return reason
    column = footprints(fitted, data.identify, names)
    if np.all(np.linalg.norm(column, axis=0) < 1e-6 * raw):
        return (
            "all it would leave is undone by parameters that are fitted, or that may move this far within "
            "their declared uncertainty"
        )
    low, high = effect.plausible_range(data.rig.declared(names[0]).value)
    error = np.sqrt(covariance_of(column, fitted.fit.residual, data.identify.block)[0, 0])
    if error * DETECTION > max(abs(low), abs(high)):
        least = format_quantity(DETECTION * error, PARAMETERS[names[0]].unit, names[0])
        return f"these records would show it from {least} on only, more than is plausible"
    return ""


# ---- one round -----------------------------------------------------------------------------------------------


def try_effects(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> list[Trial]:
    """Every effect fitted on top of the current model, with its p-value among all of them."""
    names = [e.parameters[0] for e in effects]
    columns = np.column_stack([footprints(current, data.identify, [n])[:, 0] for n in names])
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


def _unit(columns: Array) -> Array:
    return np.asarray(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300))


def _unit_columns(current: Fitted, comparison: Comparison, names: list[str]) -> Array:
    return _unit(np.column_stack([footprints(current, comparison, [n])[:, 0] for n in names]))


@dataclass(frozen=True)
class Yardstick:
    """What a gain on the validate records is measured against. Mean squares."""

    original: float
    """Of the baseline, before any cause was found."""
    floor: float
    """Of what does not repeat from stroke to stroke."""

    @property
    def least_worth(self) -> float:
        return max(WORTH * max(self.original - self.floor, 0.0), WORTH_OF_NOISE * self.floor)


def judge(
    trials: Sequence[Trial],
    current: Fitted,
    data: Data,
    yardstick: Yardstick,
    rng: np.random.Generator,
) -> None:
    """Each trial's gain on the validate records and whether it can be a cause; fills gain, accepted, reason."""
    before = residual_of(data.validate, current.params) ** 2
    block = data.validate.block
    counts = resampled(data.validate.record, block, rng)
    total = float(np.mean(before))
    resampled_before = weighted_ms(before, block, counts)
    for trial in trials:
        after = weighted_ms(trial.squared, block, counts)
        trial.gain = 1.0 - float(np.mean(trial.squared)) / total
        trial.gain_interval = interval(1.0 - after / resampled_before)
        trial.reason = _objection(trial, before, data, yardstick)
        trial.accepted = not trial.reason


def _objection(trial: Trial, before: Array, data: Data, yardstick: Yardstick) -> str:
    """Why the trial is no cause; empty if there is nothing against it."""
    name = trial.effect.parameters[0]
    value = trial.fitted.params[name]
    low, high = trial.effect.plausible_range(data.rig.declared(name).value)
    if trial.p_value > SIGNIFICANT:
        return f"may be chance (p = {trial.p_value:.2g} among all that were tried)"
    if not low <= value <= high:
        return f"fits only with {format_quantity(value, PARAMETERS[name].unit, name)}, which is not plausible"
    if trial.gain_interval[0] <= 0.0:
        return "does not help on the records it has not seen"
    worth = float(np.mean(before) - np.mean(trial.squared))
    if worth < yardstick.least_worth:
        return "real, but worth next to nothing on the records it has not seen"
    for number, motion in enumerate(data.validate.motions):
        rows = data.validate.record == number
        if float(np.mean(trial.squared[rows]) - np.mean(before[rows])) > worth:
            return f"makes '{motion.name}' worse by more than it gains elsewhere"
    return ""


def best_class(trials: Sequence[Trial], data: Data, rng: np.random.Generator) -> list[Trial]:
    """The best accepted trial and those that the data cannot tell from it, in the catalogue's order; or none.

    Alike are two effects whose footprints are nearly parallel, or whose unseen records come out equally well
    although each explains nine tenths of what the other does.
    """
    accepted = [t for t in trials if t.accepted]
    if not accepted:
        return []
    best = max(accepted, key=lambda t: t.gain)
    counts = resampled(data.validate.record, data.validate.block, rng)
    members = []
    for trial in accepted:
        difference = weighted_ms(trial.squared - best.squared, data.validate.block, counts)
        as_good = interval(difference)[0] <= 0.0 and trial.gain >= 0.9 * best.gain
        if best.similarity[trial.effect.key] > ALIKE or as_good:
            members.append(trial)
    return members
