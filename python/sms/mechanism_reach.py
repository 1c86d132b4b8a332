"""How far each driven coordinate of a mechanism alone goes from its home pose, and what ends it there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sms._core import StatusError
from sms.arrays import Array
from sms.errors import InputError
from sms.mechanism import COORDINATES, Mechanism

_STEPS = 200
_HALVINGS = 40
_LARGEST_TURN = math.pi / 2  #: rad; pitch has no more
_LARGEST_MOVE = 10.0  #: characteristic lengths


@dataclass(frozen=True, slots=True)
class Reach:
    """One driven coordinate in one direction."""

    coordinate: str
    end: float  #: m or rad, itself within the workspace
    why: str  #: what is beyond
    condition: float  #: largest condition number on the way


def reaches(mechanism: Mechanism) -> list[Reach]:
    """Down and up from home for each driven coordinate. InputError where home itself is none."""
    home, why, condition = _state(mechanism, np.array(mechanism.home), None)
    if home is None or why:
        raise InputError(f"{mechanism.name}: the home pose cannot be: {why}; correct [home]")
    sign = math.copysign(1.0, _determinant(mechanism, home))
    return [
        _reach(mechanism, home, name, direction, sign, condition)
        for name in mechanism.driven
        for direction in (-1.0, 1.0)
    ]


def _determinant(mechanism: Mechanism, pose: Array) -> float:
    return float(mechanism.conditioning(pose)[1])


def _state(mechanism: Mechanism, at: Array, sign: float | None) -> tuple[Array | None, str, float]:
    """The pose that fits, or what is wrong with it; its condition number."""
    try:
        found = mechanism.inverse(at)
    except StatusError:
        return None, "rods and planes leave no pose", math.inf
    condition, determinant = mechanism.conditioning(found.pose)
    if sign is not None and determinant * sign <= 0.0:
        return None, "a singular pose", math.inf
    outside = mechanism.outside_range(found.length[np.newaxis])
    if outside:
        leg = outside[0][1]
        limits = mechanism.legs[leg].range
        assert limits is not None
        which = "shortest" if found.length[leg] < limits[0] else "longest"
        return None, f"leg {leg + 1} at its {which}", math.inf
    return np.asarray(found.pose), "", float(condition)


def _reach(
    mechanism: Mechanism, home: Array, name: str, direction: float, sign: float, condition: float
) -> Reach:
    k = COORDINATES.index(name)
    length = mechanism.characteristic_length_in_use
    furthest = home[k] + direction * (_LARGEST_TURN if k >= 3 else _LARGEST_MOVE * length)
    pose, inside, why = home, float(home[k]), "no end was found up to here"
    for target in np.linspace(home[k], furthest, _STEPS + 1)[1:]:
        outside = float(target)
        there, problem, here = _state(mechanism, _with(pose, k, outside), sign)
        if there is None:
            why = problem
            for _ in range(_HALVINGS):
                middle = 0.5 * (inside + outside)
                there, problem, here = _state(mechanism, _with(pose, k, middle), sign)
                if there is None:
                    outside, why = middle, problem
                else:
                    inside, pose = middle, there
            break
        inside, pose, condition = outside, there, max(condition, here)
    return Reach(name, inside, why, condition)


def _with(pose: Array, coordinate: int, value: float) -> Array:
    changed = pose.copy()
    changed[coordinate] = value
    return changed
