"""One law of friction held against motions: what can be fitted, the fit, and how sure each parameter is.

Before a fit the excitation is asked which parameters it can show: one whose column nearly is a combination of the
others' (collinearity index of Brun et al. 2001 beyond COLLINEAR) is left where it is declared, and said. Standard
errors respect any correlation within a stroke. Friction differs from run to run; so every error is also found by
leaving out one run at a time (the jackknife), and the larger one stands. The scatter of runs fitted alone would not
do: what differs between runs may look like a term that no run shows by itself.

An error is itself estimated, from a few runs or some tens of blocks, so that intervals are Student's t with as many
degrees of freedom. A parameter that is zero without its effect counts as shown where it would hardly be so by chance:
FALSE is the chance of claiming any of a law's parameters on a record set without them, shared among them (Bonferroni).
How often that happens is counted by validation/trials/identify_friction.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from sms import _core
from sms.arrays import Array
from sms.errors import InputError
from sms.estimation.block_statistics import covariance_of, merge_windows, windows_per_block
from sms.identification.estimate import Estimate, Free, estimate, with_start
from sms.parameters import PARAMETERS
from sms.rigs.cylinder import Motion, core_record, rows_of

COLLINEAR = 10.0
"""Collinearity index beyond which a parameter only repeats others (Brun et al.: 5 to 20)."""
FELT = 0.05
"""Least share of the residual's scatter that a parameter must move at its usual size."""
FALSE = 0.05
"""Chance of claiming any parameter of a law that the truth does not have."""
ALWAYS = ("coulomb_force", "viscous_friction")
_DRY = ("coulomb_force", "sensor_offset_rod_force", "viscous_friction")
_TWO_SIDES = ("coulomb_force_deceleration_change", "viscous_friction_deceleration_change")
LAWS: dict[str, tuple[str, ...]] = {
    "stribeck": _DRY,
    "two_branch": (*_DRY, *_TWO_SIDES),
    "acceleration_dependent": (*_DRY, *_TWO_SIDES, "exponential_friction_force"),
    "lugre": (*_DRY, "bristle_stiffness", "bristle_damping"),
}
"""What each law is fitted by beside its Stribeck term, the most telling first."""
STRIBECK: dict[str, tuple[str, str]] = {
    "stribeck": ("stiction_force", "stribeck_velocity"),
    "two_branch": ("stiction_force", "stribeck_velocity"),
    "acceleration_dependent": ("stiction_force", "stribeck_acceleration_factor"),
    "lugre": ("stiction_force", "stribeck_velocity"),
}
"""The fall from static to Coulomb friction; in eq. 6.5 only zeta v_S counts, so v_S stays."""
EQUATION = {
    "stribeck": "eq. 6.1",
    "two_branch": "eq. 6.2",
    "acceleration_dependent": "eq. 6.5",
    "lugre": "LuGre",
}
_USUAL = {
    "sensor_offset_rod_force": 5.0,
    "coulomb_force_deceleration_change": 5.0,
    "viscous_friction_deceleration_change": 50.0,
    "exponential_friction_force": 2.0,
}
"""Size of a parameter whose default is zero, to judge whether the records are sensitive to it; SI."""


@dataclass(frozen=True)
class Told:
    """One parameter of a law."""

    name: str
    value: float
    error: float
    """Standard error: the fit's, or that of leaving out one run at a time, where it is larger."""
    freedom: int
    """Degrees of freedom of that error."""
    judged: int
    """How many parameters of the law are judged together; 1 for what no cylinder lacks."""
    scatter: float
    """Standard deviation over the runs, each fitted alone; nan with fewer than two."""
    runs: tuple[float, ...]
    """The value of each run alone."""

    @property
    def half_width(self) -> float:
        """Of its 95 percent interval."""
        return float(student.ppf(0.975, self.freedom)) * self.error

    @property
    def shown(self) -> bool:
        """Whether it would hardly be so far from zero by chance, among all that are judged."""
        limit = student.ppf(1.0 - 0.5 * FALSE / self.judged, self.freedom)
        return bool(np.isfinite(self.error)) and abs(self.value) > limit * self.error


@dataclass(frozen=True)
class LawFit:
    """One law of friction."""

    law: str
    found: Estimate
    told: tuple[Told, ...]
    left_out: tuple[tuple[str, str], ...]
    """(parameter, why this excitation cannot show it)"""
    rms_identify: float
    """N, over the compared samples."""
    rms_validate: float
    """N; nan without such records."""


def problem_of(
    motions: Sequence[Motion], law: str
) -> tuple[_core.CylinderProblem, NDArray[np.bool_]]:
    """All samples of the records, and which of them are compared."""
    records = [core_record(m, slice(None)) for m in motions]
    return _core.CylinderProblem(records, law), np.concatenate([m.used for m in motions])


def fit_law(
    law: str,
    identify: Sequence[Motion],
    validate: Sequence[Motion],
    start: _core.Params,
    asked: Sequence[str],
    loaded: bool = True,
) -> LawFit:
    """Fit one law; without a load cell (`loaded`) there is no zero error of it to fit."""
    problem, used = problem_of(identify, law)
    wanted = [n for n in dict.fromkeys((*LAWS[law], *asked)) if loaded or "rod_force" not in n]
    names, left_out, start = _choose(problem, used, law, start, wanted)
    found = _estimate(problem, used, start, names)
    record, stroke = rows_of(identify)
    together = windows_per_block(found.residual[used], record, stroke)
    block = merge_windows(record, stroke, together)
    covariance = covariance_of(found.jacobian[used], found.residual[used], block)
    between = leaving_out_runs(
        found.jacobian[used], found.residual[used], record, ~np.array(found.at_bound)
    )
    alone = [_alone(m, law, (found.params, start), names) for m in identify]
    own_freedom = max(int(block.max()) + 1 - len(names), 1)
    told = []
    for i, name in enumerate(names):
        runs = tuple(float(a.value[i]) for a in alone)
        scatter = float(np.std(runs, ddof=1)) if len(runs) > 1 else np.nan
        own = float(np.sqrt(covariance[i, i])) if not found.at_bound[i] else np.nan
        error = float(np.fmax(own, between[i]))
        freedom = own_freedom if error == own else len(runs) - 1
        value = float(found.value[i])
        judged = 1 if name in ALWAYS else len(names)
        told.append(Told(name, value, error, max(freedom, 1), judged, scatter, runs))
    return LawFit(
        law, found, tuple(told), left_out,
        rms_of(found.residual[used]), _validated(validate, law, found.params),
    )  # fmt: skip


def leaving_out_runs(
    jacobian: Array, residual: Array, run: NDArray[np.int64], inside: NDArray[np.bool_]
) -> Array:
    """(k,): standard errors by the jackknife over runs, each refit by one step; nan with one run or at a bound.

    jacobian (n, k) and residual (n,) at the solution; run (n,) of each row; inside (k,): not at a bound.
    """
    out = np.full(jacobian.shape[1], np.nan)
    runs = np.unique(run)
    if runs.size < 2 or not inside.any():
        return out
    length = np.linalg.norm(jacobian[:, inside], axis=0)
    j = jacobian[:, inside] / np.maximum(length, 1e-300)
    normal = j.T @ j
    shifts = []
    for number in runs:
        own = j[run == number]
        left = np.linalg.pinv(normal - own.T @ own, rcond=1e-12, hermitian=True)
        shifts.append(left @ (own.T @ residual[run == number]))
    scatter = np.sum((np.array(shifts) - np.mean(shifts, axis=0)) ** 2, axis=0)
    out[inside] = np.sqrt(scatter * (runs.size - 1) / runs.size) / length
    return out


def _choose(
    problem: _core.CylinderProblem,
    used: NDArray[np.bool_],
    law: str,
    start: _core.Params,
    wanted: Sequence[str],
) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...], _core.Params]:
    """What can be fitted, what cannot and why, and where to start.

    The Stribeck term comes right after Coulomb and viscous friction, as in the law's own story: what slowing down
    changes may imitate it, and would otherwise take its place. It is asked about with its fall at half of its usual
    velocity and twice the Coulomb force, where it would show best.
    """
    height, width = STRIBECK[law]
    plain = with_start(start, **{width: PARAMETERS[width].lower})
    plain = _estimate(problem, used, plain, _DRY[:2]).params
    plain.stiction_force = plain.coulomb_force
    falling = with_start(plain, **{height: 2.0 * plain.coulomb_force, width: start[width] or 1e-3})
    rest = [n for n in wanted if n not in (*_DRY, height, width)]
    dry = [n for n in wanted if n in _DRY]
    names, left_out = showable(problem, used, falling, (*dry, height, width, *rest))
    if height in names and width in names:
        return names, left_out, falling
    unfelt = any(n in (height, width) and "insensitive" in why for n, why in left_out)
    reason = (
        "these motions are insensitive to it"
        if unfelt
        else "the transition from static to Coulomb friction is not distinguishable from the other parameters"
    )
    names, left_out = showable(problem, used, plain, (*dry, *rest))
    return names, (*left_out, (height, reason), (width, reason)), plain


def _alone(
    motion: Motion, law: str, starts: Sequence[_core.Params], names: Sequence[str]
) -> Estimate:
    """Of one record by itself, from the first start at which it tells every parameter; InputError where there is none.

    Values at a bound may hide one from another.
    """
    *others, last = starts
    for start in others:
        with suppress(ValueError):
            return _estimate(*problem_of([motion], law), start, names)
    try:
        return _estimate(*problem_of([motion], law), last, names)
    except ValueError as problem:
        raise InputError(
            f"record {motion.name}: by itself it cannot be fitted ({problem}); give it the role 'validate', "
            "or compare more of it: [data] speed_above"
        ) from None


def _estimate(
    problem: _core.CylinderProblem,
    used: NDArray[np.bool_],
    start: _core.Params,
    names: Sequence[str],
) -> Estimate:
    residual, _ = problem.evaluate(start)
    spread = max(rms_of(residual[used]), 1e-9)
    free = [Free.of(name) for name in names]
    return estimate(problem, [start], free, used / spread, used)


def showable(
    problem: _core.Problem,
    used: NDArray[np.bool_],
    params: _core.Params,
    wanted: Sequence[str],
) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """Which of `wanted` this excitation can tell apart, in their order, and why not the others."""
    residual, jacobian = problem.evaluate(params, list(wanted))
    columns = jacobian[used]
    spread = max(rms_of(residual[used]), 1e-9)
    kept: list[str] = []
    basis = np.empty((columns.shape[0], 0))
    left_out = []
    for name, column in zip(wanted, columns.T, strict=True):
        usual = abs(params[name]) or _USUAL.get(name, PARAMETERS[name].uncertainty or 1.0)
        if usual * rms_of(column) < FELT * spread:
            left_out.append((name, "these motions are insensitive to it"))
            continue
        trial = np.column_stack((basis, column / np.linalg.norm(column)))
        if collinearity(trial) > COLLINEAR:
            overlap = np.abs(basis.T @ trial[:, -1])
            twin = kept[int(np.argmax(overlap))]
            left_out.append((name, f"it repeats {twin} and the others in these motions"))
            continue
        kept.append(name)
        basis = trial
    return tuple(kept), tuple(left_out)


def collinearity(columns: Array) -> float:
    """1 / sqrt(smallest eigenvalue) of columns (n, k) of length one: 1 when they are orthogonal."""
    smallest = float(np.linalg.eigvalsh(columns.T @ columns)[0])
    return float(1.0 / np.sqrt(max(smallest, 1e-16)))


def _validated(validate: Sequence[Motion], law: str, params: _core.Params) -> float:
    if not validate:
        return float("nan")
    problem, used = problem_of(validate, law)
    residual, _ = problem.evaluate(params)
    return rms_of(residual[used])


def rms_of(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
