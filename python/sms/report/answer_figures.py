"""The figures of a diagnosis one by one: gain, curves, residual, where the error arises, what is missing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import plotly.graph_objects as go  # type: ignore[import-untyped]

from sms.diagnosis.result import Diagnosis, Series
from sms.errors import did_you_mean
from sms.io.units import split_column_name
from sms.report.plotly_figures import COLOURS, of_figure
from sms.report.plots import Figure, Line
from sms.units_display import axis_unit, words

Drawing = Callable[..., go.Figure]


def figures_of_diagnosis(d: Diagnosis) -> Mapping[str, Drawing]:
    """By name; only what this diagnosis has."""
    found: dict[str, Drawing] = {}
    if d.gain:
        found["gain"] = partial(_gain, d)
    if d.series:
        found["curves"] = partial(_curves, d)
        found["residual"] = partial(_residual, d)
    if d.hidden is not None:
        found["origin"] = partial(_origin, d)
        found["missing"] = partial(_missing, d)
    return found


def _chosen(d: Diagnosis, record: str, signal: str) -> Series:
    """The first series of a record and a signal, records for validation first."""
    ordered = sorted(d.series, key=lambda s: s.role != "validate")
    for said, names in (
        (record, [s.record for s in ordered]),
        (signal, [s.signal for s in ordered]),
    ):
        if said and said not in names:
            raise ValueError(f"there is no '{said}'; {did_you_mean(said, dict.fromkeys(names))}")
    return next(
        s for s in ordered if record in ("", s.record) and signal in ("", s.signal)
    )  # fmt: skip


def _models(d: Diagnosis) -> tuple[str, ...]:
    return ("baseline", "extended") if d.causes else ("baseline",)


def _gain(d: Diagnosis) -> go.Figure:
    """RMS errors of each record, in units of its signal's noise so that signals can share an axis."""
    drawn = go.Figure()
    names = [f"{g.record}, {words(g.signal)}" for g in d.gain]
    for model in _models(d):
        rms = [getattr(g, f"{model}_rms") / g.noise_floor for g in d.gain]
        drawn.add_bar(y=names, x=rms, orientation="h", name=model, marker={"color": COLOURS[model]})
    drawn.add_vline(1.0, line={"color": COLOURS["floor"], "dash": "dot"})
    drawn.update_yaxes(autorange="reversed")
    drawn.update_xaxes(title="RMS error / noise floor", rangemode="tozero")
    return drawn.update_layout(
        title="Improvement" if d.causes else "Simulation error", barmode="group"
    )


def _curves(d: Diagnosis, record: str = "", signal: str = "") -> go.Figure:
    s = _chosen(d, record, signal)
    unit = axis_unit(s.unit)
    used = np.asarray(s.used, bool)
    lines = [Line("measured", s.time, unit.factor * s.measured, "measured")]
    lines += [
        Line(model, s.time, np.where(used, unit.factor * getattr(s, model), np.nan), model)
        for model in _models(d)
    ]
    title = f"{s.record} ({s.role}), {words(s.signal)}"
    return of_figure(
        Figure("curves", title, "time [s]", f"{words(s.signal)} [{unit.label}]", lines)
    )


def _residual(d: Diagnosis, record: str = "", signal: str = "", over: str = "time") -> go.Figure:
    """Measured less simulated against one of the signals."""
    s = _chosen(d, record, signal)
    inputs = {split_column_name(name)[0]: (name, values) for name, values in s.inputs.items()}
    inputs.setdefault("time", ("time [s]", s.time))
    if over not in inputs:
        raise ValueError(f"over='{over}' is not recorded; {did_you_mean(over, inputs)}")
    name, values = inputs[over]
    x_unit, unit, used = (
        axis_unit(split_column_name(name)[1] or "1"),
        axis_unit(s.unit),
        np.asarray(s.used, bool),
    )
    lines = [
        Line(model, x_unit.factor * values[used], unit.factor * (s.measured - getattr(s, model))[used], model,
             mode="markers")
        for model in _models(d)
    ]  # fmt: skip
    title = f"{s.record} ({s.role}), error of {words(s.signal)}"
    across = f"{words(over)} [{x_unit.label}]" if x_unit.label else words(over)
    return of_figure(Figure("residual", title, across, f"error [{unit.label}]", lines))


def _origin(d: Diagnosis) -> go.Figure:
    """What an unknown input in each equation takes alone."""
    assert d.hidden is not None
    ordered = sorted(d.hidden.shares.items(), key=lambda item: item[1][0])
    share, low, high = (100.0 * np.array([s[k] for _, s in ordered]) for k in range(3))
    whiskers: dict[str, Any] = {
        "array": np.maximum(high - share, 0.0), "arrayminus": np.maximum(share - low, 0.0), "symmetric": False,
    }  # fmt: skip
    bars = go.Bar(
        y=[words(name) for name, _ in ordered], x=share, orientation="h", error_x=whiskers,
        marker={"color": COLOURS["baseline"]},
    )  # fmt: skip
    drawn = go.Figure(bars)
    drawn.update_xaxes(title="share of the error beyond the noise [%], 95 % interval")
    return drawn.update_layout(title="Where the error arises")


def _missing(d: Diagnosis) -> go.Figure:
    """The curve of the missing term with its band."""
    assert d.hidden is not None
    shape = d.hidden.shape
    name, unit = split_column_name(shape.signal)
    x_unit, y_unit = axis_unit(unit or "1"), axis_unit(shape.unit)
    x, y = x_unit.factor * np.array(shape.at), y_unit.factor * np.array(shape.value)
    band = y_unit.factor * np.array(shape.band)
    lines = [
        Line("missing term", x, y, "extended"),
        Line("95 %", x, y + band, "floor", "dot"),
        Line("", x, y - band, "floor", "dot"),
    ]
    across, up = f"{words(name)} [{x_unit.label}]", f"{words(shape.equation)} [{y_unit.label}]"
    return of_figure(Figure("missing", "What is missing", across, up, lines))
