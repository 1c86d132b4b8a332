"""Of the trials that can be causes: which of them these records cannot tell apart.

Their predictions change alike, and none leaves significantly more, window by window.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import Left
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.judgement import by_chance, implausible
from sms.diagnosis.selection.outcome import Round
from sms.diagnosis.thresholds import MOST_MEMBERS, TELLS_APART, TELLS_APART_IN_A_CROWD, TWINS


def ambiguity_group(trials: Sequence[Trial], current: Fitted, data: Data) -> list[Trial]:
    """The best accepted trial, and those whose predictions change alike and are no worse; or none."""
    accepted = sorted((t for t in trials if t.accepted), key=lambda t: -t.lower)
    if not accepted:
        return []
    members = alike(accepted, current, data)
    better = _better_at_the_end(trials, members[0], current, data)
    members += better[: max(MOST_MEMBERS - len(members), 0)]
    for trial in members:
        trial.support = 1.0 / len(members)
    return members


def _better_at_the_end(
    trials: Sequence[Trial], named: Trial, current: Fitted, data: Data
) -> list[Trial]:
    """Trials with nothing against them but that they fit best at the end of what is plausible, whose predictions change
    as those of what is named, and which leave less: a cylinder without any Coulomb friction is at that end, and the
    next best explanation must not be named without it.
    """
    found = []
    for trial in trials:
        if trial.accepted or trial.fitted is current or trial.lower <= named.lower:
            continue
        end = implausible(trial.effect, trial.fitted, data)
        alone = end and not by_chance(trial) and min(trial.seen_share, trial.gain) > 0.0
        if alone and _similarity(named, trial, current, data) > TWINS:
            trial.reason = f"{end}, and leaves less than what is named"
            found.append(trial)
    return sorted(found, key=lambda t: -t.lower)


def alike(accepted: Sequence[Trial], current: Fitted, data: Data) -> list[Trial]:
    """The first of them, and those whose predictions change alike and are no worse."""
    best, *others = accepted
    twins = [t for t in others if _similarity(best, t, current, data) > TWINS]
    members = _plainest([best, *(t for t in twins if _no_worse(t, best, data))])
    if len(members) > MOST_MEMBERS:
        surely = (t for t in twins if _no_worse(t, best, data, TELLS_APART_IN_A_CROWD))
        members = _plainest([best, *surely])
    for trial in accepted:
        _similarity(members[0], trial, current, data)
        trial.support = 1.0 / len(members)
    return members


def with_substitutes(last: Round, data: Data) -> Round:
    """The class of the last cause, and accepted trials that are no worse: beside it none of them is needed any more, so
    each is another account of the same error, although its predictions change otherwise.
    """
    rivals = [t for t in last.trials if t.accepted and t not in last.members]
    rivals = [t for t in rivals if _no_worse(t, last.members[0], data)]
    room = max(MOST_MEMBERS - len(last.members), 0)
    members = [*last.members, *sorted(rivals, key=lambda t: -t.lower)[:room]]
    for trial in members:
        trial.support = 1.0 / len(members)
    return Round(last.trials, members)


def _no_worse(trial: Trial, best: Trial, data: Data, standard_errors: float = TELLS_APART) -> bool:
    """Whether what it leaves, window by window, is not significantly more."""
    worse = Left.by(trial.fitted, data).by_window - Left.by(best.fitted, data).by_window
    error = float(np.std(worse) * np.sqrt(len(worse)))
    return float(worse.sum()) <= standard_errors * error


def _similarity(one: Trial, other: Trial, current: Fitted, data: Data) -> float:
    """Cosine between two changes of all predictions; its magnitude is noted in both trials."""
    a, b = _change(one, current, data), _change(other, current, data)
    cosine = float(a @ b) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
    one.similarity[other.effect.key] = other.similarity[one.effect.key] = abs(cosine)
    return cosine


def _plainest(members: list[Trial]) -> list[Trial]:
    """Of what cannot be told apart, that with the fewest parameters first; no effect again with more of them.

    Effects that are one and the same equation differ by rounding, which must not order them.
    """
    order = sorted(
        members, key=lambda t: (len(t.effect.parameters), -round(t.lower, 6), t.effect.key)
    )
    return [
        t
        for t in order
        if not any(
            o.effect.id == t.effect.id and set(o.effect.parameters) < set(t.effect.parameters)
            for o in order
        )
    ]


def _change(trial: Trial, current: Fitted, data: Data) -> Array:
    """(rows,): how the residual changes with the trial, fitted records first."""
    return np.concatenate(
        [
            trial.fitted.fit.residual - current.fit.residual,
            refitted(trial.fitted, data).fit.residual - refitted(current, data).fit.residual,
        ]
    )
