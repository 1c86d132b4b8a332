"""Through time with scipy's integrators at a tolerance of 1e-10, from one held command to the next.

Every change of a command starts the integrator anew, so that no step contains a jump. Within a
hold only the integrator's own step ends are its solution; values between them come from its dense
output, which for Radau is too coarse: with it every sample is a step end. On the bench LSODA, DOP853
and Radau agree with each other to about 1e-7 at this tolerance, LSODA being the nearest to where
they all go.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp

from validation.reference.plants.flow import Array

Rate = Callable[[Array, Array], Array]
"""dy/dt from a state and a command."""
Method = Literal["LSODA", "DOP853", "Radau"]
TOLERANCE = 1e-10


def follow(
    rate: Rate,
    start: Array,
    commands: Array,
    period: float,
    scale: Array,
    *,
    delay: float = 0.0,
    before: Array | None = None,
    method: Method = "LSODA",
    tolerance: float = TOLERANCE,
) -> Array:
    """States at the beginning of every period, (n, states), under commands (n, width).

    Each command is held for one `period` [s] and arrives `delay` [s] late; until then there is
    `before`. Equal ones in a row are one hold. `scale` are magnitudes of the states below which
    the tolerance counts as absolute.
    """
    states = np.empty((len(commands), start.size))
    states[0] = start
    y, now = start, 0.0
    end = (len(commands) - 1) * period
    for over, command in _holds(commands, period, delay, before, method == "Radau"):
        until = min(over, end)
        first = int(np.floor(now / period + 1e-9)) + 1
        last = int(np.floor(until / period + 1e-9))
        inside = np.arange(first, last + 1)
        times = np.append(period * inside - now, until - now)

        def rate_now(_time: float, y: Array, held: Array = command) -> Array:
            return rate(y, held)

        solution = solve_ivp(
            rate_now,
            (0.0, until - now),
            y,
            method,
            np.unique(np.clip(times, 0.0, until - now)),
            rtol=tolerance,
            atol=tolerance * scale,
        )
        if not solution.success:
            raise RuntimeError(f"the reference stopped at {now:g} s: {solution.message}")
        states[first : last + 1] = solution.y.T[: inside.size]
        y, now = solution.y[:, -1], until
        if until >= end:
            break
    return states


def _holds(
    commands: Array, period: float, delay: float, before: Array | None, every_period: bool
) -> Iterator[tuple[float, Array]]:
    """Until when [s] which command is there."""
    held = commands[0] if before is None else before
    if delay > 0.0:
        yield delay, held
    for k in range(len(commands)):
        ends = k + 1 == len(commands) or not np.array_equal(commands[k + 1], commands[k])
        if ends or every_period:
            yield (k + 1) * period + delay, commands[k]
