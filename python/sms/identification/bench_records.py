"""Records of the moving actuator: what they are before a fit, and what they prevent.

A record is used in windows (estimation/windows.py), each simulated from an initial state of its own. A window in which
a sensor is clipped counts for nothing; what a whole record cannot show is said, with what it still can.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.errors import InputError
from sms.estimation.noise import noise_of
from sms.estimation.run import Run, make_run
from sms.estimation.windows import Runs
from sms.io.check import check_record
from sms.io.clipping import stuck_at_extremes
from sms.io.records import Finding, load_record
from sms.io.rig import Rig, load_rig
from sms.rigs.kinds import KINDS

MOVES = 1e-3  #: m, of travel that tells a piston that moves from one that creeps
STIRS = 2e4  #: Pa, of change in a chamber that tells a valve that opens from one that leaks
SUPPLIES = 0.02  #: relative; supply pressures closer than this are one
_CLIPPING = ("extension", "chamber_pressure_lower", "chamber_pressure_upper", "supply_pressure")


@dataclass(frozen=True)
class BenchRecords:
    """A rig's records by role, and what was noticed. Rows are those of `identify.problem`."""

    rig: Rig
    identify: Runs
    validate: Runs | None
    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    """What single records prevent, and what they still show."""
    moves: bool
    """Whether the piston moves anywhere in the records to identify with."""

    @property
    def problem(self) -> _core.BenchProblem:
        """The records to identify with, as the core's problem."""
        problem = self.identify.simulation
        assert isinstance(problem, _core.BenchProblem)
        return problem

    @property
    def series(self) -> list[NDArray[np.intp]]:
        """The rows of each output, in time."""
        runs = self.identify
        return [np.flatnonzero(runs.channel == c) for c in range(len(runs.channels))]

    @property
    def counted(self) -> NDArray[np.bool_]:
        """(rows,): rows of windows without a clipped reading."""
        return whole_windows(self.identify)


def load_bench(path: Path, command: str) -> BenchRecords:
    """The records of a rig of kind "bench". InputError for another kind, or with nothing to fit."""
    rig = load_rig(path)
    if rig.kind != "bench":
        raise InputError(
            f"{path}, [rig] kind: '{rig.kind}' has no single actuator whose valve is driven; "
            f"sms identify {command} reads rigs of kind 'bench'"
        )
    if "valve_command" not in rig.signals:
        raise InputError(
            f"{path}, [signals]: the signal 'valve_command' is needed but not listed; an identification takes the "
            "command from the records, a controller that is simulated or not"
        )
    runs, findings, notes = _usable(rig)
    kind = KINDS[rig.kind]
    noise = noise_of(rig, kind, runs)
    identify = tuple(r for r in runs if r.role == "identify")
    validate = tuple(r for r in runs if r.role != "identify")
    if not identify:
        why = "; ".join(notes) or "none has the role 'identify'"
        raise InputError(f"{path}, [[records]]: there is nothing to fit: {why}")
    if not any(_stirs(r) for r in identify):
        raise InputError(
            f"{path}: neither the piston nor a chamber's pressure moves in any record to identify with "
            f"(least: {1e3 * MOVES:g} mm, {1e-5 * STIRS:g} bar): the valve stayed closed or the supply was off, "
            "nothing can be identified; record a run with commands beyond the dead band"
        )
    notes += [_of_record(r) for r in identify if not _moves(r)]
    notes += _clipping(Runs(rig, identify, noise, kind, complete=True))
    notes += _supply(rig, identify)
    return BenchRecords(
        rig,
        Runs(rig, identify, noise, kind, complete=True),
        Runs(rig, validate, noise, kind, complete=True) if validate else None,
        findings,
        tuple(notes),
        any(_moves(r) for r in identify),
    )


def _usable(rig: Rig) -> tuple[list[Run], tuple[Finding, ...], list[str]]:
    """Runs without those that the data check refuses, which are named; InputError when none is left."""
    runs: list[Run] = []
    findings: list[Finding] = []
    refused: list[str] = []
    for source in rig.records:
        record = load_record(rig, source)
        found = check_record(rig, record)
        findings += found
        wrong = [f for f in found if f.severity == "error"]
        if wrong:
            refused.append(f"record {record.name} is left out: {wrong[0].message}")
        else:
            runs.append(make_run(rig, record))
    if not runs:
        first = next(f for f in findings if f.severity == "error")
        raise InputError(f"{first}; no other record is left to identify with")
    return runs, tuple(findings), refused


def _moves(run: Run) -> bool:
    return bool(np.ptp(run.signals["extension"]) > MOVES)


def _stirs(run: Run) -> bool:
    pressures = ("chamber_pressure_lower", "chamber_pressure_upper")
    return _moves(run) or any(np.ptp(run.signals[p]) > STIRS for p in pressures)


def _of_record(run: Run) -> str:
    return (
        f"record {run.name}: the piston moves less than {1e3 * MOVES:g} mm, so mass and friction are not "
        "identifiable from it; what its pressures still show is the flow into closed chambers: mass-flow gain, dead "
        "volumes, valve centre"
    )


def _clipping(runs: Runs) -> list[str]:
    """A sentence for each signal that clips, with what it costs."""
    said = []
    for run in runs.motions:
        for name in _CLIPPING:
            if name not in run.signals:
                continue
            clipped = stuck_at_extremes(run.signals[name])
            if clipped.any():
                said.append(
                    f"record {run.name}: {name} is clipped in {int(clipped.sum())} samples; the windows with them are "
                    "left out, since a model is not judged on what its sensor did not see"
                )
    return said


def whole_windows(runs: Runs) -> NDArray[np.bool_]:
    """(rows,): False in every window that holds a clipped reading."""
    keep = np.ones(runs.problem.rows, dtype=np.bool_)
    clipped = [_clipped(run) for run in runs.motions]
    for w in runs.problem.windows:
        if clipped[w.record][w.first : w.first + w.samples].any():
            keep[w.row : w.row + w.rows] = False
    return keep


def _clipped(run: Run) -> NDArray[np.bool_]:
    """(n,): samples at which a reading is at the end of its range, or repeats to the digit at its extreme."""
    by_signal = [stuck_at_extremes(run.signals[n]) for n in _CLIPPING if n in run.signals]
    return np.asarray(np.any([*by_signal, *run.clipped.values()], axis=0))


def _supply(rig: Rig, runs: Sequence[Run]) -> list[str]:
    """Whether more than one supply pressure was used."""
    declared = rig.declared("supply_pressure").value
    levels = [
        float(np.median(r.signals["supply_pressure"]))
        if "supply_pressure" in r.signals
        else declared + r.conditions.get("supply_pressure", 0.0)
        for r in runs
    ]
    if max(levels) > (1.0 + SUPPLIES) * min(levels):
        return []
    return [
        f"one supply pressure only ({1e-5 * float(np.median(levels)):.3g} bar): whether the mass-flow gain is the same "
        "at another cannot be seen, nor how choking shares in it; everything else is not touched by that"
    ]
