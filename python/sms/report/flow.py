"""The page of `sms identify flow`: what was found, the map, every fit, how sure it is."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms import _core
from sms.identification.estimate import LIMIT_95
from sms.identification.flow import FlowFit
from sms.identification.flow_map import MapCurve
from sms.identification.flow_problem import COMPONENT, SYMBOL
from sms.identification.flow_result import FlowResult
from sms.report.markup import esc, section, table
from sms.report.panels import (
    Colour,
    PanelsPage,
    correlation_view,
    figure,
    panel,
    thinned,
    trace,
    view,
)
from sms.units_display import words

C_SCALE = 1e8  # m^3/(s Pa) to l/s per bar
_LOOK: dict[str, Colour] = {"charge": "baseline", "discharge": "extended"}


def flow_html(result: FlowResult) -> str:
    """The whole page as text; plotly.js is 2 MB of it."""
    return flow_page(result).html


def flow_page(result: FlowResult) -> PanelsPage:
    """Its parts, and the figures that they hold."""
    good = result.good
    figures: dict[str, list[dict[str, Any]]] = {}
    if result.curves:
        figures["map"] = _map_views(result)
    if good:
        figures["fits"] = [_fit_view(f) for f in good]
        figures["profiles"] = [v for f in good for v in _profile_views(f)]
        figures["correlation"] = [_correlation_view(f) for f in good]
    said = "".join(f"<li>{esc(text)}</li>" for text in result.sentences())
    parts = [
        f'<p class="eyebrow">Flow identification · {esc(result.rig)}</p>'
        f"<h1>{esc(result.title)}</h1><ul class='said'>{said}</ul>"
    ]
    if result.curves:
        parts.append(
            figure(
                "map", "The valve over its spool", figures["map"],
                "Bars are 95 %: of C with everything in the budget, of b and m their profile "
                "intervals. Hollow marks are not identifiable; the map reads b and m off their "
                "neighbours there.", "tall",
            )
        )  # fmt: skip
    if good:
        parts += [
            figure("fits", "Measured and fitted", figures["fits"],
                   "The ISO law, and the classic one with its discharge coefficient fitted; below, "
                   "measured less fitted.", "tall"),
            figure("profiles", "Profile likelihood", figures["profiles"],
                   "How much worse the fit becomes when one parameter is held and all others are "
                   "fitted again, in units in which 3.84 is the 95 % limit. A curve that stays below "
                   "it on one side does not bound the parameter there. The interval of C in the list is wider: it "
                   "holds what is known within limits only, too.", "low"),
            figure("correlation", "Correlation", figures["correlation"],
                   "Correlation of the estimates of one record.", ""),
            section("records", "Every record", _records_table(result)),
            section("budget", "Uncertainty of C", _budget_table(result),
                    "One standard uncertainty of each part in percent of C (GUM: the fit by its "
                    "covariance with coloured residuals, limits as rectangular distributions)."),
        ]  # fmt: skip
    parts.append(section("notes", "Limits of these records", _notes(result)))
    heat = (
        f"tank: constant temperature, heat ratios {result.heat_ratios[0]:g} in and "
        f"{result.heat_ratios[1]:g} out"
        if result.heat == "polytropic"
        else "tank: full energy equation"
    )
    parts.append(f"<p class='small'>sms {_core.__version__}; {heat}</p>")
    return PanelsPage(f"Flow: {result.title}", parts, figures)


def _map_views(result: FlowResult) -> list[dict[str, Any]]:
    views = []
    for level in dict.fromkeys(c.supply_pressure for c in result.curves):
        curves = [c for c in result.curves if c.supply_pressure == level]
        panels = [
            panel("C [l/s per bar]", [t for c in curves for t in _conductance_traces(c)], share=2,
                  from_zero=True),
            panel("b", [t for c in curves for t in _shape_traces(result, c, COMPONENT[1])],
                  range=[0.0, 0.7]),
            panel("m", [t for c in curves for t in _shape_traces(result, c, COMPONENT[2])],
                  range=[0.0, 3.0]),
            panel("error [Pa]", [t for c in curves for t in _mae_traces(result, c)], log=True),
        ]  # fmt: skip
        views.append(view(f"supply {1e-5 * level:.2f} bar absolute", "spool [mm]", panels))
    return views


def _conductance_traces(c: MapCurve) -> list[dict[str, Any]]:
    fine = np.linspace(c.spool[0], c.spool[-1], 200)
    drawn = np.array([c.at(x)[0] for x in fine])
    colour = _LOOK[c.direction]
    return [
        trace(1e3 * fine, C_SCALE * drawn, c.direction, colour),
        trace(1e3 * c.spool, C_SCALE * c.conductance, "", colour, "markers",
              error=2 * C_SCALE * c.uncertainty),
    ]  # fmt: skip


def _members(result: FlowResult, c: MapCurve) -> list[FlowFit]:
    return [
        f for f in result.good
        if f.direction == c.direction and f.record.spool is not None
        and c.supply_pressure <= f.record.supply_pressure <= 1.05 * c.supply_pressure
    ]  # fmt: skip


def _shape_traces(result: FlowResult, c: MapCurve, name: str) -> list[dict[str, Any]]:
    out = []
    for told, symbol in ((True, "circle"), (False, "circle-open")):
        group = [f for f in _members(result, c) if f.known[name].identifiable == told]
        value = np.array([f.known[name].value for f in group])
        out.append(
            trace([1e3 * (f.record.spool or 0.0) for f in group], value, "", _LOOK[c.direction],
                  "markers", symbol=symbol,
                  error=np.array([f.known[name].upper for f in group]) - value,
                  error_below=value - np.array([f.known[name].lower for f in group]))
        )  # fmt: skip
    return out


def _mae_traces(result: FlowResult, c: MapCurve) -> list[dict[str, Any]]:
    group = _members(result, c)
    x = [1e3 * (f.record.spool or 0.0) for f in group]
    colour = _LOOK[c.direction]
    return [
        trace(x, [f.mae for f in group], f"ISO, {c.direction}", colour, "lines+markers", size=4),
        trace(x, [f.mae_classic for f in group], f"classic, {c.direction}", colour,
              "lines+markers", dash="dot", size=4),
    ]  # fmt: skip


def _fit_view(f: FlowFit) -> dict[str, Any]:
    assert f.found is not None
    n = f.record.time.size
    residual = -f.found.residual[:n]
    rows = thinned(f.record.time, f.record.pressure, residual)
    t, p = f.record.time[rows], f.record.pressure[rows]
    top = [trace(t, 1e-5 * p, "measured", "measured", "markers", size=3)]
    below = [trace(t, residual[rows], "", "extended", "markers", size=3)]
    if f.classic is not None:
        wrong = -f.classic.residual[:n][rows]
        top.append(trace(t, 1e-5 * (p - wrong), "classic", "baseline", dash="dot"))
        below.append(trace(t, wrong, "", "baseline", "markers", size=3))
    top.append(trace(t, 1e-5 * (p - residual[rows]), "ISO", "extended"))
    panels = [panel("pressure [bar]", top, share=2), panel("measured − fitted [Pa]", below)]
    return view(f.record.name, "time [s]", panels)


def _profile_views(f: FlowFit) -> list[dict[str, Any]]:
    views = []
    for name, curve in f.profiles.items():
        limit = np.full(2, LIMIT_95)
        scale, unit = (C_SCALE, " [l/s per bar]") if name == COMPONENT[0] else (1.0, "")
        value = scale * curve.value
        fine = np.linspace(value[0], value[-1], 200)
        root = np.sqrt(curve.rise) * np.sign(curve.value - f.known[name].value)  # nearly straight
        ends = [value[0], value[-1]]
        traces = [
            trace(fine, np.interp(fine, value, root) ** 2, SYMBOL[name], "extended"),
            trace(value, curve.rise, "", "extended", "markers"),
            trace(ends, limit, "95 %", "warn", dash="dot"),
        ]  # fmt: skip
        label = f"{f.record.name}: {f.known[name].verdict}"
        views.append(
            view(
                label,
                SYMBOL[name] + unit,
                [panel("rise of the cost", traces, range=[0.0, 4.0 * LIMIT_95])],
            )
        )
    return views


def _correlation_view(f: FlowFit) -> dict[str, Any]:
    assert f.found is not None
    names = [SYMBOL.get(free.name, words(free.name)) for free in f.found.free]
    return correlation_view(f.record.name, names, f.found.correlation)


def _records_table(result: FlowResult) -> str:
    rows = []
    for f in result.good:
        c = f.known[COMPONENT[0]]
        rows.append([
            esc(f.record.name),
            "" if f.record.spool is None else f"{1e3 * f.record.spool:.3f}",
            f"{C_SCALE * c.value:.4g} ± {C_SCALE * f.combined:.1g}",
            esc(_interval(f, COMPONENT[1])),
            esc(_interval(f, COMPONENT[2])),
            "" if f.classic is None else f"{f.classic.params.discharge_coefficient:.3f}",
            f"{f.mae:.0f}",
            "" if f.classic is None else f"{f.mae_classic:.0f}",
        ])  # fmt: skip
    headers = ("record", "spool [mm]", "C [l/s per bar], ± 1 sd", "b", "m", "C_d",
               "error, ISO [Pa]", "error, classic [Pa]")  # fmt: skip
    return f"<div class='scroll'>{table('', headers, rows)}</div>"


def _interval(f: FlowFit, name: str) -> str:
    k = f.known[name]
    span = f"{k.lower:.3g} to {k.upper:.3g}".replace(" ", "\N{NO-BREAK SPACE}")
    return f"{k.value:.3g} ({span})" if k.identifiable else f"not identifiable ({span})"


def _budget_table(result: FlowResult) -> str:
    names = list(dict.fromkeys(c.name for f in result.good for c in f.budget))
    rows = []
    for f in result.good:
        value = f.known[COMPONENT[0]].value
        by = {c.name: 100.0 * c.uncertainty / value for c in f.budget}
        cells = [f"{by[name]:.2g}" if name in by else "" for name in names]
        rows.append([esc(f.record.name), *cells, f"{100.0 * f.combined / value:.2g}"])
    headers = ("record", *(words(name) for name in names), "together [%]")
    return f"<div class='scroll'>{table('', headers, rows)}</div>"


def _notes(result: FlowResult) -> str:
    items = [f"<li>{esc(str(f))}</li>" for f in result.findings]
    items += [
        f"<li><b>{esc(f.record.name)}</b>: {esc(text)}</li>"
        for f in result.fits
        for text in f.notes
    ]
    return f"<ul class='said'>{''.join(items)}</ul>" if items else "<p class='empty'>Nothing.</p>"
