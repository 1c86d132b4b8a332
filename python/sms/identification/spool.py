"""`sms identify spool`: what the valve's spool does with a command.

Where the spool's position was measured (rig kind "spool_test", or "bench" with that column), position over command is
fitted directly: the static law of eq. 4.1 and its rival eq. 4.2, natural frequency, damping ratio, dead time, and the
end of the travel where it is reached. On a bench with pressures the flow is asked as well, through the whole actuator
(bench_fit.py): the command at which the valve is closed, its dead band, its lag. Either says what the other cannot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sms import OutOfRangeError, _core
from sms.arrays import Array
from sms.callbacks import Progress
from sms.errors import InputError
from sms.identification.actuator import BenchResult, wanted_of
from sms.identification.bench_fit import fit_bench, start_params
from sms.identification.bench_records import load_bench
from sms.identification.estimate import Estimate, Free, estimate, with_start
from sms.io.check import check_record, raise_if_unusable
from sms.io.records import Finding, Record, load_record
from sms.io.rig import Rig, load_rig
from sms.views import Shown

BY_PRESSURE = (
    "valve_centre",
    "dead_band_change",
    "valve_frequency",
    "valve_damping_ratio",
    "command_delay",
)
"""What pressures can say of the spool."""
STATIC = {
    "cubic": ("spool_cubic_0", "spool_cubic_1", "spool_cubic_2", "spool_cubic_3"),
    "linear": ("spool_linear_0", "spool_linear_1"),
}
EQUATION = {"cubic": "eq. 4.1, cubic", "linear": "eq. 4.2, linear"}
DYNAMIC = ("valve_frequency", "valve_damping_ratio", "command_delay")
RESTS = 0.002  #: of the travel: nearer to its extreme a spool counts as at its end
GOES_ON = 0.1  #: V, which would move it by 1 percent of its travel
MOVES = 2e-5  #: m, the least travel that tells a law
SPEED_OF_SAMPLING = 4.0  #: samples in a period of the spool, the least that shows its lag
SMALL = {"valve_frequency": 0.2, "valve_damping_ratio": 0.3}
"""Relative standard errors up to which a number is worth printing."""
DELAY = 1e-3  #: s, the same for the dead time
SHARE = 0.5  #: the same, relative, for coefficients of the static law


@dataclass(frozen=True)
class SpoolTold:
    """One parameter of the spool by its measured position."""

    name: str
    value: float
    error: float
    before: float
    told: bool


@dataclass(frozen=True)
class SpoolRun:
    """One record, evenly sampled; arrays (n,)."""

    name: str
    role: str
    step: float
    time: Array
    command: Array
    position: Array


@dataclass(frozen=True)
class LawFit:
    """One static law with the dynamics fitted beside it."""

    law: str
    found: Estimate
    told: tuple[SpoolTold, ...]
    rms_identify: float  #: m
    rms_validate: float  #: m; nan without such records
    centre: tuple[float, float]
    """V, command at which the spool stands in the middle, and its standard error."""


@dataclass(frozen=True)
class PositionFit:
    """What the measured position says."""

    runs: tuple[SpoolRun, ...]
    laws: tuple[LawFit, ...]
    best: str
    left_out: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]

    def law(self, name: str) -> LawFit:
        """One of the laws."""
        return next(f for f in self.laws if f.law == name)


@dataclass(frozen=True)
class SpoolResult(Shown):
    """Everything `sms identify spool` found."""

    title: str
    rig: str
    position: PositionFit | None
    """None: the position was not measured."""
    pressure: BenchResult | None
    """None: no pressures were measured."""
    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    """What is missing, what that prevents, and what can still be told."""


def identify_spool(
    path: Path, huber: float = 0.0, progress: Progress = lambda text, done: None
) -> SpoolResult:
    """Fit the spool to a rig of kind "spool_test" or "bench". InputError says what is wrong with it."""
    rig = load_rig(path)
    if rig.kind not in ("spool_test", "bench"):
        raise InputError(
            f"{path}, [rig] kind: '{rig.kind}' has no valve whose command and spool were recorded; sms identify spool "
            "reads rigs of kind 'spool_test' (command and spool position) or 'bench' (command and pressures)"
        )
    progress("reading records", 0.0)
    records = [load_record(rig, source) for source in rig.records]
    findings = tuple(f for record in records for f in check_record(rig, record))
    measured = [r for r in records if "spool_position" in r.signals]
    position, notes = None, []
    if measured:
        raise_if_unusable([f for f in findings if any(f.file == r.file for r in measured)])
        progress("fitting the position", 0.1)
        position = fit_position(rig, measured, huber)
    else:
        notes.append(
            "the spool's position was not measured: the static law, millimetres over volts, is not identifiable, "
            "since the valve's tables state the flow over volts; from pressures the centre and the dead band are, and "
            "the lag"
        )
    pressure = None
    if rig.kind == "bench":
        bench = load_bench(path, "spool")
        every = dict.fromkeys((*BY_PRESSURE, *wanted_of(rig)))
        fit = fit_bench(bench, tuple(every), huber, 1, progress)
        pressure = BenchResult("spool", rig.title, path.name, fit, BY_PRESSURE)
    else:
        notes.append(
            "no pressures were measured: the command at which air begins to flow, and so the dead band and the "
            "pneumatic centre, are not identifiable; the centre above is that of the spool's travel"
        )
    return SpoolResult(rig.title, path.name, position, pressure, findings, tuple(notes))


# ---- by position -----------------------------------------------------------------------------------------


def fit_position(rig: Rig, records: Sequence[Record], huber: float = 0.0) -> PositionFit:
    """Both static laws, with the dynamics, on records whose position was measured."""
    runs = tuple(_run(rig, r) for r in records)
    identify = [r for r in runs if r.role == "identify"]
    if not identify:
        raise InputError(
            f"{rig.path}, [[records]]: none with the spool's position has the role 'identify'; there is nothing to fit"
        )
    moving = [r for r in identify if np.ptp(r.position) > MOVES]
    if not moving:
        raise InputError(
            f"{rig.path}: the spool moves less than {1e3 * MOVES:g} mm in every record to identify with: no law can be "
            "identified from one position; record commands from 0 to 10 V"
        )
    notes = [
        f"record {r.name}: the spool does not move; it gives one point of the static law only"
        for r in identify
        if r not in moving
    ]
    start = start_params(rig)
    names, left_out = _excited(identify, start, notes)
    laws = [_fit_law(law, identify, runs, start, names, huber) for law in STATIC]
    judge = [f.rms_validate if np.isfinite(f.rms_validate) else f.rms_identify for f in laws]
    return PositionFit(
        runs, tuple(laws), laws[int(np.argmin(judge))].law, tuple(left_out), tuple(notes)
    )


def _run(rig: Rig, record: Record) -> SpoolRun:
    time = record.used("time")
    step = float((time[-1] - time[0]) / (time.size - 1))
    return SpoolRun(
        record.name,
        record.role,
        step,
        time,
        record.used("valve_command"),
        record.used("spool_position"),
    )


def _excited(
    runs: Sequence[SpoolRun], start: _core.Params, notes: list[str]
) -> tuple[list[str], list[tuple[str, str]]]:
    """Which of the dynamics to fit, and why not the others."""
    step = min(r.step for r in runs)
    period = 1.0 / start.valve_frequency
    if all(np.max(np.abs(np.diff(r.command))) < 1e-3 * np.ptp(r.command) for r in runs):
        slow = "the command changes slowly in every record: the spool is never seen to lag"
        return [], [(n, slow) for n in DYNAMIC]
    if period < SPEED_OF_SAMPLING * step:
        notes.append(
            f"sampled every {1e3 * step:.3g} ms, the spool's period being {1e3 * period:.3g} ms: its lag depends on "
            "the command between samples, and is not distinguishable from a dead time; the static law is not affected"
        )
        return list(DYNAMIC[:1]), [
            (n, "too few samples in a period of the spool") for n in DYNAMIC[1:]
        ]
    return list(DYNAMIC), []


def _problem(runs: Sequence[SpoolRun], law: str) -> _core.SpoolProblem:
    return _core.SpoolProblem(
        [_core.SpoolRecord(step=r.step, command=r.command, position=r.position) for r in runs], law
    )


def _fit_law(
    law: str,
    identify: Sequence[SpoolRun],
    runs: Sequence[SpoolRun],
    start: _core.Params,
    dynamic: Sequence[str],
    huber: float,
) -> LawFit:
    problem = _problem(identify, law)
    names = [*STATIC[law], *dynamic]
    if _reaches_its_end(identify):
        names.append("spool_limit")
        furthest = max(float(np.max(np.abs(r.position))) for r in identify)
        try:
            start = with_start(start, spool_limit=furthest)
        except OutOfRangeError as beyond:
            raise InputError(
                f"spool_position stands still at an end of its travel, where {beyond}; check its unit and its readings"
            ) from None
    residual, _ = problem.evaluate(start)
    spread = max(float(np.sqrt(np.mean(residual**2))), 1e-9)
    rough = estimate(
        problem, [start], _felt(problem, start, names), np.full(problem.rows, 1.0 / spread)
    )
    # Again in units of what is left, so that a robust loss knows the noise.
    noise = max(rough.scale * spread, 1e-9)
    free = _felt(problem, rough.params, names)
    found = estimate(problem, [rough.params], free, np.full(problem.rows, 1.0 / noise), huber=huber)
    names = [f.name for f in free]
    return LawFit(
        law,
        found,
        tuple(_told(found, n, start) for n in names),
        float(np.sqrt(np.mean(found.residual**2))),
        _validated([r for r in runs if r.role != "identify"], law, found.params),
        _centre(found, law),
    )


def _felt(problem: _core.SpoolProblem, params: _core.Params, names: Sequence[str]) -> list[Free]:
    """A law that stays short of its end is insensitive to it."""
    _, jacobian = problem.evaluate(params, list(names))
    felt = np.linalg.norm(jacobian, axis=0) > 0.0
    return [Free.of(n) for n, f in zip(names, felt, strict=True) if f]


def _reaches_its_end(runs: Sequence[SpoolRun]) -> bool:
    """Whether the spool rests at an end of its travel while the command goes on."""
    for run in runs:
        for extreme in (run.position.max(), run.position.min()):
            at_end = np.abs(run.position - extreme) < RESTS * np.ptp(run.position)
            if at_end.mean() > 0.005 and np.ptp(run.command[at_end]) > GOES_ON:
                return True
    return False


def _told(found: Estimate, name: str, start: _core.Params) -> SpoolTold:
    value, error = found.params[name], found.sd(name)
    worth = DELAY if name == "command_delay" else SMALL.get(name, SHARE) * abs(value)
    return SpoolTold(name, value, error, start[name], bool(np.isfinite(error) and error < worth))


def _validated(runs: Sequence[SpoolRun], law: str, params: _core.Params) -> float:
    if not runs:
        return float("nan")
    residual, _ = _problem(runs, law).evaluate(params)
    return float(np.sqrt(np.mean(np.square(residual))))


def static_law(law: str, params: _core.Params, command: Array) -> Array:
    """Spool position over command, m, (n,), without stops."""
    of_law = _core.spool_cubic if law == "cubic" else _core.spool_linear
    return np.asarray(of_law(params, command))


def _centre(found: Estimate, law: str) -> tuple[float, float]:
    """Where the static law crosses zero, V; its error by the law's slope there and the fit's covariance."""
    grid = np.linspace(3.0, 7.0, 81)
    place = static_law(law, found.params, grid)
    crossing = np.flatnonzero(np.diff(np.sign(place)) > 0.0)
    if crossing.size != 1:
        return float("nan"), float("nan")
    k = int(crossing[0])
    slope = (place[k + 1] - place[k]) / (grid[k + 1] - grid[k])
    centre = float(grid[k] - place[k] / slope)
    powers = np.array([centre**n for n in range(len(STATIC[law]))])
    rows = [found.index(n) for n in STATIC[law]]
    variance = powers @ found.covariance[np.ix_(rows, rows)] @ powers
    return centre, float(np.sqrt(max(variance, 0.0)) / slope)
