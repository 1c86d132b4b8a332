"""One record, evenly sampled, as a simulation takes it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from sms.arrays import Array
from sms.io.clipping import clipped_of
from sms.io.records import Record
from sms.io.rig import Rig
from sms.io.signal_sources import Hold


@dataclass(frozen=True, eq=False)
class Run:
    """One record, evenly sampled. Arrays (n,), SI."""

    name: str
    role: str
    time: Array
    signals: dict[str, Array]
    gauge: frozenset[str]
    conditions: dict[str, float]
    """Parameter -> by how much it is larger in this run."""
    hold: Hold = field(default="linear", kw_only=True)
    """What the command does between two samples: it goes straight to the next, stays at the previous one, or goes
    straight but where it jumps (libsms/estimation/recorded.hpp)."""
    window: float | None = field(default=None, kw_only=True)
    """s: of the windows it is cut into; None: as its kind has it."""
    clipped: Mapping[str, NDArray[np.bool_]] = field(default_factory=dict, kw_only=True)
    """Signal -> (n,) samples at which its reading is at the end of its sensor's range; only signals that have such."""
    commanded: bool = field(default=False, kw_only=True)
    """The command is taken from the record, although the controller of other records is simulated."""

    jump_deviation: float = field(default=0.0, kw_only=True)
    """s: how nearly the record tells when its commands jumped, as a standard deviation; 0: each is known."""
    ahead: Array | None = field(default=None, kw_only=True)
    """(n, commands), s: by how much the jump that a sample shows came ahead of it (jump_times.py)."""

    def part(self, samples: slice) -> Run:
        """Some of its samples, in a row."""
        return replace(
            self,
            time=self.time[samples],
            signals={n: v[samples] for n, v in self.signals.items()},
            clipped={n: c[samples] for n, c in self.clipped.items()},
            ahead=None if self.ahead is None else self.ahead[samples],
        )

    def compared(self, signal: str) -> Array:
        """(n,): the readings, NaN where nothing is known but that the truth lies beyond the sensor's range."""
        values, at_end = self.signals[signal], self.clipped.get(signal)
        return values if at_end is None or at_end.all() else np.where(at_end, np.nan, values)

    @property
    def step(self) -> float:
        return float((self.time[-1] - self.time[0]) / (len(self.time) - 1))

    def rate(self, signal: str) -> Array:
        """Of a signal, by local parabolas over 50 ms, in its unit per second."""
        width = max(5, 2 * round(0.025 / self.step) + 1)
        return np.asarray(savgol_filter(self.signals[signal], width, 2, 1, self.step))


HELD = 0.9
"""Share of the samples that repeat the one before, from which a command counts as held between samples."""


CLOCKS = 0.01
"""By how much the rates of two clocks differ at most where they are meant to be the same: quartz keeps 1e-4, an RC
oscillator 1e-2."""


def is_held(command: Array) -> bool:
    """Whether a command goes in steps: it mostly repeats, and where it changes it does so between two samples."""
    moves = np.diff(command) != 0.0
    in_a_row = np.sum(moves[1:] & moves[:-1])
    return bool(0.0 < np.mean(moves) < 1.0 - HELD and in_a_row < (1.0 - HELD) * np.sum(moves))


def hold_of(rig: Rig, commands: Mapping[str, Array], step: float) -> tuple[Hold, float]:
    """What these commands do between their samples: as the rig file says, else as the record looks; and how nearly it
    is known when they jump, s.

    step, s, is the record's. A logger at the controller's rate has every command that it held. One that is slower shows
    a jump up to a sampling period after it came: the standard deviation is that of an even distribution.
    """
    said = next((h for name in commands if (h := rig.signals[name].hold) is not None), None)
    is_logged = "control_period" in rig.table and math.isclose(
        step, rig.declared("control_period").value, rel_tol=CLOCKS
    )
    if not commands or is_logged or said in ("previous", "linear"):
        return said or ("previous" if is_logged else "stepped"), 0.0
    held: Hold = "previous" if all(map(is_held, commands.values())) else "stepped"
    return said or held, step / math.sqrt(12.0)


def make_run(rig: Rig, record: Record) -> Run:
    """A record with its pressures absolute."""
    ambient = rig.declared("ambient_pressure").value
    signals = {
        name: values + (ambient if name in record.gauge else 0.0)
        for name, values in record.signals.items()
    }
    source = next(s for s in rig.records if s.name == record.name)
    time = signals.pop("time")
    commands = {n: v for n, v in signals.items() if n.startswith("valve_command")}
    hold, deviation = hold_of(rig, commands, float((time[-1] - time[0]) / (len(time) - 1)))
    return Run(
        record.name,
        record.role,
        time,
        signals,
        record.gauge,
        {n: v - rig.declared(n).value for n, v in source.conditions.items()},
        hold=hold,
        jump_deviation=deviation,
        clipped=clipped_of(rig, record.signals),
        commanded=rig.control.controller == "simulated" and source.control.controller == "recorded",
    )
