"""The three-freedom mechanism by the velocities of its ten bodies.

The coordinates are q = (roll, pitch, height). Yaw, x and y follow from the three Panhard rods'
constant lengths; their rates and second rates from the same condition differentiated. That gives,
for unit rates of each coordinate, the velocity of every body's centre of gravity and its angular
velocity, and with them (Kane's form of the principle of virtual power)

    M_kl = sum m v_k . v_l + w_k . I w_l
    b_k  = sum m v_k . (a - g) + w_k . (I alpha + w x I w)

a and alpha the accelerations at q'' = 0. Vectors (vectors.py) are in world axes, z down.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin, sqrt
from typing import NamedTuple

import numpy as np

from validation.reference.compiled import compiled
from validation.reference.multibody.peers.exchange import Body
from validation.reference.plants.vectors import (
    Vector,
    add,
    attitude,
    cross,
    dot,
    less,
    mix,
    row,
    solve3,
    times,
    turned_inertia,
)
from validation.reference.steffen import Array

LINKS = 6
ACTUATORS = 3


class Mechanism(NamedTuple):
    """What the mechanism is made of. Bodies hang on links in the links' own axes."""

    base: Array  # B_i, m, (6, 3)
    joint: Array  # P_i from the reference point in platform axes, m, (6, 3)
    ground_axis: Array  # of the universal joint at B_i, (6, 3)
    length: Array  # at zero extension; of a rod always, m, (6,)
    platform_mass: float
    platform_cog: Array  # from the reference point, (3,)
    platform_inertia: Array  # about the cog, (3, 3)
    hung_mass: Array  # cylinders and rods, (6,)
    hung_cog: Array  # from B_i, (6, 3)
    hung_inertia: Array  # about the cog, (6, 3, 3)
    slid_mass: Array  # pistons, (3,)
    slid_cog: Array  # from P_i, (3, 3)
    slid_inertia: Array  # about the cog, (3, 3, 3)
    gravity: float
    reference: Array  # the reference point at rest, (3,)


def mechanism_at_rest(
    bodies: Sequence[Body], base: Array, joint: Array, reference: Array, gravity: float
) -> Mechanism:
    """From bodies and joints in the rest pose, world axes: "platform", "cylinder_1", ..."""
    by_name = {body["name"]: body for body in bodies}
    link = joint - base
    length = np.sqrt(np.sum(link**2, axis=1))
    across = np.column_stack((-link[:, 1], link[:, 0], np.zeros(LINKS)))
    ground_axis = across / np.sqrt(np.sum(across**2, axis=1))[:, None]
    axes = [_axes(link[i] / length[i], ground_axis[i]) for i in range(LINKS)]
    names = [f"{kind}_{i}" for kind in ("cylinder", "panhard") for i in (1, 2, 3)]
    hung = [by_name[name] for name in names]
    slid = [by_name[f"piston_{i}"] for i in (1, 2, 3)]
    platform = by_name["platform"]
    return Mechanism(
        base=base,
        joint=joint - reference,
        ground_axis=ground_axis,
        length=length,
        platform_mass=platform["mass"],
        platform_cog=np.asarray(platform["cog"]) - reference,
        platform_inertia=np.asarray(platform["inertia"], dtype=np.float64),
        hung_mass=np.array([body["mass"] for body in hung]),
        hung_cog=np.array(
            [a.T @ (np.asarray(b["cog"]) - p) for a, b, p in zip(axes, hung, base, strict=True)]
        ),
        hung_inertia=np.array(
            [a.T @ np.asarray(b["inertia"]) @ a for a, b in zip(axes, hung, strict=True)]
        ),
        slid_mass=np.array([body["mass"] for body in slid]),
        slid_cog=np.array(
            [
                a.T @ (np.asarray(b["cog"]) - p)
                for a, b, p in zip(axes[:3], slid, joint[:3], strict=True)
            ]
        ),
        slid_inertia=np.array(
            [a.T @ np.asarray(b["inertia"]) @ a for a, b in zip(axes[:3], slid, strict=True)]
        ),
        gravity=gravity,
        reference=reference,
    )


def _axes(direction: Array, ground_axis: Array) -> Array:
    """Columns x, y, z of a link: z along it, y across it and the ground's axis."""
    y = np.cross(direction, ground_axis)
    y /= np.sqrt(y @ y)
    return np.column_stack((np.cross(y, direction), y, direction))


# ---- triples ----


@compiled
def joint_arm(m: Mechanism, x: Vector, y: Vector, z: Vector, i: int) -> Vector:
    """From the reference point to P_i, world axes."""
    return mix(x, y, z, row(m.joint, i))


@compiled
def complete_pose(m: Mechanism, roll: float, pitch: float, height: float, guess: Array) -> None:
    """Yaw, x, y from the rods' lengths into `guess`, by Newton's method from what is there."""
    for _ in range(30):
        yaw, px, py = guess[0], guess[1], guess[2]
        x, y, z = attitude(roll, pitch, yaw)
        rows = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
        off = [0.0, 0.0, 0.0]
        for k in range(3):
            i = ACTUATORS + k
            arm = joint_arm(m, x, y, z, i)
            link = less(add((px, py, -height), arm), row(m.base, i))
            off[k] = 0.5 * (m.length[i] ** 2 - dot(link, link))
            turning = cross((0.0, 0.0, 1.0), arm)
            rows[k] = (dot(link, turning), link[0], link[1])
        step = solve3(rows[0], rows[1], rows[2], (off[0], off[1], off[2]))
        guess[0] += step[0]
        guess[1] += step[1]
        guess[2] += step[2]
        if abs(step[0]) + abs(step[1]) + abs(step[2]) < 1e-13:
            break


@compiled
def link_turning(
    n: Vector, x: Vector, y: Vector, slope: float, e: Vector, length: float, v: Vector
) -> Vector:
    """Angular velocity of a link whose joint P moves with v; `slope` is |n x e|."""
    rate = times(1.0 / length, less(v, times(dot(n, v), n)))
    spin = -dot(cross(rate, e), x) / slope
    return add(cross(n, rate), times(spin, n))


@compiled
def link_turning_rate(
    n: Vector,
    x: Vector,
    y: Vector,
    slope: float,
    e: Vector,
    length: float,
    v: Vector,
    a: Vector,
) -> Vector:
    """Angular acceleration of that link, its joint P accelerating with a."""
    along = dot(n, v)
    rate = times(1.0 / length, less(v, times(along, n)))
    stretch = dot(rate, v) + dot(n, a)
    second = less(less(a, times(along, rate)), times(stretch, n))
    second = times(1.0 / length, less(second, times(along, rate)))
    w = link_turning(n, x, y, slope, e, length, v)
    rate_e, second_e = cross(rate, e), cross(second, e)
    spin = -dot(rate_e, x) / slope
    slope_rate = dot(rate_e, y)
    spin_rate = -(dot(second_e, x) + dot(rate_e, cross(w, x))) / slope
    spin_rate += dot(rate_e, x) * slope_rate / slope**2
    return add(add(cross(n, second), times(spin_rate, n)), times(spin, rate))


@compiled
def add_body(
    mass: float,
    inertia: Array,
    x: Vector,
    y: Vector,
    z: Vector,
    v: tuple[Vector, Vector, Vector],
    w: tuple[Vector, Vector, Vector],
    w_now: Vector,
    a: Vector,
    alpha: Vector,
    gravity: float,
    matrix: Array,
    bias: Array,
) -> None:
    """What one body brings to M and b: v, w for unit rates, w_now the actual turning."""
    i_alpha = turned_inertia(inertia, x, y, z, alpha)
    i_w = turned_inertia(inertia, x, y, z, w_now)
    moment = add(i_alpha, cross(w_now, i_w))
    force = times(mass, (a[0], a[1], a[2] - gravity))
    for k in range(3):
        i_wk = turned_inertia(inertia, x, y, z, w[k])
        bias[k] += dot(v[k], force) + dot(w[k], moment)
        for other in range(3):
            matrix[k, other] += mass * dot(v[k], v[other]) + dot(w[other], i_wk)


@compiled
def pose_rates(
    m: Mechanism, q: Array, pose: Array, rates: Array, slopes: Array, second: Array
) -> None:
    """Rates of (roll, pitch, yaw, x, y, z) for unit rates of q into `slopes` (3, 6), and their
    second rates at q'' = 0 under the actual `rates` of q into `second` (6,)."""
    x, y, z = attitude(q[0], q[1], pose[0])
    e_yaw = (0.0, 0.0, 1.0)
    e_pitch = (-sin(pose[0]), cos(pose[0]), 0.0)
    e_roll = x
    reference = (pose[1], pose[2], -q[2])
    arms = [joint_arm(m, x, y, z, ACTUATORS + k) for k in range(3)]
    links = [less(add(reference, arms[k]), row(m.base, ACTUATORS + k)) for k in range(3)]
    rows = [(dot(links[k], cross(e_yaw, arms[k])), links[k][0], links[k][1]) for k in range(3)]
    for c in range(3):
        turning = e_roll if c == 0 else e_pitch
        off = [0.0, 0.0, 0.0]
        for k in range(3):
            off[k] = links[k][2] if c == 2 else -dot(links[k], cross(turning, arms[k]))
        u = solve3(rows[0], rows[1], rows[2], (off[0], off[1], off[2]))
        slopes[c, 0] = 1.0 if c == 0 else 0.0
        slopes[c, 1] = 1.0 if c == 1 else 0.0
        slopes[c, 2], slopes[c, 3], slopes[c, 4] = u
        slopes[c, 5] = -1.0 if c == 2 else 0.0
    now = np.zeros(6)
    for c in range(3):
        for k in range(6):
            now[k] += rates[c] * slopes[c, k]
    w = mix(e_roll, e_pitch, e_yaw, (now[0], now[1], now[2]))
    v = (now[3], now[4], now[5])
    alpha = turning_bias(e_roll, e_pitch, e_yaw, now)
    off = [0.0, 0.0, 0.0]
    for k in range(3):
        velocity = add(v, cross(w, arms[k]))
        acceleration = add(cross(alpha, arms[k]), cross(w, cross(w, arms[k])))
        off[k] = -dot(velocity, velocity) - dot(links[k], acceleration)
    u = solve3(rows[0], rows[1], rows[2], (off[0], off[1], off[2]))
    second[:] = 0.0
    second[2], second[3], second[4] = u


@compiled
def turning_bias(e_roll: Vector, e_pitch: Vector, e_yaw: Vector, now: Array) -> Vector:
    """Angular acceleration of the platform when no angle's rate changes."""
    of_pitch = times(now[1], cross(times(now[2], e_yaw), e_pitch))
    carrier = add(times(now[2], e_yaw), times(now[1], e_pitch))
    return add(of_pitch, times(now[0], cross(carrier, e_roll)))


@compiled
def equations(
    m: Mechanism,
    q: Array,
    rates: Array,
    pose: Array,
    matrix: Array,
    bias: Array,
    slope: Array,
    extension: Array,
    extension_bias: Array,
) -> None:
    """M (3, 3), b (3,), the extensions, their slopes over q (3, 3) and their second rates at
    q'' = 0; `pose` (yaw, x, y) is where the search begins and what it finds."""
    complete_pose(m, q[0], q[1], q[2], pose)
    slopes, second, now = np.zeros((3, 6)), np.zeros(6), np.zeros(6)
    pose_rates(m, q, pose, rates, slopes, second)
    for c in range(3):
        for k in range(6):
            now[k] += rates[c] * slopes[c, k]
    x, y, z = attitude(q[0], q[1], pose[0])
    e_yaw, e_pitch, e_roll = (0.0, 0.0, 1.0), (-sin(pose[0]), cos(pose[0]), 0.0), x
    reference = (pose[1], pose[2], -q[2])
    w_unit = (
        mix(e_roll, e_pitch, e_yaw, (slopes[0, 0], slopes[0, 1], slopes[0, 2])),
        mix(e_roll, e_pitch, e_yaw, (slopes[1, 0], slopes[1, 1], slopes[1, 2])),
        mix(e_roll, e_pitch, e_yaw, (slopes[2, 0], slopes[2, 1], slopes[2, 2])),
    )
    v_unit = (
        (slopes[0, 3], slopes[0, 4], slopes[0, 5]),
        (slopes[1, 3], slopes[1, 4], slopes[1, 5]),
        (slopes[2, 3], slopes[2, 4], slopes[2, 5]),
    )
    w = mix(e_roll, e_pitch, e_yaw, (now[0], now[1], now[2]))
    alpha = turning_bias(e_roll, e_pitch, e_yaw, now)
    alpha = add(alpha, mix(e_roll, e_pitch, e_yaw, (second[0], second[1], second[2])))
    v0, a0 = (now[3], now[4], now[5]), (second[3], second[4], second[5])
    matrix[:, :] = 0.0
    bias[:] = 0.0

    arm = mix(x, y, z, (m.platform_cog[0], m.platform_cog[1], m.platform_cog[2]))
    add_body(
        m.platform_mass, m.platform_inertia, x, y, z,
        moved3(v_unit, w_unit, arm), w_unit, w,
        add(a0, add(cross(alpha, arm), cross(w, cross(w, arm)))), alpha,
        m.gravity, matrix, bias,
    )  # fmt: skip
    for i in range(LINKS):
        arm = joint_arm(m, x, y, z, i)
        velocity = add(v0, cross(w, arm))
        acceleration = add(a0, add(cross(alpha, arm), cross(w, cross(w, arm))))
        unit = moved3(v_unit, w_unit, arm)
        link = less(add(reference, arm), row(m.base, i))
        add_link(m, i, link, velocity, acceleration, unit, matrix, bias)
        if i < ACTUATORS:
            length = sqrt(dot(link, link))
            n = times(1.0 / length, link)
            along = dot(n, velocity)
            extension[i] = length - m.length[i]
            for k in range(3):
                slope[i, k] = dot(n, unit[k])
            extension_bias[i] = dot(n, acceleration)
            extension_bias[i] += (dot(velocity, velocity) - along * along) / length


@compiled
def moved3(
    v: tuple[Vector, Vector, Vector], w: tuple[Vector, Vector, Vector], arm: Vector
) -> tuple[Vector, Vector, Vector]:
    """Unit velocities of a point `arm` away from where they are v."""
    return (
        add(v[0], cross(w[0], arm)),
        add(v[1], cross(w[1], arm)),
        add(v[2], cross(w[2], arm)),
    )


@compiled
def add_link(
    m: Mechanism,
    i: int,
    link: Vector,
    velocity: Vector,
    acceleration: Vector,
    unit: tuple[Vector, Vector, Vector],
    matrix: Array,
    bias: Array,
) -> None:
    """What link i brings: the body that hangs on B_i and, on an actuator, the one that slides."""
    length = sqrt(dot(link, link))
    n = times(1.0 / length, link)
    e = row(m.ground_axis, i)
    y = cross(n, e)
    slope = sqrt(dot(y, y))
    y = times(1.0 / slope, y)
    x = cross(y, n)
    w = link_turning(n, x, y, slope, e, length, velocity)
    alpha = link_turning_rate(n, x, y, slope, e, length, velocity, acceleration)
    w_unit = (
        link_turning(n, x, y, slope, e, length, unit[0]),
        link_turning(n, x, y, slope, e, length, unit[1]),
        link_turning(n, x, y, slope, e, length, unit[2]),
    )
    zero = (0.0, 0.0, 0.0)
    arm = mix(x, y, n, row(m.hung_cog, i))
    add_body(
        m.hung_mass[i], m.hung_inertia[i], x, y, n,
        moved3((zero, zero, zero), w_unit, arm), w_unit, w,
        add(cross(alpha, arm), cross(w, cross(w, arm))), alpha,
        m.gravity, matrix, bias,
    )  # fmt: skip
    if i < ACTUATORS:
        arm = mix(x, y, n, row(m.slid_cog, i))
        add_body(
            m.slid_mass[i], m.slid_inertia[i], x, y, n,
            moved3(unit, w_unit, arm), w_unit, w,
            add(acceleration, add(cross(alpha, arm), cross(w, cross(w, arm)))), alpha,
            m.gravity, matrix, bias,
        )  # fmt: skip
