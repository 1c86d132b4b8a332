"""Measured records as the core's problem: motion derived from the position, strokes found, samples chosen."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from sms import _core
from sms.arrays import Array
from sms.estimation.block_statistics import merge_strokes
from sms.io.errors import InputError
from sms.io.records import Record
from sms.io.rig import Rig

SMOOTHING_TIME = 0.15
"""s: length of the local parabola from which velocity and acceleration are taken."""
SHORTEST_STROKE = 10
"""samples: what moves one way for less is a jerk at the reversal, not a stroke."""


@dataclass(frozen=True)
class Motion:
    """One record with its derived motion. Arrays (n,) over all samples of the file, SI."""

    name: str
    role: str
    time: Array
    velocity: Array
    acceleration: Array
    signals: dict[str, Array]
    gauge: frozenset[str]
    used: NDArray[np.bool_]
    """Samples that are compared: moving, part of a stroke, not among the first that are skipped."""
    stroke: NDArray[np.int64]
    """Number of the stroke each sample belongs to, counted from 0; -1 where `used` is false."""


def derive_motion(time: Array, position: Array) -> tuple[Array, Array]:
    """Velocity and acceleration of a sampled position, both (n,).

    A parabola is fitted over SMOOTHING_TIME around each sample, on the even grid of the median step
    (loggers jitter), and read back at the measured times.
    """
    step = float(np.median(np.diff(time)))
    grid = np.arange(time[0], time[-1] + step, step)
    window = max(5, 2 * round(0.5 * SMOOTHING_TIME / step) + 1)
    if window > len(grid):
        raise InputError(
            f"{len(grid)} samples are too few to derive a velocity, {window} are needed"
        )
    even = np.interp(grid, time, position)
    velocity = savgol_filter(even, window, 2, deriv=1, delta=step)
    acceleration = savgol_filter(even, window, 2, deriv=2, delta=step)
    return np.interp(time, grid, velocity), np.interp(time, grid, acceleration)


def number_strokes(moving: NDArray[np.bool_], direction: Array) -> NDArray[np.int64]:
    """Runs of moving samples in one direction, numbered from 0; -1 between them and for short ones."""
    key = np.where(moving, np.sign(direction), 0.0)
    starts = np.flatnonzero(np.concatenate(([True], key[1:] != key[:-1])))
    stroke = np.full(len(key), -1, dtype=np.int64)
    number = 0
    for begin, end in zip(starts, [*starts[1:], len(key)], strict=True):
        if key[begin] != 0.0 and end - begin >= SHORTEST_STROKE:
            stroke[begin:end] = number
            number += 1
    return stroke


def prepare(rig: Rig, record: Record) -> Motion:
    """Derive the motion of one record and choose the samples that are compared."""
    time = record.signals["time"]
    extension = record.signals["extension"]
    velocity, acceleration = derive_motion(time, extension)
    moving = np.abs(velocity) > (rig.speed_above or 0.0)
    moving[: rig.skip_first] = False
    stroke = number_strokes(moving, velocity)
    return Motion(
        name=record.name,
        role=record.role,
        time=time,
        velocity=velocity,
        acceleration=acceleration,
        signals=dict(record.signals),
        gauge=record.gauge,
        used=stroke >= 0,
        stroke=stroke,
    )


@dataclass(frozen=True)
class Comparison:
    """Several records as one problem of the core, with what a judgement needs to know of each row."""

    motions: tuple[Motion, ...]
    strokes_per_block: int = 1

    whitened = False
    """Residuals are in the unit of the signal."""

    @cached_property
    def problem(self) -> _core.Problem:
        return _core.CylinderProblem([_cylinder_record(m, m.used) for m in self.motions])

    @cached_property
    def record(self) -> NDArray[np.int64]:
        """(rows,): which record a row belongs to."""
        return np.repeat(np.arange(len(self.motions)), [int(m.used.sum()) for m in self.motions])

    @cached_property
    def stroke(self) -> NDArray[np.int64]:
        """(rows,): which stroke, numbered through all records."""
        numbers, offset = [], 0
        for m in self.motions:
            numbers.append(m.stroke[m.used] + offset)
            offset += int(m.stroke.max(initial=-1)) + 1
        return np.concatenate(numbers)

    @cached_property
    def block(self) -> NDArray[np.int64]:
        """(rows,): which block of strokes in a row; what judgements resample (estimation/block_statistics.py)."""
        return merge_strokes(self.record, self.stroke, self.strokes_per_block)

    @cached_property
    def inputs(self) -> dict[str, Array]:
        """(rows,) each: the signals along which a residual may be arranged, SI."""
        return {
            name: np.concatenate([inputs_of(m)[name][m.used] for m in self.motions])
            for name in inputs_of(self.motions[0])
        }

    def part(self, number: int) -> Comparison:
        """One of the records alone."""
        return Comparison((self.motions[number],), self.strokes_per_block)


def inputs_of(motion: Motion) -> dict[str, Array]:
    """The signals of one record against which a residual is looked at, name with unit -> (n,)."""
    inputs = {
        "extension [m]": motion.signals["extension"],
        "velocity [m/s]": motion.velocity,
        "direction": np.sign(motion.velocity),
    }
    for name, values in motion.signals.items():
        if name.startswith("chamber_pressure"):
            inputs[f"{name} [Pa]"] = values
    return inputs | {"time [s]": motion.time}


def _cylinder_record(motion: Motion, rows: NDArray[np.bool_]) -> _core.CylinderRecord:
    signals = {name: values[rows] for name, values in motion.signals.items()}
    upper = signals.get("chamber_pressure_upper", np.empty(0))
    return _core.CylinderRecord(
        extension=signals["extension"],
        velocity=motion.velocity[rows],
        acceleration=motion.acceleration[rows],
        pressure_lower=signals["chamber_pressure_lower"],
        pressure_upper=upper,
        rod_force=signals["rod_force"],
        gauge_lower="chamber_pressure_lower" in motion.gauge,
        gauge_upper="chamber_pressure_upper" in motion.gauge,
    )


def predict(motion: Motion, params: _core.Params) -> Array:
    """The reading of the load cell that the model predicts, N, over all samples (n,)."""
    rows = np.ones(len(motion.time), dtype=np.bool_)
    residual, _ = _core.CylinderProblem([_cylinder_record(motion, rows)]).evaluate(params)
    return np.asarray(residual + motion.signals["rod_force"])


def with_role(motions: Iterable[Motion], role: str) -> Sequence[Motion]:
    return [m for m in motions if m.role == role]
