"""Judgement on unseen records: which trials are causes, and which of them cannot be told apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import unseen
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.thresholds import ALIKE, SIGNIFICANT, WORTH, WORTH_OF_NOISE
from sms.estimation.block_statistics import interval, resampled, weighted_ms
from sms.parameters import common_parameter
from sms.units_display import format_quantity

NO_HELP = "does not reduce the error on the validation records"
WORTH_NOTHING = "significant, but reduces the error on the validation records hardly at all"


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
    low, high = trial.effect.plausible_range(data.rig.declared(common_parameter(name)).value)
    if trial.p_value > SIGNIFICANT:
        return f"not significant (p = {trial.p_value:.2g}, corrected for all effects tested)"
    if not low <= value <= high:
        return f"fits only with {format_quantity(value, data.rig.table[name].unit, name)}, which is implausible"
    if trial.gain_interval[0] <= 0.0:
        return NO_HELP
    worth = float(np.mean(before) - np.mean(trial.squared))
    if worth < max(yardstick.least_worth, WORTH_OF_NOISE * yardstick.floor):
        return WORTH_NOTHING
    for number, name_ in enumerate(m.name for m in data.validate.motions):
        rows = data.validate.record == number
        if float(np.mean(trial.squared[rows]) - np.mean(before[rows])) > worth:
            return f"makes '{name_}' worse by more than it improves the others"
    return ""


def ambiguity_group(
    trials: Sequence[Trial], current: Fitted, data: Data, rng: np.random.Generator
) -> list[Trial]:
    """The best accepted trial and those that the data cannot tell from it, in the catalogue's order; or none.

    Alike are two effects whose sensitivities are nearly parallel, or whose unseen records come out equally well
    although each explains nine tenths of what the other does.
    """
    accepted = [t for t in trials if t.accepted]
    if not accepted:
        return []
    best = max(accepted, key=lambda t: t.gain)
    counts = resampled(data.validate.record, data.validate.block, rng)
    again = [weighted_ms(t.squared, data.validate.block, counts) for t in accepted]
    _chosen_again(accepted, np.column_stack(again))
    members = []
    for trial in accepted:
        difference = weighted_ms(trial.squared - best.squared, data.validate.block, counts)
        as_good = interval(difference)[0] <= 0.0 and trial.gain >= 0.9 * best.gain
        if best.similarity[trial.effect.key] > ALIKE or as_good:
            members.append(trial)
    return members


def _chosen_again(trials: Sequence[Trial], left: Array) -> None:
    """Fills support: how often each of the trials has the least of (draws, trials)."""
    best = np.argmin(left, axis=1)
    for k, trial in enumerate(trials):
        trial.support = float(np.mean(best == k))
