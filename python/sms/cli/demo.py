"""The command `sms demo`."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from sms.cli.assets import Assets
from sms.data import cylinder_rig
from sms.progress import progress_bar
from sms.report.assets import Place

if TYPE_CHECKING:
    from sms.callbacks import Progress
    from sms.demo import Hidden
    from sms.diagnosis import Diagnosis

REAL = ("cylinder_o_ring", "cylinder_kdn")
LARGEST_SEED = 10**6


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: **sms demo --seed 7** draws what is wrong; **sms demo --effect moving_mass** chooses it; "
        "**sms demo --real** diagnoses the cylinder whose measured records come with the package."
    )(demo)


def demo(
    out: Annotated[Path, typer.Option(help="Folder for records, rig file and report.")] = Path(
        "demo"
    ),
    real: Annotated[
        bool, typer.Option("--real", help="A cylinder that others measured, with two seals.")
    ] = False,
    seed: Annotated[
        int | None,
        typer.Option(min=0, help="Of what is drawn: effect, size, noise. Fresh if left out."),
    ] = None,
    effect: Annotated[
        str | None,
        typer.Option(
            help="What to hide: fitting_leakage, supply_droop, moving_mass, tube or sensor_lag. Drawn if left out."
        ),
    ] = None,
    show: Annotated[
        bool | None,
        typer.Option(
            "--open/--no-open",
            help="Show the report in a browser; by default where there is one and this is a terminal.",
        ),
    ] = None,
    as_json: Annotated[
        Path | None,
        typer.Option("--json", metavar="FILE", help="Also write what was hidden and said here."),
    ] = None,
    assets: Assets = Place.inside,
) -> None:
    """A demonstration in half a minute: one thing is wrong with a virtual bench actuator, and has to be found.

    What is wrong is drawn and sealed: its SHA-256 stands in the first lines, and it is shown beside the verdict at the
    end. In between is what *sms diagnose* does with anybody's records. DIR then holds records, rig.toml, report.html,
    diagnosis.json, extended.toml and truth.json. The records come from the package's own simulation: it shows what an
    answer looks like; how often answers are right is counted elsewhere, on independent simulators.
    """
    from sms.demo.folder import check_demo_folder  # noqa: PLC0415 (scipy takes a second; --help must not)
    from sms.errors import InputError  # noqa: PLC0415
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import check_output_folder, write_text_atomically  # noqa: PLC0415

    if real and (seed is not None or effect is not None):
        raise InputError("--real draws nothing; leave --seed and --effect out")
    check_demo_folder(out)
    if as_json is not None:
        check_output_folder(as_json.absolute().parent)
    console = Console()
    if real:
        told = real_cylinder(out, console)
    else:
        told = hidden_effect(out, drawn_seed() if seed is None else seed, effect, console)
    if as_json is not None:
        write_text_atomically(as_json, json_text("demo", told))
    page = out / (f"{REAL[0]}/report.html" if real else "report.html")
    open_page(page, show, console)


def drawn_seed() -> int:
    """Of a demonstration whose seed nobody gave."""
    import secrets  # noqa: PLC0415 (--help must not wait for it)

    return secrets.randbelow(LARGEST_SEED)


def hidden_effect(out: Path, seed: int, effect: str | None, console: Console) -> dict[str, Any]:
    """Hide, seal, diagnose, then open the truth and print it beside the verdict."""
    from sms.demo import Sealed, draw_hidden, open_sealed, write_bench  # noqa: PLC0415
    from sms.demo.bench import streams  # noqa: PLC0415
    from sms.demo.folder import SEAL, whole_folder  # noqa: PLC0415
    from sms.demo.hidden import said  # noqa: PLC0415

    begin = time.monotonic()
    for_effect, for_machine, for_noise, for_seal = streams(seed)
    hidden = draw_hidden(effect, for_effect)
    truth = {
        "effect": hidden.key,
        "parameter": hidden.parameter,
        "value": hidden.value,
        "unit": hidden.unit,
    }
    sealed = Sealed.of({**truth, "seed": seed}, for_seal.bytes(16))
    with whole_folder(out) as folder:
        rig = write_bench(folder, hidden, for_machine, for_noise)
        (folder / SEAL).write_text(f"{sealed.sha256}  truth.json\n", encoding="utf-8")
        console.print(
            f"One thing is wrong with a virtual bench actuator (seed {seed}).", soft_wrap=True
        )
        console.print(f"What it is is sealed: sha256 {sealed.sha256}\n", soft_wrap=True)
        with progress_bar("reading records") as tell:
            answer = diagnosed(rig, folder, tell)
        opened = open_sealed(sealed.content, sealed.sha256)
        (folder / "truth.json").write_bytes(sealed.content)
    told(answer, out, console)
    console.print(f"\nverdict: [bold]{verdict_of(answer)}[/bold]", soft_wrap=True)
    console.print(
        f"truth:   [bold]{words_of(hidden)}[/bold] ({out / 'truth.json'})", soft_wrap=True
    )
    return {
        "seed": seed,
        "sha256": sealed.sha256,
        "truth": opened,
        "verdict": answer.verdict,
        "named": said(answer),
        "found": hidden.named_by(answer),
        "parameters": [
            {"name": p.name, "value": p.value, "standard_error": p.standard_error, "unit": p.unit}
            for cause in answer.causes
            for p in cause.parameters
        ],
        "seconds": round(time.monotonic() - begin, 1),
        "report": str(out / "report.html"),
    }


def real_cylinder(out: Path, console: Console) -> dict[str, Any]:
    """Diagnose the measured cylinder with each of two seals."""
    from sms.demo.folder import whole_folder  # noqa: PLC0415
    from sms.demo.hidden import said  # noqa: PLC0415

    begin = time.monotonic()
    answers = {}
    with whole_folder(out) as folder, progress_bar("reading records") as tell:
        for name in REAL:
            answers[name] = diagnosed(cylinder_rig(name), folder / name, tell)
    for name, answer in answers.items():
        told(answer, out / name, console)
    return {
        "rigs": {
            name: {
                "verdict": a.verdict,
                "named": said(a),
                "report": str(out / name / "report.html"),
            }
            for name, a in answers.items()
        },
        "seconds": round(time.monotonic() - begin, 1),
    }


def diagnosed(rig: Path, folder: Path, tell: Progress) -> Diagnosis:
    """The answer, and its files in the folder."""
    from sms.diagnosis import diagnose  # noqa: PLC0415
    from sms.report.files import write_diagnosis  # noqa: PLC0415

    answer = diagnose(rig, progress=tell)
    tell("writing the report", 0.95)
    write_diagnosis(answer, rig, folder)
    return answer


def told(answer: Diagnosis, folder: Path, console: Console) -> None:
    """The answer on the console, and where its report is."""
    from sms.report.console import print_diagnosis  # noqa: PLC0415

    print_diagnosis(answer, console)
    console.print(f"report: [bold]{folder / 'report.html'}[/bold]", soft_wrap=True)


def verdict_of(answer: Diagnosis) -> str:
    """What is named, with its size; of a class every explanation."""
    from sms.report.verdict import VERDICT_WORDS, is_shift, parameter_text  # noqa: PLC0415

    named = [
        " or ".join(dict.fromkeys([cause.title, *(other.title for other in cause.alternatives)]))
        + f", {parameter_text(cause.parameters[0], is_shift(cause.parameters[0]))}"
        for cause in answer.causes
    ]
    return "; ".join(named) or VERDICT_WORDS[answer.verdict].lower()


def words_of(hidden: Hidden) -> str:
    """What was hidden, as the catalogue calls it, with its size."""
    from sms.units_display import format_quantity  # noqa: PLC0415

    return f"{hidden.effect.title}, {format_quantity(hidden.value, hidden.unit, hidden.parameter)}"


# ---- showing it ----------------------------------------------------------------------------------


def open_page(page: Path, wanted: bool | None, console: Console) -> None:
    """Show a page in the browser, if there is one, and it is wanted or nobody said and this is a terminal."""
    if wanted is False or (wanted is None and not sys.stdout.isatty()):
        return
    import webbrowser  # noqa: PLC0415 (--help must not wait for it)

    if not (has_browser() and webbrowser.open(page.resolve().as_uri())) and wanted:
        console.print(f"There is no browser here; open {page} in one.", soft_wrap=True)


def has_browser() -> bool:
    """Whether a browser has a screen: what else `webbrowser` finds would take this terminal."""
    on_screen = ("BROWSER", "DISPLAY", "WAYLAND_DISPLAY")
    return sys.platform in ("darwin", "win32") or any(os.environ.get(name) for name in on_screen)
