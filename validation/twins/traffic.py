"""A bench that runs for hours and is logged, well at first; from some moment on it is another machine.

Its owner moves it to and fro as he likes: ten seconds of one of the excitations, then of another, drawn anew each
time, with a bridge between. The log comes in pieces, as a logger that begins a file every few minutes would write
it; the machine runs on.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from validation.twins import bench, excitation
from validation.twins.air import Array
from validation.twins.bench_rig import LOOP_GAIN, ROOM, BenchRig
from validation.twins.draw import Trial, recorded
from validation.twins.measured import Measured, every, sample_times
from validation.twins.truth import Truth

MOTIONS = ("multisine", "holds", "steps", "chirp")
LENGTH = 10.0
"""s of one motion."""
BRIDGE = 1.5
"""s to the next."""
PIECE = 120.0
"""s of the log at a time: a minute of states is 5 MiB."""


@dataclass(frozen=True)
class Change:
    """What the machine is from a time on."""

    time: float
    """s"""
    truth: Truth


class RunningBench(BenchRig):
    """A bench that goes on where it stopped."""

    def __init__(self, rig: BenchRig) -> None:
        super().__init__(rig.clock, rig.sample_step)
        self.state: Array | None = None

    def measure(
        self, truth: Truth, plan: bench.Plan, reading_noise: Mapping[str, Array]
    ) -> Measured:
        """As BenchRig has it, from where the last one ended."""
        error = truth.errors["extension"]
        count = plan.setpoint.size
        commands = np.zeros(count)
        states = np.zeros(((count - 1) * self.clock.fine + 1, bench.STATES))
        if self.state is None:
            self.state = bench.balanced(truth.machine, plan.start)
        assert truth.maps is not None
        bench.run(
            truth.built,
            truth.maps,
            self.clock,
            self.state,
            plan.feedforward,
            plan.setpoint,
            plan.gain,
            plan.gains,
            reading_noise["extension"] + error.offset,
            error.gain,
            commands,
            states,
            0.0,
        )
        logged = every(self.clock.period, self.sample_step)
        kept = np.ascontiguousarray(states[:: every(self.clock.fine_step, self.sample_step)])
        signals = self._signals(truth, states)
        return Measured({"valve_command": commands[::logged]}, {}, signals, kept)


class Motion:
    """An endless set-point, m about mid-stroke, drawn piece by piece at the period of the clock."""

    def __init__(self, period: float, rng: np.random.Generator) -> None:
        self.period, self.rng = period, rng
        self.ahead: Array = np.zeros(1)

    def take(self, samples: int) -> Array:
        """The next samples + 1, of which the last is the first of what comes next."""
        while self.ahead.size <= samples:
            name = MOTIONS[int(self.rng.integers(len(MOTIONS)))]
            wave = excitation.MENU[name](sample_times(LENGTH, self.period), ROOM, self.rng)
            part = np.arange(1, round(BRIDGE / self.period)) / round(BRIDGE / self.period)
            bridge = self.ahead[-1] + (wave[0] - self.ahead[-1]) * 0.5 * (
                1.0 - np.cos(np.pi * part)
            )
            self.ahead = np.concatenate([self.ahead, bridge, wave])
        taken, self.ahead = self.ahead[: samples + 1], self.ahead[samples:]
        return taken


def traffic(
    trial: Trial, seconds: float, seed: int, changes: tuple[Change, ...] = ()
) -> Iterator[dict[str, Array]]:
    """The log of a bench (draw_trial) in pieces: column without its unit -> (n,). A change begins with a piece."""
    assert isinstance(trial.rig, BenchRig)
    rig = RunningBench(trial.rig)
    trial = replace(trial, rig=rig)
    for_motion, for_noise = (
        np.random.default_rng(s) for s in np.random.SeedSequence([seed, 23]).spawn(2)
    )
    motion = Motion(rig.clock.period, for_motion)
    edges = {0.0, seconds, *(c.time for c in changes)}
    edges |= set(np.arange(0.0, seconds, PIECE).tolist())
    ordered = sorted(edges)
    for begin, end in pairwise(ordered):
        truth = next((c.truth for c in reversed(changes) if c.time <= begin), trial.truth)
        setpoint = 0.2 + motion.take(every(rig.clock.period, end - begin))
        ahead = excitation.feedforward(setpoint, rig.clock.period)
        plan = bench.Plan(ahead, setpoint, LOOP_GAIN, float(setpoint[0]))
        columns = recorded(trial, truth, plan, end - begin, for_noise)
        columns["time"] = begin + columns["time"]
        yield {n: v[:-1] for n, v in columns.items()}
