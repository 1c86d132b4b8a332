"""The method, whole: from a rig file to a verdict. One function a step, in the order they are taken."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sms import _core
from sms.diagnosis import words
from sms.diagnosis.catalogue import Effect, catalogue
from sms.diagnosis.prepare import Comparison, Motion, inputs_of, predict, prepare, with_role
from sms.diagnosis.related import related_rigs
from sms.diagnosis.ripple import find_ripple
from sms.diagnosis.result import (
    Candidate,
    Cause,
    Diagnosis,
    Finding,
    Gain,
    Member,
    NotTestable,
    ParameterValue,
    Remainder,
    Series,
    Verdict,
)
from sms.diagnosis.search import (
    Data,
    Fitted,
    Trial,
    Yardstick,
    baseline_hypothesis,
    best_class,
    fit,
    judge,
    residual_of,
    testable,
    try_effects,
)
from sms.diagnosis.statistics import (
    Ground,
    Repeatability,
    arrangement,
    interval,
    repeatability,
    resampled,
    strokes_per_block,
    weighted_ms,
)
from sms.io import check as data_check
from sms.io.errors import InputError
from sms.io.records import Record, load_record
from sms.io.rig import Rig, load_rig
from sms.parameters import PARAMETERS

MOST_CAUSES = 4
"""More are not named: with so many terms something always fits."""
UNKNOWN_SHARE = 0.2
"""Of what is systematic in the baseline's error: with more than a fifth left, the best explanation is none."""
UNKNOWN_OF_NOISE = 0.05
"""Least systematic error, as a share of the noise floor's square, that is worth the word unknown."""
UNKNOWN_CHANCE = 0.005
"""Largest chance of calling healthy data unknown, for each of the two tests."""

Progress = Callable[[str, float], None]
"""Called with what is being done and the share that is done, 0..1."""


def diagnose(path: str | os.PathLike[str], seed: int = 1, progress: Progress = lambda text, done: None) -> Diagnosis:
    """Find what the model of a rig gets wrong on its records, and why.

    InputError if the rig file or a record cannot be used. The same seed gives the same answer.
    """
    if not _core.has_estimation:
        raise InputError("this installation of sms was built without Ceres and cannot fit; "
                         "install Ceres (Debian: apt-get install libceres-dev) and then sms again")
    rng = np.random.default_rng(seed)
    progress("reading records", 0.0)
    rig = load_rig(path)
    records, findings = read_and_check(rig)
    answer = _Answer(rig, findings, {r.name: r.role for r in records}, seed)
    faults = [f for f in findings if f.severity == "error"]
    if faults:
        return answer.data_fault(faults)

    motions = [prepare(rig, record) for record in records]
    data = Data(rig, Comparison(tuple(with_role(motions, "identify"))),
                Comparison(tuple(with_role(motions, "validate"))))
    progress("fitting the baseline", 0.1)
    effects = catalogue()
    data = in_blocks(data, fit(baseline_hypothesis(data, effects), data.identify))
    baseline = fit(baseline_hypothesis(data, effects), data.identify)
    able, blind = testable(baseline, data, effects)
    before = repeats_of(baseline, data, rng)
    outcome = find_causes(baseline, data, able, before, rng, progress)

    progress("judging what is left", 0.85)
    after = repeats_of(outcome.final, data, rng)
    verdict = decide(outcome, before, after)
    if verdict == "unknown":
        outcome = Outcome(baseline, [], outcome.candidates)
        after = before
    progress("comparing related rigs", 0.9)
    related = related_rigs(rig, outcome.final, effects)
    return answer.complete(data, motions, baseline, outcome, verdict, blind, before, after, related, rng)


# ---- reading ---------------------------------------------------------------------------------------------------


def read_and_check(rig: Rig) -> tuple[list[Record], tuple[Finding, ...]]:
    """The records, and what the data check says. InputError for what cannot be read as a record at all.

    A channel that can be read but cannot be true (stuck, saturated, beyond its range) is an error among the
    findings: the answer to it is the verdict data-fault.
    """
    data_check.raise_if_unusable(data_check.check_rig(rig))
    records, findings = [], []
    for source in rig.records:
        record = load_record(rig, source)
        found = data_check.check_record(rig, record)
        data_check.raise_if_unusable(
            [f for f in found if f in record.findings or f.signal in ("time", None)])
        records.append(record)
        findings += [Finding(f.severity, f.file.name, f.line, f.signal, f.message, f.remedy) for f in found]
    return records, tuple(findings)


def in_blocks(data: Data, baseline: Fitted) -> Data:
    """The records with as many strokes in a block as the noise of the baseline's residual asks for."""
    def with_blocks(comparison: Comparison) -> Comparison:
        inputs = comparison.inputs
        ground = Ground.of(comparison.record, comparison.stroke, inputs["extension [m]"], inputs["direction"])
        noise = ground.without_repeats(residual_of(comparison, baseline.params))
        return replace(comparison, strokes_per_block=strokes_per_block(noise, comparison.record, comparison.stroke))

    return replace(data, identify=with_blocks(data.identify), validate=with_blocks(data.validate))


# ---- the search --------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Outcome:
    """What the rounds brought: the final model, one class of trials for each cause, all candidates tried."""

    final: Fitted
    classes: list[list[Trial]]
    candidates: list[Candidate]


def repeats_of(fitted: Fitted, data: Data, rng: np.random.Generator) -> Repeatability:
    """How much of a model's error on the validate records repeats from stroke to stroke."""
    v = data.validate
    return repeatability(residual_of(v, fitted.params), v.record, v.stroke, v.inputs["extension [m]"],
                         v.inputs["direction"], rng)


def find_causes(baseline: Fitted, data: Data, effects: Sequence[Effect], before: Repeatability,
                rng: np.random.Generator, progress: Progress) -> Outcome:
    """Rounds until nothing more is found: the best effect joins the model, with those that look alike."""
    yardstick = Yardstick(float(np.mean(residual_of(data.validate, baseline.params) ** 2)), before.stroke)
    current, classes, candidates = baseline, [], []
    remaining = list(effects)
    for number in range(1, MOST_CAUSES + 1):
        progress(f"round {number}: {len(remaining)} effects", 0.1 + 0.75 * number / (MOST_CAUSES + 1))
        if not remaining:
            break
        trials = try_effects(current, data, remaining, rng)
        judge(trials, current, data, yardstick, rng)
        members = best_class(trials, data, rng)
        candidates += [candidate_of(t, number, members) for t in trials]
        if not members:
            break
        classes.append(members)
        current = members[0].fitted
        gone = {m.effect.key for m in members}
        remaining = [e for e in remaining if e.key not in gone]
    return Outcome(current, classes, candidates)


def decide(outcome: Outcome, before: Repeatability, after: Repeatability) -> Verdict:
    """One of the verdicts, data-fault aside."""
    least = max(UNKNOWN_OF_NOISE * after.stroke, UNKNOWN_SHARE * before.systematic)
    repeats = after.repeats > least and after.repeats_p_value < UNKNOWN_CHANCE
    drifts = after.drift > least and after.drift_p_value < UNKNOWN_CHANCE
    if repeats or drifts:
        return "unknown"
    if not outcome.classes:
        return "no-evidence"
    if len(outcome.classes) > 1:
        return "combination"
    return "cause" if len(outcome.classes[0]) == 1 else "class"


# ---- putting it into words and numbers -----------------------------------------------------------------------------


def value_of(fitted: Fitted, name: str, old: float) -> ParameterValue:
    error = fitted.standard_error(name) if name in fitted.hypothesis.free else 0.0
    return ParameterValue(name, fitted.params[name], error, PARAMETERS[name].unit, old)


def found_value(fitted: Fitted, name: str, old: float, data: Data) -> ParameterValue:
    """A cause's parameter. Its error is that between strokes or that between records, whichever is larger."""
    estimates = record_by_record(fitted, name, data)
    value = fitted.params[name]
    weight = sum(e.information for e in estimates)
    scatter = sum(e.information * (e.value - value) ** 2 for e in estimates)
    between = np.sqrt(scatter / weight / (len(estimates) - 1))
    return ParameterValue(name, value, max(fitted.standard_error(name), float(between)), PARAMETERS[name].unit, old)


def _values(trial: Trial, rig_start: _core.Params) -> tuple[ParameterValue, ...]:
    return tuple(value_of(trial.fitted, n, rig_start[n]) for n in trial.effect.parameters)


def candidate_of(trial: Trial, number: int, members: Sequence[Trial]) -> Candidate:
    reason = trial.reason
    if trial.accepted:
        reason = ("the best explanation of this round, or not to be told from it" if trial in members
                  else "explains less than the best of this round; tried again in the next")
    return Candidate(number, trial.effect.id, trial.effect.signal, _values(trial, trial.fitted.hypothesis.start),
                     trial.p_value, trial.gain, *trial.gain_interval, trial in members, reason)


def instead(outcome: Outcome, baseline: Fitted, members: Sequence[Trial], other: Trial, data: Data) -> Fitted:
    """The final model with another member of one class in the place of the one that stands for it."""
    hypothesis = baseline.hypothesis
    for chosen in outcome.classes:
        effect = other.effect if chosen is members else chosen[0].effect
        hypothesis = hypothesis.with_effect(effect)
    return fit(hypothesis, data.identify)


def cause_of(members: Sequence[Trial], outcome: Outcome, baseline: Fitted, data: Data) -> Cause:
    first = members[0]
    start = _core.Params(**{n: d.value for n, d in data.rig.parameters.items()})
    final = tuple(found_value(outcome.final, n, start[n], data) for n in first.effect.parameters)
    return Cause(
        effect=first.effect.id,
        signal=first.effect.signal,
        kind="missing term" if first.effect.kind == "missing" else "shifted parameter",
        block=first.effect.block,
        title=first.effect.title,
        explanation=first.effect.cause,
        members=tuple(dict.fromkeys(m.effect.id for m in members)),
        alternatives=tuple(
            Member(m.effect.id, m.effect.signal, m.effect.title,
                   tuple(found_value(instead(outcome, baseline, members, m, data), n, start[n], data)
                         for n in m.effect.parameters),
                   first.similarity[m.effect.key])
            for m in members[1:]),
        parameters=final,
        p_value=first.p_value,
        consistency={e.record: e.value for e in record_by_record(outcome.final, first.effect.parameters[0], data)},
        separated_by=" ".join(dict.fromkeys(m.effect.separated_by for m in members)) if len(members) > 1 else "",
    )


@dataclass(frozen=True)
class RecordEstimate:
    """One parameter refitted on one record alone, all others held."""

    record: str
    value: float
    information: float
    """Sum of the squared sensitivities: its weight among the records."""


def record_by_record(fitted: Fitted, name: str, data: Data) -> list[RecordEstimate]:
    out = []
    for comparison in (data.identify, data.validate):
        for number, motion in enumerate(comparison.motions):
            residual, jacobian = comparison.part(number).problem.evaluate(fitted.params, [name])
            column = jacobian[:, 0]
            information = max(float(column @ column), 1e-300)
            step = -float(column @ residual) / information
            out.append(RecordEstimate(motion.name, fitted.params[name] + step, information))
    return out


def gains(baseline: Fitted, extended: Fitted, data: Data, floor: float, rng: np.random.Generator) -> tuple[Gain, ...]:
    """What the extension is worth on each validate record."""
    out = []
    for number, motion in enumerate(data.validate.motions):
        part = data.validate.part(number)
        b = residual_of(part, baseline.params) ** 2
        e = residual_of(part, extended.params) ** 2
        counts = resampled(part.record, part.block, rng)
        reduction = 1.0 - np.sqrt(weighted_ms(e, part.block, counts) / weighted_ms(b, part.block, counts))
        rms_b, rms_e = float(np.sqrt(np.mean(b))), float(np.sqrt(np.mean(e)))
        out.append(Gain(motion.name, "rod_force", "N", rms_b, rms_e, floor, 1.0 - rms_e / rms_b,
                        *interval(reduction)))
    return tuple(out)


def remainder_of(extended: Fitted, data: Data, before: Repeatability, after: Repeatability) -> Remainder:
    residual = residual_of(data.validate, extended.params)
    ms = float(np.mean(residual**2))
    return Remainder(
        rms=float(np.sqrt(ms)),
        unit="N",
        share_of_excess=after.systematic / before.systematic if before.systematic > 0.0 else 0.0,
        repeats=min(after.repeats / ms, 1.0) if ms > 0.0 else 0.0,
        shares=arrangement(residual, data.validate.record, data.validate.inputs["direction"], after),
        ripple=find_ripple(residual, data.validate),
    )


def series_of(motion: Motion, baseline: Fitted, extended: Fitted) -> Series:
    return Series(motion.name, motion.role, "rod_force", "N", motion.time, motion.signals["rod_force"],
                  predict(motion, baseline.params), predict(motion, extended.params), motion.used,
                  inputs_of(motion))


@dataclass(frozen=True)
class _Answer:
    """The parts of a Diagnosis that are known before anything is fitted."""

    rig: Rig
    findings: tuple[Finding, ...]
    records: dict[str, str]
    seed: int

    def data_fault(self, faults: Sequence[Finding]) -> Diagnosis:
        return self._diagnosis("data-fault", words.data_fault(faults))

    def complete(self, data: Data, motions: Sequence[Motion], baseline: Fitted, outcome: Outcome, verdict: Verdict,
                 blind: Sequence[NotTestable], before: Repeatability, after: Repeatability,
                 related: tuple[words.Related, ...], rng: np.random.Generator) -> Diagnosis:
        causes = tuple(cause_of(m, outcome, baseline, data) for m in outcome.classes)
        floor = float(np.sqrt(before.stroke))
        gain = gains(baseline, outcome.final, data, floor, rng)
        remainder = remainder_of(outcome.final, data, before, after)
        start = baseline.hypothesis.start
        return self._diagnosis(
            verdict,
            words.sentence(verdict, causes, remainder),
            conclusion=words.conclusion(verdict, causes, gain, remainder, blind, related),
            causes=causes,
            candidates=tuple(outcome.candidates),
            not_testable=tuple(blind),
            gain=gain,
            remainder=remainder,
            noise_floor={"sample": float(np.sqrt(before.sample)), "stroke": floor},
            baseline=tuple(value_of(baseline, n, start[n]) for n in baseline.hypothesis.free),
            next_experiment=words.next_experiment(verdict, causes, remainder),
            related=related,
            series=tuple(series_of(m, baseline, outcome.final) for m in motions),
        )

    def _diagnosis(self, verdict: Verdict, sentence: str, **parts: object) -> Diagnosis:
        known: dict[str, object] = {
            "conclusion": (), "causes": (), "candidates": (), "not_testable": (), "gain": (), "remainder": None,
            "noise_floor": {}, "baseline": (), "next_experiment": None, "related": (), "series": (),
        }
        versions = {"sms": _core.__version__, "core": _core.build_info, "python": platform.python_version(),
                    "numpy": np.__version__}
        return Diagnosis(rig=Path(self.rig.path).name, title=self.rig.title, verdict=verdict, sentence=sentence,
                         findings=self.findings, records=self.records, seed=self.seed, versions=versions,
                         **(known | parts))  # type: ignore[arg-type]
