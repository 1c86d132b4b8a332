"""Kinematics of the mechanism: from roll, pitch and height to the three extensions, and back.

Frames: right-handed, z down, x the roll axis, R = Rz(yaw) Ry(pitch) Rx(roll). Height is that of the
platform's reference point (by default the top frame's centre of gravity) above ground. SI units.

Every function takes arrays that broadcast; a pose that cannot be raises an exception which names
the row. The equations are in libsms/include/sms: inverse_kinematics.hpp, forward_kinematics.hpp,
motion.hpp. Each row is solved from the rest pose, so that no row depends on its neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.rows import Rows, scalars, vectors

Q = (("roll", "rad"), ("pitch", "rad"), ("height", "m"))
QDOT = (("roll rate", "rad/s"), ("pitch rate", "rad/s"), ("height rate", "m/s"))
QDDOT = (
    ("roll acceleration", "rad/s^2"),
    ("pitch acceleration", "rad/s^2"),
    ("height acceleration", "m/s^2"),
)
EXTENSION = tuple((f"extension {i}", "m") for i in (1, 2, 3))
_RATE = tuple((f"extension rate {i}", "m/s") for i in (1, 2, 3))
_ACCELERATION = tuple((f"extension acceleration {i}", "m/s^2") for i in (1, 2, 3))


@dataclass(frozen=True, slots=True)
class InverseKinematics:
    """What `inverse_kinematics` found, in the shape of its inputs."""

    extension: Array  #: of the three actuators, m, (..., 3)
    yaw: Array  #: rad; yaw, x and y follow from roll, pitch and height by the Panhard rods
    x: Array  #: of the reference point, m, world axes
    y: Array  #: m
    iterations: NDArray[np.int32]  #: Newton steps taken
    residual: Array  #: largest error of a rod's length, m


@dataclass(frozen=True, slots=True)
class ForwardKinematics:
    """What `forward_kinematics` found, in the shape of its input without the last axis."""

    roll: Array  #: rad
    pitch: Array  #: rad
    height: Array  #: of the reference point above ground, m
    yaw: Array  #: rad
    x: Array  #: of the reference point, m, world axes
    y: Array  #: m
    iterations: NDArray[np.int32]  #: Newton steps taken
    residual: Array  #: largest error of a link's length, m


@dataclass(frozen=True, slots=True)
class Motion:
    """Rates and accelerations of everything that moves, each (..., 3)."""

    qdot: Array  #: of (roll, pitch, height), rad/s, rad/s, m/s
    qddot: Array  #: rad/s^2, rad/s^2, m/s^2
    parasitic_rate: Array  #: of (yaw, x, y), rad/s, m/s, m/s
    parasitic_acceleration: Array  #: rad/s^2, m/s^2, m/s^2
    extension_rate: Array  #: m/s
    extension_acceleration: Array  #: m/s^2


def inverse_kinematics(
    roll: ArrayLike, pitch: ArrayLike, height: ArrayLike, *, params: Params | None = None
) -> InverseKinematics:
    """Extensions, yaw, x and y of a roll, a pitch (rad) and a height (m), which broadcast.

    The stroke is no limit here: an extension may come out below 0 or above `params.stroke`.

    Equations: the three Panhard rods keep their lengths, the actuators' lengths follow (eq. 3.6).
    Raises: NotANumberError; OutOfWorkspaceError beyond 0.6 rad or where the rods do not reach;
    NotConvergedError.
    """
    params = params or Params()
    rows = scalars(roll=("rad", roll), pitch=("rad", pitch), height=("m", height))
    pose, extension, iterations, residual, status = _core.inverse_kinematics(params, *rows.parts)
    rows.check(status, allowed_poses, params)
    return InverseKinematics(
        extension=rows.shaped(extension, 3),
        yaw=rows.column(pose, 3),
        x=rows.column(pose, 4),
        y=rows.column(pose, 5),
        iterations=rows.shaped(iterations),
        residual=rows.shaped(residual),
    )


def forward_kinematics(extension: ArrayLike, *, params: Params | None = None) -> ForwardKinematics:
    """The pose of three extensions (m), shape (..., 3).

    Equations: six links have given lengths; the solution is the one the machine is built in.
    Raises: NotANumberError; OutOfWorkspaceError where there is no such pose within 0.6 rad;
    NotConvergedError.
    """
    params = params or Params()
    rows = vectors(extension=(EXTENSION, extension))
    pose, iterations, residual, status = _core.forward_kinematics(params, *rows.parts)
    rows.check(status, _allowed_extensions, params)
    return ForwardKinematics(
        roll=rows.column(pose, 0),
        pitch=rows.column(pose, 1),
        height=rows.column(pose, 2),
        yaw=rows.column(pose, 3),
        x=rows.column(pose, 4),
        y=rows.column(pose, 5),
        iterations=rows.shaped(iterations),
        residual=rows.shaped(residual),
    )


def inverse_motion(
    q: ArrayLike,
    qdot: ArrayLike,
    qddot: ArrayLike = (0.0, 0.0, 0.0),
    *,
    params: Params | None = None,
) -> Motion:
    """Rates and accelerations of the actuators (and of yaw, x, y) from those of q.

    Args:
        q: (roll, pitch, height), rad, rad, m, shape (..., 3).
        qdot: its rate, rad/s, rad/s, m/s, (..., 3).
        qddot: its acceleration, rad/s^2, rad/s^2, m/s^2, (..., 3).
        params: the machine.

    Equation: extension' = J q', extension'' = J q'' + J' q', exact (motion.hpp).
    Raises: as `inverse_kinematics`.
    """
    params = params or Params()
    rows = vectors(q=(Q, q), qdot=(QDOT, qdot), qddot=(QDDOT, qddot))
    motion, status = _core.inverse_motion(params, *rows.parts)
    rows.check(status, allowed_poses, params)
    return _motion(rows, motion)


def forward_motion(
    extension: ArrayLike,
    extension_rate: ArrayLike,
    extension_acceleration: ArrayLike = (0.0, 0.0, 0.0),
    *,
    params: Params | None = None,
) -> Motion:
    """Rates and accelerations of (roll, pitch, height) and (yaw, x, y) from the actuators'.

    Args:
        extension: m, shape (..., 3).
        extension_rate: m/s, (..., 3).
        extension_acceleration: m/s^2, (..., 3).
        params: the machine.

    Raises: as `forward_kinematics`.
    """
    params = params or Params()
    rows = vectors(
        extension=(EXTENSION, extension),
        extension_rate=(_RATE, extension_rate),
        extension_acceleration=(_ACCELERATION, extension_acceleration),
    )
    motion, status = _core.forward_motion(params, *rows.parts)
    rows.check(status, _allowed_extensions, params)
    return _motion(rows, motion)


def jacobian(q: ArrayLike, *, params: Params | None = None) -> Array:
    """d extension / d(roll, pitch, height) along the rods' constraint, shape (..., 3, 3).

    Row i is actuator i; m/rad, m/rad, m/m. `q`: (roll, pitch, height), shape (..., 3).
    Raises: as `inverse_kinematics`.
    """
    params = params or Params()
    rows, pose = poses(params, q)
    values, _ = _core.jacobian(params, pose)
    return rows.shaped(values, 3, 3)


def pose_jacobian(q: ArrayLike, *, params: Params | None = None) -> Array:
    """d extension / d(roll, pitch, height, yaw, x, y), all six free, shape (..., 3, 6).

    Taken in the pose that the rods give at q = (roll, pitch, height), shape (..., 3).
    Raises: as `inverse_kinematics`.
    """
    params = params or Params()
    rows, pose = poses(params, q)
    values, _ = _core.pose_jacobian(params, pose)
    return rows.shaped(values, 3, 6)


def six_leg_inverse(
    roll: ArrayLike,
    pitch: ArrayLike,
    height: ArrayLike,
    yaw: ArrayLike,
    x: ArrayLike,
    y: ArrayLike,
    *,
    params: Params | None = None,
) -> Array:
    """Lengths of all six links (m), shape (..., 6), where the whole pose is free; inputs broadcast.

    The inverse kinematics of a Gough-Stewart platform in this frame (eq. 3.6): links 1 to 3 are the
    actuators, 4 to 6 the Panhard rods. Raises: NotANumberError.
    """
    params = params or Params()
    rows = scalars(
        roll=("rad", roll),
        pitch=("rad", pitch),
        height=("m", height),
        yaw=("rad", yaw),
        x=("m", x),
        y=("m", y),
    )
    values, status = _core.six_leg_inverse(params, rows.table)
    rows.check(status, lambda _: "every one of them must be finite", params)
    return rows.shaped(values, 6)


def poses(params: Params, q: ArrayLike) -> tuple[Rows, Array]:
    """The whole poses (n, 6) at q."""
    rows = vectors(q=(Q, q))
    pose, _, _, _, status = _core.inverse_kinematics(params, *rows.parts[0].T)
    rows.check(status, allowed_poses, params)
    return rows, pose


def _motion(rows: Rows, motion: Array) -> Motion:
    return Motion(*(rows.shaped(motion[:, 3 * i : 3 * i + 3], 3) for i in range(6)))


def allowed_poses(params: Params) -> str:
    """The end of an error's sentence: which poses there are."""
    angle = _core.largest_angle
    low, high = height_range(params)
    level = f" (level, the stroke covers {low:.3f} to {high:.3f} m)" if low < high else ""
    return (
        f"allowed are roll and pitch within ±{angle:g} rad (±{np.degrees(angle):.1f}°) and heights "
        f"that the rods reach{level}"
    )


def _allowed_extensions(params: Params) -> str:
    return f"the stroke is 0 to {params.stroke:g} m"


def height_range(params: Params) -> tuple[float, float]:
    """Heights (m) with all actuators retracted and all extended; NaN where there is no such pose."""
    ends = np.array([[0.0] * 3, [params.stroke] * 3])
    pose, _, _, _ = _core.forward_kinematics(params, ends)
    return float(pose[0, 2]), float(pose[1, 2])
