"""What each method said of each trial on a virtual machine, as one table."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from statistics import mean, median

from rich.table import Table

from validation.trials.peers.on_machines import Opinion, Round
from validation.trials.scoring import Outcome


@dataclass(frozen=True)
class Judged:
    """One method on one trial."""

    trial: Round
    said: Opinion

    @property
    def hidden(self) -> Outcome:
        return self.trial.outcome

    @property
    def as_outcome(self) -> Outcome:
        """The trial as it would be scored with this method's answer."""
        verdict = "cause" if self.said.named else "unknown" if self.said.alarm else "no-evidence"
        return replace(self.hidden, verdict=verdict, named=self.said.named)

    @property
    def equation_found(self) -> bool | None:
        """Whether the error sits in an equation that it points to; None if it says nothing, or the error is in none."""
        if not self.said.alarm or not self.trial.sits_in:
            return None
        return any(e in self.trial.sits_in for e in self.said.equations)

    @property
    def of_achievable(self) -> float | None:
        """Its gain over that of the true model."""
        if self.said.gain is None or not self.hidden.achievable or self.hidden.achievable <= 0.0:
            return None
        return self.said.gain / self.hidden.achievable


GAIN = "gain of true model's"
COLUMNS = (
    "method",
    "right cause",
    "wrong name",
    "false alarm",
    "unknown",
    "seen",
    "seen, no false alarm",
    "right equation",
    GAIN,
    "gain, outside",
    "CPU s",
)


def machine_table(rounds: Sequence[Round], title: str, gain: str = GAIN) -> Table:
    """One row a method; shares as counts. gain: what the gain of a hidden effect is held against, as a heading."""
    table = Table(title=title, title_justify="left", title_style="bold", box=None)
    for number, name in enumerate(gain if c == GAIN else c for c in COLUMNS):
        table.add_column(name, justify="right" if number else "left", no_wrap=number == 0)
    for method in dict.fromkeys(o.method for r in rounds for o in r.opinions):
        own = [Judged(r, o) for r in rounds for o in r.opinions if o.method == method]
        table.add_row(method, *_row(own))
    return table


def _row(own: Sequence[Judged]) -> list[str]:
    by: dict[str, list[Judged]] = {
        sort: [j for j in own if j.hidden.sort == sort]
        for sort in ("catalogue", "pair", "healthy", "outside")
    }
    named, ill = by["catalogue"] + by["pair"], [j for j in own if j.hidden.sort != "healthy"]
    loudest = max((j.said.strength for j in by["healthy"]), default=float("inf"))
    corrects = any(j.said.gain is not None for j in own)
    gains = [g for j in named if (g := j.of_achievable) is not None]
    outside = [j.said.gain for j in by["outside"] if j.said.gain is not None]
    seconds = [j.said.seconds for j in own if j.said.seconds is not None]
    points = [j for j in own if j.equation_found is not None and j.said.equations]
    return [
        _count(named, lambda j: j.as_outcome.right) if any(j.said.named for j in own) else "-",
        _count(ill, lambda j: j.as_outcome.wrong_name) if any(j.said.named for j in own) else "-",
        _count(by["healthy"], lambda j: j.said.alarm),
        _count(by["outside"], lambda j: j.as_outcome.verdict == "unknown"),
        _count(ill, lambda j: j.said.alarm),
        _count(ill, lambda j: j.said.strength > loudest),
        _count(points, lambda j: bool(j.equation_found)) if points else "-",
        _percent(gains) if corrects else "-",
        _percent(outside) if corrects else "-",
        f"{mean(seconds):.1f}" if seconds else "shared",
    ]


def _count(judged: Sequence[Judged], holds: Callable[[Judged], bool]) -> str:
    return f"{sum(holds(j) for j in judged)} of {len(judged)}"


def _percent(shares: Sequence[float]) -> str:
    return f"{100.0 * median(shares):.0f} %" if shares else "-"
