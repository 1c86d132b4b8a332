"""The rig "cylinder": a force balance fed with measured motion and pressures; the load cell is what it predicts.

The motion is derived from the position. A window is a stroke, a run of samples in one direction; samples between
strokes are not compared. Nothing is simulated, so a fit is the core's own (Ceres), and residuals stay in newtons: their
noise is what differs between strokes over the same ground (diagnosis/adequacy/repeatability.py).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from sms import _core
from sms.arrays import Array, Index
from sms.errors import InputError
from sms.estimation.kind import Kind
from sms.estimation.least_squares import Free, Solution
from sms.estimation.problem import Problem, WindowProblem
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.records import Record
from sms.io.rig import Rig

SMOOTHING_TIME = 0.15
"""s: length of the local parabola from which velocity and acceleration are taken."""
MOST_GAPS = 10.0
"""Times its samples that a record may last at their median step: beyond, it is mostly gaps."""
SHORTEST_STROKE = 10
"""samples: what moves one way for less is a jerk at the reversal, not a stroke."""


@dataclass(frozen=True, eq=False)
class Motion(Run):
    """A run with its derived motion. Arrays (n,) over all samples of the file, SI."""

    velocity: Array
    acceleration: Array
    used: NDArray[np.bool_]
    """Samples that are compared: moving, part of a stroke, not among the first that are skipped."""
    stroke: Index
    """Number of the stroke each sample belongs to, counted from 0; -1 where `used` is false."""


def derive_motion(time: Array, position: Array) -> tuple[Array, Array]:
    """Velocity and acceleration of a sampled position, both (n,).

    A parabola is fitted over SMOOTHING_TIME around each sample, on the even grid of the median step
    (loggers jitter), and read back at the measured times.
    """
    step = float(np.median(np.diff(time)))
    if (duration := float(time[-1] - time[0])) > MOST_GAPS * step * len(time):
        widest = int(np.argmax(np.diff(time)))
        raise InputError(
            f"{len(time)} samples, {step:g} s apart in the median, span {duration:g} s: a velocity cannot be derived "
            f"across the gap behind {time[widest]:g} s; split the record there, or repair its time"
        )
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
    signals = dict(record.signals)
    time = signals.pop("time")
    velocity, acceleration = derive_motion(time, signals["extension"])
    moving = np.abs(velocity) > (rig.speed_above or 0.0)
    moving[: rig.skip_first] = False
    stroke = number_strokes(moving, velocity)
    return Motion(
        name=record.name,
        role=record.role,
        time=time,
        signals=signals,
        gauge=record.gauge,
        conditions={},
        velocity=velocity,
        acceleration=acceleration,
        used=stroke >= 0,
        stroke=stroke,
    )


def whole(run: Run) -> Motion:
    """All samples as one stroke."""
    motion = _motion(run)
    n = len(motion.time)
    return replace(motion, used=np.ones(n, dtype=np.bool_), stroke=np.zeros(n, dtype=np.int64))


def motions_of(runs: Runs) -> tuple[Motion, ...]:
    """The runs of a cylinder with their motion."""
    return tuple(_motion(run) for run in runs.motions)


def _motion(run: Run) -> Motion:
    assert isinstance(run, Motion)
    return run


# ---- the problem ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class Stroke:
    """A window: a run of samples in one direction."""

    record: int
    first: int
    samples: int
    row: int

    @property
    def rows(self) -> int:
        return self.samples


class Balance:
    """The force balance over the strokes of some runs, as a WindowProblem. Residuals in N: predicted less measured."""

    def __init__(self, motions: Sequence[Motion]) -> None:
        self.core = _core.CylinderProblem([core_record(m, m.used) for m in motions])
        self.windows = strokes_of(motions)

    @property
    def rows(self) -> int:
        return int(self.core.rows)

    def settle(self, params: _core.Params) -> None:
        """Nothing to do: a balance has no initial state."""

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        """Residual (rows,) and Jacobian (rows, free)."""
        return self.core.evaluate(params, free)

    def errors(self, params: _core.Params) -> Array:
        """(rows,): the residual; a balance has no initial state."""
        return np.asarray(self.evaluate(params)[0])

    def hidden(self, params: _core.Params, knots: int) -> Array:
        """(rows, 0): what is not simulated has no unknown input."""
        return np.empty((self.rows, 0))

    def jumps(self, params: _core.Params) -> Array:
        """(rows, 0): nor commands."""
        return np.empty((self.rows, 0))


def strokes_of(motions: Sequence[Motion]) -> list[Stroke]:
    """The strokes of all runs, in the order of their rows."""
    strokes, row = [], 0
    for record, motion in enumerate(motions):
        for number in np.unique(motion.stroke[motion.used]):
            places = np.flatnonzero(motion.stroke == number)
            strokes.append(Stroke(record, int(places[0]), len(places), row))
            row += len(places)
    return strokes


def rows_of(motions: Sequence[Motion]) -> tuple[Index, Index]:
    """(rows,) each: which record a compared sample belongs to, and which stroke, numbered through all records."""
    strokes = strokes_of(motions)
    samples = [s.samples for s in strokes]
    record = np.repeat(np.array([s.record for s in strokes], dtype=np.int64), samples)
    return record, np.repeat(np.arange(len(strokes), dtype=np.int64), samples)


def core_record(motion: Motion, rows: NDArray[np.bool_] | slice) -> _core.CylinderRecord:
    """Some samples of a run as the core takes them."""
    signals = {name: values[rows] for name, values in motion.signals.items()}
    return _core.CylinderRecord(
        extension=signals["extension"],
        velocity=motion.velocity[rows],
        acceleration=motion.acceleration[rows],
        pressure_lower=signals["chamber_pressure_lower"],
        pressure_upper=signals.get("chamber_pressure_upper", np.empty(0)),
        rod_force=signals["rod_force"],
        gauge_lower="chamber_pressure_lower" in motion.gauge,
        gauge_upper="chamber_pressure_upper" in motion.gauge,
        time=motion.time[rows],
    )


def _make_problem(
    rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
) -> WindowProblem:
    return Balance([_motion(run) for run in runs])


def _solve(problem: Problem, initial: _core.Params, free: list[Free]) -> Solution:
    assert isinstance(problem, Balance)
    return _core.fit(problem.core, initial, [(f.name, f.lower, f.upper, f.pull) for f in free])


def _derived(run: Run) -> dict[str, Array]:
    velocity = _motion(run).velocity
    return {"velocity [m/s]": velocity, "direction": np.sign(velocity)}


CYLINDER = Kind(
    outputs=("rod_force",),
    hidden={},
    make_problem=_make_problem,
    derived=_derived,
    shown=("extension", "chamber_pressure_lower", "chamber_pressure_upper"),
    menu=(),
    whitened=False,
    make_run=prepare,
    solve=_solve,
    whole=whole,
)
