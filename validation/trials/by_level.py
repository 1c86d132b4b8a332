"""Outcomes by how imperfect the machines were, and what became of the proposals: shares with one-sided 95 % bounds."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from validation.trials.scoring import ARMS, LEAST_GAIN, FollowUp, Outcome
from validation.trials.shares import Share, at_least, at_most

INTERVAL = 1.96
"""Standard errors to either side: a 95 % interval."""
GOAL_TO = 2.0
"""Percent: the goals are for machines that are off by no more."""


def shares(outcomes: Sequence[Outcome]) -> list[Share]:
    """What is counted of some outcomes."""
    known, pairs, healthy, outside = (
        [o for o in outcomes if o.sort == sort]
        for sort in ("catalogue", "pair", "healthy", "outside")
    )
    ill = [*known, *pairs, *outside]
    sized = [
        abs(value - truth) <= INTERVAL * error
        for o in known
        if o.right
        for (value, error), truth in zip(o.estimates, o.values, strict=False)
    ]
    gains = [o.of_achievable for o in (*known, *pairs) if o.right]
    return [
        at_least("right cause, or a class of at most three with it", [o.right for o in known]),
        at_least("pairs: one right and none wrong", [o.right for o in pairs]),
        at_most("a wrong name where something was hidden", [o.wrong_name for o in ill]),
        at_most("a name on a healthy machine", [bool(o.named) for o in healthy]),
        at_most("unknown on a healthy machine", [o.verdict == "unknown" for o in healthy]),
        at_least("called unknown, hidden from outside the catalogue", [o.right for o in outside]),
        at_least("true size within the stated 95 % interval", sized),
        at_least(
            "gain of at least 90 % of the true model's, where right",
            [g >= LEAST_GAIN for g in gains if g is not None],
        ),
    ]


def by_level(outcomes: Sequence[Outcome]) -> dict[str, list[Share]]:
    """Level -> shares; all levels up to that of the goals together, too, where there are several."""
    levels = sorted({o.imperfection for o in outcomes})
    found = {
        f"{level:g} %": shares([o for o in outcomes if o.imperfection == level]) for level in levels
    }
    within = [level for level in levels if level <= GOAL_TO]
    if len(within) > 1:
        title = f"{within[0]:g} to {within[-1]:g} %"
        found[title] = shares([o for o in outcomes if o.imperfection <= GOAL_TO])
    return found


def level_table(outcomes: Sequence[Outcome]) -> Table:
    """Shares in rows, levels in columns."""
    columns = by_level(outcomes)
    out = Table(
        title="by level of imperfection; in brackets the one-sided 95 % bound",
        title_style="bold",
    )
    out.add_column("")
    for title in columns:
        out.add_column(title, justify="right")
    for row in zip(*columns.values(), strict=True):
        out.add_row(row[0].what, *(cell(share) for share in row))
    return out


def cell(share: Share) -> str:
    """ "17 of 20, 85 % (66 %)"."""
    if not share.of:
        return "-"
    part, bound = (100.0 * s for s in (share.count / share.of, share.bound))
    return f"{share.count} of {share.of}, {part:.0f} % ({bound:.0f} %)"


# ---- proposals ---------------------------------------------------------------------------------------------------


def follow_up_shares(outcomes: Sequence[Outcome]) -> dict[str, list[Share]]:
    """Way of choosing -> what became of the answers that were a class."""
    return {arm: _of_arm(outcomes, arm) for arm in ARMS}


def _of_arm(outcomes: Sequence[Outcome], arm: str) -> list[Share]:
    made = [(o, f) for o in outcomes for f in o.follow_ups or [] if f.arm == arm and f.experiments]
    with_it = [f for o, f in made if o.some_right and not o.wrong_name]

    def one_right(follow_ups: Sequence[FollowUp]) -> list[bool]:
        return [f.one_right for f in follow_ups]

    every = [f for _, f in made]
    return [
        at_least("ends in one right cause", one_right(every)),
        at_least(
            "the same after one run", [f.one_right and len(f.experiments) == 1 for f in every]
        ),
        at_least("the same, where the class had the right cause", one_right(with_it)),
        at_most("ends in a wrong name", [_wrong(f, o) for o, f in made]),
    ]


def _wrong(follow_up: FollowUp, outcome: Outcome) -> bool:
    return any(not set(members) & set(outcome.hidden) for members in follow_up.named)


def follow_up_table(outcomes: Sequence[Outcome]) -> Table:
    """Proposed against drawn."""
    columns = follow_up_shares(outcomes)
    out = Table(title="answers that were a class, after at most two more runs", title_style="bold")
    out.add_column("")
    for arm in columns:
        out.add_column(f"run {arm}", justify="right")
    for row in zip(*columns.values(), strict=True):
        out.add_row(row[0].what, *(cell(share) for share in row))
    return out
