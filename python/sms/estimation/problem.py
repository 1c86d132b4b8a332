"""A model held against measured records: residuals in units of the noise, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeGuard

import numpy as np
from numpy.typing import NDArray

from sms import _core


class Problem(Protocol):
    """A model held against measured records."""

    @property
    def rows(self) -> int:
        """Number of residuals."""
        ...

    def evaluate(
        self, params: _core.Params, free: Sequence[str] = ...
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Residual (rows,), predicted less measured over the noise, and Jacobian (rows, free).

        Both are the caller's to change.
        """
        ...


class Window(Protocol):
    """A stretch of a record that is simulated from an initial state of its own."""

    @property
    def record(self) -> int: ...
    @property
    def first(self) -> int:
        """Its first sample in the record."""
        ...

    @property
    def samples(self) -> int: ...
    @property
    def row(self) -> int:
        """Where its residuals begin: for each sample, each output."""
        ...

    @property
    def rows(self) -> int: ...


class WindowProblem(Problem, Protocol):
    """A simulation held against records window by window, each from the initial state that fits it best."""

    @property
    def windows(self) -> Sequence[Window]: ...

    def settle(self, params: _core.Params) -> None:
        """Let later searches for initial states begin at the best ones of these parameters."""
        ...

    def errors(self, params: _core.Params) -> NDArray[np.float64]:
        """(rows,): predicted less measured over the noise, at the best initial states."""
        ...

    def hidden(self, params: _core.Params, knots: int) -> NDArray[np.float64]:
        """(rows, hidden inputs x knots): derivatives against hidden inputs, linear between knots in each window."""
        ...

    def jumps(self, params: _core.Params) -> NDArray[np.float64]:
        """(rows, jumps): derivatives against the times, s, by which jumps of the command come ahead of the sample that
        shows them, in each window."""
        ...


def is_commanded(
    problem: WindowProblem,
) -> TypeGuard[_core.BenchProblem | _core.PlatformProblem | _core.TankPlantProblem]:
    """Whether recorded commands drive its valves."""
    commanded = _core.BenchProblem, _core.PlatformProblem, _core.TankPlantProblem
    return isinstance(problem, commanded)
