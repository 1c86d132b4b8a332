"""Forward selection where a simulation is held against the records: which causes stand, one after another.

A machine differs from every model of it, by a percent here and there, all the time and in no direction that has a
name. So a cause is not asked to explain everything. It is asked to take most of what is left, in nearly every window,
on the records that it was fitted to and on those that it was not. What it leaves is another question (adequacy/).

How much a model leaves is counted by window and signal (adequacy/residual_energy.py).

A round. Every effect is tried on top of the model as it stands: by one linear step (score_test.py), and at a ladder of
finite sizes (finite_steps.py). Those that promise most are fitted, from the better of the two, and with them the rivals
of the best in its own equation: what helps there, and laws of several parameters, which may help only beside other
numbers. The best joins the model with whatever cannot be told from it, and so on until nothing stands. Where nothing
does from the beginning, those that promise next are fitted too, and then, if one of them helps at all, pairs. In the
end each cause is taken out again, and must be missed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.callbacks import Progress
from sms.diagnosis.adequacy.residual_energy import (
    Left,
    departs,
    logarithms,
    nothing_left,
    small,
)
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import fit, residual_of, without_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import looked_at_again
from sms.diagnosis.selection.ambiguity import ambiguity_group, with_substitutes
from sms.diagnosis.selection.backward_elimination import (
    backward_elimination,
    beyond_plausible,
    settled,
    with_these,
)
from sms.diagnosis.selection.candidates import (
    Trial,
    converged,
    leaders_settled,
    moved,
    room_of,
    score_effects,
)
from sms.diagnosis.selection.finite_steps import (
    Step,
    best_steps,
    chosen_by_step,
    extended,
    first_of_each,
)
from sms.diagnosis.selection.identifiability import raw_columns
from sms.diagnosis.selection.judgement import judge, no_help
from sms.diagnosis.selection.outcome import Outcome, Round
from sms.diagnosis.selection.pairs import try_pairs
from sms.diagnosis.selection.score_test import ScoreTests, cosines
from sms.diagnosis.thresholds import (
    ALIKE,
    CANDIDATE_STEPS,
    LEAST_SHARE,
    MOST_CAUSES,
    NEARLY_ALL,
    SAME,
    TRIED_BY_SLOPE,
)
from sms.estimation.least_squares import changed

# ---- one round -------------------------------------------------------------------------------------


def try_effects(
    current: Fitted,
    data: Data,
    effects: Sequence[Effect],
    rng: np.random.Generator,
    needed: float,
    nearby: Mapping[Effect, Fitted] | None = None,
) -> tuple[Fitted, list[Trial]]:
    """Every effect on top of the model as it stands; those that promise most are fitted. The model comes back with the
    initial states that the trials have found. needed: as in `judge`. nearby: those that were fitted from where the
    model stands; finite steps begin at what is declared then.
    """
    scores = score_effects(current, data, effects, rng)
    first, steps = _promising(current, data, effects, scores, needed, nearby)
    current = looked_at_again(current, data)
    trials = []
    for k, effect in enumerate(effects):
        trial = Trial(effect, first.get(k, current), float(scores.p_value[k]))
        if k not in first:
            trial.reason = "promises less than others of this round, by slope and by finite steps"
        trial.by_step = steps[k].gain
        trials.append(trial)
    return current, trials


def try_more(current: Fitted, data: Data, trials: Sequence[Trial], needed: float) -> list[Trial]:
    """Where nothing that was fitted stands: those that promise next by finite steps, now fitted too, whichever leaves
    least to its end. What was not fitted was not refused: a lag of friction of 145 ms promises less at 10 ms than
    effects that are not there, and with all else as it stands more is worse. What is alike to the first of them is
    fitted if that helps.
    """
    rest = [t for t in trials if t.fitted is current and t.by_step > 0.0]
    if not rest:
        return []
    effects = [t.effect for t in rest]
    steps = best_steps(effects, current, data, declared=data.healthy is not None)
    if not any(step.gain > 0.0 for step in steps):
        return []
    first, alike = chosen_by_step(steps)

    def candidate(k: int) -> Fitted:
        room = np.array(room_of(effects[k], current.params, data.rig))
        return without_sensitivities(_fitted(effects[k], current, data, steps[k], 0.0, room))

    tried = {k: candidate(k) for k in first}
    leader = replace(rest[first[0]], fitted=tried[first[0]])
    if not no_help(leader, current, data, Left.by(current, data), needed, len(trials)):
        tried |= {k: candidate(k) for k in alike}
    found = leaders_settled(
        tried,
        lambda fitted: logarithms(data.identify, fitted.fit.residual),
        lambda one, other: False,
        data,
    )
    for k, fitted in found.items():
        rest[k].fitted, rest[k].reason = fitted, ""
    return [rest[k] for k in found]


def _promising(
    current: Fitted,
    data: Data,
    effects: Sequence[Effect],
    scores: ScoreTests,
    needed: float,
    nearby: Mapping[Effect, Fitted] | None,
) -> tuple[dict[int, Fitted], list[Step]]:
    """By index the effects that are fitted: the best by finite steps and by slope, each in a direction of its own; of
    those that help where they are fitted, what is alike to them, and what acts in the equation of the best; and what is
    the same as one of all these to these signals. And the finite steps of all.
    """
    room = np.array([room_of(e, current.params, data.rig) for e in effects])
    promise = scores.promise(np.minimum(room[:, 0], 0.0), np.maximum(room[:, 1], 0.0))
    # Records of the healthy machine tell its numbers so well that nothing is to be had from where they went since.
    afar = nearby is not None
    steps = best_steps(effects, current, data, declared=afar or data.healthy is not None)
    alike = scores.cosine > ALIKE
    by_slope = first_of_each([int(k) for k in np.argsort(-promise) if promise[k] > 0.0], alike)
    by_step, alike_to_first = chosen_by_step(steps)
    before = Left.by(current, data)

    def left(fitted: Fitted) -> float:
        return logarithms(data.identify, fitted.fit.residual)

    def candidate(k: int) -> Fitted:
        effect, step = effects[k], steps[k]
        if nearby is not None and effect in nearby:
            found = nearby[effect]
        else:
            found = _fitted(effect, current, data, step, float(scores.estimate[k]), room[k])
        if afar and (k in by_step or k in alike_to_first):
            found = min(found, _fitted_from(step.params, effect, current, data), key=left)
        return without_sensitivities(found)

    first = {k: candidate(k) for k in dict.fromkeys(by_step + by_slope[:TRIED_BY_SLOPE])}

    def helps(k: int) -> bool:
        trial = Trial(effects[k], first[k], float(scores.p_value[k]))
        return not no_help(trial, current, data, before, needed, len(effects))

    more = list(alike_to_first) if by_step and helps(by_step[0]) else []
    if by_slope and helps(by_slope[0]):
        more += np.flatnonzero(alike[by_slope[0]]).tolist()
    first |= {k: candidate(k) for k in dict.fromkeys(more) if k not in first}
    best = min(first, key=lambda k: left(first[k]))
    rivals = []
    if helps(best):
        rivals = [
            k
            for k, effect in enumerate(effects)
            if alike[k, best]
            or (
                effect.block == effects[best].block
                and (steps[k].gain > 0.0 or len(effect.parameters) > 1)
            )
        ]
    # What is known tells some effects apart that are one equation to these signals: a tank's volume, and all its flow.
    same = cosines(raw_columns(current, data.identify, effects)) > SAME
    rivals += np.flatnonzero(same[list(first)].any(axis=0)).tolist()
    first |= {k: candidate(k) for k in dict.fromkeys(rivals) if k not in first}
    return leaders_settled(first, left, lambda one, other: bool(alike[one, other]), data), steps


def _fitted(
    effect: Effect, current: Fitted, data: Data, step: Step, slope: float, room: Array
) -> Fitted:
    """The effect fitted beside all else that is free, from the better of its step and its linear estimate."""
    if data.healthy is not None and step.gain > 0.0:
        return _fitted_from(step.params, effect, current, data)
    name = effect.parameters[0]
    step_by_slope = float(np.clip(slope, min(room[0], 0.0), max(room[1], 0.0)))
    linear = moved(effect, current.params, step_by_slope, data.rig)
    linear = linear if effect.step is None else max(linear, 0.1 * effect.step)
    start = changed(current.params, [name], np.array([linear]))
    if step.gain > 0.0:  # else the neutral value, which is left only where all else makes up for it
        still = linear == current.params[name]
        there = current.fit.residual if still else residual_of(data.identify, start)
        by_step = residual_of(data.identify, step.params)
        if logarithms(data.identify, by_step) < logarithms(data.identify, there):
            start = step.params
    slopes = current.slopes
    if name not in slopes:
        slopes[name] = raw_columns(current, data.identify, [effect])[:, 0]
    return _fitted_from(start, effect, current, data, slopes)


def _fitted_from(
    start: _core.Params,
    effect: Effect,
    current: Fitted,
    data: Data,
    slopes: Mapping[str, Array] | None = None,
) -> Fitted:
    """The effect fitted beside all else that is free. slopes: sensitivities to begin with, the model's by default."""
    return fit(
        extended(current.hypothesis, effect, data),
        data.identify,
        start,
        CANDIDATE_STEPS * len(effect.parameters),
        current.slopes if slopes is None else slopes,
        data.allowed(data.identify),
        roughly=True,
    )


# ---- all rounds ------------------------------------------------------------------------------------


def stepwise_selection(
    baseline: Fitted,
    data: Data,
    effects: Sequence[Effect],
    rng: np.random.Generator,
    progress: Progress,
    least: Array,
) -> Outcome:
    """Until nothing more stands, or nothing is left. least: (channels,) mean square beyond the noise that is tolerated.

    Where a model leaves no more than that, only a cause that takes nearly all of it is believed: half of so small an
    error is taken by many.
    """
    rounds: list[Round] = []
    current, remaining = baseline, list(effects)
    original = Left.by(baseline, data).excess("validate")
    for number in range(1, MOST_CAUSES + 1):
        here = Left.by(current, data)
        done = settled(current, here, data) if number == 1 else nothing_left(here, data)
        if not remaining or done:
            break
        share = 0.1 + 0.75 * number / (MOST_CAUSES + 1)
        progress(f"round {number}: {len(remaining)} effects", share)
        needed = NEARLY_ALL if small(here, least) else LEAST_SHARE
        current, trials = try_effects(current, data, remaining, rng, needed)
        judge(trials, current, data, original, needed, rng)
        members = ambiguity_group(trials, current, data)
        if not members and data.healthy is None and departs(current):
            # What is known went farther than chance has it: it may have made up for what is looked for.
            nearby = {t.effect: t.fitted for t in trials if t.fitted is not current}
            current, trials = try_effects(current, data, remaining, rng, needed, nearby)
            judge(trials, current, data, original, needed, rng)
            members = ambiguity_group(trials, current, data)
        if not members and number == 1 and (more := try_more(current, data, trials, needed)):
            judge(more, current, data, original, needed, rng, tried=len(trials))
            members = ambiguity_group(trials, current, data)
        together: list[Round] = []
        if not members and number == 1 and any(t.helps for t in trials):
            together = try_pairs(trials, current, data, original, needed, rng)
        rounds += together or [Round(trials, members)]
        _forget(trials, current, data)
        found_now = [r.members for r in together] or ([members] if members else [])
        if not found_now:
            break
        current = converged(found_now[-1][0].fitted, data)
        for members in found_now:
            members[0].fitted = current
        remaining = [e for e in remaining if all(e is not m[0].effect for m in found_now)]
    last = max((k for k, r in enumerate(rounds) if r.members), default=None)
    if last is not None:  # what an earlier round could not tell apart, a later cause may have
        rounds[last] = with_substitutes(rounds[last], data)
    found = [r.members for r in rounds if r.members]
    judged_alone = len(found) == 1
    while (beyond := beyond_plausible(found, current, data)) is not None:
        found = [m for m in found if m is not beyond]
        current = with_these(found, baseline, current, data)
        judged_alone = False
    if not judged_alone:
        found, current = backward_elimination(found, baseline, current, data)
    return Outcome(current, rounds, found)


def _forget(trials: Sequence[Trial], current: Fitted, data: Data) -> None:
    """Of what was not accepted the values are kept, and its sensitivities and residuals on other records are not."""
    for trial in trials:
        if trial.fitted is not current and not trial.accepted:
            data.refitted_of.pop(id(trial.fitted), None)
            data.unseen_of.pop(id(trial.fitted), None)
            trial.fitted = without_sensitivities(trial.fitted)
