"""The page of `sms calibrate geometry`: errors before and after, and the interval of every parameter."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms.arrays import Array
from sms.calibration.fit import COVERAGE, Calibrated, Found, problem_of
from sms.calibration.rig import CHANNELS
from sms.report.markup import esc, section, table
from sms.report.panels import Colour, figure, panel, panels_page, space_view, trace, view

_ENLARGED = 10.0
"""By which factor errors of attitude are drawn."""
_HEIGHT = 2
"""Column of a pose."""


def calibration_html(calibrated: Calibrated, said: list[str]) -> str:
    """The whole page as text."""
    rig = calibrated.rig
    measured = rig.fitted.pose
    before, after = (
        _strokes(measured, e) for e in (calibrated.errors_before, calibrated.errors_after)
    )
    space = _space(calibrated)
    plane = view(
        "from above", "roll [deg]",
        [panel("pitch [deg]", [
            trace(np.degrees(measured[:, 0]), np.degrees(measured[:, 1]), "poses", "measured", "markers"),
            trace(before[0], before[1], "before", "baseline"),
            trace(after[0], after[1], "after", "extended"),
        ])],
    )  # fmt: skip
    errors = _errors(calibrated)
    items = "".join(f"<li>{esc(text)}</li>" for text in said)
    values = table(
        "Every parameter, with its interval of 95 %",
        ("parameter", "nominal", "calibrated", "interval", "said by"),
        [_row(f) for f in calibrated.found],
    )
    combined = table(
        "Combinations: one tolerance of each moves the readings by so many standard deviations of their noise",
        ("combination", "standard deviations", "told"),
        [
            (esc(c.words), f"{c.information:.3g}", "yes" if c.told else "no")
            for c in calibrated.combinations
        ],
    )
    body = (
        f"<h1>{esc(rig.title)}</h1><ul class='said'>{items}</ul>"
        + figure(
            "plane",
            "The poses",
            [space, plane],
            f"Arrows: measured less predicted attitude, {_ENLARGED:g} times enlarged, before and after. The height "
            "is the calibrated mechanism's.",
            "tall",
        )
        + figure(
            "errors",
            "Measured less predicted",
            [errors],
            "Of the poses that were fitted.",
            "tall" if rig.distances else "low",
        )
        + section("parameters", "Parameters", values)
        + section("combinations", "What the poses tell and what not", combined)
    )
    figures = {"plane": [space, plane], "errors": [errors]}
    return panels_page(f"Calibration: {rig.title}", body, figures)


def _errors(calibrated: Calibrated) -> dict[str, Any]:
    """Over the number of each pose: a panel for each angle and, where there are distances, one for all of them."""
    rig, number = calibrated.rig, calibrated.rig.fitted.row.astype(np.float64)
    shown = [("roll [deg]", [0], np.degrees(1.0)), ("pitch [deg]", [1], np.degrees(1.0))]
    if rig.distances:
        behind = list(range(len(CHANNELS), len(rig.channels)))
        shown.append(("distances [mm]", behind, 1e3))
    both: tuple[tuple[str, Colour, Array], ...] = (
        ("before", "baseline", calibrated.errors_before),
        ("after", "extended", calibrated.errors_after),
    )
    panels = []
    for first, (label, columns, scale) in enumerate(shown):
        traces = [
            trace(
                np.repeat(number, len(columns)),
                scale * errors[:, columns].ravel(),
                name,
                colour,
                "markers",
                quiet=first > 0,
            )
            for name, colour, errors in both
        ]
        panels.append(panel(label, traces))
    return view("", "pose", panels)


def _space(calibrated: Calibrated) -> dict[str, Any]:
    """The poses over roll, pitch and height, each with its errors as arrows."""
    rig = calibrated.rig
    height = problem_of(rig.fitted, rig, calibrated.nominal).predict(calibrated.params)[:, _HEIGHT]
    roll, pitch = np.degrees(rig.fitted.pose[:, :2]).T
    traces = [trace(roll, pitch, "poses", "measured", "markers", z=height)]
    both: tuple[tuple[str, Colour, Array], ...] = (
        ("before", "baseline", calibrated.errors_before),
        ("after", "extended", calibrated.errors_after),
    )
    for name, colour, errors in both:
        x, y = _strokes(rig.fitted.pose, errors)
        traces += [
            trace(x, y, name, colour, z=np.repeat(height, 3)),
            trace(
                x[1::3], y[1::3], name, colour, "markers", z=height, symbol="diamond", quiet=True
            ),
        ]
    return space_view("in space", ("roll [deg]", "pitch [deg]", "height [m]"), traces)


def _strokes(at: Array, error: Array) -> tuple[Array, Array]:
    """From each pose along its error, with a gap after each: roll and pitch, deg."""
    begin, end = at[:, :2], at[:, :2] + _ENLARGED * error[:, :2]
    path = np.degrees(np.stack([begin, end, np.full_like(begin, np.nan)], axis=1)).reshape(-1, 2)
    return path[:, 0], path[:, 1]


def _row(f: Found) -> tuple[str, ...]:
    scale, unit = {"m": (1e3, "mm"), "rad": (np.degrees(1.0), "deg")}.get(
        f.unknown.unit, (100.0, "%")
    )
    half = COVERAGE * f.deviation
    return (
        esc(f.unknown.name),
        f"{f.nominal * scale:.3f} {unit}",
        f"{f.value * scale:.3f} {unit}",
        f"± {half * scale:.3f} {unit}",
        "poses" if f.measured else "drawing",
    )
