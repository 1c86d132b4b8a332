"""`sms watch`: its help, what it refuses, and a bench that begins to leak."""

from __future__ import annotations

import json
import re
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from plant_support import write_bench
from sms import _core
from sms.cli import app
from sms.errors import InputError
from sms.watch import healthy
from typer.testing import CliRunner, Result

from validation.twins import effects
from validation.twins.draw import draw_trial, write_trial
from validation.twins.rig_file import write_record
from validation.twins.traffic import Change, traffic

needs_fits = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


def run(*words: str) -> Result:
    terminal = {"COLUMNS": "200", "TERM": "dumb"}
    return CliRunner().invoke(app, ["watch", *words], env=terminal, catch_exceptions=False)


def test_help_teaches() -> None:
    text = " ".join(re.sub(r"\x1b\[[0-9;]*m", "", run("--help").output).split())
    for word in (
        "--play",
        "--follow",
        "--interface",
        "--learn",
        "--false-alarms-per-day",
        "--page",
    ):
        assert word in text
    assert "sms watch rig.toml --play day.csv" in text


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_bench(tmp_path_factory.mktemp("bench"), 3, {})


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "nothing is watched"),
        (("--play", "a.csv", "--follow", "b.csv"), "one stream"),
        (("--play", "gone.csv"), "no such file"),
        (("--follow", "gone.csv"), "start the logger first"),
        (("--interface", "socketcn"), "no CAN interface"),
        (("--play", "a.csv", "--alarm-frame", "0x1F0"), "on which bus"),
        (("--play", "a.csv", "--interface", "virtual", "--alarm-frame", "x"), "no identifier"),
        (("--play", "a.csv", "--learn", "10"), "--learn 10"),
        (("--play", "a.csv", "--false-alarms-per-day", "0"), "more than 0"),
        (("--play", "a.csv", "--diagnose-after", "5"), "--diagnose-after 5"),
        (("--play", "a.csv", "--keep", "-1"), "--keep -1"),
        (("--play", "a.csv", "--on-alarm", "no_such_program now"), "no program 'no_such_program'"),
        (("--play", "a.csv", "--page", "8765"), "ADDRESS:PORT"),
        (("--play", "a.csv", "--speed", "-2"), "backwards"),
    ],
)
def test_what_cannot_be_is_one_sentence_and_nothing_is_written(
    words: tuple[str, ...], said: str, bench: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with pytest.raises(InputError, match=re.escape(said)) as caught:
        run(str(bench), *words, "--out", str(out), "--quiet")
    assert "\n" not in str(caught.value)
    assert not out.exists()


def test_a_stream_that_ends_before_the_machine_is_learned_is_said(
    bench: Path, tmp_path: Path
) -> None:
    """And what came in until then is kept: of a bus it is all that there is."""
    record = next(bench.parent.glob("*.csv"))
    said = run(str(bench), "--play", str(record), "--out", str(tmp_path), "--quiet")
    assert said.exit_code == 1
    assert said.stderr.startswith("sms: the stream ended after 0 s")
    assert (tmp_path / "events.jsonl").exists()


# ---- a bench of another simulator ------------------------------------------------------------------

LEARN, WELL = 150.0, 40.0
SHORT = 120.0
"""s: the least that a healthy machine is learned from."""
LEAK = 7e-10
"""kg/(s Pa), of the lower chamber: three times the detection limit of the blind trials."""


def day_of(folder: Path, learn: float, ill: float) -> Path:
    """rig.toml of an imperfect bench, well.csv of it, and ill.csv, at whose end it leaks for so long."""
    onset = learn + WELL
    trial = draw_trial("bench", 2, "none", 3.0, 2.0)
    write_trial(trial, folder, folder.parent / "sealed" / "truth.json")
    leak = effects.find("bench", "fitting_leakage:lower")[0].hidden_in(trial.truth, LEAK)
    whole = list(traffic(trial, onset + ill, 5, (Change(onset, leak),)))
    columns = {n: np.concatenate([piece[n] for piece in whole]) for n in whole[0]}
    well = columns["time"] < onset
    write_record(folder / "well.csv", {n: v[well] for n, v in columns.items()})
    write_record(folder / "ill.csv", columns)
    return folder


@pytest.fixture(scope="module")
def day(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return day_of(tmp_path_factory.mktemp("day"), LEARN, 60.0)


def events(out: Path, event: str) -> list[dict[str, Any]]:
    lines = (out / "events.jsonl").read_text().splitlines()
    return [e for e in map(json.loads, lines) if e["event"] == event]


@needs_fits
def test_a_bench_that_begins_to_leak_is_alarmed_and_not_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(healthy, "FIT_LENGTH", 30.0)  # s; half of it, half as long a fit
    day = day_of(tmp_path / "day", SHORT, 40.0)
    out, told = tmp_path / "out", tmp_path / "told.json"
    keep = "import sys, pathlib; pathlib.Path(sys.argv[1]).write_text(sys.argv[2])"
    result = run(
        *(str(day / "rig.toml"), "--play", str(day / "ill.csv"), "--learn", str(SHORT)),
        *("--diagnose-after", "0", "--out", str(out), "--quiet"),
        *("--on-alarm", f"{sys.executable} -c '{keep}' {told}"),
    )
    assert result.exit_code == 0, result.output
    (learned,) = events(out, "learned")
    assert learned["segments"] == SHORT / 5.0
    (alarm,) = events(out, "alarm")
    onset = SHORT + WELL
    assert onset < alarm["raised_s"] <= onset + 60.0
    assert abs(alarm["since_s"] - onset) <= 10.0
    best = alarm["guesses"][0]
    assert best["effect"] == "fitting_leakage of lower"
    assert best["interval"][0] > 0.0
    assert best["size"] == pytest.approx(LEAK, rel=0.35)  # to first order, of four segments
    assert "external leakage of the lower chamber" in result.output
    assert (out / "rows" / "rows_000001.csv.gz").is_file()
    for _ in range(100):
        if told.is_file() and told.stat().st_size:
            break
        time.sleep(0.1)
    assert json.loads(told.read_text())["alarm"] == 1


@needs_fits
@pytest.mark.full
def test_a_healthy_bench_raises_no_alarm_and_a_leak_is_diagnosed(day: Path, tmp_path: Path) -> None:
    words = (str(day / "rig.toml"), "--learn", str(LEARN), "--quiet", "--keep", "0")
    well = run(*words, "--play", str(day / "well.csv"), "--out", str(tmp_path / "well"))
    assert "no alarms" in well.output
    assert not events(tmp_path / "well", "alarm")
    ill = ("--play", str(day / "ill.csv"), "--diagnose-after", "30", "--out", str(tmp_path / "ill"))
    run(*words, *ill)
    (verdict,) = events(tmp_path / "ill", "diagnosed")
    assert verdict["causes"] == ["fitting_leakage of lower"]
    assert not (tmp_path / "ill" / "rows").exists()
