"""Counted shares of trials with their one-sided 95 % bounds (Clopper and Pearson 1934), as a table and for programs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rich.table import Table
from scipy.stats import beta


@dataclass(frozen=True)
class Share:
    """How many of how many, with the bound on the side that matters."""

    what: str
    count: int
    of: int
    bound: float


def at_least(what: str, chosen: Sequence[bool]) -> Share:
    """A share that should be large, with its lower bound."""
    return Share(what, sum(chosen), len(chosen), lower_bound(sum(chosen), len(chosen)))


def at_most(what: str, chosen: Sequence[bool]) -> Share:
    """A share that should be small, with its upper bound."""
    return Share(what, sum(chosen), len(chosen), upper_bound(sum(chosen), len(chosen)))


def lower_bound(count: int, of: int) -> float:
    """One-sided 95 % bound below a share."""
    return 0.0 if count == 0 else float(beta.ppf(0.05, count, of - count + 1))


def upper_bound(count: int, of: int) -> float:
    """One-sided 95 % bound above a share."""
    return 1.0 if count == of else float(beta.ppf(0.95, count + 1, of - count))


def share_table(shares: Sequence[Share]) -> Table:
    """The shares with their bounds."""
    out = Table("", "count", "of", "share", "one-sided 95 % bound")
    for s in shares:
        share = f"{100.0 * s.count / s.of:.0f} %" if s.of else "-"
        bound = f"{100.0 * s.bound:.0f} %" if s.of else "-"
        out.add_row(s.what, str(s.count), str(s.of), share, bound)
    return out


def shares_as_dicts(shares: Sequence[Share]) -> list[dict[str, Any]]:
    """The shares of which there is anything, for programs."""
    return [
        {"what": s.what, "count": s.count, "of": s.of, "bound_95": s.bound} for s in shares if s.of
    ]
