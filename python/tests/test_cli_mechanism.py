"""`sms ik`, `sms fk` and `sms workspace` at the prompt."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sms
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command

IK = ("--roll", "0.05", "--pitch", "-0.02", "--height", "0.5")


def run(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    result = command(*arguments, cwd=cwd)
    assert result.returncode == 0, result.stderr
    return result


HEAD = ("schema", "schema_version", "versions")


def test_ik_prints_what_python_computes(tmp_path: Path) -> None:
    values = json.loads(run("ik", *IK, "--json", cwd=tmp_path).stdout)
    found = sms.inverse_kinematics(0.05, -0.02, 0.5)
    assert list(values) == [
        *HEAD,
        "extension_m",
        "yaw_rad",
        "x_m",
        "y_m",
        "iterations",
        "residual_m",
    ]
    assert values["extension_m"] == list(found.extension)
    assert (values["yaw_rad"], values["x_m"], values["y_m"]) == (found.yaw, found.x, found.y)
    assert values["iterations"] == found.iterations and values["residual_m"] < 1e-14
    text = run("ik", *IK, cwd=tmp_path).stdout
    assert f"{1e3 * found.extension[0]:.4f}" in text and "stroke 0 to 400 mm" in text


def test_ik_takes_degrees(tmp_path: Path) -> None:
    degrees = ("--roll", "5", "--pitch", "-2", "--height", "0.5", "--deg", "--json")
    values = json.loads(run("ik", *degrees, cwd=tmp_path).stdout)
    found = sms.inverse_kinematics(np.radians(5.0), np.radians(-2.0), 0.5)
    assert values["extension_m"] == pytest.approx(list(found.extension), abs=1e-15)


def test_fk_prints_what_python_computes(tmp_path: Path) -> None:
    extension = ("fk", "--extension", "0.2", "0.21", "0.19")
    values = json.loads(run(*extension, "--json", cwd=tmp_path).stdout)
    found = sms.forward_kinematics([0.2, 0.21, 0.19])
    assert list(values) == [
        *HEAD,
        *("roll_rad", "pitch_rad", "height_m", "yaw_rad", "x_m", "y_m"),
        *("iterations", "residual_m"),
    ]
    assert (values["roll_rad"], values["height_m"]) == (found.roll, found.height)
    assert f"{np.degrees(found.roll):.5f}°" in run(*extension, cwd=tmp_path).stdout


def test_a_pose_outside_the_stroke_is_computed_with_a_warning(tmp_path: Path) -> None:
    result = run("ik", "--roll", "0", "--pitch", "0", "--height", "0.8", "--json", cwd=tmp_path)
    assert json.loads(result.stdout)["extension_m"][0] > 0.4
    assert "extension 1 = 0.5" in result.stderr and "cannot reach this pose" in result.stderr


def test_a_parameter_can_be_set(tmp_path: Path) -> None:
    one = ("fk", "--extension", "0", "0", "0", "--json")
    moved = run(*one, "--set", "reference_point_z=-0.5", cwd=tmp_path)
    assert json.loads(moved.stdout)["height_m"] == pytest.approx(0.5, abs=1e-14)


def test_workspace_writes_a_page_and_says_what_fits(tmp_path: Path) -> None:
    result = run("workspace", "--out", "here", cwd=tmp_path)
    assert "±8° roll with ±4° pitch (required, Table 2.1) fits at no height" in result.stdout
    assert "fits from 0.491 to 0.506 m" in result.stdout
    assert sorted(p.name for p in (tmp_path / "here").iterdir()) == [
        "workspace.html",
        "workspace.json",
    ]
    values = json.loads((tmp_path / "here/workspace.json").read_text())
    assert values["boxes"][0]["fits"] is False
    printed = run("workspace", "--json", cwd=tmp_path)
    assert json.loads(printed.stdout) == values
    assert (tmp_path / "workspace/workspace.html").is_file()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("ik", "--roll", "5", "--pitch", "0", "--height", "0.5"), ("5 rad (286.5°)", "±34.4°")),
        (("ik", "--roll", "nan", "--pitch", "0", "--height", "0.5"), ("roll = nan", "finite")),
        (("ik", "--roll", "0", "--pitch", "0", "--height", "9"), ("height = 9 m", "0.693 m")),
        (("fk", "--extension", "0", "0", "-3"), ("extension 3 = -3 m", "0 to 0.4 m")),
        (("fk", "--extension", "0", "0", "inf"), ("extension 3 = inf m", "finite")),
        (("fk", "--extension", "0", "0", "0", "--set", "payload=3"), ("payload_mass",)),
        (("fk", "--extension", "0", "0", "0", "--set", "stroke=-1"), ("stroke = -1 m",)),
        (("fk", "--extension", "0", "0", "0", "--set", "stroke=1 ft"), ("not a number in m",)),
        (("fk", "--extension", "0", "0", "0", "--set", "stroke"), ("NAME=VALUE",)),
        (("workspace", "--set", "stroke=3"), ("no workspace",)),
        (("workspace", "--out", "/dev/null/x"), ("/dev/null/x", "cannot be written")),
    ],
)
def test_bad_input_is_one_sentence(
    arguments: tuple[str, ...], words: tuple[str, ...], tmp_path: Path
) -> None:
    refused(command(*arguments, cwd=tmp_path), *words)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [("ik", "--roll", "0"), ("fk", "--extension", "1", "2"), ("ik", "--roll", "a")]
)
def test_a_wrong_command_line_ends_with_2(arguments: tuple[str, ...], tmp_path: Path) -> None:
    result = command(*arguments, cwd=tmp_path)
    assert result.returncode == 2 and result.stdout == ""
