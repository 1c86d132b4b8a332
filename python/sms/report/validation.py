"""The published experiments as one HTML page: verdict first, then every figure beside ours."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from sms import _core
from sms.report.markup import esc, section, table
from sms.report.page import page
from sms.validation.figures import Row

_HEADERS = "quantity", "published", "computed", "difference", "verdict", "remark"
_STYLE = ".agrees { color: var(--good); font-weight: 650; } .differs { color: var(--bad); font-weight: 650; }"


def validation_html(rows: Sequence[Row]) -> str:
    """The whole page as text."""
    agreeing = sum(row.agrees for row in rows)
    differing = sorted({row.experiment for row in rows if not row.agrees})
    lead = (
        f"{agreeing} of {len(rows)} published figures come out of the published equations and "
        "coefficients. " + (f"Not in all figures: {'; '.join(differing)}." if differing else "")
    )
    parts = [
        section(
            f"experiment-{number}",
            name,
            table(f"{name}: published against computed, SI units.", _HEADERS, map(_cells, group)),
        )
        for number, (name, group) in enumerate(groupby(rows, lambda row: row.experiment))
    ]
    body = (
        "<main><h1>The published experiments, repeated</h1>"
        f"<p class='sentence'>{esc(lead)}</p>"
        "<p class='small'>A figure agrees when the computed one lies in the band that its precision "
        "allows; the remark has band and place. Why a figure differs: docs/validation.md.</p>"
        f"{''.join(parts)}<p class='small'>sms {esc(_core.__version__)}</p></main>"
    )
    return page("The published experiments, repeated", body, style=_STYLE)


def _cells(row: Row) -> tuple[str, ...]:
    css, word = ("agrees", "agrees") if row.agrees else ("differs", "differs")
    unit = "" if row.unit == "1" else f" {row.unit}"
    return (
        esc(row.quantity),
        "in words" if row.published is None else esc(f"{row.published:.5g}{unit}"),
        esc(f"{row.computed:.5g}{unit}"),
        "" if row.difference is None else esc(f"{row.difference:+.3g}{unit}"),
        f"<span class='{css}'>{word}</span>",
        esc(row.remark),
    )
