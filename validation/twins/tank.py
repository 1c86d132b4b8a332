"""The tank of the flow test: a vessel of constant volume behind one port of the valve.

Above the valve's centre the supply fills it, below it is vented. Without heat its air keeps its
temperature (eq. 5.5), as the tables were measured; with a heat transfer coefficient the full
energy equation holds and the temperature is a state.
"""

from __future__ import annotations

from math import pi

import numpy as np

from validation.reference.compiled import compiled
from validation.twins.air import (
    Array,
    chamber_rate,
    edges,
    leaks,
    supply_now,
    tube_volume,
    valve_inflow,
)
from validation.twins.bench import command_at, command_held
from validation.twins.clock import Clock
from validation.twins.machine import Machine
from validation.twins.maps import Maps, exact

SAMPLE_STEP = 5.0e-3
STEPS = 10
FINE = 5
STRAIGHT = Clock(SAMPLE_STEP, STEPS, FINE, held=False)
STATES = 5
"""p, T | spool, its rate | reservoir."""


@compiled
def derivative(
    p: Machine, time: float, map_: Array, y: Array, play: float, command: float, dy: Array
) -> None:
    """dy/dt of the tank."""
    warm = p.heat_transfer_coefficient > 0.0
    t = y[1] if warm else p.air_temperature
    head = supply_now(p, time)
    feed = y[4] if p.supply_line_resistance > 0.0 else head
    edge = edges(p, time, map_, y[2] + play)
    from_supply, from_exhaust = valve_inflow(p, edge, False, feed, y[0], t)
    lost = leaks(p, False, y[0])
    inward = max(from_supply, 0.0) + max(from_exhaust, 0.0) + max(-lost, 0.0)
    outward = max(-from_supply, 0.0) + max(-from_exhaust, 0.0) + max(lost, 0.0)
    room = (p.tank_volume + tube_volume(p), 0.0, p.tank_wall_area)
    dy[0], dy[1] = chamber_rate(p, y[0], t, room, inward, inward * p.air_temperature, outward)
    omega = 2.0 * pi * p.valve_frequency
    dy[2] = y[3]
    dy[3] = omega * (omega * (command - y[2]) - 2.0 * p.valve_damping_ratio * y[3])
    dy[4] = 0.0
    if p.supply_line_resistance > 0.0:
        stiffness = p.compression_heat_ratio * p.gas_constant * p.air_temperature
        filling = (head - y[4]) / p.supply_line_resistance
        dy[4] = stiffness / p.reservoir_volume * (filling - from_supply)


@compiled
def run(
    p: Machine,
    map_: Array,
    clock: Clock,
    y: Array,
    commands: Array,
    states: Array,
    start_time: float,
) -> None:
    """Fills `states`, clock.fine points a sample."""
    period, dt, every = clock.period, clock.period / clock.steps, clock.steps // clock.fine
    k, between = np.zeros((4, STATES)), np.zeros(STATES)
    weight = np.array([0.0, 0.5, 0.5, 1.0])
    seat, play = y[2], 0.0
    late = p.command_delay + p.tube_length / np.sqrt(p.kappa * p.gas_constant * p.air_temperature)
    states[0] = y
    for sample in range(commands.size - 1):
        for step in range(clock.steps):
            t = sample * period + step * dt
            if p.sticky_spool > 0.0:
                seat = min(max(seat, y[2] - p.sticky_spool), y[2] + p.sticky_spool)
                play = seat - y[2]
            for stage in range(4):
                for j in range(STATES):
                    between[j] = y[j] + weight[stage] * dt * k[max(stage - 1, 0), j]
                now = t + weight[stage] * dt
                if clock.held:
                    u = command_held(commands, t + 0.5 * dt - late, period)
                else:
                    u = command_at(commands, now - late, period)
                derivative(p, start_time + now, map_, between, play, u, k[stage])
            for j in range(STATES):
                y[j] += dt / 6.0 * (k[0, j] + 2.0 * k[1, j] + 2.0 * k[2, j] + k[3, j])
            if (step + 1) % every == 0:
                states[sample * clock.fine + (step + 1) // every] = y


def follow(
    p: Machine,
    commands: Array,
    start: Array,
    start_time: float,
    maps: Maps | None = None,
    clock: Clock = STRAIGHT,
) -> Array:
    """States under commands in V, one a sample of the clock, from a given state, (n, STATES)."""
    states = np.zeros(((commands.size - 1) * clock.fine + 1, STATES))
    valve = (exact() if maps is None else maps).valve
    run(p, valve, clock, start.copy(), commands, states, start_time)
    return states
