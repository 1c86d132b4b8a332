"""Air through the valve into and out of two chambers.

Each of the valve's two open edges is a component after ISO 6358 whose conductance C, critical
ratio b and index m were measured over the distance of the command from the valve's centre
(dissertation, Table 5.2). They are read here from a fine even grid, between whose points they run
straight; the grid itself is Steffen's curve through the printed rows, or straight between them, and
straight to zero below the first: the source does not say which. The two differ most between the
first rows (`python -m validation.published.valve_tables`).
"""

from __future__ import annotations

from functools import cache
from math import exp, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from validation.reference import iso6358
from validation.reference.compiled import compiled
from validation.reference.steffen import steffen_slopes
from validation.twins.machine import Machine

Array = NDArray[np.float64]

GRID_STEP = 0.01
"""V, between two points of the valve's map."""
GRID_POINTS = 501
LAMINAR_FROM = 0.9985
"""Pressure ratio from which the flow falls straight to zero."""
ATMOSPHERE = (iso6358.DENSITY, iso6358.TEMPERATURE)
FIRST_ROW = 0.559
"""V from the centre: the first printed row."""

# Table 5.2: distance from the centre in V; charge C, b, m; discharge C, m (its b is zero), C in 1e-9.
_TABLE_5_2 = """
0.559 0.413153 0.0     1.32069  2.03974 27.96589
0.680 0.954101 0.35113 1.02828  2.24115  7.60944
0.744  1.88927 0.36722 0.81108  2.67314  2.05796
0.807  2.98278 0.38654 0.77586  3.96533  1.10725
0.871  4.20924 0.40237 0.79244  5.83896  1.08272
0.930  5.28155 0.42538 0.83104  7.67732  1.06297
0.990  6.47385 0.40221 0.82732  9.70005  1.07223
1.050  7.48757 0.41039 0.86335 11.55340  1.05287
1.170  9.63519 0.31360 0.82973 15.36400  1.06469
1.288 11.55800 0.27569 0.84249 19.08520  1.07256
1.412 13.81120 0.15562 0.81303 22.58720  1.06766
1.534 15.68440 0.11088 0.84158 25.94360  1.07022
1.658 17.54550 0.03272 0.85195 28.94510  1.07641
1.778 17.93040 0.16173 0.90173 31.45880  1.07556
1.901 18.59310 0.24108 0.99567 33.92720  1.08979
2.025 19.59160 0.21249 0.99482 35.76370  1.09729
2.058 20.90620 0.12419 0.98719 36.80200  1.11032
2.217 21.93110 0.00005 0.95476 38.30880  1.10722
2.355 22.03360 0.18729 1.02833 40.01820  1.10756
2.502 22.39700 0.20567 1.06520 41.47150  1.10078
2.771 24.70770 0.09437 1.02648 43.46310  1.09848
3.045 26.56400 0.0     1.01078 45.24800  1.13117
3.332 26.79360 0.0     1.02177 46.30100  1.14242
3.618 27.38340 0.0     1.05087 46.98280  1.12868
3.917 27.57360 0.0     1.06044 47.56560  1.11906
4.225 27.72850 0.0     1.05521 48.41320  1.12569
4.552 28.38590 0.0     1.04816 48.43560  1.11487
4.871 27.77260 0.05336 1.04804 48.93180  1.11471
"""


@cache
def valve_map(straight: bool = False) -> Array:
    """Columns charge C, b, m and discharge C, m over |command - centre| in GRID_STEP, (501, 5); Steffen's curve
    through the rows, or straight between them."""
    rows = np.array([line.split() for line in _TABLE_5_2.split("\n") if line], dtype=np.float64)
    rows[:, [1, 4]] *= 1e-9
    opening, values = rows[:, 0], rows[:, 1:]
    slopes = np.column_stack([steffen_slopes(opening, column) for column in values.T])
    slopes[0] = values[0] / opening[0] * [1.0, 0.0, 0.0, 1.0, 0.0]
    grid = GRID_STEP * np.arange(GRID_POINTS)
    inside = np.clip(grid, opening[0], opening[-1])
    columns = np.column_stack([np.interp(inside, opening, column) for column in values.T])
    if not straight:
        columns = CubicHermiteSpline(opening, values, slopes)(inside)
    columns[:, [0, 3]] *= np.minimum(1.0, grid / FIRST_ROW)[:, None]
    return np.ascontiguousarray(columns)


@compiled
def mass_flow(p: Machine, c: float, b: float, m: float, from_: float, t: float, to: float) -> float:
    """kg/s through one component from the pressure `from_` (at t kelvin) to a lower one `to`."""
    return iso6358.mass_flow((c, b, m), from_, t, to, ATMOSPHERE, LAMINAR_FROM)


@compiled
def near_one(ratio: float) -> tuple[float, float]:
    """The ratio of pressures to take a leak's law at, and the share of that flow: straight within 0.1 percent."""
    return (0.999, (1.0 - ratio) / 0.001) if ratio > 0.999 else (ratio, 1.0)


@compiled
def leak(p: Machine, c: float, p1: float, t1: float, p2: float, t2: float) -> float:
    """kg/s through the valve's gap from 1 to 2: sqrt(p1^2 - p2^2), straight within 0.1 percent, or by the law of all
    leaks."""
    high, low, t = (p1, p2, t1) if p1 >= p2 else (p2, p1, t2)
    choked = iso6358.choked_flow(c, high, t, ATMOSPHERE[0], ATMOSPHERE[1])
    edge, of_edge = near_one(low / high)
    share = sqrt(1.0 - edge * edge) if p.leak_exponent == 0.0 else of_choked(p, edge)
    size = choked * share * of_edge
    return size if p1 >= p2 else -size


@compiled
def of_choked(p: Machine, ratio: float) -> float:
    """A leak's flow over its choked flow: (1 - ((r - b)/(1 - b))^2)^n, as ISO 6358-1:2013."""
    b = p.leak_critical_ratio
    return 1.0 if ratio <= b else (1.0 - ((ratio - b) / (1.0 - b)) ** 2) ** p.leak_exponent


@compiled
def seep(p: Machine, conductance: float, p1: float, p2: float) -> float:
    """kg/s past a seal or out of a fitting from 1 to 2: in proportion to the pressure difference, or by the law of all
    leaks, which gives the same where one pressure is half of the other."""
    if conductance == 0.0 or p.leak_exponent == 0.0:
        return conductance * (p1 - p2)
    high, low = (p1, p2) if p1 >= p2 else (p2, p1)
    edge, of_edge = near_one(low / high)
    size = 0.5 * conductance * high * of_choked(p, edge) / of_choked(p, 0.5) * of_edge
    return size if p1 >= p2 else -size


@compiled
def tube_volume(p: Machine) -> float:
    """m3"""
    return 0.25 * pi * p.tube_diameter**2 * p.tube_length


@compiled
def tube_pass(p: Machine, flow: float, pressure: float) -> float:
    """Share of a mass flow that a tube lets through (Richer and Hurmuzlu, 2000).

    It is smooth and straight, without fittings and bends: to the core a tube_loss_factor of 1. What leaks past the
    spool loses nothing by it.
    """
    if p.tube_length == 0.0:
        return 1.0
    viscosity = 1.82e-5
    sound = sqrt(p.kappa * p.gas_constant * p.air_temperature)
    reynolds = 4.0 * abs(flow) / (pi * p.tube_diameter * viscosity)
    resistance = 32.0 * viscosity / p.tube_diameter**2
    if reynolds > 1190.0:
        resistance *= (reynolds / 1190.0) ** 0.75
    return exp(
        -resistance * p.gas_constant * p.air_temperature * p.tube_length / (2.0 * pressure * sound)
    )


@compiled
def opening(p: Machine, spool: float) -> float:
    """V from the centre as the map counts it; a wider dead band stretches its inner part."""
    distance = spool - p.valve_centre
    edge = FIRST_ROW + p.dead_band_change
    if abs(distance) < edge:
        return distance * FIRST_ROW / edge
    return distance - p.dead_band_change if distance > 0.0 else distance + p.dead_band_change


@compiled
def exhaust_share(p: Machine, time: float) -> float:
    """Conductance towards the exhaust over what it should be."""
    share = 1.0 + p.exhaust_flow_change
    if p.clogging_silencer != 0.0:
        beat = sin(2.0 * pi * time / p.clog_period) + sin(5.13 * time / p.clog_period + 1.0)
        if beat > 0.4:
            share *= 1.0 - p.clogging_silencer
    return share


@compiled
def supply_now(p: Machine, time: float) -> float:
    """Pressure at the head of the supply line, Pa."""
    if p.pulsating_supply == 0.0:
        return p.supply_pressure
    return p.supply_pressure + p.pulsating_supply * sin(2.0 * pi * p.pulsation_frequency * time)


@compiled
def edges(
    p: Machine, time: float, map_: Array, seat: float
) -> tuple[float, float, float, float, float, float]:
    """Opening, V; charge C, b, m; vent C, m, with the spool's seat at `seat` V.

    map_: (2, GRID_POINTS, 5), above and below the centre.
    """
    wide = opening(p, seat)
    side = 1 if wide < 0.0 else 0
    place = min(abs(wide), GRID_STEP * (GRID_POINTS - 1.001)) / GRID_STEP
    row = int(place)
    part = place - row
    charge = p.mass_flow_gain * (
        map_[side, row, 0] + part * (map_[side, row + 1, 0] - map_[side, row, 0])
    )
    charge_b = map_[side, row, 1] + part * (map_[side, row + 1, 1] - map_[side, row, 1])
    charge_m = map_[side, row, 2] + part * (map_[side, row + 1, 2] - map_[side, row, 2])
    vent = p.mass_flow_gain * (
        map_[side, row, 3] + part * (map_[side, row + 1, 3] - map_[side, row, 3])
    )
    vent_m = map_[side, row, 4] + part * (map_[side, row + 1, 4] - map_[side, row, 4])
    vent *= exhaust_share(p, time)
    if p.heat_transfer_coefficient > 0.0:
        vent /= p.kappa  # the map was measured on a tank that was taken for isothermal
    return wide, charge, charge_b, charge_m, vent, vent_m


@compiled
def through(
    p: Machine, c: float, b: float, m: float, p1: float, t1: float, p2: float, t2: float
) -> float:
    """kg/s from 1 to 2, either way, and through the tube behind the component."""
    if p1 >= p2:
        flow = mass_flow(p, c, b, m, p1, t1, p2)
        return flow * tube_pass(p, flow, p2)
    flow = mass_flow(p, c, b, m, p2, t2, p1)
    return -flow * tube_pass(p, flow, p2)


@compiled
def valve_inflow(
    p: Machine,
    edge: tuple[float, float, float, float, float, float],
    upper: bool,
    feed: float,
    pressure: float,
    t: float,
) -> tuple[float, float]:
    """kg/s into one chamber through the valve: from the supply, from the exhaust's side."""
    wide, charge, charge_b, charge_m, vent, vent_m = edge
    room, outside = p.air_temperature, p.ambient_pressure
    from_supply, from_exhaust = 0.0, 0.0
    if (wide < 0.0) == upper:
        from_supply = through(p, charge, charge_b, charge_m, feed, room, pressure, t)
    else:
        from_exhaust = through(p, vent, 0.0, vent_m, outside, room, pressure, t)
    if p.valve_leakage != 0.0:
        from_supply += leak(p, p.valve_leakage, feed, room, pressure, t)
        from_exhaust += leak(p, p.valve_leakage, outside, room, pressure, t)
    return from_supply, from_exhaust


@compiled
def leaks(p: Machine, upper: bool, pressure: float) -> float:
    """kg/s out of one chamber to the room, past the valve."""
    fitting = p.fitting_leakage_upper if upper else p.fitting_leakage_lower
    out = seep(p, fitting, pressure, p.ambient_pressure)
    if not upper and p.check_valve_leak != 0.0 and pressure > p.check_valve_pressure:
        out += p.check_valve_leak * (pressure - p.check_valve_pressure)
    return out


@compiled
def room_of(p: Machine, upper: bool, x: float, v: float) -> tuple[float, float, float]:
    """Volume, m3, its rate, and the wall around it, m2."""
    bore = 0.25 * pi * p.bore_diameter**2
    tube = tube_volume(p)
    if upper:
        area, left = bore - 0.25 * pi * p.rod_diameter**2, p.stroke - x
        wall = 2.0 * area + pi * (p.bore_diameter + p.rod_diameter) * left
        return p.dead_volume_upper + tube + area * left, -area * v, wall
    return p.dead_volume_lower + tube + bore * x, bore * v, 2.0 * bore + pi * p.bore_diameter * x


@compiled
def chamber_rate(
    p: Machine,
    pressure: float,
    t: float,
    room: tuple[float, float, float],
    inward: float,
    inward_heat: float,
    outward: float,
) -> tuple[float, float]:
    """dp/dt and dT/dt of one chamber from its mass flows; `inward_heat` in kg K/s."""
    volume, volume_rate, wall = room
    if p.heat_transfer_coefficient <= 0.0:
        rate = p.inflow_heat_ratio * inward_heat - p.outflow_heat_ratio * outward * t
        rate = p.gas_constant * rate - p.compression_heat_ratio * pressure * volume_rate
        return rate / volume, 0.0
    heat = p.heat_transfer_coefficient * wall * (p.wall_temperature - t)
    rate = p.kappa * (p.gas_constant * (inward_heat - outward * t) - pressure * volume_rate)
    rate = (rate + (p.kappa - 1.0) * heat) / volume
    mass = pressure * volume / (p.gas_constant * t)
    change = rate / pressure + volume_rate / volume - (inward - outward) / mass
    return rate, t * change


@compiled
def chamber_rates(
    p: Machine,
    time: float,
    map_: Array,
    air: Array,
    seat: float,
    x: float,
    v: float,
    rates: Array,
) -> float:
    """d/dt of `air` = (p_lower, p_upper, T_lower, T_upper, reservoir pressure) into `rates`.

    Returns what the valve draws, kg/s.
    """
    warm = p.heat_transfer_coefficient > 0.0
    head = supply_now(p, time)
    feed = air[4] if p.supply_line_resistance > 0.0 else head
    edge = edges(p, time, map_, seat)
    drawn = 0.0
    for side in range(2):
        pressure = air[side]
        t = air[2 + side] if warm else p.air_temperature
        from_supply, from_exhaust = valve_inflow(p, edge, side == 1, feed, pressure, t)
        drawn += from_supply
        lost = leaks(p, side == 1, pressure)
        inward = max(from_supply, 0.0) + max(from_exhaust, 0.0) + max(-lost, 0.0)
        outward = max(-from_supply, 0.0) + max(-from_exhaust, 0.0) + max(lost, 0.0)
        heat = inward * p.air_temperature
        past = seep(p, p.piston_leakage, air[1 - side], pressure)
        if past > 0.0:
            inward += past
            heat += past * (air[3 - side] if warm else p.air_temperature)
        else:
            outward -= past
        rates[side], rates[2 + side] = chamber_rate(
            p, pressure, t, room_of(p, side == 1, x, v), inward, heat, outward
        )
    rates[4] = 0.0
    if p.supply_line_resistance > 0.0:
        stiffness = p.compression_heat_ratio * p.gas_constant * p.air_temperature
        filling = (head - air[4]) / p.supply_line_resistance
        rates[4] = stiffness / p.reservoir_volume * (filling - drawn)
    return drawn
