"""Kinematic round trip (section 3.5) and the force-controlled platform (section 3.4)."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

from sms import forward_dynamics, forward_kinematics, inverse_kinematics, jacobian
from sms._core import Params
from sms.arrays import Array
from sms.dynamics import holding_force
from sms.validation.figures import FIGURES, Row, peak_to_peak

_RANGE, _FIRSTS = 0.1, 41  # rad; the published table has 201, which take five times as long here
_HEIGHT = 0.5  # m
_SUPPLY = 0.6e6  # Pa above ambient, section 3.4
_BANDWIDTH = 12.0  # rad/s, of the critically damped loop; its gains are not published
_FIRST = 0.02  # m, extension where it begins
_LASTS = 2.0  # s


def round_trip() -> list[Row]:
    """Attitude to extensions and back, over the attitudes of the published table."""
    angles = np.linspace(-_RANGE, _RANGE, _FIRSTS)
    roll, pitch = (grid.ravel() for grid in np.meshgrid(angles, angles))
    extension = inverse_kinematics(roll, pitch, _HEIGHT).extension
    back = forward_kinematics(extension)
    error = np.abs(
        np.column_stack([back.roll - roll, back.pitch - pitch, back.height - _HEIGHT])
    ).max()
    return [FIGURES["round_trip"].row(float(error), f"{roll.size} attitudes within ±{_RANGE} rad")]


def force_control() -> list[Row]:
    """The mechanism alone under three PD loops, extensions in, forces out; no pneumatics.

    The published gains are unknown: here each leg has a critically damped loop around the mass it
    feels in heave, with the weight's force added.
    """
    params = Params()
    most = math.pi / 4.0 * params.bore_diameter**2 * _SUPPLY
    rest = forward_kinematics([_FIRST] * 3)
    start = np.array([0.0, 0.0, float(rest.height)])
    holding = holding_force(start)
    per_height = float(jacobian(start)[..., 2].mean())
    # M of heave, kg: the force that an acceleration of 1 m/s^2 asks for.
    free = forward_dynamics(start, np.zeros(3), holding + 100.0)[2]
    mass = 100.0 / (free * per_height)
    target = np.full(3, 0.5 * params.stroke)

    def force(state: Array) -> Array:
        slope = jacobian(state[:3])
        extension = inverse_kinematics(*state[:3]).extension
        rate = slope @ state[3:]
        wanted = mass * (_BANDWIDTH**2 * (target - extension) - 2.0 * _BANDWIDTH * rate)
        return np.asarray(np.clip(holding_force(state[:3]) + wanted, -most, most))

    def rate_of(_: float, state: Array) -> Array:
        acceleration = forward_dynamics(state[:3], state[3:], force(state))
        return np.concatenate([state[3:], acceleration])

    begin = np.concatenate([start, np.zeros(3)])
    times = np.linspace(0.0, _LASTS, 201)
    done = solve_ivp(rate_of, (0.0, _LASTS), begin, t_eval=times, rtol=1e-6, atol=1e-8)
    states = done.y.T
    forces = np.array([force(state) for state in states])
    pose = inverse_kinematics(*states[:, :3].T)
    error = float(np.abs(pose.extension[-1] - target).max())
    remark = f"from {1e3 * _FIRST:.0f} mm to mid-stroke; own gains, as none are published"
    return [
        FIGURES["force_limit"].row(float(np.abs(forces).max()), remark),
        FIGURES["force_settles"].row(error),
        FIGURES["force_yaw"].row(peak_to_peak(np.asarray(pose.yaw))),
    ]
