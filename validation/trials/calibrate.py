"""`./dev trials calibrate`: machines whose joints are not where the drawing has them, calibrated blind, counted.

Each machine is drawn: every joint coordinate and length from a normal distribution of which the declared tolerance is
two standard deviations, gains and zeros of the sensors alike. It is measured in poses drawn from its workspace with
noise on extensions and inclinometer, calibrated from the drawing, and judged on poses that were not fitted.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track
from rich.table import Table
from scipy.optimize import least_squares
from sms import Params, _core, inverse_kinematics
from sms.arrays import Array
from sms.calibration.fit import COVERAGE, Calibrated, calibrate_poses, problem_of, unknowns
from sms.calibration.rig import Poses, PosesRig, default_tolerances

UNSEEN = 50
"""Poses on which a calibration is judged, without noise."""
SHARE_WITHIN = 0.93, 0.97
LEAST_GAIN = 0.80
TIMED = 5
"""Calibrations that scipy does, too."""


@dataclass(frozen=True, eq=False)
class Machine:
    """One that was drawn."""

    rig: PosesRig
    truth: _core.LegParams
    unseen: Poses  #: what an exact inclinometer would read


def draw(rng: np.random.Generator, poses: int, tracker: bool) -> Machine:
    """A machine and its measured poses."""
    nominal = _core.LegParams(Params())
    empty = Poses(np.empty((0, 3)), np.empty((0, 6)), np.empty(0, dtype=np.int64))
    measured = np.arange(6) < (6 if tracker else 2)
    noise = np.where(np.isin(np.arange(6), (0, 1, 3)), np.radians(0.02), 1e-4)
    blank = Poses(
        np.zeros((1, 3)), np.where(measured, 0.0, np.nan)[None, :], np.ones(1, dtype=np.int64)
    )
    rig = PosesRig(
        "drawn", Path("drawn"), (), blank, empty, np.full(3, 1e-4), noise, default_tolerances()
    )
    truth = nominal.copy()
    for unknown in unknowns(rig):
        truth[unknown.name] = nominal[unknown.name] + unknown.deviation * rng.standard_normal()
    fitted, unseen = (_read(truth, _extensions(rng, n), rig, measured) for n in (poses, UNSEEN))
    noisy = Poses(
        fitted.extension + rig.extension_noise * rng.standard_normal(fitted.extension.shape),
        fitted.pose + noise * rng.standard_normal(fitted.pose.shape),
        fitted.row,
    )
    return Machine(replace(rig, fitted=noisy, validation=unseen), truth, unseen)


def _extensions(rng: np.random.Generator, count: int) -> Array:
    """Of poses within the stroke, drawn evenly over tilt and height, (count, 3) m."""
    params = Params()
    low = -params["reference_point_z"]
    found: list[Array] = []
    while len(found) < count:
        roll, pitch = rng.uniform(-0.25, 0.25, 2)
        extension = inverse_kinematics(roll, pitch, low + rng.uniform(0.0, params.stroke)).extension
        if np.all((extension > 0.02) & (extension < params.stroke - 0.02)):
            found.append(extension)
    return np.array(found)


def _read(
    truth: _core.LegParams, extension: Array, rig: PosesRig, measured: NDArray[np.bool_]
) -> Poses:
    """What exact sensors of that machine read, position sensors `extension`."""
    asked = np.where(measured, 0.0, np.nan) * np.ones((len(extension), 6))
    absent = Poses(extension, asked, np.arange(1, len(extension) + 1))
    pose = problem_of(absent, rig, truth).predict(truth)
    return Poses(extension, np.where(measured, pose, np.nan), absent.row)


@dataclass(frozen=True)
class Trial:
    """One machine, calibrated."""

    within: NDArray[np.bool_]  #: (parameters,) whether the truth is within the interval of 95 %
    told_within: NDArray[
        np.bool_
    ]  #: the same in directions of which poses say more than the drawing
    before: float  #: rad, attitude on unseen poses, root mean square
    after: float
    measured: int
    false_claims: int
    never_told: tuple[str, ...]  #: combinations that were called not told
    seconds: float


def calibrate_one(machine: Machine) -> Trial:
    """Calibrate and compare with the truth."""
    begin = time.perf_counter()
    c = calibrate_poses(machine.rig)
    seconds = time.perf_counter() - begin
    off = np.array([abs(machine.truth[f.unknown.name] - f.value) / f.deviation for f in c.found])
    before, after = c.validation.attitude
    _, singular, directions = np.linalg.svd(c.scaled, full_matrices=False)
    error = np.array(
        [(machine.truth[f.unknown.name] - f.value) / f.unknown.deviation for f in c.found]
    )
    along = np.abs(directions @ error) * np.hypot(singular, 1.0)
    return Trial(
        within=off <= COVERAGE,
        told_within=along[singular > 1.0] <= COVERAGE,
        before=before,
        after=after,
        measured=sum(f.measured for f in c.found),
        false_claims=sum(k.told and _cannot_be_told(k.words) for k in c.combinations),
        never_told=tuple(k.words for k in c.combinations if not k.told),
        seconds=seconds,
    )


def _cannot_be_told(words: str) -> bool:
    """By an inclinometer and position sensors alone, whatever the poses."""
    always = (
        "moved along",
        "base joints turned about z",
        "the scale",
        "the zero of extension sensor",
    )
    return any(text in words for text in always)


def scipy_seconds(machine: Machine, c: Calibrated) -> tuple[float, float]:
    """least_squares with differences on the same residuals: seconds, and how far it ends from ours, in tolerances."""
    start, names = c.nominal, [f.unknown.name for f in c.found]
    prior = np.array([f.unknown.deviation for f in c.found])
    problem = problem_of(machine.rig.fitted, machine.rig, start)
    rows = problem.first_row

    def residual(x: Array) -> Array:
        params = start.copy()
        for name, value in zip(names, x * prior, strict=True):
            params[name] = start[name] + value
        r = problem.evaluate(params)[0]
        size = np.array([np.linalg.norm(r[a:b]) for a, b in pairwise(rows)])
        soft = np.sqrt(np.where(size > 3.0, 6.0 * size - 9.0, size**2)) / np.maximum(size, 1e-300)
        return np.concatenate([r * np.repeat(soft, np.diff(rows)), x])

    begin = time.perf_counter()
    found = least_squares(residual, np.zeros(len(names)), method="lm", xtol=1e-10, ftol=1e-12)
    seconds = time.perf_counter() - begin
    ours = np.array([(f.value - f.nominal) / f.unknown.deviation for f in c.found])
    return seconds, float(np.max(np.abs(found.x - ours)))


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command()(calibrate)


def calibrate(
    count: Annotated[int, typer.Option(help="Machines.", min=1)] = 200,
    seed: Annotated[int | None, typer.Option(help="Of the drawings; printed.")] = None,
    poses: Annotated[int, typer.Option(help="Poses that are fitted.", min=6)] = 30,
    tracker: Annotated[
        bool, typer.Option(help="All six coordinates, not roll and pitch alone.")
    ] = False,
) -> None:
    """Machines with hidden joints, lengths, gains and zeros: how often intervals hold the truth, and what is gained."""
    number = secrets.randbelow(10**6) if seed is None else seed
    print(f"seed {number}, {count} machines, {poses} poses each")
    machines = [draw(rng, poses, tracker) for rng in _generators(number, count)]
    trials = [
        calibrate_one(m)
        for m in track(machines, "calibrating", console=Console(stderr=True), transient=True)
    ]
    within = np.array([t.within for t in trials])
    gains = np.array([1.0 - t.after / t.before for t in trials])
    before, after = (
        np.degrees(np.sqrt(np.mean([getattr(t, n) ** 2 for t in trials])))
        for n in ("before", "after")
    )
    table = Table(box=None)
    for header in ("", "found", "asked"):
        table.add_column(header)
    share, of_machine = within.mean(), 100.0 * within.mean(axis=1)
    known = f"{np.mean([t.measured for t in trials]):.1f} of {within.shape[1]}"
    table.add_row("truth within 95 % intervals", f"{100 * share:.2f} %", "93 to 97 %")
    told = np.concatenate([t.told_within for t in trials])
    table.add_row("in directions that poses tell", f"{100 * told.mean():.2f} %", "")
    table.add_row("such directions, mean", f"{told.size / count:.1f} of {within.shape[1]}", "")
    table.add_row("of one machine", f"{of_machine.min():.0f} to {of_machine.max():.0f} %", "")
    table.add_row("attitude off on unseen poses, before", f"{before:.4f} deg", "")
    table.add_row("after", f"{after:.4f} deg", "")
    table.add_row("down by", f"{100 * (1 - after / before):.1f} %", "at least 80 %")
    table.add_row("down by, worst machine", f"{100 * gains.min():.1f} %", "")
    table.add_row("parameters called measured, mean", known, "")
    claims = sum(t.false_claims for t in trials)
    if not tracker:
        table.add_row("claims of what cannot be told", str(claims), "0")
    table.add_row("one calibration", f"{1e3 * np.median([t.seconds for t in trials]):.1f} ms", "")
    timed = [scipy_seconds(m, calibrate_poses(m.rig)) for m in machines[:TIMED]]
    table.add_row(
        "scipy least_squares on the same", f"{1e3 * np.median([t[0] for t in timed]):.1f} ms", ""
    )
    table.add_row(
        "largest difference of the two minima", f"{max(t[1] for t in timed):.1e} tolerances", ""
    )
    Console(markup=False, width=100).print(table)
    failed = not SHARE_WITHIN[0] <= share <= SHARE_WITHIN[1] or 1 - after / before < LEAST_GAIN
    raise typer.Exit(1 if failed or (claims and not tracker) else 0)


def _generators(seed: int, count: int) -> Iterator[np.random.Generator]:
    return (np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(count))
