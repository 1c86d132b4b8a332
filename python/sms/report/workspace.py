"""The workspace as one HTML page: what fits in words, then the region, then what limits it."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.report.markup import esc, section, table
from sms.report.page import asset, page, plots
from sms.workspace_findings import box_words, degrees, findings
from sms.workspace_survey import Survey

_DRAWN = 0.05  # m, between the heights whose region is drawn


def workspace_html(survey: Survey) -> str:
    """The whole page as text, of which plotly.js is 2 MB."""
    figures = (
        _figure("stroke", "Stroke left in the worst corner of a box", "Below zero it does not fit.")
        + _figure(
            "alone", "Largest angle of one axis, the other level", "Either way, by the stroke."
        )
        + _figure("joints", "Largest turn of a joint", "From rest; a rod eye must allow it.")
        + _figure("condition", "Condition numbers", "Distance from singularity: 1 is best.")
        + _figure(
            "force",
            "Force needed, as a share of what the supply gives",
            "The most loaded actuator in the worst pose; friction not counted.",
        )
    )
    body = (
        f"<main>{_sentences(survey)}"
        + section(
            "region-part",
            "Roll and pitch by height",
            "<div id='region' role='img' aria-label='Reachable region of roll and pitch by height, "
            "with the boxes of Table 2.1'></div>",
            "Each line encloses what the three strokes allow at one height of the reference point. "
            "The filled one comes nearest to the required box. The boxes are Table 2.1's; one fits at "
            "a height whose line encloses it.",
        )
        + section("limits", "What limits it, by height", f"<div class='figures'>{figures}</div>")
        + section("numbers", "Numbers", _numbers(survey))
        + f"<p class='small'>sms {_core.__version__}; {esc(repr(survey.params))}</p></main>"
    )
    return page(
        "Workspace of the platform",
        body,
        plots(_payload(survey), "workspace.js"),
        asset("workspace.css"),
    )


def sentences_and_numbers(survey: Survey) -> str:
    """The page without its figures."""
    return _sentences(survey) + _numbers(survey)


def _sentences(survey: Survey) -> str:
    said = "".join(f"<li>{esc(text)}</li>" for text in findings(survey))
    return f"<h1>What the platform can reach</h1><ul class='findings-list'>{said}</ul>"


def _figure(name: str, title: str, note: str) -> str:
    return (
        f"<figure><figcaption><h3>{esc(title)}</h3><p class='small'>{esc(note)}</p></figcaption>"
        f"<div id='{name}' class='plot' role='img' aria-label='{esc(title)}'></div></figure>"
    )


def drawn_heights(survey: Survey) -> list[int]:
    """The heights nearest to multiples of _DRAWN, or the middle one."""
    low, high = survey.heights[0], survey.heights[-1]
    wanted = _DRAWN * np.arange(np.ceil(low / _DRAWN), np.floor(high / _DRAWN) + 1)
    return sorted({int(np.argmin(abs(survey.heights - height))) for height in wanted}) or [
        survey.heights.size // 2
    ]


def _numbers(survey: Survey) -> str:
    roll, pitch = survey.alone("roll"), survey.alone("pitch")

    def angles(axis: tuple[Array, Array], row: int) -> str:
        return f"{degrees(axis[0][row])} to +{degrees(axis[1][row])}".replace("-", "−")

    rows = [
        (
            f"{1e3 * survey.heights[row]:.0f} mm",
            angles(roll, row),
            angles(pitch, row),
            degrees(survey.worst.base_panhard[row]),
            f"{survey.worst.link_condition[row]:.2f}",
            f"{survey.worst.holding_share[row]:.0%}",
        )
        for row in drawn_heights(survey)
    ]
    headers = (
        "height",
        "roll alone",
        "pitch alone",
        "largest turn of a joint (rod, base)",
        "condition, six links",
        "force to hold",
    )
    return table("The worst of all poses within the stroke at each height.", headers, rows)


def _payload(survey: Survey) -> dict[str, Any]:
    """What workspace.js draws: mm and degrees, NaN as null."""
    roll, pitch = survey.alone("roll"), survey.alone("pitch")
    worst = survey.worst
    drawn = drawn_heights(survey)
    best = min(drawn, key=lambda row: abs(survey.heights[row] - survey.fits[0].best_height))
    by_height = {
        "roll −": np.degrees(-roll[0]),
        "roll +": np.degrees(roll[1]),
        "pitch −": np.degrees(-pitch[0]),
        "pitch +": np.degrees(pitch[1]),
        "actuator, base": np.degrees(worst.base_actuator),
        "actuator, platform": np.degrees(worst.platform_actuator),
        "rod, base": np.degrees(worst.base_panhard),
        "rod, platform": np.degrees(worst.platform_panhard),
        "Panhard rods": worst.panhard_condition,
        "all six links": worst.link_condition,
        "holding": 100.0 * worst.holding_share,
        "accelerating": 100.0 * worst.accelerating_share,
    }
    return {
        "height": _list(1e3 * survey.heights),
        "outlines": [
            {
                "height": round(1e3 * float(survey.heights[row])),
                "best": row == best,
                "roll": _list(np.degrees(survey.outline(row)[0])),
                "pitch": _list(np.degrees(survey.outline(row)[1])),
            }
            for row in drawn
        ],
        "boxes": [
            {
                "name": f"{fit.box.name}: {box_words(fit.box)}",
                "roll": float(np.degrees(fit.box.roll)),
                "pitch": float(np.degrees(fit.box.pitch)),
                "height": _list(1e3 * fit.heights[::10]),
                "margin": _list(1e3 * fit.margin[::10]),
            }
            for fit in survey.fits
        ],
        "by_height": {name: _list(values) for name, values in by_height.items()},
    }


def _list(values: Array) -> list[float | None]:
    return [round(float(v), 4) if np.isfinite(v) else None for v in values]
