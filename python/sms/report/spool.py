"""The page of `sms identify spool`: the static law, how the spool follows, and what pressures say of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from sms import _core
from sms.identification.spool import (
    EQUATION,
    LawFit,
    PositionFit,
    SpoolResult,
    SpoolRun,
    static_law,
)
from sms.identification.spool_result import sentences
from sms.parameters import PARAMETERS
from sms.report.bench_fit import bench_parts
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
from sms.units_display import format_estimate, format_quantity, words

_COLOURS: dict[str, Colour] = {"cubic": "extended", "linear": "baseline"}
_POINTS = 1500  # of a record in the static map
SETTLED = 0.03  #: s, after which a spool has followed


def spool_html(result: SpoolResult) -> str:
    """The whole page as text; plotly.js is 2 MB of it."""
    return spool_page(result).html


def spool_page(result: SpoolResult) -> PanelsPage:
    """Its parts, and the figures that they hold."""
    said = "".join(f"<li>{esc(text)}</li>" for text in sentences(result))
    parts = [
        f'<p class="eyebrow">Spool identification · {esc(result.rig)}</p>'
        f"<h1>{esc(result.title)}</h1><ul class='said'>{said}</ul>"
    ]
    figures: dict[str, list[dict[str, Any]]] = {}
    if result.position is not None:
        parts += _position_parts(result.position, figures)
    if result.pressure is not None:
        more, drawn = bench_parts(result.pressure)
        parts += more
        figures |= drawn
    if result.findings:
        items = "".join(f"<li>{esc(str(f))}</li>" for f in result.findings)
        parts.append(section("data-check", "Data check", f"<ul class='said'>{items}</ul>"))
    parts.append(f"<p class='small'>sms {_core.__version__}</p>")
    return PanelsPage(f"Spool: {result.title}", parts, figures)


def _position_parts(fit: PositionFit, figures: dict[str, list[dict[str, Any]]]) -> list[str]:
    figures["static"] = [_static_view(fit)]
    figures["positions"] = [_run_view(fit, number) for number in range(len(fit.runs))]
    figures["position-correlation"] = [
        correlation_view(
            EQUATION[f.law], [words(x.name) for x in f.found.free], f.found.correlation
        )
        for f in fit.laws
    ]
    return [
        figure("static", "Spool over command", figures["static"],
               "Every sample, also those in motion, which lie beside the law; below, measured less law where the "
               "command rests or runs slowly."),
        section("spool-parameters", f"Parameters of {EQUATION[fit.best]}", _table(fit.law(fit.best)),
                "Standard errors allow for the autocorrelation of the residual. The coefficients of a polynomial are "
                "strongly correlated: use them together."),
        figure("positions", "Measured and predicted position", figures["positions"],
               "The command, straight between its samples, through lag and static law; below, measured less "
               "predicted.", "tall"),
        figure("position-correlation", "What replaces what", figures["position-correlation"],
               "Correlation of the estimates by position."),
    ]  # fmt: skip


def _static_view(fit: PositionFit) -> dict[str, Any]:
    command = np.concatenate([r.command for r in fit.runs])
    position = np.concatenate([r.position for r in fit.runs])
    slow = np.concatenate([_slow(r) for r in fit.runs])
    drawn = np.arange(0, command.size, max(command.size // _POINTS, 1))
    still = drawn[slow[drawn]]
    grid = np.linspace(command.min(), command.max(), 200)
    top = [trace(command[drawn], 1e3 * position[drawn], "measured", "measured", "markers", size=3)]
    below = []
    for f in fit.laws:
        limit = f.found.params.spool_limit
        law = np.clip(static_law(f.law, f.found.params, grid), -limit, limit)
        top.append(trace(grid, 1e3 * law, EQUATION[f.law], _COLOURS[f.law]))
        at = np.clip(static_law(f.law, f.found.params, command[still]), -limit, limit)
        below.append(
            trace(
                command[still], 1e6 * (position[still] - at), "", _COLOURS[f.law], "markers", size=3
            )
        )
    panels = [panel("spool [mm]", top, share=2), panel("measured − law [µm]", below)]
    return view("", "command [V]", panels)


def _slow(run: SpoolRun) -> NDArray[np.bool_]:
    """(n,): where the command has run slower than 1 V/s for SETTLED, so that the spool is less than 4 mV behind."""
    speed = np.abs(np.diff(run.command, prepend=run.command[0])) / run.step
    width = max(round(SETTLED / run.step), 1)
    fastest = maximum_filter1d(speed, width, origin=(width - 1) // 2)
    return np.asarray(fastest < 1.0)


def _run_view(fit: PositionFit, number: int) -> dict[str, Any]:
    run = fit.runs[number]
    record = _core.SpoolRecord(step=run.step, command=run.command, position=run.position)
    first = record.first_compared
    time, measured = run.time[first:] - run.time[0], run.position[first:]
    off = {f.law: _core.SpoolProblem([record], f.law).evaluate(f.found.params)[0] for f in fit.laws}
    rows = thinned(time, measured, off[fit.best])
    top = [trace(time[rows], 1e3 * measured[rows], "measured", "measured")]
    below = []
    for f in fit.laws:
        predicted = measured + off[f.law]
        top.append(
            trace(time[rows], 1e3 * predicted[rows], EQUATION[f.law], _COLOURS[f.law], dash="dash")
        )
        below.append(trace(time[rows], -1e6 * off[f.law][rows], "", _COLOURS[f.law]))
    panels = [panel("spool [mm]", top, share=2), panel("measured − predicted [µm]", below)]
    return view(f"{run.name} ({run.role})", "time [s]", panels)


def _table(fit: LawFit) -> str:
    rows = []
    for t in fit.told:
        unit = PARAMETERS[t.name].unit
        rows.append(
            [
                esc(words(t.name)), esc(format_estimate(t.value, t.error, unit, t.name)),
                esc(format_quantity(t.before, unit, t.name)), "yes" if t.told else "no",
            ]
        )  # fmt: skip
    return table("", ("parameter", "value ± standard error", "declared", "identifiable"), rows)
