"""Trials on imperfect machines, and the run that an ambiguous answer proposes: bookkeeping and shares."""

from __future__ import annotations

import tomllib
from dataclasses import asdict, replace
from json import dumps, loads
from pathlib import Path

import numpy as np
import pytest
from sms.diagnosis.pipeline import read_and_check
from sms.errors import InputError
from sms.estimation.kind import Experiment
from sms.estimation.run import make_run
from sms.io.rig import load_rig
from sms.rigs.kinds import KINDS
from sms.rigs.tank import valve_of
from typer.testing import CliRunner

from validation.trials import follow_up
from validation.trials.__main__ import app
from validation.trials.answers import Answered, answered
from validation.trials.by_level import by_level, follow_up_shares
from validation.trials.follow_up import asked_of, followed, one_right
from validation.trials.machine_commands import levels_of
from validation.trials.machines import Task, hide, run_tasks, tasks
from validation.trials.scoring import FollowUp, Outcome, load, outcome_from
from validation.twins.added import Asked, add_record
from validation.twins.draw import Trial, draw, draw_trial

LEAK, LAG = "piston_leakage", "spool_lag"


def outcome(
    seed: int, sort: str, hidden: list[str], verdict: str, *named: list[str], at: float = 0.0
) -> Outcome:
    values = [1.0] * len(hidden)
    return Outcome("bench", seed, sort, 3.0, hidden, values, verdict, list(named), imperfection=at)


def in_file(path: Path, *outcomes: Outcome) -> Path:
    path.write_text("".join(dumps(asdict(o)) + "\n" for o in outcomes))
    return path


# Levels


def test_shares_are_counted_by_level() -> None:
    right, wrong = ("cause", [LEAK]), ("cause", [LAG])
    told = [
        outcome(1, "catalogue", [LEAK], *right, at=0.0),
        outcome(1, "catalogue", [LEAK], *right, at=2.0),
        outcome(2, "catalogue", [LEAK], *wrong, at=2.0),
        outcome(3, "healthy", [], *wrong, at=2.0),
        outcome(4, "healthy", [], "unknown", at=2.0),
        outcome(5, "outside", ["bent_rod"], "unknown", at=4.0),
    ]
    found = by_level(told)
    assert list(found) == ["0 %", "2 %", "4 %", "0 to 2 %"]

    def counted(level: str) -> list[tuple[int, int]]:
        return [(s.count, s.of) for s in found[level]]

    # right, pairs, wrong name, named when healthy, unknown when healthy, unknown from outside
    assert counted("0 %")[:6] == [(1, 1), (0, 0), (0, 1), (0, 0), (0, 0), (0, 0)]
    assert counted("2 %")[:6] == [(1, 2), (0, 0), (1, 2), (1, 2), (1, 2), (0, 0)]
    assert counted("4 %")[:6] == [(0, 0), (0, 0), (0, 1), (0, 0), (0, 0), (1, 1)]
    assert counted("0 to 2 %")[:6] == [(2, 3), (0, 0), (1, 3), (1, 2), (1, 2), (0, 0)]


def test_intervals_are_of_95_percent_and_gains_over_those_of_the_true_model() -> None:
    right = outcome(1, "catalogue", [LEAK], "cause", [LEAK])
    inside = replace(right, estimates=[(1.19, 0.1)], gain=0.8, achievable=0.8)
    outside = replace(right, seed=2, estimates=[(1.2, 0.1)], gain=0.5, achievable=0.8)
    interval, gain = by_level([inside, outside])["0 %"][-2:]
    assert (interval.count, interval.of) == (gain.count, gain.of) == (1, 2)


def test_the_same_trials_are_made_at_each_level_and_known_again(tmp_path: Path) -> None:
    wanted = tasks("bench", 1, 1, 3.0, [0.0, 2.0])
    assert [t.imperfection for t in wanted] == [0.0, 2.0]
    both = [outcome(1, wanted[0].sort, [LEAK], "cause", [LEAK], at=a) for a in (0.0, 2.0)]
    assert run_tasks(wanted, in_file(tmp_path / "trials.jsonl", *both), workers=1) == both


def test_a_file_from_before_there_were_levels_is_read(tmp_path: Path) -> None:
    fields = asdict(outcome(1, "catalogue", [LEAK], "cause", [LEAK]))
    del fields["imperfection"], fields["follow_ups"]
    file = tmp_path / "trials.jsonl"
    file.write_text(dumps(fields) + "\n")
    (found,) = load(file)
    assert (found.imperfection, found.follow_ups) == (0.0, None)


def test_score_prints_a_table_by_level(tmp_path: Path) -> None:
    told = [outcome(1, "catalogue", [LEAK], "cause", [LEAK], at=a) for a in (0.0, 1.0)]
    said = CliRunner().invoke(app, ["score", str(in_file(tmp_path / "t.jsonl", *told))])
    assert said.exit_code == 0
    assert "0 to 1 %" in said.output and "1 of 1, 100 % (5 %)" in said.output


def test_a_level_that_no_machine_has_is_refused() -> None:
    with pytest.raises(InputError, match="--imperfection 40"):
        levels_of([1.0, 40.0])
    assert levels_of(None) == [0.0] and levels_of([2.0, 1.0, 2.0]) == [2.0, 1.0]


# Proposals


def test_one_right_cause_is_one_that_is_there() -> None:
    assert one_right([[LEAK]], [LEAK])
    assert one_right([[LEAK]], [LEAK, LAG])
    assert not one_right([], [LEAK])
    assert not one_right([[LEAK, LAG]], [LEAK])
    assert not one_right([[LEAK], [LAG]], [LEAK])


def test_what_became_of_proposals_is_counted_by_how_they_were_chosen(tmp_path: Path) -> None:
    both = [
        FollowUp("proposed", ["a"], "cause", [[LEAK]], True, 1.0),
        FollowUp("random", ["b", "c"], "class", [[LEAK, LAG]], False, 1.0),
    ]
    wrong = FollowUp("proposed", ["a", "a"], "cause", [["tube"]], False, 1.0)
    told = [
        replace(outcome(1, "catalogue", [LEAK], "class", [LEAK, LAG]), follow_ups=both),
        replace(outcome(2, "catalogue", [LEAK], "class", [LAG, "tube"]), follow_ups=[wrong]),
        replace(outcome(3, "catalogue", [LEAK], "cause", [LEAK]), follow_ups=[]),
        outcome(4, "catalogue", [LEAK], "class", [LEAK, LAG]),
    ]
    file = in_file(tmp_path / "trials.jsonl", *told)
    assert load(file) == told
    counted = {
        arm: [(s.count, s.of) for s in shares] for arm, shares in follow_up_shares(told).items()
    }
    # one right cause, after one run, where the class had it, a wrong name
    assert counted["proposed"] == [(1, 2), (1, 2), (1, 1), (1, 2)]
    assert counted["random"] == [(0, 1), (0, 1), (0, 1), (0, 1)]


def test_a_trial_is_done_again_for_its_proposals_and_counts_once(tmp_path: Path) -> None:
    (task,) = tasks("bench", 1, 1, 3.0, follow=True)
    done = outcome(1, task.sort, [LEAK], "cause", [LEAK])
    assert replace(task, follow=False).done({done.key: done})
    assert not task.done({done.key: done})
    again = replace(done, follow_ups=[])
    assert task.done({again.key: again})
    assert load(in_file(tmp_path / "trials.jsonl", done, again)) == [again]
    assert outcome_from(loads(dumps(asdict(again)))) == again


MENU = [(kind, e) for kind in ("bench", "tank", "platform") for e in KINDS[kind].menu]


@pytest.mark.parametrize(("kind", "experiment"), MENU)
def test_the_simulator_is_asked_for_every_run_of_the_menu(
    kind: str, experiment: Experiment
) -> None:
    trial = draw_trial(kind, 4, "none", 3.0, 1.0)
    asked = asked_of(trial, experiment, "asked")
    assert len(asked.setpoint) == round(8.0 / trial.rig.clock.period) + 1
    assert asked.setpoint.shape[1:] == ((3,) if kind == "platform" else ())
    told = {"added": "moving_mass", "less supply": "supply_pressure"}
    assert set(asked.changes) == {n for words, n in told.items() if words in experiment.title}


@pytest.mark.parametrize("level", [0.0, 2.0])
def test_an_added_record_is_of_the_same_machine_and_says_what_was_changed(
    level: float, tmp_path: Path
) -> None:
    trial = draw("tank", 8, tmp_path / "r", tmp_path / "t.json", "none", imperfection=level)
    experiment = next(e for e in KINDS["tank"].menu if "less supply" in e.title)
    add_record(trial, asked_of(trial, experiment, "asked_1"), (0, 1), tmp_path / "r")
    rig = load_rig(tmp_path / "r" / "rig.toml")
    records, findings = read_and_check(rig)
    assert not [f for f in findings if f.severity == "error"]
    added = make_run(rig, records[-1])
    assert (added.name, added.role) == ("asked_1", "identify")
    assert added.conditions == {"supply_pressure": -1e5}
    assert {valve_of(rig, make_run(rig, r)) for r in records} == {"iso_0_4_mpa"}
    assert added.step == pytest.approx(trial.rig.sample_step)
    read = np.median(added.signals["supply_pressure"])
    known = trial.truth.value("supply_pressure")
    assert read == pytest.approx(known - 1e5, abs=3e3)
    listed = tomllib.loads((tmp_path / "r" / "rig.toml").read_text())["records"]
    assert [r.get("conditions") is None for r in listed] == [True] * 4 + [False]


def test_a_bench_follows_what_it_is_asked_for(tmp_path: Path) -> None:
    trial = draw("bench", 8, tmp_path / "r", tmp_path / "t.json", "none")
    time = np.arange(0.0, 10.0 + 1e-9, trial.rig.clock.period)
    wanted = 0.2 + 0.05 * np.sin(2.0 * np.pi * 0.1 * time)
    experiment = next(e for e in KINDS["bench"].menu if "slow triangle" in e.title)
    gains = asked_of(trial, experiment, "asked").gains
    add_record(trial, Asked("slow", wanted, gains, {}), (0, 1), tmp_path / "r")
    columns = (tmp_path / "r" / "slow.csv").read_text().partition("\n")[0].split(",")
    rows = np.loadtxt(tmp_path / "r" / "slow.csv", delimiter=",", skiprows=1)
    extension = rows[:, columns.index("extension [m]")]
    # A slow loop of 10 V/m lags, but it goes along.
    assert np.corrcoef(extension, wanted)[0, 1] > 0.8
    assert 0.02 < np.ptp(extension) < 0.15


def test_two_proposals_at_most_are_made_each_with_one_more_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a tank whose answer stays a class, whatever is measured."""
    records = tmp_path / "records"
    trial = hide(Task("tank", 108, "catalogue", 3.0), records, tmp_path / "truth.json")
    answer = answered(records, 108)
    menu = KINDS["tank"].menu
    folders: list[int] = []

    def once_more(folder: Path, seed: int) -> Answered:
        folders.append(len(list(folder.glob("*.csv"))))
        return answer

    monkeypatch.setattr(follow_up, "answered", once_more)
    monkeypatch.setattr(follow_up, "ambiguous", lambda case: True)
    monkeypatch.setattr(follow_up, "proposed", lambda case: menu[2])
    made = followed(trial, records, answer)
    assert folders == [5, 6, 5, 6]
    assert len(list(records.glob("*.csv"))) == 4
    assert made[0].experiments == [menu[2].title] * 2
    assert len(set(made[1].experiments)) == 2
    assert [f.arm for f in made] == ["proposed", "random"]
    assert isinstance(trial, Trial)
