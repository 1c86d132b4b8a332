"""Where nothing that was fitted stands, what promises next is fitted before anything is said."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from sms.diagnosis.adequacy.residual_energy import Left
from sms.diagnosis.selection import stepwise
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.finite_steps import Step
from sms.diagnosis.selection.stepwise import try_more

CURRENT = cast(Any, SimpleNamespace(params=None))
DATA = cast(Any, SimpleNamespace(healthy=None, identify=None, rig=None))


def trial(name: str, by_step: float, fitted: Any = CURRENT) -> Trial:
    effect = cast(Any, SimpleNamespace(key=name, parameters=(name,)))
    made = Trial(effect, fitted, 0.5, by_step=by_step)
    made.reason = "promises less than others of this round, by slope and by finite steps"
    return made


@pytest.fixture
def left_by(monkeypatch: pytest.MonkeyPatch) -> dict[str, float]:
    """What each effect's rough fit leaves; the numbers are residuals here."""
    left = {"lag": 2.0, "cushion": 3.0, "mass": 4.0, "tube": 1.0}

    def steps(effects: Any, current: Any, data: Any, declared: bool) -> list[Step]:
        gain = {"lag": 1.6, "cushion": 0.7, "mass": 0.2, "tube": 0.1}
        return [
            Step(gain[e.key], cast(Any, None), np.eye(4)[list(gain).index(e.key)]) for e in effects
        ]

    def rough(effect: Any, current: Any, data: Any, step: Any, slope: float, room: Any) -> Any:
        return SimpleNamespace(fit=SimpleNamespace(residual=np.full(1, left[effect.key])))

    def settled(fits: Any, left_of: Any, alike: Any, data: Any) -> Any:
        best = min(fits, key=lambda k: left_of(fits[k]))
        to_its_end = SimpleNamespace(fit=SimpleNamespace(residual=np.full(1, 0.5)))
        return fits | {best: to_its_end}

    monkeypatch.setattr(stepwise, "best_steps", steps)
    monkeypatch.setattr(stepwise, "_fitted", rough)
    monkeypatch.setattr(stepwise, "room_of", lambda *which: (0.0, 1.0))
    monkeypatch.setattr(stepwise, "without_sensitivities", lambda fitted: fitted)
    monkeypatch.setattr(stepwise, "leaders_settled", settled)
    monkeypatch.setattr(stepwise, "logarithms", lambda runs, residual: float(residual[0]))
    monkeypatch.setattr(stepwise, "no_help", lambda *trial: "takes 0 %")
    monkeypatch.setattr(Left, "by", lambda fitted, data: None)
    return left


def test_the_next_three_are_fitted_and_the_best_of_them_to_its_end(
    left_by: dict[str, float],
) -> None:
    fitted_before = cast(Any, SimpleNamespace())
    trials = [
        trial("clock", 4.0, fitted_before),
        trial("lag", 1.6),
        trial("gain", 0.0),  # of what no step helps nothing is to be had
        trial("cushion", 0.7),
        trial("mass", 0.2),
        trial("tube", 0.1),
    ]
    more = try_more(CURRENT, DATA, trials, 0.5)
    assert [t.effect.key for t in more] == ["lag", "cushion", "mass"]
    assert [float(t.fitted.fit.residual[0]) for t in more] == [0.5, 3.0, 4.0]
    assert not any(t.reason for t in more)
    assert trials[0].fitted is fitted_before
    assert all(t.fitted is CURRENT for t in trials if t.effect.key in ("gain", "tube"))


def test_where_nothing_promises_nothing_is_fitted(left_by: dict[str, float]) -> None:
    assert not try_more(CURRENT, DATA, [trial("gain", 0.0)], 0.5)


@pytest.mark.parametrize("helps", [True, False])
def test_what_is_alike_to_the_first_is_fitted_where_that_helps(
    helps: bool, left_by: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """From what is declared 31 effects shifted one window of a platform alike, and none of them took anything."""
    shift, droop = np.eye(2)
    gains = {"zero": (9.0, shift), "gain": (8.0, shift), "droop": (3.0, droop)}
    steps = [Step(gain, cast(Any, None), change) for gain, change in gains.values()]
    left_by |= {"zero": 2.0, "gain": 3.0, "droop": 4.0}
    monkeypatch.setattr(stepwise, "best_steps", lambda *model, declared: steps)
    monkeypatch.setattr(stepwise, "no_help", lambda *trial: "" if helps else "takes 0 %")
    more = try_more(CURRENT, DATA, [trial(name, 1.0) for name in gains], 0.5)
    expected = ["zero", "droop", "gain"] if helps else ["zero", "droop"]
    assert [t.effect.key for t in more] == expected
