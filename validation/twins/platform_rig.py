"""The platform as a rig to be measured: its runs, its signals, its windows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from validation.twins import bench, excitation, platform
from validation.twins.air import Array
from validation.twins.clock import Clock, holding
from validation.twins.declared import PLATFORM, Declared
from validation.twins.effects import SIGNALS
from validation.twins.instruments import disturbed, played
from validation.twins.machine import Body
from validation.twins.measured import Measured, every, sample_times
from validation.twins.seal import sliding_way
from validation.twins.truth import Truth

LEGS = (1, 2, 3)
LOOP_GAIN = 6.0
"""V/m of each axis' slow position loop."""
HEIGHT = 0.5
ROOM = np.array([0.055, 0.05, 0.03])
"""Largest roll, pitch (rad) and height (m) of an excitation; together they stay in the stroke."""
ROOM_TO_THE_ENDS = np.array([0.01, 0.01, 0.145])


class PlatformRig:
    """Kind "platform"."""

    kind = "platform"
    title = "Virtual motion platform"
    declared: tuple[Declared, ...] = PLATFORM
    signals = SIGNALS["platform"]
    commands = tuple(f"valve_command_{i}" for i in LEGS)
    axes = 3
    log_steps = (0.01, 0.005)
    duration = 8.0
    window_states = (
        *range(6),
        *(6 + platform.AXIS * i + side for i in range(3) for side in (0, 1)),
    )
    state_steps = (1e-4, 1e-4, 1e-4, 5e-3, 5e-3, 5e-3, *(500.0,) * 6)

    def __init__(
        self, clock: Clock = platform.STRAIGHT, sample_step: float = platform.SAMPLE_STEP
    ) -> None:
        self.clock = clock
        self.sample_step = sample_step

    @staticmethod
    def controlled(log_step: float, period: float) -> PlatformRig:
        """With a controller that holds its command for `period`, of whose samples one each `log_step` is logged, s."""
        return PlatformRig(holding(period, platform.SAMPLE_STEP / platform.STEPS), log_step)

    def plan(self, excited_by: str, rng: np.random.Generator) -> platform.Plan:
        """A run of `duration` seconds: each of roll, pitch and height by the menu."""
        time = sample_times(self.duration, self.clock.period)
        room = ROOM_TO_THE_ENDS if excited_by == "ends" else ROOM
        made = excitation.MENU[excited_by]
        # The menu is made for metres of a piston: 0.15 m there is the room here.
        pose = np.column_stack([made(time, 0.15, rng) * size / 0.15 for size in room])
        pose[:, 2] += HEIGHT
        setpoint = platform.extensions(platform.mechanism(Body()), pose)
        ahead = [excitation.feedforward(setpoint[:, i], self.clock.period) for i in range(3)]
        return platform.Plan(np.column_stack(ahead), setpoint, pose[0])

    def following(self, setpoint: Array, gains: Array) -> platform.Plan:
        """A run through poses (roll, pitch, rad, height, m), (n, 3), one a period of the clock, by controllers with
        these numbers."""
        legs = platform.extensions(platform.mechanism(Body()), setpoint)
        return platform.Plan(np.zeros(legs.shape), legs, setpoint[0], gains)

    def measure(
        self, truth: Truth, plan: platform.Plan, reading_noise: Mapping[str, Array]
    ) -> Measured:
        """One run; the noise of the extensions enters the position loops."""
        errors = [truth.errors[f"extension_{i}"] for i in LEGS]
        seen = [
            reading_noise[f"extension_{i}"] + error.offset
            for i, error in zip(LEGS, errors, strict=True)
        ]
        motion = platform.simulate(
            truth.built,
            truth.body,
            plan,
            LOOP_GAIN,
            np.column_stack(seen),
            np.array([error.gain for error in errors]),
            truth.maps,
            self.clock,
        )
        logged = every(self.clock.period, self.sample_step)
        return Measured(
            {f"valve_command_{i}": motion.command[::logged, i - 1] for i in LEGS},
            {f"setpoint_{i}": plan.setpoint[::logged, i - 1] for i in LEGS},
            self._signals(truth, motion),
            np.ascontiguousarray(motion.state[:: every(self.clock.fine_step, self.sample_step)]),
        )

    def window(
        self, truth: Truth, commands: Mapping[str, Array], start: Array, time: float
    ) -> Mapping[str, Array]:
        """The signals of a stretch of a record, from a given state, under recorded commands."""
        start, p = start.copy(), truth.machine
        speeds = platform.speeds(truth.body, start)
        for i in range(3):
            axis = start[6 + platform.AXIS * i : 6 + platform.AXIS * (i + 1)]
            axis[4] = p.supply_pressure
            if p.bristle_compliance > 0.0:
                way = sliding_way(p, float(speeds[i]))
                axis[7] = p.coulomb_force * p.bristle_compliance * way
            axis[8] = speeds[i]
        held = np.column_stack([commands[name] for name in self.commands])
        return self._signals(
            truth, platform.follow(truth.built, truth.body, held, start, time, truth.maps)
        )

    def _signals(self, truth: Truth, motion: platform.Motion) -> dict[str, Array]:
        state, body = motion.state, truth.body
        step = self.clock.fine_step
        kept = every(step, self.sample_step)
        supply = state[:, 10]
        if truth.machine.supply_line_resistance <= 0.0:
            supply = bench.heads(truth.machine, sample_times(step * (state.shape[0] - 1), step))
        fine = {"supply_pressure": supply, "roll": state[:, 0], "pitch": state[:, 1]}
        for i in LEGS:
            first = 6 + platform.AXIS * (i - 1)
            given = motion.reading[:, i - 1] + body.frame_compliance * motion.reading[:, 5 + i]
            fine[f"extension_{i}"] = played(given, body.backlash)
            fine[f"chamber_pressure_lower_{i}"] = state[:, first]
            fine[f"chamber_pressure_upper_{i}"] = state[:, first + 1]
        return {
            name: disturbed(fine[name], step, kept, truth.errors[name]) for name in self.signals
        }
