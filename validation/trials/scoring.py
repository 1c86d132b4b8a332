"""What a diagnosis said against what was hidden: one outcome a trial, and the counts and tables of many.

An answer is right when it names, alone or in a class of at most three, what was hidden and nothing else; on a healthy
rig when it names nothing; on an effect outside the catalogue when it says `unknown`; of a pair when one is named and
nothing that is not there. A name that is not hidden is worse than no answer.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rich.table import Table
from sms.io.json_files import from_json_line

SORTS = ("catalogue", "healthy", "outside", "pair")
LARGEST_CLASS = 3
"""Members of a class that still counts as an answer."""
WITHIN = 3.0
"""Standard errors within which an estimate counts as right."""
LEAST_GAIN = 0.9
"""Of what the true model gains."""
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


ARMS = ("proposed", "random")
"""How a further run is chosen: by the diagnosis, or drawn from the same menu."""
Key = tuple[str, int, str, float, float]
"""Kind, seed, sort, multiple of the detection limit, imperfection in percent."""


@dataclass(frozen=True)
class FollowUp:
    """What became of an answer that was a class, with more runs (follow_up.py)."""

    arm: str
    experiments: list[str]
    """The runs that were made, in their order."""
    verdict: str
    named: list[list[str]]
    one_right: bool
    """Each cause that is named in the end is one effect that is there."""
    seconds: float


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
    """Value and standard error of the hidden effect's parameter, where it was named by the same quantity."""
    block: str = ""
    """The equation that takes most, for the verdict unknown."""
    gain: float = 0.0
    """Part of the excess over the noise that the extended model takes on the records it has not seen."""
    seconds: float = 0.0
    achievable: float | None = None
    """The same part for the core with exactly what was hidden; None where the catalogue has no name for it."""
    imperfection: float = 0.0
    """Percent by which the machine was off from what can be declared."""
    follow_ups: list[FollowUp] | None = None
    """None: nobody asked for them."""

    @property
    def key(self) -> Key:
        """What tells it from other outcomes."""
        return self.kind, self.seed, self.sort, self.multiple, self.imperfection

    @property
    def of_achievable(self) -> float | None:
        """The gain over that of the true model; None where that model gains nothing."""
        if self.achievable is None or self.achievable <= 0.0:
            return None
        return self.gain / self.achievable

    @property
    def right(self) -> bool:
        """See the module."""
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
        """For a table."""
        return " + ".join(" | ".join(members) for members in self.named) or self.verdict


@dataclass(frozen=True)
class Goal:
    """One goal of issue 6, counted."""

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
    within = sum(abs(value - truth) <= WITHIN * error for (value, error), truth in estimates)
    ill = [o for o in outcomes if o.sort != "healthy"]
    right = [o for o in by["catalogue"] if o.right]
    unknown = [o for o in by["outside"] if o.verdict == "unknown"]
    gains = [o.of_achievable for o in (*right, *by["pair"]) if o.right]
    scored = [g for g in gains if g is not None]
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
            "gain of at least 90 % of the true model's, where right",
            sum(g >= LEAST_GAIN for g in scored),
            len(scored),
            "all",
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


def load(file: Path) -> list[Outcome]:
    """The trials in a file of JSON lines, of one that is there twice the later; a last line that was cut off is left
    out."""
    found: dict[Key, Outcome] = {}
    for line in file.read_text().splitlines() if file.exists() else []:
        try:
            outcome = outcome_from(from_json_line(line))
        except (ValueError, TypeError):
            continue
        found[outcome.key] = outcome
    return list(found.values())


def outcome_from(fields: dict[str, Any]) -> Outcome:
    """An outcome from its fields, as a file or a worker has them."""
    outcome = Outcome(**fields)
    if outcome.follow_ups is None:
        return outcome
    rows: Sequence[Any] = outcome.follow_ups
    return replace(
        outcome, follow_ups=[r if isinstance(r, FollowUp) else FollowUp(**r) for r in rows]
    )


# ---- tables ------------------------------------------------------------


def confusion_table(outcomes: Sequence[Outcome]) -> Table:
    """Hidden against said, counted."""
    table = Table(title="hidden against said", title_style="bold")
    for name in ("hidden", "said", "times"):
        table.add_column(name, justify="right" if name == "times" else "left", overflow="fold")
    for hidden, said in confusion(outcomes).items():
        for name, count in said.most_common():
            table.add_row(hidden, name, str(count))
    return table


def goal_table(outcomes: Sequence[Outcome]) -> Table:
    """The goals as a table."""
    table = Table(title="goals", title_style="bold")
    for column in ("goal", "count", "share", "wanted"):
        table.add_column(column, justify="left" if column == "goal" else "right")
    for goal in goals(outcomes):
        share = f"{100.0 * goal.share:.0f} %" if goal.of else "-"
        table.add_row(goal.what, f"{goal.count} of {goal.of}", share, goal.wanted)
    return table
