"""One actuator on the bench, horizontal, nothing on its rod: the motion of one run.

Fourth-order Runge-Kutta at a step well below every time constant. The command runs straight from
one record sample to the next. A slow position loop may keep the piston inside its stroke; it sees
the sensor, not the truth, and acts one sample later.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi

import numpy as np

from validation.reference.compiled import compiled
from validation.twins.air import Array, chamber_rates, supply_now
from validation.twins.clock import Clock
from validation.twins.controller import answered
from validation.twins.machine import Machine
from validation.twins.maps import Maps, exact
from validation.twins.seal import end_force, friction, odd_force, pressure_force

SAMPLE_STEP = 5.0e-3
"""s between two samples of a record."""
STEPS = 20
"""Integration steps a sample."""
FINE = 5
"""Points a sample at which the motion is kept."""
STRAIGHT = Clock(SAMPLE_STEP, STEPS, FINE, held=False)
STATES = 11
"""x, v | p_lower, p_upper, T_lower, T_upper, reservoir | spool, its rate | bristle, film."""


@dataclass(frozen=True)
class Plan:
    """What one run is to do; arrays have one entry a sample."""

    feedforward: Array  # V around the centre
    setpoint: Array  # m
    gain: float  # V/m of the position loop; 0: open
    start: float  # m
    gains: Array = field(default_factory=lambda: np.empty(0))
    """Of a controller (controller.py) that follows the set-point instead; empty: none."""


@dataclass(frozen=True)
class Motion:
    """Time in s and states of one run at FINE points a sample, (n,) and (n, STATES)."""

    time: Array
    state: Array
    command: Array  # V, one a sample, as the controller has put it out


@compiled
def derivative(
    p: Machine, time: float, maps: Maps, y: Array, play: float, command: float, dy: Array
) -> None:
    """dy/dt of the whole actuator; `play` is what the spool's seat lags behind its drive, V."""
    x, v = y[0], y[1]
    chamber_rates(p, time, maps.valve, y[2:7], y[7] + play, x, v, dy[2:7])
    force = pressure_force(p, y[2], y[3]) + end_force(p, x, v) + odd_force(p, x)
    force -= friction(p, maps.friction, time, x, v, y[2], y[3], y[9:11], dy[9:11])
    dy[0] = v
    dy[1] = force / p.moving_mass
    omega = 2.0 * pi * p.valve_frequency
    dy[7] = y[8]
    dy[8] = omega * (omega * (command - y[7]) - 2.0 * p.valve_damping_ratio * y[8])


@compiled
def command_at(commands: Array, time: float, period: float) -> float:
    """V at a time in s, straight between samples; before the first it is the first."""
    place = time / period
    if place <= 0.0:
        return float(commands[0])
    row = min(int(place), commands.size - 2)
    part = place - row
    return float(commands[row] + part * (commands[row + 1] - commands[row]))


@compiled
def command_held(commands: Array, time: float, period: float) -> float:
    """V at a time in s, held from one sample to the next; before the first it is the first."""
    return float(commands[min(max(int(np.floor(time / period)), 0), commands.size - 1)])


@compiled
def driven(commands: Array, clock: Clock, t: float, late: float) -> tuple[float, float, float]:
    """V at the valve at the beginning, the middle and the end of a step from t on, s."""
    dt = clock.period / clock.steps
    if clock.held:
        u = command_held(commands, t + 0.5 * dt - late, clock.period)
        return u, u, u
    return (
        command_at(commands, t - late, clock.period),
        command_at(commands, t + 0.5 * dt - late, clock.period),
        command_at(commands, t + dt - late, clock.period),
    )


@compiled
def run(
    p: Machine,
    maps: Maps,
    clock: Clock,
    y: Array,
    feedforward: Array,
    setpoint: Array,
    gain: float,
    gains: Array,
    reading_error: Array,
    sensor_gain: float,
    commands: Array,
    states: Array,
    start_time: float,
) -> None:
    """Fills `commands` and, clock.fine times as long, `states`; y is where the run starts.

    With gain < 0 `commands` is taken as it is.
    """
    period, dt = clock.period, clock.period / clock.steps
    k1, k2, k3, k4 = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    between = np.zeros(STATES)
    every = clock.steps // clock.fine
    tube = p.tube_length / np.sqrt(p.kappa * p.gas_constant * p.air_temperature)
    late = p.command_delay + tube
    seat = y[7]
    states[0] = y
    memory = np.array([setpoint[0] - y[0], 0.0, 0.0])
    if gain >= 0.0:
        commands[0] = min(10.0, max(0.0, 5.0 + feedforward[0]))
    for k in range(commands.size - 1):
        if gain >= 0.0:
            reading = (1.0 + sensor_gain) * y[0] + reading_error[k]
            wanted = 5.0 + feedforward[k + 1] + gain * (setpoint[k] - reading)
            if gains.size > 0:
                wanted = answered(gains, period, memory, setpoint[k] - reading)
            commands[k + 1] = min(10.0, max(0.0, wanted))
        for i in range(clock.steps):
            t = k * period + i * dt
            u0, u1, u2 = driven(commands, clock, t, late)
            if p.sticky_spool > 0.0:
                seat = min(max(seat, y[7] - p.sticky_spool), y[7] + p.sticky_spool)
            play = seat - y[7] if p.sticky_spool > 0.0 else 0.0
            now = start_time + t
            derivative(p, now, maps, y, play, u0, k1)
            for j in range(STATES):
                between[j] = y[j] + 0.5 * dt * k1[j]
            derivative(p, now + 0.5 * dt, maps, between, play, u1, k2)
            for j in range(STATES):
                between[j] = y[j] + 0.5 * dt * k2[j]
            derivative(p, now + 0.5 * dt, maps, between, play, u1, k3)
            for j in range(STATES):
                between[j] = y[j] + dt * k3[j]
            derivative(p, now + dt, maps, between, play, u2, k4)
            for j in range(STATES):
                y[j] += dt / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j])
            if (i + 1) % every == 0:
                states[k * clock.fine + (i + 1) // every] = y


def balanced(p: Machine, x: float, mean_pressure: float = 2.8e5) -> Array:
    """A state of rest at extension x: the two chambers hold each other."""
    bore = p.bore_diameter**2
    ring = bore - p.rod_diameter**2
    lower = p.ambient_pressure + (mean_pressure - p.ambient_pressure) * ring / bore
    y = np.zeros(STATES)
    y[0], y[2], y[3] = x, lower, mean_pressure
    y[4:6] = p.air_temperature
    y[6], y[7] = p.supply_pressure, 5.0
    return y


def simulate(
    p: Machine,
    plan: Plan,
    reading_error: Array | None = None,
    sensor_gain: float = 0.0,
    maps: Maps | None = None,
    clock: Clock = STRAIGHT,
) -> Motion:
    """One run from rest; `reading_error` (m, one a sample of the clock) is what the loop's sensor adds."""
    samples = plan.feedforward.size
    commands = np.zeros(samples)
    states = np.zeros(((samples - 1) * clock.fine + 1, STATES))
    error = np.zeros(samples) if reading_error is None else reading_error
    run(
        p,
        exact() if maps is None else maps,
        clock,
        balanced(p, plan.start),
        plan.feedforward,
        plan.setpoint,
        plan.gain,
        plan.gains,
        error,
        sensor_gain,
        commands,
        states,
        0.0,
    )
    return Motion(fine_times(states.shape[0]), states, commands)


def follow(
    p: Machine, commands: Array, start: Array, start_time: float = 0.0, maps: Maps | None = None
) -> Array:
    """States under commands of SAMPLE_STEP from a given state, FINE points a sample, (n, STATES)."""
    states = np.zeros(((commands.size - 1) * FINE + 1, STATES))
    nothing = np.zeros(commands.size)
    run(
        p,
        exact() if maps is None else maps,
        STRAIGHT,
        start.copy(),
        nothing,
        nothing,
        -1.0,
        np.empty(0),
        nothing,
        0.0,
        commands.copy(),
        states,
        start_time,
    )
    return states


def fine_times(count: int) -> Array:
    """Times of `count` points, FINE a sample, s."""
    return np.asarray(SAMPLE_STEP / FINE * np.arange(count), dtype=np.float64)


def heads(p: Machine, times: Array) -> Array:
    """Pressure at the head of the supply line, Pa, at times in s."""
    return np.array([supply_now(p, time) for time in times.tolist()])
