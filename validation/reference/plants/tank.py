"""The tank of the flow test (section 5.2): charged above the valve's centre, vented below it.

States: pressure, temperature, spool and its rate in V. The tables' flow without mass_flow_gain.
"""

from __future__ import annotations

from math import pi

import numpy as np
from sms import Params

from validation.reference.compiled import compiled
from validation.reference.plants.actuator import CHAMBER_LAWS, VALVE_LAWS, Laws, border, gas_rates
from validation.reference.plants.flow import (
    Array,
    edge_flow,
    open_edges,
    opening_of,
    orifice_area,
    valve_map,
)
from validation.reference.plants.numbers import Numbers, numbers_of
from validation.reference.plants.trajectory import TOLERANCE, Method, follow

SCALE = np.array([1e5, 300.0, 1.0, 100.0])
"""Magnitudes of the states."""


@compiled
def tank_rate(
    p: Numbers, laws: Laws, map_: Array, y: Array, command: float, supply: float, dy: Array
) -> None:
    """dy/dt under a command in V and a supply in Pa absolute."""
    energy = laws.chamber == 1
    ratio_in = p.heat_capacity_ratio if energy else p.inflow_heat_ratio
    ratio_out = p.heat_capacity_ratio if energy else p.outflow_heat_ratio
    opening = opening_of(p, map_[0, 0], y[2])
    feed, vent = open_edges(p, map_, ratio_in, ratio_out, opening)
    charging = opening >= 0.0
    edge = feed if charging else vent
    outside = supply if charging else p.ambient_pressure
    area = orifice_area(p, opening)
    flow = edge_flow(p, laws.valve, edge, area, outside, p.air_temperature, y[0], y[1])
    total = border(flow, y[1], p.air_temperature, (0.0, 0.0, 0.0))
    dy[0], dy[1] = gas_rates(p, laws, y[0], y[1], p.tank_volume, 0.0, p.tank_wall_area, total)
    omega = 2.0 * pi * p.valve_frequency
    dy[2] = y[3]
    dy[3] = omega**2 * (min(10.0, max(0.0, command)) - y[2])
    dy[3] -= 2.0 * p.valve_damping_ratio * omega * y[3]


def simulate(
    params: Params,
    start: Array,
    commands: Array,
    *,
    valve_law: str = "iso_0_4_mpa",
    chamber_law: str = "polytropic",
    method: Method = "LSODA",
    tolerance: float = TOLERANCE,
) -> Array:
    """States at the beginning of every control period, (n, 4), under commands in V, (n,)."""
    numbers = numbers_of(params)
    laws = Laws(VALVE_LAWS[valve_law], 0, CHAMBER_LAWS[chamber_law])
    map_ = valve_map(valve_law if valve_law != "classic" else "iso_0_4_mpa")

    def rate(y: Array, command: Array) -> Array:
        dy = np.empty_like(y)
        tank_rate(numbers, laws, map_, y, float(command[0]), numbers.supply_pressure, dy)
        return dy

    return follow(
        rate,
        start,
        commands[:, None],
        float(params["control_period"]),
        SCALE,
        method=method,
        tolerance=tolerance,
    )
