"""Rows that come in, cut into segments; what interrupts them is a state of the stream."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from sms.arrays import Array
from sms.errors import InputError
from sms.io.check import GAP, STEP_RANGE
from sms.io.thinning import FASTEST

SEGMENT = 5.0
"""s: of five windows. A first guess cannot come sooner."""
RUN_UP = 0.1
"""s before them, only to run up what follows the command (libsms/estimation/shooting.hpp)."""
TELLING = 20
"""Rows that tell the step of the log."""

Cause = Literal["gap", "restarted", "unreadable"]
"""Rows are missing; the clock went back; cells that are no numbers."""


@dataclass(frozen=True, eq=False)
class Segment:
    """A stretch of evenly sampled rows: signal -> (n,), SI, "time" among them."""

    signals: Mapping[str, Array]

    @property
    def begin(self) -> float:
        """s, where what is compared begins."""
        return float(self.signals["time"][0]) + RUN_UP

    @property
    def end(self) -> float:
        """s"""
        return float(self.signals["time"][-1])


@dataclass(frozen=True)
class Interruption:
    """Why the rows before and after do not belong together."""

    cause: Cause
    time: float
    """s, of the last row before it."""
    length: float
    """s; negative where the clock went back."""


class Segmenter:
    """Cuts rows into segments. It holds one segment at most, and what `push` was given."""

    def __init__(self) -> None:
        self.step: float | None = None
        """s between two rows; None: not known yet."""
        self._held: dict[str, Array] = {}
        self._time: float | None = None

    def cut(self) -> None:
        """What comes does not follow on what came."""
        self._held, self._time = {}, None

    def push(self, rows: Mapping[str, Array]) -> Iterator[Segment | Interruption]:
        """The segments and interruptions that these rows, signal -> (n,), bring about, in their order."""
        time = np.asarray(rows["time"], dtype=np.float64)
        if time.size == 0:
            return
        good = np.all([np.isfinite(v) for v in rows.values()], axis=0)
        previous = np.nan if self._time is None else self._time
        steps = np.diff(time, prepend=previous)
        if self.step is None:
            self._measure_step(time[good])
        limit = np.inf if self.step is None else GAP * self.step
        with np.errstate(invalid="ignore"):
            cut = ~good | (steps < 0.0) | (steps > limit)
        first = 0
        for k in [*np.flatnonzero(cut).tolist(), time.size]:
            if k > first:
                yield from self._append({n: v[first:k] for n, v in rows.items()})
            first = k
            if k == time.size:
                break
            if not good[k]:
                first = k + 1
            if self._held or good[k]:
                yield self._interrupted(time, good, steps, k)
        self._time = float(time[-1]) if np.isfinite(time[-1]) else self._time

    def _interrupted(self, time: Array, good: Array, steps: Array, k: int) -> Interruption:
        self._held = {}
        cause: Cause = "unreadable" if not good[k] else "restarted" if steps[k] < 0.0 else "gap"
        before = time[k] - steps[k]
        length = float(steps[k]) if np.isfinite(steps[k]) else 0.0
        return Interruption(cause, float(before) if np.isfinite(before) else 0.0, length)

    def _measure_step(self, time: Array) -> None:
        forward = np.diff(time)
        forward = forward[forward > 0.0]
        if forward.size < TELLING:
            return
        step = float(np.median(forward))
        if not STEP_RANGE[0] <= step <= STEP_RANGE[1]:
            raise InputError(
                f"the rows come {step:g} s apart, unlikely for a machine; check the unit of the column of time"
            )
        self.step = step

    def _append(self, rows: Mapping[str, Array]) -> Iterator[Segment]:
        old = self._held
        held = {n: np.concatenate([old[n], v]) if old else v for n, v in rows.items()}
        fresh = (
            np.diff(held["time"], prepend=-np.inf) > 0.0
        )  # a row that is there twice counts once
        self._held = held if fresh.all() else {n: v[fresh] for n, v in held.items()}
        if self.step is None:
            self._measure_step(self._held["time"])
        if self.step is None:
            return
        every = max(1, round(1.0 / (FASTEST * self.step)))
        step = every * self.step
        length = every * (round((SEGMENT + RUN_UP) / step) + 1)
        kept = every * (round(RUN_UP / step) + 1)
        while self._held["time"].size >= length:
            yield Segment({n: v[:length:every].copy() for n, v in self._held.items()})
            self._held = {n: v[length - kept :].copy() for n, v in self._held.items()}
