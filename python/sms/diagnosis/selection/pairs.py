"""Two causes that only together take enough: tried where no effect stands alone.

Of two large causes either may leave so much that it does not stand, or be fitted at the end of what is plausible since
it makes up for the other. So the effects that promise most are fitted two at a time. A pair is named if each
takes, of what the other leaves alone, what a cause has to take, and both together as much as two causes in turn would.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import ROLES, Left, beyond_healthy, logarithms
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import fit, residual_of, without_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.selection.ambiguity import alike
from sms.diagnosis.selection.candidates import Trial, leaders_settled
from sms.diagnosis.selection.finite_steps import Step, best_steps, extended
from sms.diagnosis.selection.judgement import judge
from sms.diagnosis.selection.outcome import Round
from sms.diagnosis.thresholds import LEADERS, LEAST_SHARE, PAIR_STEPS, PARTNERS, TWINS
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
    tried = _most_promising(trials, current, data)
    alone: dict[Effect, Fitted] = {}
    for t in (t for pair in tried for t in pair[:2] if t.effect not in alone):
        alone[t.effect] = _alone(t, current, data)
    both = {
        frozenset((one.effect, other.effect)): _together(
            alone[one.effect], alone[other.effect], current, data, step
        )
        for one, other, step in tried
    }
    if not both:
        return []
    both = leaders_settled(both, lambda f: _left_of(f, data), lambda one, other: False, data)
    best, pair = min(both.items(), key=lambda item: _left_of(item[1], data))
    if not _enough(current, pair, data):
        return []
    first, second = sorted(best, key=list(alone).index)
    rounds = []
    for member, other in ((first, second), (second, first)):
        beside = {e: f for pair, f in both.items() if other in pair for e in pair - {other}}
        candidates = _rivals(member, beside, alone[other], data)
        judge(candidates, alone[other], data, original, needed, rng, tried=len(both))
        accepted = [t for t in candidates if t.accepted]
        if not any(t.effect is member for t in accepted):
            return []
        accepted.sort(key=lambda t: t.effect is not member)
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
            found.append(Trial(effect, fitted, 1.0))
    return found


def _most_promising(
    trials: Sequence[Trial], current: Fitted, data: Data
) -> list[tuple[Trial, Trial, Step | None]]:
    """Pairs of what was fitted and lowers most, and of what promised most by finite steps (beside another cause its fit
    may have gone astray); and of each of them with what lowers most on top of it by finite steps: beside a large cause
    another one may be hidden altogether, and which of them is a cause is not known yet. Filled up with the others, by
    how much they lower and by their score tests. A step begins on top of the first.
    """
    fitted = sorted((t for t in trials if t.fitted is not current), key=lambda t: -t.lower)
    fitted = sorted(fitted, key=lambda t: t is not max(fitted, key=lambda t: t.by_step))
    leaders, more = fitted[:LEADERS], fitted[LEADERS:]
    by_score = sorted((t for t in trials if t.fitted is current), key=lambda t: t.p_value)
    led = [t.effect for t in leaders]
    pairs: dict[frozenset[Effect], tuple[Trial, Trial, Step | None]] = {}
    for leader in leaders:
        others = {t.effect: t for t in trials if t is not leader}
        steps = best_steps(list(others), leader.fitted, data, data.healthy is not None)
        beside = {e: step for e, step in zip(others, steps, strict=True) if step.gain > 0.0}
        helping = sorted(beside, key=lambda e: -beside[e].gain)
        partners = dict.fromkeys([*helping, *(t.effect for t in (*more, *by_score))])
        apart = [e for e in partners if e not in led][:PARTNERS]
        for effect in (*(e for e in led if e is not leader.effect), *apart):
            pair, step = frozenset((leader.effect, effect)), beside.get(effect)
            if pair not in pairs or pairs[pair][2] is None:
                pairs[pair] = leader, others[effect], step
    return list(pairs.values())


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
        starts.append(step.params)
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
