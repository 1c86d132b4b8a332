"""Rounds of the search until nothing more is found, and the verdict on what they brought."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from sms.diagnosis.adequacy.repeatability import Repeatability, repeatability
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, residual_of
from sms.diagnosis.other_records import unseen
from sms.diagnosis.result import Verdict
from sms.diagnosis.selection.candidates import try_effects
from sms.diagnosis.selection.outcome import Outcome, Round
from sms.diagnosis.selection.validation import Yardstick, ambiguity_group, judge
from sms.diagnosis.thresholds import MOST_CAUSES, UNKNOWN_CHANCE, UNKNOWN_OF_NOISE, UNKNOWN_SHARE

Progress = Callable[[str, float], None]
"""Called with what is being done and the share that is done, 0..1."""


def repeats_of(fitted: Fitted, data: Data, rng: np.random.Generator) -> Repeatability:
    """How much of a model's error on the validate records repeats from stroke to stroke."""
    v = data.validate
    return repeatability(
        residual_of(v, fitted.params),
        v.record,
        v.window,
        v.inputs["extension [m]"],
        v.inputs["direction"],
        rng,
    )


def forward_selection(
    baseline: Fitted,
    data: Data,
    effects: Sequence[Effect],
    floor: float,
    rng: np.random.Generator,
    progress: Progress,
) -> Outcome:
    """Until nothing more is found: the best effect joins the model, with those that look alike.

    floor: mean square of what no model of the state explains. Rigs that are simulated have stepwise.py.
    """
    original = float(np.mean(unseen(baseline, data) ** 2))
    yardstick = Yardstick(original, floor)
    current, rounds = baseline, []
    remaining = list(effects)
    for number in range(1, MOST_CAUSES + 1):
        if not remaining:
            break
        done = 0.1 + 0.75 * number / (MOST_CAUSES + 1)
        progress(f"round {number}: {len(remaining)} effects", done)
        trials = try_effects(current, data, remaining, rng)
        judge(trials, current, data, yardstick, rng)
        members = ambiguity_group(trials, current, data, rng)
        rounds.append(Round(trials, members))
        if not members:
            break
        current = members[0].fitted
        remaining = [e for e in remaining if e.key not in {m.effect.key for m in members}]
    found = [r.members for r in rounds if r.members]
    return Outcome(current, rounds, found)


def decide(outcome: Outcome, before: Repeatability, after: Repeatability) -> Verdict:
    """One of the verdicts, data-fault aside."""
    least = max(UNKNOWN_OF_NOISE * after.stroke, UNKNOWN_SHARE * before.systematic)
    repeats = after.repeats > least and after.repeats_p_value < UNKNOWN_CHANCE
    drifts = after.drift > least and after.drift_p_value < UNKNOWN_CHANCE
    if repeats or drifts:
        return "unknown"
    if not outcome.groups:
        return "no-evidence"
    if len(outcome.groups) > 1:
        return "combination"
    return "cause" if len(outcome.groups[0]) == 1 else "class"
