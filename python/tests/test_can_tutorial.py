"""docs/can_tutorial.md: every command in it runs, in order, in one shell, and shows what the page says it shows."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "can_tutorial.md"
PORTS = {
    "43113": "43213",
    "43114": "43214",
    "43115": "43215",
}  # a rig on the usual bus is left alone


def commands(text: str) -> list[str]:
    """The blocks of shell commands of the page."""
    return re.findall(r"```sh\n(.*?)```", text, re.DOTALL)


@pytest.mark.full
def test_every_command_of_the_tutorial(tmp_path: Path) -> None:
    pytest.importorskip("msgpack", reason="the bus over UDP needs the extra sms[can]")
    # On a slow computer the rigs have ended by themselves before the diagnosis has.
    cleanup = "trap 'kill $(jobs -p) 2>/dev/null || true' EXIT"
    script = f"set -e\n{cleanup}\n" + "\n".join(commands(PAGE.read_text()))
    for usual, own in PORTS.items():
        script = script.replace(usual, own)
    bin_folder = Path(sys.executable).parent
    result = subprocess.run(
        ["bash", "-c", script],
        cwd=tmp_path,
        env=os.environ | {"PATH": f"{bin_folder}:{os.environ['PATH']}", "COLUMNS": "160"},
        capture_output=True,
        text=True,
        timeout=1800,  # most of it is the diagnosis, on a computer that has other work, too
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "mode disabled" in result.stdout
    assert "position_gain = 40" in result.stdout
    assert "commands: open to whoever is on this bus" in result.stdout
    assert "commands: authenticated, the rig has a key" in result.stdout
    assert "refused\n" in result.stdout
    assert result.stdout.count("position_gain = 45") == 2
    assert "position_gain = 50" not in result.stdout
    assert result.stdout.count("set-points, one every 10 ms") == 3
    legs = {
        int(leg): (float(volts), float(pressure))
        for leg, volts, pressure in re.findall(
            r"leg (\d): valve +([+-]\d+) mV, lower chamber +([+-]\d+) kPa", result.stdout
        )
    }
    assert sorted(legs) == [1, 2, 3]
    assert legs[2][0] > 80.0
    assert legs[2][1] < -20.0
    for leg in (1, 3):
        assert abs(legs[leg][0]) < 40.0
        assert abs(legs[leg][1]) < 15.0
    diagnosis = json.loads((tmp_path / "diagnosis" / "diagnosis.json").read_text())
    assert diagnosis["verdict"] == "cause"
    (cause,) = diagnosis["causes"]
    assert [p["name"] for p in cause["parameters"]] == [
        "chamber_leakage_lower:2",
        "chamber_leakage_index_lower:2",
    ]
    assert cause["parameters"][0]["value"] == pytest.approx(2e-9, rel=0.1)


def test_the_page_has_the_commands_it_is_about() -> None:
    text = "\n".join(commands(PAGE.read_text()))
    for command in (
        "can rig",
        "can monitor",
        "can get",
        "can set",
        "can drive",
        "can replay",
        "can table",
        "diagnose",
    ):
        assert f"sms {command}" in text
