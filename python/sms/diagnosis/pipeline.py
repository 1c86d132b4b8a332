"""The method, whole: from a rig file to a verdict, in the order the steps are taken."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sms import _core
from sms.diagnosis import wording
from sms.diagnosis.adequacy.repeatability import Repeatability
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.evidence import candidates_of, cause_of, gains, remainder_of, series_of, value_of
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis, fit
from sms.diagnosis.preparation import make_data
from sms.diagnosis.related_rigs import related_rigs
from sms.diagnosis.result import Diagnosis, Finding, NotTestable, Related, Verdict
from sms.diagnosis.selection.forward_selection import (
    Progress,
    decide,
    forward_selection,
    repeats_of,
)
from sms.diagnosis.selection.identifiability import identifiable
from sms.diagnosis.selection.outcome import Outcome
from sms.diagnosis.simulated import diagnose_plant
from sms.errors import InputError
from sms.io import check as data_check
from sms.io.records import Record, load_record
from sms.io.rig import Rig, load_rig
from sms.io.thinning import raise_if_too_many, thinned
from sms.rigs.kinds import KINDS


def diagnose(
    path: str | os.PathLike[str],
    seed: int = 1,
    progress: Progress = lambda text, done: None,
    empirical: bool = False,
) -> Diagnosis:
    """Find what the model of a rig gets wrong on its records, and why.

    path is a rig file. The same seed gives the same answer. empirical: where the verdict is unknown, measure what the
    curve of the missing term is worth as an empirical one. InputError if the rig file or a record cannot be used.
    """
    if not _core.has_estimation:
        raise InputError(
            "this installation of sms was built without Ceres and cannot fit; "
            "install Ceres (Debian: apt-get install libceres-dev) and then sms again"
        )
    rng = np.random.default_rng(seed)
    progress("reading records", 0.0)
    rig = load_rig(path)
    if empirical and rig.kind == "cylinder":
        raise InputError(
            f"{rig.path}: a cylinder's force balance carries no empirical term; leave --empirical out"
        )
    effects = effects_of(rig)
    records, findings = read_and_check(rig)
    blank = blank_answer(rig, records, findings, seed)
    faults = [f for f in findings if f.severity == "error"]
    if faults:
        return replace(blank, verdict="data-fault", sentence=wording.data_fault(faults))

    if rig.kind != "cylinder":
        return diagnose_plant(rig, records, blank, rng, progress, empirical)

    progress("fitting the baseline", 0.1)
    data = make_data(rig, records)
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
    related = related_rigs(rig, outcome.final, effects)
    case = Case(data, baseline, outcome, verdict, blind, before, after, related)
    return complete(blank, case, rng)


# ---- reading -------------------------------------------------------------------------------------


def read_and_check(rig: Rig) -> tuple[list[Record], tuple[Finding, ...]]:
    """The records, and what the data check says. InputError for what cannot be read as a record at all.

    A channel that can be read but cannot be true (stuck, saturated, beyond its range) is an error among the
    findings: the answer to it is the verdict data-fault.
    """
    data_check.raise_if_unusable(data_check.check_rig(rig))
    records, findings = [], []
    for source in rig.records:
        record = load_record(rig, source)
        record = thinned(record) if rig.kind in KINDS else record
        found = data_check.check_record(rig, record)
        data_check.raise_if_unreadable(record, found)
        records.append(record)
        findings += [
            Finding(f.severity, f.file.name, f.line, f.signal, f.message, f.remedy) for f in found
        ]
    if rig.kind in KINDS:
        raise_if_too_many(rig, records)
    return records, tuple(findings)


# ---- the answer ----------------------------------------------------------------------------------


def blank_answer(
    rig: Rig, records: Sequence[Record], findings: tuple[Finding, ...], seed: int
) -> Diagnosis:
    """The parts of an answer that are known before anything is fitted."""
    versions = {
        "sms": _core.__version__,
        "core": _core.build_info,
        "python": platform.python_version(),
        "numpy": np.__version__,
    }
    return Diagnosis(
        rig=rig.path.name,
        title=rig.title,
        findings=findings,
        records={r.name: r.role for r in records},
        seed=seed,
        versions=versions,
        command=wording.of_command(rig) if rig.kind in KINDS else "",
    )


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
