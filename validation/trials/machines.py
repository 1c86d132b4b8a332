"""Blind trials on simulated machines: an effect is hidden, the diagnosis has to name it, then the truth is opened.

One trial is one line of a JSON-lines file, so that a run can be stopped and taken up again: what is in the file is not
done twice. `./dev trials` is the command; the generator (validation/twins) knows nothing of the diagnosis, and the
diagnosis nothing of it; they meet in the records' folder only.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from sms.cluster import call_from, client_of
from sms.diagnosis.adequacy.lack_of_fit import LackOfFit, lack_of_fit
from sms.diagnosis.adequacy.subset_estimates import found_value
from sms.diagnosis.adequacy.systematic_error import sized
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.fitting import fit
from sms.diagnosis.simulated import Case
from sms.io.json_files import json_line

from validation.trials.answers import Answered, answered, key_of
from validation.trials.follow_up import followed
from validation.trials.processes import processes
from validation.trials.scoring import Key, Outcome, confusion, goals, load, outcome_from
from validation.twins import effects
from validation.twins.draw import Trial, draw, draw_runs, drawable, open_truth

__all__ = [
    "Outcome",
    "Task",
    "confusion",
    "done_already",
    "goals",
    "run_task",
    "run_tasks",
    "tasks",
]


PATTERN = (
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
SORTS = tuple(dict.fromkeys(PATTERN))


@dataclass(frozen=True)
class Task:
    """What to hide, and with which seed."""

    kind: str
    seed: int
    sort: str
    multiple: float
    imperfection: float = 0.0
    """Percent by which the machine is off from what can be declared."""
    follow: bool = False
    """Whether the run that an ambiguous answer proposes is made (follow_up.py)."""

    @property
    def key(self) -> Key:
        """What tells its outcome from others."""
        return self.kind, self.seed, self.sort, self.multiple, self.imperfection

    def done(self, have: Mapping[Key, Outcome]) -> bool:
        """Whether its outcome is there, with all that is asked for."""
        found = have.get(self.key)
        return found is not None and not (self.follow and found.follow_ups is None)


NOT_TOGETHER = {"presliding", "coulomb_friction"}
"""Where almost no friction is left, a seal that bends before it slides bends by nothing: too stiff to be simulated."""


def hide(task: Task, out: Path, truth: Path) -> Trial:
    """Draw the records of a task."""
    rng = np.random.default_rng([task.seed, 11])
    if task.sort == "catalogue":
        chosen: Any = None
        pair, _ = draw_runs(task.kind, runs_rng(task.seed))
        keys = sorted(e.key for e in drawable(task.kind, pair, task.multiple))
        chosen = keys[int(rng.integers(len(keys)))]
    elif task.sort == "pair":
        pair, _ = draw_runs(task.kind, runs_rng(task.seed))
        keys = sorted({e.key for e in drawable(task.kind, pair, task.multiple)})
        chosen = [str(k) for k in rng.choice(keys, 2, replace=False)]
        while set(chosen) == NOT_TOGETHER:
            chosen = [str(k) for k in rng.choice(keys, 2, replace=False)]
    elif task.sort == "outside":
        outside = [e.key for e in effects.on(task.kind, effects.OUT_OF_CATALOGUE)]
        chosen = outside[int(rng.integers(len(outside)))]
    else:
        chosen = "none"
    return draw(task.kind, task.seed, out, truth, chosen, task.multiple, task.imperfection)


def runs_rng(seed: int) -> np.random.Generator:
    """The generator's own stream for its runs, to know which excitations it will draw."""
    return np.random.default_rng(np.random.SeedSequence(seed).spawn(4)[2])


def run_task(task: Task) -> Outcome:
    """Hide, diagnose, then open the truth."""
    with tempfile.TemporaryDirectory() as folder:
        records, sealed = Path(folder) / "records", Path(folder) / "sealed" / "truth.json"
        trial = hide(task, records, sealed)
        answer = answered(records, task.seed)
        outcome = outcome_of(task, answer, open_truth(sealed, records))
        return (
            replace(outcome, follow_ups=followed(trial, records, answer))
            if task.follow
            else outcome
        )


def fields_of(**task: Any) -> dict[str, Any]:
    """The outcome of a task, both as their fields: what travels to a worker and back."""
    return asdict(run_task(Task(**task)))


def outcome_of(task: Task, answer: Answered, truth: dict[str, Any]) -> Outcome:
    """What was said against the opened truth."""
    case = answer.case
    hidden = [e["key"] for e in truth["effects"]]
    return Outcome(
        task.kind,
        task.seed,
        task.sort,
        task.multiple,
        hidden,
        [float(e["value"]) for e in truth["effects"]],
        case.verdict,
        answer.named,
        _estimates(case, truth["effects"]),
        answer.block,
        taken(case, case.after),
        answer.seconds,
        achievable(case, hidden) if task.sort in ("catalogue", "pair") else None,
        task.imperfection,
    )


def _estimates(case: Case, hidden: Sequence[dict[str, Any]]) -> list[tuple[float, float]]:
    """Value and standard error of what was hidden, where it was named."""
    rig = case.data.rig
    found = {}
    for members in case.outcome.groups:
        for m in members:
            found[key_of(m.effect)] = found_value(case.of_member(m, members), m.effect, case.data)
    estimates = []
    for e in hidden:
        value = found.get(e["key"])
        # With another unit the simulator has another law for it, with numbers of its own.
        if value is not None and value.unit == e["unit"]:
            declared = rig.declared(value.name).value if e["is_shift"] else 0.0
            estimates.append((value.value - declared, value.standard_error))
    return estimates


# ---- gain ------------------------------------------------------------


def taken(case: Case, after: LackOfFit) -> float:
    """Part of the baseline's excess on the unseen records that a model takes."""
    before = float(np.mean(case.before.validate))
    return 1.0 - max(float(np.mean(after.validate)), 0.0) / max(before, 1e-9)


def achievable(case: Case, hidden: Sequence[str]) -> float | None:
    """The same for the true model: the core with exactly what was hidden, its parameters fitted to the same records.

    Not with the sealed values: the simulator has laws of its own, and its numbers are not the core's. Where the answer
    is this model, it is not fitted again. None where the core has no such effect.
    """
    effects = {key_of(e): e for e in effects_of(case.data.rig)}
    if not all(key in effects for key in hidden):
        return None
    classes = case.outcome.groups
    if sorted(key_of(c[0].effect) for c in classes) == sorted(hidden):
        return taken(case, case.after)
    alone = [m for c in classes for m in c if key_of(m.effect) == hidden[0]]
    if len(classes) == len(hidden) == len(alone) == 1:
        final = sized(alone[0].fitted, case.data)
        return taken(case, lack_of_fit(final, case.data))
    hypothesis = case.baseline.hypothesis
    start = case.baseline.params.copy()
    for key in hidden:
        hypothesis = hypothesis.with_effect(effects[key])
        if (step := effects[key].step) is not None:  # without a slope at its neutral value
            start[effects[key].parameters[0]] = step
    final = sized(fit(hypothesis, case.data.identify, start), case.data)
    return taken(case, lack_of_fit(final, case.data))


# ---- many ------------------------------------------------------------


def tasks(
    kind: str,
    first: int,
    count: int,
    multiple: float,
    levels: Sequence[float] = (0.0,),
    follow: bool = False,
    only: str | None = None,
) -> list[Task]:
    """Half of the catalogue, a fifth each healthy and from outside it, a tenth pairs; the same at each level.

    only: all of this sort.
    """
    pattern = PATTERN if only is None else (only,)
    return [
        Task(kind, first + i, pattern[i % len(pattern)], multiple, level, follow)
        for i in range(count)
        for level in levels
    ]


def done_already(file: Path) -> dict[Key, Outcome]:
    """The trials in a file, by task."""
    return {o.key: o for o in load(file)}


def run_tasks(
    wanted: Sequence[Task],
    file: Path,
    workers: int,
    scheduler: str | None = None,
    each: Callable[[Outcome], None] = lambda outcome: None,
) -> list[Outcome]:
    """Every trial that is not in the file yet, in parallel, each written as it comes. All outcomes, by seed, level."""
    have = done_already(file)
    missing = [t for t in wanted if not t.done(have)]
    outcomes = [have[t.key] for t in wanted if t.done(have)]
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a") as log:
        for outcome in _run(missing, workers, scheduler):
            log.write(json_line("trials", asdict(outcome)))
            log.flush()
            outcomes.append(outcome)
            each(outcome)
    return sorted(outcomes, key=lambda o: (o.seed, o.imperfection))


def _run(missing: Sequence[Task], workers: int, scheduler: str | None) -> Iterator[Outcome]:
    if scheduler is not None:
        with client_of(scheduler) as client:
            from distributed import as_completed as finished  # noqa: PLC0415 (optional extra)

            jobs = [asdict(task) for task in missing]
            where = str(Path(__file__).parents[2]), __name__, "fields_of"
            calls = client.map(partial(call_from, *where), jobs, pure=False)
            for job in finished(calls):  # type: ignore[no-untyped-call]
                yield outcome_from(job.result())
        return
    # A process is one core: new ones read this when they load their linear algebra, forked ones have it loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with processes(workers) as pool:
        pending = {pool.submit(run_task, task): task for task in missing}
        for job in as_completed(pending):
            if (fault := job.exception()) is not None:
                pool.shutdown(wait=False, cancel_futures=True)
                task = pending[job]
                raise RuntimeError(
                    f"trial {task.sort} of {task.kind}, seed {task.seed}, broke down; those that are done are kept"
                ) from fault
            yield job.result()
