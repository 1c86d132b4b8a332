"""From poses to the mechanism as built: values, covariance, outliers, and the judgement on validation poses.

The equations and the search (Ceres) are the core's, libsms/estimation/poses.hpp. Every parameter has a prior, its
tolerance on the drawing; what the poses say is how much narrower its interval has become.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.calibration.combinations import Combination, combinations_of
from sms.calibration.rig import CHANNELS, Poses, PosesRig
from sms.parameters import PARAMETERS

LINKS = range(1, 7)
COVERAGE = 1.96
"""Standard deviations of an interval of 95 %."""
HUBER = 3.0
"""Standard deviations of a pose beyond which it counts with its distance, not its square."""
OUTLIER = 4.5
"""Standard deviations of a pose beyond which it is reported: of 30 good poses one in a thousand calibrations or so."""
MEASURED = 0.5
"""A parameter is called measured where its interval is at most this share of its tolerance."""


@dataclass(frozen=True)
class Unknown:
    """A parameter that is looked for, with the half width of its tolerance."""

    name: str  #: as in params.def; "sensor_gain_extension:2" is that of leg 2
    tolerance: float

    @property
    def deviation(self) -> float:
        """Standard deviation of the prior."""
        return self.tolerance / 2.0

    @property
    def unit(self) -> str:
        return PARAMETERS[self.name.partition(":")[0]].unit


def unknowns(rig: PosesRig) -> list[Unknown]:
    """All that is looked for."""
    of = rig.tolerances
    found = [
        Unknown(f"{side}_joint_{i}_{axis}", of["joint"])
        for side in ("base", "platform")
        for i in LINKS
        for axis in "xyz"
    ]
    found += [
        Unknown(f"{kind}_length_offset_{i}", of["length"])
        for kind in ("actuator", "panhard")
        for i in (1, 2, 3)
    ]
    found += [Unknown(f"sensor_gain_extension:{i}", of["sensor_gain"]) for i in (1, 2, 3)]
    found += [Unknown(f"sensor_offset_extension:{i}", of["extension_zero"]) for i in (1, 2, 3)]
    measured = np.asarray(np.isfinite(rig.fitted.pose).any(axis=0))
    names = [name for name, is_there in zip(("roll", "pitch"), measured, strict=False) if is_there]
    return found + [Unknown(f"sensor_offset_{name}", of["attitude_zero"]) for name in names]


@dataclass(frozen=True)
class Found:
    """One parameter: nominal, calibrated, standard deviation after and before, SI."""

    unknown: Unknown
    nominal: float
    value: float
    deviation: float

    @property
    def interval(self) -> tuple[float, float]:
        """Of 95 %."""
        return self.value - COVERAGE * self.deviation, self.value + COVERAGE * self.deviation

    @property
    def measured(self) -> bool:
        """Whether the poses say it, not the drawing."""
        return self.deviation <= MEASURED * self.unknown.deviation


@dataclass(frozen=True)
class Outlier:
    """A pose that does not fit."""

    row: int  #: in its file, from 1
    deviations: float  #: how far off it is, in standard deviations of its noise
    error: Array  #: (6 + distances,) measured less calibrated, rad and m; NaN: not measured


@dataclass(frozen=True, eq=False)
class Judgement:
    """Errors on the validation poses, measured less predicted, (n, 6 + distances) in rad and m."""

    before: Array
    after: Array

    def rms(self, errors: Array, channels: slice) -> float:
        """Root mean square over the poses and some channels; NaN where none was measured."""
        part = errors[:, channels]
        part = part[np.isfinite(part)]
        return float(np.sqrt(np.mean(part**2))) if part.size else float("nan")

    @property
    def attitude(self) -> tuple[float, float]:
        """Before and after, rad."""
        return self.rms(self.before, slice(0, 2)), self.rms(self.after, slice(0, 2))

    @property
    def distance(self) -> tuple[float, float]:
        """Before and after, m."""
        behind = slice(len(CHANNELS), None)
        return self.rms(self.before, behind), self.rms(self.after, behind)


@dataclass(frozen=True, eq=False)
class Calibrated:
    """All that a calibration found."""

    rig: PosesRig
    params: _core.LegParams
    nominal: _core.LegParams
    found: tuple[Found, ...]
    covariance: Array  #: (parameters, parameters), SI
    combinations: tuple[Combination, ...]
    outliers: tuple[Outlier, ...]
    errors_before: Array  #: of the fitted poses, (n, 6 + distances)
    errors_after: Array
    validation: Judgement
    iterations: int
    converged: bool
    scaled: Array  #: (rows, parameters) whitened Jacobian over the prior's deviations, with the weights of the loss


def problem_of(poses: Poses, rig: PosesRig, start: _core.LegParams) -> _core.PoseProblem:
    """The poses, held against the core's forward kinematics."""
    return _core.PoseProblem(
        extension=poses.extension,
        pose=poses.pose,
        extension_noise=rig.extension_noise,
        pose_noise=rig.pose_noise,
        start=start,
        ground_marks=np.array([d.ground for d in rig.distances]).reshape(-1, 3),
        platform_marks=np.array([d.platform for d in rig.distances]).reshape(-1, 3),
    )


def calibrate_poses(
    rig: PosesRig, nominal: _core.Params | None = None, huber: float = HUBER
) -> Calibrated:
    """Fit the mechanism to the poses of a rig. InputError, or ValueError of the core for poses out of reach."""
    start = _core.LegParams(nominal or _core.Params())
    looked_for = unknowns(rig)
    names = [u.name for u in looked_for]
    prior = np.array([u.deviation for u in looked_for])
    problem = problem_of(rig.fitted, rig, start)
    fit = _core.calibrate(problem, start, names, prior, huber)
    distances, weights = _distances(problem.first_row, fit.residual, huber)
    scaled = fit.jacobian * prior * weights[:, None]
    covariance = covariance_of(scaled)
    deviation = np.sqrt(np.diag(covariance)) * prior
    found = tuple(
        Found(u, start[u.name], fit.params[u.name], float(s))
        for u, s in zip(looked_for, deviation, strict=True)
    )
    after = rig.fitted.pose - problem.predict(fit.params)
    outliers = tuple(
        Outlier(int(rig.fitted.row[i]), float(distances[i]), after[i])
        for i in np.flatnonzero(distances > OUTLIER)
    )
    return Calibrated(
        rig=rig,
        params=fit.params,
        nominal=start,
        found=found,
        covariance=covariance * np.outer(prior, prior),
        combinations=combinations_of(fit.params, names, prior, scaled),
        outliers=outliers,
        errors_before=rig.fitted.pose - problem.predict(start),
        errors_after=after,
        validation=judge(rig, start, fit.params),
        iterations=fit.iterations,
        converged=fit.converged,
        scaled=scaled,
    )


def covariance_of(scaled: Array) -> Array:
    """Of the parameters over their prior's deviations: (J^T J + I)^-1."""
    return np.asarray(np.linalg.inv(scaled.T @ scaled + np.eye(scaled.shape[1])))


def judge(rig: PosesRig, before: _core.LegParams, after: _core.LegParams) -> Judgement:
    """The validation poses, with the nominal and with the calibrated mechanism."""
    if not len(rig.validation):
        none = np.empty((0, len(rig.channels)))
        return Judgement(none, none)
    problem = problem_of(rig.validation, rig, before)
    measured = rig.validation.pose
    return Judgement(measured - problem.predict(before), measured - problem.predict(after))


def _distances(first_row: Sequence[int], residual: Array, huber: float) -> tuple[Array, Array]:
    """How far each pose is off, and the root of the loss's weight of each row."""
    distances = np.array([np.linalg.norm(residual[a:b]) for a, b in pairwise(first_row)])
    weight = (
        np.sqrt(huber / np.maximum(distances, huber)) if huber > 0.0 else np.ones(len(distances))
    )
    return distances, np.repeat(weight, np.diff(first_row))
