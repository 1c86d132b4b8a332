"""The commands `sms identify ...`: from test-bench records to parameters with errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from sms.cli.assets import Assets
from sms.progress import progress_bar
from sms.report.assets import Place

if TYPE_CHECKING:
    from sms.io.declarations import Declaration

RigFile = Annotated[
    Path,
    typer.Argument(help="The rig file (TOML): what was measured, what is known, which records."),
]
Out = Annotated[Path, typer.Option(help="Folder for the parameter file, the JSON and report.html.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the JSON instead of the summary.")]
Huber = Annotated[
    float,
    typer.Option(
        help="Robust loss: readings further off than this many standard deviations of the noise count "
        "with their distance, not its square. 0: least squares.",
        min=0.0,
    ),
]

identify = typer.Typer(
    help="From test-bench records to parameters: values, errors, and what these records cannot tell.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
)


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.add_typer(identify, name="identify")


@identify.command(
    epilog="Example: **sms identify flow valve.toml --out flow** writes flow/flow.toml (the valve map, "
    "read by load_valve_map), flow/flow.json (covariances, diagnostics) and flow/report.html."
)
def flow(
    rig: RigFile,
    out: Out = Path("flow"),
    huber: Huber = 0.0,
    monotone: Annotated[
        bool, typer.Option(help="Keep C from falling while the valve opens, in the map.")
    ] = True,
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """C, b and m of a valve from charges and discharges of a tank.

    The rig is of kind *flow_test*; each record holds one charge or discharge at a constant spool position, said in
    its *conditions* (spool_position, supply_pressure). Every record is fitted by the ISO 6358 law and by the classic
    one; a sensor that saturates, the moment of opening, the start and the outside pressure are part of the fit. What
    a record cannot tell is called not identifiable.
    """
    from sms.identification.flow import fit_records  # noqa: PLC0415
    from sms.identification.flow_result import assemble, parameter_file  # noqa: PLC0415
    from sms.identification.flow_rig import load_flow_test  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second)
    from sms.report.flow import flow_html  # noqa: PLC0415

    check_output_folder(out)
    with progress_bar("reading records") as update:
        loaded, records, findings = load_flow_test(rig)
        heat = loaded.model.chambers
        fits = fit_records(records, loaded.declared, heat, huber, progress=update)
        ratios = [loaded.declared(f"{way}flow_heat_ratio").value for way in ("in", "out")]
        result = assemble(
            loaded.title, rig.name, heat, (ratios[0], ratios[1]), fits, findings, monotone
        )
        page = flow_html(result)
    text = json_text("identify_flow", result.to_dict(), loaded.files)
    files = write_files(
        out, {"flow.toml": parameter_file(result), "flow.json": text, "report.html": page}
    )
    if as_json:
        print(text, end="")
        return
    for sentence in result.sentences():
        print(f"- {sentence}")
    for fit in result.fits:
        for fault in fit.look.faults:
            print(f"- {fit.record.name}: {fault}")
    print(f"written: {', '.join(str(f) for f in files)}")


@identify.command(
    epilog="Example: **sms identify friction cylinder.toml --out friction** writes friction/friction.toml (the rig "
    "file with what was identified; every other command reads it), friction/friction.json and "
    "friction/report.html."
)
def friction(
    rig: RigFile,
    out: Out = Path("friction"),
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """The friction of a cylinder from its displacement and its pressures.

    The rig is of kind *cylinder* or *bench*; without a rod force the piston is taken as unloaded. The source's law
    (eq. 6.5) and its rivals (eq. 6.1, eq. 6.2, LuGre) are fitted to the records with role *identify* and judged on
    the others. Parameters that these motions cannot show are left where they are declared, and named.
    """
    from sms.identification import friction_result  # noqa: PLC0415
    from sms.identification.friction import identify_friction  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second)
    from sms.report.friction import friction_html  # noqa: PLC0415

    check_output_folder(out)
    with progress_bar("reading records") as update:
        result = identify_friction(rig, update)
        page = friction_html(result)
    _deliver(
        "friction",
        rig,
        out,
        page,
        friction_result.sentences(result),
        friction_result.declarations(result),
        friction_result.to_dict(result),
        as_json,
    )


@identify.command(
    epilog="Example: **sms identify actuator bench.toml --out actuator** writes actuator/actuator.toml (the rig file "
    "with what was identified; every other command reads it), actuator/actuator.json (covariance, gain, diagnostics) "
    "and actuator/report.html."
)
def actuator(
    rig: RigFile,
    out: Out = Path("actuator"),
    huber: Huber = 0.0,
    starts: Annotated[
        int,
        typer.Option(help="Starting points; the second and later ones are drawn.", min=1, max=50),
    ] = 1,
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """Mass, dead volumes, mass-flow gain, heat ratios and friction of an actuator, together.

    The rig is of kind *bench*. Its records are predicted from the command in windows of a second, each from an initial
    state of its own, and all parameters are fitted at once to extension and pressures. What the rig file knows within
    limits is fitted within them; what the records cannot tell is named and stays as declared. Records with role
    *validate* are not used for the fit: on them the result is judged.
    """
    from sms.identification import bench_result  # noqa: PLC0415
    from sms.identification.actuator import identify_actuator  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second)
    from sms.report.actuator import actuator_html  # noqa: PLC0415

    check_output_folder(out)
    with progress_bar("reading records") as update:
        result = identify_actuator(rig, huber, starts, update)
        page = actuator_html(result)
    _deliver(
        "actuator",
        rig,
        out,
        page,
        bench_result.sentences(result),
        bench_result.declarations(result),
        bench_result.to_dict(result),
        as_json,
    )


@identify.command(
    epilog="Example: **sms identify spool valve.toml --out spool** writes spool/spool.toml (the rig file with what was "
    "identified), spool/spool.json and spool/report.html."
)
def spool(
    rig: RigFile,
    out: Out = Path("spool"),
    huber: Huber = 0.0,
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """The valve's spool: static law, natural frequency, damping, dead time; centre and dead band.

    Position is used where it was measured: a rig of kind *spool_test* (valve_command, spool_position), or *bench* with
    that column. On a bench pressures say at which command the valve is closed, how wide its dead band is, and how it
    lags. What is missing, and what that prevents, is said.
    """
    from sms.identification import spool_result  # noqa: PLC0415
    from sms.identification.spool import identify_spool  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415 (scipy takes a second)
    from sms.report.spool import spool_html  # noqa: PLC0415

    check_output_folder(out)
    with progress_bar("reading records") as update:
        result = identify_spool(rig, huber, update)
        page = spool_html(result)
    _deliver(
        "spool",
        rig,
        out,
        page,
        spool_result.sentences(result),
        spool_result.declarations(result),
        spool_result.to_dict(result),
        as_json,
    )


# ---- shared ------------------------------------------------------------------------------------------------


def _deliver(
    subject: str,
    rig: Path,
    out: Path,
    page: str,
    sentences: Sequence[str],
    declarations: Mapping[str, Declaration],
    answer: Mapping[str, Any],
    as_json: bool,
) -> None:
    """The rig file with what was found, the JSON and the page; then the sentences, or the JSON, on the terminal."""
    from sms.io import load_rig, write_extended_rig  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415

    text = json_text(f"identify_{subject}", answer, load_rig(rig).files)
    header = "\n".join([f"Identified by sms identify {subject}.", *sentences])
    write_extended_rig(rig, out / f"{subject}.toml", declarations, header)
    files = write_files(out, {f"{subject}.json": text, "report.html": page})
    if as_json:
        print(text, end="")
        return
    for sentence in sentences:
        print(f"- {sentence}")
    print(f"written: {', '.join(str(f) for f in (out / f'{subject}.toml', *files))}")


def write_files(out: Path, texts: dict[str, str]) -> Sequence[Path]:
    """Each file whole or not at all."""
    from sms.io import write_text_atomically  # noqa: PLC0415 (pandas takes its time; --help must not)
    from sms.report.page import write_page  # noqa: PLC0415

    for name, text in texts.items():
        (write_page if name.endswith(".html") else write_text_atomically)(out / name, text)
    return [out / name for name in texts]
