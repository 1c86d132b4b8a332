"""Mass flow through the valve: the classic law, ISO 6358, and the measured table over the opening.

Dissertation, sections 4.1.2 and 5. The readings where it leaves a choice are those of
mass_flow.hpp, valve.hpp and valve_table.hpp as their opening comments state them: the index m
inside the root, straight from a pressure ratio of 0.999 (classic: 1 - 1e-5), Steffen's monotone
cubic through the table's rows.
"""

from __future__ import annotations

import re
from functools import cache
from math import pi, sqrt
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from validation.reference import iso6358
from validation.reference.compiled import compiled
from validation.reference.plants.numbers import Numbers
from validation.reference.steffen import steffen_slopes

Array = NDArray[np.float64]
TABLES = Path(__file__).parents[3] / "libsms/include/sms"
CHARGE_C, CHARGE_B, CHARGE_M, DISCHARGE_C, DISCHARGE_B, DISCHARGE_M = range(6)
CLASSIC, ISO = 0, 1


@cache
def valve_map(law: str) -> Array:
    """Pieces of "iso_0_4_mpa" or "iso_0_2_mpa": row i is opening, then 4 coefficients for each of
    6 columns, highest power first, (28, 25). The last piece is constant."""
    text = (TABLES / f"valve_table_{law.removeprefix('iso_')}.def").read_text()
    rows = np.array(
        [row.split(",") for row in re.findall(r"^SMS_VALVE_ROW\(([-0-9].*)\)", text, re.M)],
        dtype=np.float64,
    )
    opening = 0.5 * (rows[:, 5] - rows[:, 1])
    values = rows[:, [3, 2, 4, 7, 6, 8]]
    pieces = np.zeros((len(rows), 25))
    pieces[:, 0] = opening
    for column in range(6):
        y = values[:, column]
        slope = steffen_slopes(opening, y)
        if column in (CHARGE_C, DISCHARGE_C):
            slope[0] = y[0] / opening[0]
        spline = CubicHermiteSpline(opening, y, slope)
        pieces[:-1, 1 + 4 * column : 5 + 4 * column] = spline.c.T
        pieces[-1, 4 + 4 * column] = y[-1]
    return pieces


@compiled
def map_value(map_: Array, row: int, column: int, beyond: float) -> float:
    """One column of the map, `beyond` volts after the row."""
    k = 1 + 4 * column
    a, b, c, d = map_[row, k], map_[row, k + 1], map_[row, k + 2], map_[row, k + 3]
    return float(((a * beyond + b) * beyond + c) * beyond + d)


@compiled
def map_place(map_: Array, distance: float) -> tuple[int, float, float]:
    """Row, volts beyond it, and the factor of C below the first row."""
    if distance < map_[0, 0]:
        return 0, 0.0, distance / map_[0, 0]
    row = int(np.searchsorted(map_[:, 0], distance, side="right")) - 1
    return row, distance - map_[row, 0], 1.0


@compiled
def classic_flow(p: Numbers, area: float, p1: float, t1: float, p2: float) -> float:
    """kg/s from p1 at t1 to a lower p2, eq. 4.20 to 4.22."""
    if p1 <= 0.0:
        return 0.0
    k = p.heat_capacity_ratio
    scale = p.discharge_coefficient * area * p1 / sqrt(t1)
    ratio = p2 / p1
    if ratio <= (2.0 / (k + 1.0)) ** (k / (k - 1.0)):
        return scale * sqrt(k / p.gas_constant * (2.0 / (k + 1.0)) ** ((k + 1.0) / (k - 1.0)))
    last = 1.0 - 1e-5
    r = min(ratio, last)
    expanding: float = r ** (1.0 / k) * sqrt(1.0 - r ** ((k - 1.0) / k))
    flow = scale * sqrt(2.0 * k / (p.gas_constant * (k - 1.0))) * expanding
    return flow if ratio < last else flow * (1.0 - ratio) / (1.0 - last)


@compiled
def iso_flow(p: Numbers, c: float, b: float, m: float, p1: float, t1: float, p2: float) -> float:
    """kg/s from p1 at t1 to a lower p2, eq. 5.8 and 5.9."""
    atmosphere = (p.reference_density, p.reference_temperature)
    return iso6358.mass_flow((c, b, m), p1, t1, p2, atmosphere, 0.999)


@compiled
def edge_flow(
    p: Numbers,
    law: int,
    edge: tuple[float, float, float],
    area: float,
    p1: float,
    t1: float,
    p2: float,
    t2: float,
) -> float:
    """kg/s from 1 to 2, either way."""
    c, b, m = edge
    if p1 >= p2:
        if law == CLASSIC:
            return classic_flow(p, area, p1, t1, p2)
        return iso_flow(p, c, b, m, p1, t1, p2)
    if law == CLASSIC:
        return -classic_flow(p, area, p2, t2, p1)
    return -iso_flow(p, c, b, m, p2, t2, p1)


@compiled
def opening_of(p: Numbers, first: float, spool: float) -> float:
    """V from the centre; a changed dead band stretches the range below the first row."""
    distance = spool - p.valve_centre
    far = first + p.dead_band_change
    if abs(distance) < far:
        return distance * first / far
    return distance + p.dead_band_change if distance < 0.0 else distance - p.dead_band_change


@compiled
def orifice_area(p: Numbers, opening: float) -> float:
    """m2, eq. 4.1 and 4.4."""
    v = 5.0 + opening
    spool = abs(
        p.spool_cubic_3 * v**3 + p.spool_cubic_2 * v**2 + p.spool_cubic_1 * v + p.spool_cubic_0
    )
    overlap = 0.5 * (p.land_width - p.port_width)
    width = p.port_count * p.port_angle * p.barrel_diameter / 2.0
    return width * max(0.0, min(spool, p.spool_limit) - overlap)


@compiled
def open_edges(
    p: Numbers, map_: Array, ratio_in: float, ratio_out: float, opening: float
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """C, b, m of the port that is fed and of the one that is vented."""
    row, beyond, below = map_place(map_, abs(opening))
    feed = (
        below * 1.4 / ratio_in * map_value(map_, row, CHARGE_C, beyond),
        map_value(map_, row, CHARGE_B, beyond),
        map_value(map_, row, CHARGE_M, beyond),
    )
    vent = (
        below * 1.0 / ratio_out * map_value(map_, row, DISCHARGE_C, beyond),
        map_value(map_, row, DISCHARGE_B, beyond),
        map_value(map_, row, DISCHARGE_M, beyond),
    )
    return feed, vent


@compiled
def tube_share(p: Numbers, flow: float, pressure: float) -> float:
    """Share of a flow that the tube lets through (section 4.1.4), 1 without a tube."""
    if p.tube_length == 0.0:
        return 1.0
    sound = sqrt(p.heat_capacity_ratio * p.gas_constant * p.air_temperature)
    reynolds = 4.0 * abs(flow) / (pi * p.tube_diameter * p.air_viscosity)
    resistance = 32.0 * p.air_viscosity / p.tube_diameter**2
    if reynolds > 1190.0:
        resistance *= (reynolds / 1190.0) ** 0.75
    exponent = resistance * p.gas_constant * p.air_temperature * p.tube_length
    return float(np.exp(-p.tube_loss_factor * exponent / (2.0 * pressure * sound)))
