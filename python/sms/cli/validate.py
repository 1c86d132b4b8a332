"""The command `sms validate`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sms.errors import InputError, did_you_mean
from sms.progress import progress_bar

if TYPE_CHECKING:
    from sms.validation import Row


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: **sms validate --out report --json report/rows.json** runs every "
        "published experiment and writes report/validation.html, the page, and the same rows "
        "for programs. Why a row does not agree: docs/validation.md."
    )(validate)


def validate(
    out: Annotated[Path, typer.Option(help="Folder for validation.html.")] = Path(
        "validation-report"
    ),
    json_file: Annotated[
        Path | None,
        typer.Option(
            "--json",
            metavar="FILE",
            help="Write the rows as JSON too: experiment, quantity, published, computed, unit, "
            "agrees, remark. 'published' is null where the source has words only.",
        ),
    ] = None,
    only: Annotated[
        list[str],
        typer.Option("--only", metavar="EXPERIMENT", help="Only this one; may be repeated."),
    ] = [],  # noqa: B006 (typer copies it)
) -> None:
    """Repeat the published experiments and say which figures come out; it takes a minute.

    Each row holds the published figure, the computed one, and whether it lies within the band that
    the figure's precision allows. A row that does not agree is a finding, not a failure: the exit
    code is 0 either way. Ctrl-C leaves no file.
    """
    from sms.io import write_text_atomically  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second)
    from sms.report.validation import validation_html  # noqa: PLC0415
    from sms.validation import EXPERIMENTS, rows_to_json  # noqa: PLC0415
    from sms.validation import validate as run  # noqa: PLC0415

    for name in only:
        if name not in EXPERIMENTS:
            raise InputError(f"--only {name}: there is none; {did_you_mean(name, EXPERIMENTS)}")
    check_output_folder(out)
    with progress_bar("validation") as tell:
        rows = run(only or None, tell)
    page = out / "validation.html"
    write_text_atomically(page, validation_html(rows))
    written = [page]
    if json_file is not None:
        write_text_atomically(json_file, rows_to_json(rows))
        written.append(json_file)
    _print(rows)
    print(f"written: {', '.join(str(file) for file in written)}")


def _print(rows: Sequence[Row]) -> None:
    experiment = ""
    for row in rows:
        if row.experiment != experiment:
            experiment = row.experiment
            print(experiment)
        published = "in words" if row.published is None else f"{row.published:.5g}"
        mark = "agrees " if row.agrees else "DIFFERS"
        print(f"  {mark}  {row.quantity}: {row.computed:.5g} {row.unit} (published {published})")
    agreeing = sum(row.agrees for row in rows)
    print(f"{agreeing} of {len(rows)} figures agree")
