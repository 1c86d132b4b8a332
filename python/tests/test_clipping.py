"""Readings as a converter and the end of a sensor's range leave them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray
from plant_support import write_bench
from sms import _core
from sms.diagnosis import diagnose
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.fitting import fit
from sms.diagnosis.hypothesis import baseline_hypothesis
from sms.diagnosis.preparation import make_data
from sms.io import InputError, load_rig
from sms.io.check import check_record
from sms.io.clipping import clipped_of, stuck_at_extremes
from sms.io.records import load_record

Array = NDArray[np.float64]
PRESSURE = "chamber_pressure_lower"
COLUMN = f"{PRESSURE} [Pa]"
pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


def source_of(path: Path, signal: str, text: str) -> Path:
    """The rig file with another line for a signal."""
    lines = path.read_text().splitlines()
    lines = [f"{signal} = {text}" if line.startswith(f"{signal} =") else line for line in lines]
    path.write_text("\n".join(lines) + "\n")
    return path


def change(folder: Path, number: int, column: str, values: Array) -> None:
    file = folder / f"run{number}.csv"
    pd.read_csv(file).assign(**{column: values}).to_csv(file, index=False)


def column(folder: Path, number: int, name: str = COLUMN) -> Array:
    return np.asarray(pd.read_csv(folder / f"run{number}.csv")[name], dtype=np.float64)


# ---- rounding ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scale", "rounding", "bias"), [
    (1.0, "down", 0.0), (-1.0, "down", 0.0), (1.0, "nearest", -0.5), (-1.0, "nearest", 0.5),
])  # fmt: skip
def test_a_reading_that_was_rounded_down_is_half_a_step_higher(
    tmp_path: Path, scale: float, rounding: str, bias: float
) -> None:
    """bias: of the mean, in steps, on a record whose converter does round down."""
    path = write_bench(tmp_path, 7, {})
    step, name = 1e-3, "extension [m]"
    truth = column(tmp_path, 0, name)
    change(tmp_path, 0, name, np.floor(scale * truth / step) * step)
    text = f'{{ scale = {scale}, noise = "0.07 mm", resolution = "1 mm", rounding = "{rounding}" }}'
    rig = load_rig(source_of(path, "extension", text))
    read = load_record(rig, rig.records[0]).signals["extension"]
    assert np.mean(read - truth) / step == pytest.approx(bias, abs=0.1)
    assert np.std(read - truth) == pytest.approx(step / np.sqrt(12.0), rel=0.1)
    other = load_record(rig, rig.records[0]).signals[PRESSURE]
    assert np.array_equal(other, column(tmp_path, 0))


def test_a_shift_of_half_a_step_is_no_zero_error_where_it_is_declared(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 8, {})
    step = 8e3  # Pa
    for number in range(4):
        for name in (COLUMN, "chamber_pressure_upper [Pa]"):
            change(tmp_path, number, name, np.floor(column(tmp_path, number, name) / step) * step)
    left = []
    for rounding in ("nearest", "down"):
        for signal in (PRESSURE, "chamber_pressure_upper"):
            text = f'{{ noise = "300 Pa", resolution = "8 kPa", rounding = "{rounding}" }}'
            source_of(path, signal, text)
        rig = load_rig(path)
        data = make_data(rig, [load_record(rig, s) for s in rig.records])
        left.append(float(np.mean(data.validate.problem.errors(rig.start()) ** 2)))
    assert left[1] < 0.7 * left[0]


def test_rounding_needs_a_step(tmp_path: Path) -> None:
    path = source_of(write_bench(tmp_path, 7, {}), "extension", '{ rounding = "down" }')
    with pytest.raises(InputError, match="rounding needs a step; write resolution too"):
        load_rig(path)


# ---- the end of a range --------------------------------------------------------------------------


def test_only_what_repeats_to_the_digit_at_its_extreme_looks_clipped() -> None:
    random = np.random.default_rng(3)
    wave = np.sin(0.02 * np.arange(2000)) + random.normal(0.0, 0.01, 2000)
    assert not stuck_at_extremes(wave).any()
    clipped = np.minimum(wave, 0.9)
    assert np.array_equal(stuck_at_extremes(clipped), clipped == 0.9)
    for step in (0.005, 0.02, 0.05):  # a converter of few steps repeats everywhere
        assert not stuck_at_extremes(np.round(wave / step) * step).any()
        coarse = np.round(np.clip(wave, -0.5, np.inf) / step) * step
        assert np.array_equal(stuck_at_extremes(coarse), coarse == coarse.min())


LEAKING = 6e-9
"""kg/(s Pa)"""


def clipped_bench(folder: Path, declared: bool) -> Path:
    """A bench that leaks past its piston, whose pressure sensor ends at 3.4 bar."""
    path = write_bench(folder, 2, {"piston_leakage": LEAKING})
    for number in range(4):
        change(folder, number, COLUMN, np.minimum(column(folder, number), 3.4e5))
    if declared:
        source_of(path, PRESSURE, '{ noise = "300 Pa", range = ["0 bar", "3.4 bar"] }')
    return path


@pytest.mark.parametrize("declared", [True, False])
def test_clipped_readings_are_compared_with_nothing(tmp_path: Path, declared: bool) -> None:
    """And the leak is there with its size in the others."""
    rig = load_rig(clipped_bench(tmp_path, declared))
    records = [load_record(rig, s) for s in rig.records]
    clipped = [clipped_of(rig, r.signals) for r in records]
    assert any(clipped)
    data = make_data(rig, records)
    kept = 0
    for runs, part in ((data.identify, clipped[:2]), (data.validate, clipped[2:])):
        windows = runs.problem.windows
        for w in windows:
            where = part[w.record].get(PRESSURE)
            assert where is None or where[w.first : w.first + w.samples].mean() <= 0.5
        kept += len(windows)
        at_end = np.zeros(runs.problem.rows, dtype=np.bool_)
        for number, of_record in enumerate(part):
            if PRESSURE in of_record:
                rows = (runs.record == number) & (runs.channel == runs.channels.index(PRESSURE))
                at_end[rows] = of_record[PRESSURE][runs.sample[rows]]
        assert not runs.problem.errors(rig.start())[at_end].any()
        residual, jacobian = runs.problem.evaluate(rig.start(), ["moving_mass"])
        assert len(residual) == len(jacobian) == runs.problem.rows == sum(w.rows for w in windows)
        assert runs.problem.rows == len(runs.channel) == len(runs.record)
        for k in range(len(windows)):  # a window by itself is that window
            (alone,) = runs.excerpt([k]).problem.windows
            assert abs(alone.samples - windows[k].samples) <= 1
    assert kept > 8
    effects = effects_of(rig)
    (leak,) = (effect for effect in effects if effect.key == "piston_leakage")
    leaking = baseline_hypothesis(data, effects).with_effect(leak, leak.plausible_range(0.0))
    found = fit(leaking, data.identify)
    assert found.params["piston_leakage"] == pytest.approx(LEAKING, rel=0.1)


@pytest.mark.full
@pytest.mark.parametrize("declared", [True, False])
def test_a_leak_is_named_on_clipped_records(tmp_path: Path, declared: bool) -> None:
    path = clipped_bench(tmp_path, declared)
    rig = load_rig(path)
    clipped = [clipped_of(rig, load_record(rig, s).signals) for s in rig.records]
    answer = diagnose(path)
    assert [f.severity for f in answer.findings] == ["warning"] * sum(map(bool, clipped))
    assert all("the end of its range" in f.message for f in answer.findings)
    assert answer.verdict in ("cause", "class")
    assert "piston_leakage" in answer.causes[0].members
    found = answer.causes[0].parameters[0]
    if answer.causes[0].effect == "piston_leakage":
        assert found.value == pytest.approx(
            LEAKING, abs=max(3.0 * found.standard_error, 0.1 * LEAKING)
        )


def test_a_record_that_is_clipped_in_every_window_is_a_data_fault(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 4, {})
    change(tmp_path, 2, COLUMN, np.minimum(column(tmp_path, 2), 2.9e5))
    source_of(path, PRESSURE, '{ noise = "300 Pa", range = ["0 bar", "2.9 bar"] }')
    answer = diagnose(path)
    assert answer.verdict == "data-fault"
    assert "end of its range" in answer.sentence


@pytest.mark.parametrize(("signal", "text", "sentence"), [
    (PRESSURE, '{ range = ["3 bar", "1 bar"] }', "3 bar to 1 bar is upside down"),
    (PRESSURE, '{ range = ["3 bar"] }', r"two readings, \[smallest, largest\]"),
    (PRESSURE, '{ range = ["3 mm", "4 mm"] }', "the unit 'mm' does not fit"),
    ("valve_command", '{ range = ["0 V", "10 V"] }', "only a sensor has a range"),
])  # fmt: skip
def test_a_range_that_is_none_is_refused(
    tmp_path: Path, signal: str, text: str, sentence: str
) -> None:
    path = source_of(write_bench(tmp_path, 7, {}), signal, text)
    with pytest.raises(InputError, match=sentence):
        load_rig(path)


def test_a_floor_that_the_parameters_declare_is_no_clipping(tmp_path: Path) -> None:
    time = np.arange(0.0, 4.0, 0.01)
    pressure = 86e3 + 2e5 * np.exp(-3.0 * time) + np.random.default_rng(1).normal(0.0, 300.0, 400)
    signals = {"time": time, "tank_pressure": np.maximum(pressure, 96e3)}
    text = '[rig]\nkind = "tank"\n[signals]\ntime = "t"\nvalve_command = "u"\n'
    text += 'tank_pressure = { noise = "300 Pa" }\n'
    record = '[[records]]\nfile = "run.csv"\nrole = "identify"\n'
    (tmp_path / "run.csv").touch()
    for declared, count in (("", 1), ('[parameters]\ntank_pressure_floor = "96 kPa"\n', 0)):
        (tmp_path / "rig.toml").write_text(text + declared + record)
        assert len(clipped_of(load_rig(tmp_path / "rig.toml"), signals)) == count


def test_a_healthy_record_has_no_clipped_reading(tmp_path: Path) -> None:
    rig = load_rig(write_bench(tmp_path, 9, {}))
    for source in rig.records:
        record = load_record(rig, source)
        assert not clipped_of(rig, record.signals)
        assert not check_record(rig, record)
