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
from sms.diagnosis.gauss_newton import Free, Solution, changed, fit_windows
from sms.diagnosis.prepare import Comparison
from sms.diagnosis.result import Array, NotTestable
from sms.diagnosis.runs import Runs
from sms.diagnosis.screening import Nuisance, Screen, columns_of, project, screen
from sms.diagnosis.statistics import (
    covariance_of,
    interval,
    project_off,
    resampled,
    score_test,
    sum_by,
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
ALWAYS_UNCERTAIN = ("stiction_shape",)
"""Parameters that a simulation may move although no rig file mentions them: their uncertainty is that of params.def."""
MOST_FITS = 5
"""Effects of a round that are fitted in full, where a fit is a simulation of every record."""
WORTH_A_FIT = 0.3
"""Of the chi-square that the most promising effect would take: what an effect must promise to be fitted."""
WORTH_A_LOOK = 0.5
"""Of the chi-square that the best fit takes: what a fit must take to be judged on unseen records."""


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
    fit: Solution
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
    identified: Array = field(default_factory=lambda: np.empty(0))
    """(rows,) squared residuals on the identify records, where both count in the comparison of rivals."""


@dataclass(frozen=True)
class Data:
    """The records of a rig, by role."""

    rig: Rig
    identify: Comparison | Runs
    validate: Comparison | Runs
    unseen_of: dict[int, tuple[Fitted, Fitted]] = field(default_factory=dict, repr=False)
    """What `unseen` has worked out already."""


# ---- fits --------------------------------------------------------------------------------------------------


def baseline_hypothesis(data: Data, effects: Sequence[Effect]) -> Hypothesis:
    """Parameters as declared; free are those to be fitted, and those that have a declared uncertainty.

    A free parameter that leaves no trace in the identify records stays where it is.
    """
    rig = data.rig
    start = _core.Params(**{name: declared.value for name, declared in rig.parameters.items()})
    names = [n for n, d in rig.parameters.items() if d.fit]
    known = [n for e in effects for n in e.parameters if n not in names]
    if (
        data.identify.whitened
    ):  # a simulation feels every parameter, not only those that are effects
        known += [n for n, d in rig.parameters.items() if d.uncertainty > 0.0 and not d.fit]
        known += [n for n in ALWAYS_UNCERTAIN if n not in rig.parameters]
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


def fit(
    hypothesis: Hypothesis, comparison: Comparison | Runs, initial: _core.Params | None = None
) -> Fitted:
    """Least squares over the hypothesis' free parameters, with block-robust covariance."""
    if isinstance(comparison, Runs):
        return _fit_runs(hypothesis, comparison, initial or hypothesis.start)
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


def _fit_runs(hypothesis: Hypothesis, runs: Runs, initial: _core.Params) -> Fitted:
    start = hypothesis.start
    free = [
        Free(n, low, high, 1.0 / hypothesis.known[n] if n in hypothesis.known else 0.0, start[n])
        for n, (low, high) in hypothesis.free.items()
    ]
    found = fit_windows(runs.problem, initial, free)
    pull = np.array([f.pull for f in free])
    bread = np.linalg.pinv(found.jacobian.T @ found.jacobian + np.diag(pull**2), hermitian=True)
    noise = max(float(np.mean(found.residual**2)), 1e-12)
    robust = covariance_of(found.jacobian, found.residual, runs.block) if free else bread
    # With more parameters than windows the robust one has too low a rank: the larger of the two variances holds.
    inflate = np.sqrt(np.maximum(np.diag(robust) / np.maximum(np.diag(noise * bread), 1e-300), 1.0))
    inflate = np.minimum(inflate, 10.0)
    covariance = noise * bread * np.outer(inflate, inflate)
    for k, held in enumerate(found.at_bound):
        if held:
            covariance[k, :] = covariance[:, k] = 0.0
    return Fitted(hypothesis, found, covariance)


def residual_of(comparison: Comparison | Runs, params: _core.Params) -> Array:
    residual, _ = comparison.problem.evaluate(params)
    return np.asarray(residual)


def unseen(fitted: Fitted, data: Data) -> Array:
    """(rows,) residuals on the validate records.

    Where a simulation is held against them, the known parameters may move within their declared uncertainty on these
    records too (another day, another temperature); what was found on the identify records stays.
    """
    return (
        refitted(fitted, data).fit.residual
        if data.validate.whitened
        else residual_of(data.validate, fitted.params)
    )


def refitted(fitted: Fitted, data: Data) -> Fitted:
    """The model on the validate records, its causes held."""
    if id(fitted) not in data.unseen_of:
        h = fitted.hypothesis
        held = {n for cause in h.causes for n in cause.parameters}
        free = {n: bounds for n, bounds in h.free.items() if n not in held}
        start = changed(h.start, list(held), np.array([fitted.params[n] for n in held]))
        known = {n: u for n, u in h.known.items() if n not in held}
        there = fit(Hypothesis(start, free, known, h.causes), data.validate, fitted.params)
        data.unseen_of[id(fitted)] = (fitted, there)
    return data.unseen_of[id(fitted)][1]


def footprints(fitted: Fitted, comparison: Comparison | Runs, names: list[str]) -> Array:
    """(rows, names): how the residual changes with each parameter, beyond what the free ones can undo."""
    nuisance = [n for n in fitted.movable if n not in names]
    _, jacobian = comparison.problem.evaluate(fitted.params, nuisance + names)
    return project_off(jacobian[:, len(nuisance) :], jacobian[:, : len(nuisance)])


# ---- which effects can be seen at all ------------------------------------------------------------------------


def testable(
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
    raw = _raw_columns(fitted, data.identify, possible)
    reduced = _reduced_columns(fitted, data.identify, possible, raw)
    seen: list[Effect] = []
    for k, effect in enumerate(possible):
        reason = _why_blind(effect, fitted, data, raw[:, k], reduced[:, k])
        if reason:
            blind.append(NotTestable(effect.id, effect.signal, reason))
        else:
            seen.append(effect)
    return seen, blind


def _raw_columns(fitted: Fitted, comparison: Comparison | Runs, effects: Sequence[Effect]) -> Array:
    return columns_of(comparison.problem, fitted.params, fitted.fit.residual, effects)


def _reduced_columns(
    fitted: Fitted, comparison: Comparison | Runs, effects: Sequence[Effect], raw: Array
) -> Array:
    """(rows, effects): less what the free parameters can undo."""
    names = [e.parameters[0] for e in effects]
    if isinstance(comparison, Runs):
        return project(nuisance_of(fitted), raw, names)[: len(raw)]
    return np.column_stack([footprints(fitted, comparison, [n])[:, 0] for n in names])


def nuisance_of(fitted: Fitted) -> Nuisance:
    """The free parameters that are not held by a bound, at the solution."""
    h = fitted.hypothesis
    movable = fitted.movable
    place = [list(h.free).index(n) for n in movable]
    return Nuisance(
        movable,
        fitted.fit.jacobian[:, place],
        np.array([1.0 / h.known[n] if n in h.known else 0.0 for n in movable]),
        np.array([fitted.params[n] - h.start[n] for n in movable]),
    )


def _why_not_asked(effect: Effect, data: Data) -> str:
    signals = data.identify.motions[0].signals
    of_sensor = effect.of_sensor or (effect.signal is not None and not data.identify.whitened)
    if of_sensor and effect.signal not in signals:
        return f"{effect.signal} is not measured"
    if all(data.rig.declared(n).fit for n in effect.parameters):
        return "declared as unknown and fitted anyway: its value is part of the baseline"
    return ""


def _why_blind(effect: Effect, fitted: Fitted, data: Data, raw: Array, column: Array) -> str:
    if not np.any(raw):
        return "it leaves no trace in the signals of this rig"
    reason = missing_excitation(effect.needs, data.identify, data.rig.declared("stroke").value)
    if reason:
        return reason
    if np.linalg.norm(column) < 1e-6 * np.linalg.norm(raw):
        return (
            "all it would leave is undone by parameters that are fitted, or that may move this far within "
            "their declared uncertainty"
        )
    name = effect.parameters[0]
    low, high = effect.plausible_range(data.rig.declared(name).value)
    covariance = covariance_of(column[:, None], fitted.fit.residual, data.identify.block)
    error = float(np.sqrt(covariance[0, 0]))
    if (
        data.identify.whitened
    ):  # the residual still holds what the effect itself may have left there
        error = 1.0 / float(np.linalg.norm(column))
    if error * DETECTION > max(abs(low), abs(high)):
        least = format_quantity(DETECTION * error, PARAMETERS[name].unit, name)
        return f"these records would show it from {least} on only, more than is plausible"
    return ""


# ---- one round -----------------------------------------------------------------------------------------------


def try_effects(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> list[Trial]:
    """The effects fitted on top of the current model, with their p-values among all of them."""
    if isinstance(data.identify, Runs):
        return _try_on_runs(current, data, effects, rng)
    assert isinstance(data.validate, Comparison)
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


def screen_effects(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> Screen:
    """The tests of all effects on top of the current model, each by one linear step."""
    nuisance = nuisance_of(current)
    columns = _raw_columns(current, data.identify, effects)
    footprint = project(nuisance, columns, [e.parameters[0] for e in effects])
    allowed = np.array([_allowed_signs(e, current, data.rig) for e in effects])
    return screen(footprint, nuisance, current.fit.residual, data.identify.block, allowed, rng)


def _allowed_signs(effect: Effect, current: Fitted, rig: Rig) -> tuple[bool, bool]:
    """Whether the effect's parameter may still fall, and rise."""
    name = effect.parameters[0]
    low, high = effect.plausible_range(rig.declared(name).value)
    low, high = max(low, PARAMETERS[name].lower), min(high, PARAMETERS[name].upper)
    return current.params[name] > low, current.params[name] < high


def _try_on_runs(
    current: Fitted, data: Data, effects: Sequence[Effect], rng: np.random.Generator
) -> list[Trial]:
    """All effects are screened; those that speak loudest are fitted in full."""
    found = screen_effects(current, data, effects, rng)
    before = unseen(current, data) ** 2
    promising = [
        int(k)
        for k in np.argsort(-found.gain)[:MOST_FITS]
        if found.p_value[k] <= SIGNIFICANT and found.gain[k] > WORTH_A_FIT * found.gain.max()
    ]
    fits = {
        k: fit(
            current.hypothesis.with_effect(effects[k]),
            data.identify,
            _first_guess(effects[k], current, found, k),
        )
        for k in promising
    }
    here = float(np.sum(current.fit.residual**2))
    taken = {k: here - float(np.sum(f.fit.residual**2)) for k, f in fits.items()}
    cosine = found.cosine
    trials = []
    for k, effect in enumerate(effects):
        p_value = float(found.p_value[k])
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


def _first_guess(effect: Effect, current: Fitted, found: Screen, k: int) -> _core.Params:
    """Where a fit begins: at the current model, or where there is no slope at a first estimate."""
    name = effect.parameters[0]
    if effect.step is None:
        return current.params
    size = float(
        np.clip(current.params[name] + found.estimate[k], 0.1 * effect.step, PARAMETERS[name].upper)
    )
    return changed(current.params, [name], np.array([size]))


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
    before = unseen(current, data) ** 2
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
    if trial.reason:
        return trial.reason
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
    for number, name_ in enumerate(m.name for m in data.validate.motions):
        rows = data.validate.record == number
        if float(np.mean(trial.squared[rows]) - np.mean(before[rows])) > worth:
            return f"makes '{name_}' worse by more than it gains elsewhere"
    return ""


def best_class(trials: Sequence[Trial], data: Data, rng: np.random.Generator) -> list[Trial]:
    """The best accepted trial and those that the data cannot tell from it, in the catalogue's order; or none.

    Alike are two effects whose footprints are nearly parallel, or whose unseen records come out equally well
    although each explains nine tenths of what the other does.
    """
    accepted = [t for t in trials if t.accepted]
    if not accepted:
        return []
    if data.validate.whitened:
        return _best_of_runs(accepted, data)
    best = max(accepted, key=lambda t: t.gain)
    counts = resampled(data.validate.record, data.validate.block, rng)
    members = []
    for trial in accepted:
        difference = weighted_ms(trial.squared - best.squared, data.validate.block, counts)
        as_good = interval(difference)[0] <= 0.0 and trial.gain >= 0.9 * best.gain
        if best.similarity[trial.effect.key] > ALIKE or as_good:
            members.append(trial)
    return members


TELLS_APART = 3.0
"""Standard errors of the difference between two rivals, over windows, from which the worse one is out."""


def _best_of_runs(accepted: Sequence[Trial], data: Data) -> list[Trial]:
    """As best_class, where each rival has one parameter and all windows count: seen ones and unseen ones alike."""

    def by_window(trial: Trial) -> Array:
        seen = sum_by(data.identify.block, trial.identified, int(data.identify.block.max()) + 1)
        unseen = sum_by(data.validate.block, trial.squared, int(data.validate.block.max()) + 1)
        return np.concatenate([seen, unseen])

    left = {t.effect.key: by_window(t) for t in accepted}
    best = min(accepted, key=lambda t: float(left[t.effect.key].sum()))
    members = []
    for trial in accepted:
        worse = left[trial.effect.key] - left[best.effect.key]
        scatter = float(np.std(worse) * np.sqrt(len(worse)))
        told_apart = float(worse.sum()) > TELLS_APART * scatter or trial.gain < 0.9 * best.gain
        if (
            trial is best
            or (best.similarity[trial.effect.key] > ALIKE and trial.gain > 0.8 * best.gain)
            or not told_apart
        ):
            members.append(trial)
    return sorted(members, key=lambda t: t is not best)
