"""The command `./dev trials`: what it refuses, and what it writes for programs."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from sms.io import InputError, load_rig
from typer.testing import CliRunner

from validation.trials.__main__ import app
from validation.trials.foreign import chosen_sets, with_exchanged_roles, within
from validation.trials.foreign_pairs import first_day, judged
from validation.trials.machine_commands import as_dict
from validation.trials.machines import SORTS, tasks
from validation.trials.scoring import Outcome

LEAK = Outcome("tank", 1, "catalogue", 3.0, ["leak"], [1.0], "cause", [["leak"]])


def test_a_rig_that_nobody_simulates_is_refused() -> None:
    answer = CliRunner().invoke(app, ["boat"])
    assert answer.exit_code == 2
    assert "No such command 'boat'" in answer.output


def test_files_without_an_outcome_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no outcome"):
        CliRunner().invoke(app, ["score", str(tmp_path / "none")], catch_exceptions=False)


def test_programs_get_goals_and_outcomes() -> None:
    answer = json.loads(json.dumps(as_dict([LEAK])))
    assert answer["goals"][0]["count"] == answer["goals"][0]["of"] == 1
    assert Outcome(**answer["outcomes"][0]) == LEAK


def test_trials_of_one_sort() -> None:
    assert {t.sort for t in tasks("tank", 7, 10, 3.0)} == set(SORTS)
    healthy = tasks("tank", 7, 10, 3.0, (0.0, 2.0), only="healthy")
    assert [(t.seed, t.sort) for t in healthy[::2]] == [(7 + k, "healthy") for k in range(10)]
    with pytest.raises(InputError, match="did you mean 'healthy'"):
        CliRunner().invoke(app, ["tank", "--only", "healty"], catch_exceptions=False)


def test_a_set_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no set with"):
        chosen_sets(tmp_path, "set01")
    (tmp_path / "keys").mkdir()
    for name in ("set01", "set02"):
        (tmp_path / name).mkdir()
        (tmp_path / "keys" / f"{name}.json").write_text("{}", encoding="utf-8")
    assert chosen_sets(tmp_path, "") == ["set01", "set02"]
    assert chosen_sets(tmp_path, "set02") == ["set02"]
    with pytest.raises(InputError, match="has no set set99; it has set01 to set02"):
        chosen_sets(tmp_path, "set02, set99")


def test_sizes_are_compared_as_that_simulator_counts_them() -> None:
    def answer(parameter: str, value: float) -> Any:
        found = SimpleNamespace(name=parameter, value=value, standard_error=0.1 * abs(value))
        cause = SimpleNamespace(parameters=(found,), alternatives=())
        return SimpleNamespace(causes=(cause,))

    key = {"true_values": {"C_leak_m3_s_Pa": 2e-10}, "drawn": {"gain": 1.5}}
    assert within(key, answer("valve_leakage", 3e-10))
    assert not within(key, answer("valve_leakage", 2e-10))
    assert within({"true_values": {"C_leak_m3_s_Pa": 2e-10}}, answer("valve_leakage", 2e-10))
    assert within({"true_values": {"gain": 1.04}}, answer("sensor_gain_extension", 0.04))
    assert (
        within({"true_values": {"a_law_of_its_own": 1.0}}, answer("valve_leakage", 2e-10)) is None
    )


def test_records_exchange_their_roles_and_are_found_where_they_are(tmp_path: Path) -> None:
    there, here = tmp_path / "there", tmp_path / "here"
    there.mkdir()
    here.mkdir()
    roles = ("identify", "validate", "reference")
    records = [f'[[records]]\nfile = "{role}.csv"\nrole = "{role}"\n' for role in roles]
    for role in roles:
        (there / f"{role}.csv").write_text("time,valve_command,tank_pressure\n", encoding="utf-8")
    text = '[rig]\nkind = "tank"\n\n[signals]\ntime = "time"\nvalve_command = {}\ntank_pressure = {}\n\n'
    (there / "rig.toml").write_text(text + "\n".join(records), encoding="utf-8")
    made = load_rig(with_exchanged_roles(there / "rig.toml", here))
    found = [
        (source.file.resolve().parent, source.file.stem, source.role) for source in made.records
    ]
    exchanged = ("validate", "identify", "reference")
    assert found == [(there, role, other) for role, other in zip(roles, exchanged, strict=True)]


def test_reference_records_are_the_first_day_of_a_pair(tmp_path: Path) -> None:
    there, here = tmp_path / "there", tmp_path / "here"
    there.mkdir()
    here.mkdir()
    text = '[rig]\nkind = "tank"\n[signals]\ntime = "t"\nvalve_command = "u"\ntank_pressure = "p"\n'
    for name, role in (("a", "identify"), ("b", "validate"), ("c", "identify")):
        text += f'[[records]]\nfile = "{name}.csv"\nrole = "{role}"\nname = "{name}"\n'
    for name in ("b", "a"):
        text += (
            f'[[records]]\nfile = "r{name}.csv"\nrole = "reference"\nname = "reference_{name}"\n'
        )
    (there / "rig.toml").write_text(text)
    for name in ("a", "b", "c", "ra", "rb"):
        (there / f"{name}.csv").write_text("t,u,p\n0,5,1e5\n1,5,1e5\n2,5,1e5\n")
    made = load_rig(first_day(there / "rig.toml", here))
    assert [(r.file.name, r.role) for r in made.records] == [
        ("rb.csv", "validate"),
        ("ra.csv", "identify"),
    ]
    (there / "rig.toml").write_text(text.replace("reference_b", "reference_d"))
    with pytest.raises(InputError, match="no record 'd'"):
        first_day(there / "rig.toml", here)


@pytest.mark.parametrize(
    ("accepted", "changed", "right", "wrong"),
    [
        ([{"NOTHING"}], [], True, False),
        ([{"NOTHING"}], [["backlash"]], False, True),
        ([{"UNKNOWN"}], [], True, False),
        ([{"valve_leakage"}], [["valve_leakage"]], True, False),
        ([{"valve_leakage"}], [], False, False),
        ([{"valve_leakage"}], [["valve_leakage"], ["backlash"]], False, True),
        ([{"valve_leakage"}, {"moving_mass"}], [["valve_leakage"]], False, False),
    ],
)
def test_a_pair_is_right_when_what_was_hidden_and_nothing_else_is_called_changed(
    accepted: list[set[str]], changed: list[list[str]], right: bool, wrong: bool
) -> None:
    assert judged(accepted, changed) == (right, wrong)
