"""One actuator on the bench: its derivative, and its motion under a command held by periods."""

from __future__ import annotations

from math import sqrt

import numpy as np
from sms import Params

from validation.reference.compiled import compiled
from validation.reference.plants.actuator import (
    BEND,
    CHAMBER_LAWS,
    FRICTION_LAWS,
    P_LOWER,
    P_UPPER,
    VALVE_LAWS,
    Laws,
    air_rates,
    rod_drive,
)
from validation.reference.plants.flow import Array, valve_map
from validation.reference.plants.friction import acceleration, direct
from validation.reference.plants.numbers import Numbers, numbers_of
from validation.reference.plants.trajectory import TOLERANCE, Method, follow

COLUMNS = (
    "extension",
    "velocity",
    "chamber_pressure_lower",
    "chamber_temperature_lower",
    "chamber_pressure_upper",
    "chamber_temperature_upper",
    "spool_voltage",
    "spool_rate",
    "drive_voltage",
    "drive_rate",
    "seal_deflection",
    "supply_pressure",
)
"""States in order, as a run of the core names them."""
SCALE = np.array([0.4, 0.5, 1e5, 300.0, 1e5, 300.0, 1.0, 100.0, 1.0, 100.0, 1e-3, 1e5])
"""Magnitudes of the states."""


@compiled
def bench_rate(
    p: Numbers, laws: Laws, map_: Array, y: Array, command: float, load: float, dy: Array
) -> None:
    """dy/dt under a command in V and a load in N against extension."""
    x, v, air = y[0], y[1], y[2:]
    air_rates(p, laws, map_, air, x, v, command, dy[2:])
    drive = rod_drive(p, air, x, v) - load
    dy[0] = v
    dy[2 + BEND] = 0.0
    if laws.friction <= 1:
        dy[1] = acceleration(
            p, laws.friction, x, v, air[P_LOWER], air[P_UPPER], p.moving_mass, drive
        )
    else:
        force, bend = direct(p, laws.friction, x, v, air[BEND], air[P_LOWER], air[P_UPPER])
        dy[1] = (drive - force) / p.moving_mass
        dy[2 + BEND] = bend


def simulate(
    params: Params,
    start: Array,
    commands: Array,
    *,
    load: float = 0.0,
    valve_law: str = "iso_0_4_mpa",
    friction_law: str = "acceleration_dependent",
    chamber_law: str = "polytropic",
    method: Method = "LSODA",
    tolerance: float = TOLERANCE,
) -> Array:
    """States at the beginning of every control period, (n, 12), under commands in V, (n,)."""
    numbers = numbers_of(params)
    laws = Laws(VALVE_LAWS[valve_law], FRICTION_LAWS[friction_law], CHAMBER_LAWS[chamber_law])
    map_ = valve_map(valve_law if valve_law != "classic" else "iso_0_4_mpa")

    def rate(y: Array, command: Array) -> Array:
        dy = np.empty_like(y)
        bench_rate(numbers, laws, map_, y, float(command[0]), load, dy)
        return dy

    period = float(params["control_period"])
    sound = sqrt(numbers.heat_capacity_ratio * numbers.gas_constant * numbers.air_temperature)
    return follow(
        rate,
        start,
        commands[:, None],
        period,
        SCALE,
        delay=float(params["command_delay"]) + numbers.tube_length / sound,
        before=np.array([numbers.valve_centre]),
        method=method,
        tolerance=tolerance,
    )
