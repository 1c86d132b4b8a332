"""`sms diagnose` at the prompt: what it writes, and what it says to bad input."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from cli_support import sms, sms_started
from test_diagnosis_cylinder import make_rig


def refused(result: subprocess.CompletedProcess[str], *words: str) -> None:
    """Exit code 2 and one sentence with these words."""
    assert result.returncode == 2, result.stderr
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1, result.stderr
    for word in words:
        assert word in result.stderr


def test_the_command_as_a_user_starts_it(tmp_path: Path) -> None:
    started = sms_started("diagnose", "missing.toml", "--out", "o", cwd=tmp_path)
    refused(started, "missing.toml", "there is no such rig file")
    again = sms("diagnose", "missing.toml", "--out", "o", cwd=tmp_path)
    assert (again.returncode, again.stdout, again.stderr) == (2, "", started.stderr)


def test_a_diagnosis_writes_three_files_and_prints_the_verdict(tmp_path: Path) -> None:
    make_rig(tmp_path, pressure_friction=3e-6)
    result = sms("diagnose", "rig.toml", "--out", "report", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "pressure-dependent seal friction" in result.stdout
    assert sorted(p.name for p in (tmp_path / "report").iterdir()) == [
        "diagnosis.json",
        "extended.toml",
        "report.html",
    ]
    data = json.loads((tmp_path / "report" / "diagnosis.json").read_text())
    assert data["verdict"] == "cause"
    assert data["causes"][0]["effect"] == "pressure_dependent_friction"
    assert {"effect", "members", "block", "parameters"} <= set(data["causes"][0])
    assert {"value", "standard_error", "unit"} <= set(data["causes"][0]["parameters"][0])
    assert {"candidates", "not_testable", "gain", "next_experiment", "versions", "seed"} <= set(
        data
    )
    assert "<script src" not in (tmp_path / "report" / "report.html").read_text()
    again = sms("diagnose", "report/extended.toml", "--json", "--out", "again", cwd=tmp_path)
    assert json.loads(again.stdout)["verdict"] == "no-evidence"


def test_help_teaches_with_an_example(tmp_path: Path) -> None:
    result = sms("diagnose", "--help", cwd=tmp_path)
    assert result.returncode == 0
    for word in ("Example", "report.html", "no-evidence", "--out"):
        assert word in result.stdout


def test_a_misspelt_key_is_met_with_the_right_one(tmp_path: Path) -> None:
    rig = make_rig(tmp_path)
    rig.write_text(rig.read_text().replace("coulomb_force", "coulomb_forse"))
    refused(sms("diagnose", "rig.toml", cwd=tmp_path), "coulomb_forse", "coulomb_force", "rig.toml")


@pytest.mark.parametrize(
    "name, content, words",
    [
        ("missing.toml", None, ("missing.toml",)),
        ("empty.toml", "", ("empty.toml",)),
    ],
)
def test_no_rig_file(
    tmp_path: Path, name: str, content: str | None, words: tuple[str, ...]
) -> None:
    if content is not None:
        (tmp_path / name).write_text(content)
    refused(sms("diagnose", name, cwd=tmp_path), *words)


def test_bad_records_name_file_and_line(tmp_path: Path) -> None:
    rig = make_rig(tmp_path)
    good = (tmp_path / "3_bar.csv").read_text().splitlines()

    def write(lines: list[str]) -> None:
        (tmp_path / "3_bar.csv").write_text("\n".join(lines) + "\n")

    write([*good[:700], good[700].rpartition(",")[0] + ",nan", *good[701:]])
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv", "line 701", "rod_force")
    write([*good[:700], good[300], *good[701:]])
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv", "line 701", "time")
    write([good[0].replace("rod_force [N]", "rod_force [bar]"), *good[1:]])
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv", "rod_force", "N")
    write([good[0].replace("rod_force", "rod_farce"), *good[1:]])
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv", "rod_force")
    write([])
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv")
    write(good[:1])
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv")
    (tmp_path / "3_bar.csv").unlink()
    refused(sms("diagnose", rig.name, cwd=tmp_path), "3_bar.csv")
    assert not (tmp_path / "diagnosis").exists()


def test_an_output_folder_that_cannot_be_written_is_said_before_the_work(tmp_path: Path) -> None:
    rig = make_rig(tmp_path)
    (tmp_path / "taken").write_text("a file")
    refused(sms("diagnose", rig.name, "--out", "taken", cwd=tmp_path), "taken", "not a folder")
    refused(
        sms("diagnose", rig.name, "--out", "taken/below", cwd=tmp_path), "taken", "not a folder"
    )
    assert (tmp_path / "taken").read_text() == "a file"
