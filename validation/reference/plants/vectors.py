"""Vectors as triples of floats, which compiled equations keep in registers."""

from __future__ import annotations

from math import cos, sin

from validation.reference.compiled import compiled
from validation.reference.steffen import Array

Vector = tuple[float, float, float]


@compiled
def row(a: Array, i: int) -> Vector:
    """Row i of an (n, 3) array."""
    return a[i, 0], a[i, 1], a[i, 2]


@compiled
def add(a: Vector, b: Vector) -> Vector:
    """a + b"""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@compiled
def less(a: Vector, b: Vector) -> Vector:
    """a - b"""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@compiled
def times(s: float, a: Vector) -> Vector:
    """s a"""
    return s * a[0], s * a[1], s * a[2]


@compiled
def dot(a: Vector, b: Vector) -> float:
    """a . b"""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def cross(a: Vector, b: Vector) -> Vector:
    """a x b"""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def mix(x: Vector, y: Vector, z: Vector, a: Vector) -> Vector:
    """a[0] x + a[1] y + a[2] z: from own axes to world axes."""
    return add(add(times(a[0], x), times(a[1], y)), times(a[2], z))


@compiled
def turned_inertia(inertia: Array, x: Vector, y: Vector, z: Vector, w: Vector) -> Vector:
    """I w in world axes of a body whose inertia stands in the axes x, y, z."""
    own = (dot(x, w), dot(y, w), dot(z, w))
    moment = (
        dot(row(inertia, 0), own),
        dot(row(inertia, 1), own),
        dot(row(inertia, 2), own),
    )
    return mix(x, y, z, moment)


@compiled
def solve3(a: Vector, b: Vector, c: Vector, right: Vector) -> Vector:
    """u of a . u, b . u, c . u = right, by Cramer's rule."""
    bc, ca, ab = cross(b, c), cross(c, a), cross(a, b)
    mixed = mix(bc, ca, ab, right)
    return times(1.0 / dot(a, bc), mixed)


# ---- pose ----


@compiled
def attitude(roll: float, pitch: float, yaw: float) -> tuple[Vector, Vector, Vector]:
    """Platform axes in world axes, R = Rz(yaw) Ry(pitch) Rx(roll)."""
    cr, sr, cp, sp, cy, sy = cos(roll), sin(roll), cos(pitch), sin(pitch), cos(yaw), sin(yaw)
    return (
        (cy * cp, sy * cp, -sp),
        (cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
        (cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr),
    )
