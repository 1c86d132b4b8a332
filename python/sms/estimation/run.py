"""One record, evenly sampled, as a simulation takes it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import savgol_filter

from sms.arrays import Array
from sms.io.records import Record
from sms.io.rig import Rig


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

    @property
    def step(self) -> float:
        return float((self.time[-1] - self.time[0]) / (len(self.time) - 1))

    def rate(self, signal: str) -> Array:
        """Of a signal, by local parabolas over 50 ms, in its unit per second."""
        width = max(5, 2 * round(0.025 / self.step) + 1)
        return np.asarray(savgol_filter(self.signals[signal], width, 2, 1, self.step))


HELD = 0.9
"""Share of the samples that repeat the one before, from which a command counts as held between samples."""
DEAD_TIME = {"bench": "command_delay", "platform": "command_delay", "tank": "clock_skew_tank"}


def is_held(command: Array) -> bool:
    """Whether a command goes in steps: each value holds until the next sample, and is no ramp towards it."""
    return bool(np.ptp(command) > 0.0 and np.mean(np.diff(command) == 0.0) > HELD)


def make_run(rig: Rig, record: Record) -> Run:
    """A record with its pressures absolute."""
    ambient = rig.declared("ambient_pressure").value
    signals = {
        name: values + (ambient if name in record.gauge else 0.0)
        for name, values in record.signals.items()
    }
    source = next(s for s in rig.records if s.name == record.name)
    time = signals.pop("time")
    conditions = {n: v - rig.declared(n).value for n, v in source.conditions.items()}
    if rig.kind in DEAD_TIME and all(
        is_held(values) for name, values in signals.items() if name.startswith("valve_command")
    ):
        half = 0.5 * float(time[-1] - time[0]) / (len(time) - 1)
        name = DEAD_TIME[rig.kind]
        conditions[name] = conditions.get(name, 0.0) + half
    return Run(
        record.name,
        record.role,
        time,
        signals,
        record.gauge,
        conditions,
    )
