"""The whole workspace at once: the region of roll and pitch by height, and what limits it.

`survey` samples it; workspace_findings.py says in words what came out. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms._core import OutOfWorkspaceError, Params
from sms.arrays import Array
from sms.kinematics import forward_kinematics, height_range
from sms.views import Shown
from sms.workspace import conditioning, force_share, joint_angles, reach, rectangle_margin

DEGREE = math.pi / 180.0


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle of roll and pitch that the machine is asked to reach."""

    name: str
    roll: float  #: largest |roll|, rad
    pitch: float  #: largest |pitch|, rad


BOXES = (
    Box("required", 8.0 * DEGREE, 4.0 * DEGREE),
    Box("specified", 6.0 * DEGREE, 6.0 * DEGREE),
)
"""Movement range of Table 2.1; no heave is asked for."""
ACCELERATION = 6.2 * DEGREE
"""Largest angular acceleration of Table 2.1, of roll and of pitch, rad/s^2."""

_STEP = 0.005  # m, between heights
_FINE_STEP = 1e-4  # m, for the heights at which a box fits
_DIRECTIONS = 360  # a multiple of 4, so that roll and pitch alone are among them
_SHARES = np.linspace(0.0, 1.0, 9)  # of the way to the edge of the region
_EVERY = 9  # of the directions, where poses inside the region are looked at
_GRID = 13  # extensions an actuator, for the worst of the whole stroke


@dataclass(frozen=True, slots=True)
class Fit:
    """Whether a box fits, and where."""

    box: Box
    heights: Array  #: m
    margin: Array  #: least stroke left over in the box at each height, m; NaN: no such pose
    fits_from: float  #: m; NaN: at no height
    fits_to: float  #: m
    best_height: float  #: where the margin is largest, m
    best_margin: float  #: m; negative: the stroke that is missing


@dataclass(frozen=True, slots=True)
class Worst:
    """The worst of many poses: (H,) by height, or () over the whole stroke."""

    base_actuator: Array  #: turn of a base joint from rest, rad
    base_panhard: Array  #: rad
    platform_actuator: Array  #: turn of a platform joint from rest, rad
    platform_panhard: Array  #: rad
    panhard_condition: Array  #: condition number of the rods' constraint
    link_condition: Array  #: condition number of all six links
    holding_share: Array  #: of the actuator's force, to hold the payload
    accelerating_share: Array  #: the same with ACCELERATION of roll and pitch at once


@dataclass(frozen=True, slots=True)
class Survey(Shown):
    """The workspace of one machine."""

    params: Params
    heights: Array  #: (H,) m
    directions: Array  #: (D,) rad, in the roll-pitch plane, 0 is roll
    reach: Array  #: (H, D) largest tilt in that direction, rad
    fits: tuple[Fit, ...]  #: one a box
    worst: Worst  #: by height
    worst_of_all: Worst  #: of the whole stroke, all ends of it included
    push: float  #: what an actuator can push with at the supply pressure, N
    pull: float  #: what it can pull with, N

    def alone(self, axis: str) -> tuple[Array, Array]:
        """Largest negative and positive angle (rad) of "roll" or "pitch", the other one level."""
        quarter = _DIRECTIONS // 4
        first = 0 if axis == "roll" else quarter
        return -self.reach[:, first + 2 * quarter], self.reach[:, first]

    def either_way(self, axis: str) -> Array:
        """The angle (rad) of one axis alone that is reached both ways, by height."""
        negative, positive = self.alone(axis)
        return np.minimum(-negative, positive)

    def outline(self, index: int) -> tuple[Array, Array]:
        """Roll and pitch (rad) around the region at heights[index], closed."""
        angle = np.append(self.reach[index], self.reach[index, 0])
        direction = np.append(self.directions, self.directions[0])
        return angle * np.cos(direction), angle * np.sin(direction)


def survey(params: Params | None = None) -> Survey:
    """Sample the workspace of a machine; about a second.

    Raises: OutOfWorkspaceError where the mechanism does not even stand level with all actuators
    retracted or all extended.
    """
    params = params or Params()
    low, high = height_range(params)
    if not low < high:
        raise OutOfWorkspaceError(
            "this mechanism has no pose with all actuators retracted or none with all of them "
            f"extended by the stroke of {params.stroke:g} m: there is no workspace to survey"
        )
    heights = _multiples(min(_STEP, (high - low) / 20.0), low, high)
    directions = np.linspace(0.0, 2.0 * math.pi, _DIRECTIONS, endpoint=False)
    limits = reach(heights[:, None], directions, params=params)
    push, pull = _core.force_range(params)
    return Survey(
        params=params.copy(),
        heights=heights,
        directions=directions,
        reach=limits,
        fits=tuple(_fit(params, box, low, high) for box in BOXES),
        worst=_worst(params, _poses_by_height(heights, directions, limits)),
        worst_of_all=_worst(params, _poses_of_the_stroke(params)),
        push=push,
        pull=pull,
    )


def _multiples(step: float, low: float, high: float) -> Array:
    """The whole multiples of `step` from low to high."""
    first, last = math.ceil(low / step), math.floor(high / step)
    return step * np.linspace(first, last, last - first + 1)


def _fit(params: Params, box: Box, low: float, high: float) -> Fit:
    heights = _multiples(_FINE_STEP, low, high)
    margin = rectangle_margin(heights, box.roll, box.pitch, params=params)
    fitting = heights[margin >= 0.0]
    best = int(np.argmax(margin))
    return Fit(
        box=box,
        heights=heights,
        margin=margin,
        fits_from=float(fitting[0]) if fitting.size else math.nan,
        fits_to=float(fitting[-1]) if fitting.size else math.nan,
        best_height=float(heights[best]),
        best_margin=float(margin[best]),
    )


def _poses_by_height(heights: Array, directions: Array, limits: Array) -> Array:
    """Shares of the way to the edge in every ninth direction: q, (H, N, 3)."""
    angle = limits[:, ::_EVERY, None] * _SHARES
    direction = directions[::_EVERY, None]
    q = np.empty((*angle.shape, 3))
    q[..., 0] = angle * np.cos(direction)
    q[..., 1] = angle * np.sin(direction)
    q[..., 2] = heights[:, None, None]
    return q.reshape(len(heights), -1, 3)


def _poses_of_the_stroke(params: Params) -> Array:
    """A grid over the three extensions, ends included: q, (N, 3)."""
    grid = np.linspace(0.0, params.stroke, _GRID)
    extension = np.stack(np.meshgrid(grid, grid, grid), axis=-1).reshape(-1, 3)
    pose = forward_kinematics(extension, params=params)
    return np.stack([pose.roll, pose.pitch, pose.height], axis=-1)


def _worst(params: Params, q: Array) -> Worst:
    """The largest of everything over the last axis but one of q."""
    joints = joint_angles(q, params=params)
    numbers = conditioning(q, params=params)
    signs = [(roll, pitch, 0.0) for roll in (-1.0, 1.0) for pitch in (-1.0, 1.0)]
    accelerating = [force_share(q, ACCELERATION * np.array(s), params=params) for s in signs]
    return Worst(
        base_actuator=joints.base[..., :3].max(axis=(-2, -1)),
        base_panhard=joints.base[..., 3:].max(axis=(-2, -1)),
        platform_actuator=joints.platform[..., :3].max(axis=(-2, -1)),
        platform_panhard=joints.platform[..., 3:].max(axis=(-2, -1)),
        panhard_condition=numbers.panhard.max(axis=-1),
        link_condition=numbers.links.max(axis=-1),
        holding_share=force_share(q, params=params).max(axis=-1),
        accelerating_share=np.maximum.reduce(accelerating).max(axis=-1),
    )
