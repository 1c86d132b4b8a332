"""The commands `sms can ...`: their help, their errors, and what they do on a virtual bus."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from sms.cli import app
from sms.io import InputError
from sms.io.can_files import read_frames
from sms.io.can_frames import load_dbc
from sms.io.can_logs import read_can_log
from sms.io.table_files import read_table
from typer.testing import CliRunner, Result

COMMANDS = ("monitor", "drive", "record", "replay", "get", "set", "rig")


def run(*words: str) -> Result:
    return CliRunner().invoke(app, ["can", *words], env={"COLUMNS": "200", "TERM": "dumb"})


def output_of(*words: str) -> str:
    result = run(*words)
    assert result.exit_code == 0, result.output
    return re.sub(r"\x1b\[[0-9;]*m", "", result.output)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_teaches(command: str) -> None:
    text = output_of(command, "--help")
    assert "Example: sms can" in " ".join(text.split()) or "sms can" in text
    for option in ("--interface", "--channel", "--bitrate"):
        assert option in text


def test_get_reads_from_the_rig_that_comes_with_a_virtual_bus() -> None:
    text = output_of("get", "position_gain", "level_height")
    assert "position_gain = 40 V/m\nlevel_height = 0.5 m\n" in text


def test_get_of_an_unknown_name_says_the_nearest_few_and_how_to_list_all() -> None:
    with pytest.raises(InputError) as caught:
        CliRunner().invoke(app, ["can", "get", "position_gain", "leak"], catch_exceptions=False)
    text = str(caught.value)
    assert "no parameter 'leak'" in text
    assert "valve_leakage" in text
    assert "`sms can get` without a name lists all" in text
    assert len(text) < 300


def test_set_checks_before_it_sends() -> None:
    for setting, said in (("position_gian=1", "did you mean"), ("level_height=99", "outside")):
        with pytest.raises(InputError, match=said):
            CliRunner().invoke(app, ["can", "set", setting], catch_exceptions=False)


def test_set_writes() -> None:
    assert "position_gain = 20\n" in output_of("set", "position_gain=20", "--disable")


def test_monitor_shows_names_values_and_units() -> None:
    text = output_of("monitor", "--seconds", "0.7")
    for word in (
        "mode disabled",
        "enable switch closed",
        "extension_1",
        "mm",
        "chamber_pressure_lower_3",
        "kPa",
        "commands: open to whoever is on this bus",
    ):
        assert word in text


def test_monitor_shows_a_recording(tmp_path: Path) -> None:
    log = tmp_path / "run.blf"
    output_of("record", str(log), "--seconds", "0.5")
    text = output_of("monitor", "--log", str(log), "--speed", "0")
    assert "mode disabled" in text
    assert "extension_1" in text


def test_a_recording_is_a_record(tmp_path: Path) -> None:
    log = tmp_path / "run.blf"
    text = output_of("record", str(log), "--seconds", "1.0")
    assert f"written: {log}" in text
    table = read_can_log(log, load_dbc(), {"extension_1": False, "valve_command_2": False})
    time, _ = table.numbers(0)
    # The controller's own clock: steps of 10 ms to the bit of its 1 ms resolution, whatever the computer did.
    np.testing.assert_allclose(np.diff(time), 0.01, atol=1e-9)
    assert table.names == ("time [s]", "extension_1 [m]", "valve_command_2 [V]")
    assert np.all(np.abs(table.numbers(2)[0] - 5.0) < 0.02)

    csv = tmp_path / "run.csv"
    assert f"written: {csv}" in output_of("table", str(log), "--out", str(csv))
    whole, written = read_table(log, "comma", None), read_table(csv, "comma", None)
    assert {"roll [rad]", "Setpoint.extension_setpoint_1 [m]", "supply_pressure [Pa]"} < set(
        whole.names
    )
    assert whole.names == written.names
    for column in range(len(whole.names)):
        np.testing.assert_array_equal(whole.numbers(column)[0], written.numbers(column)[0])


def test_a_recording_that_is_ended_is_whole(tmp_path: Path) -> None:
    log = tmp_path / "run.blf"
    command = [sys.executable, "-m", "sms.cli", "can", "record", str(log)]
    with subprocess.Popen(command, stderr=subprocess.PIPE) as process:
        assert process.stderr is not None
        assert b"virtual rig" in process.stderr.readline()
        deadline = time.monotonic() + 30.0
        while not list(tmp_path.glob(".run.*")) and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)
        assert process.wait(30.0) == 0
    assert [file.name for file in tmp_path.iterdir()] == ["run.blf"]
    assert sum(1 for _ in read_frames(log)) > 50


def test_what_cannot_be_replayed_is_said(tmp_path: Path) -> None:
    for name, said in (("absent.blf", "no such log"), ("run.xyz", "not a CAN log")):
        with pytest.raises(InputError, match=said):
            CliRunner().invoke(app, ["can", "replay", str(tmp_path / name)], catch_exceptions=False)


def test_drive_refuses_before_anything_moves(tmp_path: Path) -> None:
    motion = tmp_path / "motion.csv"
    motion.write_text("time [s],roll [deg]\n0,0\n1,25\n")
    with pytest.raises(InputError, match="leaves the workspace"):
        CliRunner().invoke(app, ["can", "drive", str(motion)], catch_exceptions=False)


def test_a_rig_on_a_virtual_bus_would_be_alone() -> None:
    with pytest.raises(InputError, match="ends at this process"):
        CliRunner().invoke(app, ["can", "rig", "--interface", "virtual"], catch_exceptions=False)


def test_rig_lists_its_faults() -> None:
    text = output_of("rig", "--faults")
    assert "sensor_stuck" in text
    assert "frames_lost" in text


def test_no_rig_on_the_bus_is_exit_code_1() -> None:
    pytest.importorskip("msgpack", reason="the bus over UDP needs the extra sms[can]")
    result = run("get", "stroke", "--interface", "udp_multicast", "--channel", "239.74.163.2:43199")
    assert result.exit_code == 1
    assert "no rig answers" in result.output
