"""The method on strokes of a cylinder on its test rig, where the force balance is compared sample by sample.

What simulated.py asks of windows is asked of strokes here; what scatters from stroke to stroke is the noise, since none
is declared that would count it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sms.callbacks import Progress
from sms.diagnosis import wording
from sms.diagnosis.adequacy.repeatability import Repeatability, arrangement, repeatability
from sms.diagnosis.adequacy.verdict import of_causes
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.evidence import candidates_of, cause_from, gains, series_of, value_of
from sms.diagnosis.fitting import fit, residual_of
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.localisation.ripple import find_ripple
from sms.diagnosis.related_rigs import related_rigs
from sms.diagnosis.remainder import Remainder
from sms.diagnosis.result import Cause, Diagnosis, NotTestable, ParameterValue, Related, Verdict
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.forward_selection import forward_selection
from sms.diagnosis.selection.identifiability import identifiable
from sms.diagnosis.selection.outcome import Outcome
from sms.diagnosis.thresholds import LEAST_SHARE, UNKNOWN_CHANCE, UNKNOWN_OF_NOISE


@dataclass(frozen=True)
class Case:
    """Everything the steps brought."""

    data: Data
    baseline: Fitted
    outcome: Outcome
    verdict: Verdict
    blind: Sequence[NotTestable]
    before: Repeatability
    after: Repeatability
    related: tuple[Related, ...]


def investigate(
    data: Data, effects: Sequence[Effect], rng: np.random.Generator, progress: Progress
) -> Case:
    """Baseline, rounds and verdict; and the causes on related rigs."""
    progress("fitting the baseline", 0.1)
    baseline = fit(baseline_hypothesis(data, effects), data.identify)
    able, blind = identifiable(baseline, data, effects)
    before = repeats_of(baseline, data, rng)
    outcome = forward_selection(baseline, data, able, before.stroke, rng, progress)
    progress("judging what is left", 0.85)
    after = repeats_of(outcome.final, data, rng)
    verdict = decide(outcome, before, after)
    if verdict == "unknown":
        outcome, after = replace(outcome, final=baseline, named=False), before
    progress("comparing related rigs", 0.9)
    related = related_rigs(data.rig, outcome.final, effects)
    return Case(data, baseline, outcome, verdict, blind, before, after, related)


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


def decide(outcome: Outcome, before: Repeatability, after: Repeatability) -> Verdict:
    """One of the verdicts, data-fault aside: causes are named where together they take most of what is systematic."""
    least = max(UNKNOWN_OF_NOISE * after.stroke, (1.0 - LEAST_SHARE) * before.systematic)
    repeats = after.repeats > least and after.repeats_p_value < UNKNOWN_CHANCE
    drifts = after.drift > least and after.drift_p_value < UNKNOWN_CHANCE
    if repeats or drifts:
        return "unknown"
    return of_causes(outcome.groups) if outcome.groups else "no-evidence"


def complete(blank: Diagnosis, case: Case, rng: np.random.Generator) -> Diagnosis:
    """The whole answer, in numbers and in wording."""
    data, baseline, outcome = case.data, case.baseline, case.outcome
    causes = tuple(cause_of(m, outcome, baseline, data) for m in outcome.groups)
    floor = float(np.sqrt(case.before.stroke))
    gain = gains(baseline, outcome.final, data, np.array([case.before.stroke]), rng)
    left = remainder_of(outcome.final, data, case.before, case.after)
    start = baseline.hypothesis.start
    return replace(
        blank,
        verdict=case.verdict,
        sentence=wording.sentence(case.verdict, causes, left),
        conclusion=wording.conclusion(causes, gain, left, case.blind, case.related),
        causes=causes,
        candidates=candidates_of(outcome.rounds),
        not_testable=tuple(case.blind),
        gain=gain,
        remainder=left,
        noise_floor={"sample": float(np.sqrt(case.before.sample)), "stroke": floor},
        baseline=tuple(value_of(baseline, n, start[n]) for n in baseline.hypothesis.free),
        next_experiment=wording.next_experiment(case.verdict, causes, left),
        related=case.related,
        series=series_of(baseline, outcome.final, data),
    )


# ---- causes ------------------------------------------------------------


def found_value(fitted: Fitted, name: str, old: float, data: Data) -> ParameterValue:
    """A cause's parameter. Its error is that between strokes or that between records, whichever is larger."""
    estimates = record_by_record(fitted, name, data)
    value = fitted.params[name]
    weight = sum(e.information for e in estimates)
    scatter = sum(e.information * (e.value - value) ** 2 for e in estimates)
    between = np.sqrt(scatter / weight / (len(estimates) - 1))
    return value_of(fitted, name, old, max(fitted.standard_error(name), float(between)))


def instead(
    outcome: Outcome, baseline: Fitted, members: Sequence[Trial], other: Trial, data: Data
) -> Fitted:
    """The final model with another member of one class in the place of the one that stands for it."""
    hypothesis = baseline.hypothesis
    for chosen in outcome.groups:
        effect = other.effect if chosen is members else chosen[0].effect
        hypothesis = hypothesis.with_effect(effect)
    return fit(hypothesis, data.identify)


def cause_of(members: Sequence[Trial], outcome: Outcome, baseline: Fitted, data: Data) -> Cause:
    first = members[0]
    start = data.rig.start()

    def found(m: Trial) -> tuple[ParameterValue, ...]:
        at = outcome.final if m is first else instead(outcome, baseline, members, m, data)
        return tuple(found_value(at, n, start[n], data) for n in m.effect.parameters)

    each = record_by_record(outcome.final, first.effect.parameters[0], data)
    return cause_from(members, found, {e.record: e.value for e in each})


@dataclass(frozen=True)
class RecordEstimate:
    """One parameter refitted on one record alone, all others held."""

    record: str
    value: float
    information: float
    """Sum of the squared sensitivities: its weight among the records."""


def record_by_record(fitted: Fitted, name: str, data: Data) -> list[RecordEstimate]:
    out = []
    for runs in (data.identify, data.validate):
        for number, motion in enumerate(runs.motions):
            residual, jacobian = runs.part(number).problem.evaluate(fitted.params, [name])
            column = jacobian[:, 0]
            information = max(float(column @ column), 1e-300)
            step = -float(column @ residual) / information
            out.append(RecordEstimate(motion.name, fitted.params[name] + step, information))
    return out


# ---- what is left ------------------------------------------------------------


def remainder_of(
    extended: Fitted, data: Data, before: Repeatability, after: Repeatability
) -> Remainder:
    residual = residual_of(data.validate, extended.params)
    ms = float(np.mean(residual**2))
    return Remainder(
        rms=float(np.sqrt(ms)),
        unit="N",
        share_of_excess=after.systematic / before.systematic if before.systematic > 0.0 else 0.0,
        repeats=min(after.repeats / ms, 1.0) if ms > 0.0 else 0.0,
        shares=arrangement(
            residual, data.validate.record, data.validate.inputs["direction"], after
        ),
        ripple=find_ripple(residual, data.validate),
    )
