"""Friction and its fit, timed against what one would write with numpy and scipy.

The equation is written here a second time, from the source (eq. 6.4 to 6.7), so that the peer owes
nothing to the core; both are held against each other before either is timed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.optimize
from numpy.typing import NDArray
from sms import _core

from validation.speed.timing import Goal, Row, fastest, row

Array = NDArray[np.float64]

SAMPLES = 20_000
FREE = ("coulomb_force", "viscous_friction", "pressure_friction", "bore_diameter")
AMBIENT_PRESSURE = 86.0e3  # Pa
ROD_DIAMETER = 0.025  # m
MOVING_MASS = 3.639  # kg
STICTION_FORCE = 77.27  # N
STRIBECK_VELOCITY, STRIBECK_EXPONENT, STRIBECK_ACCELERATION_FACTOR = 0.05, 1.4, 0.9
STICTION_VELOCITY = 0.005  # m/s


@dataclass(frozen=True)
class Motion:
    """One record of a moved cylinder: arrays of one length, SI."""

    extension: Array
    velocity: Array
    acceleration: Array
    pressure_lower: Array
    pressure_upper: Array


def random_motion(rng: np.random.Generator, n: int) -> Motion:
    """`n` samples anywhere in the working range of the cylinder."""
    return Motion(
        extension=rng.uniform(0.0, 0.4, n),
        velocity=rng.uniform(-0.3, 0.3, n),
        acceleration=rng.uniform(-2.0, 2.0, n),
        pressure_lower=rng.uniform(1e5, 5e5, n),
        pressure_upper=rng.uniform(1e5, 5e5, n),
    )


def friction_numpy(
    m: Motion, coulomb: float = 38.0, viscous: float = 530.0, pressure: float = 0.0
) -> Array:
    """Friction force, N, eq. 6.5 to 6.7 with pressure-dependent seals; the published cylinder."""
    speed = np.abs(m.velocity)
    width = np.abs(m.acceleration) * (STRIBECK_ACCELERATION_FACTOR * STRIBECK_VELOCITY)
    speeding_up = m.velocity * m.acceleration > 0.0
    slowness = np.divide(speed, width, out=np.full_like(speed, np.inf), where=speeding_up)
    stribeck = (STICTION_FORCE - coulomb) * np.exp(-(slowness**STRIBECK_EXPONENT))
    seals = pressure * (m.pressure_lower + m.pressure_upper - 2.0 * AMBIENT_PRESSURE)
    ramp = np.sin(np.pi / 2.0 * np.minimum(speed / STICTION_VELOCITY, 1.0))
    return ramp * (np.sign(m.velocity) * (coulomb + stribeck + seals) + viscous * m.velocity)


def rod_force_numpy(m: Motion, free: Array) -> Array:
    """Force on the load, N, eq. 6.4, for the four parameters of FREE."""
    coulomb, viscous, pressure, bore = free
    lower = np.pi / 4.0 * bore**2
    upper = lower - np.pi / 4.0 * ROD_DIAMETER**2
    gas = m.pressure_lower * lower - m.pressure_upper * upper - AMBIENT_PRESSURE * (lower - upper)
    force: Array = (
        gas - friction_numpy(m, coulomb, viscous, pressure) - MOVING_MASS * m.acceleration
    )
    return force


def _friction_core(m: Motion) -> Array:
    force: Array = np.asarray(
        _core.friction(
            _core.Params(),
            m.extension,
            m.velocity,
            m.acceleration,
            m.pressure_lower,
            m.pressure_upper,
        )
    )
    return force


def friction_rows(compiled: Mapping[str, float]) -> Iterator[Row]:
    """Time of one evaluation; `compiled` holds what libsms/bench measured, ns."""
    motion = random_motion(np.random.default_rng(1), SAMPLES)
    difference = np.max(np.abs(_friction_core(motion) - friction_numpy(motion)))
    if not difference < 1e-11:
        raise AssertionError(f"friction: core and numpy differ by {difference:.1e} N")
    peer = ("numpy, vectorised", fastest(lambda: friction_numpy(motion)) / SAMPLES * 1e9)
    for name in ("friction", "friction, float"):
        yield row(f"{name}, from C", compiled[name], "ns", peer, Goal(ratio_at_least=1.0))
    python = fastest(lambda: _friction_core(motion)) / SAMPLES * 1e9
    yield row("friction, arrays from Python", python, "ns", peer, Goal(ratio_at_least=1.0))


def fit_rows() -> Iterator[Row]:
    """Four parameters from 20000 noisy samples: exact derivatives against differences."""
    rng = np.random.default_rng(2)
    motion = random_motion(rng, SAMPLES)
    truth = np.array([31.0, 480.0, 7.5e-6, 0.1003])
    measured = rod_force_numpy(motion, truth) + rng.normal(0.0, 0.3, SAMPLES)

    problem = _core.CylinderProblem(
        [
            _core.CylinderRecord(
                extension=motion.extension,
                velocity=motion.velocity,
                acceleration=motion.acceleration,
                pressure_lower=motion.pressure_lower,
                pressure_upper=motion.pressure_upper,
                rod_force=measured,
            )
        ]
    )
    table = {info.name: info for info in _core.parameter_table()}
    bounds = [(name, table[name].lower, table[name].upper, 0.0) for name in FREE]
    start = np.array([_core.Params()[name] for name in FREE])

    def fit_core() -> _core.Fit:
        return _core.fit(problem, _core.Params(), bounds)

    def residual(free: Array) -> Array:
        return rod_force_numpy(motion, free) - measured

    def fit_scipy() -> Array:
        x: Array = scipy.optimize.least_squares(
            residual, start, x_scale="jac", ftol=1e-12, xtol=1e-12, gtol=1e-14
        ).x
        return x

    fit, x = fit_core(), fit_scipy()
    difference = max(abs(fit.params[n] / value - 1.0) for n, value in zip(FREE, x, strict=True))
    if not difference < 1e-8:
        raise AssertionError(f"fit: the two minima differ by {difference:.1e}, relative")
    scipy_time = fastest(fit_scipy, rounds=10) * 1e3
    yield row(
        "fit of 4 parameters, 20000 samples",
        fastest(fit_core, rounds=10) * 1e3,
        "ms",
        ("scipy least_squares, differences", scipy_time),
        Goal(ratio_at_least=1.0),
    )
