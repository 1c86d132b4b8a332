"""The next experiment: which run of a safe menu would tell the remaining explanations apart.

Every run of the menu is simulated with the model as it stands, under a slow position loop that keeps the piston inside
its stroke, and the rivals' footprints in it are computed. What one rival does and no other rival and no known parameter
can imitate, in standard errors, is the separation to be expected; the run with the largest smallest separation is
proposed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from sms import _core, simulation
from sms.diagnosis.catalogue import Effect
from sms.diagnosis.result import Array, Hidden, NextExperiment, Verdict
from sms.diagnosis.runs import Run, Runs
from sms.diagnosis.screening import Nuisance, columns_of, project
from sms.diagnosis.search import Data, Fitted

LENGTH = 8.0
"""s"""
STEP = 0.005
"""s, of the proposed record."""
MARGIN = 0.02
"""m kept from either end, where the run does not mean to go there."""
LOOP_GAIN = 10.0
"""V/m"""
TOLERANCE = 1e-5
"""Of the integrator: a plan needs no more."""

Waveform = Callable[[Array, float], Array]


@dataclass(frozen=True)
class Experiment:
    """One run of the menu."""

    title: str
    how: str
    setpoint: Waveform
    """Of time (n,) and the stroke: extension, m."""
    added_mass: float = 0.0
    """kg"""
    supply_change: float = 0.0
    """Pa"""


def _multisine(time: Array, stroke: float) -> Array:
    parts = [np.sin(2.0 * np.pi * f * time + f * f) for f in (0.25, 0.5, 1.0, 1.75, 2.75)]
    return np.asarray(0.5 * stroke + 0.08 * stroke * np.sum(parts, axis=0))


def _slow_triangle(time: Array, stroke: float) -> Array:
    return np.asarray(
        0.5 * stroke + 0.3 * stroke * (2.0 * np.abs((time / 8.0 + 0.25) % 1.0 - 0.5) - 0.5) * 2.0
    )


def _holds(time: Array, stroke: float) -> Array:
    return np.asarray(
        stroke * np.array([0.3, 0.7, 0.5, 0.2])[np.minimum((time / 2.0).astype(int), 3)]
    )


def _small_steps(time: Array, stroke: float) -> Array:
    return np.asarray(0.5 * stroke + 0.03 * stroke * np.sign(np.sin(2.0 * np.pi * 0.7 * time)))


def _sweep(time: Array, stroke: float) -> Array:
    phase = 2.0 * np.pi * (0.5 * time + 0.5 * time**2)
    return np.asarray(0.5 * stroke + 0.15 * stroke / (1.0 + time) * np.sin(phase))


def _ends(time: Array, stroke: float) -> Array:
    return np.asarray(0.5 * stroke * (1.0 - 0.96 * np.cos(2.0 * np.pi * time / 8.0)))


MENU = (
    Experiment("A multisine of 0.25 to 2.75 Hz about mid-stroke", "random phases, 8 s", _multisine),
    Experiment("A slow triangle over 60 per cent of the stroke", "both ways, 8 s", _slow_triangle),
    Experiment("Fast moves with holds at four positions", "two seconds each", _holds),
    Experiment("Small steps about mid-stroke", "3 per cent of the stroke, 0.7 Hz", _small_steps),
    Experiment("A sweep from 0.5 to 8 Hz, falling in amplitude", "8 s", _sweep),
    Experiment("A slow approach to both ends", "to 2 per cent of the stroke, 8 s", _ends),
    Experiment(
        "The multisine with 20 kg added to the rod", "weigh the mass", _multisine, added_mass=20.0
    ),
    Experiment(
        "The multisine at 100 kPa less supply", "read the gauge", _multisine, supply_change=-1e5
    ),
)


def plan_next(
    verdict: Verdict, classes: Sequence[Sequence[Effect]], final: Fitted, data: Data, hidden: Hidden
) -> NextExperiment | None:
    """The measurement that would tell most; None when there is nothing to tell apart."""
    rivals = next((list(c) for c in classes if len(c) > 1), [])
    if rivals and data.rig.kind == "bench":
        found = best_of_menu(rivals, final, data)
        if found is not None:
            experiment, separation = found
            apart = tuple(e.id if e.signal is None else f"{e.id} {e.signal}" for e in rivals)
            power = (
                f"expected to tell them apart by {separation:.1f} standard errors"
                if separation >= 3.0
                else f"the best of the menu, though by {separation:.1f} standard errors only: better "
                + rivals[0].separated_by[:1].lower()
                + rivals[0].separated_by[1:].rstrip(".")
            )
            return NextExperiment(experiment.title, f"{experiment.how}; {power}.", apart)
    if rivals:
        return NextExperiment(
            "Tell the explanations apart", rivals[0].separated_by, tuple(e.id for e in rivals)
        )
    if verdict == "unknown":
        signal = hidden.shape.signal.split(" [")[0].replace("_", " ")
        return NextExperiment(
            f"A run that moves {signal} alone",
            f"shows whether the missing term in {hidden.equation.replace('_', ' ')} follows {signal} or something that "
            "moved with it; repeat it once, so that chance can be told from a cause.",
            (),
        )
    return None


def best_of_menu(
    rivals: Sequence[Effect], final: Fitted, data: Data
) -> tuple[Experiment, float] | None:
    """The run of the menu with the largest smallest separation of two rivals, in standard errors."""
    best: tuple[Experiment, float] | None = None
    for experiment in MENU:
        runs = simulated(experiment, final.params, data)
        if runs is None:
            continue
        separation = min_separation(rivals, final, runs)
        if best is None or separation > best[1]:
            best = experiment, separation
    return best


def simulated(experiment: Experiment, params: _core.Params, data: Data) -> Runs | None:
    """The record that this run would give; None if it would leave the stroke."""
    assert isinstance(data.identify, Runs)
    period, stroke = 1e-3, float(params["stroke"])
    time = np.arange(0.0, LENGTH, period)
    machine = params.copy()
    machine["moving_mass"] = machine["moving_mass"] + experiment.added_mass
    machine["supply_pressure"] = machine["supply_pressure"] + experiment.supply_change
    machine["proportional_gain"] = LOOP_GAIN
    model = data.rig.model
    try:
        run = simulation.simulate_bench(
            experiment.setpoint(time, stroke),
            controller="pid",
            params=machine,
            valve_law=model.valve,
            friction_law=model.friction,
            chamber_law=model.chambers,
            tolerance=TOLERANCE,
        )
    except _core.StatusError:
        return None
    extension = run["extension"]
    goes_there = experiment.setpoint is _ends
    if not goes_there and not (extension.min() > MARGIN and extension.max() < stroke - MARGIN):
        return None
    pick = slice(None, None, round(STEP / period))
    names = ("valve_command", "extension", "chamber_pressure_lower", "chamber_pressure_upper")
    signals = {name: np.ascontiguousarray(run[name][pick]) for name in names}
    if "supply_pressure" in data.identify.channels:
        signals["supply_pressure"] = np.full(len(signals["extension"]), machine["supply_pressure"])
    changes = {"moving_mass": experiment.added_mass, "supply_pressure": experiment.supply_change}
    conditions = {n: v for n, v in changes.items() if v != 0.0}
    one = Run("proposed", "identify", time[pick], signals, frozenset(), conditions)
    return Runs(data.rig, (one,), data.identify.noise)


def min_separation(rivals: Sequence[Effect], final: Fitted, runs: Runs) -> float:
    """Smallest, over pairs, of what one rival does that another cannot imitate, in standard errors."""
    h = final.hypothesis
    names = [n for n in final.movable if n not in {p for e in rivals for p in e.parameters}]
    residual, jacobian = runs.problem.evaluate(final.params, names)
    nuisance = Nuisance(
        names,
        np.asarray(jacobian),
        np.array([1.0 / h.known[n] if n in h.known else 0.0 for n in names]),
        np.zeros(len(names)),
    )
    columns = columns_of(runs.problem, final.params, residual, rivals)
    footprint = project(nuisance, columns, [e.parameters[0] for e in rivals])
    sizes = _sizes(rivals, final, footprint)
    smallest = np.inf
    for i, j in permutations(range(len(rivals)), 2):
        a, b = footprint[:, i] * sizes[i], footprint[:, j]
        rest = a - b * float(a @ b) / max(float(b @ b), 1e-300)
        smallest = min(smallest, float(np.linalg.norm(rest)))
    return smallest


def _sizes(rivals: Sequence[Effect], final: Fitted, footprint: Array) -> Array:
    """How large each rival would be: the first as found, the others with the same footprint in size."""
    name = rivals[0].parameters[0]
    found = abs(final.params[name] - final.hypothesis.start[name])
    size = np.linalg.norm(footprint, axis=0)
    return np.asarray(found * size[0] / np.maximum(size, 1e-300))
