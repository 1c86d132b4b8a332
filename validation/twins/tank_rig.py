"""The tank as a rig to be measured: its runs, its signals, its windows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from validation.twins import bench, tank
from validation.twins.air import Array
from validation.twins.clock import Clock, holding
from validation.twins.declared import TANK, Declared
from validation.twins.effects import SIGNALS
from validation.twins.instruments import disturbed
from validation.twins.measured import Measured, every, sample_times
from validation.twins.truth import Truth

RAMP = 0.02
"""s that a change of the command takes."""


class TankRig:
    """Kind "tank"."""

    kind = "tank"
    title = "Virtual tank of the flow test"
    declared: tuple[Declared, ...] = TANK
    signals = SIGNALS["tank"]
    commands = ("valve_command",)
    axes = 1
    log_steps = (0.01, 0.005, 0.002)
    duration = 8.0
    window_states = (0,)
    state_steps = (500.0,)

    def __init__(self, clock: Clock = tank.STRAIGHT, sample_step: float = tank.SAMPLE_STEP) -> None:
        self.clock = clock
        self.sample_step = sample_step

    @staticmethod
    def controlled(log_step: float, period: float) -> TankRig:
        """With a controller that holds its command for `period`, of whose samples one each `log_step` is logged, s."""
        return TankRig(holding(period, tank.SAMPLE_STEP / tank.STEPS), log_step)

    def plan(self, excited_by: str, rng: np.random.Generator) -> Array:
        """Commands in V of a run: "strokes" fills and vents, "bursts" does it bit by bit."""
        time = sample_times(self.duration, self.clock.period)
        knots, volts, up = [0.0, 0.3], [5.0, 5.0], True
        while knots[-1] < time[-1]:
            if excited_by == "strokes":
                wide, hold, pause = rng.uniform(0.9, 1.6), rng.uniform(0.7, 1.2), 0.3
            else:
                wide, hold, pause = rng.uniform(0.7, 2.5), rng.uniform(0.05, 0.15), 0.35
            turn = up if excited_by == "strokes" else len(knots) % 40 < 20
            volt = 5.0 + (wide if turn else -wide)
            start = knots[-1]
            knots += [start + RAMP, start + RAMP + hold, start + 2.0 * RAMP + hold]
            volts += [volt, volt, 5.0]
            knots.append(knots[-1] + pause)
            volts.append(5.0)
            up = not up
        return np.asarray(np.interp(time, knots, volts), dtype=np.float64)

    def following(self, setpoint: Array, gains: Array) -> Array:
        """A run whose commands are given, V, one a period of the clock; there is no loop."""
        return np.clip(setpoint, 0.0, 10.0)

    def measure(self, truth: Truth, plan: Array, reading_noise: Mapping[str, Array]) -> Measured:
        """One run from ambient pressure; there is no loop."""
        p = truth.machine
        start = np.array([p.ambient_pressure + 5e4, p.air_temperature, 5.0, 0.0, p.supply_pressure])
        states = tank.follow(p, plan, start, 0.0, truth.maps, self.clock)
        return Measured(
            {"valve_command": plan[:: every(self.clock.period, self.sample_step)]},
            {},
            self._signals(truth, states),
            np.ascontiguousarray(states[:: every(self.clock.fine_step, self.sample_step)]),
        )

    def window(
        self, truth: Truth, commands: Mapping[str, Array], start: Array, time: float
    ) -> Mapping[str, Array]:
        """The signals of a stretch of a record, from a given state, under recorded commands."""
        start = start.copy()
        start[4] = truth.machine.supply_pressure
        return self._signals(
            truth, tank.follow(truth.built, commands["valve_command"], start, time, truth.maps)
        )

    def _signals(self, truth: Truth, states: Array) -> dict[str, Array]:
        step, p = self.clock.fine_step, truth.machine
        kept = every(step, self.sample_step)
        supply, warmth = states[:, 4], states[:, 1]
        if p.supply_line_resistance <= 0.0:
            supply = bench.heads(p, sample_times(step * (states.shape[0] - 1), step))
        if p.heat_transfer_coefficient <= 0.0:
            warmth = np.full(states.shape[0], p.air_temperature)
        fine = {
            "tank_pressure": states[:, 0],
            "tank_temperature": warmth,
            "supply_pressure": supply,
        }
        return {
            name: disturbed(signal, step, kept, truth.errors[name]) for name, signal in fine.items()
        }
