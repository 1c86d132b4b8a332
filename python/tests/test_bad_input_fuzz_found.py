"""Bad input that validation/fuzz found an answer missing for: each is one sentence now, or an answer."""

from __future__ import annotations

import gzip
import io
import os
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from io_support import write_rig
from report_support import diagnosis
from rich.console import Console
from sms.cli.command import main
from sms.comparison.metrics import frequency_response
from sms.identification.flow import fit_record
from sms.io import InputError, Record, load_rig, write_extended_rig
from sms.io.can_files import read_frames
from sms.io.plausible import ABSURD, usual_range
from sms.io.schema import ParameterTable
from sms.io.signals import SIGNALS
from sms.io.table_files import read_table
from sms.io.toml_tables import LARGEST_TOML
from sms.io.units import to_si
from sms.report.console import print_diagnosis
from sms.scenario import load_scenario

from validation.trials.identify_flow import declared, one_test


def failure(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *words: str
) -> str:
    """What `sms` says on standard error, with exit code 2."""
    monkeypatch.setattr("sys.argv", ["sms", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    return capsys.readouterr().err.strip()


def test_a_sentence_is_one_line_whatever_it_quotes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = write_rig(tmp_path)
    rig.write_text(rig.read_text().replace('"25 mm"', r'"2\n5\u001b[31m mm"'))
    said = failure(capsys, monkeypatch, "diagnose", str(rig), "--out", str(tmp_path / "out"))
    assert len(said.splitlines()) == 1
    assert r"'5\x1b[31m mm' is not a unit" in said


@pytest.mark.parametrize(("text", "words"), [
    (f"x = {20000 * '['}{20000 * ']'}", "nested hundreds deep"),
    (f"[{20000 * 'a.'}a]", "nested hundreds deep"),
    (f"""{20000 * '"a" . '}a = 1""", "nested hundreds deep"),
    (f"x = {5000 * '9'}", "thousands of digits"),
    ("#" * (LARGEST_TOML + 1), "more than 16 MiB, which no scenario has"),
])  # fmt: skip
def test_a_scenario_that_is_too_much_for_its_reader(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "scenario.toml").write_text(text)
    with pytest.raises(InputError, match=words):
        load_scenario(tmp_path / "scenario.toml")


def test_a_rig_file_without_end() -> None:
    with pytest.raises(InputError, match="more than 16 MiB, which no rig file has"):
        load_rig("/dev/zero")


def test_a_number_beyond_all_units_is_none(tmp_path: Path) -> None:
    (tmp_path / "x.csv").write_text("time [s],x [m]\n0,1e49\n1,1e308\n2,-inf\n")
    values, bad = read_table(tmp_path / "x.csv", "comma", None).numbers(1)
    assert values[0] == 1e49 and np.all(np.isnan(values[1:]))
    assert bad == [(1, "1e+308"), (2, "-inf")]


def test_a_reading_that_no_unit_explains_is_an_error(tmp_path: Path) -> None:
    rig = load_rig(write_rig(tmp_path))
    span = SIGNALS["rod_force"].high - SIGNALS["rod_force"].low
    for force, severity in ((1e7, "warning"), (2.0 * ABSURD * span, "error")):
        signals = {"time": np.arange(3.0), "rod_force": np.array([0.0, force, np.nan])}
        record = Record(
            "run", "identify", Path("run.csv"), signals, frozenset(), (), np.arange(1, 4)
        )
        assert [f.severity for f in usual_range(rig, record)] == [severity]


def test_names_that_look_like_markup_are_printed_as_they_are() -> None:
    evil = "[/red] [bold]"
    d = diagnosis("combination")
    d = replace(d, title=evil, gain=tuple(replace(g, record=evil) for g in d.gain))
    out = io.StringIO()
    print_diagnosis(d, Console(file=out, width=120))
    assert evil in out.getvalue()


def test_flow_records_that_are_no_charge_are_named() -> None:
    record, _ = one_test(1e-3, True, 486e3, np.random.default_rng(1))
    fast = fit_record(replace(record, time=1e-5 * record.time), declared)
    assert fast.found is None and "check the units of time and pressure" in fast.look.faults[0]
    still = fit_record(replace(record, pressure=np.full_like(record.pressure, 86e3)), declared)
    assert still.found is None and "the pressure does not move" in still.look.faults[0]
    wild = record.pressure.copy()
    wild[wild.size // 2] = 2e10
    out_of_range = fit_record(replace(record, pressure=wild), declared)
    assert out_of_range.found is None and "up to 2e+07 kPa" in out_of_range.look.faults[-1]
    one_sample = replace(record, time=record.time[:1], pressure=record.pressure[:1])
    assert "1 samples are too few" in fit_record(one_sample, declared).look.faults[0]


def test_nothing_is_said_beside_the_sentence() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert to_si("1e308 bar", "Pa", "") == np.inf
        assert ParameterTable(value=3).model_dump()["value"] == 3  # type: ignore[arg-type]
        response = frequency_response(np.zeros(64), np.arange(64.0), 0.1)
    assert not np.any(response.coherence)


def test_a_name_that_is_no_text_does_no_harm(tmp_path: Path) -> None:
    rig = write_rig(tmp_path).rename(
        tmp_path / "\udcff.toml"
    )  # the byte 0xff, which UTF-8 does not know
    write_extended_rig(rig, tmp_path / "new.toml", {}, f"Made from {rig.name}.")
    assert (tmp_path / "new.toml").read_text().startswith("# Made from \\udcff.toml.")
    (tmp_path / "x.csv").write_text(
        "time [s],x [m]\n" + "".join(f"{i},{i % 3}\n" for i in range(99))
    )
    result = subprocess.run(
        [sys.executable, "-m", "sms.cli", "noise", "x.csv", "--out", "\udcff"],
        cwd=tmp_path, capture_output=True, check=False, env=os.environ | {"PYTHONIOENCODING": "ascii"},
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    assert b"written: \\udcff/noise.html" in result.stdout


def test_a_frame_whose_time_is_none(tmp_path: Path) -> None:
    log = tmp_path / "run.log"
    log.write_text(f"(1.5) can0 101#00\n({400 * '9'}.5) can0 101#00\n")
    with pytest.raises(InputError, match=r"after frame 2 \(its time is none\)"):
        list(read_frames(log))


def test_a_name_that_is_too_long_for_a_file_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    record = tmp_path / "record.csv"
    record.write_text("time,pressure\n0,1\n")
    for words in (("--out", 300 * "a"), (300 * "b",)):
        said = failure(capsys, monkeypatch, "new", "bench", str(record), *words)
        assert said.endswith("too long for a file's name; choose another")
        assert len(said) < 200


def test_poses_in_a_file_that_was_cut_off_are_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    table = "extension_1 [mm],extension_2 [mm],extension_3 [mm],roll [deg]\n" + 20 * "1,2,3,4\n"
    (tmp_path / "poses.csv.gz").write_bytes(gzip.compress(table.encode())[:-12])
    poses = tmp_path / "poses.toml"
    poses.write_text(
        '[rig]\nname = "cut"\nkind = "poses"\nposes = "poses.csv.gz"\n'
        '[noise]\nextension = "0.1 mm"\nroll = "0.02 deg"\n[tolerances]\njoint = "5 mm"\n'
    )
    said = failure(capsys, monkeypatch, "calibrate", "geometry", str(poses))
    assert "cut-off gzip file" in said
