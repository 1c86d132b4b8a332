"""The peers' table: what counts as what, and one trial from the draw to the row."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from validation.reference.multibody.environment import PeersUnavailableError
from validation.trials.peers import __main__ as peers
from validation.trials.peers.exchange import Part, Question, load
from validation.trials.peers.on_cylinder import ask, named_by_terms
from validation.trials.peers.scoring import Said, table


def said(hidden: str, *named: tuple[str, ...], alarm: bool = True) -> Said:
    return Said("m", "t", "catalogue", hidden, named, alarm, None)


def test_what_is_said_counts_as_what_it_is() -> None:
    assert said("a", ("a",)).verdict == "right"
    assert said("a", ("a", "b")).verdict == "class"
    assert said("a", ("b", "c", "d", "a")).verdict == "wrong"  # four guesses are no answer
    assert said("a", ("a",), ("b",)).verdict == "wrong"
    assert said("none", ("a",)).verdict == "wrong"
    assert said("none", ("a",)).false_alarm
    assert said("a", ()).verdict == "unknown"
    assert said("a", alarm=False).verdict == "nothing"
    assert not said("none", alarm=False).false_alarm


def test_terms_of_a_sparse_model_are_read_as_a_person_would() -> None:
    assert named_by_terms(["direction"]) == ()
    assert named_by_terms(["direction*pressure", "direction"]) == (
        ("pressure_dependent_friction",),
    )
    assert named_by_terms(["extension*velocity"]) == ((),)
    assert named_by_terms(["1", "pressure"]) == (
        (
            "direction_dependent_friction",
            "sensor_offset:rod_force",
            "sensor_offset:chamber_pressure_lower",
        ),
        ("sensor_gain:rod_force", "sensor_gain:chamber_pressure_lower"),
    )


def test_a_question_survives_the_way_to_the_peers(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)

    def part(rows: int) -> Part:
        numbers = np.arange(rows) // 5
        return Part(rng.normal(size=rows), rng.normal(size=(rows, 2)), numbers, numbers % 2)

    question = Question(("extension", "direction"), part(20), part(15))
    question.save(tmp_path / "q.npz")
    found = load(tmp_path / "q.npz")
    assert found.names == question.names
    for one, other in ((found.identify, question.identify), (found.validate, question.validate)):
        assert all(
            np.array_equal(a, b)
            for a, b in zip(vars(one).values(), vars(other).values(), strict=True)
        )


def test_a_trial_brings_the_diagnosis_the_best_aic_and_a_question() -> None:
    """Seed 2 hides a sensor's gain; its rival for the same sensitivity is the other sensor's, or the bore."""
    answers, question = ask(2, "catalogue", 3.0)
    assert [s.method for s in answers] == ["sms diagnose", "best AIC, same candidates"]
    assert answers[0].verdict in ("right", "class")
    assert answers[0].gain is not None and answers[0].gain > 0.5
    assert question.identify.inputs.shape == (len(question.identify.residual), 4)
    assert np.std(question.identify.residual) == pytest.approx(1.0)


@pytest.mark.full
def test_the_table_has_every_method_on_every_sort(capsys: pytest.CaptureFixture[str]) -> None:
    try:
        found = peers.run(1, 2, 3.0, 2)
    except PeersUnavailableError as error:
        pytest.skip(str(error))
    assert len(found) == 2 * 3 * 5
    ours = [s for s in found if s.method == "sms diagnose"]
    assert not any(s.false_alarm for s in ours)
    Console(width=120).print(table(found, "two of each"))
    assert "whiteness" in capsys.readouterr().out
