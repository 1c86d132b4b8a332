"""`./dev trials lung FOLDER`: real faults with known truth, set by others at a test lung.

A question is a setting that is declared and a record that was measured: every different setting of the eight tests
against every record of the folder. Tests 4 and 5 set the same, and are asked about once. Where the two settings agree,
the lung is healthy; another C is a wrong compliance, another number a wrong resistor, both are two causes. What is
declared beside the setting comes from the other records (lung_calibration.py), never from the one that is judged.

An answer is right when every wrong setting is in a named cause, or in a class of at most three, and nothing else is
named; on a healthy lung when nothing is named.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table
from sms.diagnosis import Diagnosis, own
from sms.errors import InputError
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.foreign import judged
from validation.trials.lung_calibration import Calibration, calibrate, known, noise
from validation.trials.lung_model import (
    CMH2O,
    ML,
    ML_PER_CMH2O,
    TESTS,
    WINDOW,
    Known,
    Setting,
    Test,
    model,
    read_tests,
)
from validation.trials.processes import processes
from validation.trials.shares import Share, at_least, at_most, share_table, shares_as_dicts

PARAMETERS = {"compliance": "compliance", "resistor_drop": "resistor"}
"""Parameter of the model -> the effect that names a wrong setting of it."""


@dataclass(frozen=True)
class Answer:
    """One question, answered and scored."""

    declared: str
    """The setting: "C 20, R 50"."""
    measured: str
    """The record: "air1_pc_4"."""
    true: str
    """How the lung was set there."""
    hidden: list[str]
    """Effect ids of the wrong settings."""
    verdict: str
    named: list[list[str]]
    """Effect ids of each cause's members."""
    right: bool
    wrong_name: bool
    within: list[bool]
    """For each rightly named setting: whether the stated interval and that of the true value meet."""
    seconds: float


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: **./dev trials lung ../shared/data/test_lung_respiraworks --json lung.json**."
    )(lung)


def lung(
    folder: Annotated[Path, typer.Argument(help="Folder with DAY_pc_N.dat.gz.")],
    as_json: Annotated[
        Path | None, typer.Option("--json", help="File for shares and answers, for programs.")
    ] = None,
    limit: Annotated[
        int | None, typer.Option(min=1, help="Ask so many questions at the most, evenly spread.")
    ] = None,
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
) -> None:
    """Declare one setting of a test lung, give the record of another, diagnose, and count."""
    tests = read_tests(folder)
    if len(tests) < 4:
        raise InputError(
            f"{folder}: there are {len(tests)} files DAY_pc_N.dat.gz; at least three others must say what is known"
        )
    console, answers = Console(), []
    os.environ.update(SMS_THREADS="1", OPENBLAS_NUM_THREADS="1")
    with processes(workers) as pool:
        calibrations = list(pool.map(calibrate, tests))
        console.print(calibration_table(calibrations))
        jobs = [pool.submit(answer, s, t, calibrations) for s, t in questions(tests, limit)]
        for job in as_completed(jobs):
            a = job.result()
            answers.append(a)
            said = " + ".join(" | ".join(m) for m in a.named) or "-"
            mark = "right" if a.right else "WRONG NAME" if a.wrong_name else "missed"
            console.print(
                f"{a.declared} declared, {a.measured} measured ({a.true}): hidden {' + '.join(a.hidden) or 'nothing'}; "
                f"{a.verdict}: {said}; {mark} ({a.seconds:.0f} s)",
                highlight=False,
                soft_wrap=True,
            )
            if as_json is not None:
                write_text_atomically(as_json, json_text("trials", as_dict(answers)))
    console.print(share_table(shares(answers)))


def questions(tests: Sequence[Test], limit: int | None = None) -> list[tuple[Setting, Test]]:
    """Every different setting with every record; with a limit some, evenly spread."""
    every = [(setting, test) for test in tests for setting in dict.fromkeys(TESTS.values())]
    count = len(every) if limit is None else min(limit, len(every))
    return [every[k * len(every) // count] for k in range(count)]


def answer(declared: Setting, test: Test, calibrations: Sequence[Calibration]) -> Answer:
    """Diagnose one record under one declared setting, then look at how the lung was set."""
    told = known(declared, test, calibrations)
    begin = time.perf_counter()
    lung_model = model(told, noise(test, calibrations))
    diagnosis = own.diagnose_model(lung_model, test.records, WINDOW)
    seconds = time.perf_counter() - begin
    return scored(declared, test, known(test.truth, test, calibrations), diagnosis, seconds)


def scored(
    declared: Setting, test: Test, truth: dict[str, Known], diagnosis: Diagnosis, seconds: float
) -> Answer:
    """An answer against the truth. `truth`: what the other records say of a lung that is set as this one was."""
    hidden = wrong_settings(declared, test.truth)
    named = [list(dict.fromkeys(c.members)) for c in diagnosis.causes]
    right, wrong = judged([{h} for h in hidden] or [{"NOTHING"}], named, diagnosis.verdict)
    within = [
        abs(p.value - truth[p.name].value)
        <= math.hypot(1.96 * p.standard_error, truth[p.name].half_width)
        for cause in diagnosis.causes
        for p in cause.parameters
        if PARAMETERS.get(p.name) in hidden
    ]
    return Answer(
        str(declared),
        test.name,
        str(test.truth),
        hidden,
        diagnosis.verdict,
        named,
        right,
        wrong,
        within,
        seconds,
    )


def wrong_settings(declared: Setting, true: Setting) -> list[str]:
    """Effect ids."""
    return [
        *(["compliance"] if declared.compliance != true.compliance else []),
        *(["resistor"] if declared.resistor != true.resistor else []),
    ]


# ---- tables ----------------------------------------------------------------------------------------


def shares(answers: Sequence[Answer]) -> list[Share]:
    """What is counted."""
    healthy = [a for a in answers if not a.hidden]
    wrong = [a for a in answers if a.hidden]
    one, two = [a for a in wrong if len(a.hidden) == 1], [a for a in wrong if len(a.hidden) == 2]
    within = [w for a in wrong for w in a.within]

    return [
        at_least("right causes, or classes of at most three with them", [a.right for a in wrong]),
        at_least("of these, one wrong setting", [a.right for a in one]),
        at_least("of these, two wrong settings", [a.right for a in two]),
        at_most("a wrong name where a setting was wrong", [a.wrong_name for a in wrong]),
        at_most("a name on a healthy lung", [a.wrong_name for a in healthy]),
        at_least("nothing named, and no alarm, on a healthy lung", _quiet(healthy)),
        at_least("true value within the stated 95 % interval", within),
    ]


def _quiet(healthy: Sequence[Answer]) -> list[bool]:
    return [a.verdict == "no-evidence" for a in healthy]


def calibration_table(calibrations: Sequence[Calibration]) -> Table:
    """What each record says of the rig at its true setting, in the units of its protocol."""
    out = Table(
        "record",
        "set",
        "C over set",
        "drop at 0.5 l/s [cmH2O]",
        "linear share",
        "hoses [ml/cmH2O]",
        "flow zero [ml/s]",
        "left [ml]",
    )
    for c in calibrations:
        out.add_row(
            c.test,
            str(c.setting),
            f"{c.compliance_ratio:.3f}",
            f"{c.resistor_drop / CMH2O:.2f}",
            f"{c.linear_share:.2f}",
            f"{c.circuit_compliance / ML_PER_CMH2O:.2f}",
            f"{c.flow_zero / ML:.1f}",
            f"{c.rms / ML:.1f}",
        )
    return out


def as_dict(answers: Sequence[Answer]) -> dict[str, Any]:
    """Shares and answers for programs."""
    rows = [asdict(a) for a in sorted(answers, key=lambda a: (a.measured, a.declared))]
    return {"shares": shares_as_dicts(shares(answers)), "answers": rows}
