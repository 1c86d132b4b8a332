"""The valve's map: C, b and m over the spool, from the fits of single records.

Between the positions run the piecewise cubics of scipy's PCHIP, which never leave the values on
either side. Where C must not fall while the valve opens, its values are first made monotone by
weighted isotonic regression. b and m come from positions where the record tells them; elsewhere
they are read off their neighbours, and the map says so.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import isotonic_regression

from sms.arrays import Array
from sms.identification.flow import FlowFit
from sms.identification.flow_problem import COMPONENT
from sms.identification.flow_record import FlowRecord
from sms.identification.flow_rig import supplies


@dataclass(frozen=True)
class MapCurve:
    """One direction at one supply. Arrays (positions,) over `spool`, rising."""

    direction: str
    supply_pressure: float  #: Pa
    spool: Array  #: m
    conductance: Array  #: m^3/(s Pa), monotone where that was asked for
    uncertainty: Array  #: standard, of the measured conductance, all contributions
    ratio: Array
    ratio_known: Array  #: whether the position's own record tells b
    index: Array
    index_known: Array

    def at(self, spool: float) -> tuple[float, float, float]:
        """(C, b, m) at a spool position (m); beyond the measured ones those of the nearest."""
        x = float(np.clip(spool, self.spool[0], self.spool[-1]))
        return tuple(  # type: ignore[return-value]
            float(_curve(self.spool, values)(x))
            for values in (self.conductance, self.ratio, self.index)
        )


def _curve(x: Array, y: Array) -> PchipInterpolator:
    if x.size == 1:
        x, y = np.array([x[0], x[0] + 1.0]), np.repeat(y, 2)
    return PchipInterpolator(x, y)


def valve_map(fits: Sequence[FlowFit], monotone: bool = True) -> tuple[MapCurve, ...]:
    """A curve for each direction and supply whose records say their spool position."""
    placed = [f for f in fits if f.found is not None and f.record.spool is not None]
    levels = supplies([f.record for f in placed])
    curves = []
    for level in levels:
        for direction in ("charge", "discharge"):
            group = [
                f for f in placed if f.direction == direction and _same_supply(f.record, level)
            ]
            if group:
                curves.append(_map_curve(group, direction, level, monotone))
    return tuple(curves)


def _same_supply(record: FlowRecord, level: float) -> bool:
    return level <= record.supply_pressure <= 1.05 * level


def _map_curve(group: list[FlowFit], direction: str, level: float, monotone: bool) -> MapCurve:
    """Repeats of a position are averaged by their weights; their scatter counts as error too."""
    positions = sorted({float(f.record.spool or 0.0) for f in group})
    conductance, uncertainty = [], []
    b, m = [], []
    for position in positions:
        runs = [f for f in group if f.record.spool == position]
        c, u = _pooled([(f.known[COMPONENT[0]].value, f.combined) for f in runs])
        conductance.append(c)
        uncertainty.append(u)
        b.append(_told(runs, COMPONENT[1]))
        m.append(_told(runs, COMPONENT[2]))
    c_all, u_all = np.array(conductance), np.array(uncertainty)
    if monotone and len(positions) > 1:
        weights = 1.0 / np.where(np.isfinite(u_all) & (u_all > 0.0), u_all, np.nanmax(u_all)) ** 2
        c_all = np.asarray(isotonic_regression(c_all, weights=weights).x)
    spool = np.array(positions)
    ratio, ratio_known = _filled(spool, b, [f.known[COMPONENT[1]].value for f in group])
    index, index_known = _filled(spool, m, [f.known[COMPONENT[2]].value for f in group])
    return MapCurve(direction, level, spool, c_all, u_all, ratio, ratio_known, index, index_known)


def _pooled(values: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Weighted mean, and the larger of its own error and what the scatter says."""
    x, u = np.array(values).T
    weights = 1.0 / np.maximum(u, 1e-300) ** 2
    mean = float(np.sum(weights * x) / np.sum(weights))
    own = float(np.sqrt(1.0 / np.sum(weights)))
    if x.size == 1:
        return mean, float(u[0])
    scatter = float(np.std(x, ddof=1) / np.sqrt(x.size))
    return mean, max(own, scatter)


def _told(runs: Iterable[FlowFit], name: str) -> float:
    told = [f.known[name].value for f in runs if f.known[name].identifiable]
    return float(np.mean(told)) if told else np.nan


def _filled(spool: Array, told: list[float], fallback: list[float]) -> tuple[Array, Array]:
    """Values with the untold ones read off their neighbours, and which were told."""
    values = np.array(told)
    known = np.isfinite(values)
    if not known.any():
        return np.full(spool.size, float(np.median(fallback))), known
    return np.interp(spool, spool[known], values[known]), known


@dataclass(frozen=True)
class SupplyComparison:
    """C of one direction at two supplies: a component by ISO 6358 has one."""

    direction: str
    low: float  #: Pa
    high: float  #: Pa
    difference: float
    """Median of C(high) / C(low) - 1 over the common positions."""
    significant: int
    """Positions where the fits' own errors (3 sd) do not cover the difference."""
    positions: int


def compare_supplies(fits: Sequence[FlowFit]) -> tuple[SupplyComparison, ...]:
    """Whether C depends on the supply pressure; volume and temperature, common to both, are left out."""
    out = []
    levels = supplies([f.record for f in fits])
    for direction in ("charge", "discharge"):
        by = {
            level: {
                f.record.spool: f
                for f in fits
                if f.found is not None
                and f.direction == direction
                and f.record.spool is not None
                and _same_supply(f.record, level)
            }
            for level in levels
        }
        for low, high in pairwise(levels):
            common = sorted(p for p in by[low].keys() & by[high].keys() if p is not None)
            if not common:
                continue
            c = np.array(
                [[by[s][p].known[COMPONENT[0]].value for s in (low, high)] for p in common]
            )
            u = np.array([[by[s][p].known[COMPONENT[0]].sd for s in (low, high)] for p in common])
            far = np.abs(c[:, 1] - c[:, 0]) > 3.0 * np.hypot(u[:, 0], u[:, 1])
            out.append(
                SupplyComparison(
                    direction,
                    low,
                    high,
                    float(np.median(c[:, 1] / c[:, 0] - 1.0)),
                    int(far.sum()),
                    len(common),
                )
            )
    return tuple(out)
