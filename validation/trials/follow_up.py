"""The experiment that an ambiguous answer proposes, made: on the hidden machine, by its simulator.

Where the answer is a class, the diagnosis proposes the run of a menu that would tell its members apart best. It is
simulated on the machine of the trial with what is hidden in it, its record joins those to identify with, and the
diagnosis is repeated; twice at most. Beside it, from the same records, a run drawn at random from the same menu, each
at most once. Both may only choose what the diagnosis holds to be safe.

The run is what the menu says: its set-point (of a tank: its command) goes to the simulator as it is, followed by a
controller with the menu's gain; an added mass and another supply are changed on the machine and declared as the
record's conditions.
"""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import cast

import numpy as np
from sms.diagnosis.design.next_experiment import best_of_menu
from sms.diagnosis.simulated import Case
from sms.estimation.kind import Experiment
from sms.rigs import bench, platform, tank

from validation.trials.answers import Answered, answered
from validation.trials.scoring import ARMS, FollowUp
from validation.twins.added import Asked, add_record
from validation.twins.air import Array
from validation.twins.controller import Controller
from validation.twins.draw import Trial
from validation.twins.measured import sample_times

MOST = 2
"""Proposals that are followed."""
CHANGES = {"added_mass": "moving_mass", "supply_change": "supply_pressure"}
"""What a menu's run changes on purpose -> the declared number that it changes."""
CENTRE = 5.0
"""V: where the owner of a tank believes his valve to be closed."""


def followed(trial: Trial, records: Path, answer: Answered) -> list[FollowUp]:
    """What becomes of an answer that is a class, by either way of choosing; nothing of another answer."""
    if not ambiguous(answer.case):
        return []
    return [_follow(trial, records, answer, arm) for arm in ARMS]


def ambiguous(case: Case) -> bool:
    """Whether an answer leaves several explanations for one cause."""
    return any(len(members) > 1 for members in case.outcome.groups)


def _follow(trial: Trial, records: Path, answer: Answered, arm: str) -> FollowUp:
    folder = records.with_name(f"{records.name}_{arm}")
    shutil.copytree(records, folder)
    rng = np.random.default_rng([trial.seed, 13])
    made: list[str] = []
    seconds = 0.0
    while len(made) < MOST and ambiguous(answer.case):
        chosen = proposed(answer.case) if arm == "proposed" else at_random(answer.case, made, rng)
        if chosen is None:
            break
        made.append(chosen.title)
        asked = asked_of(trial, chosen, f"asked_{len(made)}")
        add_record(trial, asked, (ARMS.index(arm), len(made)), folder)
        answer = answered(folder, trial.seed)
        seconds += answer.seconds
    hidden = [h.effect.key for h in trial.hidden]
    return FollowUp(
        arm, made, answer.case.verdict, answer.named, one_right(answer.named, hidden), seconds
    )


def one_right(named: Sequence[Sequence[str]], hidden: Sequence[str]) -> bool:
    """Whether each cause that is named is one effect that is there."""
    return bool(named) and all(len(members) == 1 and members[0] in hidden for members in named)


# ---- choosing ----------------------------------------------------------------------------------------------------


def proposed(case: Case) -> Experiment | None:
    """The run that the diagnosis proposes; None where it finds none of the menu safe."""
    rivals = next(
        [m.effect for m in members] for members in case.outcome.groups if len(members) > 1
    )
    found = best_of_menu(rivals, case.final, case.data)
    return None if found is None else found[0]


def at_random(case: Case, made: Sequence[str], rng: np.random.Generator) -> Experiment | None:
    """A run of the same menu that is safe and has not been made."""
    runs = case.data.identify
    menu = runs.kind.menu
    drawn: list[Experiment] = [menu[place] for place in rng.permutation(len(menu)).tolist()]
    for experiment in drawn:
        if experiment.title in made:
            continue
        if experiment.simulated(case.data.rig, case.final.params, runs.channels) is not None:
            return experiment
    return None


# ---- what is asked for, in the words of the simulator ------------------------------------------------------------


def asked_of(trial: Trial, experiment: Experiment, name: str) -> Asked:
    """A run of the menu, for the machine of a trial."""
    says = dict(cast("partial[object]", experiment.simulated).keywords)
    says.pop("margin", None)
    changes = {n: says.pop(key) for key, n in CHANGES.items() if key in says}
    (waveform,) = says.values()
    period = trial.rig.clock.period
    gain = {"bench": bench.LOOP_GAIN, "platform": platform.LOOP_GAIN}.get(trial.rig.kind, 0.0)
    loop = Controller(proportional=gain, integral=0.0, derivative=0.0)
    return Asked(name, setpoint_of(trial, waveform, period), loop.gains, changes)


def setpoint_of(trial: Trial, waveform: partial[Array], period: float) -> Array:
    """What the menu's waveform asks of a rig."""
    kind = trial.rig.kind
    if kind == "bench":
        time = sample_times(bench.LENGTH, period)
        return np.asarray(waveform(time, trial.truth.machine.stroke), dtype=np.float64)
    if kind == "tank":
        opening = np.asarray(waveform(sample_times(tank.LENGTH, period)), dtype=np.float64)
        return CENTRE + opening
    pose = np.array(waveform(sample_times(platform.LENGTH, period)), dtype=np.float64)
    pose[:, 2] += platform.HEIGHT
    return pose
