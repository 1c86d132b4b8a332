"""A comparison as one HTML page and as a table for the console."""

from __future__ import annotations

import math

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.comparison.files import WARNING, Comparison, Signal
from sms.comparison.metrics import FrequencyResponse
from sms.report.markup import esc, section, table
from sms.report.page import asset, page, plots
from sms.report.plots import Figure, Line, figures_html, payload
from sms.units_display import axis_unit, format_aligned, format_quantity, significant, words

HEADERS = (
    "signal",
    "MAE",
    "RMS error",
    "largest error",
    "amplitude ratio",
    "rise-time ratio",
    "correlation (7.2)",
    "lag",
)
RATIOS = (
    "Every ratio is simulated over measured, as the source's 0.85 for the rise time is. A positive "
    "lag means that the simulation is late."
)
_COHERENT = 0.5  # below it a frequency response is drawn as nothing


def table_rows(comparison: Comparison) -> list[list[str]]:
    """One row a signal, cells as text, in the order of HEADERS."""
    return [_row(signal) for signal in comparison.signals]


def comparison_html(comparison: Comparison) -> str:
    """The whole page, of which plotly.js is 2 MB."""
    figures = [figure for signal in comparison.signals for figure in _figures(comparison, signal)]
    shift = (
        f" The simulation's times were shifted by {comparison.shift:+.3f} s."
        if comparison.shift
        else ""
    )
    lead = (
        f"{comparison.simulated} against {comparison.measured}, "
        f"{comparison.time[0]:.2f} to {comparison.time[-1]:.2f} s.{shift}"
    )
    cells = [[esc(cell) for cell in row] for row in table_rows(comparison)]
    left = ", ".join(comparison.left_out)
    body = (
        f"<main><h1>Measured and simulated</h1><p class='lead'>{esc(lead)}</p>"
        + section("numbers", "Numbers", table(RATIOS, HEADERS, cells), "")
        + f"<p class='decide'>{esc(WARNING)}</p>"
        + section("curves", "Signals and frequency responses", figures_html(figures))
        + (f"<p class='small'>In one file only: {esc(left)}.</p>" if left else "")
        + f"<p class='small'>sms {_core.__version__}</p></main>"
    )
    return page(
        "Measured and simulated", body, plots(payload(figures), "plots.js"), asset("plots.css")
    )


def _row(signal: Signal) -> list[str]:
    m = signal.metrics
    errors = format_aligned(
        [m.mean_absolute_error, m.rms_error, m.largest_error], signal.unit, signal.name
    )
    errors[2] += f" at {m.largest_error_at:.2f} s"
    return [
        words(signal.name),
        *errors,
        significant(m.amplitude_ratio),
        significant(m.rise_time_ratio),
        "n/a" if math.isnan(m.correlation) else f"{m.correlation:.4f}",
        format_quantity(m.lag, "s"),
    ]


def _figures(comparison: Comparison, signal: Signal) -> list[Figure]:
    unit = axis_unit(signal.unit)
    name = words(signal.name)
    over_time = Figure(
        f"time-{signal.name}",
        name,
        "time in s",
        f"{name} in {unit.label}" if unit.label else name,
        [
            Line("measured", comparison.time, unit.factor * signal.measured, "measured"),
            Line("simulated", comparison.time, unit.factor * signal.simulated, "extended"),
        ],
        wide=True,
    )
    responses = {"simulated over measured": signal.response}
    if signal.response_measured is not None and signal.response_simulated is not None:
        responses = {
            f"measured over {comparison.input}": signal.response_measured,
            f"simulated over {comparison.input}": signal.response_simulated,
        }
    gains, phases, coherences = [], [], []
    for text, response in responses.items():
        shown = _coherent(response)
        used = slice(0, 1 + int(np.flatnonzero(np.isfinite(shown)).max(initial=0)))
        decibels = 20.0 * np.log10(np.maximum(response.gain, 1e-12))
        gains.append(Line(text, response.frequency[used], (decibels + shown)[used]))
        phase = np.degrees(response.phase) + shown
        phases.append(Line(text, response.frequency[used], phase[used]))
        coherences.append(Line(text, response.frequency, response.coherence))
    note = f"Shown where the coherence is above {_COHERENT:g}."
    return [
        over_time,
        Figure(
            f"gain-{signal.name}", f"{name}: gain", "frequency in Hz", "gain in dB", gains, note,
            log_x=True,
        ),
        Figure(
            f"phase-{signal.name}", f"{name}: phase", "frequency in Hz", "phase in °", phases, note,
            log_x=True,
        ),
        Figure(
            f"coherence-{signal.name}", f"{name}: coherence", "frequency in Hz", "coherence",
            coherences, "How much of one signal is linear in the other.", log_x=True,
        ),
    ]  # fmt: skip


def _coherent(response: FrequencyResponse) -> Array:
    """0 where the response can be trusted, NaN where not."""
    return np.where(response.coherence > _COHERENT, 0.0, np.nan)
