"""Two causes that only together take enough: tried where no effect stands alone.

Of two large causes either may leave so much that it does not stand, or be fitted at the end of what is plausible since
it makes up for the other. So the effects that promise most are fitted two at a time. A pair is named if each
takes, of what the other leaves alone, what a cause has to take, and both together as much as two causes in turn would.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import ROLES, Left, beyond_healthy, logarithms
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, fit, residual_of, without_sensitivities
from sms.diagnosis.selection.candidates import Trial, leaders_settled
from sms.diagnosis.selection.finite_steps import Step, best_steps, extended
from sms.diagnosis.selection.judgement import alike, judge
from sms.diagnosis.selection.outcome import Round
from sms.diagnosis.thresholds import LEAST_SHARE, PAIR_STEPS, PAIRED, PARTNERS, TWINS
from sms.estimation.least_squares import changed


def try_pairs(
    trials: Sequence[Trial],
    current: Fitted,
    data: Data,
    original: float,
    needed: float,
    rng: np.random.Generator,
) -> list[Round]:
    """Two rounds, one for each cause of the pair that stands; none if no pair does. Arguments as in `judge`.

    trials: of the round in which no effect stood alone.
    """
    tried, beside_first = _most_promising(trials, current, data)
    alone = [_alone(t, current, data) for t in tried]
    effects = [t.effect for t in tried]
    both: dict[frozenset[int], Fitted] = {}
    for i, j in combinations(range(len(tried)), 2):
        step = beside_first.get(effects[j]) if i == 0 else None
        both[frozenset((i, j))] = _together(alone[i], alone[j], current, data, step)
    if not both:
        return []
    both = leaders_settled(both, lambda f: _left_of(f, data), lambda one, other: False, data)
    best, pair = min(both.items(), key=lambda item: _left_of(item[1], data))
    if not _enough(current, pair, data):
        return []
    first, second = sorted(best)
    rounds = []
    for member, other in ((first, second), (second, first)):
        beside = {effects[k]: both[frozenset((k, other))] for k in range(len(tried)) if k != other}
        candidates = _rivals(effects[member], beside, alone[other], data)
        judge(candidates, alone[other], data, original, needed, rng, tried=len(both))
        accepted = [t for t in candidates if t.accepted]
        if not any(t.effect is effects[member] for t in accepted):
            return []
        accepted.sort(key=lambda t: t.effect is not effects[member])
        rounds.append(Round(candidates, alike(accepted, alone[other], data)))
    return rounds


def _rivals(
    member: Effect, beside: Mapping[Effect, Fitted], other: Fitted, data: Data
) -> list[Trial]:
    """On top of the other one alone: the member, and what changes the predictions as it does."""
    changes = {e: fitted.fit.residual - other.fit.residual for e, fitted in beside.items()}
    found = []
    for effect, fitted in beside.items():
        if effect is member or _cosine(changes[member], changes[effect]) > TWINS:
            squared = residual_of(data.validate, fitted.params) ** 2
            found.append(Trial(effect, fitted, 1.0, squared, identified=fitted.fit.residual**2))
    return found


def _most_promising(
    trials: Sequence[Trial], current: Fitted, data: Data
) -> tuple[list[Trial], dict[Effect, Step]]:
    """Those that were fitted and lower most, those that finite steps on top of the best of them would lower it most
    (beside a large cause another one may be hidden altogether), and the others by their score tests. With those steps.
    """
    fitted = sorted((t for t in trials if t.fitted is not current), key=lambda t: -t.lower)
    if not fitted:
        return [], {}
    others = [t for t in trials if t.effect is not fitted[0].effect]
    steps = best_steps([t.effect for t in others], fitted[0].fitted, data, data.healthy is not None)
    beside = {t.effect: s for t, s in zip(others, steps, strict=True) if s.gain > 0.0}
    helping = [t for t in sorted(others, key=lambda t: -_gain(beside, t)) if t.effect in beside]
    best, more = fitted[: PAIRED - PARTNERS], fitted[PAIRED - PARTNERS :]
    by_score = sorted((t for t in trials if t.fitted is current), key=lambda t: t.p_value)
    tried = [*best, *helping[:PARTNERS], *more, *by_score]
    return list({id(t.effect): t for t in tried}.values())[:PAIRED], beside


def _gain(beside: Mapping[Effect, Step], trial: Trial) -> float:
    return beside[trial.effect].gain if trial.effect in beside else 0.0


def _alone(trial: Trial, current: Fitted, data: Data) -> Fitted:
    if trial.fitted is not current:
        return trial.fitted
    hypothesis = extended(current.hypothesis, trial.effect, data)
    allowed = data.allowed(data.identify)
    return without_sensitivities(
        fit(
            hypothesis,
            data.identify,
            current.params,
            PAIR_STEPS,
            current.slopes,
            allowed,
            roughly=True,
        )
    )


def _together(one: Fitted, other: Fitted, current: Fitted, data: Data, step: Step | None) -> Fitted:
    """Both effects fitted on top of a model, from the best of what each alone begins with, and of a step of the other
    beside the one."""
    effect = other.hypothesis.causes[-1]
    hypothesis = extended(one.hypothesis, effect, data)
    mine, its = (list(f.hypothesis.causes[-1].parameters) for f in (one, other))
    starts = [
        one.params,
        other.params,
        changed(one.params, its, np.array([other.params[n] for n in its])),
        changed(other.params, mine, np.array([one.params[n] for n in mine])),
    ]
    if step is not None:
        starts.append(changed(one.params, its, np.array([step.params[n] for n in its])))
    runs = data.identify
    left = [_of_residual(residual_of(runs, start), data) for start in starts]
    start = starts[int(np.argmin(left))]
    allowed = data.allowed(runs)
    return without_sensitivities(
        fit(hypothesis, runs, start, PAIR_STEPS, current.slopes, allowed, roughly=True)
    )


def _left_of(fitted: Fitted, data: Data) -> float:
    return _of_residual(fitted.fit.residual, data)


def _of_residual(residual: Array, data: Data) -> float:
    """What is compared on the identification records: logarithms of what is left, by window and signal."""
    if not np.all(np.isfinite(residual)):
        return float("inf")
    return logarithms(data.identify, beyond_healthy(data, data.identify, residual))


def _enough(current: Fitted, pair: Fitted, data: Data) -> bool:
    """Whether two causes take what each would have to take of what the other leaves."""
    was, left = Left.by(current, data), Left.by(pair, data)
    kept = 1.0
    for role in ROLES:
        kept *= left.excess(role) / max(was.excess(role), 1e-12)
    return kept <= (1.0 - LEAST_SHARE) ** 4


def _cosine(a: Array, b: Array) -> float:
    return float(a @ b) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
