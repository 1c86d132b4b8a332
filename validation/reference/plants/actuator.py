"""Valve, two chambers and the ends of one actuator: rates of its ten states, force on its rod.

States, in this order: lower pressure and temperature, upper pressure and temperature, spool and
its rate (in volts), drive filter and its rate (left alone here), deflection of the seals, pressure
of the reservoir. Dissertation, sections 4.1.2 to 4.1.5; chamber.hpp, vessel.hpp, tube.hpp,
end_stop.hpp state the readings.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

from validation.reference.compiled import compiled
from validation.reference.plants.flow import (
    Array,
    edge_flow,
    open_edges,
    opening_of,
    orifice_area,
    tube_share,
)
from validation.reference.plants.numbers import Numbers

STATES = 10
P_LOWER, T_LOWER, P_UPPER, T_UPPER, SPOOL, SPOOL_RATE, DRIVE, DRIVE_RATE, BEND, RESERVOIR = range(
    STATES
)
VALVE_LAWS = {"classic": 0, "iso_0_4_mpa": 1, "iso_0_2_mpa": 1}
FRICTION_LAWS = {
    name: i
    for i, name in enumerate(("acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre"))
}
CHAMBER_LAWS = {"polytropic": 0, "energy": 1}


class Laws(NamedTuple):
    """Which equation stands for what, by the numbers of the dictionaries above."""

    valve: int
    friction: int
    chamber: int


@compiled
def leak_flow(p: Numbers, p1: float, t1: float, p2: float, t2: float) -> float:
    """kg/s from 1 to 2 through the gap past a land."""
    gap = (p.valve_leakage, p.leakage_critical_ratio, p.leakage_index)
    return edge_flow(p, 1, gap, 0.0, p1, t1, p2, t2)


@compiled
def seal_flow(conductance: float, index: float, p1: float, p2: float) -> float:
    """kg/s from 1 to 2 past a seal: g p/2 (2 - 2 r)^n from the higher pressure p, proportional above r = 0.999."""
    high, low = max(p1, p2), min(p1, p2)
    drop = 2.0 * (1.0 - low / high)
    share = drop**index if drop > 2e-3 else drop * 2e-3 ** (index - 1.0)
    return float(0.5 * conductance * high * share * (1.0 if p1 > p2 else -1.0))


@compiled
def valve_flows(p: Numbers, laws: Laws, map_: Array, y: Array) -> tuple[float, float, float, float]:
    """kg/s: supply to lower, lower to exhaust, supply to upper, upper to exhaust."""
    energy = laws.chamber == 1
    ratio_in = p.heat_capacity_ratio if energy else p.inflow_heat_ratio
    ratio_out = p.heat_capacity_ratio if energy else p.outflow_heat_ratio
    ps, ta, pe = y[RESERVOIR], p.air_temperature, p.ambient_pressure
    pl, tl, pu, tu = y[P_LOWER], y[T_LOWER], y[P_UPPER], y[T_UPPER]
    sl, le, su, ue = 0.0, 0.0, 0.0, 0.0
    if p.valve_leakage != 0.0:
        sl, le = leak_flow(p, ps, ta, pl, tl), leak_flow(p, pl, tl, pe, ta)
        su, ue = leak_flow(p, ps, ta, pu, tu), leak_flow(p, pu, tu, pe, ta)
    opening = opening_of(p, map_[0, 0], y[SPOOL])
    feed, vent = open_edges(p, map_, ratio_in, ratio_out, opening)
    area = orifice_area(p, opening)
    gain = 1.0 if laws.valve == 0 else p.mass_flow_gain
    vent_gain = gain * (1.0 + p.exhaust_flow_change)
    if opening >= 0.0:
        sl += gain * edge_flow(p, laws.valve, feed, area, ps, ta, pl, tl)
        ue += vent_gain * edge_flow(p, laws.valve, vent, area, pu, tu, pe, ta)
    else:
        su += gain * edge_flow(p, laws.valve, feed, area, ps, ta, pu, tu)
        le += vent_gain * edge_flow(p, laws.valve, vent, area, pl, tl, pe, ta)
    through_lower = tube_share(p, sl - le, pl)
    through_upper = tube_share(p, su - ue, pu)
    return sl * through_lower, le * through_lower, su * through_upper, ue * through_upper


@compiled
def border(
    inward: float, t_inside: float, t_outside: float, total: tuple[float, float, float]
) -> tuple[float, float, float]:
    """Adds one flow over a chamber's border to (mass in, mass in times its kelvin, mass out)."""
    mass_in, heat_in, mass_out = total
    if inward > 0.0:
        return mass_in + inward, heat_in + inward * t_outside, mass_out
    return mass_in, heat_in, mass_out - inward


@compiled
def gas_rates(
    p: Numbers,
    laws: Laws,
    pressure: float,
    t: float,
    volume: float,
    volume_rate: float,
    wall: float,
    total: tuple[float, float, float],
) -> tuple[float, float]:
    """Pa/s and K/s, eq. 4.30 or the full energy equation."""
    mass_in, heat_in, mass_out = total
    if laws.chamber == 0:
        flowing = p.inflow_heat_ratio * heat_in - p.outflow_heat_ratio * mass_out * t
        work = p.compression_heat_ratio * pressure * volume_rate
        return (p.gas_constant * flowing - work) / volume, 0.0
    # d(m c_v T) = c_p T_in m_in' - c_p T m_out' - p V' + Q',  d(m) = m_in' - m_out'
    cv = p.gas_constant / (p.heat_capacity_ratio - 1.0)
    cp = p.heat_capacity_ratio * cv
    mass = pressure * volume / (p.gas_constant * t)
    heat = p.heat_transfer_coefficient * wall * (p.wall_temperature - t)
    energy_rate = cp * heat_in - cp * t * mass_out - pressure * volume_rate + heat
    mass_rate = mass_in - mass_out
    t_rate = (energy_rate - cv * t * mass_rate) / (cv * mass)
    p_rate = pressure * (mass_rate / mass + t_rate / t - volume_rate / volume)
    return p_rate, t_rate


@compiled
def air_rates(
    p: Numbers, laws: Laws, map_: Array, y: Array, x: float, v: float, command: float, dy: Array
) -> None:
    """Rates of all states but the seals' into dy."""
    ta, pe = p.air_temperature, p.ambient_pressure
    pl, tl, pu, tu = y[P_LOWER], y[T_LOWER], y[P_UPPER], y[T_UPPER]
    sl, le, su, ue = valve_flows(p, laws, map_, y)
    past = seal_flow(p.piston_leakage, p.piston_leakage_index, pl, pu)
    lower, upper = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    lower = border(sl, tl, ta, lower)
    lower = border(-le, tl, ta, lower)
    lower = border(-past, tl, tu, lower)
    leak = seal_flow(p.chamber_leakage_lower, p.chamber_leakage_index_lower, pe, pl)
    lower = border(leak, tl, ta, lower)
    upper = border(su, tu, ta, upper)
    upper = border(-ue, tu, ta, upper)
    upper = border(past, tu, tl, upper)
    leak = seal_flow(p.chamber_leakage_upper, p.chamber_leakage_index_upper, pe, pu)
    upper = border(leak, tu, ta, upper)

    bore, rod = 0.25 * pi * p.bore_diameter**2, 0.25 * pi * p.rod_diameter**2
    tube, left = 0.25 * pi * p.tube_diameter**2 * p.tube_length, p.stroke - x
    dy[P_LOWER], dy[T_LOWER] = gas_rates(
        p, laws, pl, tl,
        p.dead_volume_lower + tube + bore * x, bore * v,
        2.0 * bore + pi * p.bore_diameter * x, lower,
    )  # fmt: skip
    ring = bore - rod
    dy[P_UPPER], dy[T_UPPER] = gas_rates(
        p, laws, pu, tu,
        p.dead_volume_upper + tube + ring * left, -ring * v,
        2.0 * ring + pi * (p.bore_diameter + p.rod_diameter) * left, upper,
    )  # fmt: skip

    omega = 2.0 * pi * p.valve_frequency
    wanted = min(10.0, max(0.0, command))
    dy[SPOOL] = y[SPOOL_RATE]
    dy[SPOOL_RATE] = omega**2 * (wanted - y[SPOOL])
    dy[SPOOL_RATE] -= 2.0 * p.valve_damping_ratio * omega * y[SPOOL_RATE]
    dy[DRIVE], dy[DRIVE_RATE] = 0.0, 0.0
    dy[RESERVOIR] = 0.0
    if p.supply_line_resistance > 0.0:
        drop, r, k = (
            p.supply_pressure - y[RESERVOIR],
            p.supply_line_resistance,
            p.supply_line_turbulence,
        )
        fed = drop / r
        if k > 0.0:  # the root of k m^2 + r m = |drop| by the other formula
            fed = (sqrt(r**2 + 4.0 * k * abs(drop)) - r) / (2.0 * k) * (1.0 if drop > 0.0 else -1.0)
        spring = p.compression_heat_ratio * p.gas_constant * ta / p.reservoir_volume
        dy[RESERVOIR] = spring * (fed - sl - su)


@compiled
def contact(p: Numbers, depth: float, rate: float) -> float:
    """N away from an end, Hunt and Crossley."""
    if depth <= 0.0:
        return 0.0
    return p.end_stop_stiffness * depth * max(0.0, 1.0 + p.end_stop_damping * rate)


@compiled
def cushion(p: Numbers, distance: float, approach: float) -> float:
    """N away from an end, on the way there."""
    if approach <= 0.0 or distance >= p.cushion_length:
        return 0.0
    return p.cushion_damping * min(1.0, 1.0 - distance / p.cushion_length) * approach


@compiled
def rod_drive(p: Numbers, y: Array, x: float, v: float) -> float:
    """N outwards: gas on both faces, ambient on the rod, ends of the stroke."""
    bore, rod = 0.25 * pi * p.bore_diameter**2, 0.25 * pi * p.rod_diameter**2
    gas = y[P_LOWER] * bore - y[P_UPPER] * (bore - rod) - p.ambient_pressure * rod
    ends = contact(p, -x, -v) + cushion(p, x, -v)
    ends -= contact(p, x - p.stroke, v) + cushion(p, p.stroke - x, v)
    return float(gas + ends)
