"""Rigid-body dynamics of the whole mechanism in q = (roll, pitch, height).

    M(q) q'' + b(q, q') = J(q)^T F + Q

M mass matrix, b bias force (Coriolis, centrifugal and weight), J = d extension / dq, F actuator
forces (N, positive pushing out), Q what else acts on the platform. The equations are in
libsms/include/sms: dynamics.hpp, link_dynamics.hpp, linear_dynamics.hpp.

`masses` chooses the reading of the mass table (bodies.hpp): "corrected" is the whole mechanism with
inertias as they must have been meant, "table" the same with the printed numbers, "platform" the
top frame and payload alone, "lumped" the platform with pistons and half rods as points.

q, qdot, qddot and force have shape (..., 3) and broadcast; units rad, rad, m and their rates, N. An
impossible pose raises what `inverse_kinematics` raises for it, a NaN NotANumberError.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.kinematics import QDDOT, QDOT, Q, allowed_poses
from sms.rows import Rows, vectors

FORCE = tuple((f"force {i}", "N") for i in (1, 2, 3))
_EXTERNAL_FORCE = tuple((f"external force {axis}", "N") for axis in "xyz")
_EXTERNAL_MOMENT = tuple((f"external moment {axis}", "N m") for axis in "xyz")
_STIFFNESS = tuple((f"stiffness {i}", "N/m") for i in (1, 2, 3))
_DAMPING = tuple((f"damping {i}", "N s/m") for i in (1, 2, 3))
_REST = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Energies:
    """Of all moving bodies, in the shape of q without its last axis."""

    kinetic: Array  #: J
    potential: Array  #: of the weights, J, zero at ground


@dataclass(frozen=True, slots=True)
class LinearModel:
    """M dq'' + D dq' + K dq = J^T dF, and the same as x' = A x + B dF with x = (dq, dq')."""

    mass_matrix: Array  #: M, (..., 3, 3); kg m^2, kg m, kg
    damping: Array  #: D, (..., 3, 3); N m s/rad, N s, N s/m
    stiffness: Array  #: K, (..., 3, 3); N m/rad, N, N/m
    a: Array  #: A, (..., 6, 6)
    b: Array  #: B, (..., 6, 3)


@dataclass(frozen=True, slots=True)
class Modes:
    """Undamped small motions, by rising omega^2; each a solution of K v = omega^2 M v."""

    eigenfrequency: Array  #: Hz, (..., 3); 0 where the mode does not oscillate
    growth_rate: Array  #: 1/s, (..., 3); 0 where it does
    shape: Array  #: v in q, column k of mode k, v^T M v = 1, (..., 3, 3)


def forward_dynamics(
    q: ArrayLike,
    qdot: ArrayLike,
    force: ArrayLike,
    masses: str = "corrected",
    *,
    external_force: ArrayLike = _REST,
    external_moment: ArrayLike = _REST,
    params: Params | None = None,
) -> Array:
    """Accelerations of (roll, pitch, height) under actuator forces, rad/s^2, rad/s^2, m/s^2.

    Args:
        q: (roll, pitch, height), (..., 3).
        qdot: its rate, (..., 3).
        force: of the three actuators, N, positive pushing out, (..., 3).
        masses: reading of the mass table, see the module.
        external_force: on the platform at the reference point, N, world axes (z down), (..., 3).
        external_moment: on the platform, N m, world axes, (..., 3).
        params: the machine.

    Equation: q'' = M^-1 (J^T F + Q - b). Returns an array (..., 3).
    """
    params = params or Params()
    rows = vectors(
        q=(Q, q),
        qdot=(QDOT, qdot),
        force=(FORCE, force),
        external_force=(_EXTERNAL_FORCE, external_force),
        external_moment=(_EXTERNAL_MOMENT, external_moment),
    )
    qddot, status = _core.forward_dynamics(params, mass_model_number(masses), *rows.parts)
    rows.check(status, allowed_poses, params)
    return rows.shaped(qddot, 3)


def inverse_dynamics(
    q: ArrayLike,
    qdot: ArrayLike,
    qddot: ArrayLike,
    masses: str = "corrected",
    *,
    external_force: ArrayLike = _REST,
    external_moment: ArrayLike = _REST,
    params: Params | None = None,
) -> Array:
    """Actuator forces (N, positive pushing out) that give the accelerations `qddot`, (..., 3).

    Arguments as in `forward_dynamics`. Equation: F = J^-T (M q'' + b - Q).
    """
    params = params or Params()
    rows = vectors(
        q=(Q, q),
        qdot=(QDOT, qdot),
        qddot=(QDDOT, qddot),
        external_force=(_EXTERNAL_FORCE, external_force),
        external_moment=(_EXTERNAL_MOMENT, external_moment),
    )
    force, status = _core.inverse_dynamics(params, mass_model_number(masses), *rows.parts)
    rows.check(status, allowed_poses, params)
    return rows.shaped(force, 3)


def holding_force(
    q: ArrayLike,
    masses: str = "corrected",
    *,
    external_force: ArrayLike = _REST,
    external_moment: ArrayLike = _REST,
    params: Params | None = None,
) -> Array:
    """Actuator forces (N) that hold a pose at rest, (..., 3): `inverse_dynamics` without motion."""
    return inverse_dynamics(
        q,
        _REST,
        _REST,
        masses,
        external_force=external_force,
        external_moment=external_moment,
        params=params,
    )


def mass_matrix(q: ArrayLike, masses: str = "corrected", *, params: Params | None = None) -> Array:
    """M at q, (..., 3, 3), symmetric; kg m^2 among angles, kg m between angle and height, kg."""
    rows, terms = _terms(q, _REST, masses, params)
    return rows.shaped(terms[:, 15:24], 3, 3)


def bias_force(
    q: ArrayLike, qdot: ArrayLike, masses: str = "corrected", *, params: Params | None = None
) -> Array:
    """b at q and q': Coriolis, centrifugal and weight, (..., 3); N m, N m, N."""
    rows, terms = _terms(q, qdot, masses, params)
    return rows.shaped(terms[:, 24:27], 3)


def gravity_force(
    q: ArrayLike, masses: str = "corrected", *, params: Params | None = None
) -> Array:
    """The weight's part of the bias force, the gradient of the potential energy, (..., 3)."""
    rows, terms = _terms(q, _REST, masses, params)
    return rows.shaped(terms[:, 27:30], 3)


def energies(
    q: ArrayLike, qdot: ArrayLike, masses: str = "corrected", *, params: Params | None = None
) -> Energies:
    """Kinetic and potential energy (J) at q and q', in their shape without the last axis."""
    rows, terms = _terms(q, qdot, masses, params)
    return Energies(kinetic=rows.column(terms, 30), potential=rows.column(terms, 31))


def linearise(
    q: ArrayLike,
    stiffness: ArrayLike,
    damping: ArrayLike = 0.0,
    masses: str = "corrected",
    *,
    force: ArrayLike | None = None,
    params: Params | None = None,
) -> LinearModel:
    """The model of small motions about a pose at rest.

    Args:
        q: (roll, pitch, height), (..., 3).
        stiffness: by how much each actuator's force falls per metre of extension, N/m; one number
            or (..., 3). An air spring at constant air mass, for instance.
        damping: by how much it falls per m/s, N s/m; one number or (..., 3).
        masses: reading of the mass table, see the module.
        force: actuator forces at the pose, N, (..., 3); by default those that hold it.
        params: the machine.

    Equation: K = d(b - J^T F)/dq + J^T k J, D = J^T d J (linear_dynamics.hpp).
    """
    rows, model = _linear(q, stiffness, damping, masses, force, params)
    return LinearModel(
        mass_matrix=rows.shaped(model[:, 0:9], 3, 3),
        damping=rows.shaped(model[:, 9:18], 3, 3),
        stiffness=rows.shaped(model[:, 18:27], 3, 3),
        a=rows.shaped(model[:, 27:63], 6, 6),
        b=rows.shaped(model[:, 63:81], 6, 3),
    )


def eigenfrequencies(
    q: ArrayLike,
    stiffness: ArrayLike,
    masses: str = "corrected",
    *,
    force: ArrayLike | None = None,
    params: Params | None = None,
) -> Modes:
    """The three undamped modes about a pose at rest; arguments as in `linearise`.

    With stiffness 0 they are growth rates: at constant force the payload topples.
    """
    rows, model = _linear(q, stiffness, 0.0, masses, force, params)
    return Modes(
        eigenfrequency=rows.shaped(model[:, 81:84], 3),
        growth_rate=rows.shaped(model[:, 84:87], 3),
        shape=rows.shaped(model[:, 87:96], 3, 3),
    )


def mass_model_number(masses: str) -> int:
    """The core's number of a reading of the mass table; ValueError that names them."""
    names = _core.mass_models()
    if masses not in names:
        raise ValueError(f"masses is {masses!r}; it must be one of {', '.join(names)}")
    return names.index(masses)


def _all_three(value: ArrayLike) -> ArrayLike:
    """One number stands for all three actuators."""
    return np.full(3, value) if np.ndim(value) == 0 else value


def _terms(q: ArrayLike, qdot: ArrayLike, masses: str, params: Params | None) -> tuple[Rows, Array]:
    """Rows of sms_dynamics: pose 0:6, J 6:15, M 15:24, b 24:27, g 27:30, T 30, U 31."""
    params = params or Params()
    rows = vectors(q=(Q, q), qdot=(QDOT, qdot))
    terms, status = _core.dynamics_terms(params, mass_model_number(masses), *rows.parts)
    rows.check(status, allowed_poses, params)
    return rows, terms


def _linear(
    q: ArrayLike,
    stiffness: ArrayLike,
    damping: ArrayLike,
    masses: str,
    force: ArrayLike | None,
    params: Params | None,
) -> tuple[Rows, Array]:
    """Rows of sms_linear_model: M, D, K 0:27, A 27:63, B 63:81, Hz 81:84, growth, shapes."""
    params = params or Params()
    if force is None:
        force = holding_force(q, masses, params=params)
    rows = vectors(
        q=(Q, q),
        force=(FORCE, force),
        stiffness=(_STIFFNESS, _all_three(stiffness)),
        damping=(_DAMPING, _all_three(damping)),
    )
    model, status = _core.linearise(params, mass_model_number(masses), *rows.parts)
    rows.check(status, allowed_poses, params)
    return rows, model
