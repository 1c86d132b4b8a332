"""What takes the place of a cause that does not stand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from sms.diagnosis import simulated
from sms.diagnosis.selection import next_best as subject
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.next_best import next_best
from sms.diagnosis.selection.outcome import Outcome, Round


def trial(name: str, lower: float, accepted: bool = True) -> Trial:
    effect = cast(Any, SimpleNamespace(key=name, parameters=(name,)))
    made = Trial(effect, cast(Any, f"model with {name}"), 0.0, np.zeros(1))
    made.lower, made.accepted = lower, accepted
    return made


@pytest.fixture
def round_one(monkeypatch: pytest.MonkeyPatch) -> Round:
    """A sensor's zero and its gain, then a set point and its leg's, then what was never accepted."""
    monkeypatch.setattr(subject, "converged", lambda fitted, data: f"{fitted}, to its end")
    monkeypatch.setattr(
        subject, "alike", lambda accepted, *model: [t for t in accepted if t.lower > 30.0]
    )
    trials = [
        trial("droop", 12.0, accepted=False),
        trial("setpoint of one leg", 39.0),
        trial("zero", 44.0),
        trial("setpoint", 40.0),
        trial("gain", 44.0),
    ]
    return Round(trials, [trials[2], trials[4]])


def model(*whatever: Any) -> Any:
    return None


def test_it_is_the_best_of_those_that_were_accepted_and_not_refused(round_one: Round) -> None:
    for refused in round_one.members:
        refused.accepted = False
    later = Round([], [])
    found = next_best(Outcome(model(), [round_one, later], []), model(), model())
    assert found is not None
    (members,) = found.found
    assert [t.effect.key for t in members] == ["setpoint", "setpoint of one leg"]
    assert found.final == members[0].fitted == "model with setpoint, to its end"
    assert found.rounds[0].members == members
    assert found.rounds[1] is later
    for refused in members:
        refused.accepted = False
    assert next_best(found, model(), model()) is None


@pytest.mark.parametrize(
    ("holds", "named"), [("zero", "zero"), ("setpoint", "setpoint"), ("droop", None)]
)
def test_each_is_asked_in_turn_until_one_stands(
    round_one: Round, holds: str, named: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def standing(outcome: Outcome, *rest: Any) -> tuple[Any, Outcome]:
        (members,) = outcome.found
        if any(t.effect.key == holds for t in members):
            return outcome.final, outcome
        for t in members:
            t.accepted = False
        return "baseline", Outcome(model(), outcome.rounds, [])

    monkeypatch.setattr(simulated, "_standing", standing)
    outcome = Outcome(model(), [round_one], [round_one.members])
    _, found = simulated._with_sizes(outcome, model(), model(), np.zeros(1))
    assert [m[0].effect.key for m in found.found] == ([] if named is None else [named])


def test_where_nothing_was_found_nothing_takes_its_place(
    round_one: Round, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What backward elimination has shown to be dispensable was accepted once too."""
    monkeypatch.setattr(simulated, "_standing", lambda outcome, *rest: (outcome.final, outcome))
    _, found = simulated._with_sizes(
        Outcome(model(), [round_one], []), model(), model(), np.zeros(1)
    )
    assert not found.found
