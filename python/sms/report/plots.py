"""Figures of a page as plain data, which plots.js draws: lines over one axis, thinned to what a screen shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from sms.arrays import Array
from sms.report.markup import esc

_MOST = 4000  # points a line


@dataclass(frozen=True)
class Line:
    """One line of a figure; NaN leaves a gap."""

    name: str
    x: ArrayLike
    y: ArrayLike
    colour: str = ""  #: a colour of style.css: measured, extended, baseline, good, warn, bad, floor
    dash: str = ""
    mode: str = "lines"
    symbol: str = ""


@dataclass(frozen=True)
class Figure:
    """One figure, with its place in the page."""

    identifier: str
    title: str
    x: str  #: title of the axis with its unit
    y: str
    lines: Sequence[Line]
    note: str = ""
    log_x: bool = False
    log_y: bool = False
    height: int = 300
    wide: bool = False  #: over the whole page
    legend: bool = True
    range_x: tuple[float, float] | None = None
    range_y: tuple[float, float] | None = None
    marks: Sequence[dict[str, float]] = field(default_factory=tuple)  #: {"y": 0.5} or {"x": 1.0}

    def html(self) -> str:
        """The figure's place in the page, which plots.js fills."""
        note = f"<p class='small'>{esc(self.note)}</p>" if self.note else ""
        return (
            f"<figure{' class=wide' if self.wide else ''}><figcaption><h3>{esc(self.title)}</h3>{note}</figcaption>"
            f"<div id='{esc(self.identifier)}' class='plot' role='img' "
            f"aria-label='{esc(self.title)}'></div></figure>"
        )

    def to_dict(self) -> dict[str, Any]:
        """What plots.js reads."""
        return {
            "id": self.identifier,
            "x": self.x,
            "y": self.y,
            "log_x": self.log_x,
            "log_y": self.log_y,
            "height": self.height,
            "legend": self.legend,
            "range_x": self.range_x,
            "range_y": self.range_y,
            "marks": list(self.marks),
            "series": [_series(line) for line in self.lines],
        }


def figures_html(figures: Sequence[Figure]) -> str:
    """The places of several figures."""
    return f"<div class='figures'>{''.join(figure.html() for figure in figures)}</div>"


def payload(figures: Sequence[Figure]) -> dict[str, Any]:
    """All figures of a page, for `sms.report.page.plots`."""
    return {"figures": [figure.to_dict() for figure in figures]}


def thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """At most 4,000 points that keep each stretch's lowest and highest value."""
    if x.size <= _MOST:
        return x, y
    stretches = np.array_split(np.arange(x.size), _MOST // 2)
    filled = np.nan_to_num(y)
    ends = [sorted({int(s[np.argmin(filled[s])]), int(s[np.argmax(filled[s])])}) for s in stretches]
    rows = np.array([0, *[row for pair in ends for row in pair], x.size - 1])
    return x[rows], y[rows]


def _series(line: Line) -> dict[str, Any]:
    x, y = (np.asarray(v, dtype=np.float64) for v in (line.x, line.y))
    if line.mode == "lines":
        x, y = thinned(x, y)
    shown = {"colour": line.colour, "dash": line.dash, "mode": line.mode, "symbol": line.symbol}
    return {
        "name": line.name,
        "x": _numbers(x),
        "y": _numbers(y),
        **{key: value for key, value in shown.items() if value},
    }


def _numbers(values: Array) -> list[float | None]:
    return [float(f"{v:.6g}") if np.isfinite(v) else None for v in values]
