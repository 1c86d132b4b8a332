"""Rig files of tank, bench and platform: what is new in them, and the data check of their records."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import sms._core
from numpy.typing import NDArray
from sms.diagnosis.pipeline import read_and_check
from sms.io import InputError, load_rig, write_extended_rig, write_record
from sms.io.check import check_record
from sms.io.declarations import Declaration
from sms.io.records import Record, load_record
from sms.io.signals import KINDS, SIGNAL_UNITS, of_legs, without_leg
from sms.parameters import FLOW_MAP, FRICTION_MAP, LINEARITY, PARAMETERS

Array = NDArray[np.float64]

BENCH = """
[rig]
kind = "bench"

[model]
friction = "stribeck"

[control]
loop = "closed"
controller = "recorded"

[signals]
time = "time"
valve_command = {}
extension = { noise = "0.05 mm", resolution = "0.1 mm" }
chamber_pressure_lower = { noise = "4 mbar" }
chamber_pressure_upper = { noise = "400 Pa" }

[[records]]
file = "one.csv"
role = "identify"
conditions = { moving_mass = "23.6 kg" }

[[records]]
file = "two.csv"
role = "test"
"""


def bench_signals(samples: int = 1200) -> dict[str, Array]:
    time = 0.005 * np.arange(samples)
    noise = np.random.default_rng(1)
    wave = np.sin(2.0 * time)
    return {
        "time": time,
        "valve_command": 5.0 + wave,
        "extension": 0.2 - 0.1 * np.cos(2.0 * time) + noise.normal(0.0, 5e-5, samples),
        "chamber_pressure_lower": 3e5 + 2e4 * wave + noise.normal(0.0, 400.0, samples),
        "chamber_pressure_upper": 2.9e5 - 2e4 * wave + noise.normal(0.0, 400.0, samples),
    }


def bench(folder: Path, text: str = BENCH, **changed: Array) -> Path:
    for name in ("one.csv", "two.csv"):
        write_record(folder / name, bench_signals() | changed)
    (folder / "rig.toml").write_text(text)
    return folder / "rig.toml"


def first_record(path: Path) -> tuple[list[str], Record]:
    rig = load_rig(path)
    record = load_record(rig, rig.records[0])
    return [f"{f.severity} {f.signal}" for f in check_record(rig, record)], record


def test_a_bench_rig_says_its_laws_its_loop_its_noise_and_what_differs_in_a_run(
    tmp_path: Path,
) -> None:
    rig = load_rig(bench(tmp_path))
    assert (rig.kind, rig.model.friction, rig.model.valve) == ("bench", "stribeck", "iso_0_4_mpa")
    assert (rig.control.loop, rig.control.controller) == ("closed", "recorded")
    assert rig.signals["extension"].noise == pytest.approx(5e-5)
    assert rig.signals["extension"].resolution == pytest.approx(1e-4)
    assert rig.signals["chamber_pressure_lower"].noise == pytest.approx(400.0)
    assert rig.signals["valve_command"].noise is None
    assert rig.signals["extension"].column == "extension [m]"
    assert [(r.role, dict(r.conditions)) for r in rig.records] == [
        ("identify", {"moving_mass": 23.6}),
        ("test", {}),
    ]


@pytest.mark.parametrize(
    ("wrong", "right", "sentence"),
    [
        ('"stribeck"', '"strybeck"', "did you mean 'stribeck'"),
        ('"0.05 mm"', '"-1 mm"', "is negative"),
        ('"0.05 mm"', '"5 Pa"', "does not fit"),
        ('"0.05 mm"', '"1e308 m"', "more than what such a sensor reads"),
        ("valve_command = {}", "valve_command = { scale = nan }", "scale: must be a finite number"),
        ('moving_mass = "23.6 kg"', 'moving_maas = "23.6 kg"', "did you mean 'moving_mass'"),
        ('moving_mass = "23.6 kg"', 'moving_mass = "-1 kg"', "outside the allowed range"),
        ('"bench"', '"bank"', "'bank' is not known"),
    ],
)
def test_a_mistake_is_named(tmp_path: Path, wrong: str, right: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        load_rig(bench(tmp_path, BENCH.replace(wrong, right)))


@pytest.mark.parametrize(("key", "names"), [
    ("flow_map_uncertainty", FLOW_MAP),
    ("friction_map_uncertainty", FRICTION_MAP),
    ("sensor_linearity", LINEARITY),
])  # fmt: skip
def test_a_half_width_in_model_is_that_of_all_its_parameters(
    tmp_path: Path, key: str, names: tuple[str, ...]
) -> None:
    def declared(text: str) -> set[float]:
        return {load_rig(bench(tmp_path, text)).declared(n).uncertainty for n in names}

    assert declared(BENCH) == {PARAMETERS[n].uncertainty for n in names}
    assert list(declared(BENCH.replace("[model]", f'[model]\n{key} = "1.5 %"'))) == pytest.approx(
        [0.015]
    )


def test_one_parameter_of_a_map_has_a_half_width_of_its_own(tmp_path: Path) -> None:
    with_map = BENCH.replace("[model]", '[model]\nflow_map_uncertainty = "7 %"')
    one = with_map + "\n[parameters]\nflow_map_feed_lower_2 = { value = 0.1, uncertainty = 0.01 }\n"
    assert load_rig(bench(tmp_path, one)).declared("flow_map_feed_lower_2") == Declaration(
        0.1, 0.01
    )
    assert load_rig(bench(tmp_path, one)).declared(
        "flow_map_feed_lower_3"
    ).uncertainty == pytest.approx(0.07)


@pytest.mark.parametrize(("said", "sentence"), [
    ('"-3 %"', "-3 % is no half width; write 0 to 100 %"),
    ('"200 %"', "200 % is no half width"),
    ('"3 mm"', "the unit 'mm' does not fit"),
])  # fmt: skip
def test_a_half_width_that_is_none_is_refused(tmp_path: Path, said: str, sentence: str) -> None:
    text = BENCH.replace("[model]", f"[model]\nflow_map_uncertainty = {said}")
    with pytest.raises(InputError, match=re.escape(f"[model] flow_map_uncertainty: {sentence}")):
        load_rig(bench(tmp_path, text))
    cylinder = '[rig]\nkind = "cylinder"\n[model]\nflow_map_uncertainty = "3 %"\n'
    with pytest.raises(InputError, match="nothing of a cylinder depends on it"):
        load_rig(bench(tmp_path, cylinder + '[[records]]\nfile = "one.csv"\nrole = "identify"\n'))
    wide = BENCH.replace("[model]", '[model]\nsensor_linearity = "3 %"')
    with pytest.raises(InputError, match="3 % is no half width; write 0 to 2 %"):
        load_rig(bench(tmp_path, wide))


def test_signals_of_the_legs_have_units() -> None:
    assert of_legs("extension") == ("extension_1", "extension_2", "extension_3")
    assert without_leg("chamber_pressure_lower_2") == "chamber_pressure_lower"
    assert without_leg("chamber_pressure_lower") == "chamber_pressure_lower"
    for kind in KINDS.values():
        assert set(kind.signals) <= set(SIGNAL_UNITS)
    assert SIGNAL_UNITS["chamber_pressure_upper_3"] == "Pa"


def test_a_healthy_record_passes(tmp_path: Path) -> None:
    found, _ = first_record(bench(tmp_path))
    assert found == []


def test_a_dead_channel_is_an_error(tmp_path: Path) -> None:
    dead = bench_signals()["chamber_pressure_upper"]
    dead[400:] = dead[400]
    found, _ = first_record(bench(tmp_path, chamber_pressure_upper=dead))
    assert "error chamber_pressure_upper" in found


def test_a_channel_that_clips_through_the_run_is_an_error(tmp_path: Path) -> None:
    clipped = np.minimum(bench_signals()["chamber_pressure_lower"], 3e5)
    found, _ = first_record(bench(tmp_path, chamber_pressure_lower=clipped))
    assert "error chamber_pressure_lower" in found


def test_uneven_time_is_an_error(tmp_path: Path) -> None:
    time = bench_signals()["time"].copy()
    time[600:] += 0.05
    found, _ = first_record(bench(tmp_path, time=time))
    assert "error time" in found


def test_a_piston_that_rests_at_its_end_is_no_fault(tmp_path: Path) -> None:
    extension = np.clip(bench_signals()["extension"], 0.15, None)
    extension += np.random.default_rng(2).normal(
        0.0, 5e-5, extension.size
    )  # the sensor's noise goes on
    found, _ = first_record(bench(tmp_path, extension=extension))
    assert found == []


def test_a_parameter_of_one_leg_is_written_into_the_rig_file_of_a_platform(tmp_path: Path) -> None:
    lines = "".join(f"{name} = {{}}\n" for name in KINDS["platform"].needed if name != "time")
    record = '[[records]]\nfile = "one.csv"\nrole = "identify"\n'
    signals = {name: np.linspace(0.0, 1.0, 5) for name in KINDS["platform"].needed}
    write_record(tmp_path / "one.csv", signals)
    path = tmp_path / "rig.toml"
    path.write_text(f'[rig]\nkind = "platform"\n[signals]\ntime = "time"\n{lines}{record}')
    found = {"chamber_leakage_lower:2": Declaration(2e-9, 1e-11)}
    write_extended_rig(path, tmp_path / "extended.toml", found, "what was found")
    rig = load_rig(tmp_path / "extended.toml")
    assert rig.declared("chamber_leakage_lower:2").value == pytest.approx(2e-9)
    assert rig.start()["chamber_leakage_lower:2"] == pytest.approx(2e-9)
    assert rig.start()["chamber_leakage_lower"] == 0.0


def test_a_sensor_s_gain_is_that_of_what_its_column_reads(tmp_path: Path) -> None:
    plain = load_rig(bench(tmp_path)).start()
    assert all(plain[n] == 0.0 for n in PARAMETERS if n.startswith("sensor_datum_"))
    text = BENCH.replace(
        'extension = { noise = "0.05 mm"', 'extension = { offset = "200 mm", noise = "0.05 mm"'
    ).replace('lower = { noise = "4 mbar" }', 'lower = { noise = "4 mbar", gauge = true }')
    rig = load_rig(bench(tmp_path, text))
    params = rig.start()
    assert params["sensor_datum_extension"] == pytest.approx(0.2)
    ambient = rig.declared("ambient_pressure").value
    assert params["sensor_datum_chamber_pressure_lower"] == ambient
    assert params["sensor_datum_chamber_pressure_upper"] == 0.0


def test_each_leg_s_sensor_has_a_datum(tmp_path: Path) -> None:
    needed = [n for n in KINDS["platform"].needed if n != "time"]
    lines = "".join(f"{n} = {{}}\n" for n in needed if n != "extension_2")
    record = '[[records]]\nfile = "one.csv"\nrole = "identify"\n'
    write_record(
        tmp_path / "one.csv", {n: np.linspace(0.0, 1.0, 5) for n in KINDS["platform"].needed}
    )
    path = tmp_path / "rig.toml"
    offset = 'extension_2 = { offset = "0.3 m" }\n'
    path.write_text(f'[rig]\nkind = "platform"\n[signals]\ntime = "time"\n{lines}{offset}{record}')
    machine = load_rig(path).start()
    assert isinstance(machine, sms._core.LegParams)
    assert [leg["sensor_datum_extension"] for leg in machine.legs] == pytest.approx([0.0, 0.3, 0.0])


@pytest.mark.parametrize(
    ("unit", "factor", "line"),
    [
        (None, 1e3, 'write time = { column = "time", unit = "ms" }'),
        ("hour", 1.0, 'write time = { column = "time", unit = "s" }'),
        (None, 50.0, "check the unit of time"),
    ],
)
def test_a_clock_in_another_unit_is_an_error_with_the_line_to_write(
    tmp_path: Path, unit: str | None, factor: float, line: str
) -> None:
    said = "" if unit is None else f', unit = "{unit}"'
    text = BENCH.replace('time = "time"', f'time = {{ column = "time"{said} }}')
    path = bench(tmp_path, text, time=factor * bench_signals()["time"])
    rig = load_rig(path)
    found = check_record(rig, load_record(rig, rig.records[0]))
    assert any(f.severity == "error" and f.signal == "time" and line in f.remedy for f in found)


@pytest.mark.parametrize(
    ("signal", "factor", "unit"),
    [("extension", 100.0, "cm"), ("extension", 1e3, "mm"), ("chamber_pressure_upper", 1e-5, "bar"),
     ("chamber_pressure_lower", 1e-3, "kPa")],
)  # fmt: skip
def test_readings_in_another_unit_are_an_error_with_the_line_to_write(
    tmp_path: Path, signal: str, factor: float, unit: str
) -> None:
    path = bench(tmp_path, **{signal: factor * bench_signals()[signal]})
    rig = load_rig(path)
    found = check_record(rig, load_record(rig, rig.records[0]))
    said = [f for f in found if f.severity == "error" and f.signal == signal]
    assert any(f'unit = "{unit}"' in f.remedy for f in said), found


@pytest.mark.parametrize("step", [0.0, -0.1, 0.2, 5.0, float("nan"), float("inf")])
def test_the_core_refuses_windows_of_a_few_samples(step: float) -> None:
    """A record in seconds of which the file has milliseconds brought the process down."""
    noise = {"extension": 1e-4, "supply_pressure": 300.0}
    noise |= {"chamber_pressure_lower": 300.0, "chamber_pressure_upper": 300.0}
    with pytest.raises(ValueError, match="step"):
        record = sms._core.BenchRecord(
            step=step,
            command=np.full(600, 5.0),
            extension=np.full(600, 0.2),
            pressure_lower=np.full(600, 3e5),
            pressure_upper=np.full(600, 3e5),
        )
        sms._core.BenchProblem(records=[record], noise=noise)


def test_a_record_at_20_khz_is_thinned_and_that_is_said(tmp_path: Path) -> None:
    signals = bench_signals(60_000) | {"time": 5e-5 * np.arange(60_000)}
    path = bench(tmp_path, BENCH.replace('"test"', '"validate"'), **signals)
    records, findings = read_and_check(load_rig(path))
    assert [len(r) for r in records] == [3_000, 3_000]
    assert np.allclose(np.diff(records[0].signals["time"]), 1e-3)
    assert "one sample in 20 is used" in " ".join(f.remedy for f in findings)
    assert records[0].signals["extension"][1] == signals["extension"][20]


def test_more_samples_than_a_diagnosis_holds_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sms.io.thinning.MOST_SAMPLES", 2399)
    path = bench(tmp_path, BENCH.replace('"test"', '"validate"'))
    with pytest.raises(InputError, match="2400 samples in 2 records; a diagnosis holds 2399"):
        read_and_check(load_rig(path))


@pytest.mark.parametrize(
    ("step", "warned"),
    [(0.005, False), (0.0055, True), (1.0 / 60.0, False), (0.011, True), (0.001, False)],
)
def test_a_rate_that_no_logger_has_is_said(tmp_path: Path, step: float, warned: bool) -> None:
    path = bench(tmp_path, time=step * np.arange(1200))
    rig = load_rig(path)
    found = check_record(rig, load_record(rig, rig.records[0]))
    assert (
        any("no logger has" in f.message and "scale = 0.909091" in f.remedy for f in found)
        is warned
    )


def test_samples_that_are_skipped_reach_no_simulation(tmp_path: Path) -> None:
    signals = bench_signals()
    bad = signals["extension"].copy()
    bad[:20] = np.nan
    text = BENCH.replace('"test"', '"validate"') + "\n[data]\nskip_first = 20\n"
    path = bench(tmp_path, text, extension=bad)
    rig = load_rig(path)
    found, record = first_record(path)
    assert not [f for f in found if f.startswith("error")]
    assert len(record) == len(bad) - 20
    np.testing.assert_array_equal(record.signals["extension"], signals["extension"][20:])
    assert record.finding("note", 0, "extension", "", "").line == 22
    assert all(np.all(np.isfinite(r.signals["extension"])) for r in read_and_check(rig)[0])


def test_skipping_all_of_a_record_is_refused(tmp_path: Path) -> None:
    rig = load_rig(bench(tmp_path, BENCH + "\n[data]\nskip_first = 1200\n"))
    with pytest.raises(InputError, match=r"one.csv: skip_first leaves none of its 1200 samples"):
        load_record(rig, rig.records[0])
