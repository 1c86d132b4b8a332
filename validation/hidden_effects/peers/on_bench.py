"""A trial on the virtual bench: the diagnosis, the best AIC, and the question for the peers.

The residual is that of the simulation, window by window; a correction learnt from it is one of the readings.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np
from sms.diagnosis.catalogue import effects_of
from sms.diagnosis.hypothesis import Fitted, refitted
from sms.diagnosis.method import read_and_check
from sms.diagnosis.plant import investigate, make_data
from sms.diagnosis.runs import Runs
from sms.diagnosis.visible import testable
from sms.io.rig import load_rig

from validation.hidden_effects.machines.draw import open_truth
from validation.hidden_effects.peers.candidates import best_by_aic, key_of
from validation.hidden_effects.peers.exchange import Array, Part, Question
from validation.hidden_effects.peers.scoring import Said
from validation.hidden_effects.plant_trial import Task, hide

INPUTS = {
    "extension [m]": "extension",
    "velocity [m/s]": "velocity",
    "direction": "direction",
    "valve_command [V]": "command",
    "chamber_pressure_lower [Pa]": "pressure_lower",
    "chamber_pressure_upper [Pa]": "pressure_upper",
}


def ask(seed: int, sort: str, multiple: float) -> tuple[list[Said], Question]:
    """Draw, diagnose, compare; the truth is opened at the end."""
    os.environ.setdefault("SMS_THREADS", "1")
    trial = f"{sort}-{seed}"
    with tempfile.TemporaryDirectory() as folder:
        records, sealed = Path(folder) / "records", Path(folder) / "sealed" / "truth.json"
        hide(Task("bench", seed, sort, multiple), records, sealed)
        rig = load_rig(records / "rig.toml")
        read, _ = read_and_check(rig)
        data, rng = make_data(rig, read), np.random.default_rng(seed)
        case = investigate(data, effects_of(rig), rng, lambda text, done: None)
        truth = open_truth(sealed, records)
    hidden = next((e["key"] for e in truth["effects"]), "none")
    able, _ = testable(case.baseline, case.data, effects_of(rig))
    before, after = (
        float(np.mean(refitted(f, case.data).fit.residual ** 2))
        for f in (case.baseline, case.outcome.final if case.outcome.named else case.baseline)
    )
    named = tuple(tuple(key_of(m.effect) for m in members) for members in case.outcome.classes)
    gain = 1.0 - float(np.sqrt(after / before))
    said = [
        Said("sms diagnose", trial, sort, hidden, named, case.verdict != "no-evidence", gain),
        best_by_aic(case.baseline, case.data, able, trial, sort, hidden),
    ]
    assert isinstance(case.data.identify, Runs) and isinstance(case.data.validate, Runs)
    there = refitted(case.baseline, case.data)
    question = Question(
        tuple(INPUTS.values()),
        _part(case.data.identify, case.baseline),
        _part(case.data.validate, there),
    )
    return said, question


def _part(runs: Runs, fitted: Fitted) -> Part:
    inputs: Array = np.column_stack([runs.inputs[name] for name in INPUTS])
    series = runs.block * len(runs.channels) + runs.channel
    return Part(-fitted.fit.residual, inputs, series, runs.channel)


def named_by_terms(terms: list[str]) -> tuple[tuple[str, ...], ...]:
    """No term of a reading's correction has a name in the machine: an error of extension over velocity may be a clock,
    a friction or a flow."""
    return ((),) if terms else ()
