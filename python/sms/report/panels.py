"""Figures of a page as data: views to choose from, each some panels over one axis; drawn by panels.js."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sms.report.curves import thin
from sms.report.markup import esc, section
from sms.report.page import asset, page, plots

Colour = Literal["measured", "baseline", "extended", "floor", "good", "warn", "bad"]
POINTS = 700
"""Points of one line over time."""


def numbers(values: ArrayLike) -> list[float | None]:
    """For JSON: six digits, and null for what is not finite."""
    flat = np.asarray(values, dtype=np.float64).ravel().tolist()
    return [float(f"{v:.6g}") if math.isfinite(v) else None for v in flat]


def trace(
    x: ArrayLike,
    y: ArrayLike,
    name: str = "",
    colour: Colour = "extended",
    mode: Literal["lines", "markers", "lines+markers"] = "lines",
    **more: Any,
) -> dict[str, Any]:
    """One curve. `more`: dash, size, symbol, quiet, and error (above) with error_below, (n,); z, (n,), in space."""
    arrays = {k: numbers(v) for k, v in more.items() if k in ("error", "error_below", "z")}
    return {"x": numbers(x), "y": numbers(y), "name": name, "colour": colour, "mode": mode} | (
        more | arrays
    )


def panel(title: str, traces: Sequence[Mapping[str, Any]], **more: Any) -> dict[str, Any]:
    """One axis with its curves. `more`: share (of the height), log, from_zero, range."""
    return {"title": title, "traces": list(traces)} | more


def view(
    label: str, x_title: str, panels: Sequence[Mapping[str, Any]], **more: Any
) -> dict[str, Any]:
    """What is drawn at a time. `more`: x_log; x_names, what stands at 1, 2, ... of the axis."""
    return {"label": label, "x_title": x_title, "panels": list(panels)} | more


def space_view(
    label: str, titles: tuple[str, str, str], traces: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """Curves in space, which can be turned; titles of x, y and z."""
    return {"label": label, "titles": list(titles), "traces": list(traces)}


def correlation_view(label: str, names: Sequence[str], correlation: NDArray[Any]) -> dict[str, Any]:
    """A correlation matrix (k, k) as a map."""
    return {"label": label, "names": list(names), "values": [numbers(row) for row in correlation]}


def thinned(time: NDArray[Any], *curves: NDArray[Any]) -> NDArray[np.intp]:
    """Rows to draw: extremes of every curve stay."""
    return thin((time, *curves), POINTS)


def figure(
    identifier: str,
    title: str,
    views: Sequence[Mapping[str, Any]],
    lead: str = "",
    size: Literal["", "tall", "low"] = "",
) -> str:
    """The section in which panels.js draws data[identifier]."""
    choice = f'<div class="choice" id="{identifier}-choice"></div>' if len(views) > 1 else ""
    plot = (
        f'<div id="{identifier}-plot" class="panels {size}" role="img" '
        f'aria-label="{esc(title)}"></div>'
    )
    return section(identifier, title, choice + plot, lead)


@dataclass(frozen=True)
class PanelsPage:
    """A page of panels before it is written: what a notebook takes from it too."""

    title: str
    parts: Sequence[str]
    figures: Mapping[str, Sequence[Mapping[str, Any]]]

    @property
    def html(self) -> str:
        """The whole page."""
        return panels_page(self.title, "".join(self.parts), self.figures)

    @property
    def without_figures(self) -> str:
        """Sentences and tables."""
        return "".join(part for part in self.parts if 'class="panels' not in part)


def panels_page(title: str, body: str, figures: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    """The whole page; `figures` by their identifier."""
    scripts = plots(dict(figures), "panels.js") if figures else None
    return page(title, f"<main>{body}</main>", scripts, asset("panels.css"))
