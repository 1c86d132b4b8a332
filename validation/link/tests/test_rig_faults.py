"""Every fault through the whole chain: said, answered as stated, survived, and led back from."""

from __future__ import annotations

import pytest

from validation.link.rig_fault_trials import TRIALS, Trial
from validation.link.rig_faults import Outcome, row, run_trial

ALWAYS = ("lost", "corrupted", "host gone", "two hosts", "sensor broken", "wrong hash")
SHORT = 2.0  #: s


def fault_id(trial: Trial) -> str:
    return trial.fault.replace(" ", "-")


def passes(trial: Trial, seeds: range, seconds: float) -> None:
    outcome = Outcome(trial)
    for seed in seeds:
        run_trial(trial, seed, seconds, outcome)
    assert not outcome.failures, outcome.failures
    assert len(outcome.detected) == len(seeds)
    assert trial.fault in row(outcome)


@pytest.mark.parametrize(
    "trial", [t for t in TRIALS if any(word in t.fault for word in ALWAYS)], ids=fault_id
)
def test_faults_in_short(trial: Trial) -> None:
    passes(trial, range(1, 2), min(trial.seconds, SHORT))


@pytest.mark.full
@pytest.mark.parametrize("trial", TRIALS, ids=fault_id)
def test_faults(trial: Trial) -> None:
    passes(trial, range(1, 4), trial.seconds)


def test_a_fault_that_is_not_said_fails() -> None:
    nothing = Trial("nothing", ("bus_off",), ("tracking",), "", "", lambda s, t: s.stream(t))
    outcome = Outcome(nothing)
    run_trial(nothing, 1, 0.2, outcome)
    assert outcome.failures == ["seed 1: not said; said was nothing"]
    assert "never" in row(outcome)
