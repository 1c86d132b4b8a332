"""`sms ik`, `fk`, `workspace` with --mechanism, and `sms path`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from cli_support import sms as command
from sms.mechanism_file import load_mechanism
from test_cli_diagnose import refused

RPS = load_mechanism("three_rps")
OF = ("--mechanism", "three_rps")


def test_ik_and_fk_print_what_python_computes(tmp_path: Path) -> None:
    done = command("ik", *OF, "--roll", "5", "--pitch", "-2", "--deg", "--json", cwd=tmp_path)
    values = json.loads(done.stdout)
    found = RPS.inverse((*RPS.home[:3], 0.08726646259971647, -0.03490658503988659, 0.0))
    assert values["length_m"] == pytest.approx(list(found.length), abs=1e-14)
    lengths = [word for length in values["length_m"] for word in ("--length", repr(length))]
    back = json.loads(command("fk", *OF, *lengths, "--json", cwd=tmp_path).stdout)
    assert back["roll_rad"] == pytest.approx(0.08726646259971647, abs=1e-13)
    assert back["schema"] == "sms.mechanism_fk"
    text = command("ik", *OF, "--z", "1.4", cwd=tmp_path)
    assert "leg 1" in text.stdout and "is outside 0.8 to 1.3 m" in text.stderr


def test_workspace_says_what_ends_each_coordinate(tmp_path: Path) -> None:
    done = command("workspace", *OF, "--out", "w", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    values = json.loads((tmp_path / "w" / "workspace.json").read_text())
    reach = {
        (r["coordinate"], r["end"] > RPS.home[2 if r["coordinate"] == "z" else 3]): r
        for r in values["reach"]
    }
    # Level, a leg of 1.3 m stands 0.2 m outwards below.
    assert reach["z", True]["end"] == pytest.approx((1.3**2 - 0.2**2) ** 0.5, abs=1e-9)
    assert reach["z", False]["end"] == pytest.approx((0.8**2 - 0.2**2) ** 0.5, abs=1e-9)
    assert "longest" in reach["z", True]["beyond"]
    assert "singular" in reach["pitch", True]["beyond"]


def test_path_finds_the_singular_pose_and_the_leg(tmp_path: Path) -> None:
    (tmp_path / "good.csv").write_text("z [m],roll [deg]\n1,0\n1.05,5\n")
    good = command("path", *OF, "good.csv", cwd=tmp_path)
    assert good.returncode == 0 and "the path can be driven" in good.stdout
    (tmp_path / "bad.csv").write_text("pitch [deg],z [m]\n0,1\n75,1\n0,1.4\n")
    bad = command("path", *OF, "bad.csv", "--json", cwd=tmp_path)
    assert bad.returncode == 1
    values = json.loads(bad.stdout)
    assert values["drivable"] is False
    assert values["singularities"][0]["after_line"] == 2
    assert values["legs_outside_range"][-1]["line"] == 4
    assert "singular" in command("path", *OF, "bad.csv", cwd=tmp_path).stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ik", *OF, "--height", "1"), "--height"),
        (("ik", *OF, "--x", "1"), "it follows from z, roll, pitch"),
        (("ik", "--roll", "0", "--pitch", "0", "--height", "0.5", "--z", "1"), "leave it out"),
        (("ik", "--roll", "0"), "--pitch is missing"),
        (("fk",), "--extension is missing"),
        (("fk", "--length", "1"), "say --mechanism"),
        (("fk", *OF, "--length", "1"), "3 legs are actuated, 1 lengths given"),
        (("fk", *OF, "--length", "1", "--length", "nan", "--length", "1"), "finite"),
        (("workspace", *OF, "--set", "payload_mass=280"), "--set"),
        (("workspace", "--mechanism", "no.toml"), "there is no such mechanism file"),
        (("path", "poses.csv"), "--mechanism"),
        (("path", *OF, "no.csv"), "no such file"),
        (("path", *OF, "other.csv"), "no column is driven"),
        (("path", *OF, "text.csv"), "is not a number"),
        (("path", *OF, "unit.csv"), "the unit is missing"),
    ],
)
def test_bad_input_is_one_sentence(tmp_path: Path, words: tuple[str, ...], said: str) -> None:
    (tmp_path / "other.csv").write_text("a [m],b [m]\n1,1\n")
    (tmp_path / "text.csv").write_text("z [m],roll [deg]\n1,up\n")
    (tmp_path / "unit.csv").write_text("z [m],roll\n1,0\n")
    refused(command(*words, cwd=tmp_path), said)
    assert not (tmp_path / "workspace").exists()
