"""A problem's windows without those of which too much is at the end of a sensor's range.

A clipped reading is compared with nothing (Run.compared). But of a signal that is mostly clipped the initial state is
not known, and along the extension the motion is followed sample by sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.estimation.problem import Window, WindowProblem
from sms.estimation.run import Run
from sms.io.signals import without_leg

MOST_CLIPPED = 0.5
"""Share of a window's samples of one signal. Judgement: half of them tell its initial value."""


@dataclass(frozen=True)
class Kept:
    """A window of another problem, its residuals elsewhere."""

    record: int
    first: int
    samples: int
    row: int
    rows: int


@dataclass(frozen=True, eq=False)
class ChosenWindows:
    """Some windows of a problem, in its order."""

    problem: WindowProblem
    chosen: tuple[int, ...]

    @cached_property
    def windows(self) -> Sequence[Window]:
        """The chosen ones, their rows one after the other."""
        found, row = [], 0
        for number in self.chosen:
            w = self.problem.windows[number]
            found.append(Kept(w.record, w.first, w.samples, row, w.rows))
            row += w.rows
        return found

    @cached_property
    def _rows(self) -> Index:
        """(rows,): of the whole problem."""
        whole = self.problem.windows
        parts = [np.arange(whole[n].row, whole[n].row + whole[n].rows) for n in self.chosen]
        return np.concatenate(parts) if parts else np.empty(0, dtype=np.int64)

    @property
    def rows(self) -> int:
        return len(self._rows)

    def settle(self, params: _core.Params) -> None:
        """As WindowProblem has it."""
        self.problem.settle(params)

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        """Residual (rows,) and Jacobian (rows, free), as WindowProblem has them."""
        residual, jacobian = self.problem.evaluate(params, free)
        return residual[self._rows], jacobian[self._rows]

    def errors(self, params: _core.Params) -> Array:
        """(rows,), as WindowProblem has them."""
        return self.problem.errors(params)[self._rows]

    def hidden(self, params: _core.Params, knots: int) -> Array:
        """(rows, hidden inputs x knots), as WindowProblem has them."""
        return self.problem.hidden(params, knots)[self._rows]

    def jumps(self, params: _core.Params) -> Array:
        """(rows, jumps), as WindowProblem has them."""
        return self.problem.jumps(params)[self._rows]


def without_clipped(problem: WindowProblem, runs: Sequence[Run]) -> WindowProblem:
    """The problem without windows that clipped readings spoil; itself where there are none."""

    def is_spoilt(w: Window) -> bool:
        return any(
            c[w.first : w.first + w.samples].mean() > (0.0 if is_path(n) else MOST_CLIPPED)
            for n, c in runs[w.record].clipped.items()
        )

    windows = problem.windows
    chosen = tuple(k for k, w in enumerate(windows) if not is_spoilt(w))
    return problem if len(chosen) == len(windows) else ChosenWindows(problem, chosen)


def is_path(signal: str) -> bool:
    """Whether a simulation follows the readings themselves."""
    return without_leg(signal) == "extension"
