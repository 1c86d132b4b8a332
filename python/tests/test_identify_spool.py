"""Spool identification: truth recovered by position, what is missing said, bad records named."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms.identification.spool import identify_spool
from sms.identification.spool_result import declarations, sentences
from sms.io import InputError
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command

from validation.twins.spool_runs import RUNS, Run, draw

SEED = 3


def test_the_truth_comes_back_within_its_errors(tmp_path: Path) -> None:
    spool = draw(tmp_path, SEED)
    found = identify_spool(tmp_path / "rig.toml").position
    assert found is not None
    assert found.best == "cubic"
    best = found.law("cubic")
    told = {t.name: t for t in best.told}
    for name, truth in (
        ("valve_frequency", spool.frequency),
        ("valve_damping_ratio", spool.damping),
        ("command_delay", spool.delay),
    ):
        assert told[name].told
        assert abs(told[name].value - truth) < 4.0 * told[name].error, name
    assert told["valve_frequency"].value == pytest.approx(spool.frequency, rel=0.01)
    centre, error = best.centre
    assert abs(centre - spool.centre) < 4.0 * error
    assert best.rms_identify < 3e-6 < found.law("linear").rms_identify


def test_a_slow_command_shows_the_static_law_and_no_lag(tmp_path: Path) -> None:
    draw(tmp_path, SEED, (Run("triangle", "identify"),))
    result = identify_spool(tmp_path / "rig.toml")
    assert result.position is not None
    assert "valve_frequency" in dict(result.position.left_out)
    assert "never seen to lag" in " ".join(sentences(result))
    assert "spool_cubic_3" in declarations(result)
    assert "valve_frequency" not in declarations(result)


def test_slow_sampling_is_said(tmp_path: Path) -> None:
    draw(tmp_path, SEED, tuple(replace(run, rate=100.0) for run in RUNS))
    result = identify_spool(tmp_path / "rig.toml")
    assert any("sampled every 10 ms" in text for text in sentences(result))


def test_a_spool_that_does_not_move_is_refused_with_what_to_do(tmp_path: Path) -> None:
    draw(tmp_path, SEED, (Run("sweep", "identify"),))
    file = tmp_path / "sweep.csv"
    lines = file.read_text().splitlines()
    still = [",".join([*line.split(",")[:-1], "0.0001"]) for line in lines[1:]]
    file.write_text("\n".join([lines[0], *still]) + "\n")
    with pytest.raises(InputError, match="record commands from 0 to 10 V"):
        identify_spool(tmp_path / "rig.toml")


def test_the_command_writes_a_rig_file_that_is_read_again(tmp_path: Path) -> None:
    draw(tmp_path / "records", SEED, RUNS[:2])
    result = command("identify", "spool", "records/rig.toml", "--out", "spool", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "dead band" in result.stdout  # what a position alone cannot tell
    found = tomllib.loads((tmp_path / "spool" / "spool.toml").read_text())
    assert "uncertainty" in found["parameters"]["valve_frequency"]
    again = identify_spool(tmp_path / "spool" / "spool.toml")
    assert again.position is not None
    assert np.isfinite(again.position.law("cubic").centre[0])
    page = (tmp_path / "spool" / "report.html").read_text()
    for part in ("static", "positions", "position-correlation"):
        assert f'id="{part}"' in page
    other = tmp_path / "records" / "other.toml"
    text = (tmp_path / "records" / "rig.toml").read_text()
    other.write_text(text.replace("spool_test", "tank") + '\n[signals]\ntime = "time"\n')
    refused(command("identify", "spool", str(other), cwd=tmp_path), "signals")


def test_an_end_of_the_travel_that_no_spool_has_is_refused(tmp_path: Path) -> None:
    """A tenth of a metre, where the reading is stuck."""
    draw(tmp_path, SEED)
    steps = tmp_path / "steps.csv"
    head, *rows = steps.read_text().splitlines()
    stuck = [row.rpartition(",")[0] + ",0.1" for row in rows[100:200]]
    steps.write_text("\n".join([head, *rows[:100], *stuck, *rows[200:]]) + "\n")
    with pytest.raises(InputError, match="spool_position stands still at an end"):
        identify_spool(tmp_path / "rig.toml")
