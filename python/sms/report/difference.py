"""The difference of two diagnoses as a table on the console."""

from __future__ import annotations

import math

from sms.history.difference import Difference, Item
from sms.units_display import capital, format_aligned, format_p_value, words

HEADERS = ("size", "a", "b", "difference (95 %)", "seen from", "p (Holm)", "")


def difference_rows(found: Difference) -> list[tuple[str, ...]]:
    """An item a row, as plain text, the changed ones first."""
    order = ("changed", "cannot be told", "unchanged")
    return [_row(i) for i in sorted(found.items, key=lambda i: order.index(i.change))]


def _row(item: Item) -> tuple[str, ...]:
    numbers = [item.a, item.b, item.low, item.high, item.smallest]
    a, b, low, high, smallest = format_aligned(numbers, item.unit, item.parameter)
    return (
        capital(item.title or words(item.parameter)),
        _not_named(item, a) if item.absent == "a" else a,
        _not_named(item, b) if item.absent == "b" else b,
        f"{low.partition(' ')[0]} to {high}" if math.isfinite(item.low) else "not known",
        smallest,
        format_p_value(item.p_holm).removeprefix("p ").removeprefix("= "),
        item.change,
    )


def _not_named(item: Item, estimate: str) -> str:
    """With the size that its records would be fitted best by, where that is what is compared."""
    return f"not named ({estimate})" if item.selected else "not named"


def notes(found: Difference) -> list[str]:
    """What stands behind single items, a sentence each."""
    said = [
        f"{capital(i.title or words(i.parameter))}: {i.reason}." for i in found.items if i.reason
    ]
    return list(dict.fromkeys(said))


def total_in_words(found: Difference) -> str:
    """The chi-square of all."""
    if not found.degrees:
        return "No difference could be tested."
    return (
        f"All differences together: chi-square {found.chi_square:.1f} of {found.degrees}, "
        f"{format_p_value(found.p_value)} if nothing had changed."
    )
