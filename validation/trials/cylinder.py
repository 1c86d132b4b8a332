"""The blind trial: an effect is hidden in records, the diagnosis has to find it, then the truth is opened.

    python -m validation.trials.cylinder --count 40 --seed 1

prints the confusion matrix. The generator (draw.py and what it uses) knows nothing of the diagnosis, and the diagnosis
nothing of it; they meet in the records' folder only.
"""

from __future__ import annotations

import argparse
import secrets
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table
from scipy.stats import norm
from sms.demo.hidden import key_of, said
from sms.diagnosis import diagnose
from sms.diagnosis.result import Cause, Member

from validation.twins.cylinder import effects
from validation.twins.cylinder.draw import draw, open_truth


@dataclass(frozen=True)
class Outcome:
    """One trial: what was hidden and what was said."""

    seed: int
    hidden: str
    value: float
    verdict: str
    named: tuple[tuple[str, ...], ...]
    """The members of each named cause."""
    estimate: float | None
    """The hidden effect's parameter as the diagnosis has it, where it named that effect, alone or in a class."""
    standard_error: float | None = None

    @property
    def right(self) -> bool:
        """The hidden effect and nothing else was named, alone or in a class of at most three."""
        if self.hidden == "none":
            return self.verdict == "no-evidence"
        if any(self.hidden == effect.key for effect in effects.OUT_OF_CATALOGUE):
            return self.verdict == "unknown"
        return len(self.named) == 1 and len(self.named[0]) <= 3 and self.hidden in self.named[0]

    @property
    def wrong_name(self) -> bool:
        """Something was named that is not there: worse than no answer."""
        return any(self.hidden not in members for members in self.named)

    @property
    def within(self) -> bool | None:
        """Whether the truth is within the stated 95 % interval; None where no size was stated."""
        if self.estimate is None or self.standard_error is None:
            return None
        return bool(abs(self.estimate - self.value) <= norm.ppf(0.975) * self.standard_error)

    @property
    def said(self) -> str:
        return " + ".join("|".join(members) for members in self.named) or self.verdict


def run_trial(seed: int, effect: str | None = None, multiple: float = 3.0) -> Outcome:
    """Draw, diagnose, then open the truth."""
    with tempfile.TemporaryDirectory() as folder:
        records, sealed = Path(folder) / "records", Path(folder) / "sealed" / "truth.json"
        sealed.parent.mkdir()
        draw(seed, records, sealed, effect, multiple)
        answer = diagnose(records / "rig.toml", seed=seed)
        truth = open_truth(sealed, records)
    hidden = key_of(truth["effect"], truth["signal"])
    named = tuple(map(tuple, said(answer)))
    members: list[Cause | Member] = [*answer.causes]
    members += [m for cause in answer.causes for m in cause.alternatives]
    found = next((m.parameters[0] for m in members if key_of(m.effect, m.signal) == hidden), None)
    size = (None, None) if found is None else (found.value, found.standard_error)
    return Outcome(seed, hidden, truth["value"], answer.verdict, named, *size)


def run_trials(
    seeds: Sequence[int],
    effect_of: Callable[[int], str | None],
    workers: int = 2,
    console: Console | None = None,
) -> list[Outcome]:
    """One trial a seed, in parallel; the order of the seeds."""
    with ProcessPoolExecutor(workers) as pool:
        jobs = {pool.submit(run_trial, seed, effect_of(seed)): seed for seed in seeds}
        done = track(
            as_completed(jobs), "hiding and finding", len(jobs), console=console, transient=True
        )
        outcomes = [job.result() for job in done]
    return sorted(outcomes, key=lambda o: o.seed)


def some_effect(seed: int) -> str:
    """One of the catalogue's effects for a seed, all equally often."""
    keys = [effect.key for effect in effects.CATALOGUE]
    return keys[int(np.random.default_rng([seed, 7]).integers(len(keys)))]


def confusion_matrix(outcomes: Sequence[Outcome]) -> Table:
    """Hidden against said, counted."""
    table = Table(title="hidden (rows) against said (columns)", title_style="bold")
    said = sorted({o.said for o in outcomes})
    table.add_column("hidden")
    for name in said:
        table.add_column(name, justify="right", overflow="fold")
    for hidden in sorted({o.hidden for o in outcomes}):
        counts = Counter(o.said for o in outcomes if o.hidden == hidden)
        table.add_row(hidden, *(str(counts[name] or "") for name in said))
    return table


def summary(outcomes: Sequence[Outcome]) -> str:
    healthy = [o for o in outcomes if o.hidden == "none"]
    ill = [o for o in outcomes if o.hidden != "none"]
    sizes = [o.within for o in ill if o.within is not None]
    return (
        f"healthy: {sum(o.right for o in healthy)} of {len(healthy)} without a finding, "
        f"{sum(o.wrong_name for o in healthy)} false names; "
        f"hidden effect: {sum(o.right for o in ill)} of {len(ill)} found, "
        f"{sum(o.wrong_name for o in ill)} wrong names; "
        f"{sum(sizes)} of {len(sizes)} within the stated 95 % interval"
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description="Hide effects in virtual records and have them found."
    )
    parser.add_argument("--count", type=int, default=40, help="healthy draws, and as many ill ones")
    parser.add_argument("--seed", type=int, default=None, help="first seed; fresh if left out")
    parser.add_argument("--effect", help="hide always this one (id, or id:signal)")
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    first = secrets.randbelow(10**6) if arguments.seed is None else arguments.seed
    console = Console(width=160)
    console.print(f"--seed {first} --count {arguments.count}")
    seeds = range(first, first + 2 * arguments.count)
    if arguments.effect:
        outcomes = run_trials(
            seeds[: arguments.count], lambda _: arguments.effect, arguments.workers, console
        )
    else:
        healthy = set(seeds[: arguments.count])
        outcomes = run_trials(
            seeds, lambda s: "none" if s in healthy else some_effect(s), arguments.workers, console
        )
    console.print(confusion_matrix(outcomes))
    for outcome in outcomes:
        if not outcome.right:
            console.print(
                f"seed {outcome.seed}: hidden {outcome.hidden} = {outcome.value:.4g}, said {outcome.said}"
            )
    console.print(summary(outcomes))


if __name__ == "__main__":
    main()
