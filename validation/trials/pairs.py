"""`./dev trials pairs`: a virtual machine measured on two days, and what `sms compare-diagnoses` says of the diagnoses.

Between the days nothing happens, or one effect sets in, at one, two or three times its detection limit; or it is there
on both days, at one or three times its limit. The machine is drawn within what its rig file declares, and off from it
by an imperfection; on the second day it makes other motions under other noise. Unlike `./dev trials history`, whose
answers are drawn, this counts whole diagnoses.
"""

from __future__ import annotations

import os
import secrets
import tempfile
from collections.abc import Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from sms.diagnosis import diagnose
from sms.history import Answer
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.compared import as_answer, called_changed
from validation.trials.processes import processes
from validation.trials.shares import Share, at_least, at_most, share_table, shares_as_dicts
from validation.twins.draw import RIGS, Trial, draw_trial, drawable, size_of, write_trial

TIMES = ((0.0, 0.0), (1.0, 1.0), (3.0, 3.0), (0.0, 1.0), (0.0, 2.0), (0.0, 3.0))
"""Times its detection limit, of the effect on the first and on the second day."""


@dataclass(frozen=True)
class Pair:
    """What was said of one pair."""

    kind: str
    seed: int
    imperfection: float
    hidden: str
    """The effect that may have set in."""
    before: float
    after: float
    """Times its limit."""
    limit: float
    changed: list[list[str]]
    """The members of each cause that is called changed; a number of the declared model, with effects that shift it."""
    verdicts: tuple[str, str]

    @property
    def called(self) -> bool:
        return bool(self.changed)

    @property
    def wrong(self) -> bool:
        """Something is called changed that has not, or under names of which none is right."""
        steady = self.before == self.after
        return any(steady or self.hidden not in names for names in self.changed)


def pairs_of(kind: str, seed: int, imperfection: float) -> list[Pair]:
    """A machine's first day against a second one of each size."""
    well = draw_trial(kind, seed, "none", 1.0, imperfection)
    rng = np.random.default_rng([seed, 18])
    excited = "+".join(run.excited_by for run in well.runs if run.role == "identify")
    seen = [
        e for e in drawable(kind, excited, max(after for _, after in TIMES)) if e.drawn_from is None
    ]
    effect = seen[int(rng.integers(len(seen)))]
    sign = float(rng.choice([-1.0, 1.0])) if effect.signed else effect.sense
    limit = size_of(kind, excited, effect, 1.0, well.loudness, 0.0)[0]

    def of(times: float, day: int) -> Answer:
        size = sign * times * limit
        truth = effect.hidden_in(well.truth, size) if times > 0.0 else well.truth
        return _diagnosed(replace(well, truth=truth, day=day), f"day {day + 1}")

    first = {times: of(times, 0) for times in sorted({before for before, _ in TIMES})}
    second = {times: of(times, 1) for times in sorted({after for _, after in TIMES})}
    return [
        Pair(
            kind,
            seed,
            imperfection,
            effect.key,
            before,
            after,
            sign * limit,
            called_changed(kind, first[before], second[after]),
            (first[before].verdict, second[after].verdict),
        )
        for before, after in TIMES
    ]


def _diagnosed(trial: Trial, name: str) -> Answer:
    os.environ.setdefault("SMS_THREADS", "1")
    with tempfile.TemporaryDirectory() as folder:
        records = Path(folder) / "records"
        write_trial(trial, records, Path(folder) / "sealed" / "truth.json")
        return as_answer(diagnose(records / "rig.toml", seed=trial.seed), name)


def shares(pairs: Sequence[Pair]) -> list[Share]:
    """Called changed: wrongly, by size, and of these under the right name."""
    found = []
    for before, after in TIMES:
        called = [p.called for p in pairs if (p.before, p.after) == (before, after)]
        if before == after:
            there = f", {after:g} x its limit on both days" if after else ", nothing there"
            found.append(at_most(f"unchanged pair called changed{there}", called))
        else:
            found.append(at_least(f"changed by {after:g} x its limit, called so", called))
    changed = [p.wrong for p in pairs if p.before != p.after and p.called]
    return [*found, at_most("called changed, under no right name or beside another", changed)]


# ---- the command -----------------------------------------------------------------------------------


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command()(pairs)


def pairs(
    kind: Annotated[str, typer.Argument(metavar="RIG", help="bench, platform or tank.")],
    count: Annotated[
        int,
        typer.Option(min=1, help="Machines; each gives three unchanged pairs and three changed."),
    ] = 50,
    seed: Annotated[int | None, typer.Option(help="By default drawn, and printed.")] = None,
    imperfect: Annotated[
        float, typer.Option(min=0.0, max=4.0, help="% by which machines are off from the model.")
    ] = 1.0,
    workers: Annotated[int, typer.Option(min=1)] = os.cpu_count() or 1,
    as_json_file: Annotated[
        Path | None, typer.Option("--json", help="Also to this file, machine by machine.")
    ] = None,
) -> None:
    """Machines on two days, diagnosed and compared: what is called changed. A tank takes half a minute."""
    if kind not in RIGS:
        raise typer.BadParameter(f"'{kind}' is no rig: {', '.join(RIGS)}")
    first = secrets.randbelow(10**6) if seed is None else seed
    console = Console()
    console.print(f"seed {first}, {count} machines, {imperfect:g} % imperfect", style="dim")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    found: list[Pair] = []
    with processes(workers) as pool:
        jobs = [pool.submit(pairs_of, kind, first + i, imperfect) for i in range(count)]
        for number, job in enumerate(as_completed(jobs), 1):
            found += job.result()
            said = found[-len(TIMES) :]
            console.print(
                f"{number} of {count}: seed {said[0].seed}, {said[0].hidden}: "
                + ", ".join(
                    f"{p.before:g} to {p.after:g} x {'changed' if p.called else '-'}" for p in said
                ),
                soft_wrap=True,
            )
            for pair in said:
                if pair.wrong:
                    console.print(
                        f"  {pair.before:g} to {pair.after:g} x: {pair.verdicts} {pair.changed}",
                        soft_wrap=True,
                    )
            if as_json_file is not None:
                _write(as_json_file, first, imperfect, found)
    console.print(share_table(shares(found)))


def _write(file: Path, seed: int, imperfection: float, found: Sequence[Pair]) -> None:
    """What is known so far, machine by machine: hours of trials that are stopped keep what they have."""
    content: dict[str, Any] = {
        "seed": seed,
        "imperfection": imperfection,
        "pairs": [asdict(p) for p in sorted(found, key=lambda p: p.seed)],
        "shares": shares_as_dicts(shares(found)),
    }
    write_text_atomically(file, json_text("trials", content))
