"""`./dev trials foreign FOLDER`: data sets of another simulator, whose truth lies beside them in `keys/`.

That simulator shares no code with this repository and is nobody's model exactly: its flow is off by a smooth error
over the opening, its numbers lie anywhere within what the rig files declare. A set is diagnosed blind, then its key
is opened. An answer is right when every hidden effect is in a named cause, or in a class of at most three, and
nothing else is named; on a healthy machine when nothing is named; on an effect outside the catalogue when the verdict
is `unknown` and nothing is named.
"""

from __future__ import annotations

import json
import os
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import tomlkit
import typer
from rich.console import Console
from sms.diagnosis import Diagnosis, diagnose
from sms.diagnosis.result import Cause, Member
from sms.errors import InputError
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.processes import processes
from validation.trials.scoring import LARGEST_CLASS
from validation.trials.shares import Share, at_least, at_most, share_table, shares_as_dicts


class Size(NamedTuple):
    """How a number of a key is counted here."""

    parameter: str
    added: float = 0.0
    times: str = ""
    """A number among those that were drawn for the machine, by which it is multiplied; 1 where there is none."""


SIZES = {
    "extra_lap_each_side_V": Size("dead_band_change"),
    "true_centre_V": Size("valve_centre"),
    "C_leak_m3_s_Pa": Size("valve_leakage", times="gain"),
    "sigma_N_s_m": Size("viscous_friction"),
    "bench_mass_kg": Size("moving_mass"),
    "recording_delay_s": Size("clock_skew_extension"),
    "offset_m": Size("sensor_offset_extension"),
    "gain": Size("sensor_gain_extension", added=-1.0),
}
"""A key's number -> the parameter that has the same meaning here. Others are laws of that simulator's own, without a
parameter here.

A leak is added there to the conductance of the valve's tables, and the mass-flow gain of a cylinder multiplies both;
here it is the conductance of the gap itself (docs/trials.md).
"""


@dataclass(frozen=True)
class Answer:
    """One set, diagnosed and scored."""

    set: str
    scope: str
    hidden: list[str]
    verdict: str
    named: list[list[str]]
    """Effect ids of each cause's members."""
    right: bool
    wrong_name: bool
    gain: float | None
    """Share of the mean squared error on validation records that the extended model takes; None without a cause."""
    within: bool | None
    """Whether the true size lies within the stated 95 % interval; None where nothing can be compared."""
    seconds: float


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: **./dev trials foreign ../shared/foreign --reference --json foreign.json**."
    )(foreign)


def foreign(
    folder: Annotated[Path, typer.Argument(help="Folder with setNN/ and keys/setNN.json.")],
    reference: Annotated[
        bool, typer.Option("--reference", help="With records of the machine when it was well.")
    ] = False,
    exchanged: Annotated[
        bool,
        typer.Option(
            "--exchanged",
            help="Identify with the validation records, and the reverse: other questions of the same machines.",
        ),
    ] = False,
    as_json: Annotated[
        Path | None, typer.Option("--json", help="File for shares and answers, for programs.")
    ] = None,
    only: Annotated[str, typer.Option(help="Sets, separated by commas; all if left out.")] = "",
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
) -> None:
    """Diagnose the data sets of another simulator blind, open the keys, and count."""
    sets = chosen_sets(folder, only)
    console, answers = Console(), []
    cores = len(os.sched_getaffinity(0))
    os.environ.update(SMS_THREADS=str(max(cores // workers, 1)), OPENBLAS_NUM_THREADS="1")
    with processes(workers) as pool:
        jobs = [pool.submit(answer_set, folder, name, reference, exchanged) for name in sets]
        for job in as_completed(jobs):
            answer = job.result()
            answers.append(answer)
            said = " + ".join(" | ".join(m) for m in answer.named) or "-"
            mark = "right" if answer.right else "WRONG NAME" if answer.wrong_name else "missed"
            console.print(
                f"{answer.set} {answer.scope}: hidden {' + '.join(answer.hidden)}; {answer.verdict}: {said}; "
                f"{mark} ({answer.seconds:.0f} s)",
                highlight=False,
            )
            if as_json is not None:
                write_text_atomically(as_json, json_text("trials", as_dict(answers)))
    console.print(share_table(shares(answers)))


def sets_of(folder: Path) -> list[str]:
    """The names of the sets that have a key; InputError if there is none."""
    sets = sorted(k.stem for k in (folder / "keys").glob("*.json") if (folder / k.stem).is_dir())
    if not sets:
        raise InputError(f"{folder}: there is no set with a rig.toml and a key in keys/")
    return sets


def chosen_sets(folder: Path, only: str) -> list[str]:
    """Those of a folder, or those named, separated by commas; InputError for a name that is no set."""
    sets = sets_of(folder)
    wanted = [name.strip() for name in only.split(",") if name.strip()]
    if unknown := [name for name in wanted if name not in sets]:
        raise InputError(
            f"--only: {folder} has no set {', '.join(unknown)}; it has {sets[0]} to {sets[-1]}"
        )
    return wanted or sets


def answer_set(folder: Path, name: str, reference: bool, exchanged: bool = False) -> Answer:
    """Diagnose one set, then open its key."""
    file = folder / name / "rig.toml"
    with_reference = folder / name / "rig_with_reference.toml"
    if reference and with_reference.is_file():
        file = with_reference
    begin = time.perf_counter()
    if exchanged:
        with tempfile.TemporaryDirectory() as other:
            answer = diagnose(with_exchanged_roles(file, Path(other)))
    else:
        answer = diagnose(file)
    seconds = time.perf_counter() - begin
    key = json.loads((folder / "keys" / f"{name}.json").read_text(encoding="utf-8"))
    return scored(name, key, answer, seconds)


def with_exchanged_roles(file: Path, folder: Path) -> Path:
    """A rig file in `folder` with the records of another one, those to identify with and those to validate with
    exchanged."""
    other = {"identify": "validate", "validate": "identify"}
    rig = tomlkit.parse(file.read_text(encoding="utf-8"))
    for record in rig["records"]:
        record["role"] = other.get(record["role"], record["role"])
    return moved_rig(rig, file, folder)


def moved_rig(rig: tomlkit.TOMLDocument, file: Path, folder: Path) -> Path:
    """Writes what a rig file has become into `folder`; its records stay where they are."""
    data = rig.setdefault("data", tomlkit.table())
    data["folder"] = str(file.parent.resolve() / data.get("folder", ""))
    made = folder / file.name
    made.write_text(tomlkit.dumps(rig), encoding="utf-8")
    return made


def scored(name: str, key: dict[str, Any], answer: Diagnosis, seconds: float) -> Answer:
    """An answer against the truth."""
    named = [list(dict.fromkeys(c.members)) for c in answer.causes]
    accepted = [set(group) for group in key["accepted"]]
    hidden = [e["name"] for e in key["effects"]]
    right, wrong = judged(accepted, named, answer.verdict)
    gains = [1.0 - (g.extended_rms / g.baseline_rms) ** 2 for g in answer.gain]
    return Answer(
        name,
        key["scope"],
        hidden,
        answer.verdict,
        named,
        right,
        wrong,
        sum(gains) / len(gains) if gains and named else None,
        within(key, answer) if right else None,
        seconds,
    )


def judged(
    accepted: Sequence[set[str]], named: Sequence[Sequence[str]], verdict: str
) -> tuple[bool, bool]:
    """Whether an answer is right, and whether something is named that is not there."""
    if accepted == [{"NOTHING"}]:
        return not named and verdict != "data-fault", bool(named)
    if accepted == [{"UNKNOWN"}]:
        return not named and verdict == "unknown", bool(named)
    wrong = any(not any(set(members) & group for group in accepted) for members in named)
    small = [set(m) for m in named if len(m) <= LARGEST_CLASS]
    found = all(
        any(members & group for members in small)
        or ("DATA-FAULT" in group and verdict == "data-fault")
        for group in accepted
    )
    return found and not wrong, wrong


def within(key: dict[str, Any], answer: Diagnosis) -> bool | None:
    """Whether the sizes that can be compared lie within two standard errors."""
    inside = []
    for number, size in SIZES.items():
        if number not in key["true_values"]:
            continue
        drawn = key.get("drawn", {})
        truth = float(key["true_values"][number]) * float(drawn.get(size.times, 1.0)) + size.added
        owners: list[Cause | Member] = [*answer.causes]
        owners += [m for c in answer.causes for m in c.alternatives]
        for value in (p for owner in owners for p in owner.parameters):
            if value.name.partition(":")[0] == size.parameter:
                inside.append(abs(value.value - truth) <= 1.96 * value.standard_error)
    return all(inside) if inside else None


def shares(answers: Sequence[Answer]) -> list[Share]:
    """What is counted."""
    nothing = [a for a in answers if a.hidden == ["none"]]
    outside = [a for a in answers if a.hidden[0].startswith("unknown_")]
    known = [a for a in answers if a not in nothing and a not in outside]
    sized = [a for a in known if a.within is not None]

    return [
        at_least("right cause, or a class of at most three with it", [a.right for a in known]),
        at_most("a wrong name where something was hidden", [a.wrong_name for a in known + outside]),
        at_most("a name on a healthy machine", [a.wrong_name for a in nothing]),
        at_least("called unknown, hidden from outside the catalogue", [a.right for a in outside]),
        at_least("true size within the stated 95 % interval", [bool(a.within) for a in sized]),
    ]


def as_dict(answers: Sequence[Answer]) -> dict[str, Any]:
    """Shares and answers for programs."""
    rows = [asdict(a) for a in sorted(answers, key=lambda a: a.set)]
    return {"shares": shares_as_dicts(shares(answers)), "answers": rows}
