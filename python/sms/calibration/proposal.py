"""The poses to measure next: D-optimal among what the machine reaches, away from the ends of the stroke."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms.arrays import Array
from sms.calibration.fit import Calibrated, covariance_of, problem_of
from sms.calibration.rig import Poses
from sms.kinematics import inverse_kinematics

NEXT = 6
"""Poses that are proposed."""
END_MARGIN = 0.02
"""m, that an actuator keeps from both ends of its stroke."""
LARGEST_TILT = 0.3
"""rad, of roll and pitch in the grid of candidates."""
_GRID = 9


@dataclass(frozen=True)
class Proposal:
    """One pose to measure."""

    q: Array  #: roll, pitch in rad, height in m
    extension: Array  #: (3,) m
    gain: float  #: by which factor the geometric mean deviation of all parameters shrinks


def candidates(calibrated: Calibrated) -> tuple[Array, Array]:
    """(q, extension) of a grid over what the stroke allows with a margin, (n, 3) each."""
    params = calibrated.params
    level = calibrated.nominal
    low = -float(level["reference_point_z"])
    angles = np.linspace(-LARGEST_TILT, LARGEST_TILT, _GRID)
    heights = np.linspace(low, low + params.stroke, _GRID)
    grid = np.stack(np.meshgrid(angles, angles, heights, indexing="ij"), axis=-1).reshape(-1, 3)
    extension = inverse_kinematics(*grid.T, params=params).extension
    safe = np.all((extension >= END_MARGIN) & (extension <= params.stroke - END_MARGIN), axis=1)
    return grid[safe], extension[safe]


def propose(calibrated: Calibrated, count: int = NEXT) -> tuple[Proposal, ...]:
    """One after the other, the pose that shrinks the volume of the parameters' ellipsoid most."""
    rig = calibrated.rig
    q, extension = candidates(calibrated)
    measured = np.isfinite(rig.fitted.pose).any(axis=0)
    readings = np.where(measured, 0.0, np.nan) * np.ones((len(q), len(rig.channels)))
    problem = problem_of(Poses(extension, readings, np.arange(len(q))), rig, calibrated.params)
    prior = np.array([f.unknown.deviation for f in calibrated.found])
    names = [f.unknown.name for f in calibrated.found]
    _, jacobian = problem.evaluate(calibrated.params, names)
    blocks = (jacobian * prior).reshape(len(q), -1, len(names))
    covariance = covariance_of(calibrated.scaled)
    chosen = []
    for _ in range(min(count, len(q))):
        spread = blocks @ covariance @ blocks.transpose(0, 2, 1) + np.eye(blocks.shape[1])
        told = np.linalg.slogdet(spread)[1]
        best = int(np.argmax(told))
        chosen.append(
            Proposal(q[best], extension[best], float(np.exp(-0.5 * told[best] / len(names))))
        )
        held = covariance @ blocks[best].T
        covariance = covariance - held @ np.linalg.solve(spread[best], held.T)
    return tuple(chosen)
