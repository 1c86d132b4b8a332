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


def make_run(rig: Rig, record: Record) -> Run:
    """A record with its pressures absolute."""
    ambient = rig.declared("ambient_pressure").value
    signals = {
        name: values + (ambient if name in record.gauge else 0.0)
        for name, values in record.signals.items()
    }
    source = next(s for s in rig.records if s.name == record.name)
    return Run(
        record.name,
        record.role,
        signals.pop("time"),
        signals,
        record.gauge,
        {n: v - rig.declared(n).value for n, v in source.conditions.items()},
    )
