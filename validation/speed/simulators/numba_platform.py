"""The platform under the published controller by numba: classical Runge-Kutta steps of fixed size.

Air, valve and mechanism are those of validation/reference/plants, which owe nothing to the core. What is
here is what one adds for speed: the coupled friction of the pistons by Newton's method from the
last accelerations, the controller and the step.
"""

from __future__ import annotations

from math import atan, exp, pi

import numpy as np
from sms import Params
from sms.arrays import Array

from validation.reference.compiled import compiled
from validation.reference.plants.actuator import P_LOWER, P_UPPER, Laws, air_rates, rod_drive
from validation.reference.plants.flow import valve_map
from validation.reference.plants.friction import sliding
from validation.reference.plants.mechanism import Mechanism, equations
from validation.reference.plants.numbers import Numbers, numbers_of
from validation.reference.plants.platform import coupled, mechanism_from

PUBLISHED = Laws(valve=1, friction=0, chamber=0)


@compiled
def slope_of_fall(p: Numbers, v: float, a: float) -> float:
    """N/(m/s2), d F_f/d a of eq. 6.5 while speeding up beyond the ramp of eq. 6.7, else 0."""
    if v * a <= 0.0:
        return 0.0
    width = p.stribeck_velocity * p.stribeck_acceleration_factor * abs(a)
    if width <= 0.0 or abs(v) >= 1e6 * width:
        return 0.0
    power = (abs(v) / width) ** p.stribeck_exponent
    rise = p.stiction_force - p.coulomb_force
    return float(
        min(1.0, abs(v) / p.stiction_velocity)
        * rise
        * exp(-power)
        * p.stribeck_exponent
        * power
        / abs(a)
    )


@compiled
def balanced(
    p: Numbers, x: Array, v: Array, lower: Array, upper: Array, mass: Array, drive: Array, a: Array
) -> None:
    """m/s2: mass a + F_f(v, a) = drive by Newton's method from `a`; the slow way where it fails."""
    matrix, off = np.empty((3, 3)), np.empty(3)
    for _ in range(12):
        for i in range(3):
            off[i] = drive[i] - sliding(p, 0, x[i], v[i], a[i], lower[i], upper[i])
            for k in range(3):
                off[i] -= mass[i, k] * a[k]
                matrix[i, k] = mass[i, k]
            matrix[i, i] += slope_of_fall(p, v[i], a[i])
        m = matrix
        c0 = m[1, 1] * m[2, 2] - m[1, 2] * m[2, 1]
        c1 = m[1, 2] * m[2, 0] - m[1, 0] * m[2, 2]
        c2 = m[1, 0] * m[2, 1] - m[1, 1] * m[2, 0]
        scale = 1.0 / (m[0, 0] * c0 + m[0, 1] * c1 + m[0, 2] * c2)
        s0 = scale * (
            c0 * off[0]
            + (m[0, 2] * m[2, 1] - m[0, 1] * m[2, 2]) * off[1]
            + (m[0, 1] * m[1, 2] - m[0, 2] * m[1, 1]) * off[2]
        )
        s1 = scale * (
            c1 * off[0]
            + (m[0, 0] * m[2, 2] - m[0, 2] * m[2, 0]) * off[1]
            + (m[0, 2] * m[1, 0] - m[0, 0] * m[1, 2]) * off[2]
        )
        s2 = scale * (
            c2 * off[0]
            + (m[0, 1] * m[2, 0] - m[0, 0] * m[2, 1]) * off[1]
            + (m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0]) * off[2]
        )
        a[0] += s0
        a[1] += s1
        a[2] += s2
        largest = max(abs(a[0]), abs(a[1]), abs(a[2]))
        if max(abs(s0), abs(s1), abs(s2)) <= 6e-8 * largest:
            return
    a[:] = 0.0
    coupled(p, 0, x, v, lower, upper, mass, drive, a)


@compiled
def inverse(m: Array, to: Array) -> None:
    """Of a 3 by 3 matrix, by cofactors."""
    for i in range(3):
        for k in range(3):
            a, b, c, d = (k + 1) % 3, (k + 2) % 3, (i + 1) % 3, (i + 2) % 3
            to[i, k] = m[a, c] * m[b, d] - m[a, d] * m[b, c]
    determinant = m[0, 0] * to[0, 0] + m[0, 1] * to[1, 0] + m[0, 2] * to[2, 0]
    for i in range(3):
        for k in range(3):
            to[i, k] /= determinant


@compiled
def platform_rate(
    p: Numbers,
    laws: Laws,
    map_: Array,
    m: Mechanism,
    y: Array,
    commands: Array,
    memory: Array,
    work: Array,
    x: Array,
    dy: Array,
) -> None:
    """dy/dt; `memory` (2, 3) keeps yaw, x, y and the accelerations for the next search, `work` is
    (4, 3, 3), `x` are the extensions."""
    matrix, slope, back, mass = work[0], work[1], work[2], work[3]
    bias, x_bias, v, force = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    lower, upper, drive, q = np.empty(3), np.empty(3), np.empty(3), y[3:6]
    equations(m, y[0:3], q, memory[0], matrix, bias, slope, x, x_bias)
    for i in range(3):
        v[i] = slope[i, 0] * q[0] + slope[i, 1] * q[1] + slope[i, 2] * q[2]
        air, rates = y[6 + 10 * i : 16 + 10 * i], dy[6 + 10 * i : 16 + 10 * i]
        air_rates(p, laws, map_, air, x[i], v[i], commands[i], rates)
        force[i] = rod_drive(p, air, x[i], v[i])
        lower[i], upper[i] = air[P_LOWER], air[P_UPPER]
        rates[8] = 0.0
    inverse(slope, back)
    for i in range(3):
        for k in range(3):
            total = 0.0
            for r in range(3):
                for s in range(3):
                    total += back[r, i] * matrix[r, s] * back[s, k]
            mass[i, k] = total
    for i in range(3):
        drive[i] = force[i]
        for k in range(3):
            drive[i] += mass[i, k] * x_bias[k] - back[k, i] * bias[k]
    balanced(p, x, v, lower, upper, mass, drive, memory[1])
    for i in range(3):
        dy[i] = q[i]
        dy[3 + i] = 0.0
        for k in range(3):
            dy[3 + i] += back[i, k] * (memory[1, k] - x_bias[k])


@compiled
def over_dead_band(step: float, sharpness: float, voltage: float) -> float:
    """V, eq. 7.5 and 7.6."""
    gain = (5.0 - 2.0 / pi * step * atan(5.0 * sharpness)) / 5.0
    return float(gain * voltage + 2.0 / pi * step * atan(sharpness * voltage))


@compiled
def closed_loop(
    p: Numbers,
    laws: Laws,
    map_: Array,
    m: Mechanism,
    start: Array,
    setpoint: Array,
    control: tuple[float, float, float, float, float],
    steps: int,
    path: Array,
) -> None:
    """Extensions at every sample into `path`, (n, 3); `control` is (gain, step, sharpness, offset,
    period), `steps` are those in one period."""
    gain, step, sharpness, offset, period = control
    y, at, total = start.copy(), np.empty(36), np.empty(36)
    k, work, memory = np.empty(36), np.empty((4, 3, 3)), np.zeros((2, 3))
    memory[0, 0], memory[0, 1], memory[0, 2] = 0.0, m.reference[0], m.reference[1]
    x, unused, commands = np.empty(3), np.empty(3), np.full(3, offset)
    h = period / steps
    for sample in range(len(setpoint)):
        platform_rate(p, laws, map_, m, y, commands, memory, work, x, k)
        for i in range(3):
            path[sample, i] = x[i]
            u = min(5.0, max(-5.0, gain * (setpoint[sample, i] - x[i])))
            commands[i] = min(10.0, max(0.0, offset + over_dead_band(step, sharpness, u)))
        for _ in range(steps):
            for stage in range(4):
                if stage == 0:
                    platform_rate(p, laws, map_, m, y, commands, memory, work, unused, k)
                else:
                    platform_rate(p, laws, map_, m, at, commands, memory, work, unused, k)
                weight = h / 6.0 if stage in (0, 3) else h / 3.0
                ahead = h if stage == 2 else 0.5 * h
                for i in range(36):
                    total[i] = (y[i] if stage == 0 else total[i]) + weight * k[i]
                    at[i] = y[i] + ahead * k[i]
            y[:] = total


def control_of(p: Params) -> tuple[float, float, float, float, float]:
    """(gain, step, sharpness, offset, period) of the published controller."""
    return (
        float(p["proportional_gain"]),
        float(p["dead_band_step"]),
        float(p["dead_band_sharpness"]),
        float(p["command_offset"]),
        float(p["control_period"]),
    )


class NumbaPlatform:
    """Ready to run, everything that does not change looked up; the default parameters."""

    def __init__(self, start: Array) -> None:
        p = Params()
        self.fixed = (numbers_of(p), PUBLISHED, valve_map("iso_0_4_mpa"), mechanism_from(p))
        self.start = start
        self.control = control_of(p)

    def run(self, setpoint: Array, steps: int) -> Array:
        """Extensions at every sample, m, (n, 3), by `steps` steps in a period."""
        path = np.empty_like(setpoint)
        closed_loop(*self.fixed, self.start, setpoint, self.control, steps, path)
        return path
