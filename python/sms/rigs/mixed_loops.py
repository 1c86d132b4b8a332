"""Records whose controller is simulated beside records whose command is taken as it was recorded: two problems as one.

Each record is simulated as it would be in a rig file of its own. The rows of a command that nothing computes are zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.estimation.chosen_windows import Kept
from sms.estimation.problem import Window, WindowProblem
from sms.estimation.run import Run
from sms.io.rig import Rig

Maker = Callable[[Rig, Sequence[Run], Sequence[str], Mapping[str, float]], WindowProblem]


@dataclass(frozen=True)
class Part:
    """Some of the records as a problem of their own."""

    problem: WindowProblem
    records: tuple[int, ...]
    """Number of each among all records."""
    channels: int
    """The first so many of all."""


@dataclass(frozen=True, eq=False)
class Mixed:
    """The parts' windows in the order of the records."""

    parts: tuple[Part, ...]
    channels: int
    inputs: int
    """Hidden inputs of the part that has most; those of the others are the first of them."""

    @cached_property
    def _order(self) -> list[tuple[int, int, int]]:
        """Record, part and number in it of each window."""
        return sorted(
            (part.records[w.record], p, k)
            for p, part in enumerate(self.parts)
            for k, w in enumerate(part.problem.windows)
        )

    @cached_property
    def windows(self) -> Sequence[Window]:
        """All windows, their rows one after the other."""
        found, row = [], 0
        for record, p, k in self._order:
            w = self.parts[p].problem.windows[k]
            rows = w.samples * self.channels
            found.append(Kept(record, w.first, w.samples, row, rows))
            row += rows
        return found

    @property
    def rows(self) -> int:
        return sum(w.rows for w in self.windows)

    @cached_property
    def _places(self) -> tuple[Index, ...]:
        """Of each part: where its rows are among all."""
        places: list[list[Index]] = [[] for _ in self.parts]
        for (_, p, _), w in zip(self._order, self.windows, strict=True):
            rows = w.row + np.arange(w.rows, dtype=np.int64).reshape(w.samples, self.channels)
            places[p].append(rows[:, : self.parts[p].channels].ravel())
        return tuple(np.concatenate(p) if p else np.empty(0, dtype=np.int64) for p in places)

    def _together(self, of_parts: Sequence[Array], columns: tuple[int, ...] = ()) -> Array:
        out = np.zeros((self.rows, *columns))
        for places, values in zip(self._places, of_parts, strict=True):
            if columns:
                out[places, : values.shape[1]] = values
            else:
                out[places] = values
        return out

    def settle(self, params: _core.Params) -> None:
        """As WindowProblem has it."""
        for part in self.parts:
            part.problem.settle(params)

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        """Residual (rows,) and Jacobian (rows, free), as WindowProblem has them."""
        residuals, slopes = zip(
            *(p.problem.evaluate(params, free) for p in self.parts), strict=True
        )
        return self._together(residuals), self._together(slopes, (len(free),))

    def errors(self, params: _core.Params) -> Array:
        """(rows,), as WindowProblem has them."""
        return self._together([p.problem.errors(params) for p in self.parts])

    def hidden(self, params: _core.Params, knots: int) -> Array:
        """(rows, hidden inputs x knots), as WindowProblem has them."""
        of_parts = [p.problem.hidden(params, knots) for p in self.parts]
        return self._together(of_parts, (self.inputs * knots,))

    def jumps(self, params: _core.Params) -> Array:
        """(rows, jumps), as WindowProblem has them."""
        of_parts = [p.problem.jumps(params) for p in self.parts]
        return self._together(of_parts, of_parts[0].shape[1:])


def mixed(in_loop: Maker, commanded: Maker, computed: Sequence[str], inputs: int) -> Maker:
    """What makes the problem of any records: in_loop of those whose controller is simulated, commanded of the others.

    computed: outputs that the controller adds, the last ones; inputs: hidden inputs of the first problem.
    """

    def make(
        rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
    ) -> WindowProblem:
        if not any(run.commanded for run in runs):
            return in_loop(rig, runs, channels, noise)
        parts = []
        for maker, taken in ((in_loop, False), (commanded, True)):
            numbers = tuple(k for k, run in enumerate(runs) if run.commanded == taken)
            own = [c for c in channels if not (taken and c in computed)]
            if numbers:
                problem = maker(rig, [runs[k] for k in numbers], own, noise)
                parts.append(Part(problem, numbers, len(own)))
        return Mixed(tuple(parts), len(channels), inputs)

    return make
