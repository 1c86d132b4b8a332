"""The command `sms calibrate geometry`: from measured poses to the mechanism as built."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sms.cli.assets import Assets
from sms.cli.identify import write_files
from sms.progress import progress_bar
from sms.report.assets import Place

calibrate = typer.Typer(
    help="The machine as built: what measured poses say of its joints, lengths and sensors.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
)


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.add_typer(calibrate, name="calibrate")


@calibrate.callback()
def _calibrate() -> None:
    """A group, so that `geometry` is named also while it is alone."""


@calibrate.command(
    epilog="Example: **sms calibrate geometry poses.toml --out geometry** writes geometry/geometry.toml (for "
    "sms.load_params, *--set geometry/geometry.toml*, *sms export c-params*), geometry/calibration.json (with the "
    "covariance) and geometry/report.html. docs/calibration.md shows a rig file."
)
def geometry(
    rig: Annotated[Path, typer.Argument(help="The rig file (TOML) of kind *poses*.")],
    out: Annotated[
        Path, typer.Option(help="Folder for geometry.toml, calibration.json and report.html.")
    ] = Path("geometry"),
    huber: Annotated[
        float,
        typer.Option(
            help="Robust loss: poses further off than this many standard deviations of the noise count with their "
            "distance, not its square. 0: least squares.",
            min=0.0,
        ),
    ] = 3.0,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the JSON instead of the summary.")
    ] = False,
    assets: Assets = Place.inside,
) -> None:
    """Joint places, lengths, gains and zeros of the sensors from measured poses, with their intervals.

    One row a pose: the three extensions as read and some of roll, pitch, height, yaw, x, y. Every parameter is held
    by its tolerance on the drawing; what the poses cannot tell is named, poses that do not fit are reported one by
    one, and the result is judged on validation poses. The poses to measure next keep 20 mm from the stroke's ends.
    """
    from sms.calibration.fit import calibrate_poses  # noqa: PLC0415
    from sms.calibration.proposal import propose  # noqa: PLC0415
    from sms.calibration.result import geometry_file, sentences, to_dict  # noqa: PLC0415
    from sms.calibration.rig import load_poses  # noqa: PLC0415
    from sms.errors import InputError  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415
    from sms.report.calibration import calibration_html  # noqa: PLC0415

    check_output_folder(out)
    with progress_bar("reading poses") as update:
        loaded = load_poses(rig)
        update("fitting", 0.2)
        try:
            found = calibrate_poses(loaded, huber=huber)
        except ValueError as problem:
            if isinstance(problem, InputError):
                raise
            raise InputError(
                f"{rig}: {problem}; check units, signs and the order of the columns"
            ) from None
        update("proposing poses", 0.6)
        proposals = propose(found)
        said = sentences(found, proposals)
        page = calibration_html(found, said)
    text = json_text("calibration", to_dict(found, proposals), loaded.files)
    files = write_files(
        out,
        {
            "geometry.toml": geometry_file(found, said),
            "calibration.json": text,
            "report.html": page,
        },
    )
    if as_json:
        print(text, end="")
        return
    for sentence in said:
        print(f"- {sentence}")
    print(f"written: {', '.join(str(f) for f in files)}")
