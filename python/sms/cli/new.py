"""The command `sms new`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

from sms.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from sms.draft import Columns, Draft, Given, Question


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog='Example: **sms new bench sine.csv steps.csv --column extension="pos" --unit extension=mm** writes '
        "rig.toml, which **sms diagnose rig.toml** accepts, and rig.schema.json beside it for the editor."
    )(new)


def new(
    kind: Annotated[str, typer.Argument(help="bench, platform, tank or cylinder.")],
    records: Annotated[
        list[Path], typer.Argument(help="Two records or more; the last ones judge (role validate).")
    ],
    out: Annotated[Path, typer.Option(help="The rig file.")] = Path("rig.toml"),
    column: Annotated[
        list[str], typer.Option(metavar="SIGNAL=COLUMN", help="Which column a signal is.")
    ] = [],  # noqa: B006 (typer copies it)
    unit: Annotated[
        list[str], typer.Option(metavar="SIGNAL=UNIT", help="The unit of its column.")
    ] = [],  # noqa: B006
    offset: Annotated[
        list[str], typer.Option(metavar="SIGNAL=QUANTITY", help="What to add to its column.")
    ] = [],  # noqa: B006
    scale: Annotated[
        list[str], typer.Option(metavar="SIGNAL=NUMBER", help="What to multiply its column by.")
    ] = [],  # noqa: B006
    parameter: Annotated[
        list[str], typer.Option(metavar="NAME=VALUE", help='What is known: stroke="300 mm".')
    ] = [],  # noqa: B006
    pressures: Annotated[
        str | None, typer.Option(help="gauge or absolute, where headers say nothing.")
    ] = None,
    names: Annotated[
        str | None, typer.Option(help='Columns of files without a header line: "time [s],u [V]".')
    ] = None,
    validate: Annotated[
        int | None, typer.Option(help="How many records judge; without it a third of them.")
    ] = None,
    title: Annotated[str, typer.Option(help="Of the rig, for reports.")] = "",
    yes: Annotated[
        bool, typer.Option("--yes", help="Accept doubtful guesses, ask nothing.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
) -> None:
    """Write a commented rig file from the columns of records: which is which signal, in which unit.

    Headers, units and ranges of readings are looked at; what was guessed is said, and how sure. What cannot be told is
    asked, on a terminal; elsewhere the option to give is named. What is written is accepted by *sms diagnose*.
    """
    from sms.draft import Given, read_columns  # noqa: PLC0415 (pandas takes its time)
    from sms.draft.draft import DRAFTED  # noqa: PLC0415
    from sms.draft.rig_text import SCHEMA  # noqa: PLC0415
    from sms.io.write import write_text_atomically  # noqa: PLC0415
    from sms.schemas import shipped  # noqa: PLC0415

    if kind not in DRAFTED:
        raise InputError(f"{kind}: no such kind of rig is drafted; {did_you_mean(kind, DRAFTED)}")
    if out.exists() and not force:
        raise InputError(
            f"{out}: exists already; choose another --out, or overwrite it with --force"
        )
    for file in records:
        if not file.is_file():
            raise InputError(f"{file}: there is no such record; check the path")
    given = Given(
        column=_pairs("column", column),
        unit=_pairs("unit", unit),
        offset=_pairs("offset", offset),
        scale=_pairs("scale", scale),
        parameter=_pairs("parameter", parameter),
        pressures=pressures,
        accept=yes,
    )
    split = None if names is None else [name.strip() for name in names.split(",")]
    draft = _asked(read_columns(records, split), kind, out, given, validate, title)
    warnings = _accepted(draft, out)
    write_text_atomically(out, draft.text)
    schema = out.with_name(SCHEMA)
    if not schema.exists() or force:
        write_text_atomically(schema, shipped("rig"))
    if any(s.gauge for s in draft.signals) and "ambient_pressure" not in given.parameter:
        warnings.append(_without_ambient())
    _say(draft, warnings)
    print(f"written: {out}, with {SCHEMA} beside it")


def _pairs(option: str, texts: list[str]) -> dict[str, str]:
    """NAME=VALUE of one option."""
    found = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not (name and equals and value):
            raise InputError(f"--{option} {text}: write NAME=VALUE, for instance extension=...")
        found[name] = value
    return found


def _asked(
    columns: Columns, kind: str, out: Path, given: Given, validate: int | None, title: str
) -> Draft:
    """The draft, after as many questions as there are, if somebody is there to answer them."""
    from sms.draft import Question, draft_rig  # noqa: PLC0415

    while True:
        try:
            return draft_rig(columns, kind, out, given, validate, title)
        except Question as question:
            if given.accept or not (sys.stdin.isatty() and sys.stdout.isatty()):
                raise
            answer = _answer(question)
            given = given.with_answer(question.subject, question.name, answer)


def _answer(question: Question) -> str:
    """What a person says to it; an empty line takes the guess."""
    print(f"{question.problem}.")
    if question.choices:
        print(f"  {', '.join(question.choices)}")
    what = f"{question.subject} of {question.name}" if question.name else question.subject
    return str(typer.prompt(f"  {what}", default=question.suggestion)).strip()


def _accepted(draft: Draft, out: Path) -> list[str]:
    """What the data check says of the records as drafted. InputError for what `sms diagnose` would refuse."""
    from sms.diagnosis.pipeline import read_and_check  # noqa: PLC0415 (scipy takes a second)
    from sms.io.rig import interpret  # noqa: PLC0415
    from sms.io.schema import parse_rig_text  # noqa: PLC0415
    from sms.rigs.kinds import kind_of  # noqa: PLC0415

    rig = interpret(parse_rig_text(draft.text, out), out)
    kind_of(rig)
    _, findings = read_and_check(rig)
    return [str(f) for f in findings if f.severity != "note"]


def _without_ambient() -> str:
    """What gauge readings are taken against where nobody has said it."""
    from sms.parameters import PARAMETERS  # noqa: PLC0415
    from sms.units_display import format_quantity  # noqa: PLC0415

    usual = PARAMETERS["ambient_pressure"]
    taken = format_quantity(usual.default, usual.unit, "ambient_pressure")
    return (
        f"pressures are gauge, and the air outside is taken to have {taken}; where that is not so, write it down: "
        '--parameter ambient_pressure="101.3 kPa"'
    )


def _say(draft: Draft, warnings: list[str]) -> None:
    """What was guessed and why, what is not used, who judges."""
    table = Table(box=None, pad_edge=False)
    for header in ("signal", "column", "unit", "how sure", "why"):
        table.add_column(header, overflow="fold")
    for of in draft.signals:
        table.add_row(of.signal, of.column.name, of.unit, of.sure, "; ".join(of.why))
    Console(markup=False).print(table)
    for name, why in draft.unused:
        print(f"- not used: '{name}' ({why})")
    for role in ("identify", "validate"):
        files = ", ".join(file for file, given in draft.roles if given == role)
        last = "" if role == "identify" else " (the last ones; they only judge)"
        print(f"- {role}: {files}{last}")
    for warning in warnings:
        print(f"- {warning}")
