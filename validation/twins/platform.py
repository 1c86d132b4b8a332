"""The platform on three axes: the motion of one run.

The mechanism's equations are those of validation/reference/plants/mechanism.py, by the velocities of its ten
bodies; air and seals are the bench's. Fourth-order Runge-Kutta; the command runs straight from one
record sample to the next.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, lru_cache
from math import pi
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from validation.reference.compiled import compiled
from validation.reference.multibody.mechanism import mechanism_of
from validation.reference.plants.mechanism import (
    Mechanism,
    equations,
    joint_arm,
    mechanism_at_rest,
    pose_rates,
)
from validation.reference.plants.vectors import add, attitude, cross, dot, mix, times
from validation.twins.air import Array, chamber_rates
from validation.twins.clock import Clock
from validation.twins.controller import answered
from validation.twins.machine import Body, Machine
from validation.twins.maps import Maps, exact, of_axes
from validation.twins.published import MECHANISM
from validation.twins.seal import end_force, friction, odd_force, pressure_force

SAMPLE_STEP = 5.0e-3
STEPS = 10
FINE = 5
STRAIGHT = Clock(SAMPLE_STEP, STEPS, FINE, held=False)
AXIS = 9
"""States of an axis: p_lower, p_upper, T_lower, T_upper, reservoir | spool, rate | bristle, film."""
STATES = 6 + 3 * AXIS
"""roll, pitch, height, their rates, three axes."""
READINGS = 9
"""Extensions, their rates, forces of the axes on the platform."""


@lru_cache(maxsize=64)
def mechanism(body: Body) -> Mechanism:
    """The mechanism with this payload, as it is built."""
    numbers = dict(MECHANISM)
    for name in ("payload_mass", "payload_cog_x", "payload_cog_y", "payload_cog_z"):
        numbers[name] = getattr(body, name)
    for name in ("base_joint_2_y", "platform_joint_1_x", "base_joint_5_z"):
        numbers[name] += getattr(body, f"{name}_error")
    bodies = mechanism_of(cast(Any, SimpleNamespace(**numbers)))["bodies"]

    def point(name: str) -> list[float]:
        return [numbers[f"{name}_{axis}"] for axis in "xyz"]

    base, joint = (
        np.array([point(f"{kind}_joint_{i}") for i in range(1, 7)]) for kind in ("base", "platform")
    )
    reference = np.array(point("reference_point"))
    built = mechanism_at_rest(bodies, base, joint, reference, numbers["gravity"])
    longer = np.zeros(len(built.length))
    longer[2], longer[4] = body.actuator_3_length_error, body.panhard_2_length_error
    return built._replace(length=built.length + longer)


@dataclass(frozen=True)
class Plan:
    """What one run is to do; (n, 3), one row a sample."""

    feedforward: Array  # V around the centre
    setpoint: Array  # m
    pose: Array  # roll, pitch, height, where it starts
    gains: Array = field(default_factory=lambda: np.empty(0))
    """Of controllers that follow the set-points instead; see bench.Plan."""


@dataclass(frozen=True)
class Motion:
    """States (n, STATES) and readings (n, READINGS) at FINE points a sample, commands a sample."""

    state: Array
    reading: Array
    command: Array


@cache
def exact_maps() -> Maps:
    """Of three legs."""
    return of_axes([exact()] * 3)


@compiled
def derivative(
    p: Machine,
    body: Body,
    m: Mechanism,
    time: float,
    maps: Maps,
    y: Array,
    play: Array,
    commands: Array,
    pose: Array,
    work: tuple[Array, Array, Array, Array, Array],
    reading: Array,
    dy: Array,
) -> None:
    """dy/dt of the whole platform; extensions, their rates and forces into `reading`."""
    matrix, bias, slope, x, x_bias = work
    equations(m, y[0:3], y[3:6], pose, matrix, bias, slope, x, x_bias)
    omega = 2.0 * pi * p.valve_frequency
    right = np.zeros(3)
    for i in range(3):
        v = slope[i, 0] * y[3] + slope[i, 1] * y[4] + slope[i, 2] * y[5]
        own, rates = y[6 + AXIS * i : 6 + AXIS * (i + 1)], dy[6 + AXIS * i : 6 + AXIS * (i + 1)]
        chamber_rates(p, time, maps.valve[i], own[0:5], own[5] + play[i], x[i], v, rates[0:5])
        force = pressure_force(p, own[0], own[1]) + end_force(p, x[i], v) + odd_force(p, x[i])
        force -= friction(p, maps.friction[i], time, x[i], v, own[0], own[1], own[7:9], rates[7:9])
        rates[5] = own[6]
        rates[6] = omega * (omega * (commands[i] - own[5]) - 2.0 * p.valve_damping_ratio * own[6])
        reading[i], reading[3 + i], reading[6 + i] = x[i], v, force
        for k in range(3):
            right[k] += slope[i, k] * force
    if body.panhard_friction != 0.0:
        rods_drag(m, y, pose, body.panhard_friction, right)
    for k in range(3):
        right[k] -= bias[k]
        dy[k] = y[3 + k]
    solution = np.linalg.solve(matrix, right)
    for k in range(3):
        dy[3 + k] = solution[k]


@compiled
def rods_drag(m: Mechanism, y: Array, pose: Array, per_speed: float, right: Array) -> None:
    """Generalised forces of the rods' joints, which take c |w|^2 from the motion of each rod."""
    slopes, second = np.zeros((3, 6)), np.zeros(6)
    pose_rates(m, y[0:3], pose, y[3:6], slopes, second)
    x, yy, z = attitude(y[0], y[1], pose[0])
    e_pitch = (-np.sin(pose[0]), np.cos(pose[0]), 0.0)
    for i in range(3, 6):
        arm = joint_arm(m, x, yy, z, i)
        total = (0.0, 0.0, 0.0)
        unit = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
        for c in range(3):
            w = mix(x, e_pitch, (0.0, 0.0, 1.0), (slopes[c, 0], slopes[c, 1], slopes[c, 2]))
            unit[c] = add((slopes[c, 3], slopes[c, 4], slopes[c, 5]), cross(w, arm))
            total = add(total, times(y[3 + c], unit[c]))
        for c in range(3):
            right[c] -= per_speed * dot(unit[c], total) / m.length[i] ** 2


@compiled
def steer(
    commands: Array,
    sample: int,
    feedforward: Array,
    setpoint: Array,
    gain: float,
    gains: Array,
    memory: Array,
    period: float,
    extension: Array,
    reading_error: Array,
    sensor_gain: Array,
) -> None:
    """The command of the next sample, from what the sensors say at this one."""
    for i in range(3):
        seen = (1.0 + sensor_gain[i]) * extension[i] + reading_error[sample, i]
        wanted = 5.0 + feedforward[sample + 1, i] + gain * (setpoint[sample, i] - seen)
        if gains.size > 0:
            wanted = answered(gains, period, memory[i], setpoint[sample, i] - seen)
        commands[sample + 1, i] = min(10.0, max(0.0, wanted))


@compiled
def drag_seats(p: Machine, y: Array, seat: Array, play: Array) -> None:
    """Seats of sticky spools follow their drives with a play."""
    for i in range(3):
        spool = y[6 + AXIS * i + 5]
        seat[i] = min(max(seat[i], spool - p.sticky_spool), spool + p.sticky_spool)
        play[i] = seat[i] - spool


@compiled
def drive(commands: Array, clock: Clock, t: float, late: float, u: Array) -> None:
    """What is at the valves at the beginning, the middle and the end of a step from t on, by legs, into `u`."""
    dt = clock.period / clock.steps
    for place in range(3):
        for i in range(3):
            if clock.held:
                u[place, i] = command_held(commands, t + 0.5 * dt - late, i, clock.period)
            else:
                u[place, i] = command_at(commands, t + 0.5 * place * dt - late, i, clock.period)


@compiled
def run(
    p: Machine,
    body: Body,
    m: Mechanism,
    maps: Maps,
    clock: Clock,
    y: Array,
    feedforward: Array,
    setpoint: Array,
    gain: float,
    gains: Array,
    reading_error: Array,
    sensor_gain: Array,
    commands: Array,
    states: Array,
    readings: Array,
    start_time: float,
) -> None:
    """Fills `commands` and, clock.fine times as long, `states` and `readings`; see bench.run."""
    period, dt, every = clock.period, clock.period / clock.steps, clock.steps // clock.fine
    k, between, u = np.zeros((4, STATES)), np.zeros(STATES), np.zeros((3, 3))
    pose, seat, play = np.array([0.04, 0.0, 0.0]), np.zeros(3), np.zeros(3)
    reading, spare = np.zeros(READINGS), np.zeros(READINGS)
    work = (np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3)), np.zeros(3), np.zeros(3))
    late = p.command_delay
    late += p.tube_length / np.sqrt(p.kappa * p.gas_constant * p.air_temperature)
    weight, of_command = np.array([0.0, 0.5, 0.5, 1.0]), np.array([0, 1, 1, 2])
    for i in range(3):
        seat[i] = y[6 + AXIS * i + 5]
    states[0] = y
    derivative(p, body, m, start_time, maps, y, play, commands[0], pose, work, reading, k[0])
    readings[0] = reading
    memory = np.zeros((3, 3))
    for i in range(3):
        memory[i, 0] = setpoint[0, i] - reading[i]
    for sample in range(commands.shape[0] - 1):
        if gain >= 0.0:
            steer(
                commands, sample, feedforward, setpoint, gain, gains, memory, period, reading,
                reading_error, sensor_gain,
            )  # fmt: skip
        for step in range(clock.steps):
            t = sample * period + step * dt
            drive(commands, clock, t, late, u)
            if p.sticky_spool > 0.0:
                drag_seats(p, y, seat, play)
            for stage in range(4):
                for j in range(STATES):
                    between[j] = y[j] + weight[stage] * dt * k[max(stage - 1, 0), j]
                now = start_time + t + weight[stage] * dt
                held = u[of_command[stage]]
                derivative(p, body, m, now, maps, between, play, held, pose, work, spare, k[stage])
            for j in range(STATES):
                y[j] += dt / 6.0 * (k[0, j] + 2.0 * k[1, j] + 2.0 * k[2, j] + k[3, j])
            if (step + 1) % every == 0:
                now = start_time + t + dt
                derivative(p, body, m, now, maps, y, play, u[2], pose, work, reading, k[0])
                states[sample * clock.fine + (step + 1) // every] = y
                readings[sample * clock.fine + (step + 1) // every] = reading


@compiled
def command_held(commands: Array, time: float, axis: int, period: float) -> float:
    """V at a time in s, held from one sample to the next; before the first it is the first."""
    return float(commands[min(max(int(np.floor(time / period)), 0), commands.shape[0] - 1), axis])


@compiled
def command_at(commands: Array, time: float, axis: int, period: float) -> float:
    """V at a time in s, straight between samples; before the first it is the first."""
    place = time / period
    if place <= 0.0:
        return float(commands[0, axis])
    row = min(int(place), commands.shape[0] - 2)
    part = place - row
    return float(commands[row, axis] + part * (commands[row + 1, axis] - commands[row, axis]))


def extensions(m: Mechanism, poses: Array) -> Array:
    """Extensions, m, (n, 3), of poses (roll, pitch, height), (n, 3)."""
    found = np.empty_like(poses)
    pose = np.array([0.04, 0.0, 0.0])
    for row, q in enumerate(poses):
        found[row] = _static(m, q, pose)[0]
    return found


def _static(m: Mechanism, q: Array, pose: Array) -> tuple[Array, Array]:
    """Extensions, m, and the forces that hold the pose, N."""
    matrix, slope = np.zeros((3, 3)), np.zeros((3, 3))
    bias, x, x_bias = np.zeros(3), np.zeros(3), np.zeros(3)
    equations(m, np.ascontiguousarray(q), np.zeros(3), pose, matrix, bias, slope, x, x_bias)
    return x, np.asarray(np.linalg.solve(slope.T, bias), dtype=np.float64)


def speeds(body: Body, y: Array) -> Array:
    """Rates of the three extensions in a state, m/s."""
    matrix, slope = np.zeros((3, 3)), np.zeros((3, 3))
    bias, x, x_bias = np.zeros(3), np.zeros(3), np.zeros(3)
    pose = np.array([0.04, 0.0, 0.0])
    equations(mechanism(body), y[0:3], y[3:6], pose, matrix, bias, slope, x, x_bias)
    return np.asarray(slope @ y[3:6])


def at_rest(p: Machine, body: Body, q: Array, mean_pressure: float = 3.3e5) -> Array:
    """A state of rest: the air carries the weight."""
    _, force = _static(mechanism(body), q, np.array([0.04, 0.0, 0.0]))
    bore, ring = (
        0.25 * pi * p.bore_diameter**2,
        0.25 * pi * (p.bore_diameter**2 - p.rod_diameter**2),
    )
    y = np.zeros(STATES)
    y[0:3] = q
    for i in range(3):
        axis = y[6 + AXIS * i : 6 + AXIS * (i + 1)]
        # lower bore - upper ring = force + ambient (bore - ring), their mean as given
        wanted = force[i] + p.ambient_pressure * (bore - ring)
        axis[0] = (wanted + 2.0 * mean_pressure * ring) / (bore + ring)
        axis[1] = 2.0 * mean_pressure - axis[0]
        axis[2:4] = p.air_temperature
        axis[4], axis[5] = p.supply_pressure, 5.0
    return y


def simulate(
    p: Machine,
    body: Body,
    plan: Plan,
    gain: float,
    reading_error: Array,
    sensor_gain: Array,
    maps: Maps | None = None,
    clock: Clock = STRAIGHT,
) -> Motion:
    """One run from rest in the plan's first pose; see bench.simulate."""
    samples = plan.feedforward.shape[0]
    commands = np.full((samples, 3), 5.0)
    commands[0] += plan.feedforward[0]
    states = np.zeros(((samples - 1) * clock.fine + 1, STATES))
    readings = np.zeros((states.shape[0], READINGS))
    start = at_rest(p, body, plan.pose)
    run(
        p, body, mechanism(body), exact_maps() if maps is None else maps, clock, start,
        plan.feedforward, plan.setpoint, gain, plan.gains, reading_error, sensor_gain,
        commands, states, readings, 0.0,
    )  # fmt: skip
    return Motion(states, readings, commands)


def follow(
    p: Machine,
    body: Body,
    commands: Array,
    start: Array,
    start_time: float,
    maps: Maps | None = None,
) -> Motion:
    """Under recorded commands (n, 3) from a given state."""
    states = np.zeros(((commands.shape[0] - 1) * FINE + 1, STATES))
    readings = np.zeros((states.shape[0], READINGS))
    nothing = np.zeros_like(commands)
    run(
        p, body, mechanism(body), exact_maps() if maps is None else maps, STRAIGHT, start.copy(),
        nothing, nothing, -1.0, np.empty(0), nothing, np.zeros(3), commands.copy(), states, readings,
        start_time,
    )  # fmt: skip
    return Motion(states, readings, commands)
