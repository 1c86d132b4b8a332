"""Blind trials on simulated machines: an effect is hidden, the diagnosis has to name it, then the truth is opened.

One trial is one line of a JSON-lines file, so that a run can be stopped and taken up again: what is in the file is not
done twice. `sms trials` is the command; the generator (machines/) knows nothing of the diagnosis, and the diagnosis
nothing of it; they meet in the records' folder only.
"""

from __future__ import annotations

import json
import os
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from sms.diagnosis.catalogue import effects_of
from sms.diagnosis.method import read_and_check
from sms.diagnosis.plant import found_value, investigate, make_data
from sms.io.rig import load_rig

from validation.hidden_effects.machines import effects
from validation.hidden_effects.machines.draw import draw, draw_runs, drawable, open_truth

SORTS = ("catalogue", "healthy", "outside", "pair")
LARGEST_CLASS = 3
"""Members of a class that still counts as an answer."""
BLOCKS = {
    "clogging_silencer": "flow",
    "bent_rod": "force",
    "scratched_bore": "force",
    "warming_grease": "force",
    "pulsating_supply": "supply",
    "sticky_spool": "flow",
    "dragging_cable": "force",
    "check_valve_leak": "flow",
}
"""In which equation an effect sits that no catalogue holds; air that comes in wrongly is seen in the flows too."""


@dataclass(frozen=True)
class Task:
    """What to hide, and with which seed."""

    kind: str
    seed: int
    sort: str
    multiple: float


@dataclass(frozen=True)
class Outcome:
    """One trial: what was hidden and what was said."""

    kind: str
    seed: int
    sort: str
    multiple: float
    hidden: list[str]
    values: list[float]
    verdict: str
    named: list[list[str]]
    """The members of each named cause."""
    estimates: list[tuple[float, float]] = field(default_factory=list)
    """Value and standard error of the hidden effect's parameter, where it was named."""
    block: str = ""
    """The equation that takes most, for the verdict unknown."""
    gain: float = 0.0
    """Part of the excess over the noise that the extended model takes on the records it has not seen."""
    seconds: float = 0.0

    @property
    def right(self) -> bool:
        if self.sort == "healthy":
            return self.verdict == "no-evidence"
        if self.sort == "outside":
            return self.verdict == "unknown"
        if self.sort == "pair":
            return self.some_right and not self.wrong_name
        return (
            len(self.named) == 1
            and len(self.named[0]) <= LARGEST_CLASS
            and self.hidden[0] in self.named[0]
        )

    @property
    def some_right(self) -> bool:
        """At least one of the hidden effects is in a class that is no larger than allowed."""
        return any(
            h in members and len(members) <= LARGEST_CLASS
            for h in self.hidden
            for members in self.named
        )

    @property
    def wrong_name(self) -> bool:
        """Something was named that is not there: worse than no answer."""
        return any(not set(members) & set(self.hidden) for members in self.named)

    @property
    def right_block(self) -> bool:
        wanted = BLOCKS.get(self.hidden[0], "") if self.hidden else ""
        return wanted in self.block or (wanted == "supply" and "flow" in self.block)

    @property
    def said(self) -> str:
        return " + ".join(" | ".join(members) for members in self.named) or self.verdict


def hide(task: Task, out: Path, truth: Path) -> None:
    """Draw the records of a task."""
    rng = np.random.default_rng([task.seed, 11])
    if task.sort == "catalogue":
        chosen: Any = None
        pair, _ = draw_runs(task.kind, _runs_rng(task.seed))
        keys = sorted(e.key for e in drawable(task.kind, pair, task.multiple))
        chosen = keys[int(rng.integers(len(keys)))]
    elif task.sort == "pair":
        pair, _ = draw_runs(task.kind, _runs_rng(task.seed))
        keys = sorted({e.key for e in drawable(task.kind, pair, task.multiple)})
        chosen = [str(k) for k in rng.choice(keys, 2, replace=False)]
    elif task.sort == "outside":
        outside = [e.key for e in effects.on(task.kind, effects.OUT_OF_CATALOGUE)]
        chosen = outside[int(rng.integers(len(outside)))]
    else:
        chosen = "none"
    draw(task.kind, task.seed, out, truth, chosen, task.multiple)


def _runs_rng(seed: int) -> np.random.Generator:
    """The generator's own stream for its runs, to know which excitations it will draw."""
    return np.random.default_rng(np.random.SeedSequence(seed).spawn(4)[2])


def run_task(task: Task) -> Outcome:
    """Hide, diagnose, then open the truth."""
    os.environ.setdefault("SMS_THREADS", "1")
    with tempfile.TemporaryDirectory() as folder:
        records, sealed = Path(folder) / "records", Path(folder) / "sealed" / "truth.json"
        hide(task, records, sealed)
        begin = time.process_time()
        rig = load_rig(records / "rig.toml")
        read, _ = read_and_check(rig)
        data, rng = make_data(rig, read), np.random.default_rng(task.seed)
        case = investigate(data, effects_of(rig), rng, lambda text, done: None)
        named = [
            [m.effect.key.replace(" of ", ":") for m in members] for members in case.outcome.classes
        ]
        estimates = {}
        for members in case.outcome.classes:
            for m in members:
                at = case.outcome.final if m is members[0] else m.fitted
                value = found_value(at, m.effect, case.data)
                estimates[m.effect.key.replace(" of ", ":")] = (
                    value,
                    rig.declared(value.name).value,
                )
        block = ""
        if case.verdict == "unknown":
            block = case.where(np.random.default_rng(task.seed)).equation
        seconds = time.process_time() - begin
        truth = open_truth(sealed, records)
    hidden = [e["key"] for e in truth["effects"]]
    shifts = {e["key"]: e["is_shift"] for e in truth["effects"]}
    found = []
    for e in truth["effects"]:
        if e["key"] in estimates:
            value, declared = estimates[e["key"]]
            found.append(
                (value.value - (declared if shifts[e["key"]] else 0.0), value.standard_error)
            )
    before, after = float(np.mean(case.before.validate)), float(np.mean(case.after.validate))
    return Outcome(
        task.kind,
        task.seed,
        task.sort,
        task.multiple,
        hidden,
        [float(e["value"]) for e in truth["effects"]],
        case.verdict,
        named,
        found,
        block,
        1.0 - max(after, 0.0) / max(before, 1e-9),
        seconds,
    )


# ---- many ------------------------------------------------------------


def tasks(kind: str, first: int, count: int, multiple: float) -> list[Task]:
    """Half of the catalogue, a fifth each healthy and from outside it, a tenth pairs."""
    pattern = (
        "catalogue",
        "healthy",
        "catalogue",
        "outside",
        "catalogue",
        "healthy",
        "catalogue",
        "outside",
        "catalogue",
        "pair",
    )
    return [Task(kind, first + i, pattern[i % len(pattern)], multiple) for i in range(count)]


def done_already(file: Path) -> dict[tuple[str, int, str, float], Outcome]:
    """The trials in a file; a last line that was cut off is left out."""
    found = {}
    if file.exists():
        for line in file.read_text().splitlines():
            try:
                outcome = Outcome(**json.loads(line))
            except (ValueError, TypeError):
                continue
            found[(outcome.kind, outcome.seed, outcome.sort, outcome.multiple)] = outcome
    return found


def run_tasks(
    wanted: Sequence[Task],
    file: Path,
    workers: int,
    scheduler: str | None = None,
    each: Callable[[Outcome], None] = lambda outcome: None,
) -> list[Outcome]:
    """Every trial that is not in the file yet, in parallel, each written as it comes. All outcomes, by seed."""
    have = done_already(file)
    missing = [t for t in wanted if (t.kind, t.seed, t.sort, t.multiple) not in have]
    outcomes = [have[(t.kind, t.seed, t.sort, t.multiple)] for t in wanted if t not in missing]
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a") as log:
        for outcome in _run(missing, workers, scheduler):
            log.write(json.dumps(asdict(outcome)) + "\n")
            log.flush()
            outcomes.append(outcome)
            each(outcome)
    return sorted(outcomes, key=lambda o: o.seed)


def _run(missing: Sequence[Task], workers: int, scheduler: str | None) -> Iterator[Outcome]:
    if scheduler is not None:
        from distributed import Client  # noqa: PLC0415 (optional extra)
        from distributed import as_completed as dask_completed  # noqa: PLC0415

        with Client(scheduler) as client:  # type: ignore[no-untyped-call]
            for job in dask_completed(client.map(run_task, missing, pure=False)):  # type: ignore[no-untyped-call]
                yield job.result()
        return
    with ProcessPoolExecutor(workers) as pool:
        for job in as_completed([pool.submit(run_task, task) for task in missing]):
            yield job.result()


# ---- what came out ------------------------------------------------------------


@dataclass(frozen=True)
class Goal:
    """One line of the summary."""

    what: str
    count: int
    of: int
    wanted: str

    @property
    def share(self) -> float:
        return self.count / self.of if self.of else float("nan")


def goals(outcomes: Sequence[Outcome]) -> list[Goal]:
    """The goals of the blind proof, counted."""
    by = {sort: [o for o in outcomes if o.sort == sort] for sort in SORTS}
    estimates = [
        (e, v)
        for o in by["catalogue"]
        if o.right and o.estimates
        for e, v in zip(o.estimates, o.values, strict=False)
    ]
    within = sum(abs(value - truth) <= 3.0 * error for (value, error), truth in estimates)
    ill = [o for o in outcomes if o.sort != "healthy"]
    right = [o for o in by["catalogue"] if o.right]
    unknown = [o for o in by["outside"] if o.verdict == "unknown"]
    return [
        Goal(
            "right cause, or a class of at most three with it",
            len(right),
            len(by["catalogue"]),
            "95 %",
        ),
        Goal(
            "a wrong name where something was hidden",
            sum(o.wrong_name for o in ill),
            len(ill),
            "at most 2 %",
        ),
        Goal(
            "a name or an alarm on healthy data",
            sum(not o.right for o in by["healthy"]),
            len(by["healthy"]),
            "at most 2 %",
        ),
        Goal(
            "called unknown, hidden from outside the catalogue",
            len(unknown),
            len(by["outside"]),
            "90 %",
        ),
        Goal(
            "of these, in the right equation",
            sum(o.right_block for o in unknown),
            len(unknown),
            "85 %",
        ),
        Goal("parameter within three standard errors", within, len(estimates), "97 %"),
        Goal(
            "gain of at least 90 % of the excess, where right",
            sum(o.gain >= 0.9 for o in right),
            len(right),
            "-",
        ),
        Goal(
            "pairs: one right and none wrong",
            sum(o.right for o in by["pair"]),
            len(by["pair"]),
            "80 %",
        ),
    ]


def confusion(outcomes: Sequence[Outcome]) -> dict[str, Counter[str]]:
    """Hidden -> said -> how often."""
    table: dict[str, Counter[str]] = {}
    for o in outcomes:
        table.setdefault(" + ".join(o.hidden) or "nothing", Counter())[o.said] += 1
    return dict(sorted(table.items()))
