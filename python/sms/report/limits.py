"""The page of `sms limits`: effects by experiments, the smaller the darker."""

from __future__ import annotations

from math import log10

from sms.diagnosis.design.detection_limits import Limit, Limits, Row
from sms.io.signals import SIGNAL_UNITS
from sms.report.markup import esc, section
from sms.report.page import page
from sms.units_display import format_quantity, words

_STYLE = """
table.heat { border-collapse: collapse; font-size: 0.8rem; }
table.heat th, table.heat td { border: 1px solid #8884; padding: 0.2rem 0.45rem; text-align: right; }
table.heat th:first-child { text-align: left; font-weight: normal; }
table.heat td.never { color: #888; }
"""
DECADES = 1.5
"""Between the darkest cell of a row and one without colour."""


def limits_html(found: Limits) -> str:
    """The whole page."""
    noise = ", ".join(
        f"{words(signal)} {format_quantity(size, SIGNAL_UNITS[signal])}"
        for signal, size in found.noise.items()
    )
    lead = (
        "Each number is the detection limit of an effect: three standard errors of its size from one run of this "
        "experiment, with everything that is declared as uncertain fitted too; a shift of such a number counts "
        "from the end of its declared uncertainty. The darker, the lower. A dash: not "
        f"identifiable from this run; hover over it for the reason. Noise of one sample: {noise}, taken as white."
    )
    numbers = "".join(
        f'<th scope="col" title="{esc(title)}">{number}</th>'
        for number, title in enumerate(found.experiments, 1)
    )
    rows = "".join(
        f'<tr><th scope="row" title="{esc(row.effect.title)}">{esc(words(row.effect.key))}</th>'
        + f"<td>{esc(row.shown[0])}</td>"
        + "".join(map(_cell, [row] * len(row.limits), row.limits, row.shown[1]))
        + "</tr>"
        for row in found.rows
    )
    listed = "".join(f"<li>{esc(title)}</li>" for title in found.experiments)
    body = (
        f"<main><h1>Detection limits: {esc(found.title)}</h1>"
        + section(
            "limits",
            "Detection limits",
            f'<ol>{listed}</ol><table class="heat"><thead><tr><th scope="col">Effect</th>'
            f'<th scope="col">Unit</th>{numbers}</tr></thead>'
            f"<tbody>{rows}</tbody></table>",
            lead,
        )
        + "</main>"
    )
    return page(f"Detection limits: {found.title}", body, style=_STYLE)


def _cell(row: Row, limit: Limit, text: str) -> str:
    if limit.size is None or row.best is None:
        return f'<td class="never" title="{esc(limit.reason)}">-</td>'
    worse = log10(limit.size / row.best) / DECADES
    share = max(0.0, 1.0 - worse)
    return f'<td style="background:rgba(68,119,170,{0.65 * share:.2f})">{esc(text)}</td>'
