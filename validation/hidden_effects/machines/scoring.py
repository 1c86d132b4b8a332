"""What a diagnosis said against what was hidden: one outcome a trial, and the tables of many.

An answer is right when it names, alone or in a class of at most three, what was hidden and nothing
else; on a healthy rig when it names nothing; on an effect outside the catalogue when it says
`unknown`. A name that is not hidden is worse than no answer.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich.table import Table

from validation.hidden_effects.machines import effects

NO_EVIDENCE = "no-evidence"
UNKNOWN = "unknown"
LARGEST_CLASS = 3
WITHIN = 3.0
"""Standard errors within which an estimate counts as right."""


@dataclass(frozen=True)
class Named:
    """One cause of an answer: the members of its class, and the first one's value."""

    keys: tuple[str, ...]
    value: float | None = None  # as the truth counts it: from neutral, or from what is declared
    standard_error: float | None = None


@dataclass(frozen=True)
class Outcome:
    """One trial."""

    kind: str
    seed: int
    hidden: tuple[str, ...]
    values: tuple[float, ...]
    verdict: str
    named: tuple[Named, ...]
    gain: float | None = None  # on unseen records
    gain_of_truth: float | None = None  # the true model's

    @property
    def sort(self) -> str:
        """healthy, catalogue, outside or pair."""
        outside = {effect.key for effect in effects.OUT_OF_CATALOGUE}
        if not self.hidden:
            return "healthy"
        if len(self.hidden) > 1:
            return "pair"
        return "outside" if self.hidden[0] in outside else "catalogue"

    @property
    def wrong_name(self) -> bool:
        """Something was named that is not there."""
        return any(not set(named.keys) & set(self.hidden) for named in self.named)

    @property
    def right(self) -> bool:
        """See the module."""
        if self.sort == "healthy":
            return self.verdict == NO_EVIDENCE
        if self.sort == "outside":
            return self.verdict == UNKNOWN
        small = all(len(named.keys) <= LARGEST_CLASS for named in self.named)
        return bool(self.named) and small and not self.wrong_name

    @property
    def estimate_is_right(self) -> bool | None:
        """Within WITHIN standard errors; None where there is no estimate to judge."""
        if len(self.hidden) != 1:
            return None
        for named in self.named:
            if named.keys[0] == self.hidden[0] and named.value is not None and named.standard_error:
                return abs(named.value - self.values[0]) <= WITHIN * named.standard_error
        return None

    @property
    def said(self) -> str:
        """For a table."""
        return " + ".join("|".join(named.keys) for named in self.named) or self.verdict


def outcome_of(
    truth: dict[str, Any],
    verdict: str,
    named: Sequence[Named],
    gain: float | None = None,
    gain_of_truth: float | None = None,
) -> Outcome:
    """A trial from its opened truth and what was said."""
    hidden = truth["effects"]
    return Outcome(
        truth["kind"],
        truth["seed"],
        tuple(row["key"] for row in hidden),
        tuple(row["value"] for row in hidden),
        verdict,
        tuple(named),
        gain,
        gain_of_truth,
    )


def confusion_matrix(outcomes: Sequence[Outcome]) -> Table:
    """Hidden against said, counted."""
    table = Table(title="hidden (rows) against said (columns)", title_style="bold")
    said = sorted({o.said for o in outcomes})
    table.add_column("hidden")
    for name in said:
        table.add_column(name, justify="right", overflow="fold")
    rows = sorted({" + ".join(o.hidden) for o in outcomes})
    for row in rows:
        counts = Counter(o.said for o in outcomes if " + ".join(o.hidden) == row)
        table.add_row(row or "(healthy)", *(str(counts[name] or "") for name in said))
    return table


@dataclass(frozen=True)
class Goal:
    """One goal of issue 6: a share of the trials that it is about."""

    name: str
    share: float | None  # None: no such trial
    trials: int
    wanted: float
    at_least: bool

    @property
    def met(self) -> bool | None:
        """None without trials."""
        if self.share is None:
            return None
        return self.share >= self.wanted if self.at_least else self.share <= self.wanted


def goals(outcomes: Sequence[Outcome]) -> list[Goal]:
    """How far the goals are met."""
    by_sort = {
        sort: [o for o in outcomes if o.sort == sort]
        for sort in ("healthy", "catalogue", "outside", "pair")
    }
    ill = [*by_sort["catalogue"], *by_sort["outside"], *by_sort["pair"]]
    estimates = [e for e in (o.estimate_is_right for o in by_sort["catalogue"]) if e is not None]
    gains = [
        o.gain / o.gain_of_truth
        for o in by_sort["catalogue"]
        if o.gain is not None and o.gain_of_truth
    ]

    def share(name: str, of: Iterable[bool], wanted: float, at_least: bool = True) -> Goal:
        flags = list(of)
        part = sum(flags) / len(flags) if flags else None
        return Goal(name, part, len(flags), wanted, at_least)

    return [
        share("right cause or class", (o.right for o in by_sort["catalogue"]), 0.95),
        share("wrong name", (o.wrong_name for o in ill), 0.02, at_least=False),
        share("false alarm", (not o.right for o in by_sort["healthy"]), 0.02, at_least=False),
        share("outside called unknown", (o.right for o in by_sort["outside"]), 0.90),
        share("parameter within 3 standard errors", estimates, 0.97),
        share("gain at least 90 % of the truth's", (g >= 0.9 for g in gains), 0.90),
        share("pairs: one right, none wrong", (o.right for o in by_sort["pair"]), 0.80),
    ]


def goal_table(outcomes: Sequence[Outcome]) -> Table:
    """The goals as a table."""
    table = Table(title="goals", title_style="bold")
    for column in ("goal", "wanted", "reached", "trials"):
        table.add_column(column, justify="left" if column == "goal" else "right")
    for goal in goals(outcomes):
        sign = ">=" if goal.at_least else "<="
        reached = "-" if goal.share is None else f"{100.0 * goal.share:.1f} %"
        mark = {True: "", False: " !", None: ""}[goal.met]
        table.add_row(
            goal.name, f"{sign} {100.0 * goal.wanted:.0f} %", reached + mark, str(goal.trials)
        )
    return table


def append(path: Path, outcome: Outcome) -> None:
    """One line of JSON more: an interrupted series of trials goes on where it was."""
    with path.open("a") as file:
        file.write(json.dumps(asdict(outcome)) + "\n")


def load(path: Path) -> list[Outcome]:
    """The trials done so far; a line that an interruption cut off is left out."""
    found = []
    for line in path.read_text().splitlines() if path.exists() else []:
        try:
            row = json.loads(line)
        except json.JSONDecodeError:
            continue
        named = tuple(Named(**{**n, "keys": tuple(n["keys"])}) for n in row.pop("named"))
        row["hidden"], row["values"] = tuple(row["hidden"]), tuple(row["values"])
        found.append(Outcome(**row, named=named))
    return found
