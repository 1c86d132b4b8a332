"""A problem's windows without those in which a reading is at the end of its sensor's range.

The initial state of a window is that which fits all its samples best, so that a clipped reading spoils all of it.
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


def without_clipped(problem: WindowProblem, runs: Sequence[Run]) -> WindowProblem:
    """The problem where no reading of its runs is clipped; itself where none is anywhere."""
    if all(run.clipped is None for run in runs):
        return problem

    def is_clean(w: Window) -> bool:
        clipped = runs[w.record].clipped
        return clipped is None or not clipped[w.first : w.first + w.samples].any()

    windows = problem.windows
    return ChosenWindows(problem, tuple(k for k, w in enumerate(windows) if is_clean(w)))
