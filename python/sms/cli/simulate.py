"""The commands `sms simulate` and `sms sweep`."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sms.cli.assets import Assets
from sms.cli.mechanism import AsJson, Settings, bad_input, files_first, is_file
from sms.data import scenario_file
from sms.errors import InputError
from sms.progress import INTERRUPTED_CODE, progress_bar
from sms.report.assets import Place

if TYPE_CHECKING:
    from sms.scenario import Scenario

MIN_SAMPLES = 16


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command(
        epilog="Example: **sms simulate waves_3012 --out run** writes run/run.csv, run/run.json and "
        "run/report.html with the platform moving in 3-D. docs/simulation.md explains every key of "
        "the scenario file."
    )(simulate)
    app.command(
        epilog="Example: **sms sweep payload.toml --out sweep** runs every variant on the cores of this "
        "machine and writes sweep/sweep.parquet and sweep/sweep.html; **--scheduler "
        "tcp://10.0.0.1:8786** sends them to a Dask cluster."
    )(sweep)


def simulate(
    scenario: Annotated[
        Path,
        typer.Argument(
            help="The scenario file (TOML): plant, controller, motion; or one that is shipped: waves_3012, waves_3061."
        ),
    ],
    out: Annotated[
        Path, typer.Option(help="Folder for the run, its findings and the page.")
    ] = Path("run"),
    scale: Annotated[
        float | None,
        typer.Option(help="Froude scale of the deck motion: ship's length over model's."),
    ] = None,
    settings: Settings = [],  # noqa: B006 (typer copies it)
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """Simulate platform, bench or tank: a scenario in, what comes out, and where its limit is.

    The command is a deck-motion record (roll, pitch, heave in any unit; band-limited, Froude-scaled,
    held against the workspace and the speed limits), a synthetic sea, or an excitation. A tank is
    charged and emptied by its valve, as in the flow test. Ctrl-C ends the run and keeps what was
    computed as run.partial.
    """
    from sms.report.run_files import run_json, write_run  # noqa: PLC0415
    from sms.scenario import command_of, findings_of, load_scenario, run_scenario  # noqa: PLC0415
    from sms.scenario.tank import TankRecord, run_tank, tank_findings  # noqa: PLC0415

    with bad_input():
        asked = with_scale(load_scenario(scenario_file(scenario), settings_in_si(settings)), scale)
        with progress_bar("preparing the motion") as tell:
            command = command_of(asked)
            tank = asked.plant == "tank"
            record = (run_tank if tank else run_scenario)(
                asked, command, lambda share: tell("simulating", share)
            )
            if record.time.size < MIN_SAMPLES:
                raise InputError(f"{scenario}: {record.ended or 'too short'}; nothing was written")
            tell("writing", 1.0)
            findings = (
                tank_findings(asked, record)
                if isinstance(record, TankRecord)
                else findings_of(asked, command, record)
            )
            files = write_run(out, asked, command, record, findings)
    if as_json:
        print(run_json(asked, command, record, findings), end="")
    else:
        for sentence in findings.sentences:
            print(f"- {sentence}")
        print(f"written: {', '.join(str(file) for file in files)}")
    if not record.complete:
        end_partial(asked, record.ended, files)


def with_scale(scenario: Scenario, scale: float | None) -> Scenario:
    """The scenario with the deck motion at another Froude scale."""
    if scale is None:
        return scenario
    if scenario.deck_motion is None:
        raise InputError(f"--scale {scale:g}: {scenario.path} has no [deck_motion] to scale")
    return replace(scenario, deck_motion=scenario.deck_motion.model_copy(update={"scale": scale}))


def settings_in_si(settings: list[str]) -> dict[str, float]:
    """--set NAME=VALUE as numbers, a value may carry a unit; and --set FILE, before which the others go."""
    from sms.parameter_files import read_values  # noqa: PLC0415
    from sms.parameters import LEG_PARAMETERS  # noqa: PLC0415
    from sms.scenario.load import parameter_value  # noqa: PLC0415

    values: dict[str, float] = {}
    for setting in files_first(settings):
        if is_file(setting):
            values |= read_values(setting)
            continue
        name, equals, value = (part.strip() for part in setting.partition("="))
        if not equals:
            raise InputError(f"--set {setting}: write NAME=VALUE, for instance payload_mass=280")
        if name in LEG_PARAMETERS and value.replace(".", "", 1).lstrip("+-").isdigit():
            value = f"{value} {LEG_PARAMETERS[name].unit}".removesuffix(" 1")
        values[name] = parameter_value(name, value, f"--set {setting}")
    return values


def end_partial(scenario: Scenario, ended: str, files: list[Path]) -> None:
    """Say that a run is partial, and leave with the code of Ctrl-C or of bad input."""
    from sms.scenario.load import TOLERANCES  # noqa: PLC0415
    from sms.scenario.plant import INTERRUPTED, MISSED  # noqa: PLC0415

    if ended == INTERRUPTED:
        print(f"sms: stopped; {files[0]} holds what was computed until then", file=sys.stderr)
        raise typer.Exit(INTERRUPTED_CODE)
    kept = f"{files[0]} holds what was computed until then"
    if ended.startswith(MISSED):
        raise InputError(
            f"{scenario.path}, [model] tolerance: {ended}; {TOLERANCES[0]:g} to {TOLERANCES[1]:g} "
            f"is allowed, a larger one may get through; {kept}"
        )
    raise InputError(f"{scenario.path}, [parameters]: {ended}; {kept}")


def sweep(
    plan: Annotated[
        Path, typer.Argument(help="The sweep file (TOML): a scenario and what varies in it.")
    ],
    out: Annotated[Path, typer.Option(help="Folder for sweep.parquet and sweep.html.")] = Path(
        "sweep"
    ),
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; by default one a core.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help='An existing Dask scheduler, "tcp://host:port".'),
    ] = None,
    assets: Assets = Place.inside,
) -> None:
    """Run many variants of a scenario: any parameters, on grids or drawn from distributions.

    What is finished is kept at once: after Ctrl-C the same command goes on where it stopped.
    """
    from sms.report.page import write_page  # noqa: PLC0415
    from sms.report.sweep import sentences, sweep_html  # noqa: PLC0415
    from sms.sweep.plan import load_sweep  # noqa: PLC0415
    from sms.sweep.run import PARTIAL, WHOLE, run_sweep  # noqa: PLC0415

    with bad_input():
        asked = load_sweep(plan)
        kept = f"{out / PARTIAL} keeps what is done, the same command goes on"
        with progress_bar("starting", kept) as tell:
            results = run_sweep(asked, out, workers, scheduler, tell)
        write_page(out / "sweep.html", sweep_html(asked, results))
    for sentence in sentences(asked, results):
        print(f"- {sentence}")
    print(f"written: {out / WHOLE}, {out / 'sweep.html'}")
