"""Detection limit: the smallest value of an effect that these records can show at all.

Generalised least squares on the moving samples of the `identify` records. With s the
sensitivity of the residual to the effect, N the sensitivities to what a diagnosis may move
anyway, and C the covariance of the noise, the information on the effect alone is

    i = s'C^-1 s - s'C^-1 N (N'C^-1 N + P)^-1 N'C^-1 s

where P holds 1/uncertainty^2 for a parameter that is known within a declared uncertainty and
zero for a free one. The standard deviation of the best unbiased estimate is i^-1/2
(Gauss-Markov), and the effect counts as detectable from SIGMAS of them on.

The noise is white plus an Ornstein-Uhlenbeck process. The inverse covariance of the latter at
uneven instants is tridiagonal, T, so with white variance w (Woodbury)

    C^-1 = (I - (I + w T)^-1) / w

is applied exactly in O(n), whatever the gaps between moving stretches.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

from validation.twins.cylinder.effects import Effect, sensitivity
from validation.twins.cylinder.motion import Array, Cylinder, ExtraFriction
from validation.twins.cylinder.sensors import Samples, Sensors

SIGMAS = 5.0
"""Standard deviations of its own estimate that an effect must reach."""
NOISE_SHARE = 0.10
"""Share of the noise's RMS that the change of force must reach."""
SPEED_ABOVE = 4e-3
"""Only samples faster than this are compared [m/s]."""


@dataclass(frozen=True)
class Uncertainty:
    """Declared half widths; the Coulomb force is always free."""

    bore_diameter: float = 0.01e-3  # m
    moving_mass: float = 0.05  # kg
    viscous_friction: float = 5.0  # N s/m


def white_variance(sensors: Sensors, cylinder: Cylinder) -> float:
    """Variance of the residual's white part [N2]: force and pressure noise, both converters."""
    force = sensors.force_white**2 + sensors.force_step**2 / 12.0
    pressure = sensors.pressure_noise**2 + sensors.pressure_step**2 / 12.0
    return force + cylinder.piston_area**2 * pressure


def noise_rms(sensors: Sensors, cylinder: Cylinder) -> float:
    """RMS of the whole noise in the residual [N]."""
    return float(np.sqrt(white_variance(sensors, cylinder) + sensors.force_coloured**2))


def weigh(columns: Array, time: Array, white: float, coloured: float, tau: float) -> Array:
    """C^-1 times `columns`, shape (n, k), for instants `time` [s], white and coloured variance."""
    if coloured <= 0.0:
        return columns / white
    memory = np.exp(-np.diff(time) / tau)
    fresh = 1.0 - memory**2
    diagonal = np.ones_like(time)
    diagonal[1:] = 1.0 / fresh
    diagonal[:-1] += memory**2 / fresh
    bands = np.zeros((2, time.size))
    bands[0] = 1.0 + white / coloured * diagonal
    bands[1, :-1] = -white / coloured * memory / fresh
    smooth = solveh_banded(bands, columns, lower=True)
    return np.asarray((columns - smooth) / white, dtype=np.float64)


def _nuisances(samples: Samples, cylinder: Cylinder) -> Array:
    """Sensitivities to Coulomb force, bore, viscous friction and mass, shape (n, 4)."""
    by_bore = -2.0 * cylinder.piston_area / cylinder.bore_diameter * samples.gauge_pressure
    return np.column_stack(
        (np.sign(samples.velocity), by_bore, samples.velocity, samples.acceleration)
    )


def detection_limit(
    effect: Effect,
    records: Sequence[Samples],
    cylinder: Cylinder,
    sensors: Sensors,
    *,
    shape: ExtraFriction,
    uncertainty: Uncertainty,
) -> float:
    """Smallest detectable value of `effect` (its own unit, positive) on the `identify` records.

    The larger of two: where it reaches `SIGMAS` standard deviations of the noise as it is, and
    where the part of it that no Coulomb force imitates has `NOISE_SHARE` of the noise's RMS.
    An uncertainty of zero means that the parameter is known exactly.
    """
    white = white_variance(sensors, cylinder)
    known = np.array(
        [uncertainty.bore_diameter, uncertainty.viscous_friction, uncertainty.moving_mass]
    )
    movable = [0, *(np.flatnonzero(known > 0.0) + 1).tolist()]
    information = np.zeros((1 + len(movable),) * 2)
    plain = np.zeros((2, 2))
    count = 0
    for samples in records:
        moving = np.abs(samples.velocity) > SPEED_ABOVE
        column = sensitivity(effect, samples, cylinder, shape)
        design = np.column_stack((column, _nuisances(samples, cylinder)[:, movable]))[moving]
        weighed = weigh(
            design,
            samples.time[moving],
            white,
            sensors.force_coloured**2,
            sensors.force_correlation_time,
        )
        information += design.T @ weighed
        plain += design[:, :2].T @ design[:, :2]
        count += int(np.count_nonzero(moving))
    prior = np.concatenate(([0.0], 1.0 / known[known > 0.0] ** 2))
    alone = _eliminate(information[1:, 1:] + np.diag(prior), information)
    shape_rms = np.sqrt(_eliminate(plain[1:, 1:], plain) / count)
    return float(
        max(SIGMAS / np.sqrt(alone), NOISE_SHARE * noise_rms(sensors, cylinder) / shape_rms)
    )


def _eliminate(block: Array, information: Array) -> float:
    """Information left on the first parameter when the others, with `block`, are fitted too."""
    cross = information[1:, 0]
    scale = 1.0 / np.sqrt(np.diag(block))
    solution = np.linalg.solve(block * np.outer(scale, scale), scale * cross) * scale
    return float(information[0, 0] - cross @ solution)
