"""The peers on bench, platform and tank: what counts as what, the way to the peers, a run that was stopped."""

from __future__ import annotations

from dataclasses import asdict
from json import dumps
from pathlib import Path

import numpy as np
import pytest

from validation.trials.machines import Task, tasks
from validation.trials.peers.exchange import Averages, Equation, Part, PlantAnswer, Question, load
from validation.trials.peers.machine_table import Judged, machine_table
from validation.trials.peers.on_foreign import accepted_names, sort_of
from validation.trials.peers.on_machines import Opinion, Round, play_all
from validation.trials.scoring import Outcome


def outcome(sort: str, hidden: list[str], achievable: float | None = None) -> Outcome:
    return Outcome(
        "bench", 1, sort, 3.0, hidden, [1.0] * len(hidden), "", [], achievable=achievable
    )


def opinion(strength: float, *named: str, equation: str = "", gain: float | None = None) -> Opinion:
    equations = [equation] if equation else []
    return Opinion("m", [[n] for n in named], strength > 1.0, strength, equations, gain, 2.0)


LEAK = Round(outcome("catalogue", ["piston_leakage"], 0.8), ["flow"], [])
HEALTHY = Round(outcome("healthy", []), [], [])
OUTSIDE = Round(outcome("outside", ["bent_rod"]), ["force"], [])


def test_a_peer_is_scored_as_the_diagnosis_is() -> None:
    assert Judged(LEAK, opinion(5.0, "piston_leakage")).as_outcome.right
    assert Judged(LEAK, opinion(5.0, "tube")).as_outcome.wrong_name
    assert Judged(OUTSIDE, opinion(5.0)).as_outcome.right
    assert Judged(OUTSIDE, opinion(5.0, "tube")).as_outcome.wrong_name
    assert Judged(HEALTHY, opinion(0.5)).as_outcome.right
    assert not Judged(HEALTHY, opinion(5.0)).as_outcome.right
    assert Judged(LEAK, opinion(5.0, equation="flow")).equation_found is True
    assert Judged(LEAK, opinion(5.0, equation="force")).equation_found is False
    assert Judged(LEAK, opinion(0.5, equation="force")).equation_found is None
    assert Judged(LEAK, opinion(5.0, gain=0.6)).of_achievable == pytest.approx(0.75)
    assert Judged(OUTSIDE, opinion(5.0, gain=0.6)).of_achievable is None


def test_the_table_counts() -> None:
    answers = [
        (LEAK, opinion(5.0, "piston_leakage", equation="flow", gain=0.8)),
        (LEAK, opinion(1.5, "tube", equation="force", gain=0.4)),
        (HEALTHY, opinion(2.0, gain=0.0)),
        (OUTSIDE, opinion(3.0, gain=0.5)),
    ]
    table = machine_table([Round(r.outcome, r.sits_in, [o]) for r, o in answers], "four")
    row = [next(iter(column.cells)) for column in table.columns]
    assert row == [
        *("m", "1 of 2", "1 of 3", "1 of 1", "1 of 1", "3 of 3", "2 of 3", "1 of 2"),
        *("75 %", "50 %", "2.0"),
    ]


def test_what_equations_lack_survives_the_way_to_the_peers(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)

    def averages() -> Averages:
        return Averages(rng.normal(size=(6, 2)), rng.normal(size=6), np.eye(6))

    none = Part(np.empty(0), np.empty((0, 2)), np.empty(0, np.int64), np.empty(0, np.int64))
    sent = tuple(
        Equation(name, (averages(), averages()), (averages(),)) for name in ("force", "flow")
    )
    Question(("extension", "velocity"), none, none, sent).save(tmp_path / "q.npz")
    found = load(tmp_path / "q.npz").equations
    assert [e.name for e in found] == ["force", "flow"]
    for one, other in zip(sent, found, strict=True):
        assert (len(other.identify), len(other.validate)) == (2, 1)
        for a, b in zip(one.identify + one.validate, other.identify + other.validate, strict=True):
            assert all(np.array_equal(x, vars(b)[n]) for n, x in vars(a).items())


def test_a_run_that_was_stopped_goes_on_where_it_was(tmp_path: Path) -> None:
    wanted = tasks("bench", 1, 1, 3.0)
    done = Round(outcome(wanted[0].sort, ["tube"]), ["flow"], [opinion(2.0, "tube")])
    file = tmp_path / "bench.jsonl"
    file.write_text(dumps(asdict(done)) + "\n" + '{"outcome": {"ki')

    def never(question: Question) -> dict[str, PlantAnswer]:
        raise AssertionError("nothing is left to ask")

    assert play_all(wanted, file, never, lambda: None) == [done]
    assert wanted == [Task("bench", 1, "catalogue", 3.0)]


def test_an_effect_that_a_key_accepts_counts_as_the_one_that_is_hidden() -> None:
    named = accepted_names(
        [["sensor_gain:extension", "tube"], ["piston_leakage"]], [["clock_skew", "tube"]]
    )
    assert named == [["sensor_gain", "clock_skew"], ["piston_leakage"]]
    assert sort_of({"effects": [{"name": "none"}]}) == "healthy"
    assert sort_of({"effects": [{"name": "unknown_cable"}]}) == "outside"
    assert sort_of({"effects": [{"name": "leak"}]}) == "catalogue"
    assert sort_of({"effects": [{"name": "leak"}, {"name": "mass"}]}) == "pair"
