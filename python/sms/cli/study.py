"""The commands `sms compare`, `sms requirements` and `sms design`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from sms.cli.assets import Assets
from sms.cli.columns import Columns, Dbc, columns_of
from sms.cli.mechanism import AsJson, Settings, bad_input, machine
from sms.errors import InputError
from sms.progress import progress_bar
from sms.report.assets import Place

LOOPS = ("state_feedback", "pid")


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command(
        epilog="Example: **sms requirements --set payload_mass=280** with another payload; "
        "**--controller pid --set proportional_gain=2** with the source's first loop."
    )(requirements)
    app.command(
        epilog="Example: **sms design --out design**, then look at design/design.html in a browser."
    )(design)
    app.command(
        epilog="Example: **sms compare measured.csv run/run.csv --signal extension_1 --input "
        "valve_command_1** compares one signal and its frequency response over the valve's command; "
        "look at comparison/comparison.html in a browser."
    )(compare)


def compare(
    measured: Annotated[Path, typer.Argument(help='The measured record, columns "name [unit]".')],
    simulated: Annotated[Path, typer.Argument(help="The simulated one, such as run.csv.")],
    signal: Annotated[
        list[str], typer.Option(help="A signal to compare; may be repeated. Default: all in both.")
    ] = [],  # noqa: B006 (typer copies it)
    pair: Annotated[
        list[str],
        typer.Option(metavar="MEASURED=SIMULATED", help="Columns that are named differently."),
    ] = [],  # noqa: B006
    input_name: Annotated[
        str | None,
        typer.Option("--input", help="What excites both: responses are taken over it."),
    ] = None,
    shift: Annotated[float, typer.Option(help="Seconds added to the simulation's times.")] = 0.0,
    align: Annotated[
        bool, typer.Option("--align", help="Take off the lag of the first signal before comparing.")
    ] = False,
    column: Columns = [],  # noqa: B006
    dbc: Dbc = None,
    out: Annotated[
        Path, typer.Option(help="Folder for comparison.html and comparison.json.")
    ] = Path("comparison"),
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """How alike a measurement and a simulation are: errors, amplitude, rise time, lag, response.

    Every ratio is simulated over measured. The normalised cross-correlation of eq. 7.2 is among the
    numbers, and it is blind to gain: read it beside the amplitude ratio.
    """
    from sms.comparison.files import WARNING, compare_files  # noqa: PLC0415 (scipy takes a second)
    from sms.io import write_text_atomically  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.report.comparison import HEADERS, RATIOS, comparison_html, table_rows  # noqa: PLC0415
    from sms.report.page import write_page  # noqa: PLC0415

    renamed = {}
    for text in pair:
        left, equals, right = text.partition("=")
        if not equals:
            raise InputError(f"--pair {text}: write MEASURED=SIMULATED, two names of columns")
        renamed[left.strip()] = right.strip()
    found = compare_files(
        measured, simulated, signal, input_name, shift, align, renamed, columns_of(column), dbc
    )
    text = json_text("comparison", found.to_dict(), [measured, simulated])
    files = out / "comparison.html", out / "comparison.json"
    write_page(files[0], comparison_html(found))
    write_text_atomically(files[1], text)
    if as_json:
        print(text, end="")
        return
    print_table(HEADERS, table_rows(found))
    print(RATIOS)
    print(WARNING)
    print(f"written: {files[0]}, {files[1]}")


def requirements(
    controller: Annotated[
        str, typer.Option(help="Loop for accuracy and bandwidth: state_feedback or pid.")
    ] = "state_feedback",
    out: Annotated[
        Path, typer.Option(help="Folder for requirements.html and requirements.json.")
    ] = Path("requirements"),
    settings: Settings = [],  # noqa: B006 (typer copies it)
    as_json: AsJson = False,
) -> None:
    """Table 2.1 as a computed table: range, rate, acceleration, accuracy, load and bandwidth.

    Each line says what is required and specified, what this machine gives, by how much, and which
    part limits it: stroke, flow, force or the loop's bandwidth.
    """
    from sms.io import write_text_atomically  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.report.requirements import (  # noqa: PLC0415
        HEADERS,
        requirements_html,
        sentences,
        table_rows,
    )
    from sms.requirements import compliance  # noqa: PLC0415

    if controller not in LOOPS:
        raise InputError(f"--controller {controller}: allowed are {', '.join(LOOPS)}")
    with bad_input(), progress_bar("mechanism") as tell:
        try:
            found = compliance(machine(settings), controller, progress=tell)
        except ValueError as problem:
            raise InputError(str(problem)) from None
    text = json_text("requirements", found.to_dict())
    files = out / "requirements.html", out / "requirements.json"
    write_text_atomically(files[0], requirements_html(found))
    write_text_atomically(files[1], text)
    if as_json:
        print(text, end="")
        return
    print_table(HEADERS, table_rows(found))
    for sentence in sentences(found):
        print(f"- {sentence}")
    print(f"written: {files[0]}, {files[1]}")


def design(
    out: Annotated[Path, typer.Option(help="Folder for design.html.")] = Path("design"),
    assets: Assets = Place.inside,
) -> None:
    """State feedback designed on the simplified plant of section 8.1: gains, root locus, Bode, step.

    Both methods of the source and its published gains, on each reading of its contradictory numbers.
    Needs python-control: pip install "sms[control]".
    """
    from sms.design import designs, readings  # noqa: PLC0415
    from sms.report.design import HEADERS, design_html, plant_words, table_rows  # noqa: PLC0415
    from sms.report.page import write_page  # noqa: PLC0415

    write_page(out / "design.html", design_html())
    for plant in readings():
        print(plant_words(plant))
        print_table(HEADERS, table_rows(designs(plant)))
    print(f"written: {out / 'design.html'}")


def print_table(headers: tuple[str, ...], rows: list[list[str]]) -> None:
    """A table as wide as the console."""
    shown = Table(box=None, pad_edge=False)
    for header in headers:
        shown.add_column(header, overflow="fold")  # a narrow terminal breaks a word, and loses none
    for row in rows:
        shown.add_row(*row)
    Console(markup=False).print(shown)
