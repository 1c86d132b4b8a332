"""When a cause acts: its sensitivity, put together from those of hidden inputs.

What a leak or a friction does to an equation at one moment, a hidden flow or force does as well
(localisation/unknown_inputs.py). So window by window the hidden inputs are asked which of them, and when, would leave
what the cause leaves. Then it is known when it acted, and "only while the pressure was high" is a sensitivity too: that
of the inputs at those moments, with all that comes of them later.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.arrays import Array
from sms.diagnosis.localisation.signal_functions import at_knots, leg_of, without_leg
from sms.diagnosis.thresholds import CANNOT, INPUT_RIDGE
from sms.estimation.discrepancy import KNOTS
from sms.estimation.windows import Runs


@dataclass(frozen=True)
class Activity:
    """A cause as hidden inputs."""

    runs: Runs
    column: Array
    """(rows,): its sensitivity."""
    hidden: Array
    """(rows, inputs x KNOTS): those of hidden inputs at the knots of their window."""
    size: Array
    """(windows, inputs x KNOTS): the inputs that leave what the cause leaves."""

    def where(self, chosen: NDArray[np.bool_]) -> Array:
        """(rows,): the sensitivity, had the cause acted only at the chosen (windows, inputs x KNOTS)."""
        out = np.empty(len(self.column))
        for w, size in zip(self.runs.problem.windows, self.size * chosen, strict=True):
            rows = slice(w.row, w.row + w.rows)
            out[rows] = self.hidden[rows] @ size
        return out


def activity(runs: Runs, params: _core.Params, column: Array) -> Activity | None:
    """When a cause acts whose sensitivity is column (rows,); None where it does not act on the equations' inputs."""
    hidden = runs.problem.hidden(params, KNOTS)
    scale = np.maximum(np.linalg.norm(hidden, axis=0), 1e-300)
    size, missed = [], 0.0
    for w in runs.problem.windows:
        rows = slice(w.row, w.row + w.rows)
        a = hidden[rows] / scale
        gram = a.T @ a
        ridge = INPUT_RIDGE * np.trace(gram) / len(gram) * np.eye(len(gram))
        # Nothing is read of an input in a window whose readings are masked, or where the load rests, held by friction.
        x = np.linalg.solve(gram + ridge, a.T @ column[rows]) if a.any() else np.zeros(len(gram))
        missed += float(np.sum((column[rows] - a @ x) ** 2))
        size.append(x / scale)
    if missed > CANNOT * float(column @ column):
        return None
    return Activity(runs, column, hidden, np.array(size))


def own_signals(runs: Runs, signals: Mapping[str, Array]) -> dict[str, Array]:
    """Signals (rows,) at the knots, (windows, inputs x KNOTS) each: for an input of a leg, that leg's own signal."""
    inputs = [leg_of(equation) for equation in runs.kind.hidden]
    of_legs: dict[str, dict[str, Array]] = {}
    for name, values in signals.items():
        own = without_leg(name) if any(inputs) else name
        knots = at_knots(runs, values[:, None])[:, :, 0]
        of_legs.setdefault(own, {})[leg_of(name) if any(inputs) else ""] = knots
    return {
        name: np.hstack([knots[leg if leg in knots else ""] for leg in inputs])
        for name, knots in of_legs.items()
        if "" in knots or all(leg in knots for leg in inputs)
    }
