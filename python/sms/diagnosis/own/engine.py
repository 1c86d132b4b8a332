"""An own model in the diagnosis: the search and the judgement are those of this project's rigs (simulated.py)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path

import numpy as np

from sms.callbacks import Progress
from sms.diagnosis import preparation, simulated, wording
from sms.diagnosis.own.answer import Answer, extended_model, parameters_text
from sms.diagnosis.own.as_rig import (
    effect_of,
    kind_of,
    noise_of,
    problem_of,
    rig_of,
    run_of,
    values_of,
    with_states,
)
from sms.diagnosis.own.curve_term import with_curve
from sms.diagnosis.own.determinacy import at_bounds, undetermined
from sms.diagnosis.own.model import Model
from sms.diagnosis.own.records import Record, check
from sms.diagnosis.own.wording import where_it_acts
from sms.diagnosis.result import Diagnosis, as_json
from sms.diagnosis.simulated import Case
from sms.diagnosis.thresholds import FEWEST_WINDOWS
from sms.errors import InputError
from sms.io.json_files import versions
from sms.io.write import write_text_atomically
from sms.report.diagnosis import report_html
from sms.report.files import header_of
from sms.report.page import write_page
from sms.rigs.threads import one_thread_for_matrices


@one_thread_for_matrices()
def diagnose_model(
    model: Model,
    records: Sequence[Record],
    window: float,
    seed: int = 1,
    progress: Progress = lambda text, done: None,
    empirical: bool = False,
) -> Answer:
    """Find what a model gets wrong on its records, and why: the answer that `diagnose` gives for a rig file.

    window: s, how long it is simulated from one initial state; a few of the plant's own time constants, and a tenth of
    a record or less, since windows are what judgements count. seed and empirical as in `diagnose`. InputError for
    records that do not fit the model.
    """
    if not window > 0.0:
        raise InputError(f"{model.title}: window is {window:g} s; it must be positive")
    findings = check(model, records)
    blank = Diagnosis(
        rig=model.title,
        title=model.title,
        findings=findings,
        records={r.name: r.role for r in records},
        seed=seed,
        versions=versions(),
    )
    if faults := [f for f in findings if f.severity == "error"]:
        blank = replace(blank, verdict="data-fault", sentence=wording.data_fault(faults))
        return _answer(blank, model, None)
    rng = np.random.default_rng(seed)
    runs = [run_of(model, record) for record in records]
    noise = noise_of(model, runs)
    model = problem_of(model, runs, noise, window).with_fine_step()
    data = preparation.split(rig_of(model), kind_of(model, window, noise), runs, noise)
    if spoilt := preparation.without_windows(data):
        blank = replace(blank, verdict="data-fault", sentence=wording.data_fault(spoilt))
        return _answer(replace(blank, findings=(*findings, *spoilt)), model, None)
    fewest = min(len(part.problem.windows) for part in (data.identify, data.validate))
    if fewest < FEWEST_WINDOWS:
        raise InputError(
            f"{model.title}: the records of one role make {fewest} windows of {window:g} s; "
            f"{FEWEST_WINDOWS} are the least that can be judged on, so take a shorter window or more records"
        )
    effects = tuple(effect_of(model, effect) for effect in model.effects)
    case = simulated.investigate(data, effects, rng, progress)
    case = replace(case, data=with_states(data, model, window, values_of(case.baseline)))
    found = simulated.complete(blank, case, rng, progress, empirical)
    return _answer(_all_said(found, model, case), model, _extended(model, found))


def _extended(model: Model, found: Diagnosis) -> Model | None:
    if found.causes:
        return extended_model(model, found)
    if found.empirical is None:
        return None
    at_baseline = model.with_values({p.name: p.value for p in found.baseline})
    return with_curve(at_baseline, found.empirical.shape)


def _all_said(found: Diagnosis, model: Model, case: Case) -> Diagnosis:
    """With what the baseline cannot tell of its parameters, and where a missing term acts."""
    left_open = undetermined(model, case.baseline)
    unknown = {name for u in left_open for name in u.parameters}
    told = [u.sentence for u in left_open]
    if found.verdict == "unknown" and found.hidden is not None:
        told += where_it_acts(found.hidden.shape)
    return replace(
        found,
        findings=(*found.findings, *at_bounds(model, case.baseline)),
        conclusion=(*found.conclusion, *told),
        baseline=tuple(p for p in found.baseline if p.name not in unknown),
        refitted=tuple(p for p in found.refitted if p.name not in unknown),
        undetermined=left_open,
    )


def _answer(found: Diagnosis, model: Model, extended: Model | None) -> Answer:
    plain = {f.name: getattr(found, f.name) for f in fields(Diagnosis)}
    return Answer(**plain, model=model, extended=extended)


def write_diagnosis(diagnosis: Diagnosis, out: Path) -> tuple[Path, Path]:
    """report.html and diagnosis.json in the folder `out`, made if need be.

    With causes also extended.toml, the values of the extended model (`read_parameters`).
    """
    page, data = out / "report.html", out / "diagnosis.json"
    write_page(page, report_html(diagnosis))
    write_text_atomically(data, as_json(diagnosis))
    if isinstance(diagnosis, Answer) and diagnosis.extended is not None and diagnosis.causes:
        text = parameters_text(diagnosis.extended, header_of(diagnosis))
        write_text_atomically(out / "extended.toml", text)
    return page, data
