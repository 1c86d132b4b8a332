"""The parameter table of the core as a neutral list of bodies and joints in the rest pose.

Only the reading of the numbers is repeated here (their meaning is stated in bodies.hpp and
geometry.hpp, reading `corrected`); how the machine moves is left to whoever reads the list.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from validation.reference.multibody.peers.exchange import GROUND, PLATFORM, Body, Joint, Mechanism

if TYPE_CHECKING:  # the list serves simulators too that share nothing with the core
    from sms import Params
    from sms.arrays import Array

COUNT = 3  # actuators, and Panhard rods
DESIGN_TURN = np.radians([0.0, -120.0, 120.0])  # of actuators 1 to 3 about z, against the first


def mechanism_of(params: Params) -> Mechanism:
    """Platform with payload, cylinders, pistons and rods as the parameters describe them.

    Raises: ValueError for lengths that do not fit the rest pose, which this list cannot express.
    """
    for i in range(COUNT):
        for name in (f"actuator_length_offset_{i + 1}", f"panhard_length_offset_{i + 1}"):
            if getattr(params, name):
                raise ValueError(f"{name} is not zero; only machines that fit their rest pose can")
    bodies, joints = [_platform(params)], []
    for i in range(COUNT):
        base, top = _point(params, f"base_joint_{i + 1}"), _point(params, f"platform_joint_{i + 1}")
        cylinder, piston = f"cylinder_{i + 1}", f"piston_{i + 1}"
        turn = _about_z(DESIGN_TURN[i])
        bodies += [
            _of_design(params, "cylinder", cylinder, turn, base, "base_joint_1"),
            _of_design(params, "piston", piston, turn, top, "platform_joint_1"),
        ]
        joints += [
            _universal(cylinder, base, top),
            _joint("prismatic", cylinder, piston, top, _direction(base, top)),
            _joint("spherical", piston, PLATFORM, top),
        ]
    for i in range(COUNT, 2 * COUNT):
        base, top = _point(params, f"base_joint_{i + 1}"), _point(params, f"platform_joint_{i + 1}")
        rod = f"panhard_{i - COUNT + 1}"
        bodies.append(_rod(params, rod, base, top))
        joints += [_universal(rod, base, top), _joint("spherical", rod, PLATFORM, top)]
    return Mechanism(
        gravity=[0.0, 0.0, params.gravity],
        reference_point=_point(params, "reference_point").tolist(),
        bodies=bodies,
        joints=joints,
    )


def _platform(params: Params) -> Body:
    """Top frame and payload, rigid together."""
    parts = [
        (
            float(getattr(params, f"{name}_mass")),
            _point(params, f"{name}_cog"),
            _inertia(params, f"{name}_inertia"),
        )
        for name in ("top_frame", "payload")
    ]
    mass = sum(m for m, _, _ in parts)
    cog = sum((m * c for m, c, _ in parts), np.zeros(3)) / mass
    inertia = sum((i + _steiner(m, c - cog) for m, c, i in parts), np.zeros((3, 3)))
    return _body(PLATFORM, mass, cog, inertia)


def _of_design(
    params: Params, part: str, name: str, turn: Array, joint: Array, joint_1: str
) -> Body:
    """A cylinder or piston: the first of its kind turned about z, hung on its own joint."""
    from_joint = _point(params, f"{part}_cog") - _point(params, joint_1)
    inertia = turn @ _inertia(params, f"{part}_inertia") @ turn.T
    return _body(name, getattr(params, f"{part}_mass"), joint + turn @ from_joint, inertia)


def _rod(params: Params, name: str, base: Array, top: Array) -> Body:
    """A Panhard rod: the same all round its axis, its centre of gravity half-way."""
    n = _direction(base, top)
    along, across = params.panhard_inertia_axial, params.panhard_inertia_transverse
    inertia = across * np.eye(3) + (along - across) * np.outer(n, n)
    return _body(name, params.panhard_mass, 0.5 * (base + top), inertia)


def _universal(name: str, base: Array, top: Array) -> Joint:
    """Ground axis horizontal and across the link, link axis perpendicular to both, at rest."""
    n = _direction(base, top)
    ground_axis = _unit(np.cross([0.0, 0.0, 1.0], n))
    return _joint("universal", GROUND, name, base, ground_axis, np.cross(n, ground_axis))


def _joint(kind: str, first: str, second: str, point: Array, *axes: Array) -> Joint:
    return Joint(
        kind=kind, bodies=[first, second], point=point.tolist(), axes=[a.tolist() for a in axes]
    )


def _body(name: str, mass: float, cog: Array, inertia: Array) -> Body:
    return Body(name=name, mass=mass, cog=cog.tolist(), inertia=inertia.tolist())


def _point(params: Params, name: str) -> Array:
    return np.array([getattr(params, f"{name}_{axis}") for axis in "xyz"])


def _inertia(params: Params, name: str) -> Array:
    """3x3; what has no products in the table (the top frame) has none."""
    pairs = [["xx", "xy", "xz"], ["xy", "yy", "yz"], ["xz", "yz", "zz"]]
    return np.array([[getattr(params, f"{name}_{pair}", 0.0) for pair in row] for row in pairs])


def _steiner(mass: float, offset: Array) -> Array:
    return mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))


def _unit(vector: Array) -> Array:
    return vector / np.linalg.norm(vector)


def _direction(base: Array, top: Array) -> Array:
    return _unit(top - base)


def _about_z(angle: float) -> Array:
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
