"""`sms identify friction`: the friction of a cylinder from its displacement and its pressures.

Newton's second law of the piston (eq. 6.4), fed with the measured motion and pressures, leaves the
friction force. The source's law (eq. 6.5) and its rivals (eq. 6.1, eq. 6.2, LuGre) are fitted to the
records of role `identify` and judged on those of role `validate`. Before a fit the excitation is
asked which parameters it can show: one whose column nearly is a combination of the others'
(collinearity index of Brun et al. 2001 beyond COLLINEAR) is left where it is declared, and said.
Standard errors respect any correlation within a stroke; where runs scatter more than that, the
scatter is the error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.cylinder import friction as friction_force
from sms.diagnosis.prepare import Comparison, Motion, prepare
from sms.diagnosis.result import Array
from sms.diagnosis.statistics import covariance_of, strokes_per_block
from sms.identification.estimate import Estimate, Free, estimate, with_start
from sms.io.check import check_record, raise_if_unusable
from sms.io.errors import InputError
from sms.io.records import Finding, Record, load_record
from sms.io.rig import Rig, load_rig
from sms.parameters import PARAMETERS

Progress = Callable[[str, float], None]

SPACING = 5e-3
"""s: samples closer than this are thinned; the motion is a mean over 0.15 s, they say the same."""
COLLINEAR = 10.0
"""Collinearity index beyond which a parameter only repeats others (Brun et al.: 5 to 20)."""
FELT = 0.05
"""Least share of the residual's scatter that a parameter must move at its usual size."""
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
"""Size of a parameter whose default is zero, to judge whether its effect could be felt; SI."""


@dataclass(frozen=True)
class Told:
    """One parameter of a law."""

    name: str
    value: float
    error: float
    """Standard error: the fit's, or the scatter of runs over sqrt(runs) where that is larger."""
    scatter: float
    """Standard deviation over the runs, each fitted alone; nan with fewer than two."""
    runs: tuple[float, ...]
    """The value of each run alone."""

    @property
    def shown(self) -> bool:
        """Whether its 99 percent interval leaves zero out.

        Not 95: some ten parameters are judged at a time, and every other time one would be shown by
        chance.
        """
        return bool(np.isfinite(self.error)) and abs(self.value) > 2.6 * self.error


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


@dataclass(frozen=True)
class FrictionResult:
    """Everything `sms identify friction` found."""

    title: str
    rig: str
    motions: tuple[Motion, ...]
    laws: tuple[LawFit, ...]
    best: str
    """The law that fits the validation records best (without them: the identification records)."""
    findings: tuple[Finding, ...]
    speed: tuple[float, float]
    """m/s, 1st and 99th percentile of the compared samples."""
    acceleration: float
    """m/s^2, root mean square of the compared samples."""

    def law(self, name: str) -> LawFit:
        """One of the laws."""
        return next(fit for fit in self.laws if fit.law == name)


def identify_friction(path: Path, progress: Progress = lambda text, done: None) -> FrictionResult:
    """Fit every law to a rig of kind "cylinder" or "bench". InputError says what is wrong with it."""
    rig = load_rig(path)
    if rig.kind not in ("cylinder", "bench"):
        raise InputError(
            f"{path}, [rig] kind: '{rig.kind}' has no single cylinder; sms identify friction reads "
            "rigs of kind 'cylinder' or 'bench'"
        )
    motions, findings = _motions(rig)
    identify = [m for m in motions if m.role == "identify"]
    validate = [m for m in motions if m.role != "identify"]
    if not identify:
        raise InputError(
            f"{path}, [[records]]: none has the role 'identify'; there is nothing to fit"
        )
    start = _core.Params(**{name: rig.declared(name).value for name in PARAMETERS})
    asked = tuple(n for n, d in rig.parameters.items() if d.fit)
    laws = []
    for number, law in enumerate(LAWS):
        progress(f"fitting {EQUATION[law]}", number / len(LAWS))
        laws.append(_fit_law(law, identify, validate, start, asked))
    judge = (lambda f: f.rms_validate) if validate else (lambda f: f.rms_identify)
    speeds = np.concatenate([np.abs(m.velocity[m.used]) for m in identify])
    acceleration = np.concatenate([m.acceleration[m.used] for m in identify])
    return FrictionResult(
        title=rig.title,
        rig=path.name,
        motions=tuple(motions),
        laws=tuple(laws),
        best=min(laws, key=judge).law,
        findings=findings,
        speed=(float(np.quantile(speeds, 0.01)), float(np.quantile(speeds, 0.99))),
        acceleration=float(np.sqrt(np.mean(acceleration**2))),
    )


def _motions(rig: Rig) -> tuple[list[Motion], tuple[Finding, ...]]:
    """Every record with its motion; without a load cell the rod pushes on nothing (F_L = 0)."""
    records = [load_record(rig, source) for source in rig.records]
    findings = tuple(f for record in records for f in check_record(rig, record))
    raise_if_unusable(findings)
    motions = []
    for record in records:
        signals = dict(record.signals)
        signals.setdefault("rod_force", np.zeros(len(record)))
        motion = prepare(rig, replace(record, signals=signals))
        if not motion.used.any():
            raise InputError(_standstill(rig, record))
        motions.append(_thinned(motion))
    return motions, findings


def _thinned(motion: Motion) -> Motion:
    rows = slice(None, None, max(round(SPACING / float(np.median(np.diff(motion.time)))), 1))
    return replace(
        motion,
        time=motion.time[rows],
        velocity=motion.velocity[rows],
        acceleration=motion.acceleration[rows],
        signals={name: values[rows] for name, values in motion.signals.items()},
        used=motion.used[rows],
        stroke=motion.stroke[rows],
    )


def _standstill(rig: Rig, record: Record) -> str:
    above = f" faster than {1e3 * (rig.speed_above or 0.0):g} mm/s" if rig.speed_above else ""
    return (
        f"{record.file}: the piston never moves{above}, so no friction force can be read off it; what "
        "it still shows is that break-away needs more than the largest force applied; record a run "
        "that moves, or lower speed_above"
    )


# ---- one law -----------------------------------------------------------------------------------------


def _problem(
    motions: Sequence[Motion], law: str
) -> tuple[_core.CylinderProblem, NDArray[np.bool_]]:
    """All samples of the records, and which of them are compared."""
    records = []
    for m in motions:
        records.append(
            _core.CylinderRecord(
                extension=m.signals["extension"],
                velocity=m.velocity,
                acceleration=m.acceleration,
                pressure_lower=m.signals["chamber_pressure_lower"],
                pressure_upper=m.signals.get("chamber_pressure_upper", np.empty(0)),
                rod_force=m.signals["rod_force"],
                gauge_lower="chamber_pressure_lower" in m.gauge,
                gauge_upper="chamber_pressure_upper" in m.gauge,
                time=m.time,
            )
        )
    return _core.CylinderProblem(records, law), np.concatenate([m.used for m in motions])


def _fit_law(
    law: str,
    identify: Sequence[Motion],
    validate: Sequence[Motion],
    start: _core.Params,
    asked: Sequence[str],
) -> LawFit:
    problem, used = _problem(identify, law)
    wanted = (*LAWS[law], *(n for n in asked if n not in LAWS[law]))
    names, left_out, start = _choose(problem, used, law, start, wanted)
    found = _estimate(problem, used, start, names)
    comparison = Comparison(tuple(identify))
    together = strokes_per_block(found.residual[used], comparison.record, comparison.stroke)
    block = Comparison(tuple(identify), together).block
    covariance = covariance_of(found.jacobian[used], found.residual[used], block)
    alone = [_estimate(*_problem([m], law), found.params, names) for m in identify]
    told = []
    for i, name in enumerate(names):
        runs = tuple(float(a.value[i]) for a in alone)
        scatter = float(np.std(runs, ddof=1)) if len(runs) > 1 else np.nan
        own = float(np.sqrt(covariance[i, i])) if not found.at_bound[i] else np.nan
        error = np.fmax(own, scatter / np.sqrt(len(runs)))
        told.append(Told(name, float(found.value[i]), float(error), scatter, runs))
    return LawFit(
        law, found, tuple(told), left_out,
        _rms(found.residual[used]), _validated(validate, law, found.params),
    )  # fmt: skip


def _choose(
    problem: _core.CylinderProblem,
    used: NDArray[np.bool_],
    law: str,
    start: _core.Params,
    wanted: Sequence[str],
) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...], _core.Params]:
    """What can be fitted, what cannot and why, and where to start.

    First without the Stribeck term, near the data; then with it, the fall at half of its usual
    velocity and twice the Coulomb force, where it would show best.
    """
    height, width = STRIBECK[law]
    plain = with_start(start, **{width: PARAMETERS[width].lower})
    plain = _estimate(problem, used, plain, _DRY[:2]).params
    plain.stiction_force = plain.coulomb_force
    names, left_out = showable(
        problem, used, plain, [n for n in wanted if n not in (height, width)]
    )
    falling = with_start(plain, **{height: 2.0 * plain.coulomb_force, width: start[width] or 1e-3})
    both, missing = showable(problem, used, falling, (*names, height, width))
    if height in both and width in both and set(names) <= set(both):
        return (*names, height, width), left_out, falling
    unfelt = any(n in (height, width) and "feel" in why for n, why in missing)
    reason = (
        "these motions do not feel it"
        if unfelt
        else "the fall from static to Coulomb friction cannot be told from what is fitted already"
    )
    return names, (*left_out, (height, reason), (width, reason)), plain


def _estimate(
    problem: _core.CylinderProblem,
    used: NDArray[np.bool_],
    start: _core.Params,
    names: Sequence[str],
) -> Estimate:
    residual, _ = problem.evaluate(start)
    spread = max(_rms(residual[used]), 1e-9)
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
    spread = max(_rms(residual[used]), 1e-9)
    kept: list[str] = []
    basis = np.empty((columns.shape[0], 0))
    left_out = []
    for name, column in zip(wanted, columns.T, strict=True):
        usual = abs(params[name]) or _USUAL.get(name, PARAMETERS[name].uncertainty or 1.0)
        if usual * _rms(column) < FELT * spread:
            left_out.append((name, "these motions do not feel it"))
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
    problem, used = _problem(validate, law)
    residual, _ = problem.evaluate(params)
    return _rms(residual[used])


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


# ---- the map -------------------------------------------------------------------------------------------


def friction_map(motion: Motion, params: _core.Params) -> Array:
    """The measured friction of one record, N, (n,): what eq. 6.4 leaves over."""
    problem, _ = _problem([motion], "acceleration_dependent")
    missed, _ = problem.evaluate(params)
    return np.asarray(missed + modelled(motion, params))


def modelled(motion: Motion, params: _core.Params) -> Array:
    """Eq. 6.5 over the record's motion, N, (n,)."""
    ambient = params.ambient_pressure

    def absolute(name: str) -> Array:
        signal = motion.signals.get(name, np.full(motion.time.size, ambient))
        return np.asarray(signal + (ambient if name in motion.gauge else 0.0))

    return friction_force(
        motion.velocity,
        motion.acceleration,
        motion.signals["extension"],
        absolute("chamber_pressure_lower"),
        absolute("chamber_pressure_upper"),
        params,
    )


def law_over_record(motion: Motion, fit: LawFit, measured: Array, params: _core.Params) -> Array:
    """What a law says of the record's friction, N, (n,); `measured` is its friction_map at params."""
    problem, _ = _problem([motion], fit.law)
    missed, _ = problem.evaluate(fit.found.params)
    reference, _ = _problem([motion], "acceleration_dependent")[0].evaluate(params)
    return np.asarray(measured - missed + (reference - (measured - modelled(motion, params))))
