"""The method on records that a simulation is held against: tank, bench, platform, and a model of one's own.

The unit of judgement is a window, simulated from its own initial state; the noise is declared; and where an error comes
from is asked of hidden inputs in the equations (localisation/unknown_inputs.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sms.arrays import Array
from sms.callbacks import Progress
from sms.diagnosis.adequacy.hysteresis import Hysteresis
from sms.diagnosis.adequacy.lack_of_fit import LackOfFit, lack_of_fit
from sms.diagnosis.adequacy.parameter_constancy import Inconstancy
from sms.diagnosis.adequacy.record_consistency import Inconsistency, inconsistency
from sms.diagnosis.adequacy.residual_energy import (
    Left,
    differs_when_well,
    energies,
    excess,
    nothing_left,
    small,
    tolerated,
)
from sms.diagnosis.adequacy.subset_estimates import found_value, record_by_record
from sms.diagnosis.adequacy.systematic_error import better_predicting, generalised, sized
from sms.diagnosis.adequacy.verdict import decide, inconstancy_of
from sms.diagnosis.design.closed_loop_performance import in_use
from sms.diagnosis.design.next_experiment import next_experiment
from sms.diagnosis.design.still_hidden import still_hidden
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.evidence import candidates_of, cause_from, gains, series_of, value_of
from sms.diagnosis.fitting import fit, nuisance_of
from sms.diagnosis.free_run import free_runs
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.localisation.empirical_term import empirical_of
from sms.diagnosis.localisation.equation_error import fed_equations
from sms.diagnosis.localisation.residual_spectrum import symptoms_of
from sms.diagnosis.localisation.unknown_inputs import estimate_unknown_inputs
from sms.diagnosis.other_records import unseen
from sms.diagnosis.reference import from_reference
from sms.diagnosis.remainder import FedEquations, Hidden, Unexplained
from sms.diagnosis.result import Cause, Diagnosis, NotTestable, ParameterValue, Verdict
from sms.diagnosis.selection.backward_elimination import without_insignificant, without_untenable
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.identifiability import identifiable
from sms.diagnosis.selection.next_best import next_best
from sms.diagnosis.selection.outcome import Outcome
from sms.diagnosis.selection.stepwise import stepwise_selection
from sms.diagnosis.thresholds import EXPLAINS
from sms.diagnosis.wording_simulated import (
    conclusion,
    nearest_in_words,
    remainder_in_words,
    sentence,
    sentence_of_inconsistency,
    still_hidden_in_words,
    words_of_inconsistency,
)
from sms.parameters import MAPS, common_parameter


@dataclass(frozen=True)
class Case:
    """Everything the steps brought."""

    data: Data
    baseline: Fitted
    outcome: Outcome
    before: LackOfFit
    after: LackOfFit
    tolerated: Array
    """(channels,): mean square beyond the noise, in its units, that is not practically significant."""
    blind: Sequence[NotTestable]
    able: Sequence[Effect]
    """The effects that these records can show."""
    verdict: Verdict
    inconsistency: Inconsistency | None = None
    """With the verdict data-fault."""
    inconstancy: Inconstancy | Hysteresis | None = None
    """What speaks against the nearest explanation, with the verdict unknown."""

    @property
    def final(self) -> Fitted:
        """The model that the answer stands for: the baseline where nothing is named."""
        return self.outcome.final if self.outcome.named else self.baseline

    def of_member(self, trial: Trial, members: Sequence[Trial]) -> Fitted:
        """The model from which the size of a member of a class is stated: its first one stands in the final model."""
        return self.outcome.final if trial is members[0] else sized(trial.fitted, self.data)

    def where(self, rng: np.random.Generator) -> Hidden:
        """Which equation the baseline's error comes from, by hidden inputs in the simulation."""
        return _hidden(self.baseline, self.data, self.before, rng)

    def fed(self, rng: np.random.Generator) -> FedEquations | None:
        """The same with each equation fed with measured signals; None for a kind without such equations."""
        runs = self.data.identify
        return fed_equations(runs, self.baseline, rng)


def investigate(
    data: Data, effects: Sequence[Effect], rng: np.random.Generator, progress: Progress
) -> Case:
    """Baseline, rounds and verdict: all that a trial needs."""
    progress("fitting the baseline", 0.05)
    declared = hypothesis = baseline_hypothesis(data, effects)
    if data.reference is not None:
        hypothesis, data = from_reference(hypothesis, data)
    else:
        data = data.timed(hypothesis.start)  # what is declared has the first word (reference.py)
        data = data.timed(fit(hypothesis, data.identify).params)
    baseline = fit(hypothesis, data.identify, discrepancy=data.allowed(data.identify))
    progress("looking which effects can be seen", 0.15)
    able, blind = identifiable(baseline, data, effects)
    least = tolerated(baseline, data) if data.healthy is None else differs_when_well(data)

    def enough(fitted: Fitted) -> bool:
        left = Left.by(fitted, data)
        return small(left, least) or nothing_left(left, data)

    outcome = stepwise_selection(baseline, data, able, rng, progress, least)
    if outcome.found:
        progress("estimating sizes beside what no parameter explains", 0.8)
    final, outcome = _with_sizes(outcome, baseline, data, least)
    adequate = enough(outcome.final)
    found = law = None
    if outcome.found:
        law = inconstancy_of(outcome, data, adequate)
        outcome = replace(outcome, final=final, named=law is None)
    before, after = lack_of_fit(baseline, data), lack_of_fit(outcome.final, data)
    if not adequate and not outcome.groups and not outcome.explained_by_one(EXPLAINS):
        # An error of the tables would take a part of what one record has of its own; and records that contradict each
        # other do so whatever the machine was like before.
        plain = fit(declared.with_exact_maps, data.identify)
        found = inconsistency(plain, data.as_declared, able, before.floor)
    verdict = decide(outcome, adequate) if found is None else "data-fault"
    return Case(data, baseline, outcome, before, after, least, blind, able, verdict, found, law)


def _with_sizes(
    outcome: Outcome, baseline: Fitted, data: Data, least: Array
) -> tuple[Fitted, Outcome]:
    """The final model by generalised least squares, and the causes that stand in it. Of a single cause that does not,
    the next best takes the place.
    """
    final, standing = _standing(outcome, baseline, data, least)
    while len(outcome.found) == 1 and not standing.found:
        other = next_best(standing, baseline, data)
        if other is None:
            break
        outcome = other
        final, standing = _standing(outcome, baseline, data, least)
    return final, standing


def _standing(
    outcome: Outcome, baseline: Fitted, data: Data, least: Array
) -> tuple[Fitted, Outcome]:
    """The final model, and the causes whose sizes in it are beyond what is declared: by either estimate of what no
    parameter explains.
    """
    final = generalised(outcome.final, data) if outcome.found else outcome.final
    while (
        outcome.found and (fewer := without_untenable(outcome, final, baseline, data)) is not None
    ):
        outcome = fewer
        final = generalised(outcome.final, data) if outcome.found else outcome.final
    outcome = without_insignificant(outcome, final, baseline, data, least)
    if not outcome.found:
        return outcome.final, outcome
    stated = better_predicting(final, outcome.final, data)
    outcome = without_insignificant(outcome, stated, baseline, data, least)
    return stated if outcome.found else outcome.final, outcome


def complete(
    blank: Diagnosis,
    case: Case,
    rng: np.random.Generator,
    progress: Progress,
    empirical: bool = False,
) -> Diagnosis:
    """The whole answer, in numbers and in words; `empirical` asks for the curve of an unknown as a term."""
    data, baseline, final = case.data, case.baseline, case.final
    causes = tuple(_cause(members, case) for members in case.outcome.groups)
    progress("asking which equation is wrong", 0.85)
    hidden, fed = case.where(rng), case.fed(np.random.default_rng(blank.seed))
    left = _hidden(final, data, case.after, rng) if causes else None
    gain = gains(baseline, final, data, case.after.floor, rng)
    curve = None
    if empirical and case.verdict == "unknown":
        progress("measuring what the curve of the unknown is worth", 0.88)
        curve = empirical_of(baseline, data, hidden.shape, case.before.floor, rng)
    progress("choosing the next experiment", 0.9)
    classes = [[m.effect for m in members] for members in case.outcome.groups]
    unseen = [members[0].effect for members in case.outcome.groups if members[0].cross_validated]
    start = baseline.hypothesis.start
    answer = replace(
        blank,
        verdict=case.verdict,
        causes=causes,
        candidates=candidates_of(case.outcome.rounds),
        not_testable=tuple(case.blind),
        still_hidden=still_hidden(baseline, data, case.able)
        if case.verdict == "no-evidence"
        else (),
        symptoms=symptoms_of(baseline, data, case.before.floor),
        gain=gain,
        free_run=free_runs(baseline, final, data),
        in_use=in_use(data.rig, baseline.params, final.params) if causes else (),
        hidden=hidden,
        fed=fed,
        hidden_left=left,
        remainder=_unexplained(case, left or hidden),
        empirical=curve,
        noise_floor={},
        baseline=tuple(value_of(baseline, n, start[n]) for n in baseline.hypothesis.free),
        refitted=_beside(final, causes),
        next_experiment=next_experiment(case.verdict, classes, final, data, hidden, unseen),
        series=series_of(baseline, case.final, data),
    )
    return _with_words(answer, case, hidden)


def _unexplained(case: Case, hidden: Hidden) -> Unexplained:
    """What the model that the answer stands for leaves; `hidden` says where that is."""
    runs, before, after = case.data.validate, case.before, case.after
    left = energies(runs, unseen(case.final, case.data)).mean(axis=0)
    scale = [runs.noise[c] for c in runs.channels]

    def rms(squares: Array) -> dict[str, float]:
        return {
            c: float(s * np.sqrt(q)) for c, s, q in zip(runs.channels, scale, squares, strict=True)
        }

    was = excess(energies(runs, unseen(case.baseline, case.data)))
    share = excess(energies(runs, unseen(case.final, case.data))) / max(was, 1e-12)
    floor = np.maximum(np.minimum(before.floor, after.floor), 1.0)
    practically_significant = not small(Left.by(case.final, case.data), case.tolerated)
    found = Unexplained(
        rms(left),
        rms(floor),
        rms(_as_residual(case)),
        float(np.clip(share, 0.0, 1.0)),
        practically_significant,
        hidden.equation,
        hidden.shape.signal,
        hidden.shape,
        "",
    )
    units = {c: runs.kind.units[c] for c in runs.channels}
    return replace(found, sentence=remainder_in_words(found, units))


def _as_residual(case: Case) -> Array:
    """(channels,): what is tolerated, as mean square in units of the noise."""
    healthy = case.data.healthy
    return case.tolerated if healthy is None else healthy.plain * (1.0 + case.tolerated)


def _with_words(answer: Diagnosis, case: Case, hidden: Hidden) -> Diagnosis:
    """The answer's numbers as sentences, and what the records themselves have against each other as a finding."""
    table, nearest = case.data.rig.table, ""
    if case.outcome.found:
        effect, law = case.outcome.found[0][0].effect, case.inconstancy
        nearest = nearest_in_words(effect, law, case.before, case.after, table)
    findings, said = answer.findings, sentence(case.verdict, answer.causes, hidden)
    if case.inconsistency is not None:
        named = words_of_inconsistency(case.inconsistency, case.data.rig.path.name)
        findings, said = (*findings, named), sentence_of_inconsistency(case.inconsistency)
    concluded = conclusion(
        case.verdict,
        answer.causes,
        answer.gain,
        hidden,
        answer.fed,
        answer.hidden_left,
        case.before,
        case.after,
        nearest,
    )
    if answer.still_hidden:
        concluded = (*concluded, still_hidden_in_words(answer.still_hidden))
    left = answer.remainder
    if isinstance(left, Unexplained) and answer.causes:
        concluded = (*concluded, left.sentence)
    return replace(answer, findings=findings, sentence=said, conclusion=concluded)


# ---- causes ------------------------------------------------------------


def _cause(members: list[Trial], case: Case) -> Cause:
    data, final = case.data, case.outcome.final

    def found(m: Trial) -> tuple[ParameterValue, ...]:
        at = case.of_member(m, members)
        others = m.effect.parameters[1:]
        beside = (value_of(at, n, data.rig.declared(n).value) for n in others)
        return (found_value(at, m.effect, data), *beside)

    each = record_by_record(final, members[0].effect, data)
    return cause_from(members, found, {record: value for record, (value, _) in each.items()})


def _beside(final: Fitted, causes: Sequence[Cause]) -> tuple[ParameterValue, ...]:
    """What was fitted together with the causes: declared, and as it is now."""
    named = {p.name for cause in causes for p in cause.parameters}
    h = final.hypothesis
    return tuple(value_of(final, n, h.start[n]) for n in h.free if n not in named and causes)


# ---- where it comes from ------------------------------------------------------------


def _hidden(fitted: Fitted, data: Data, excess: LackOfFit, rng: np.random.Generator) -> Hidden:
    """Which equation is wrong, from the identify records."""
    runs = data.identify
    rows = len(runs.channel) / len(runs.channels)
    chi_square = float(np.sum(np.maximum(excess.identify, 0.0) * excess.floor)) * rows
    free = nuisance_of(fitted)
    # What is missing is looked for beside the maps, not in what they may be off by.
    free = free.without(*(n for n in free.names if common_parameter(n) in MAPS))
    return estimate_unknown_inputs(runs, free, fitted.fit.residual, fitted.params, chi_square, rng)
