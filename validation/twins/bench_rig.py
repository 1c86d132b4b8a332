"""The bench as a rig to be measured: its runs, its signals, its windows for detection limits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from validation.twins import bench, excitation
from validation.twins.air import Array
from validation.twins.clock import Clock, holding
from validation.twins.declared import BENCH, Declared
from validation.twins.effects import SIGNALS
from validation.twins.instruments import disturbed, played
from validation.twins.measured import Measured, every, sample_times
from validation.twins.seal import sliding_way
from validation.twins.truth import Truth

ROOM = 0.15
"""m to either side of mid-stroke that an excitation may use."""
ROOM_TO_THE_ENDS = 0.19
LOOP_GAIN = 5.0
"""V/m of the slow position loop."""


class BenchRig:
    """Kind "bench"."""

    kind = "bench"
    title = "Virtual pneumatic actuator on the bench"
    declared: tuple[Declared, ...] = BENCH
    signals = SIGNALS["bench"]
    commands = ("valve_command",)
    axes = 1
    log_steps = (0.01, 0.005, 0.002)
    menu = tuple(excitation.MENU)
    duration = 10.0
    window_states = (0, 1, 2, 3)
    """What is unknown at the start of every stretch of a record: position, speed, pressures."""
    state_steps = (1e-4, 1e-2, 500.0, 500.0)

    def __init__(
        self, clock: Clock = bench.STRAIGHT, sample_step: float = bench.SAMPLE_STEP
    ) -> None:
        self.clock = clock
        self.sample_step = sample_step

    @staticmethod
    def controlled(log_step: float, period: float) -> BenchRig:
        """With a controller that holds its command for `period`, of whose samples one each `log_step` is logged, s."""
        return BenchRig(holding(period, bench.SAMPLE_STEP / bench.STEPS), log_step)

    def plan(self, excited_by: str, rng: np.random.Generator) -> bench.Plan:
        """A run of `duration` seconds."""
        time = sample_times(self.duration, self.clock.period)
        room = ROOM_TO_THE_ENDS if excited_by == "ends" else ROOM
        setpoint = 0.2 + excitation.MENU[excited_by](time, room, rng)
        ahead = excitation.feedforward(setpoint, self.clock.period)
        return bench.Plan(ahead, setpoint, LOOP_GAIN, float(setpoint[0]))

    def following(self, setpoint: Array, gains: Array) -> bench.Plan:
        """A run along a set-point, m, one a period of the clock, by a controller with these numbers."""
        return bench.Plan(np.zeros(setpoint.size), setpoint, 0.0, float(setpoint[0]), gains)

    def measure(
        self, truth: Truth, plan: bench.Plan, reading_noise: Mapping[str, Array]
    ) -> Measured:
        """One run; `reading_noise` of the extension enters the position loop."""
        error = truth.errors["extension"]
        motion = bench.simulate(
            truth.built,
            plan,
            reading_noise["extension"] + error.offset,
            error.gain,
            truth.maps,
            self.clock,
        )
        logged = every(self.clock.period, self.sample_step)
        return Measured(
            {"valve_command": motion.command[::logged]},
            {"setpoint": plan.setpoint[::logged]},
            self._signals(truth, motion.state),
            np.ascontiguousarray(motion.state[:: every(self.clock.fine_step, self.sample_step)]),
        )

    def window(
        self, truth: Truth, commands: Mapping[str, Array], start: Array, time: float
    ) -> Mapping[str, Array]:
        """The signals of a stretch of a record, from a given state, under recorded commands."""
        start = start.copy()
        if truth.machine.bristle_compliance > 0.0:
            slide = sliding_way(truth.machine, float(start[1]))
            start[9] = truth.machine.coulomb_force * truth.machine.bristle_compliance * slide
        start[10] = start[1]
        start[6] = truth.machine.supply_pressure
        states = bench.follow(truth.built, commands["valve_command"], start, time, truth.maps)
        return self._signals(truth, states)

    def _signals(self, truth: Truth, states: Array) -> dict[str, Array]:
        supply = states[:, 6]
        if truth.machine.supply_line_resistance <= 0.0:
            supply = bench.heads(truth.machine, bench.fine_times(states.shape[0]))
        fine = {
            "extension": self._seen(truth, states),
            "chamber_pressure_lower": states[:, 2],
            "chamber_pressure_upper": states[:, 3],
            "supply_pressure": supply,
        }
        step = self.clock.fine_step
        kept = every(step, self.sample_step)
        return {
            name: disturbed(signal, step, kept, truth.errors[name]) for name, signal in fine.items()
        }

    def _seen(self, truth: Truth, states: Array) -> Array:
        """What the position sensor stands in front of: it is fixed to the ground and follows the
        rod with a play. The mount takes what the cylinder gives the rod, which is M a here."""
        body = truth.body
        rod = states[:, 0]
        if body.frame_compliance > 0.0:
            acceleration = np.gradient(states[:, 1], self.clock.fine_step)
            rod = rod - body.frame_compliance * truth.machine.moving_mass * acceleration
        return played(rod, body.backlash)
