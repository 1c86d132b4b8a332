"""`./dev trials changed FOLDER`: another simulator's machines when they were well, and with what was hidden in them.

Each set of `./dev trials foreign` that has reference records is two days of one machine: the reference records,
diagnosed as those of any other machine, and the records with what was hidden. `sms compare-diagnoses` then has to say
what changed. Both days are off from the model by the same smooth error of the flow, which neither diagnosis knows.
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
from typing import Annotated

import tomlkit
import typer
from rich.console import Console
from sms.diagnosis import diagnose
from sms.errors import InputError
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.compared import as_answer, called_changed
from validation.trials.foreign import chosen_sets, moved_rig
from validation.trials.processes import processes
from validation.trials.shares import Share, at_least, at_most, share_table, shares_as_dicts

OF_REFERENCE = "reference_"
"""What the name of a reference record has before that of the record with the same motion."""


@dataclass(frozen=True)
class Changed:
    """What was said of the two days of one set."""

    set: str
    scope: str
    hidden: list[str]
    verdicts: tuple[str, str]
    changed: list[list[str]]
    """Effect ids of each cause that is called changed; a number of the declared model, and those that shift it."""
    right: bool
    """All that was hidden is called changed, under a right name, and nothing else; or nothing, where nothing was."""
    wrong: bool
    """Something is called changed that was not hidden."""
    seconds: float


def first_day(file: Path, folder: Path) -> Path:
    """A rig file in `folder` with the reference records of another one in the roles of those that they correspond to.

    InputError where it has none, or one without a counterpart.
    """
    rig = tomlkit.parse(file.read_text(encoding="utf-8"))
    roles = {r["name"]: r["role"] for r in rig["records"] if r["role"] != "reference"}
    kept = tomlkit.aot()
    for record in [r for r in rig["records"] if r["role"] == "reference"]:
        name = str(record["name"]).removeprefix(OF_REFERENCE)
        if name not in roles:
            raise InputError(f"{file}: no record '{name}' for reference record '{record['name']}'")
        record["role"] = roles[name]
        kept.append(record)
    if not kept:
        raise InputError(f"{file}: it has no reference records; give one with role = 'reference'")
    rig["records"] = kept
    return moved_rig(rig, file, folder)


def answer_pair(folder: Path, name: str) -> Changed:
    """Diagnose both days of a set, compare, then open its key."""
    begin = time.perf_counter()
    place = folder / name
    with tempfile.TemporaryDirectory() as made:
        well = as_answer(diagnose(first_day(place / "rig_with_reference.toml", Path(made))), "well")
    spoilt = as_answer(diagnose(place / "rig.toml"), "with what was hidden")
    seconds = time.perf_counter() - begin
    key = json.loads((folder / "keys" / f"{name}.json").read_text(encoding="utf-8"))
    called = called_changed(key["scope"], well, spoilt)
    changed = [list(dict.fromkeys(n.partition(":")[0] for n in names)) for names in called]
    right, wrong = judged([set(group) for group in key["accepted"]], changed)
    hidden = [e["name"] for e in key["effects"]]
    verdicts = (well.verdict, spoilt.verdict)
    return Changed(name, key["scope"], hidden, verdicts, changed, right, wrong, seconds)


def judged(accepted: Sequence[set[str]], changed: Sequence[Sequence[str]]) -> tuple[bool, bool]:
    """Whether what is called changed is what was hidden, and whether something is that was not."""
    if accepted in ([{"NOTHING"}], [{"UNKNOWN"}]):
        return not changed, bool(changed)
    wrong = any(not any(set(names) & group for group in accepted) for names in changed)
    return not wrong and all(any(set(n) & g for n in changed) for g in accepted), wrong


def shares(found: Sequence[Changed]) -> list[Share]:
    """What is counted. Of what no effect of the catalogue explains, that nothing is called changed under a name."""
    nothing = [c for c in found if c.hidden == ["none"]]
    outside = [c for c in found if c.hidden[0].startswith("unknown_")]
    known = [c for c in found if c not in nothing and c not in outside]
    return [
        at_least("called changed, all that was hidden and nothing else", [c.right for c in known]),
        at_most("something called changed that was not hidden", [c.wrong for c in known + outside]),
        at_most("a healthy machine called changed", [c.wrong for c in nothing]),
    ]


# ---- the command -----------------------------------------------------------------------------------


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(epilog="Example: **./dev trials changed ../shared/foreign --json changed.json**.")(
        changed
    )


def changed(
    folder: Annotated[Path, typer.Argument(help="Folder with setNN/ and keys/setNN.json.")],
    as_json_file: Annotated[
        Path | None, typer.Option("--json", help="File for shares and answers, for programs.")
    ] = None,
    only: Annotated[str, typer.Option(help="Sets, separated by commas; all if left out.")] = "",
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
) -> None:
    """Diagnose machines of another simulator when they were well and later; count what is called changed."""
    sets = [
        s for s in chosen_sets(folder, only) if (folder / s / "rig_with_reference.toml").is_file()
    ]
    if not sets:
        raise InputError(f"{folder}: none of these sets has a rig_with_reference.toml")
    console, found = Console(), []
    cores = len(os.sched_getaffinity(0))
    os.environ.update(SMS_THREADS=str(max(cores // workers, 1)), OPENBLAS_NUM_THREADS="1")
    with processes(workers) as pool:
        jobs = [pool.submit(answer_pair, folder, name) for name in sets]
        for job in as_completed(jobs):
            one = job.result()
            found.append(one)
            said = " + ".join(" | ".join(names) for names in one.changed) or "-"
            mark = "right" if one.right else "WRONG" if one.wrong else "missed"
            console.print(
                f"{one.set} {one.scope}: hidden {' + '.join(one.hidden)}; {' to '.join(one.verdicts)}; "
                f"changed: {said}; {mark} ({one.seconds:.0f} s)",
                highlight=False,
                soft_wrap=True,
            )
            if as_json_file is not None:
                rows = [asdict(c) for c in sorted(found, key=lambda c: c.set)]
                content = {"shares": shares_as_dicts(shares(found)), "pairs": rows}
                write_text_atomically(as_json_file, json_text("trials", content))
    console.print(share_table(shares(found)))
