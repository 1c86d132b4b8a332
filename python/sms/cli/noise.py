"""The command `sms noise`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sms.cli.assets import Assets
from sms.cli.columns import Columns, Dbc, columns_of
from sms.report.assets import Place


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog='Example: **sms noise run.csv --signal "tank_pressure" --from 20 --to 50** describes thirty seconds at '
        "rest and draws their spectrum into noise/noise.html."
    )(noise)


def noise(
    record: Annotated[
        Path,
        typer.Argument(
            help="A record: a table, a log of a measurement system or of a bus; a column named time."
        ),
    ],
    signal: Annotated[
        str | None,
        typer.Option(help="The column, with or without its unit; by default the first after time."),
    ] = None,
    begin: Annotated[float | None, typer.Option("--from", help="Begin of the stretch, s.")] = None,
    end: Annotated[float | None, typer.Option("--to", help="End of the stretch, s.")] = None,
    alpha: Annotated[float, typer.Option(help="Of the alpha-beta filter drawn beside it.")] = 0.25,
    beta: Annotated[float, typer.Option(help="Of that filter.")] = 0.02,
    out: Annotated[Path, typer.Option(help="Folder for noise.html and noise.json.")] = Path(
        "noise"
    ),
    column: Columns = [],  # noqa: B006 (typer copies it)
    dbc: Dbc = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print noise.json instead.")] = False,
    assets: Assets = Place.inside,
) -> None:
    """The noise of a signal at rest: spread, skewness, kurtosis, colour, and its spectrum.

    Choose a stretch in which the true signal is constant or drifts evenly; the drift is taken off.
    """
    from sms.identification.noise import noise_of  # noqa: PLC0415
    from sms.identification.noise_record import noise_dict, noise_sentences, stretch  # noqa: PLC0415
    from sms.io import write_text_atomically  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second; --help must not)
    from sms.report.noise import noise_html  # noqa: PLC0415
    from sms.report.page import write_page  # noqa: PLC0415

    check_output_folder(out)
    name, unit, time, values = stretch(record, signal, begin, end, columns_of(column), dbc)
    found = noise_of(time, values, alpha, beta)
    said = noise_sentences(found, unit)
    told = {"record": record.name, "signal": name, "unit": unit} | noise_dict(found)
    text = json_text("noise", told, [record])
    files = out / "noise.html", out / "noise.json"
    write_page(files[0], noise_html(f"{name}, {record.name}", unit, time, values, found, said))
    write_text_atomically(files[1], text)
    if as_json:
        print(text, end="")
        return
    print(f"{name}, {time[0]:g} to {time[-1]:g} s")
    for sentence in said:
        print(f"- {sentence}")
    print(f"written: {files[0]}, {files[1]}")
