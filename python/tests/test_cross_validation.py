"""An effect to which the validation records are insensitive: judged by cross-validation."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import plant_support
import pytest
from numpy.typing import NDArray
from sms import _core
from sms.diagnosis import diagnose
from sms.diagnosis.effects.catalogue import catalogue
from sms.diagnosis.hypothesis import Fitted, Hypothesis
from sms.diagnosis.selection.cross_validation import predicted
from sms.estimation.least_squares import WindowFit
from sms.report.diagnosis import report_html

from validation.random_cases import draw

Array = NDArray[np.float64]
HIDDEN = {"exponential_friction_force": 2.0}
BENDING = next(e for e in catalogue("bench") if e.id == "exponential_friction")


def test_a_part_is_predicted_with_the_size_that_the_others_ask_for() -> None:
    """A linear problem: one step is the whole refit, which is done here the long way."""
    random = draw("cross_validation")
    columns, target = random.normal(size=(90, 2)), random.normal(size=90)
    parts = np.repeat(np.arange(3), 30)
    known = 0.1  # half width of the viscous friction, declared as 1.0
    names = {"viscous_friction": (0.0, 9.0), "exponential_friction_force": (0.0, 9.0)}
    start = _core.Params(viscous_friction=1.0)
    hypothesis = Hypothesis(start, names, {"viscous_friction": known}, (BENDING,))
    at = _core.Params(viscous_friction=1.3, exponential_friction_force=2.0)
    residual = columns @ [1.3, 2.0] - target
    fit = WindowFit(at, residual, columns, [False, False], True)
    found = predicted(Fitted(hypothesis, fit, np.zeros((2, 2))), parts)
    for part in range(3):
        own, rest = parts == part, parts != part
        both = np.vstack([columns[rest], [1.0 / known, 0.0]])
        size = np.linalg.lstsq(both, np.append(target[rest], 1.0 / known))[0][1]
        a, b = columns[own, 0], target[own] - size * columns[own, 1]
        free = (a @ b + 1.0 / known**2) / (a @ a + 1.0 / known**2)
        assert found[own] == pytest.approx(a * free - b, abs=1e-9)


def _slow_aside(kind: int, time: Array, setpoint: object = plant_support.setpoint) -> Array:
    assert callable(setpoint)
    return np.asarray(setpoint(kind, time if kind < 2 else 0.2 * time))


needs_fit = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


@pytest.mark.full
@needs_fit
def test_friction_at_high_speed_is_named_from_the_fitted_records_alone_and_said_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(plant_support, "setpoint", _slow_aside)
    answer = diagnose(plant_support.write_bench(tmp_path, 3, HIDDEN))
    (cause,) = answer.causes
    assert (cause.effect, cause.cross_validated) == ("exponential_friction", True)
    found = cause.parameters[0]
    assert found.value == pytest.approx(2.0, abs=max(3.0 * found.standard_error, 0.1))
    said = [text for text in answer.conclusion if "records are insensitive to it" in text]
    assert len(said) == 1
    assert answer.next_experiment is not None
    assert 'role = "validate"' in answer.next_experiment.title
    assert "more than 0.2 m/s" in answer.next_experiment.purpose
    assert "records are insensitive to it" in report_html(answer)
    assert not any("the error within a window falls" in text for text in answer.conclusion)


@needs_fit
@pytest.mark.full
def test_what_the_fitted_records_disagree_on_is_not_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of the two fitted records is of a machine that has twice as much and more of it."""
    monkeypatch.setattr(plant_support, "setpoint", _slow_aside)
    rig = plant_support.write_bench(tmp_path / "rig", 3, HIDDEN)
    other = plant_support.write_bench(tmp_path / "other", 4, {"exponential_friction_force": 5.0})
    shutil.copy(other.parent / "run1.csv", rig.parent / "run1.csv")
    answer = diagnose(rig)
    assert (answer.verdict, answer.causes) == ("unknown", ())
    (tried,) = [c for c in answer.candidates if c.effect == "exponential_friction"]
    assert not tried.accepted and tried.reason
