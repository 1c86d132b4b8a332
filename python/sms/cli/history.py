"""The commands `sms history` and `sms compare-diagnoses`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

from sms.cli.assets import Assets
from sms.errors import InputError
from sms.report.assets import Place

if TYPE_CHECKING:
    from sms.diagnosis.result import Diagnosis
    from sms.history import Answer, History, Store
    from sms.history.store import Origin

JsonFile = Annotated[
    Path | None, typer.Option("--json", help="Also write the numbers to this file.")
]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command(
        epilog="Examples: **sms history crane.sqlite --add reports/** puts every diagnosis.json below a folder into "
        "the history; **sms history crane.sqlite --limit chamber_leakage_lower=5e-10** says when the leak will be as "
        "large."
    )(history)
    app.command(
        name="compare-diagnoses",
        epilog="Example: **sms compare-diagnoses may/diagnosis.json june/diagnosis.json** says which causes "
        "changed, which did not, and of which these records cannot tell it.",
    )(compare_diagnoses)


def history(
    file: Annotated[Path, typer.Argument(help="The history (SQLite), of one machine.")],
    add: Annotated[
        list[Path],
        typer.Option(help="A diagnosis.json, or a folder that holds some; may be repeated."),
    ] = [],  # noqa: B006 (typer copies it)
    measured: Annotated[
        str | None,
        typer.Option(
            metavar="DATE", help="When the records of the one that is added were measured."
        ),
    ] = None,
    machine: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Says that what is added is this machine, whatever its title."
        ),
    ] = None,
    limit: Annotated[
        list[str],
        typer.Option(
            metavar="PARAMETER=SIZE",
            help="Says when a growing size reaches it; SI, or with its unit.",
        ),
    ] = [],  # noqa: B006
    out: Annotated[Path, typer.Option(help="Folder for history.html.")] = Path("history"),
    as_json: JsonFile = None,
    assets: Assets = Place.inside,
) -> None:
    """The history of one machine: each cause and parameter over its diagnoses, what changed, and since when.

    The file is filled by **sms diagnose RIG.toml --history FILE**, or with **--add** from what earlier diagnoses wrote.
    """
    from sms.history import Store, history_of, read_answers  # noqa: PLC0415 (scipy takes a second)
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import check_output_folder, write_text_atomically  # noqa: PLC0415
    from sms.report.history import history_html  # noqa: PLC0415
    from sms.report.page import write_page  # noqa: PLC0415

    check_output_folder(out)
    limits = dict(_split(text) for text in limit)
    store = Store(file)
    console = Console(markup=False)
    new = dated(read_answers(add), measured)
    if not new and (measured or machine):
        option = "--measured" if measured else "--machine"
        raise InputError(f"{option}: it is said of what is added; name that with --add")
    store.check_all(new, machine)
    for answer in new:
        console.print(_added(store, answer, "import", machine), soft_wrap=True)
    answers = store.answers()
    known = store.machine()
    if known is None or not answers:
        raise InputError(
            f"{file}: there is no diagnosis in it yet; sms history {file} --add diagnosis.json"
        )
    found = history_of(known, answers, limits)
    page = out / "history.html"
    write_page(page, history_html(found))
    if as_json is not None:
        write_text_atomically(as_json, json_text("history", found.to_dict(), [file]))
    print_history(found, console)
    written = [page, *([] if as_json is None else [as_json])]
    console.print(f"written: {', '.join(map(str, written))}", style="dim", soft_wrap=True)


def compare_diagnoses(
    a: Annotated[Path, typer.Argument(help="The earlier diagnosis.json.")],
    b: Annotated[Path, typer.Argument(help="The later one.")],
    any_machine: Annotated[
        bool, typer.Option("--any-machine", help="Compare although title or kind differ.")
    ] = False,
    as_json: JsonFile = None,
) -> None:
    """What changed between two diagnoses: changed, unchanged, or not to be told, each by a test.

    Wrongly called changed is a pair of which nothing changed in at most 5 % (Holm's procedure over all sizes).
    """
    from sms.history import compare  # noqa: PLC0415 (scipy takes a second)
    from sms.history.answer import read_file  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import write_text_atomically  # noqa: PLC0415
    from sms.report.difference import HEADERS, difference_rows, notes, total_in_words  # noqa: PLC0415

    found = compare(read_file(a), read_file(b), any_machine)
    if as_json is not None:
        write_text_atomically(as_json, json_text("diagnosis_comparison", found.to_dict(), [a, b]))
    console = Console(markup=False)
    console.print(found.sentence, style="bold")
    if found.items:
        _print_table(console, HEADERS, difference_rows(found))
        console.print(total_in_words(found))
    for text in (*notes(found), *found.would_tell, *found.assumed):
        console.print(f"- {text}")
    if as_json is not None:
        console.print(f"written: {as_json}", style="dim", soft_wrap=True)


# ---- what `sms diagnose` uses ----------------------------------------------------------------------


def check_history(file: Path, rig: Path, machine: str | None) -> None:
    """InputError, before the work, where the diagnosis of this rig could not be added."""
    from sms.history import Store  # noqa: PLC0415
    from sms.io.rig import load_rig  # noqa: PLC0415

    known = load_rig(rig)
    Store(file).check(known.title, known.kind, machine)


def add_diagnosis(file: Path, diagnosis: Diagnosis, source: Path, machine: str | None) -> str:
    """Add what was diagnosed just now; what happened, in a sentence."""
    from datetime import UTC, datetime  # noqa: PLC0415

    from sms.diagnosis.result import as_json  # noqa: PLC0415
    from sms.history import Store, read_answer  # noqa: PLC0415

    answer = read_answer(as_json(diagnosis), str(source), datetime.now(UTC))
    return _added(Store(file), answer, "diagnose", machine)


# ---- parts -----------------------------------------------------------------------------------------


def dated(answers: Sequence[Answer], measured: str | None) -> list[Answer]:
    """With the time of measurement that an option says, of one diagnosis."""
    from dataclasses import replace  # noqa: PLC0415

    from sms.io.measured import moment, parse_measured  # noqa: PLC0415

    if measured is None:
        return list(answers)
    time = moment(parse_measured(measured, "--measured"))
    if len(answers) > 1:
        raise InputError(
            f"--measured: {len(answers)} diagnoses would all have been measured then; add them one by one"
        )
    return [replace(a, measured=time, measured_from="stated") for a in answers]


def _added(store: Store, answer: Answer, origin: Origin, machine: str | None) -> str:
    """Add it; what happened, in a sentence."""
    before = store.add(answer, origin, machine)
    if before is not None:
        return f"{answer.source}: already in {store.path}, as measured on {before.date()}; not added again"
    when = answer.measured.date()
    return f"added to {store.path}: {answer.source}, measured on {when} ({answer.measured_from})"


def _split(text: str) -> tuple[str, str]:
    name, equals, size = text.partition("=")
    if not equals or not name.strip() or not size.strip():
        raise InputError(f"--limit {text}: write PARAMETER=SIZE, as chamber_leakage_lower=5e-10")
    return name.strip(), size.strip()


def print_history(found: History, console: Console) -> None:
    """What a person reads in ten seconds; the page has the rest."""
    from sms.report.history import COURSE_HEADERS, course_rows  # noqa: PLC0415

    console.print(f"{found.machine.title}: {len(found.entries)} diagnoses", style="bold")
    rows = [
        (
            e.date,
            e.verdict,
            "; ".join(e.causes) or "-",
            "; ".join(e.changed_in_rig_file) or "-",
        )
        for e in found.entries
    ]
    _print_table(console, ("measured", "verdict", "causes", "changed in the rig file"), rows)
    causes = [c for c in found.courses if c.about == "cause"]
    moving = [c for c in found.courses if c.about == "model" and (c.moves or c.changed)]
    if causes or moving:
        _print_table(console, COURSE_HEADERS, course_rows([*causes, *moving]))
    for text in (*found.sentences, *found.lacks):
        console.print(f"- {text}")


def _print_table(console: Console, headers: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", pad_edge=False)
    for header in headers:
        table.add_column(header)
    for row in rows:
        table.add_row(*row)
    console.print(table)
