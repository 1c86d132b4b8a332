"""The records of the demonstration: two runs of a bench actuator, and the rig file that its owner would write."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sms import _core
from sms.demo.hidden import Hidden
from sms.diagnosis.design.detection_limits import published_rig
from sms.errors import InputError
from sms.io.rig import Rig
from sms.io.signals import SIGNALS
from sms.io.write import write_record, write_text_atomically
from sms.parameters import PARAMETERS
from sms.rigs.bench import BENCH, OUTPUTS

RUNS = (("identify", "multisine", 0), ("validate", "slow triangle", 1))
"""Role and name of each record, and which experiment of the menu it is (rigs/bench.py)."""
DURATION = 4.0
"""s, of a record: half a minute of diagnosis on two cores."""
EVERY = 2
"""Samples of the menu's runs in one of the record, which is logged at 100 Hz."""
RESOLUTION = {"m": 1e-4, "Pa": 250.0}
"""Steps of 12-bit converters over 0.4 m and 10 bar, by the signal's unit."""


def streams(seed: int) -> list[np.random.Generator]:
    """Of one seed the random numbers for the effect, the machine, the noise and the seal, each by itself."""
    return [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(4)]


def machine_of(rig: Rig, hidden: Hidden, rng: np.random.Generator) -> _core.Params:
    """The bench as published, each number off by what its declared half width allows, and one of them wrong."""
    machine = rig.start()
    for name, row in PARAMETERS.items():
        half = row.uncertainty
        off = float(np.clip(rng.normal(0.0, 0.5 * half), -half, half))  # drawn whether used or not
        if half > 0.0 and name != hidden.parameter:
            machine[name] = float(np.clip(row.default + off, row.lower, row.upper))
    machine[hidden.parameter] = hidden.value
    return machine


def write_bench(
    folder: Path, hidden: Hidden, for_machine: np.random.Generator, for_noise: np.random.Generator
) -> Path:
    """Write the records and rig.toml, which says nothing of what is hidden; the rig file's path."""
    rig = published_rig("bench")
    machine = machine_of(rig, hidden, for_machine)
    for _, name, number in RUNS:
        run = BENCH.menu[number].simulated(rig, machine, OUTPUTS)
        if run is None:
            raise InputError(
                f"{hidden.key} of {hidden.value:g} {hidden.unit}: the piston leaves its stroke; choose another --seed"
            )
        kept = slice(0, round(DURATION / run.step), EVERY)
        signals = {"time": run.time[kept], "valve_command": run.signals["valve_command"][kept]}
        for signal in OUTPUTS:
            clean = run.signals[signal][kept]
            read = clean + for_noise.normal(0.0, noise_of(signal), clean.size)
            step = RESOLUTION[BENCH.units[signal]]
            signals[signal] = step * np.round(read / step)
        write_record(folder / f"{name.replace(' ', '_')}.csv", signals)
    path = folder / "rig.toml"
    write_text_atomically(path, rig_text())
    return path


def noise_of(signal: str) -> float:
    """Standard deviation of a reading, SI; the supply's sensor is one like the chambers'."""
    return SIGNALS[signal].noise or SIGNALS["chamber_pressure_lower"].noise


def rig_text() -> str:
    """The rig file: what is measured, and of the machine nothing: it is taken to be as published."""
    signals = "\n".join(_signal(signal) for signal in OUTPUTS)
    listed = "\n".join(
        f'[[records]]\nfile = "{name.replace(" ", "_")}.csv"\nrole = "{role}"\nname = "{name}"\n'
        for role, name, _ in RUNS
    )
    return f"""\
# Written by `sms demo`. No [parameters]: numbers and half widths of the published actuator hold (docs/parameters.md).
[rig]
kind = "bench"
title = "Virtual pneumatic actuator on the bench"
notes = "Simulated by sms demo; one thing is wrong with it."

[signals]
time = "time"
valve_command = "valve_command"
{signals}

{listed}"""


def _signal(signal: str) -> str:
    unit = BENCH.units[signal]
    noise, step = (f"{size:g} {unit}" for size in (noise_of(signal), RESOLUTION[unit]))
    return f'{signal} = {{ noise = "{noise}", resolution = "{step}" }}'
