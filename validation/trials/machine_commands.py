"""`./dev trials bench|platform|tank`: effects hidden in virtual measurements, and what the diagnosis says of them."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from sms.errors import InputError, did_you_mean
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.by_level import by_level, follow_up_shares, follow_up_table, level_table
from validation.trials.machines import SORTS, Task, done_already, run_tasks, tasks
from validation.trials.page import trials_html
from validation.trials.scoring import Outcome, confusion_table, goal_table, goals, load
from validation.trials.shares import shares_as_dicts
from validation.twins.imperfection import LARGEST

Count = Annotated[int, typer.Option(min=1, help="How many trials.")]
Seed = Annotated[int | None, typer.Option(help="Seed of the first; fresh and printed if left out.")]
Multiple = Annotated[
    float, typer.Option(help="Size of the hidden effect, times its detection limit.")
]
Out = Annotated[Path, typer.Option(help="Folder for trials.jsonl and trials.html.")]
Workers = Annotated[int, typer.Option(min=1, help="Processes on this machine.")]
Scheduler = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help='An existing Dask scheduler, "tcp://host:port", its workers started in a checkout of the project.',
    ),
]
Imperfection = Annotated[
    list[float] | None,
    typer.Option(
        metavar="PERCENT",
        help="By how much the machines are off from what a rig file can declare: RMS of smooth errors of the valve's "
        "flow and of friction, with sensors that bow, a held command, another log rate and rounding drawn along "
        "(validation/twins/imperfection.py). 0 if left out: exactly what can be declared. Given several times, "
        "every trial is made at each level, on the same machine with the same thing hidden; COUNT is for each.",
    ),
]
Follow = Annotated[
    bool,
    typer.Option(
        "--follow-proposals",
        help="Where the answer is a class: make the run that the diagnosis proposes on the hidden machine and diagnose "
        "again, twice at most; beside it the same with runs drawn from the same menu.",
    ),
]
Only = Annotated[
    str | None,
    typer.Option(
        metavar="SORT",
        help="All trials of one sort: healthy, catalogue, outside or pair. A share of 2 % that is to be believed takes "
        "149 healthy machines.",
    ),
]
Json = Annotated[
    Path | None, typer.Option("--json", help="File for goals and outcomes, for programs.")
]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    for rig in ("bench", "platform", "tank"):
        app.command(
            rig,
            epilog=f"Example: **./dev trials {rig} --count 200 --out trials**. Stopped with Ctrl-C, it goes on where "
            "it was when called again with the same --out and --seed.",
        )(_trials_of(rig))
    app.command()(score)


def _trials_of(rig: str) -> Callable[..., None]:
    def trials(
        count: Count = 40,
        seed: Seed = None,
        multiple: Multiple = 3.0,
        out: Out = Path("trials"),
        workers: Workers = 2,
        imperfection: Imperfection = None,
        follow: Follow = False,
        only: Only = None,
        scheduler: Scheduler = None,
        as_json: Json = None,
    ) -> None:
        first = secrets.randbelow(10**6) if seed is None else seed
        levels = levels_of(imperfection)
        if only is not None and only not in SORTS:
            raise InputError(f"--only {only}: no such sort of trials; {did_you_mean(only, SORTS)}")
        console = Console()
        said = "".join(f" --imperfection {level:g}" for level in levels)
        console.print(
            f"[dim]{rig} --seed {first} --count {count} --multiple {multiple:g}{said}"
            f"{'' if only is None else f' --only {only}'}[/dim]"
        )
        wanted = tasks(rig, first, count, multiple, levels, follow, only)
        outcomes = _with_progress(wanted, out, workers, scheduler)
        print_tables(console, outcomes)
        for o in outcomes:
            if not o.right:
                hidden = " + ".join(o.hidden) or "nothing"
                console.print(
                    f"[dim]seed {o.seed}, {o.imperfection:g} %[/dim] hidden {hidden}, said {o.said}"
                )
        page = out / "trials.html"
        write_text_atomically(page, trials_html(rig, first, multiple, outcomes))
        if as_json is not None:
            write_text_atomically(as_json, json_text("trials", as_dict(outcomes)))
        console.print(f"[dim]written: {page}, {out / 'trials.jsonl'}[/dim]")

    trials.__doc__ = f"""Hide effects in measurements of a virtual {rig}, diagnose them blind, count.

    Half of the trials hide an effect of the catalogue, a fifth nothing, a fifth something that the catalogue does not
    have, a tenth two effects at once. The truth is sealed before the diagnosis begins and opened after. The simulator
    that makes the measurements is independent of the core (validation/twins).
    """
    return trials


def levels_of(given: Sequence[float] | None) -> list[float]:
    """The levels that were asked for, in percent, each once. InputError for one that no machine has."""
    for level in given or ():
        if not 0.0 <= level <= LARGEST:
            raise InputError(
                f"--imperfection {level:g}: a machine is off by 0 to {LARGEST:g} percent; give a level within that"
            )
    return list(dict.fromkeys(given or (0.0,)))


def _with_progress(
    wanted: Sequence[Task], out: Path, workers: int, scheduler: str | None
) -> list[Outcome]:
    file = out / "trials.jsonl"
    columns = (
        TextColumn("hiding and finding"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=len(wanted))
        have = done_already(file)
        progress.advance(task, sum(t.done(have) for t in wanted))
        return run_tasks(wanted, file, workers, scheduler, lambda outcome: progress.advance(task))


def score(
    files: Annotated[list[Path], typer.Argument(help="Outcomes, as a trial writes them.")],
) -> None:
    """Confusion matrix and goals of outcomes (JSON lines), by level of imperfection where there is any."""
    outcomes = [outcome for path in files for outcome in load(path)]
    if not outcomes:
        raise InputError("there is no outcome in these files")
    console = Console(width=200)
    for kind in sorted({outcome.kind for outcome in outcomes}):
        own = [outcome for outcome in outcomes if outcome.kind == kind]
        console.print(f"[bold]{kind}[/bold], {len(own)} trials")
        console.print(confusion_table(own))
        print_tables(console, own)


def print_tables(console: Console, outcomes: Sequence[Outcome]) -> None:
    """The goals; by level of imperfection where machines had one; what became of the proposals where they were made."""
    if any(o.imperfection for o in outcomes):
        console.print(level_table(outcomes))
    else:
        console.print(goal_table(outcomes))
    if any(o.follow_ups for o in outcomes):
        console.print(follow_up_table(outcomes))


def as_dict(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Goals, shares and outcomes for programs."""
    return {
        "goals": [
            {"goal": g.what, "count": g.count, "of": g.of, "wanted": g.wanted}
            for g in goals(outcomes)
        ],
        "by_level": {level: shares_as_dicts(s) for level, s in by_level(outcomes).items()},
        "proposals": {arm: shares_as_dicts(s) for arm, s in follow_up_shares(outcomes).items()},
        "outcomes": [asdict(o) for o in outcomes],
    }
