"""Friction of the piston by each of the laws, and the acceleration that agrees with it.

Dissertation, chapter 6; Dahl and LuGre (elasto-plastic, Dupont et al. 2002) as in the opening
comment of friction_dynamic.hpp. The loop of eq. 6.5, where friction depends on the acceleration
that it changes, is closed by Ridders' method, which keeps the root between two bounds.
"""

from __future__ import annotations

from math import exp, pi, sin, sqrt

from validation.reference.compiled import compiled
from validation.reference.plants.numbers import Numbers

ACCELERATION_DEPENDENT, TWO_BRANCH, STRIBECK, DAHL, LUGRE = range(5)


@compiled
def seal(p: Numbers, dry: float, x: float, v: float, lower: float, upper: float) -> float:
    """N, dry friction with the effects that act on it, and eq. 6.6."""
    pressing = lower + upper - 2.0 * p.ambient_pressure
    grown = dry * (1.0 + p.position_friction * (x - 0.5 * p.stroke))
    upturn = exp(min(50.0, p.exponential_friction_rate * abs(v))) - 1.0
    pressed = p.pressure_friction + p.pressure_stiction * (dry - p.coulomb_force)
    return grown + pressed * pressing + p.exponential_friction_force * upturn


@compiled
def fall(p: Numbers, speed: float, width: float) -> float:
    """exp(-(speed / width)^delta), 0 for a width of 0."""
    if width <= 0.0 or speed >= 1e6 * width:
        return 0.0
    return exp(-((speed / width) ** p.stribeck_exponent))


@compiled
def sliding(
    p: Numbers, law: int, x: float, v: float, a: float, lower: float, upper: float
) -> float:
    """N, eq. 6.2 and 6.5 to 6.7 at a given acceleration."""
    speed = abs(v)
    ramp = 1.0 if v >= 0.0 else -1.0
    if speed < p.stiction_velocity:
        ramp = sin(0.5 * pi * v / p.stiction_velocity)
    if v * a > 0.0:
        width = p.stribeck_velocity
        if law == ACCELERATION_DEPENDENT:
            width *= p.stribeck_acceleration_factor * abs(a)
        dry = p.coulomb_force + (p.stiction_force - p.coulomb_force) * fall(p, speed, width)
        slope = p.viscous_friction
    else:
        dry = p.coulomb_force + p.coulomb_force_deceleration_change
        slope = p.viscous_friction + p.viscous_friction_deceleration_change
    return ramp * seal(p, dry, x, v, lower, upper) + abs(ramp) * (slope * v + p.direction_friction)


@compiled
def acceleration(
    p: Numbers,
    law: int,
    x: float,
    v: float,
    lower: float,
    upper: float,
    mass: float,
    drive: float,
) -> float:
    """m/s2, a with mass a + F_f(a) = drive; the left side rises with a."""
    way = -1.0 if v < 0.0 else 1.0
    slowing = drive - sliding(p, law, x, v, -way, lower, upper)
    if way * slowing <= 0.0:
        return slowing / mass
    # Speeding up; just above a = 0 the Stribeck term of eq. 6.5 is gone, that of 6.2 is not.
    starting = 1e-300 if law == ACCELERATION_DEPENDENT else 1.0
    at_low = way * (drive - sliding(p, law, x, v, way * starting, lower, upper))
    if at_low <= 0.0:
        return 0.0
    low, high = 0.0, way * slowing / mass + abs(drive) / mass
    at_high = way * (drive - sliding(p, law, x, v, way * high, lower, upper)) - mass * high
    last = -1.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        at_middle = way * (drive - sliding(p, law, x, v, way * middle, lower, upper))
        at_middle -= mass * middle
        root = sqrt(max(at_middle**2 - at_low * at_high, 0.0))
        new = middle
        if root > 0.0:
            new += (middle - low) * at_middle / root
        at_new = way * (drive - sliding(p, law, x, v, way * new, lower, upper)) - mass * new
        if at_middle > 0.0:
            low, at_low = middle, at_middle
        else:
            high, at_high = middle, at_middle
        if low < new < high:
            if at_new > 0.0:
                low, at_low = new, at_new
            else:
                high, at_high = new, at_new
        if high - low <= 4e-16 * high or abs(new - last) <= 2e-16 * new:
            return way * new
        last = new
    return way * 0.5 * (low + high)


@compiled
def steady(p: Numbers, speed: float) -> float:
    """N, g of eq. 6.1."""
    rise = p.stiction_force - p.coulomb_force
    return p.coulomb_force + rise * fall(p, speed, p.stribeck_velocity)


@compiled
def strength(p: Numbers, dry: float, x: float, v: float, lower: float, upper: float) -> float:
    """N that the bent seals can carry, at least 1 mN."""
    side = p.direction_friction * (1.0 if v > 0.0 else (-1.0 if v < 0.0 else 0.0))
    return max(1e-3, seal(p, dry, x, v, lower, upper) + side)


@compiled
def sliding_part(p: Numbers, v: float, z: float, largest: float) -> float:
    """lambda of the elasto-plastic blend, 0 to 1."""
    if p.breakaway_ratio <= 0.0:
        return 1.0
    elastic = p.breakaway_ratio * largest
    if v * z <= 0.0 or abs(z) <= elastic:
        return 0.0
    if abs(z) >= largest:
        return 1.0
    return 0.5 * (1.0 + sin(pi * (abs(z) - 0.5 * (largest + elastic)) / (largest - elastic)))


@compiled
def direct(
    p: Numbers, law: int, x: float, v: float, z: float, lower: float, upper: float
) -> tuple[float, float]:
    """Friction in N and z' in m/s of the laws that do not ask for the acceleration."""
    if law == STRIBECK:
        sign = 1.0 if v > 0.0 else (-1.0 if v < 0.0 else 0.0)
        return sign * steady(p, abs(v)) + p.viscous_friction * v, 0.0
    if law == DAHL:
        force = p.bristle_stiffness * z
        return force, v - abs(v) * force / strength(p, p.coulomb_force, x, v, lower, upper)
    largest = strength(p, steady(p, abs(v)), x, v, lower, upper) / p.bristle_stiffness
    rate = v - sliding_part(p, v, z, largest) * abs(v) * z / largest
    return p.bristle_stiffness * z + p.bristle_damping * rate + p.viscous_friction * v, rate
