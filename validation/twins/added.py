"""A run that somebody asks for, on the machine of a trial: its record joins those that are there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from validation.twins.air import Array
from validation.twins.draw import ADDED, Run, Trial, recorded
from validation.twins.rig_file import entry, write_record

ONE_TABLE = '[model]\nvalve = "iso_0_4_mpa"\n\n'
"""A valve of these machines has one table whatever its supply. Its owner says so where he lowers the supply: else a
tank's record is taken to follow the table that was measured nearest to it, and 100 kPa less is half-way to the next."""


@dataclass(frozen=True)
class Asked:
    """A run as it is asked for."""

    name: str
    setpoint: Array  # as the rig's `following` takes it, one a period of its clock
    gains: Array  # of the controller that follows it (controller.py)
    changes: Mapping[
        str, float
    ]  # declared number -> by how much it is changed for this run, on purpose


def add_record(trial: Trial, asked: Asked, stream: tuple[int, ...], out: Path) -> None:
    """Measure it and list it in the rig file of `out`, to be identified with; `stream` tells its noise from others'."""
    rig, seed = trial.rig, np.random.SeedSequence(trial.seed, spawn_key=(ADDED, *stream))
    changed = {name: trial.truth.value(name) + by for name, by in asked.changes.items()}
    truth = trial.truth.having(**changed)
    duration = rig.clock.period * (len(asked.setpoint) - 1)
    plan = rig.following(asked.setpoint, asked.gains)
    run = Run(asked.name, "identify", "asked")
    write_record(
        out / f"{run.name}.csv", recorded(trial, truth, plan, duration, np.random.default_rng(seed))
    )
    known = {d.parameter: d for d in rig.declared}
    told = {n: f"{known[n].value + by:g} {known[n].unit}" for n, by in asked.changes.items()}
    path = out / "rig.toml"
    text = path.read_text() + "\n" + entry(run, told)
    if "supply_pressure" in told and ONE_TABLE not in text:
        text = text.replace("[signals]\n", f"{ONE_TABLE}[signals]\n", 1)
    path.write_text(text)
