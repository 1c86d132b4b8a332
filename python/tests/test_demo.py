"""`sms demo`: what it hides, how it seals it, what it writes, and what it leaves alone."""

from __future__ import annotations

import hashlib
import json
import webbrowser
from pathlib import Path

import numpy as np
import pytest
import typer
from cli_support import sms
from report_support import diagnosis
from rich.console import Console
from sms.cli.demo import hidden_effect, open_page, verdict_of, words_of
from sms.demo import HIDEABLE, Hidden, Sealed, draw_hidden, open_sealed, write_bench
from sms.demo.bench import RUNS, machine_of, streams
from sms.demo.folder import MARKS, SEAL, whole_folder
from sms.demo.hidden import said
from sms.diagnosis.design.detection_limits import published_rig
from sms.errors import InputError
from sms.io import check_record, load_record, load_rig
from sms.parameters import PARAMETERS
from test_cli_diagnose import refused

Rng = np.random.Generator


def rng() -> Rng:
    return np.random.default_rng(5)


# ---- what is hidden ----


@pytest.mark.parametrize("key", HIDEABLE)
def test_the_largest_and_the_smallest_give_records_that_can_be_used(
    key: str, tmp_path: Path
) -> None:
    for value in HIDEABLE[key]:
        hidden = Hidden(key, value)
        low, high = hidden.effect.plausible_range(PARAMETERS[hidden.parameter].default)
        assert low < value <= high
        rig = load_rig(write_bench(tmp_path, hidden, rng(), rng()))
        assert [record.role for record in rig.records] == [role for role, *_ in RUNS]
        for source in rig.records:
            record = load_record(rig, source)
            assert not [f for f in check_record(rig, record) if f.severity == "error"]
            assert np.ptp(record.signals["extension"]) > 0.05


def test_the_same_seed_draws_the_same_and_a_name_keeps_the_place_in_the_range() -> None:
    drawn = draw_hidden(None, streams(3)[0])
    assert drawn == draw_hidden(None, streams(3)[0])
    assert {draw_hidden(None, streams(seed)[0]).key for seed in range(60)} == set(HIDEABLE)
    places = []
    for key, (low, high) in HIDEABLE.items():
        named = draw_hidden(key, streams(3)[0])
        assert named.key == key and low <= named.value <= high
        places.append(np.log(named.value / low) / np.log(high / low))
    assert places == pytest.approx([places[0]] * len(places))
    assert draw_hidden("fitting_leakage", rng()).key.startswith("fitting_leakage:")
    with pytest.raises(InputError, match="did you mean 'moving_mass'"):
        draw_hidden("moving_mas", rng())


def test_the_machine_is_off_within_what_is_declared_and_wrong_in_one_number() -> None:
    rig, hidden = published_rig("bench"), Hidden("moving_mass", 30.0)
    machine = machine_of(rig, hidden, rng())
    off = {
        n
        for n, row in PARAMETERS.items()
        if abs(machine[n] - row.default) > 1.001 * row.uncertainty
    }
    assert off == {"moving_mass"}
    assert machine["mass_flow_gain"] != PARAMETERS["mass_flow_gain"].default
    other = machine_of(rig, Hidden("tube", 5.0), rng())
    same = set(PARAMETERS) - {"moving_mass", "tube_length"}
    assert all(machine[n] == other[n] for n in same)


def test_the_rig_file_says_nothing_of_what_is_hidden(tmp_path: Path) -> None:
    texts = {
        write_bench(tmp_path, Hidden(key, HIDEABLE[key][0]), rng(), rng()).read_text()
        for key in HIDEABLE
    }
    assert len(texts) == 1


def test_a_seal_is_that_of_one_truth() -> None:
    sealed = Sealed.of({"effect": "tube", "value": 5.0}, b"salt")
    assert sealed.sha256 == hashlib.sha256(sealed.content).hexdigest()
    assert sealed.sha256 != Sealed.of({"effect": "tube", "value": 5.0}, b"other").sha256
    assert open_sealed(sealed.content, sealed.sha256 + "\n")["value"] == 5.0
    with pytest.raises(ValueError, match="not the truth that was sealed"):
        open_sealed(sealed.content.replace(b"5.0", b"6.0"), sealed.sha256)


def test_what_is_said_is_held_against_what_was_hidden() -> None:
    one, several, nothing = (diagnosis(v) for v in ("class", "combination", "no-evidence"))
    explanations = ["sensor_gain:rod_force", "sensor_gain:chamber_pressure_lower", "bore_diameter"]
    assert said(one) == [explanations]
    assert said(several) == [explanations, ["pressure_dependent_friction"]]
    assert all(Hidden(key, 1.0).named_by(one) for key in explanations)
    assert not Hidden("tube", 5.0).named_by(one)
    assert not Hidden("sensor_gain:rod_force", 1.0).named_by(several)
    assert said(nothing) == [] and verdict_of(nothing) == "no evidence of a model error"
    assert verdict_of(one).startswith("gain error of the load cell or gauge gain or bore diameter")
    assert words_of(Hidden("piston_leakage", 1e-8)) == "leakage past the piston, 1.00 g/s per bar"


# ---- the folder ----


def test_a_folder_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    out = tmp_path / "new" / "demo"
    with pytest.raises(KeyboardInterrupt), whole_folder(out) as folder:
        (folder / "rig.toml").write_text("")
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []
    for text in ("first", "second"):
        with whole_folder(out) as folder:
            (folder / SEAL).write_text(text)
            (folder / "in").mkdir()
            (folder / "in" / "report.html").write_text(text)
            assert folder.parent == out.parent
    assert (out / SEAL).read_text() == (out / "in" / "report.html").read_text() == "second"
    assert [path.name for path in out.parent.iterdir()] == ["demo"]


def test_a_folder_of_somebody_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "rig.toml").write_text("mine")
    refused(sms("demo", "--out", "mine", cwd=tmp_path), "mine", "choose another --out")
    assert (tmp_path / "mine" / "rig.toml").read_text() == "mine"
    (tmp_path / "file").write_text("")
    refused(sms("demo", "--real", "--out", "file", cwd=tmp_path), "file", "not a folder")


def test_ctrl_c_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("sms.diagnosis.diagnose", interrupted)
    with pytest.raises(typer.Exit) as caught:
        hidden_effect(tmp_path / "demo", 1, "tube", Console(quiet=True))
    assert caught.value.exit_code == 130
    assert list(tmp_path.iterdir()) == []


# ---- the command ----


def test_what_cannot_be_asked_for_is_said(tmp_path: Path) -> None:
    refused(sms("demo", "--real", "--seed", "1", cwd=tmp_path), "--real", "leave --seed")
    refused(sms("demo", "--effect", "magic", cwd=tmp_path), "magic", "moving_mass")
    told = sms("demo", "--help", cwd=tmp_path).stdout
    assert all(key.partition(":")[0] in told for key in HIDEABLE)
    assert list(tmp_path.iterdir()) == []


def test_a_browser_is_opened_on_a_terminal_with_a_screen_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) or True)
    monkeypatch.setattr("sms.cli.demo.sys.platform", "linux")
    for name in ("BROWSER", "WAYLAND_DISPLAY", "DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    page, console = tmp_path / "report.html", Console()
    open_page(page, True, console)
    assert not opened and "no browser here" in capsys.readouterr().out
    monkeypatch.setenv("DISPLAY", ":0")
    open_page(page, None, console)  # standard output is no terminal
    open_page(page, False, console)
    assert not opened
    open_page(page, True, console)
    assert opened == [page.as_uri()]


@pytest.mark.full
@pytest.mark.parametrize("key", HIDEABLE)
def test_what_was_hidden_is_found(key: str, tmp_path: Path) -> None:
    command = ("demo", "--seed", "7", "--effect", key, "--out", "demo", "--json", "told.json")
    result = sms(*command, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    told = json.loads((tmp_path / "told.json").read_text())
    assert told["found"] and told["truth"]["effect"] == key
    first = told["parameters"][0]
    assert abs(first["value"] - told["truth"]["value"]) < 5.0 * first["standard_error"]
    assert result.stdout.index(told["sha256"]) < result.stdout.index("Causes")
    content = (tmp_path / "demo" / "truth.json").read_bytes()
    assert hashlib.sha256(content).hexdigest() == told["sha256"]
    assert (tmp_path / "demo" / SEAL).read_text().split() == [told["sha256"], "truth.json"]
    names = {"rig.toml", "report.html", "diagnosis.json", "extended.toml", "truth.json", SEAL}
    assert names < {path.name for path in (tmp_path / "demo").iterdir()}
    assert load_rig(tmp_path / "demo" / "extended.toml").records
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


@pytest.mark.full
def test_the_real_cylinder_needs_no_data_folder(tmp_path: Path) -> None:
    result = sms("demo", "--real", "--out", "demo", "--json", "told.json", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    told = json.loads((tmp_path / "told.json").read_text())
    assert {rig["verdict"] for rig in told["rigs"].values()} == {"combination"}
    for name, rig in told["rigs"].items():
        assert (tmp_path / rig["report"]).is_file()
        assert load_rig(tmp_path / "demo" / name / "extended.toml").records
    assert (tmp_path / "demo" / MARKS[1]).is_dir()
