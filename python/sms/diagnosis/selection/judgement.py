"""Judgement of a round on a simulated rig: which of the fitted trials can be causes.

Counted by window and signal (adequacy/residual_energy.py): by ranks of the windows, or, where records of the healthy
machine told what residuals are worth, by likelihood.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import chi2, wilcoxon

from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import (
    ROLES,
    Left,
    Role,
    seen_beyond_floor,
    taken_beyond_floor,
)
from sms.diagnosis.adequacy.systematic_error import generalised
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, Healthy
from sms.diagnosis.selection import cross_validation
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.thresholds import (
    HELPS,
    LEAST_SHARE,
    SIGNIFICANT,
    SURE,
)
from sms.estimation.block_statistics import interval, resampled
from sms.units_display import format_quantity


def judge(
    trials: Sequence[Trial],
    current: Fitted,
    data: Data,
    original: float,
    needed: float,
    rng: np.random.Generator,
    tried: int | None = None,
) -> None:
    """Whether each trial that was fitted can be a cause; fills gain, its interval, p_value, accepted, reason.

    original: what the baseline left beyond the noise on the validation records. needed: share of what is left that a
    cause must take. tried: how many there were to choose from; None: as many as trials.
    """
    tried = tried or len(trials)
    before = Left.by(current, data)
    part = before.excess("validate") / original if original > 0.0 else 1.0
    counts = resampled(
        data.validate.record, data.validate.window, rng
    )  # (draws, windows), record by record
    weights = counts / counts.sum(axis=1, keepdims=True)
    needed = needed if data.healthy is None else LEAST_SHARE
    for trial in trials:
        if trial.fitted is current:
            continue
        if objection := no_help(trial, current, data, before, needed, tried):
            trial.reason = objection
            continue
        trial.helps = True
        after = Left.by(trial.fitted, data)
        trial.lower = float((before.by_window - after.by_window).sum())
        by_score = trial.p_value
        if data.healthy is None:
            _by_windows(trial, before, after, weights, tried)
        else:
            _by_likelihood(trial, before, after, weights, tried, data.healthy)
        low, high = (min(part * g, 1.0) for g in trial.gain_interval)
        trial.share = (min(part * trial.gain, 1.0), low, high)
        chance = trial.gain_interval[0] <= 0.0
        trial.cross_validated = chance and _insensitive(trial, current, data, before, after)
        few = chance and not trial.cross_validated and data.healthy is None and trial.gain >= needed
        trial.reason = _untenable(trial, data, few) or _leaves_much(
            trial, needed, _telling(before, data)
        )
        if (trial.cross_validated or few) and not trial.reason:
            trial.reason = _contradicted(trial, current, data, rng.spawn(1)[0])
        channel = channel_of_its_own(trial.effect, data)
        if trial.reason and trial.lower > 0.0 and channel is not None and data.healthy is None:
            trial.p_value, trial.cross_validated, trial.by_own_signal = by_score, False, True
            was = before.of(channel)
            _by_windows(trial, was, after.of(channel), weights, tried)
            trial.reason = _untenable(trial, data) or _leaves_much(
                trial, needed, _telling(was, data)
            )
        trial.accepted = not trial.reason
    if needed > LEAST_SHARE:
        _accept_significant([t for t in trials if t.fitted is not current], current, data)


def no_help(
    trial: Trial, current: Fitted, data: Data, before: Left, needed: float, tried: int
) -> str:
    """That it takes next to nothing of what is left where it was fitted, if so. It is not asked about on the validation
    records then, where what is known would have to be fitted again: that is most effects of most rounds. Where hardly
    anything is left of the fitted records, they have no say.

    With records of the healthy machine the likelihood of the fitted records decides that.
    """
    after = before.where_fitted(trial.fitted, data)
    trial.lower = float((before.by_window - after.by_window).sum())
    if data.healthy is not None:
        trial.p_value = _chance_by_likelihood(trial, before, after, tried, data.healthy)
        return _improbable(trial)
    if "identify" not in _telling(before, data):
        return ""
    shares = [before.share_taken(after, "identify")]
    channel = channel_of_its_own(trial.effect, data)
    if channel is not None:
        shares.append(before.of(channel).share_taken(after.of(channel), "identify"))
    if needed > LEAST_SHARE:
        shares.append(seen_beyond_floor(current, trial.fitted, data.identify))
    trial.seen_share = shares[0]
    if max(shares) >= HELPS:
        return ""
    return f"takes {_percent(trial.seen_share)} of what is left on the identification records"


def _accept_significant(fitted: Sequence[Trial], current: Fitted, data: Data) -> None:
    """Where little is left: the best of all trials also stands if it takes most of that, beyond the measured floor of
    the noise, and its size is beyond doubt beside what no parameter explains. With it stand the others that take most:
    which of them is no worse is asked of a class.

    A smooth error of a map takes a part of what such an effect does, and leaves one of its own; so the share that is
    left says less here than how far the size is from what its errors and systematic ones could make.
    """
    best = max(fitted, key=lambda t: t.lower, default=None)
    if best is None or best.accepted or not _takes_most(best, current, data):
        return
    if not beyond_doubt(best.effect, generalised(best.fitted, data), data):
        return
    for trial in fitted:
        if _takes_most(trial, current, data):
            trial.accepted, trial.reason = True, ""


def _takes_most(trial: Trial, current: Fitted, data: Data) -> bool:
    """Of what is left beyond the measured floor; not of an effect to which the validation records are insensitive."""
    if trial.cross_validated or _untenable(trial, data):
        return False
    seen, gained = taken_beyond_floor(current, trial.fitted, data)
    return min(seen, gained) > 0.0 and (1.0 - seen) * (1.0 - gained) < (1.0 - LEAST_SHARE) ** 2


def beyond_doubt(effect: Effect, found: Fitted, data: Data) -> bool:
    """Whether its size is beyond what is declared of it by five standard errors.

    Those of the size where what shapes it stays as it fits best: without the effect that has no value (Davies,
    Biometrika 64, 1977), and the size of a leak of any law is less certain than that there is one.
    """
    name = effect.parameters[0]
    moved = abs(found.params[name] - found.hypothesis.start[name])
    shapes = [] if effect.sizes is None else list(effect.parameters[effect.sizes :])
    error = found.standard_error(name, held=shapes)
    return moved - data.rig.declared(name).uncertainty > SURE * error > 0.0


def channel_of_its_own(effect: Effect, data: Data) -> int | None:
    """The compared signal that the effect's equation gives without any other, if there is one: what is wrong there is
    its doing, however much is wrong elsewhere."""
    runs = data.identify
    signal = runs.kind.read_directly.get(effect.block)
    return runs.channels.index(signal) if signal in runs.channels else None


def _by_windows(trial: Trial, before: Left, after: Left, weights: Array, tried: int) -> None:
    """Shares of what is left beyond the noise, and the chance that so many windows are better."""
    trial.seen_share, trial.gain = (before.share_taken(after, role) for role in ROLES)
    was, now = (
        np.maximum(weights @ left.validate - 1.0, 0.0).mean(axis=1) for left in (before, after)
    )
    trial.gain_interval = interval(1.0 - now / np.maximum(was, 1e-12))
    lower = before.by_window - after.by_window
    better = float(wilcoxon(lower, alternative="greater").pvalue) if np.any(lower) else 1.0
    by_rank = tried * better
    trial.p_value = min(1.0, 2.0 * min(by_rank, trial.p_value))


def _by_likelihood(
    trial: Trial, before: Left, after: Left, weights: Array, tried: int, healthy: Healthy
) -> None:
    """The same where energies are in units of what the healthy machine's model leaves: a likelihood ratio.

    Shares are of what there is beyond that, or of what the trial takes if that is more: an effect may be far smaller
    than what its model leaves anyway, and still be seen, because it is there in every window.
    """
    taken = [float(np.mean(before.energy(role) - after.energy(role))) for role in ROLES]
    beyond = [max(before.excess(r), t, 1e-12) for r, t in zip(ROLES, taken, strict=True)]
    trial.seen_share, trial.gain = (max(t / b, -1.0) for t, b in zip(taken, beyond, strict=True))
    again = (weights @ (before.validate - after.validate)).mean(axis=1)
    low, high = np.clip(interval(again / beyond[1]), -1.0, 1.0)
    trial.gain_interval = float(low), float(high)
    trial.p_value = _chance_by_likelihood(trial, before, after, tried, healthy)


def _chance_by_likelihood(
    trial: Trial, before: Left, after: Left, tried: int, healthy: Healthy
) -> float:
    """That chance takes so much of the fitted records, for one of so many effects."""
    taken = max(float(np.mean(before.identify - after.identify)), 0.0)
    ratio = taken * trial.fitted.fit.residual.size / healthy.inflation
    return min(1.0, tried * float(chi2.sf(ratio, len(trial.effect.parameters))))


def _contradicted(trial: Trial, current: Fitted, data: Data, rng: np.random.Generator) -> str:
    """What the identification records, held against each other, have against it. That is asked where the validation
    records are insensitive to it, and where they are so few that it may be by chance that it takes most of what is left
    on them: of four windows, two of which are insensitive, every sixteenth resample has no others."""
    objection = cross_validation.objection(trial.fitted, current, data, 1.0, rng)
    why = "are insensitive to it" if trial.cross_validated else "are too few to exclude chance"
    return f"the validation records {why}, and {objection}" if objection else ""


def _insensitive(trial: Trial, current: Fitted, data: Data, before: Left, after: Left) -> bool:
    """Whether the change of the validation records is not practically significant, and not significantly for the worse.

    With records of the healthy machine the likelihood has weighed them already, and an effect is worth having that is
    far smaller than what its model leaves: they speak against it where they take back most of what it takes.
    """
    if data.healthy is not None:
        taken, gained = (float(np.mean(before.energy(r) - after.energy(r))) for r in ROLES)
        return gained > -LEAST_SHARE * taken or trial.gain_interval[1] >= 0.0
    if trial.gain_interval[1] < 0.0:
        return False
    least = data.validate.kind.practically_significant[0]
    return cross_validation.change_on_validation(trial.fitted, current, data) < least


def implausible(effect: Effect, fitted: Fitted, data: Data) -> str:
    """That an effect is as large in a model as it can be, or larger, if so.

    Of what only shapes an effect the end is that of its law (a tube without loss, a critical ratio of nearly one), and
    nothing against its size.
    """
    for name in effect.parameters[: effect.sizes]:
        value, declared = fitted.params[name], fitted.hypothesis.start[name]
        beside = name != effect.parameters[0]
        entry = data.rig.table[name]
        # A share of one is the end of its range by definition: the law holds altogether.
        in_full = entry.unit == "1" and value == entry.upper == 1.0
        if name not in fitted.movable and not in_full and not (beside and value == declared):
            said = format_quantity(value, entry.unit, name)
            return f"fits best at or beyond {said}, the end of what is plausible"
    return ""


def _untenable(trial: Trial, data: Data, few: bool = False) -> str:
    """Why the trial cannot be a cause, not even one among others; empty if there is nothing against it.

    few: that it takes most of what is left on the validation records, but for few windows, is no objection.
    """
    return implausible(trial.effect, trial.fitted, data) or by_chance(trial, few)


def by_chance(trial: Trial, few: bool = False) -> str:
    """That it may be chance that it takes what it takes, if so. few: as above."""
    if reason := _improbable(trial):
        return reason
    if trial.gain_interval[0] <= 0.0 and not (trial.cross_validated or few):
        return f"{_taken(trial)}, where it may be chance"
    return ""


def _improbable(trial: Trial) -> str:
    if trial.p_value > SIGNIFICANT:
        return f"may be chance (p = {trial.p_value:.2g} among all that were tried)"
    return ""


def _telling(before: Left, data: Data) -> tuple[Role, ...]:
    """The roles in which a practically significant error is left: of nothing every effect takes a hundred percent."""
    if data.healthy is not None:
        return ROLES
    least = data.identify.kind.practically_significant[0]
    return tuple(role for role in ROLES if before.excess(role) >= least) or ROLES


def _leaves_much(trial: Trial, needed: float, telling: Sequence[Role]) -> str:
    """That it takes less than it needs to of what is left, if so; of the identification records alone where the
    validation records are insensitive to it.
    """
    if trial.cross_validated:
        return _taken(trial) if trial.seen_share < needed else ""
    share: dict[Role, float] = {"identify": trial.seen_share, "validate": trial.gain}
    kept = np.prod([1.0 - share[role] for role in telling])
    return _taken(trial) if kept > (1.0 - needed) ** len(telling) else ""


def _taken(trial: Trial) -> str:
    return (
        f"takes {_percent(trial.seen_share)} of what is left on the identification records and "
        f"{_percent(trial.gain)} on the validation records"
    )


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %".replace("-", "−")
