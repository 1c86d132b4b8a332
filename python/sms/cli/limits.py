"""The command `sms limits`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from sms.progress import progress_bar

if TYPE_CHECKING:
    from sms.diagnosis.design.detection_limits import Limits


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Examples: **sms limits bench** for the published machine with typical sensors; **sms limits rig.toml** "
        "for your own machine, sensors and records. A bench takes half a minute, a platform some minutes."
    )(limits)


def limits(
    rig: Annotated[
        str, typer.Argument(help="A rig file (TOML); or bench, platform or tank, as published.")
    ],
    out: Annotated[Path, typer.Option(help="Folder for limits.html and limits.csv.")] = Path(
        "limits"
    ),
) -> None:
    """Detection limits: the smallest size of each effect that an experiment shows.

    For each effect of the catalogue, each experiment that the diagnosis may propose, and each record that the rig file
    lists: the size that equals three standard errors of its estimate from one such run, with the noise as declared and
    everything uncertain free within its declaration; what shifts a number that is declared with an uncertainty is
    counted from the end of that. "-" is an effect that it cannot show; the page says why.
    """
    from sms.diagnosis.design.detection_limits import as_csv, detection_limits  # noqa: PLC0415
    from sms.io import write_text_atomically  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second)
    from sms.report.limits import limits_html  # noqa: PLC0415

    check_output_folder(out)
    with progress_bar("simulating the experiments") as progress:
        found = detection_limits(rig, progress)
    write_text_atomically(out / "limits.csv", as_csv(found))
    write_text_atomically(out / "limits.html", limits_html(found))
    console = Console(markup=False)  # a title that its owner chose may look like it
    for number, title in enumerate(found.experiments, 1):
        console.print(f"{number}  {title}")
    table = table_of(found)
    # Numbers are not cut: beyond the terminal's width lines wrap.
    wide = console.options.update(max_width=1000)
    console.width = max(console.width, Measurement.get(console, wide, table).maximum)
    console.print(table)
    console.print(
        f"written: {out / 'limits.html'}, {out / 'limits.csv'}", style="dim", soft_wrap=True
    )


def table_of(found: Limits) -> Table:
    """Effects by experiments, in natural units."""
    table = Table(
        title=f"smallest size that is seen: {found.title}", title_justify="left", box=None
    )
    table.add_column("effect", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for number in range(1, len(found.experiments) + 1):
        table.add_column(str(number), justify="right", no_wrap=True)
    for row in found.rows:
        unit, sizes = row.shown
        table.add_row(row.effect.key, unit, *sizes)
    return table
