"""The platform on its three actuators: its derivative, and its motion under held commands.

The friction of a piston under eq. 6.2 and 6.5 depends on its own acceleration, and the three are
coupled by the mass matrix. The loop is closed the slow and sure way: one piston after the other by
itself with the others held, round and round until no acceleration moves. Each round lowers the
convex function whose gradient the balance is, so it comes to the one solution.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from sms import Params

from validation.reference.compiled import compiled
from validation.reference.multibody.mechanism import mechanism_of
from validation.reference.plants import actuator
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
from validation.reference.plants.mechanism import Mechanism, equations, mechanism_at_rest
from validation.reference.plants.numbers import Numbers, numbers_of
from validation.reference.plants.trajectory import TOLERANCE, Method, follow

STATES = 6 + 3 * actuator.STATES
_ACTUATOR = [1e5, 300.0, 1e5, 300.0, 1.0, 100.0, 1.0, 100.0, 1e-3, 1e5]
SCALE = np.array([0.1, 0.1, 0.3, 0.5, 0.5, 0.5, *_ACTUATOR, *_ACTUATOR, *_ACTUATOR])
"""Magnitudes of the states: roll, pitch, height, their rates, three actuators."""


@compiled
def coupled(
    p: Numbers,
    law: int,
    x: Array,
    v: Array,
    lower: Array,
    upper: Array,
    mass: Array,
    drive: Array,
    a: Array,
) -> None:
    """m/s2 of the three pistons: mass a + F_f(v, a) = drive."""
    for _ in range(400):
        moved = 0.0
        for i in range(3):
            others = 0.0
            for k in range(3):
                if k != i:
                    others += mass[i, k] * a[k]
            new = acceleration(
                p, law, x[i], v[i], lower[i], upper[i], mass[i, i], drive[i] - others
            )
            moved = max(moved, abs(new - a[i]))
            a[i] = new
        if moved <= 1e-13 * (abs(a[0]) + abs(a[1]) + abs(a[2])):
            break


@compiled
def platform_rate(
    p: Numbers,
    laws: Laws,
    map_: Array,
    m: Mechanism,
    y: Array,
    commands: Array,
    pose: Array,
    dy: Array,
) -> None:
    """dy/dt under three commands in V; `pose` (yaw, x, y) is where its search begins."""
    matrix, slope = np.zeros((3, 3)), np.zeros((3, 3))
    bias, x, x_bias = np.zeros(3), np.zeros(3), np.zeros(3)
    equations(m, y[0:3], y[3:6], pose, matrix, bias, slope, x, x_bias)
    v = slope @ y[3:6]
    force, lower, upper = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(3):
        air, rates = y[6 + 10 * i : 16 + 10 * i], dy[6 + 10 * i : 16 + 10 * i]
        air_rates(p, laws, map_, air, x[i], v[i], commands[i], rates)
        force[i] = rod_drive(p, air, x[i], v[i])
        lower[i], upper[i] = air[P_LOWER], air[P_UPPER]
        rates[BEND] = 0.0
        if laws.friction > 1:
            rubbing, bend = direct(p, laws.friction, x[i], v[i], air[BEND], lower[i], upper[i])
            force[i] -= rubbing
            rates[BEND] = bend
    dy[0:3] = y[3:6]
    if laws.friction > 1:
        dy[3:6] = np.linalg.solve(matrix, slope.T @ force - bias)
        return
    # Along the pistons: a = slope q'' + x_bias.
    back = np.linalg.inv(slope)
    mass = back.T @ matrix @ back
    drive = force - back.T @ bias + mass @ x_bias
    a = np.zeros(3)
    coupled(p, laws.friction, x, v, lower, upper, mass, drive, a)
    dy[3:6] = back @ (a - x_bias)


def mechanism_from(params: Params) -> Mechanism:
    """The mechanism in the reading `corrected` of the mass table."""
    bodies = mechanism_of(params)["bodies"]
    base, joint = (
        np.array([_point(params, f"{kind}_joint_{i}") for i in range(1, 7)])
        for kind in ("base", "platform")
    )
    reference = _point(params, "reference_point")
    return mechanism_at_rest(bodies, base, joint, reference, float(params["gravity"]))


def _point(params: Params, name: str) -> Array:
    return np.array([float(getattr(params, f"{name}_{axis}")) for axis in "xyz"])


def simulate(
    params: Params,
    start: Array,
    commands: Array,
    *,
    valve_law: str = "iso_0_4_mpa",
    friction_law: str = "acceleration_dependent",
    chamber_law: str = "polytropic",
    method: Method = "LSODA",
    tolerance: float = TOLERANCE,
) -> Array:
    """States at the beginning of every control period, (n, 36), under commands in V, (n, 3)."""
    numbers = numbers_of(params)
    mechanism = mechanism_from(params)
    laws = Laws(VALVE_LAWS[valve_law], FRICTION_LAWS[friction_law], CHAMBER_LAWS[chamber_law])
    map_ = valve_map(valve_law if valve_law != "classic" else "iso_0_4_mpa")
    pose = np.array([0.04, 0.0, 0.0])

    def rate(y: Array, command: Array) -> Array:
        dy = np.empty_like(y)
        platform_rate(numbers, laws, map_, mechanism, y, command, pose, dy)
        return dy

    sound = sqrt(numbers.heat_capacity_ratio * numbers.gas_constant * numbers.air_temperature)
    return follow(
        rate,
        start,
        commands,
        float(params["control_period"]),
        SCALE,
        delay=float(params["command_delay"]) + numbers.tube_length / sound,
        before=np.full(3, numbers.valve_centre),
        method=method,
        tolerance=tolerance,
    )
