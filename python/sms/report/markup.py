"""Small pieces of HTML that every part of the page uses: escaping, sections, tables, bars."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from sms.units_display import words


def esc(text: object) -> str:
    """Text for HTML, also inside attributes."""
    return html.escape(str(text), quote=True)


def effect_label(effect: str, signal: str | None) -> str:
    """An effect for a reader: "sensor gain · rod force", carrying its identifiers for tools."""
    text = words(effect) + (f" · {words(signal)}" if signal else "")
    identifier = effect + (f" {signal}" if signal else "")
    return f'<span class="effect" data-effect="{esc(identifier)}">{esc(text)}</span>'


def paragraphs(sentences: Iterable[str], css: str = "") -> str:
    """Each sentence as a paragraph, empty ones left out."""
    attribute = f' class="{css}"' if css else ""
    return "".join(f"<p{attribute}>{esc(text)}</p>" for text in sentences if text)


def section(identifier: str, title: str, body: str, lead: str = "") -> str:
    """A part of the page with its heading; `lead` is plain text, `body` HTML."""
    return (
        f'<section id="{identifier}" aria-labelledby="{identifier}-title">'
        f'<h2 id="{identifier}-title">{esc(title)}</h2>'
        f"{paragraphs([lead], 'lead')}{body}</section>"
    )


def empty(text: str) -> str:
    """What stands where a list has nothing to show."""
    return f'<p class="empty">{esc(text)}</p>'


def printed_in_part(printed: int, rows: int) -> str:
    """What stands on paper below a table of which the first rows are printed only; nothing where all are."""
    if printed >= rows:
        return ""
    return f'<p class="small paper">The first {printed} of {rows}; all are on this page on a screen.</p>'


def table(
    caption: str,
    headers: Sequence[str],
    rows: Iterable[Sequence[str]],
    css: str = "",
    on_paper: int | None = None,
) -> str:
    """A table whose first column names the row. Cells are HTML; on a phone a row becomes a block.

    on_paper: how many of the rows are printed, the first ones; a line says how many there are.

    The roles are spelled out because that change of layout may hide them from screen readers.
    """
    head = "".join(f'<th scope="col" role="columnheader">{esc(text)}</th>' for text in headers)
    rows = list(rows)
    printed = len(rows) if on_paper is None else on_paper
    body = "".join(
        f'<tr role="row"{"" if number < printed else " class=screen"}>'
        + f'<th scope="row" role="rowheader">{row[0]}</th>'
        + "".join(
            f'<td role="cell" data-label="{esc(label)}">{cell}</td>'
            for label, cell in zip(headers[1:], row[1:], strict=True)
        )
        + "</tr>"
        for number, row in enumerate(rows)
    )
    left_out = printed_in_part(printed, len(rows))
    return (
        f'<table role="table" class="{css}"><caption>{esc(caption)}</caption>'
        f'<thead role="rowgroup"><tr role="row">{head}</tr></thead>'
        f'<tbody role="rowgroup">{body}</tbody></table>{left_out}'
    )


@dataclass(frozen=True)
class Scale:
    """A horizontal axis: maps low..high to 0..100 percent of a bar's track."""

    low: float
    high: float

    @classmethod
    def over(cls, values: Iterable[float], margin: float = 0.0) -> Scale:
        """The axis that holds all finite `values`, with `margin` of its width free at both ends."""
        finite = [value for value in values if math.isfinite(value)] or [0.0]
        low, high = min(finite), max(finite)
        width = (high - low) or abs(high) or 1.0
        return cls(low - margin * width, high + margin * width)

    def position(self, value: float) -> float:
        """Percent from the left, kept within the track."""
        width = self.high - self.low
        share = (value - self.low) / width if width > 0.0 else 0.0
        return min(max(100.0 * share, 0.0), 100.0)


def _span(css: str, left: float, right: float) -> str:
    return f'<i class="{css}" style="left:{left:.2f}%;width:{max(right - left, 0.0):.2f}%"></i>'


def bar(
    scale: Scale,
    value: float,
    css: str,
    interval: tuple[float, float] | None = None,
    marks: Sequence[float] = (0.0,),
) -> str:
    """A bar from zero to `value` with its interval as a whisker and thin lines at `marks`.

    Decoration only: the number stands beside it as text.
    """
    parts = []
    if math.isfinite(value):
        ends = sorted((scale.position(0.0), scale.position(value)))
        parts.append(_span(f"fill {css}", *ends))
    if interval is not None and all(math.isfinite(end) for end in interval):
        ends = sorted(scale.position(end) for end in interval)
        parts.append(_span("whisker", *ends))
    parts += [
        f'<i class="mark" style="left:{scale.position(mark):.2f}%"></i>'
        for mark in marks
        if scale.low < mark < scale.high
    ]
    return f'<span class="track" aria-hidden="true">{"".join(parts)}</span>'


def dot(scale: Scale, value: float, band: tuple[float, float], marks: Sequence[float]) -> str:
    """A dot at `value` over a shaded band, with thin lines at `marks`; decoration only."""
    parts = []
    if all(math.isfinite(end) for end in band):
        parts.append(_span("band", *(scale.position(end) for end in band)))
    parts += [
        f'<i class="mark" style="left:{scale.position(mark):.2f}%"></i>'
        for mark in marks
        if math.isfinite(mark)
    ]
    if math.isfinite(value):
        parts.append(f'<i class="dot" style="left:{scale.position(value):.2f}%"></i>')
    return f'<span class="track thin" aria-hidden="true">{"".join(parts)}</span>'


def swatch(kind: str) -> str:
    """The colour of measured, baseline, extended or floor beside its name."""
    return f'<span class="swatch {kind}" aria-hidden="true"></span>'
