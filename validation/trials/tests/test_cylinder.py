"""The blind trial as a test: at most 1 false name in 40 healthy draws, at least 38 of 40 hidden effects found.

./dev test --full takes fresh seeds, ./dev test a twentieth of them, fixed; the seed and the confusion matrix are
printed.
"""

from __future__ import annotations

import os

import pytest
from rich.console import Console
from scipy.stats import binom

from validation.random_cases import SEED
from validation.trials.cylinder import Outcome, confusion_matrix, run_trials, some_effect, summary

COUNT = 40
FEW = 2
FIXED_SEED = 20000


def trial(first: int, count: int) -> None:
    console = Console(width=160)
    healthy = range(first, first + count)
    ill = range(first + count, first + 2 * count)
    outcomes = run_trials(
        [*healthy, *ill],
        lambda s: "none" if s in healthy else some_effect(s),
        workers=os.cpu_count() or 1,
    )
    console.print(f"seeds {first} to {first + 2 * count - 1}")
    console.print(confusion_matrix(outcomes))
    console.print(summary(outcomes))
    assert sum(o.wrong_name for o in outcomes if o.hidden == "none") <= count // COUNT
    assert sum(o.right for o in outcomes if o.hidden != "none") >= count - 2 * count // COUNT
    within = [o.within for o in outcomes if o.within is not None]
    assert sum(within) >= binom.ppf(1e-3, len(within), 0.95)


def test_hidden_effects_are_found_and_health_is_left_alone() -> None:
    trial(FIXED_SEED, FEW)


@pytest.mark.full
def test_fresh_hidden_effects_are_found_and_health_is_left_alone() -> None:
    trial(SEED % 10**6 + 10**6, COUNT)


def test_the_trial_itself_can_tell_right_from_wrong() -> None:
    """A judge that never says no would make the trial worthless."""
    gain, friction = "sensor_gain:rod_force", "pressure_dependent_friction"
    assert Outcome(1, gain, 0.01, "class", ((gain, "bore_diameter"),), 0.01).right
    assert not Outcome(1, gain, 0.01, "cause", ((friction,),), None).right
    assert Outcome(1, gain, 0.01, "cause", ((friction,),), None).wrong_name
    assert not Outcome(1, gain, 0.01, "combination", ((gain,), (friction,)), 0.01).right
    assert not Outcome(1, gain, 0.01, "class", ((gain, "a", "b", "c"),), 0.01).right
    assert not Outcome(1, gain, 0.01, "no-evidence", (), None).right
    assert not Outcome(1, gain, 0.01, "no-evidence", (), None).wrong_name
    assert Outcome(1, "none", 0.0, "no-evidence", (), None).right
    assert Outcome(1, "none", 0.0, "cause", ((friction,),), None).wrong_name
    assert not Outcome(1, "none", 0.0, "unknown", (), None).right
    assert Outcome(1, "bore_scratch", 1.0, "unknown", (), None).right
    assert Outcome(1, gain, 0.01, "cause", ((gain,),), 0.012, 0.0011).within
    assert not Outcome(1, gain, 0.01, "cause", ((gain,),), 0.012, 0.0009).within
