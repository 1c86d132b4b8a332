"""The command `sms`."""

from __future__ import annotations

import errno
import io
import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from sms.cli import (
    calibrate,
    can,
    demo,
    export,
    history,
    identify,
    limits,
    mechanism,
    new,
    noise,
    schema,
    simulate,
    study,
    validate,
    watch,
)
from sms.cli.assets import Assets
from sms.errors import InputError
from sms.progress import INTERRUPTED_CODE, progress_bar
from sms.report.assets import Place

app = typer.Typer(
    help="Pneumatic motion platform: what measured data says about its simulation.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
)
BAD_INPUT = 2


def _version(wanted: bool) -> None:
    if wanted:
        from sms import __version__  # noqa: PLC0415 (the core; --help must not wait for it)

        print(__version__)
        raise typer.Exit


@app.callback()
def _sms(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_version, is_eager=True, help="Print the version and stop."
        ),
    ] = False,
) -> None:
    pass


@app.command(
    epilog="Example: **sms diagnose cylinder_o_ring.toml --out report** reads the rig file, finds what its "
    "model gets wrong on the records it lists, and writes report/report.html (look at it in a "
    "browser), report/diagnosis.json (for programs) and report/extended.toml (the rig file with the "
    "causes built in; diagnose accepts it again)."
)
def diagnose(
    rig: Annotated[
        Path,
        typer.Argument(
            help="The rig file (TOML): what was measured, what is known, which records; of kind *fmu* with an FMU "
            "as the plant."
        ),
    ],
    out: Annotated[
        Path, typer.Option(help="Folder for report.html, diagnosis.json and extended.toml.")
    ] = Path("diagnosis"),
    seed: Annotated[
        int, typer.Option(help="Seed of the resampling; the same seed gives the same answer.")
    ] = 1,
    empirical: Annotated[
        bool,
        typer.Option(
            "--empirical",
            help="Where the cause is unknown, carry the curve of what is missing along as an empirical term (not "
            "explained), measure its gain on unseen records and write it to empirical.csv.",
        ),
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print diagnosis.json instead of the table.")
    ] = False,
    threads: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Of the core; by default as SMS_THREADS says, else 2.",
        ),
    ] = None,
    history_file: Annotated[
        Path | None,
        typer.Option(
            "--history",
            metavar="FILE.sqlite",
            help="Also add the answer to the history of this machine; **sms history** shows it.",
        ),
    ] = None,
    measured: Annotated[
        str | None,
        typer.Option(
            metavar="DATE",
            help="When the records were measured, for the history; by default as the rig file says, else when the "
            "records were changed last.",
        ),
    ] = None,
    machine: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="With --history: says that it is this machine, whatever its title."
        ),
    ] = None,
    assets: Assets = Place.inside,
) -> None:
    """Find what the simulation of a rig gets wrong, name the cause, extend the model, measure the gain.

    The model is fitted to the records with role *identify*, every effect of the catalogue that these signals can
    show is tried on top of it, and only what also helps on the records with role *validate* is named. The verdict
    is one of: no-evidence, cause, class (causes that these signals cannot tell apart), combination, unknown,
    data-fault.
    """
    from sms.diagnosis import diagnose as run  # noqa: PLC0415 (scipy takes a second; --help must not)
    from sms.diagnosis.own import Answer, diagnose_fmu  # noqa: PLC0415
    from sms.diagnosis.own.fmu_file import is_fmu_rig, write_fmu_diagnosis  # noqa: PLC0415
    from sms.diagnosis.result import as_json as diagnosis_json  # noqa: PLC0415
    from sms.io.measured import parse_measured  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415
    from sms.report.console import print_diagnosis  # noqa: PLC0415
    from sms.report.files import write_diagnosis  # noqa: PLC0415
    from sms.rigs.threads import use_threads  # noqa: PLC0415

    if threads is not None:
        use_threads(threads)
    check_output_folder(out)
    stated = None if measured is None else parse_measured(measured, "--measured")
    if machine is not None and history_file is None:
        raise InputError("--machine: it is said of a history; name that with --history")
    if history_file is not None:
        if is_fmu_rig(rig):
            raise InputError(
                f"{rig}: a history is kept of rigs of this project, not of FMUs; leave --history out"
            )
        history.check_history(history_file, rig, machine)
    with progress_bar("reading records") as tell:
        answer = (diagnose_fmu if is_fmu_rig(rig) else run)(rig, seed, tell, empirical)
        if stated is not None:
            answer = replace(answer, measured=stated, measured_from="stated")
        tell("writing the report", 0.95)
        files = (
            write_fmu_diagnosis(answer, rig, out)
            if isinstance(answer, Answer)
            else write_diagnosis(answer, rig, out)
        )
    added = ""
    if history_file is not None:
        added = history.add_diagnosis(history_file, answer, out / "diagnosis.json", machine)
    if as_json:
        print(diagnosis_json(answer), end="")
        return
    console = Console()
    print_diagnosis(answer, console)
    written = f"written: {', '.join(str(f) for f in files)}"
    console.print(written, style="dim", soft_wrap=True, markup=False)
    if added:
        console.print(added, style="dim", soft_wrap=True, markup=False)


demo.register(app)
mechanism.register(app)
identify.register(app)
calibrate.register(app)
limits.register(app)
simulate.register(app)
study.register(app)
can.register(app)
noise.register(app)
new.register(app)
schema.register(app)
export.register(app)
history.register(app)
validate.register(app)
watch.register(app)


def main() -> None:
    """Run the command; a person's bad input is one sentence and exit code 2."""
    if isinstance(
        sys.stdout, io.TextIOWrapper
    ):  # of a name or a unit that the terminal has no letters for
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        app()
    except InputError as problem:
        print(f"sms: {_in_one_line(str(problem))}", file=sys.stderr)
        sys.exit(BAD_INPUT)
    except OSError as problem:
        if problem.errno != errno.ENAMETOOLONG:
            raise
        name = _in_one_line(str(problem.filename))
        print(f"sms: '{name[:60]}...': too long for a file's name; choose another", file=sys.stderr)
        sys.exit(BAD_INPUT)
    except KeyboardInterrupt:
        print("sms: stopped; nothing was written", file=sys.stderr)
        sys.exit(INTERRUPTED_CODE)


def _in_one_line(sentence: str) -> str:
    """A sentence quotes what a file holds: a line's end or another control character in it is shown as its code."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in sentence)
