"""Judgement on unseen records: which trials are causes, and which of them cannot be told apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.diagnosis.hypothesis import Data, Fitted, unseen
from sms.diagnosis.selection import cross_validation
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.thresholds import (
    ALIKE,
    NEARLY_EVERY,
    SIGNIFICANT,
    TELLS_ALIKE_APART,
    TELLS_APART,
    WORTH,
    WORTH_OF_LEFT,
    WORTH_OF_NOISE,
)
from sms.estimation.block_statistics import interval, resampled, sum_by, weighted_ms
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
        if trial.reason in (NO_HELP, WORTH_NOTHING) and _insensitive(
            trial, current, data, yardstick
        ):
            trial.cross_validated = True
            trial.reason = cross_validation.objection(
                trial.fitted, current, data, yardstick.floor, rng.spawn(1)[0]
            )
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
    least = yardstick.least_worth
    if data.validate.whitened:  # a large error that is already named must not hide a second one
        least = min(least, WORTH_OF_LEFT * max(float(np.mean(before)) - yardstick.floor, 0.0))
    if worth < max(least, WORTH_OF_NOISE * yardstick.floor):
        return WORTH_NOTHING
    for number, name_ in enumerate(m.name for m in data.validate.motions):
        rows = data.validate.record == number
        if float(np.mean(trial.squared[rows]) - np.mean(before[rows])) > worth:
            return f"makes '{name_}' worse by more than it improves the others"
    return ""


def _insensitive(trial: Trial, current: Fitted, data: Data, yardstick: Yardstick) -> bool:
    """Whether unseen records change less with the trial than two honest descriptions differ by, and no worse for it."""
    if not data.validate.whitened or trial.gain_interval[1] < 0.0:
        return False
    honest = data.validate.kind.honest[0] * yardstick.floor
    return cross_validation.change_on_validation(trial.fitted, current, data) < honest


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
    if data.validate.whitened:
        return _best_of_runs(accepted, current, data, rng)
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


def by_window(seen: Array, unseen: Array, data: Data) -> Array:
    """Sums of squared residuals (rows,) of identify and validate records over windows, one after the other."""
    return np.concatenate(
        [
            sum_by(part.block, squared, int(part.block.max()) + 1)
            for part, squared in ((data.identify, seen), (data.validate, unseen))
        ]
    )


def _best_of_runs(
    accepted: Sequence[Trial], current: Fitted, data: Data, rng: np.random.Generator
) -> list[Trial]:
    """As best_class, where each rival has one parameter and all windows count: seen ones and unseen ones alike."""

    left = {t.effect.key: by_window(t.identified, t.squared, data) for t in accepted}
    own = rng.spawn(1)[0]
    counts = np.hstack([resampled(p.record, p.block, own) for p in (data.identify, data.validate)])
    _chosen_again(accepted, counts @ np.column_stack(list(left.values())))
    best = min(accepted, key=lambda t: float(left[t.effect.key].sum()))
    before = by_window(current.fit.residual**2, unseen(current, data) ** 2, data)
    least = least_difference(float(before.sum()), best.fitted, data)
    members = []
    for trial in accepted:
        alike = best.similarity[trial.effect.key] > ALIKE
        worse = left[trial.effect.key] - left[best.effect.key]
        out = told_apart(worse, least if alike else 0.0, left[best.effect.key])
        if not alike:
            out = out or _takes_less(trial, best, before, left)
        if trial is best or not out:
            members.append(trial)
    return sorted(members, key=lambda t: t is not best)


def _takes_less(trial: Trial, best: Trial, before: Array, left: Mapping[str, Array]) -> bool:
    """Whether a rival takes less than nine tenths, of all records where those for validation are insensitive."""
    if not (trial.cross_validated or best.cross_validated):
        return trial.gain < 0.9 * best.gain
    takes, most = (float((before - left[t.effect.key]).sum()) for t in (trial, best))
    return takes < 0.9 * most


def told_apart(worse: Array, least: float, best: Array) -> bool:
    """Whether a rival leaves more than the best, from the differences of chi-square (windows,), and by `least`.

    best: (windows,) that the best leaves. A rival that leaves more than twice that, and more in nearly every window, is
    out however much the windows differ in size.
    """
    if float(worse.sum()) > max(float(best.sum()), least) and np.mean(worse > 0.0) > NEARLY_EVERY:
        return True
    scatter = float(np.std(worse) * np.sqrt(len(worse)))
    return float(worse.sum()) > max(TELLS_APART * scatter, least)


def least_difference(before: float, best: Fitted, data: Data) -> float:
    """Of chi-square, what tells two apart that look alike; `before` is chi-square without either."""
    left, honest = 0.0, 0.0
    seen = (data.identify, best.fit.residual), (data.validate, unseen(best, data))
    for runs, residual in seen:
        noise = float(np.sum(runs.floor(residual)[runs.channel]))
        honest += runs.kind.honest[0] * noise
        left += float(np.sum(residual**2)) - noise
    after = sum(float(np.sum(residual**2)) for _, residual in seen)
    return min(TELLS_ALIKE_APART * (before - after), max(left, honest))
