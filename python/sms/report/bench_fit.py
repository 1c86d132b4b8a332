"""Parts of a page about a fit of the bench: curves, residuals, what each record says, what it is worth."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms.arrays import Array
from sms.estimation.windows import Runs
from sms.identification.actuator import BenchResult
from sms.identification.bench_fit import BenchFit, Told, start_params
from sms.identification.bench_result import gain_cell
from sms.io.signals import SIGNAL_UNITS
from sms.parameters import PARAMETERS
from sms.report.markup import esc, section, table
from sms.report.panels import Colour, correlation_view, figure, panel, thinned, trace, view
from sms.units_display import axis_unit, display_unit, format_estimate, format_quantity, words

_SHADE: dict[str, Colour] = {
    "extension": "extended",
    "chamber_pressure_lower": "baseline",
    "chamber_pressure_upper": "good",
    "supply_pressure": "warn",
}

Views = dict[str, list[dict[str, Any]]]


def bench_parts(result: BenchResult) -> tuple[list[str], Views]:
    """The sections of the page, and the figures that they hold."""
    fit = result.fit
    figures: Views = {"fits": _fit_views(fit), "correlation": [_correlation(fit)]}
    parts = [
        section(
            "parameters", "Parameters", _parameters(fit.wanted, result.asked),
            "One standard error each: from the residuals with their autocorrelation, and from the scatter of the "
            "records where that is larger. Known within: half width as declared. Not identifiable: no more accurate "
            "than declared, or uncertain by half of its value or more.",
        ),
        figure(
            "fits", "Measured and predicted", figures["fits"],
            "Each window of a second is simulated from the command and an initial state of its own. Below: predicted "
            "less measured, in standard deviations of the declared noise; dotted with the parameters as declared.",
            "tall",
        ),
    ]  # fmt: skip
    if fit.gain:
        parts.append(
            section("gain", "Validation records", _gain_table(fit),
                    "Root mean square of the residual; its reduction with a 95 % interval over resampled windows.")
        )  # fmt: skip
    if len(fit.records.identify.motions) > 1:
        figures["runs"] = [v for t in fit.wanted if (v := _runs_view(fit, t)) is not None]
        parts.append(
            figure("runs", "Record by record", figures["runs"],
                   "Fitted to each record alone, with two standard errors; the line is the common fit. Records "
                   "from which a parameter is not identifiable are left out.", "low")
        )  # fmt: skip
    parts.append(
        figure("correlation", "What replaces what", figures["correlation"],
               "Correlation of the estimates, with what is known within limits.", "tall")
    )  # fmt: skip
    parts.append(
        section("surroundings", "Known within limits", _parameters(fit.surroundings, None),
                "Fitted within what is declared of them, so that their uncertainty is part of every error above.")
    )  # fmt: skip
    if fit.left_out:
        items = "".join(
            f"<li><b>{esc(words(name))}</b>: {esc(why)}</li>" for name, why in fit.left_out
        )
        parts.append(
            section(
                "not-told", "Not identifiable from these records", f"<ul class='said'>{items}</ul>"
            )
        )
    return parts, figures


def _fit_views(fit: BenchFit) -> list[dict[str, Any]]:
    start = start_params(fit.records.rig)
    views = []
    for runs in (fit.records.identify, fit.records.validate):
        if runs is not None:
            off = runs.problem.errors(start), runs.problem.errors(fit.found.params)
            views += [_fit_view(runs, number, *off) for number in range(len(runs.motions))]
    return views


def _fit_view(runs: Runs, number: int, declared: Array, identified: Array) -> dict[str, Any]:
    run = runs.motions[number]
    panels: dict[str, list[dict[str, Any]]] = {"mm": [], "bar": [], "sd": []}
    for c, channel in enumerate(runs.channels):
        rows = (runs.record == number) & (runs.channel == c)
        sample = runs.sample[rows]
        time = run.time[sample] - run.time[0]
        measured = run.signals[channel][sample]
        off, before = identified[rows], declared[rows]
        drawn = thinned(time, measured, off)
        unit = axis_unit(SIGNAL_UNITS[channel])
        place = "mm" if channel == "extension" else "bar"
        shade = _SHADE[channel]
        predicted = measured + off * runs.noise[channel]
        curves = [
            trace(
                time[drawn],
                unit.factor * measured[drawn],
                "measured" if channel == "extension" else "",
                "measured",
            ),
            trace(time[drawn], unit.factor * predicted[drawn], words(channel), shade, dash="dash"),
        ]
        if channel != "supply_pressure":  # nearly constant, far above the chambers'
            panels[place] += curves
        panels["sd"] += [
            trace(
                time[drawn], np.clip(before[drawn], -20.0, 20.0), "", shade, dash="dot", quiet=True
            ),
            trace(
                time[drawn],
                off[drawn],
                words(channel) if channel == "supply_pressure" else "",
                shade,
            ),
        ]
    titles = {"mm": "extension [mm]", "bar": "pressure [bar]", "sd": "off / noise"}
    return view(
        f"{run.name} ({run.role})",
        "time [s]",
        [panel(titles[key], traces, share=1) for key, traces in panels.items()],
    )


def _parameters(told: tuple[Told, ...], asked: tuple[str, ...] | None) -> str:
    rows = []
    for t in told:
        unit = PARAMETERS[t.name].unit
        beside = "" if asked is None or t.name in asked else " (beside)"
        cells = [
            esc(words(t.name) + beside),
            esc(format_estimate(t.value, t.error, unit, t.name)),
            esc(format_quantity(t.before, unit, t.name)),
            esc(format_quantity(t.known_to, unit, t.name)) if t.known_to else "unknown",
        ]
        if asked is not None:
            cells += [esc(format_quantity(t.scatter, unit, t.name, 2)), "yes" if t.told else "no"]
        rows.append(cells)
    headers = ["parameter", "value ± standard error", "declared", "known within"]
    if asked is not None:
        headers += ["scatter of records", "identifiable"]
    return table("", headers, rows)


def _gain_table(fit: BenchFit) -> str:
    rows = [
        [
            esc(g.record), esc(words(g.channel)),
            *(esc(format_quantity(v, SIGNAL_UNITS[g.channel])) for v in (g.before, g.after, g.noise)),
            esc(gain_cell(g.gain, *g.interval)),
        ]
        for g in fit.gain
    ]  # fmt: skip
    return table(
        "", ("record", "signal", "as declared", "as identified", "declared noise", "gain"), rows
    )


def _runs_view(fit: BenchFit, t: Told) -> dict[str, Any] | None:
    names = [m.name for m in fit.records.identify.motions]
    known = [i for i, (v, _) in enumerate(t.runs) if np.isfinite(v)]
    if not known:
        return None
    unit = display_unit(PARAMETERS[t.name].unit, abs(t.value), t.name)
    x = np.array([i + 1.0 for i in known])
    value = unit.factor * np.array([t.runs[i][0] for i in known])
    error = unit.factor * 2.0 * np.array([t.runs[i][1] for i in known])
    ends = np.array([0.5, len(names) + 0.5])
    traces = [
        trace(ends, np.full(2, unit.factor * t.value), "together", "extended"),
        trace(x, value, "alone", "measured", "markers", size=8, error=error),
    ]
    label = f"[{unit.label}]" if unit.label else ""
    return view(words(t.name), "", [panel(f"{words(t.name)} {label}", traces)], x_names=names)


def _correlation(fit: BenchFit) -> dict[str, Any]:
    return correlation_view("", [words(f.name) for f in fit.found.free], fit.found.correlation)
