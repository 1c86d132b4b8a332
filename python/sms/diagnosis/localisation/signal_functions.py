"""Terms of an equation that follow a signal: functions over its quantiles, and what they do to the predictions.

A function is a chain of straight lines. Its sensitivity is put together from those to an input at points of time
(Runs.problem.hidden) and the function's values there.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from sms.arrays import Array
from sms.diagnosis.thresholds import MOVES, PIECES
from sms.estimation.discrepancy import KNOTS
from sms.estimation.windows import Runs
from sms.io.signals import LEGS


def signals_of(runs: Runs) -> dict[str, Array]:
    """What a hidden term may follow: (rows,) each.

    Not a signal that hardly moves: its readings are noise, and an error of that reading would follow them of itself.
    """
    wanted = runs.inputs

    def moves(name: str) -> bool:
        low, high = np.quantile(wanted[name], [0.05, 0.95])
        return bool(high - low > MOVES * runs.noise.get(name.partition(" [")[0], 0.0))

    left_out = ("direction", "supply", "setpoint")
    names = [n for n in wanted if not n.startswith(left_out) and moves(n)]
    return {n: wanted[n] for n in names}


def hats(values: Array, at: Array) -> Array:
    """(n, pieces): the chain of straight lines that is one at each point of `at` in turn."""
    at = at + 1e-9 * np.ptp(at) * np.arange(len(at))
    return np.column_stack([np.interp(values, at, row) for row in np.eye(len(at))])


def points(values: Array) -> Array:
    """Where the pieces meet: even in rank, so that each has data."""
    return np.asarray(np.quantile(values, np.linspace(0.005, 0.995, PIECES)))


# ---- through the plant ---------------------------------------------------------------------------------


def of_input(hidden: Array, number: int) -> Array:
    """(rows, KNOTS): of one equation, from the sensitivities (rows, equations * KNOTS) of all."""
    return np.asarray(hidden[:, number * KNOTS : (number + 1) * KNOTS])


def through_plant(runs: Runs, hidden: Array, functions: Array) -> Array:
    """(rows, pieces): sensitivity to a hidden input that follows functions (rows, pieces) of a signal.

    hidden: (rows, KNOTS), that to its values at points of time.
    """
    out = np.zeros((len(hidden), functions.shape[1]))
    for w, values in zip(runs.problem.windows, at_knots(runs, functions), strict=True):
        rows = slice(w.row, w.row + w.rows)
        out[rows] = hidden[rows] @ values
    return out


def at_knots(runs: Runs, functions: Array) -> Array:
    """(windows, KNOTS, pieces): functions (rows, pieces) of a signal at the points of time of each window."""
    channels, out = len(runs.channels), []
    for w in runs.problem.windows:
        of_samples = functions[w.row : w.row + w.rows][::channels]
        place = np.linspace(0, w.samples - 1, KNOTS)
        # The mean around a knot, so that a term that jumps at a reversal is not caught by one sample.
        half = max(1, round(0.5 * (w.samples - 1) / (KNOTS - 1)))
        out.append(
            [of_samples[max(0, round(p) - half) : round(p) + half + 1].mean(axis=0) for p in place]
        )
    return np.array(out)


# ---- machines with legs ----------------------------------------------------------------------------------

_LEG = re.compile(r"(?: of leg |_)([123])(?= \[|$)")


def leg_of(name: str) -> str:
    """ "velocity_2 [m/s]", "force of leg 2" -> "2"; empty for what has no leg."""
    found = _LEG.search(name)
    return found[1] if found else ""


def without_leg(name: str) -> str:
    """ "velocity_2 [m/s]" -> "velocity [m/s]"."""
    return _LEG.sub("", name)


def belong_together(equation: str, signal: str) -> bool:
    """Whether a term of this equation may follow this signal: another leg's it does not."""
    return not leg_of(signal) or leg_of(equation) == leg_of(signal)


def alike(equations: Sequence[str]) -> dict[str, list[int]]:
    """Equations that every leg has, as one for all legs: "force" -> where those of legs 1, 2, 3 stand."""
    found: dict[str, list[int]] = {}
    for number, equation in enumerate(equations):
        if leg_of(equation):
            found.setdefault(without_leg(equation), []).append(number)
    return found


def alike_signals(signals: Mapping[str, Array]) -> dict[str, list[Array]]:
    """ "velocity [m/s]" -> that of each leg; what has no leg is the same for all."""
    found: dict[str, list[Array]] = {}
    for name, values in signals.items():
        found.setdefault(without_leg(name), []).extend(
            [values] * (1 if leg_of(name) else len(LEGS))
        )
    return found
