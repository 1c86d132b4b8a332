"""The next experiment: which run of a safe menu would tell the remaining explanations apart.

Every run of the menu of this kind of rig is simulated with the model as it stands, and the rivals' sensitivities in it
are computed. What one rival does and no other rival and no known parameter
can imitate, in standard errors, is the separation to be expected; the run with the largest smallest separation is
proposed. A run that is among the records already is not: it has not told them apart, and what a model leaves in it
systematically it would leave again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations

import numpy as np

from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.effects.sensitivity import sensitivity_columns
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.remainder import Hidden
from sms.diagnosis.result import NextExperiment, Verdict
from sms.diagnosis.thresholds import SAME_CONDITIONS, SAME_RUN
from sms.estimation.kind import Experiment
from sms.estimation.nuisance import nuisance_at, project
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.signals import without_leg


def next_experiment(
    verdict: Verdict,
    classes: Sequence[Sequence[Effect]],
    final: Fitted,
    data: Data,
    hidden: Hidden,
    unseen: Sequence[Effect] = (),
) -> NextExperiment | None:
    """The measurement that would tell most; None when there is nothing to tell apart.

    unseen: causes to which the validation records are insensitive.
    """
    rivals = next((list(c) for c in classes if len(c) > 1), [])
    if rivals:
        found = best_of_menu(rivals, final, data)
        if found is not None:
            experiment, separation = found
            apart = tuple(e.id if e.signal is None else f"{e.id} {e.signal}" for e in rivals)
            power = (
                f"expected to distinguish them by {separation:.1f} standard errors"
                if separation >= 3.0
                else f"the best of the menu, though with {separation:.1f} standard errors only; better: "
                + rivals[0].separated_by[:1].lower()
                + rivals[0].separated_by[1:].rstrip(".")
            )
            return NextExperiment(experiment.title, f"{experiment.how}; {power}.", apart)
    if rivals:
        return NextExperiment(
            "Distinguish between the explanations",
            rivals[0].separated_by,
            tuple(e.id for e in rivals),
        )
    if verdict == "unknown":
        return _for_unknown(hidden)
    if unseen:
        effect = unseen[0]
        return NextExperiment(
            'A record that is sensitive to it, with role = "validate"',
            f"the present validation records are insensitive to it ({effect.title}), so that only the identification "
            "records support it. What shows it: "
            + effect.separated_by[:1].lower()
            + effect.separated_by[1:],
            (),
        )
    return None


def _for_unknown(hidden: Hidden) -> NextExperiment:
    """What would show more of a term that has no name."""
    signal, equation = (
        s.split(" [")[0].replace("_", " ") for s in (hidden.shape.signal, hidden.equation)
    )
    again = "repeat it once, so that chance can be excluded"
    if signal == "time":
        return NextExperiment(
            "The machine at rest, for as long as a run",
            f"no signal of these records explains the missing term in {equation}: at rest it shows whether it comes "
            f"with time, from outside, or with the motion; {again}.",
            (),
        )
    return NextExperiment(
        f"A run that moves {signal} alone",
        f"shows whether the missing term in {equation} follows {signal} or something that moved with it; {again}.",
        (),
    )


def best_of_menu(
    rivals: Sequence[Effect], final: Fitted, data: Data
) -> tuple[Experiment, float] | None:
    """The run of the menu with the largest smallest separation of two rivals, in standard errors."""
    runs = data.identify
    best: tuple[Experiment, float] | None = None
    for experiment in runs.kind.menu:
        run = experiment.simulated(data.rig, final.params, runs.channels)
        if run is None or any(same_experiment(run, record) for record in runs.motions):
            continue
        separation = min_separation(rivals, final, replace(runs, motions=(run,)))
        if best is None or separation > best[1]:
            best = experiment, separation
    return best


def same_experiment(run: Run, record: Run) -> bool:
    """Whether a record is of this run of a menu: the same motion, or the same command where nothing moves, under the
    same conditions."""
    changed = {*run.conditions, *record.conditions}
    pairs = [(run.conditions.get(n, 0.0), record.conditions.get(n, 0.0)) for n in changed]
    alike = all(abs(a - b) <= SAME_CONDITIONS * max(abs(a), abs(b)) for a, b in pairs)
    return alike and unlikeness(run, record) < SAME_RUN


def unlikeness(run: Run, record: Run) -> float:
    """RMS of the difference of two motions, over that of the first about its mean; of the signal that differs most."""
    time, planned = record.time - record.time[0], run.time - run.time[0]
    if abs(time[-1] - planned[-1]) > SAME_RUN * planned[-1]:
        return float("inf")
    asked = [s for s in run.signals if without_leg(s) == "extension"]
    asked = asked or [s for s in run.signals if without_leg(s) == "valve_command"]
    there = [np.interp(time, planned, run.signals[s]) for s in asked]
    here = [record.signals[s] for s in asked]
    return max(
        float(np.std(h - t) / max(np.std(t), 1e-300)) for h, t in zip(here, there, strict=True)
    )


def min_separation(rivals: Sequence[Effect], final: Fitted, runs: Runs) -> float:
    """Smallest, over pairs, of what one rival does that another cannot imitate, in standard errors."""
    h = final.hypothesis
    names = [n for n in final.movable if n not in {p for e in rivals for p in e.parameters}]
    residual, nuisance = nuisance_at(runs.problem, final.params, names, h.known, h.joint)
    columns = sensitivity_columns(runs.problem, final.params, residual, rivals, h.table)
    sensitivity = project(nuisance, columns, [e.parameters[0] for e in rivals])
    sizes = _sizes(rivals, final, sensitivity)
    smallest = np.inf
    for i, j in permutations(range(len(rivals)), 2):
        a, b = sensitivity[:, i] * sizes[i], sensitivity[:, j]
        rest = a - b * float(a @ b) / max(float(b @ b), 1e-300)
        smallest = min(smallest, float(np.linalg.norm(rest)))
    return smallest


def _sizes(rivals: Sequence[Effect], final: Fitted, sensitivity: Array) -> Array:
    """How large each rival would be: the first as found, the others with the same sensitivity in size."""
    name = rivals[0].parameters[0]
    found = abs(final.params[name] - final.hypothesis.start[name])
    size = np.linalg.norm(sensitivity, axis=0)
    return np.asarray(found * size[0] / np.maximum(size, 1e-300))
