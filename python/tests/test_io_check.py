"""The data check: each fault is found with its line and signal, and healthy data is left alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from io_support import AMBIENT, PLAIN_RIG, Array, healthy_signals, write_rig
from sms.io import (
    Finding,
    InputError,
    check_record,
    check_rig,
    load_record,
    load_rig,
    raise_if_unusable,
)

Signals = dict[str, Array]
HEADER_LINES = 2  # the first sample of a written record stands in line 2


def findings_of(
    folder: Path, signals: Signals, data: str = "", old: str = "", new: str = ""
) -> tuple[Finding, ...]:
    """What is found in these signals, with [data] and one replacement in the rig file."""
    text = PLAIN_RIG.replace(old, new) if old else PLAIN_RIG
    rig = load_rig(write_rig(folder, f"[data]\n{data}\n{text}", signals))
    return check_record(rig, load_record(rig, rig.records[0]))


def test_healthy_records_pass_without_a_word(tmp_path: Path) -> None:
    assert findings_of(tmp_path, healthy_signals()) == ()
    assert findings_of(tmp_path, healthy_signals(), 'skip_first = 5\nspeed_above = "4 mm/s"') == ()


def put(signal: str, where: slice | int, value: float) -> Callable[[Signals], None]:
    def change(signals: Signals) -> None:
        signals[signal][where] = value

    return change


def scaled(signal: str, factor: float, offset: float = 0.0) -> Callable[[Signals], None]:
    def change(signals: Signals) -> None:
        signals[signal] = factor * signals[signal] + offset

    return change


def shortened(samples: int) -> Callable[[Signals], None]:
    def change(signals: Signals) -> None:
        for signal in signals:
            signals[signal] = signals[signal][:samples]

    return change


def limited(signal: str, share: float) -> Callable[[Signals], None]:
    def change(signals: Signals) -> None:
        limit = float(np.quantile(signals[signal], share))
        values = signals[signal]
        values[500:560] = np.maximum(values[500:560], limit + 10.0)
        signals[signal] = np.minimum(values, limit)

    return change


def gap(signals: Signals) -> None:
    signals["time"][700:] += 0.3


def swapped(signals: Signals) -> None:
    signals["time"][[700, 701]] = signals["time"][[701, 700]]


@pytest.mark.parametrize(("change", "severity", "line", "signal", "words"), [
    (put("rod_force", 300, np.nan), "error", 302, "rod_force", ["cell is empty", "repair"]),
    (swapped, "error", 703, "time", ["runs backwards", "split the file"]),
    (put("time", slice(700, 702), 7.0), "error", 703, "time", ["stands still"]),
    (gap, "warning", 702, "time", ["a gap of 0.31 s"]),
    (scaled("time", 1000.0), "warning", None, "time", ["median step is 10 s", "unit of time"]),
    (put("rod_force", slice(300, 700), 140.0), "error", 302, "rod_force",
     ["constant for 400 samples (33 %", "check the sensor"]),
    (put("chamber_pressure_lower", slice(300, 700), 4e5), "warning", 302, "chamber_pressure_lower",
     ["constant for 400 samples"]),
    (limited("rod_force", 0.9), "warning", 502, "rod_force", ["sits at its largest value"]),
    (shortened(90), "error", None, None, ["too short", "moving samples", "record more"]),
    (shortened(150), "error", None, None, ["too short", "strokes seen: 1, needed: 2"]),
    (put("chamber_pressure_lower", 400, -5e3), "error", 402, "chamber_pressure_lower",
     ["below vacuum", "gauge = true"]),
    (put("chamber_pressure_lower", 400, 3e4), "warning", 402, "chamber_pressure_lower",
     ["far below ambient"]),
    (scaled("chamber_pressure_lower", 1.0, -AMBIENT), "warning", None, "chamber_pressure_lower",
     ["taken as absolute it misses the rod force by", "gauge = true"]),
    (scaled("rod_force", -1.0), "warning", None, "rod_force", ["opposite", "scale = -1"]),
    (scaled("extension", 1.0, 0.0056), "note", None, "extension", ["outside 0 to 40 mm"]),
    (scaled("extension", 1.0, -0.02), "warning", None, "extension", ["(offset)"]),
    (scaled("extension", 1000.0), "error", None, "extension", ["outside 0 to 40 mm", "unit"]),
])  # fmt: skip
def test_a_fault_is_found(
    tmp_path: Path,
    *,
    change: Callable[[Signals], None],
    severity: str,
    line: int | None,
    signal: str | None,
    words: list[str],
) -> None:
    signals = healthy_signals()
    change(signals)
    found = [
        finding
        for finding in findings_of(tmp_path, signals)
        if all(word in str(finding) for word in words)
    ]
    assert len(found) == 1, findings_of(tmp_path, signals)
    assert (found[0].severity, found[0].signal) == (severity, signal)
    assert str(tmp_path.resolve() / "one.csv") in str(found[0])
    if line is not None:
        assert found[0].line == line


def test_gauge_taken_as_gauge_is_right_and_absolute_taken_as_gauge_is_said(tmp_path: Path) -> None:
    gauge = '[signals]\ntime = "time"\nextension = "extension"\nrod_force = "rod_force"\n'
    gauge += 'chamber_pressure_lower = { column = "chamber_pressure_lower", gauge = true }\n'
    signals = healthy_signals()
    (finding,) = findings_of(tmp_path, signals, "", "[parameters]", gauge + "[parameters]")
    assert "check whether gauge = false" in str(finding)
    signals["chamber_pressure_lower"] -= AMBIENT
    assert findings_of(tmp_path, signals, "", "[parameters]", gauge + "[parameters]") == ()


def test_what_lies_within_skip_first_is_only_noted(tmp_path: Path) -> None:
    signals = healthy_signals()
    signals["time"][5:] += 0.3
    signals["time"][8] = signals["time"][7]
    signals["rod_force"][3] = np.nan
    signals["chamber_pressure_lower"][4] = -1e5
    found = findings_of(tmp_path, signals, "skip_first = 15")
    assert [finding.severity for finding in found] == ["note"] * 3
    assert {finding.line for finding in found} == {5, 7, 10}
    assert all("within skip_first" in finding.remedy for finding in found)


def test_one_pass_shows_everything_errors_first(tmp_path: Path) -> None:
    signals = healthy_signals()
    signals["rod_force"][300] = np.nan
    signals["extension"][310] = np.nan
    gap(signals)
    signals["time"][900] = 0.0
    found = findings_of(tmp_path, signals)
    assert [finding.severity for finding in found] == ["error", "error", "error", "warning"]
    assert [finding.signal for finding in found] == ["rod_force", "extension", "time", "time"]
    with pytest.raises(InputError, match=r"one\.csv, line 302, rod_force.*\(and 2 more errors"):
        raise_if_unusable(found)


def test_many_faults_of_one_kind_are_one_finding_with_a_count(tmp_path: Path) -> None:
    signals = healthy_signals()
    signals["rod_force"][300:310] = np.nan
    (finding,) = findings_of(tmp_path, signals)
    assert "(and 9 more in this column)" in finding.message


def test_warnings_do_not_stop(tmp_path: Path) -> None:
    signals = healthy_signals()
    gap(signals)
    raise_if_unusable(findings_of(tmp_path, signals))


@pytest.mark.parametrize("samples", [1, 2, 11])
def test_a_very_short_record_is_an_error_not_a_crash(tmp_path: Path, samples: int) -> None:
    signals = healthy_signals()
    shortened(samples)(signals)
    for data in ("", "skip_first = 15"):
        found = findings_of(tmp_path, signals, data)
        assert "too short" in found[0].message


@pytest.mark.parametrize("signal", ["extension", "rod_force", "chamber_pressure_lower", "time"])
def test_a_column_of_nothing_is_an_error_not_a_crash(tmp_path: Path, signal: str) -> None:
    signals = healthy_signals()
    signals[signal][:] = np.nan
    found = findings_of(tmp_path, signals)
    assert (found[0].severity, found[0].signal, found[0].line) == ("error", signal, HEADER_LINES)


def test_an_end_stop_is_only_noted(tmp_path: Path) -> None:
    signals = healthy_signals()
    signals["extension"] = np.minimum(signals["extension"], 0.032)
    (finding,) = findings_of(tmp_path, signals)
    assert finding.severity == "note"
    assert "end stop" in finding.remedy


@pytest.mark.parametrize(("records", "words"), [
    (["identify"], ["only one record", "nothing to judge on", "'validate'"]),
    (["validate"], ["only one record", "nothing to fit on", "'identify'"]),
    (["identify", "identify"], ["2 records", "nothing to judge on"]),
    (["validate", "validate"], ["2 records", "nothing to fit on"]),
])  # fmt: skip
def test_records_to_fit_on_and_others_to_judge_on(
    tmp_path: Path, records: list[str], words: list[str]
) -> None:
    text = PLAIN_RIG[: PLAIN_RIG.index("[[records]]")]
    for role, name in zip(records, ("one", "two"), strict=False):
        text += f'[[records]]\nfile = "{name}.csv"\nrole = "{role}"\n'
    rig = load_rig(write_rig(tmp_path, text))
    (finding,) = check_rig(rig)
    assert finding.severity == "error"
    for word in [str(rig.path), "[[records]]", *words]:
        assert word in str(finding)
    assert check_rig(load_rig(write_rig(tmp_path))) == ()


def test_what_a_rig_file_says_in_vain_is_a_warning(tmp_path: Path) -> None:
    text = PLAIN_RIG.replace("[[records]]", '[model]\nfriction = "lugre"\n\n[[records]]', 1)
    rig = load_rig(write_rig(tmp_path, text))
    assert rig.kind == "cylinder"
    (finding,) = check_rig(rig)
    assert finding.severity == "warning"
    assert "[model] friction has no effect on a cylinder" in str(finding)
    noisy = replace(rig.signals["rod_force"], noise=1.0)
    rig = replace(load_rig(write_rig(tmp_path)), signals={**rig.signals, "rod_force": noisy})
    (finding,) = check_rig(rig)
    assert finding.signal == "rod_force" and "stroke to stroke" in finding.message
