"""The platform with a sampled position controller in each leg, all of them with the same numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from validation.reference.compiled import compiled
from validation.reference.plants.mechanism import Mechanism
from validation.twins import platform
from validation.twins.air import Array
from validation.twins.controller import Controller, answered, delay, read, sample_at_valve
from validation.twins.instruments import CHANNELS
from validation.twins.machine import Body, Machine
from validation.twins.maps import Maps
from validation.twins.measured import Measured
from validation.twins.platform_rig import LEGS, PlatformRig
from validation.twins.truth import Truth


@compiled
def run(
    p: Machine,
    body: Body,
    m: Mechanism,
    maps: Maps,
    y: Array,
    setpoint: Array,
    noise: Array,
    count: float,
    gains: Array,
    commands: Array,
    states: Array,
    readings: Array,
) -> None:
    """Fills `commands` and, platform.FINE times as long, `states` and `readings`; y is where the run starts.

    setpoint and noise of the sensors, m, (n, 3); count: one step of the converter, m.
    """
    period = platform.SAMPLE_STEP
    dt = period / platform.STEPS
    every = platform.STEPS // platform.FINE
    late = delay(p)
    k, between, u = np.zeros((4, platform.STATES)), np.zeros(platform.STATES), np.zeros(3)
    pose, play = np.array([0.04, 0.0, 0.0]), np.zeros(3)
    reading, spare = np.zeros(platform.READINGS), np.zeros(platform.READINGS)
    work = (np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3)), np.zeros(3), np.zeros(3))
    weight = np.array([0.0, 0.5, 0.5, 1.0])
    u[:] = 5.0
    platform.derivative(p, body, m, 0.0, maps, y, play, u, pose, work, reading, k[0])
    memory = np.zeros((3, 3))
    memory[:, 0] = setpoint[0] - reading[0:3]
    states[0], readings[0] = y, reading
    for sample in range(setpoint.shape[0]):
        for i in range(3):
            error = setpoint[sample, i] - read(reading[i], noise[sample, i], count)
            commands[sample, i] = answered(gains, period, memory[i], error)
        if sample == setpoint.shape[0] - 1:
            return
        for step in range(platform.STEPS):
            sent = sample_at_valve(sample, step * dt, late, period)
            for i in range(3):
                u[i] = commands[sent, i] if sent >= 0 else 5.0
            now = sample * period + step * dt
            for stage in range(4):
                between[:] = y + weight[stage] * dt * k[max(stage - 1, 0)]
                at = now + weight[stage] * dt
                platform.derivative(
                    p, body, m, at, maps, between, play, u, pose, work, spare, k[stage]
                )
            y += dt / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3])
            if (step + 1) % every == 0:
                row = sample * platform.FINE + (step + 1) // every
                platform.derivative(
                    p, body, m, now + dt, maps, y, play, u, pose, work, reading, k[0]
                )
                states[row], readings[row] = y, reading


class ClosedPlatformRig(PlatformRig):
    """The platform with three controllers; its runs are short."""

    title = "Virtual motion platform in its position loops"
    duration = 4.0

    def __init__(self, controller: Controller) -> None:
        super().__init__()
        self.controller = controller

    def measure(
        self, truth: Truth, plan: platform.Plan, reading_noise: Mapping[str, Array]
    ) -> Measured:
        """One run; for sensors of the extensions without errors, which are also the controllers'."""
        commands = np.zeros_like(plan.setpoint)
        states = np.zeros(((len(commands) - 1) * platform.FINE + 1, platform.STATES))
        readings = np.zeros((len(states), platform.READINGS))
        run(
            truth.built,
            truth.body,
            platform.mechanism(truth.body),
            platform.exact_maps(),
            platform.at_rest(truth.machine, truth.body, plan.pose),
            plan.setpoint,
            np.column_stack([reading_noise[f"extension_{i}"] for i in LEGS]),
            CHANNELS["extension"].step,
            self.controller.gains,
            commands,
            states,
            readings,
        )
        return Measured(
            {f"valve_command_{i}": commands[:, i - 1] for i in LEGS},
            {f"setpoint_{i}": plan.setpoint[:, i - 1] for i in LEGS},
            self._signals(truth, platform.Motion(states, readings, commands)),
            np.ascontiguousarray(states[:: platform.FINE]),
        )
