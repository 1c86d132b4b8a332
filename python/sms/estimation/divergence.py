"""A simulation that runs away, held within numbers.

Records of another machine, or a rig file that is wrong by a factor, lead a fit to parameters at which a window's
simulation grows without bound: its derivatives first, by a hundred decades within a second, then itself. Linear algebra
ends there. Such a window tells where a fit must not go, and nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.arrays import Array
from sms.estimation.problem import Window, WindowProblem
from sms.parameters import Parameter

LARGEST = 1e6
"""Of a residual, in units of the noise: what no sensor's range holds."""
STEEPEST = 1e9
"""Of a derivative, in units of the noise over the parameter's whole range: a millionth of that range would move
readings by as much as no fit can follow, and one such window would outweigh all others. Numerics: windows that do not
diverge stay below 1e8."""
FARTHER_THAN_OTHERS = 1e6
"""Of a window's derivative per unit of a hidden input, whose range nobody knows: over the median window's. Numerics:
the noise, one in these units, is added to its square, and is still there in a double."""


@dataclass(frozen=True, eq=False)
class WithinNumbers:
    """A window problem whose windows that run away have large errors, and no slope."""

    problem: WindowProblem
    table: Mapping[str, Parameter]
    """Of its parameters, for their ranges."""

    @property
    def rows(self) -> int:
        return self.problem.rows

    @property
    def windows(self) -> Sequence[Window]:
        return self.problem.windows

    def settle(self, params: _core.Params) -> None:
        """As WindowProblem has it."""
        self.problem.settle(params)

    def evaluate(self, params: _core.Params, free: Sequence[str] = ()) -> tuple[Array, Array]:
        """Residual (rows,) and Jacobian (rows, free), as WindowProblem has them; all of them finite."""
        residual, jacobian = self.problem.evaluate(params, free)
        ranges = np.array([self.table[n].upper - self.table[n].lower for n in free])
        return _held(residual), self._flat_where_steep(jacobian, STEEPEST / ranges)

    def errors(self, params: _core.Params) -> Array:
        """(rows,), as WindowProblem has them; all of them finite."""
        return _held(self.problem.errors(params))

    def hidden(self, params: _core.Params, knots: int) -> Array:
        """(rows, hidden inputs x knots), as WindowProblem has them; all of them finite, and none beyond comparison."""
        inputs = self.problem.hidden(params, knots)
        if not self.windows:
            return inputs
        farthest = [np.max(np.abs(inputs[w.row : w.row + w.rows]), axis=0) for w in self.windows]
        usual = np.quantile(np.nan_to_num(farthest, nan=np.inf), 0.5, axis=0, method="lower")
        steepest = np.where(usual > 0.0, FARTHER_THAN_OTHERS * usual, np.inf)
        return self._flat_where_steep(inputs, np.minimum(steepest, np.finfo(float).max))

    def jumps(self, params: _core.Params) -> Array:
        """(rows, jumps), as WindowProblem has them; all of them finite."""
        return np.nan_to_num(self.problem.jumps(params), nan=0.0, posinf=0.0, neginf=0.0)

    def _flat_where_steep(self, jacobian: Array, steepest: Array) -> Array:
        for w in self.windows:
            rows = slice(w.row, w.row + w.rows)
            if not np.all(np.abs(jacobian[rows]) < steepest):
                jacobian[rows] = 0.0
        return jacobian


def _held(residual: NDArray[np.float64]) -> Array:
    return np.clip(np.nan_to_num(residual, nan=LARGEST), -LARGEST, LARGEST)
