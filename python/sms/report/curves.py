"""The curves of the page as compact JSON: thinned, in display units, numbers as base64 floats.

The whole page stays below 4 MB however long the records are: a fixed budget of points is shared
among the series, and what is dropped is chosen so that extremes stay visible.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.diagnosis.result import Diagnosis, Series
from sms.io.units import split_column_name
from sms.units_display import DisplayUnit, axis_unit, words

LINE_POINTS = 30_000
"""Points of all lines over time together."""
SCATTER_POINTS = 60_000
"""Points of all residual panels together."""
MEAN_BINS = 24
_FEW = 5  # so many different values or fewer are drawn as columns, not as a continuous axis


def payload(diagnosis: Diagnosis) -> dict[str, Any]:
    """What figures.js draws: one entry a record (validate first), one a group of residuals."""
    usable = [s for s in diagnosis.series if s.time.size > 1]
    series = sorted(usable, key=lambda s: s.role != "validate")
    floors = {(g.record, g.signal): g.noise_floor for g in diagnosis.gain}
    line_limit = LINE_POINTS // max(len(series), 1)
    pools = _pools(series)
    panels = sum(len(_input_names(members)) for _, members in pools)
    scatter_limit = SCATTER_POINTS // max(panels, 1)
    return {
        "extended": bool(diagnosis.causes),
        "records": [
            _lines(s, floors.get((s.record, s.signal), math.nan), line_limit) for s in series
        ],
        "groups": [_group(label, members, min(scatter_limit, 1500)) for label, members in pools],
    }


def _pools(series: Sequence[Series]) -> list[tuple[str, list[Series]]]:
    """All records of a signal together, then each alone."""
    pools = []
    for signal in dict.fromkeys(s.signal for s in series):
        members = [s for s in series if s.signal == signal]
        if len(members) > 1:
            pools.append(("all records", members))
    return pools + [(s.record, [s]) for s in series]


def encode(values: Array) -> str:
    """Little-endian float32 as base64; NaN and infinities become NaN, a gap in the line."""
    finite = np.where(np.isfinite(values), values, np.nan)
    return base64.b64encode(finite.astype("<f4").tobytes()).decode("ascii")


# ---- over time ---------------------------------------------------------------------------------


def _lines(s: Series, floor: float, limit: int) -> dict[str, Any]:
    unit = axis_unit(s.unit)
    keep = thin((s.measured, s.measured - s.baseline), limit)
    breaks = _gaps(s.time)[keep]
    # A line is interrupted where time jumps: NaN in front of the first row after the jump.
    cuts = np.flatnonzero(np.diff(breaks)) + 1

    def column(values: Array, factor: float) -> str:
        return encode(np.insert(values[keep] * factor, cuts, np.nan))

    used = np.asarray(s.used, dtype=bool)
    views = [{"title": "time [s]", "x": column(s.time, 1.0)}]
    for name, values in s.inputs.items():
        label, si_unit = split_column_name(name)
        if label.startswith("extension"):
            axis = axis_unit(si_unit or "1")
            views.append({"title": _title(label, axis), "x": column(values, axis.factor)})
    return {
        "label": s.record,
        "of": words(s.signal),
        "role": s.role,
        "signal": _title(s.signal, unit),
        "unit": unit.label,
        "views": views,
        "measured": column(s.measured, unit.factor),
        "baseline": column(np.where(used, s.baseline, np.nan), unit.factor),
        "extended": column(np.where(used, s.extended, np.nan), unit.factor),
        "floor": unit.scale(floor) if math.isfinite(floor) else None,
    }


def thin(curves: Sequence[Array], limit: int) -> NDArray[np.intp]:
    """Rows to keep, at most `limit`, rising: smallest and largest of each curve in every bucket."""
    rows = curves[0].size
    if rows <= limit:
        return np.arange(rows, dtype=np.intp)
    buckets = max(limit // (2 * len(curves)), 1)
    edges = np.linspace(0, rows, buckets + 1).astype(np.intp)
    safe = [np.nan_to_num(curve) for curve in curves]
    keep = {
        start + int(pick)
        for start, stop in pairwise(edges)
        for curve in safe
        for pick in (np.argmin(curve[start:stop]), np.argmax(curve[start:stop]))
    }
    return np.array(sorted(keep), dtype=np.intp)


def _gaps(time: Array) -> NDArray[np.intp]:
    """For each row the number of time jumps before it; a jump is far beyond the usual step."""
    steps = np.diff(time)
    usual = float(np.median(steps[np.isfinite(steps)])) if np.isfinite(steps).any() else 0.0
    jumps = np.concatenate([[False], steps > 10.0 * usual]) if usual > 0.0 else np.zeros(time.size)
    return np.cumsum(jumps).astype(np.intp)


# ---- residual against the inputs ---------------------------------------------------------------


def _input_names(members: Sequence[Series]) -> list[str]:
    names = list(dict.fromkeys(name for s in members for name in s.inputs))
    return names if any(name.startswith("time") for name in names) else [*names, "time [s]"]


def _group(label: str, members: Sequence[Series], limit: int) -> dict[str, Any]:
    unit = axis_unit(members[0].unit)
    residuals = {
        "baseline": _pooled(members, lambda s: s.measured - s.baseline) * unit.factor,
        "extended": _pooled(members, lambda s: s.measured - s.extended) * unit.factor,
    }
    good = np.logical_and.reduce([np.isfinite(residual) for residual in residuals.values()])
    residuals = {kind: residual[good] for kind, residual in residuals.items()}
    rows = int(good.sum())
    shown = np.linspace(0, max(rows - 1, 0), min(limit, rows)).astype(np.intp)
    direction = _pooled(members, lambda s: _input(s, "direction"))[good]
    panels = []
    for name in _input_names(members):
        title, si_unit = split_column_name(name)
        axis = axis_unit(si_unit or "1")
        x = _pooled(members, partial(_input, name=name))[good] * axis.factor
        panels.append(_panel(_title(title, axis), x, direction, residuals, shown))
    signal = members[0].signal
    worst = np.abs(np.concatenate(list(residuals.values())))
    return {
        "label": label,
        "of": words(signal),
        "error": f"error [{unit.label}]",
        "limit": float(np.quantile(worst, 0.998)) * 1.1 if worst.size else 1.0,
        "dots": {kind: encode(residual[shown]) for kind, residual in residuals.items()},
        "panels": panels,
    }


def _input(s: Series, name: str) -> Array:
    if name in s.inputs:
        return s.inputs[name]
    return s.time if name.startswith("time") else np.full(s.time.size, np.nan)


def _pooled(members: Sequence[Series], curve: Callable[[Series], Array]) -> Array:
    """One curve of all members, compared rows only."""
    parts = [np.asarray(curve(s), dtype=np.float64)[np.asarray(s.used, bool)] for s in members]
    return np.concatenate(parts)


def _panel(
    title: str,
    x: Array,
    direction: Array,
    residuals: Mapping[str, Array],
    shown: NDArray[np.intp],
) -> dict[str, Any]:
    """One residual panel: where the dots `shown` lie, and means for each direction of motion apart.

    What friction does has opposite signs in the two directions and would cancel in one mean.
    """
    good = np.isfinite(x)
    values = np.unique(x[good])
    few = 0 < values.size <= _FEW
    spread = np.random.default_rng(0).uniform(-0.2, 0.2, shown.size) if few else 0.0
    panel: dict[str, Any] = {"title": title, "x": encode(x[shown] + spread), "few": few}
    x, sign = x[good], np.sign(direction[good])
    if few:
        panel["ticks"] = values.tolist()
        panel["names"] = [_tick(title, float(value)) for value in values]
    edges = _edges(x, values, few)
    sides = {"extending": sign > 0.0, "retracting": sign < 0.0}
    if title == "direction" or not any(rows.any() for rows in sides.values()):
        sides = {"": np.full(x.size, True)}
    for kind, residual in residuals.items():
        y = residual[good]
        means = []
        for side, rows in sides.items():
            centres, heights = _means(x[rows], y[rows], edges)
            means.append({"side": side, "x": encode(centres), "y": encode(heights)})
        panel[kind] = {"means": means}
    return panel


def _tick(title: str, value: float) -> str:
    if title == "direction":
        return {-1.0: "retracting", 0.0: "standing", 1.0: "extending"}.get(value, f"{value:g}")
    return f"{value:g}"


def _edges(x: Array, values: Array, few: bool) -> Array:
    if few:
        middles = 0.5 * (values[:-1] + values[1:])
        return np.concatenate([[-np.inf], middles, [np.inf]])
    if not x.size:
        return np.array([0.0, 1.0])
    low, high = float(np.quantile(x, 0.001)), float(np.quantile(x, 0.999))
    return np.linspace(low, high, MEAN_BINS + 1)


def _means(x: Array, y: Array, edges: Array) -> tuple[Array, Array]:
    """Mean of y over the mean of x in each bin that holds enough rows.

    Where rows lie in few bins, as pressures of several records do, those are joined by a line;
    elsewhere an empty bin is a gap in it (NaN).
    """
    last = edges.size - 2
    bins = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, last)
    count = np.bincount(bins, minlength=last + 1)
    enough = count >= max(3, 0.01 * x.size)
    per = np.maximum(count, 1)
    centres = np.bincount(bins, weights=x, minlength=last + 1) / per
    means = np.bincount(bins, weights=y, minlength=last + 1) / per
    if 2 * np.count_nonzero(enough) < enough.size:
        return centres[enough], means[enough]
    return np.where(enough, centres, np.nan), np.where(enough, means, np.nan)


def _title(name: str, unit: DisplayUnit) -> str:
    return f"{words(name)} [{unit.label}]" if unit.label else words(name)
