"""The method, whole: from a rig file to a verdict, in the order the steps are taken."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sms import _core
from sms.callbacks import Progress
from sms.diagnosis import simulated, strokes, wording
from sms.diagnosis.adequacy.misdeclared_signals import misdeclared_signals, of_another_machine
from sms.diagnosis.effects.catalogue import Effect, effects_of
from sms.diagnosis.hypothesis import Data, baseline_hypothesis
from sms.diagnosis.preparation import make_data, without_windows
from sms.diagnosis.result import Diagnosis, Finding
from sms.errors import InputError
from sms.io import check as data_check
from sms.io.json_files import input_hashes, versions
from sms.io.measured import declared_of, measured_time
from sms.io.records import Finding as FindingInFile
from sms.io.records import Record, load_record
from sms.io.rig import Rig, load_rig
from sms.io.thinning import raise_if_too_many, thinned
from sms.rigs.kinds import KINDS
from sms.rigs.threads import one_thread_for_matrices, threads


@one_thread_for_matrices()
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
    threads()  # what is wrong with it is no fault of a record
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

    data = make_data(rig, records)
    if rig.kind == "cylinder":
        return strokes.complete(blank, strokes.investigate(data, effects, rng, progress), rng)
    progress("asking whether a signal is declared wrongly", 0.02)
    asked = declared_wrongly(data, effects)
    blank = replace(blank, findings=(*findings, *asked))
    if faults := [f for f in asked if f.severity == "error"]:
        return replace(blank, verdict="data-fault", sentence=wording.data_fault(faults))
    case = simulated.investigate(data, effects, rng, progress)
    return simulated.complete(blank, case, rng, progress, empirical)


# ---- reading -------------------------------------------------------------------------------------


def read_and_check(rig: Rig) -> tuple[list[Record], tuple[Finding, ...]]:
    """The records, and what the data check says. InputError for what cannot be read as a record at all.

    A channel that can be read but cannot be true (stuck, saturated, beyond its range) is an error among the
    findings: the answer to it is the verdict data-fault.
    """
    of_rig = data_check.check_rig(rig)
    data_check.raise_if_unusable(of_rig)
    records: list[Record] = []
    findings = [_as_told(f) for f in of_rig]
    for source in rig.records:
        record = load_record(rig, source)
        record = thinned(record) if rig.kind in KINDS else record
        found = data_check.check_record(rig, record)
        data_check.raise_if_unreadable(record, found)
        records.append(record)
        findings += [_as_told(f) for f in found]
    if rig.kind in KINDS:
        raise_if_too_many(rig, records)
    return records, tuple(findings)


def _as_told(found: FindingInFile) -> Finding:
    """As it stands in the answer."""
    return Finding(
        found.severity, found.file.name, found.line, found.signal, found.message, found.remedy
    )


def declared_wrongly(data: Data, effects: Sequence[Effect]) -> tuple[Finding, ...]:
    """What the declared model itself says of the records: a signal that is not what it is called (an error), or
    another machine (a warning). InputError for a kind of rig that cannot be diagnosed."""
    if faults := without_windows(data):
        return faults
    start = baseline_hypothesis(data, effects).start
    return misdeclared_signals(data, start) or of_another_machine(data, start)


def blank_answer(
    rig: Rig, records: Sequence[Record], findings: tuple[Finding, ...], seed: int
) -> Diagnosis:
    """The parts of an answer that are known before anything is fitted."""
    measured, measured_from = measured_time(rig)
    return Diagnosis(
        rig=rig.path.name,
        title=rig.title,
        notes=rig.notes,
        findings=findings,
        records={r.name: r.role for r in records},
        seed=seed,
        versions=versions(),
        inputs=input_hashes(rig.files),
        kind=rig.kind,
        measured=measured,
        measured_from=measured_from,
        declared=declared_of(rig),
        command=wording.of_command(rig) if rig.kind in KINDS else "",
    )
