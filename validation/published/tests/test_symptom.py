"""The source's own symptom: the picture, the experiments, and what the diagnosis says of it."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from sms.diagnosis import diagnose

from validation.published.symptom import CAUSES, Row, write_records
from validation.published.symptom_experiments import Experiment, experiments
from validation.published.symptom_picture import picture
from validation.twins.draw import draw


def test_an_experiment_is_as_good_as_for_the_two_it_tells_worst() -> None:
    values = {"a": np.array([0.0, 0.0]), "b": np.array([3.0, 4.0]), "c": np.array([3.0, 5.0])}
    assert Experiment(((1.0, 1.0),), ("travel",), values).worst == ("b", "c", 1.0)


def test_the_picture_has_every_cause_that_has_a_size() -> None:
    rows = [
        Row("healthy", None, (0.087, 0.07), (0.0, 0.0)),
        Row("tube", 2.0, (0.081, 0.068), (0.015, 0.01)),
        Row("supply_droop", None, (), ()),
    ]
    text = picture(rows)
    ElementTree.fromstring(text)
    assert "tube" in text
    assert "supply droop" not in text
    assert text.count("<circle") == 2


@pytest.mark.full
def test_travel_under_the_published_sine_tells_nothing_and_a_pair_of_inputs_tells_all() -> None:
    published, best, *_ = experiments(CAUSES)
    assert published.worst[2] < 0.5
    assert best.worst[2] > 10.0
    assert len(best.values) == 6


@pytest.mark.full
def test_the_symptom_is_two_causes_and_one_of_them_a_clock(tmp_path: Path) -> None:
    write_records(1, tmp_path / "rig", tmp_path / "truth.json")
    answer = diagnose(tmp_path / "rig" / "rig.toml")
    clock, flow = answer.causes
    assert (clock.effect, clock.signal) == ("clock_skew", "extension")
    assert clock.parameters[0].value == pytest.approx(-0.2, abs=0.002)
    assert "flow_conductance" in flow.members


@pytest.mark.full
def test_the_curve_of_an_unknown_predicts_unseen_records_of_a_bench(tmp_path: Path) -> None:
    draw("bench", 6, tmp_path / "rig", tmp_path / "truth.json", "dragging_cable", 10.0)
    answer = diagnose(tmp_path / "rig" / "rig.toml", empirical=True)
    assert answer.verdict == "unknown"
    assert answer.empirical is not None
    assert answer.empirical.shape.equation == "force"
    assert answer.empirical.shape.signal == "extension [m]"
    pressures = [g for g in answer.empirical.gain if g.signal.startswith("chamber_pressure")]
    assert all(g.reduction > 0.5 for g in pressures)
