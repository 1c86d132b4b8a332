"""The page of `sms identify friction`: the map, the laws against it, and what each run says."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms import _core
from sms.identification.friction import FrictionResult
from sms.identification.friction_fit import EQUATION
from sms.identification.friction_map import friction_map, law_over_record
from sms.identification.friction_result import sentences
from sms.parameters import PARAMETERS
from sms.report.markup import esc, section, table
from sms.report.panels import Colour, PanelsPage, correlation_view, figure, panel, trace, view
from sms.rigs.cylinder import Motion
from sms.units_display import display_unit, format_estimate, format_quantity, words

_COLOURS: dict[str, Colour] = {
    "stribeck": "baseline", "two_branch": "good", "acceleration_dependent": "extended",
    "lugre": "warn",
}  # fmt: skip
_DRAWN = 1500  # samples of a record


def friction_html(result: FrictionResult) -> str:
    """The whole page as text; plotly.js is 2 MB of it."""
    return friction_page(result).html


def friction_page(result: FrictionResult) -> PanelsPage:
    """Its parts, and the figures that they hold."""
    best = result.law(result.best)
    figures: dict[str, list[dict[str, Any]]] = {
        "map": [_map_view(result, m) for m in result.motions],
        "correlation": [
            correlation_view(EQUATION[f.law], [words(x.name) for x in f.found.free], f.found.correlation)
            for f in sorted(result.laws, key=lambda f: f.law != result.best)
        ],
    }  # fmt: skip
    runs = _runs_view(result)
    if runs:
        figures["runs"] = runs
    said = "".join(f"<li>{esc(text)}</li>" for text in sentences(result))
    parts = [
        f'<p class="eyebrow">Friction identification · {esc(result.rig)}</p>'
        f"<h1>{esc(result.title)}</h1><ul class='said'>{said}</ul>",
        figure("map", "Friction over velocity", figures["map"],
               "Measured: pressure forces less inertia and load (eq. 6.4). Every law is evaluated along "
               "the same motion; below, measured less law.", "tall"),
        section("laws", "The laws", _laws_table(result),
                "Root mean square of each law's residual, in newtons."),
        section("parameters", f"Parameters of {EQUATION[result.best]}", _parameters_table(result),
                "Standard errors allow for residuals correlated within a stroke, and for runs that differ "
                "(jackknife). A parameter that is identifiable from all runs together need not be so from "
                "one alone."),
    ]  # fmt: skip
    if runs:
        parts.append(
            figure("runs", "Run by run", runs, "Each run fitted alone by the best law; the line is "
                   "the common fit.", "low")
        )  # fmt: skip
    parts.append(
        figure("correlation", "What replaces what", figures["correlation"],
               "Correlation of the estimates.")
    )  # fmt: skip
    not_shown = "".join(
        f"<li><b>{esc(words(name))}</b> ({esc(EQUATION[f.law])}): {esc(why)}</li>"
        for f in result.laws
        for name, why in f.left_out
    )
    if not_shown:
        parts.append(
            section("not-shown", "Not identifiable with this excitation", f"<ul class='said'>{not_shown}</ul>")
        )  # fmt: skip
    if result.findings:
        items = "".join(f"<li>{esc(str(f))}</li>" for f in result.findings)
        parts.append(section("data-check", "Data check", f"<ul class='said'>{items}</ul>"))
    parts.append(
        f"<p class='small'>sms {_core.__version__}; condition number {best.found.condition:.3g}</p>"
    )
    return PanelsPage(f"Friction: {result.title}", parts, figures)


def _map_view(result: FrictionResult, motion: Motion) -> dict[str, Any]:
    best = result.law(result.best).found.params
    measured = friction_map(motion, best)
    used = np.flatnonzero(motion.used)
    rows = used[:: max(used.size // _DRAWN, 1)]
    speed = 1e3 * motion.velocity[rows]
    top = [trace(speed, measured[rows], "measured", "measured", "markers", size=3)]
    below = []
    for f in result.laws:
        law = law_over_record(motion, f, measured, best)[rows]
        top.append(trace(speed, law, EQUATION[f.law], _COLOURS[f.law], "markers", size=3))
        below.append(trace(speed, measured[rows] - law, "", _COLOURS[f.law], "markers", size=3))
    panels = [panel("friction [N]", top, share=2), panel("measured − law [N]", below)]
    return view(f"{motion.name} ({motion.role})", "velocity [mm/s]", panels)


def _laws_table(result: FrictionResult) -> str:
    rows = [
        [
            esc(EQUATION[f.law].replace(" ", "\N{NO-BREAK SPACE}")), f"{f.rms_identify:.3g}",
            f"{f.rms_validate:.3g}" if np.isfinite(f.rms_validate) else "",
            esc(", ".join(words(t.name) for t in f.told)),
        ]
        for f in result.laws
    ]  # fmt: skip
    return table("", ("law", "identify [N]", "validate [N]", "fitted"), rows)


def _parameters_table(result: FrictionResult) -> str:
    rows = [
        [
            esc(words(t.name)),
            esc(format_estimate(t.value, t.error, PARAMETERS[t.name].unit, t.name)),
            esc(format_quantity(t.half_width, PARAMETERS[t.name].unit, t.name, 2)),
            esc(format_quantity(t.scatter, PARAMETERS[t.name].unit, t.name, 2)),
            "yes" if t.shown else "no",
        ]
        for t in result.law(result.best).told
    ]  # fmt: skip
    headers = (
        "parameter",
        "value ± standard error",
        "half of 95 %",
        "scatter of the runs alone",
        "shown",
    )
    return table("", headers, rows)


def _runs_view(result: FrictionResult) -> list[dict[str, Any]]:
    views = []
    for t in result.law(result.best).told:
        if len(t.runs) < 2:
            continue
        unit = display_unit(PARAMETERS[t.name].unit, abs(t.value), t.name)
        ends = np.array([0.5, len(t.runs) + 0.5])
        traces = [
            trace(ends, np.full(2, unit.scale(t.value)), "together", "extended"),
            trace(np.arange(1, len(t.runs) + 1), unit.factor * np.array(t.runs), "alone", "measured",
                  "markers", size=8),
        ]  # fmt: skip
        names = [m.name for m in result.motions if m.role == "identify"]
        title = f"{words(t.name)} [{unit.label}]"
        views.append(view(words(t.name), "", [panel(title, traces)], x_names=names))
    return views
