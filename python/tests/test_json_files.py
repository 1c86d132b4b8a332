"""Every JSON file says what it is, in which version of its format, and from which files it was made."""

from __future__ import annotations

import ast
import hashlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sms import __version__, schemas
from sms.cli import main
from sms.diagnosis.pipeline import blank_answer
from sms.diagnosis.result import as_json
from sms.io import load_rig, write_table
from sms.io.json_files import (
    SCHEMA_VERSIONS,
    from_json_line,
    input_hashes,
    json_line,
    json_text,
)
from sms.validation import FIGURES, rows_to_json

ROOT = Path(__file__).parents[2]
ELSEWHERE = {
    "python/sms/io/json_files.py": "the one place",
    "python/sms/demo/sealed.py": "the truth under a seal, whose bytes are hashed",
    "python/sms/report/page.py": "data inside a page",
    "python/sms/schemas/__init__.py": "a JSON schema, which says by $schema what it is",
    "python/sms/sweep/plan.py": "a digest",
    "python/sms/watch/page.py": "frames to a page",
    "validation/fuzz/mutated_text.py": "what is spoilt on purpose",
}


def serialisers(file: Path) -> list[int]:
    """The lines on which a file makes JSON by itself."""
    return [
        node.lineno
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute)
        and node.attr in ("dump", "dumps")
        and isinstance(node.value, ast.Name)
        and node.value.id == "json"
    ]


def sha256(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def printed(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> dict[str, Any]:
    """What a command prints with --json."""
    monkeypatch.setattr("sys.argv", ["sms", *words, "--json"])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    return found


def test_json_is_made_in_one_place() -> None:
    package = list((ROOT / "python" / "sms").rglob("*.py"))
    offering = [f for f in (ROOT / "validation").rglob("*.py") if '"--json"' in f.read_text()]
    assert len(offering) > 3
    made = {
        file.relative_to(ROOT).as_posix()
        for file in [*package, *offering]
        if serialisers(file) and "tests" not in file.parts
    }
    assert made == ELSEWHERE.keys()


def test_the_head_of_a_file_and_no_nan(tmp_path: Path) -> None:
    read = tmp_path / "record.csv"
    read.write_text("time [s]\n0\n")
    text = json_text("noise", {"rms": math.nan, "values": np.arange(2.0)}, [read, read])
    found = json.loads(text, parse_constant=pytest.fail)
    assert list(found)[:4] == ["schema", "schema_version", "versions", "inputs"]
    assert (found["schema"], found["schema_version"]) == ("sms.noise", SCHEMA_VERSIONS["noise"])
    assert found["versions"]["sms"] == __version__
    assert found["inputs"] == {"record.csv": sha256(read)}
    assert found["rms"] is None and found["values"] == [0.0, 1.0]
    with pytest.raises(KeyError):
        json_text("nothing", {})


def test_files_of_one_name_are_told_apart_by_their_folder(tmp_path: Path) -> None:
    files = [tmp_path / folder / "run.csv" for folder in ("a", "b")]
    for file in files:
        file.parent.mkdir()
        file.write_text(file.parent.name)
    assert input_hashes(files) == {f"{f.parent.name}/run.csv": sha256(f) for f in files}
    assert input_hashes([tmp_path / "not there"]) == {}


def test_lines_carry_the_version_and_are_read_with_and_without() -> None:
    line = json_line("trials", {"seed": 3})
    assert json.loads(line)["schema_version"] == SCHEMA_VERSIONS["trials"]
    assert from_json_line(line) == from_json_line('{"seed": 3}') == {"seed": 3}
    with pytest.raises(ValueError, match="not an object"):
        from_json_line("[1]")


def test_a_diagnosis_names_every_file_it_read(tmp_path: Path) -> None:
    record = tmp_path / "run.csv"
    time = 0.01 * np.arange(50)
    names = ("time [s]", "extension [m]", "rod_force [N]", "chamber_pressure [Pa]")
    write_table(record, {name: time for name in names})
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text(
        '[rig]\nkind = "cylinder"\n[signals]\ntime = "time [s]"\nextension = "extension [m]"\n'
        'rod_force = "rod_force [N]"\nchamber_pressure_lower = "chamber_pressure [Pa]"\n'
        '[[records]]\nfile = "run.csv"\nrole = "identify"\n'
    )
    found = json.loads(as_json(blank_answer(load_rig(rig_file), [], (), seed=7)))
    assert found["schema"] == "sms.diagnosis" and found["seed"] == 7
    assert found["inputs"] == {"rig.toml": sha256(rig_file), "run.csv": sha256(record)}


@pytest.mark.parametrize(
    ("words", "schema"),
    [
        (["ik", "--roll", "1", "--pitch", "0", "--height", "0.5", "--deg"], "inverse_kinematics"),
        (["fk", "--extension", "0.2", "0.2", "0.2"], "forward_kinematics"),
    ],
)
def test_what_reads_no_file_names_none(
    words: list[str],
    schema: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    found = printed(words, monkeypatch, capsys)
    assert found["schema"] == f"sms.{schema}" and found["schema_version"] == SCHEMA_VERSIONS[schema]
    assert "inputs" not in found


def test_commands_that_read_records_hash_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    time = 0.01 * np.arange(400)
    for name, seed in (("measured", 1), ("simulated", 2)):
        values = np.sin(time) + 0.01 * np.random.default_rng(seed).normal(size=time.size)
        write_table(tmp_path / f"{name}.csv", {"time [s]": time, "extension [m]": values})
    hashes = {f"{n}.csv": sha256(tmp_path / f"{n}.csv") for n in ("measured", "simulated")}
    noise = printed(["noise", "measured.csv"], monkeypatch, capsys)
    assert noise == json.loads((tmp_path / "noise" / "noise.json").read_text())
    assert noise["inputs"] == {"measured.csv": hashes["measured.csv"]}
    compared = printed(["compare", "measured.csv", "simulated.csv"], monkeypatch, capsys)
    assert compared["schema"] == "sms.comparison" and compared["inputs"] == hashes


def test_a_simulation_hashes_its_scenario(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    scenario = tmp_path / "steps.toml"
    scenario.write_text(
        '[scenario]\nplant = "bench"\nduration = "1 s"\n[excitation]\nkind = "sine"\n'
        'axis = "actuators"\namplitude = "10 mm"\nfrequency = "1 Hz"\n'
    )
    found = printed(["simulate", "steps.toml"], monkeypatch, capsys)
    assert found == json.loads((tmp_path / "run" / "run.json").read_text())
    assert found["schema"] == "sms.run" and found["inputs"] == {"steps.toml": sha256(scenario)}


def test_rows_of_the_validation_and_a_json_schema_say_what_they_are() -> None:
    rows = json.loads(rows_to_json([FIGURES["heave_gain"].row(-14.0)]))
    assert rows["schema"] == "sms.validation" and len(rows["rows"]) == 1
    assert "json-schema.org" in json.loads(schemas.shipped("rig"))["$schema"]
