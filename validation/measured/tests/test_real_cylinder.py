"""The claim on the measured cylinder: both causes are found without being told, and hold on records not seen."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from sms.data import cylinder_rig
from sms.diagnosis import Diagnosis, diagnose
from sms.errors import InputError
from sms.io.records import load_record
from sms.io.rig import load_rig

from validation.measured.seals import SEALS, TERMS, least_squares, left, rig_file


@cache
def answer_of(path: Path) -> Diagnosis:
    """Two of the seals are asked for in more than one way."""
    return diagnose(path)


@pytest.fixture(scope="module", params=["o_ring", "kdn"])
def answer(request: pytest.FixtureRequest) -> Diagnosis:
    return answer_of(Path(cylinder_rig(f"cylinder_{request.param}")).resolve())


def test_two_causes_are_named(answer: Diagnosis) -> None:
    assert answer.verdict == "combination"
    gain, friction = answer.causes
    assert set(gain.members) == {"sensor_gain", "bore_diameter"}
    assert {gain.signal, *(a.signal for a in gain.alternatives)} == {
        "rod_force",
        "chamber_pressure_lower",
        None,
    }
    assert 0.005 < gain.parameters[0].value < 0.02
    assert friction.members == ("pressure_dependent_friction",)


def test_the_seals_differ_in_friction(answer: Diagnosis) -> None:
    per_bar = 1e5 * answer.causes[1].parameters[0].value
    expected = 0.75 if "O-ring" in answer.title else 0.13
    assert per_bar == pytest.approx(expected, abs=0.05)


def test_the_error_on_unseen_records(answer: Diagnosis) -> None:
    def pooled(kind: str) -> float:
        return float(np.sqrt(np.mean([getattr(g, kind) ** 2 for g in answer.gain])))

    assert pooled("baseline_rms") > 3.0
    assert pooled("extended_rms") < (1.25 if "O-ring" in answer.title else 0.85)
    assert all(g.reduction_low > 0.3 for g in answer.gain)


def test_nothing_is_claimed_of_speed(answer: Diagnosis) -> None:
    blind = {n.effect: n.reason for n in answer.not_testable}
    assert {"viscous_friction", "stribeck_friction", "exponential_friction"} <= set(blind)
    assert "decade" in blind["viscous_friction"]


def test_the_proportional_error_stays_with_the_rig_and_the_friction_goes_with_the_seal(
    answer: Diagnosis,
) -> None:
    assert len(answer.related) == 4
    if "O-ring" in answer.title:
        text = " ".join(answer.conclusion)
        assert "belongs to the rig, not to the seal" in text
        assert "goes with the seal" in text


@pytest.mark.parametrize("seal", SEALS)
def test_every_seal_names_both_causes_and_leaves_no_more_than_least_squares_with_both(
    seal: str,
) -> None:
    path = rig_file(seal)
    try:
        rig = load_rig(path)
        for source in rig.records:
            load_record(rig, source)
    except InputError as error:
        pytest.skip(f"its records are not at hand: {error}")
    answer = answer_of(path.resolve())
    named = {member for cause in answer.causes for member in cause.members}
    assert "pressure_dependent_friction" in named
    assert named & {"sensor_gain", "sensor_offset"}
    assert left(answer) < 1.01 * min(least_squares(rig, terms) for terms in TERMS.values())
