"""The commands `sms export fmu`, `sms export c-params` and `sms export table-params`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

export_app = typer.Typer(
    help="Models for other simulators.", no_args_is_help=True, rich_markup_mode="markdown"
)


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.add_typer(export_app, name="export")


@export_app.callback()
def _export() -> None:
    """A group, so that `fmu` is named also while it is alone."""


@export_app.command(
    epilog="Example: **sms export c-params geometry/geometry.toml -o as_built.h**, then in C "
    "sms_params_default(&p); sms_params_as_built(&p);"
)
def c_params(
    file: Annotated[Path, typer.Argument(help="A parameter file, such as geometry.toml.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="The header.")] = Path("sms_params.h"),
) -> None:
    """Write the parameters of a file as a C header, which firmware compiles in."""
    from sms.io.write import write_text_atomically  # noqa: PLC0415
    from sms.parameter_files import c_header, load_params  # noqa: PLC0415

    write_text_atomically(out, c_header(load_params(file), file.name))
    print(f"written: {out}")


@export_app.command(
    epilog="Example: **ik_tables --height 0.5 --range 0.1 --step 0.001 -o table.npz --params $(sms export table-params "
    "geometry.toml)** makes the table of the machine as built, and holds it against the solver."
)
def table_params(
    file: Annotated[Path, typer.Argument(help="A parameter file, such as geometry.toml.")],
) -> None:
    """Print the parameters of a file as NAME=VALUE in SI, which `ik_tables --params` takes.

    What one leg's sensors have more is left out: a table is of true extensions.
    """
    from sms.parameter_files import read_values  # noqa: PLC0415
    from sms.parameters import is_of_leg  # noqa: PLC0415

    for name, value in read_values(file).items():
        if not is_of_leg(name):
            print(f"{name}={value!r}")


@export_app.command(
    epilog="Example: **sms export fmu bench report/extended.toml --fmi 3.0 -o bench.fmu** is the bench that a "
    "diagnosis found. docs/fmi.md has a closed loop of FMUs in fmpy, and what to do in other tools."
)
def fmu(
    kind: Annotated[str, typer.Argument(help="bench, platform, tank or controller.")],
    rig: Annotated[
        Path | None,
        typer.Argument(
            help="A rig file whose parameters are the start values, such as extended.toml; without it the "
            "published machine."
        ),
    ] = None,
    fmi: Annotated[str, typer.Option("--fmi", help="The standard: 2.0 or 3.0.")] = "2.0",
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="The file; without it KIND.fmu.")
    ] = None,
    every: Annotated[
        bool, typer.Option("--all", help="List the parameters and local variables, too.")
    ] = False,
) -> None:
    """Write a plant, or its position controller, as an FMU for co-simulation.

    Parameters have units, bounds and start values; the sources are inside, and a binary for this machine. A step gives
    what *sms simulate* gives for the same commands.
    """
    from sms.fmi import Starts, export_fmu, starts_of_rig, variables_of  # noqa: PLC0415
    from sms.fmi.archive import check  # noqa: PLC0415

    file = Path(f"{kind}.fmu") if out is None else out
    check(kind, fmi, file)
    starts = Starts() if rig is None else starts_of_rig(kind, rig)
    export_fmu(kind, file, fmi, starts)
    table = Table(box=None, pad_edge=False)
    for header in ("variable", "", "unit", "start", "what it is"):
        table.add_column(header, overflow="fold")
    variables = variables_of(kind)
    for v in variables:
        if every or v.causality in ("input", "output"):
            start = starts.values.get(v.name, v.start)
            shown = f"{start:g}" if v.causality in ("input", "parameter") else ""
            table.add_row(v.name, v.causality, "" if v.unit == "1" else v.unit, shown, v.doc)
    Console(markup=False).print(table)
    parameters = sum(v.causality == "parameter" for v in variables)
    print(f"- {parameters} parameters; {len(starts.values) or 'none'} from the rig file")
    for name, value in starts.left_out.items():
        print(f"- not in the FMU: {name} = {value:g}, which only a record has, or another model")
    print(f"written: {file}, FMI {fmi}")
