"""A machine on two days: what differs between them, and how an answer is counted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from validation.random_cases import SEED
from validation.trials.pairs import Pair, pairs_of, shares
from validation.twins.draw import draw_trial, write_trial

LEAK = "fitting_leakage:lower"


def pair(before: float, after: float, *changed: list[str]) -> Pair:
    verdicts = ("no-evidence", "cause")
    return Pair("tank", 1, 1.0, LEAK, before, after, 2e-10, list(changed), verdicts)


def test_the_second_day_has_the_same_machine_and_instruments_but_other_motions_and_noise(
    tmp_path: Path,
) -> None:
    first = draw_trial("tank", 3, "none", 1.0, 1.0)
    for name, trial in (("a", first), ("b", replace(first, day=1)), ("again", first)):
        write_trial(trial, tmp_path / name, tmp_path / f"{name}.json")
    rigs = [(tmp_path / name / "rig.toml").read_text() for name in ("a", "b")]
    assert rigs[0] == rigs[1]
    for file in (tmp_path / "a").glob("*.csv"):
        records = [(tmp_path / name / file.name).read_text() for name in ("a", "b", "again")]
        assert records[0] != records[1]
        assert records[0] == records[2]


def test_how_an_answer_is_counted() -> None:
    assert not pair(0.0, 0.0).called
    assert pair(0.0, 0.0, [LEAK]).wrong
    assert pair(3.0, 3.0, [LEAK]).wrong
    assert pair(0.0, 1.0, [LEAK, "tank_volume"]).called
    assert not pair(0.0, 1.0, [LEAK, "tank_volume"]).wrong
    assert pair(0.0, 1.0, [LEAK], ["valve_centre"]).wrong
    assert not pair(0.0, 1.0).wrong
    counted = shares(
        [pair(0.0, 0.0), pair(3.0, 3.0, [LEAK]), pair(0.0, 2.0, ["x"]), pair(0.0, 3.0, [LEAK])]
    )
    assert [s.count for s in counted] == [0, 0, 1, 0, 1, 1, 1]
    assert [s.of for s in counted] == [1, 0, 1, 0, 1, 1, 2]


@pytest.mark.full
def test_tanks_on_two_days_are_called_changed_where_they_are() -> None:
    """Unchanged ones seldom: more than 5 percent would be, by chance, once in a thousand runs."""
    first = int(np.random.default_rng([SEED, 18]).integers(10**6))
    print(f"seeds {first} to {first + 9}")
    found = [p for seed in range(first, first + 10) for p in pairs_of("tank", seed, 1.0)]
    unchanged = [p.called for p in found if p.before == p.after == 0.0]
    assert sum(unchanged) <= binom.ppf(0.999, len(unchanged), 0.05)
    assert np.mean([p.called for p in found if (p.before, p.after) == (0.0, 3.0)]) >= 0.5
