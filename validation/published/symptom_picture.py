"""The picture of docs/symptom.md: how far the rod still travels with each cause, and how late."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from validation.published.symptom import LEAD, MEASURED, SIMULATED, Row

WIDTH, HEIGHT = 760, 460
LEFT, RIGHT, TOP, BOTTOM = 62, 24, 20, 50
TRAVEL = (88.0, 102.0)
"""Percent of the simulated travel at the same input."""
LAG = (-260.0, 260.0)
"""ms"""
COLOURS = ("#4477aa", "#ee6677", "#228833", "#b58900", "#66ccee", "#aa3377", "#777777")

LABELS = {
    "flow_conductance": (8.0, 28.0, "start"),
    "dead_band_width": (8.0, 42.0, "start"),
    "exhaust_restriction": (8.0, 56.0, "start"),
    "tube": (108.0, 0.0, "start"),
    "viscous_friction": (0.0, 22.0, "start"),
    "coulomb_friction": (8.0, 0.0, "start"),
    "presliding": (4.0, -10.0, "end"),
    "friction_lag": (4.0, 20.0, "end"),
    "command_delay": (-16.0, 22.0, "end"),
    "clock_skew:extension": (0.0, 22.0, "end"),
}
"""Where a name stands beside its first point."""


def picture(rows: Sequence[Row]) -> str:
    """SVG: one line with three points, one an input, for each cause; a cross for what was measured."""
    healthy = rows[0]
    body = [_axes()]
    shown = [row for row in rows[1:] if row.travels]
    for number, row in enumerate(shown):
        colour = COLOURS[number % len(COLOURS)]
        points = [
            (_x(100.0 * travel / reference), _y(1e3 * lag))
            for travel, reference, lag in zip(row.travels, healthy.travels, row.lags, strict=True)
        ]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        body.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        body += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>' for x, y in points]
        right, down, anchor = LABELS.get(row.cause, (8.0, 4.0, "start"))
        x, y = points[0][0] + right, points[0][1] + down
        body.append(
            f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">'
            f"{escape(row.cause.replace('_', ' ').replace(':', ' of '))}</text>"
        )
    x, y = _x(100.0 * MEASURED / SIMULATED), _y(-1e3 * LEAD)
    body.append(
        f'<path d="M{x - 9} {y - 9}L{x + 9} {y + 9}M{x - 9} {y + 9}L{x + 9} {y - 9}" stroke="#000" stroke-width="3"/>'
        f'<text x="{x + 14}" y="{y + 5}" font-weight="bold">measured</text>'
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        f'font-size="12"><rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>{"".join(body)}</svg>\n'
    )


def _x(percent: float) -> float:
    return LEFT + (percent - TRAVEL[0]) / (TRAVEL[1] - TRAVEL[0]) * (WIDTH - LEFT - RIGHT)


def _y(lag: float) -> float:
    return HEIGHT - BOTTOM - (lag - LAG[0]) / (LAG[1] - LAG[0]) * (HEIGHT - TOP - BOTTOM)


def _axes() -> str:
    lines = [
        f'<line x1="{_x(p):.1f}" y1="{TOP}" x2="{_x(p):.1f}" y2="{HEIGHT - BOTTOM}" stroke="#ddd"/>'
        f'<text x="{_x(p):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{p} %</text>'
        for p in range(88, 103, 2)
    ]
    lines += [
        f'<line x1="{LEFT}" y1="{_y(t):.1f}" x2="{WIDTH - RIGHT}" y2="{_y(t):.1f}" '
        f'stroke="{"#888" if t == 0 else "#ddd"}"/>'
        f'<text x="{LEFT - 8}" y="{_y(t) + 4:.1f}" text-anchor="end">{t}</text>'
        for t in range(-200, 201, 100)
    ]
    lines.append(
        f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle">travel, of that simulated at '
        f'the same input</text><text x="16" y="{(TOP + HEIGHT - BOTTOM) / 2}" text-anchor="middle" '
        f'transform="rotate(-90 16 {(TOP + HEIGHT - BOTTOM) / 2})">later than simulated [ms]</text>'
    )
    return "".join(lines)
