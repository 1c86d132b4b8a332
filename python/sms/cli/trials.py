"""The command `sms trials`: effects hidden in virtual measurements, and what the diagnosis says of them."""

from __future__ import annotations

import importlib
import secrets
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from sms.io.errors import InputError


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: **sms trials --rig bench --count 200 --out trials**. A trial takes some twenty "
        "seconds of one core. Stopped with Ctrl-C, it goes on where it was when called again with the "
        "same --out and --seed."
    )(trials)


def trials(
    rig: Annotated[str, typer.Option(help="What is measured: bench, platform or tank.")] = "bench",
    count: Annotated[int, typer.Option(min=1, help="How many trials.")] = 40,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the first; fresh and printed if left out.")
    ] = None,
    multiple: Annotated[
        float, typer.Option(help="Size of the hidden effect, times its detection limit.")
    ] = 3.0,
    out: Annotated[Path, typer.Option(help="Folder for trials.jsonl and trials.html.")] = Path(
        "trials"
    ),
    workers: Annotated[int, typer.Option(min=1, help="Processes on this machine.")] = 2,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help='An existing Dask scheduler, "tcp://host:port", its workers started in a checkout of the project.',
        ),
    ] = None,
) -> None:
    """Hide effects in virtual measurements, diagnose them blind, and write the confusion matrix.

    Half of the trials hide an effect of the catalogue, a fifth nothing, a fifth something that the catalogue does not
    have, a tenth two effects at once. The truth is sealed before the diagnosis begins and opened after. The simulator
    that makes the measurements is independent of the core; it lies in the project's checkout, so the command has to be
    run there.
    """
    plant_trial = _plant_trial()
    first = secrets.randbelow(10**6) if seed is None else seed
    console = Console()
    console.print(f"[dim]--rig {rig} --seed {first} --count {count} --multiple {multiple:g}[/dim]")
    if rig not in plant_trial.effects.RIGS:
        raise InputError(
            f"--rig: there is no virtual '{rig}'; choose {', '.join(plant_trial.effects.RIGS)}"
        )
    wanted = plant_trial.tasks(rig, first, count, multiple)
    file = out / "trials.jsonl"
    columns = (
        TextColumn("hiding and finding"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=count)
        have = plant_trial.done_already(file)
        progress.advance(task, sum((t.kind, t.seed, t.sort, t.multiple) in have for t in wanted))
        outcomes = plant_trial.run_tasks(
            wanted, file, workers, scheduler, lambda outcome: progress.advance(task)
        )
    console.print(summary(plant_trial.goals(outcomes)))
    for o in outcomes:
        if not o.right:
            hidden = " + ".join(o.hidden) or "nothing"
            console.print(f"[dim]seed {o.seed}[/dim] hidden {hidden}, said {o.said}")
    from sms.io.write import write_text_atomically  # noqa: PLC0415
    from sms.report.trials import trials_html  # noqa: PLC0415 (plotly takes a second)

    page = out / "trials.html"
    write_text_atomically(page, trials_html(rig, first, multiple, outcomes, plant_trial))
    console.print(f"[dim]written: {page}, {file}[/dim]")


def trial_of_worker(checkout: str, task: dict[str, Any]) -> dict[str, Any]:
    """One trial on a worker of a cluster: the fields of its outcome.

    Workers know the package sms, not the virtual rigs: those come from the checkout in which a worker was started, or
    from the one of the command, where both see the same files.
    """
    plant_trial = _plant_trial(Path(checkout))
    return asdict(plant_trial.run_task(plant_trial.Task(**task)))


def _plant_trial(otherwise: Path | None = None) -> ModuleType:
    """The trials' own module, from the checkout in which this command was called. InputError outside of one."""
    checkout = _checkout(Path.cwd()) or (_checkout(otherwise) if otherwise is not None else None)
    if checkout is None:
        raise InputError(
            f"{Path.cwd()} is not in a checkout of the project, where the virtual rigs are; "
            "call this in one, after ./dev build"
        )
    if str(checkout) not in sys.path:
        sys.path.insert(0, str(checkout))
    try:
        return importlib.import_module("validation.hidden_effects.plant_trial")
    except ModuleNotFoundError as problem:
        raise InputError(
            f"the virtual rigs need the Python package {problem.name}; ./dev build installs it"
        ) from None


def _checkout(folder: Path) -> Path | None:
    """The nearest folder above, or this one, that has the virtual rigs."""
    above = (folder, *folder.parents)
    return next(
        (f for f in above if (f / "validation/hidden_effects/plant_trial.py").is_file()), None
    )


def summary(goals: Sequence[Any]) -> Table:
    """The goals, counted."""
    table = Table(title="what came out", title_justify="left", title_style="bold", box=None)
    for name in ("", "count", "of", "share", "wanted"):
        table.add_column(name, justify="left" if name == "" else "right")
    for g in goals:
        share = f"{100 * g.share:.0f} %" if g.of else "-"
        table.add_row(g.what, str(g.count), str(g.of), share, g.wanted)
    return table
