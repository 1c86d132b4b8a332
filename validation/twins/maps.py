"""The maps of one axis as its equations read them: the valve's flow and what friction is off by.

The exact ones are the source's. A machine whose maps are off has its valve's conductances and its sliding friction
multiplied by 1 + a smooth function (imperfection.py), each metering edge and each direction with its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from validation.twins.air import GRID_POINTS, GRID_STEP, Array, valve_map
from validation.twins.seal import SPEED_POINTS, SPEED_STEP, TOP_SPEED

Curve = Callable[[Array], Array]
"""A relative error over the opening (V from the centre, signed) or the speed (m/s, signed)."""


class Maps(NamedTuple):
    """Of one axis, or of several with a leading axis for them."""

    valve: Array  # (2, GRID_POINTS, 5): above and below the centre; columns as air.valve_map
    friction: Array  # (SPEED_POINTS,): relative error of the sliding friction


@cache
def exact(straight: bool = False) -> Maps:
    """The maps as the source has them; the valve's tables are read by Steffen's curve, or straight between rows."""
    return Maps(np.stack([valve_map(straight)] * 2), np.zeros(SPEED_POINTS))


def off_by(charge: Curve, discharge: Curve, friction: Curve, straight: bool = False) -> Maps:
    """The maps with relative errors."""
    valve = exact(straight).valve.copy()
    away: Array = GRID_STEP * np.arange(GRID_POINTS, dtype=np.float64)
    speeds: Array = SPEED_STEP * np.arange(SPEED_POINTS, dtype=np.float64) - TOP_SPEED
    for side, opening in enumerate((away, -away)):
        valve[side, :, 0] *= 1.0 + charge(opening)
        valve[side, :, 3] *= 1.0 + discharge(opening)
    return Maps(valve, friction(speeds))


def of_axes(each: Sequence[Maps]) -> Maps:
    """Of several axes."""
    return Maps(np.stack([m.valve for m in each]), np.stack([m.friction for m in each]))
