"""Table 2.1 as one HTML page and as rows for the console."""

from __future__ import annotations

import math

from sms import _core
from sms.report.markup import esc, section, table
from sms.report.page import page
from sms.requirements import Compliance, Row
from sms.units_display import format_quantity, round_number

_MANY = 9.0
HEADERS = ("criterion", "required", "specified", "computed", "margin", "verdict", "limited by")


def table_rows(found: Compliance) -> list[list[str]]:
    """One row a line of the table, in the order of HEADERS, as text."""
    return [
        [
            f"{row.criterion}: {row.axis}",
            _amount(row.required, row),
            _amount(row.specified, row),
            _amount(row.computed, row),
            _margin(row),
            verdict(row),
            row.limit,
        ]
        for row in found.rows
    ]


def verdict(row: Row) -> str:
    """What is met: both, the requirement only, the specification only, or neither."""
    meets = row.meets(row.required), row.meets(row.specified)
    return {
        (True, True): "met",
        (True, False): "specification missed",
        (False, True): "requirement missed",
        (False, False): "missed",
    }[meets]


def sentences(found: Compliance) -> list[str]:
    """What misses, and by what; or that all is met."""
    missed = [row for row in found.rows if "missed" in verdict(row)]
    if not missed:
        return ["Everything of Table 2.1 is met."]
    return [
        f"{row.criterion.capitalize()}, {row.axis}: {_amount(row.computed, row)}, {verdict(row)}; "
        f"the limit is the {row.limit} ({row.remark})."
        for row in missed
    ]


def requirements_html(found: Compliance) -> str:
    """The whole page; it needs no plots."""
    cells = [
        [esc(cell) for cell in (*row, line.remark)]
        for row, line in zip(table_rows(found), found.rows, strict=True)
    ]
    listed = "".join(f"<li>{esc(text)}</li>" for text in sentences(found))
    numbers = table(
        "Margin against the requirement / against the specification.",
        (*HEADERS, "how it was computed"),
        cells,
    )
    body = (
        "<main><h1>Table 2.1, computed</h1>"
        f"<ul class='findings-list'>{listed}</ul>"
        + section("table", "Compliance", numbers)
        + f"<p class='small'>sms {_core.__version__}; {esc(repr(found.params))}</p></main>"
    )
    return page("Requirements", body)


def _amount(value: float, row: Row) -> str:
    if not math.isfinite(value):
        return "n/a"
    if row.unit in ("rad/s", "rad/s^2"):
        return f"{round_number(math.degrees(value), 2)}°/{row.unit[4:].replace('^2', '²')}"
    if row.unit == "rad":
        return f"{round_number(math.degrees(value), 2)}°"
    return format_quantity(value, row.unit)


def _margin(row: Row) -> str:
    asked = [row.required] if row.required == row.specified else [row.required, row.specified]
    return " / ".join(_share(row.margin(value)) for value in asked)


def _share(margin: float) -> str:
    """A margin: "+21 %"; ten times as much and more as "74 times"."""
    if margin >= _MANY:
        return f"{margin + 1.0:.0f} times"
    return f"{round_number(100.0 * margin, 0, signed=True)} %"
