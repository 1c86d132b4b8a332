"""What the mechanism can reach, and with what to spare: stroke, joints, singularity, force.

The equations are in libsms/include/sms/workspace.hpp. Arrays broadcast as in `sms.kinematics`, and
an impossible pose raises the same exceptions; units are m, rad and N.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.dynamics import inverse_dynamics
from sms.kinematics import Q, allowed_poses, height_range, poses
from sms.rows import scalars, vectors, without_axes


@dataclass(frozen=True, slots=True)
class JointAngles:
    """How far each link has turned from the rest pose, rad, (..., 6); 1 to 3 are the actuators."""

    base: Array  #: against the ground
    platform: Array  #: against the platform


@dataclass(frozen=True, slots=True)
class Conditioning:
    """Distance from singularity, 1 is best: condition numbers in metres and radians."""

    panhard: Array  #: of the three rods' lengths by (yaw, x, y)
    links: Array  #: of all six lengths by the whole pose


def stroke_margin(q: ArrayLike, *, params: Params | None = None) -> Array:
    """Stroke left over (m) by the actuator nearest to an end, negative outside, (...).

    `q`: (roll, pitch, height), (..., 3).
    """
    params = params or Params()
    rows = vectors(q=(Q, q))
    _, extension, _, _, status = _core.inverse_kinematics(params, *rows.parts[0].T)
    rows.check(status, allowed_poses, params)
    return rows.column(_core.stroke_margin(params, extension), 0)


def rectangle_margin(
    height: ArrayLike,
    roll_limit: ArrayLike,
    pitch_limit: ArrayLike,
    *,
    params: Params | None = None,
) -> Array:
    """Least stroke margin (m) on the edges of |roll| <= roll_limit, |pitch| <= pitch_limit (rad).

    The rectangle fits at that height (m) when it is not negative. Inputs broadcast.
    """
    params = params or Params()
    rows = scalars(
        height=("m", height), roll_limit=("rad", roll_limit), pitch_limit=("rad", pitch_limit)
    )
    margin, status = _core.rectangle_margin(params, rows.table)
    rows.check(status, allowed_poses, params)
    return rows.column(margin, 0)


def reach(height: ArrayLike, direction: ArrayLike, *, params: Params | None = None) -> Array:
    """The largest tilt (rad) that the stroke allows at a height (m) in one direction.

    `direction` (rad) is counted in the roll-pitch plane: roll = angle cos(direction), pitch = angle
    sin(direction). OutOfWorkspaceError where not even the level pose is within the stroke.
    """
    params = params or Params()
    rows = scalars(height=("m", height), direction=("rad", direction))
    angle, status = _core.reach(params, _rays(*rows.parts))
    rows.check(status, _allowed_heights, params)
    return rows.column(angle, 0)


def joint_angles(q: ArrayLike, *, params: Params | None = None) -> JointAngles:
    """How far the joints have turned at q = (roll, pitch, height), (..., 3)."""
    params = params or Params()
    rows, pose = poses(params, q)
    angles, _ = _core.joint_angles(params, pose)
    return JointAngles(rows.shaped(angles[:, :6], 6), rows.shaped(angles[:, 6:], 6))


def conditioning(q: ArrayLike, *, params: Params | None = None) -> Conditioning:
    """Condition numbers at q = (roll, pitch, height), (..., 3)."""
    params = params or Params()
    rows, pose = poses(params, q)
    numbers, _ = _core.conditioning(params, pose)
    return Conditioning(rows.column(numbers, 0), rows.column(numbers, 1))


def force_share(
    q: ArrayLike,
    qddot: ArrayLike = (0.0, 0.0, 0.0),
    masses: str = "corrected",
    *,
    params: Params | None = None,
) -> Array:
    """Largest share of its force that an actuator needs at q to give qddot from rest, (...).

    1 is the limit: one chamber at the supply pressure, the other vented, no friction.
    """
    params = params or Params()
    force = inverse_dynamics(q, (0.0, 0.0, 0.0), qddot, masses, params=params)
    share = _core.force_share(params, force.reshape(-1, 3))
    return without_axes(share.reshape(force.shape[:-1]))


def _rays(height: Array, direction: Array) -> Array:
    return np.column_stack([height, np.cos(direction), np.sin(direction)])


def _allowed_heights(params: Params) -> str:
    low, high = height_range(params)
    return f"level, the stroke covers {low:.3f} to {high:.3f} m"
