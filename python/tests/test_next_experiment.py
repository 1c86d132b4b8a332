"""What to measure next where nothing has a name."""

from __future__ import annotations

from typing import Any

import pytest
from sms.diagnosis.design.next_experiment import next_experiment
from sms.diagnosis.result import Hidden, Shape


@pytest.mark.parametrize(
    ("signal", "title", "said"),
    [
        ("velocity [m/s]", "A run that moves velocity alone", "follows velocity or something"),
        (
            "time [s]",
            "The machine at rest, for as long as a run",
            "from outside, or with the motion",
        ),
    ],
)
def test_an_unknown_asks_for_a_run_that_can_be_made(signal: str, title: str, said: str) -> None:
    shape = Shape("force", signal, (0.0, 1.0), (0.0, 1.0), (0.1, 0.1), "N", 0.9)
    nothing: Any = None  # neither model nor records are asked
    asked = next_experiment(
        "unknown", [], nothing, nothing, Hidden({"force": (0.9, 0.8, 1.0)}, {}, shape)
    )
    assert asked is not None
    assert asked.title == title
    assert said in asked.purpose and "in force" in asked.purpose
