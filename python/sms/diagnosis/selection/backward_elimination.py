"""Causes taken out again: each must be missed, and must stand in the final model.

What a cause took beside another, or before another came, it need not take alone.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import chi2

from sms import _core
from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import ROLES, Left, departs, nothing_left, small
from sms.diagnosis.adequacy.systematic_error import generalised, with_systematic_error
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import fit
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.finite_steps import extended
from sms.diagnosis.selection.judgement import beyond_doubt, channel_of_its_own, implausible
from sms.diagnosis.selection.outcome import Outcome
from sms.diagnosis.thresholds import JOINT_INTERVAL, LEAST_SHARE, NEARLY_ALL


def settled(fitted: Fitted, left: Left, data: Data) -> bool:
    """Whether there is nothing to look for: hardly more than noise is left, and what is known is nearly as declared.

    With records of the healthy machine what is left counts how far that moved.
    """
    return nothing_left(left, data) and (data.healthy is not None or not departs(fitted))


def beyond_plausible(found: Sequence[list[Trial]], final: Fitted, data: Data) -> list[Trial] | None:
    """A cause that beside those that came later is at the end of what is plausible, and says so."""
    for members in found:
        if reason := implausible(members[0].effect, final, data):
            for trial in members:
                trial.accepted, trial.reason = False, f"beside other causes {reason}"
            return members
    return None


def without_untenable(
    outcome: Outcome, final: Fitted, baseline: Fitted, data: Data
) -> Outcome | None:
    """Without the first cause whose value in the final model is within what is declared of it, or at the end of what is
    plausible: it is none, whatever it stood in for before the others came. Of several causes none stands whose interval
    has no effect in it: what another leaves, whose law is known only roughly, has been given its name. None where each
    can stand.
    """
    h = baseline.hypothesis
    several = len(outcome.found) > 1
    for members in outcome.found:
        name = members[0].effect.parameters[0]
        declared = data.rig.declared(name).uncertainty
        reason = implausible(members[0].effect, final, data)
        if abs(final.params[name] - h.start[name]) <= h.known.get(name, declared):
            reason = "within what is declared"
        elif several and _may_be_nothing(members, final, h.start, data):
            reason = "its interval of 95 % has no effect in it"
        if reason:
            for trial in members:
                trial.accepted, trial.reason = False, f"in the final model {reason}"
            kept = [m for m in outcome.found if m is not members]
            if not kept:
                return Outcome(baseline, outcome.rounds, kept)
            current = with_these(kept, baseline, outcome.final, data)
            kept, current = backward_elimination(kept, baseline, current, data)
            return Outcome(current, outcome.rounds, kept)
    return None


def without_insignificant(
    outcome: Outcome, final: Fitted, baseline: Fitted, data: Data, least: Array
) -> Outcome:
    """Without a single cause whose interval has no effect in it. One stands all the same that takes nearly all of an
    error beyond what is tolerated, least (channels,): that is hardly imitated, however unsure the size. What was
    judged by its own signal took of that alone.
    """
    if len(outcome.found) != 1:
        return outcome
    first = outcome.found[0][0]
    takes_all = not first.by_own_signal and min(first.seen_share, first.gain) >= NEARLY_ALL
    if takes_all and not small(Left.by(baseline, data), least):
        return outcome
    if not _may_be_nothing(outcome.found[0], final, baseline.hypothesis.start, data):
        return outcome
    for trial in outcome.found[0]:
        trial.accepted = False
        trial.reason = "in the final model its interval of 95 % has no effect in it"
    return Outcome(baseline, outcome.rounds, [])


def _may_be_nothing(
    members: Sequence[Trial],
    final: Fitted,
    declared: _core.Params,
    data: Data,
) -> bool:
    """Whether errors alone would bring every member of a class where it is, in one case of twenty. One may be known as
    nearly as what it is confounded with, a sensor's gain as its zero, where another is beyond doubt.
    """
    for trial in members:
        at = final if trial is members[0] else generalised(trial.fitted, data)
        distance, count = _distance_from_nothing(trial.effect, at, declared)
        if distance >= float(chi2.ppf(JOINT_INTERVAL, count)):
            return False
    return True


def _distance_from_nothing(
    effect: Effect, final: Fitted, declared: _core.Params
) -> tuple[float, int]:
    """How far the effect's sizes lie from what is declared, squared and in standard errors, systematic errors counted;
    and how many parameters were estimated. Infinite where none was.

    Without the effect what shapes it has no value, so none that is declared (Davies, Biometrika 64, 1977): it stays
    where it fits best.
    """
    names = [n for n in effect.parameters if n in final.movable and final.standard_error(n) > 0.0]
    if not names:
        return np.inf, 0
    place = [list(final.hypothesis.free).index(n) for n in names]
    sizes = effect.parameters[: effect.sizes]
    off = np.array([final.params[n] - declared[n] if n in sizes else 0.0 for n in names])
    deviation = np.array([final.standard_error(n) for n in names])
    correlation = final.covariance[np.ix_(place, place)] / np.outer(deviation, deviation)
    distance = off / deviation @ np.linalg.pinv(correlation, hermitian=True) @ (off / deviation)
    return float(distance), len(names)


def with_these(found: Sequence[list[Trial]], baseline: Fitted, final: Fitted, data: Data) -> Fitted:
    """The baseline with some of the causes of the final model, fitted from its values."""
    hypothesis, start = baseline.hypothesis, baseline.params.copy()
    for members in found:
        hypothesis = extended(hypothesis, members[0].effect, data)
    for name in hypothesis.free:
        start[name] = final.params[name]
    return fit(
        hypothesis,
        data.identify,
        start,
        nearby=final.slopes,
        discrepancy=data.allowed(data.identify),
    )


def backward_elimination(
    found: list[list[Trial]], baseline: Fitted, current: Fitted, data: Data
) -> tuple[list[list[Trial]], Fitted]:
    """The causes that are missed where they are taken out, and their model. What a cause took beside another that is
    gone, it need not take alone.
    """
    while found and (fewer := _without_one(found, baseline, current, data)) is not None:
        found, current = fewer
    return found, current


def _without_one(
    found: Sequence[list[Trial]], baseline: Fitted, final: Fitted, data: Data
) -> tuple[list[list[Trial]], Fitted] | None:
    """Fewer causes and their model, where one has stood in for the others; None where each is missed.

    A cause is missed if without it the others leave at least as much more as a cause has to take, and more than what
    ends the search: a pair's second one may have stood in for a first one that was not fitted to its end. Where records
    of the healthy machine told what is known, that may have to move so far in its place that its size is beyond doubt,
    however little more is left: it is missed then too.
    """
    left = Left.by(final, data)
    for members in found:
        if data.healthy is not None and beyond_doubt(
            members[0].effect, with_systematic_error(final, data.identify), data
        ):
            continue
        kept = [m for m in found if m is not members]
        without = with_these(kept, baseline, final, data)
        other = Left.by(without, data)
        channel = channel_of_its_own(members[0].effect, data)
        counted = [(left, other)]
        if channel is not None:
            counted.append((left.of(channel), other.of(channel)))
        if settled(without, other, data) or all(
            now.excess(r) >= (1.0 - LEAST_SHARE) * then.excess(r)
            for now, then in counted
            for r in ROLES
        ):
            for trial in members:
                trial.accepted, trial.reason = False, "without it the model leaves hardly more"
            return kept, without
    return None
