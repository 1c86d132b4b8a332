"""The whole answer on a measured test lung: the resistor that others put in by mistake, and a model that runs."""

from __future__ import annotations

from pathlib import Path

import pytest
from sms.diagnosis import own

from validation.measured import lung
from validation.trials.lung_calibration import Calibration, calibrate, known
from validation.trials.lung_model import TESTS, Test, read_tests
from validation.trials.tests.test_lung import FOLDER, needs_data

Test.__test__ = False  # type: ignore[attr-defined]  # a record of the lung, not a test of pytest's
pytestmark = needs_data


@pytest.fixture(scope="module")
def mistaken() -> tuple[Test, list[Calibration]]:
    """The record, and what every record says at its true setting."""
    assert FOLDER is not None
    tests = read_tests(FOLDER)
    return next(t for t in tests if t.name == lung.RECORD), [calibrate(t) for t in tests]


@pytest.mark.full
def test_the_resistor_that_was_put_in_by_mistake(
    mistaken: tuple[Test, list[Calibration]], tmp_path: Path
) -> None:
    test, calibrations = mistaken
    plant, answer = lung.diagnosed(TESTS[4], test, calibrations)
    assert [c.members for c in answer.causes] == [("resistor",)]
    (found,) = answer.causes[0].parameters
    truth = known(test.truth, test, calibrations)["resistor_drop"]
    assert abs(found.value - truth.value) < truth.half_width + 2.0 * found.standard_error
    assert {p.name for p in answer.refitted} == {
        "compliance",
        "circuit_compliance",
        "linear_share",
        "flow_zero",
    }
    assert all(g.reduction_low > 0.0 for g in answer.gain)
    assert len(answer.free_run) == 2
    assert all(r.extended_rms < r.baseline_rms for r in answer.free_run)
    own.write_diagnosis(answer, tmp_path)
    extended = own.read_parameters(tmp_path / "extended.toml", plant)
    before, after = (own.simulate(m, test.whole).error["volume"] for m in (plant, extended))
    assert after < 0.6 * before
    said = list(lung.lines(plant, answer, test, calibrations))
    assert sum("beside it" in line for line in said) == 4
    assert any("in one free run" in line for line in said)
    assert lung.again(plant, answer, test, tmp_path).startswith(f"{tmp_path.name}/extended.toml")


def test_a_record_that_is_not_there_is_one_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    assert lung.main([str(FOLDER), "--record", "wrong_resistor_pc_5"]) == 2
    said = capsys.readouterr().err
    assert "did you mean 'wrong_resistor_pc_4'" in said and said.count("\n") == 1
