"""Figures of pages as objects of plotly, for notebooks: the same data in the same colours as plots.js and panels.js."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go  # type: ignore[import-untyped]

from sms.report.plots import Figure

COLOURS = {
    "measured": "#1c2126", "baseline": "#d55e00", "extended": "#0072b2", "floor": "#8c96a0", "good": "#00684d",
    "warn": "#8a5a00", "bad": "#a8321f",
}  # fmt: skip
"""As style.css has them in the light; of `measured` and `floor` a notebook's own theme is the paper."""
_CYCLE = ("measured", "extended", "baseline", "good", "warn", "floor")


def of_figure(figure: Figure) -> go.Figure:
    """Lines over one axis."""
    drawn = go.Figure()
    for number, line in enumerate(figure.lines):
        colour = COLOURS[line.colour or _CYCLE[number % len(_CYCLE)]]
        drawn.add_scatter(
            x=np.asarray(line.x), y=np.asarray(line.y), name=line.name, mode=line.mode,
            showlegend=bool(line.name), line={"color": colour, "width": 1.6, "dash": line.dash or "solid"},
            marker={"color": colour, "symbol": line.symbol or "circle"},
        )  # fmt: skip
    for mark in figure.marks:
        (drawn.add_hline if "y" in mark else drawn.add_vline)(
            *[mark[k] for k in ("x", "y") if k in mark], line={"color": COLOURS["bad"], "dash": "dot"}
        )  # fmt: skip
    drawn.update_xaxes(title=figure.x, type="log" if figure.log_x else None, range=figure.range_x)
    drawn.update_yaxes(title=figure.y, type="log" if figure.log_y else None, range=figure.range_y)
    return _titled(drawn, figure.title)


def of_view(view: Mapping[str, Any]) -> go.Figure:
    """Panels above each other over one axis, or a map of correlations (panels.py)."""
    if "names" in view:
        heat = go.Heatmap(
            x=view["names"], y=view["names"], z=view["values"], zmin=-1.0, zmax=1.0,
            colorscale=[[0.0, COLOURS["baseline"]], [0.5, "#f4f4f2"], [1.0, COLOURS["extended"]]],
        )  # fmt: skip
        drawn = go.Figure(heat)
        drawn.update_yaxes(autorange="reversed")
        return _titled(drawn, view["label"])
    drawn = go.Figure()
    panels = view["panels"]
    for number, (panel, (low, high)) in enumerate(zip(panels, _domains(panels), strict=True), 1):
        for trace in panel["traces"]:
            drawn.add_trace(_trace(trace, f"y{number if number > 1 else ''}"))
        axis: dict[str, Any] = {"title": panel["title"], "domain": [low, high]}
        if panel.get("log"):
            axis["type"] = "log"
        if panel.get("range"):
            axis["range"] = panel["range"]
        if panel.get("from_zero"):
            axis["rangemode"] = "tozero"
        drawn.update_layout({f"yaxis{number if number > 1 else ''}": axis})
    last = f"y{len(panels)}" if len(panels) > 1 else "y"
    drawn.update_xaxes(
        title=view["x_title"], anchor=last, type="log" if view.get("x_log") else None
    )
    if view.get("x_names"):
        names = view["x_names"]
        drawn.update_xaxes(tickvals=list(range(1, len(names) + 1)), ticktext=names)
    return _titled(drawn, view["label"])


def _trace(trace: Mapping[str, Any], axis: str) -> go.Scatter:
    colour = COLOURS[trace["colour"]]
    drawn = go.Scatter(
        x=trace["x"], y=trace["y"], name=trace["name"], mode=trace["mode"], yaxis=axis,
        showlegend=bool(trace["name"]) and not trace.get("quiet"),
        line={"color": colour, "dash": trace.get("dash", "solid")},
        marker={"color": colour, "size": trace.get("size", 5), "symbol": trace.get("symbol", "circle")},
    )  # fmt: skip
    if "error" in trace:
        below = trace.get("error_below")
        drawn.error_y = {"array": trace["error"], "arrayminus": below, "symmetric": below is None}
    return drawn


def _domains(panels: Sequence[Mapping[str, Any]], gap: float = 0.05) -> list[tuple[float, float]]:
    """Where each panel lies, from the top down, by its share of the height."""
    shares = np.array([float(panel.get("share", 1)) for panel in panels])
    heights = shares / shares.sum() * (1.0 - gap * (len(panels) - 1))
    tops = 1.0 - np.concatenate([[0.0], np.cumsum(heights + gap)[:-1]])
    return [
        (max(float(top - height), 0.0), float(top))
        for top, height in zip(tops, heights, strict=True)
    ]


def _titled(drawn: go.Figure, title: str) -> go.Figure:
    return drawn.update_layout(
        title=title, legend={"orientation": "h", "y": 1.0, "yanchor": "bottom"}
    )
