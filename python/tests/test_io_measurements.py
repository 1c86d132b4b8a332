"""Logs of measurement systems and MATLAB's objects, each written by its own library, read as one table."""

from __future__ import annotations

import gc
import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from sms.errors import InputError
from sms.io import matlab_files, measurement_files
from sms.io.table import Table
from sms.io.table_files import is_can_log, read_table
from sms.io.write import write_table

STROKE = np.sin(np.linspace(0.0, 3.0, 101))
TIME = np.linspace(0.0, 1.0, 101)
LATE, PRESSURE = np.linspace(0.05, 0.95, 31), 3.0 + 2.0 * np.linspace(0.05, 0.95, 31)


def read(file: Path) -> Table:
    return read_table(file, "comma", None)


def column(table: Table, name: str) -> np.ndarray:
    values, bad = table.numbers(table.names.index(name))
    assert not bad
    return values


def check_two_rates(table: Table, stroke: str, pressure: str) -> None:
    """The stroke as it is, the pressure led onto its times, and no more of both than both have."""
    time = column(table, "time [s]")
    assert 0.0499 < time[0] < 0.0601 and 0.9399 < time[-1] < 0.9501
    np.testing.assert_allclose(column(table, stroke), np.interp(time, TIME, STROKE), atol=1e-12)
    np.testing.assert_allclose(column(table, pressure), 3.0 + 2.0 * time, rtol=1e-6)
    assert any("straight lines" in r.message for r in table.remarks)


# ---- measurement systems -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("version", "name"), [("4.10", "r.mf4"), ("3.30", "r.mdf"), ("3.30", "r.dat")]
)
def test_mdf_is_read_by_signal(tmp_path: Path, version: str, name: str) -> None:
    asammdf = pytest.importorskip("asammdf")
    log = asammdf.MDF(version=version)
    log.append([asammdf.Signal(STROKE, TIME, name="stroke", unit="mm")])
    log.append([asammdf.Signal(PRESSURE, LATE, name="pressure", unit="bar")])
    saved = log.save(tmp_path / f"m{'.mf4' if version > '4' else '.mdf'}", overwrite=True)
    log.close()
    file = Path(saved).rename(tmp_path / name)
    assert not is_can_log(file)
    check_two_rates(read(file), "stroke [mm]", "pressure [bar]")


@pytest.mark.filterwarnings("error::pytest.PytestUnraisableExceptionWarning")
def test_of_a_broken_mdf_one_sentence_is_said_and_nothing_is_printed(tmp_path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    log = asammdf.MDF(version="4.10")
    log.append([asammdf.Signal(STROKE, TIME, name="stroke", unit="mm")])
    file = Path(log.save(tmp_path / "whole.mf4", overwrite=True))
    log.close()
    spoilt = bytearray(file.read_bytes())
    spoilt[64:72] = b"no block"  # of which the header begins
    for ending in (".mf4", ".mdf"):
        broken = tmp_path / f"broken{ending}"
        broken.write_bytes(spoilt)
        with pytest.raises(InputError, match="not a readable"):
            read(broken)
    gc.collect()  # destructors run here, if they have not


def test_tdms_is_read_with_its_own_times(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    waveform = {"wf_start_offset": 0.0, "wf_increment": 0.01, "unit_string": "mm"}
    slow = {"wf_start_offset": 0.05, "wf_increment": 0.03, "unit_string": "bar"}
    with nptdms.TdmsWriter(tmp_path / "r.tdms") as writer:
        writer.write_segment([
            nptdms.ChannelObject("log", "stroke", STROKE, waveform),
            nptdms.ChannelObject("log", "pressure", PRESSURE, slow),
        ])  # fmt: skip
    check_two_rates(read(tmp_path / "r.tdms"), "stroke [mm]", "pressure [bar]")


def test_tdms_without_times_is_vectors(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(tmp_path / "r.tdms") as writer:
        writer.write_segment([
            nptdms.ChannelObject("log", "time", TIME, {"unit_string": "s"}),
            nptdms.ChannelObject("log", "stroke", STROKE),
        ])  # fmt: skip
    table = read(tmp_path / "r.tdms")
    assert table.names == ("time [s]", "stroke")
    np.testing.assert_array_equal(column(table, "stroke"), STROKE)


def test_hdf5_is_vectors_with_their_units(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "r.h5", "w") as log:
        log["run/time"] = TIME
        log["run/stroke"] = STROKE[:, None]
        log["run/stroke"].attrs["unit"] = "mm"
        log["serial"] = 7
    table = read(tmp_path / "r.h5")
    assert set(table.names) == {"run.time", "run.stroke [mm]"}
    np.testing.assert_array_equal(column(table, "run.stroke [mm]"), STROKE)


def mcap_with(file: Path, encoding: str) -> Path:
    writer_of = pytest.importorskip("mcap.writer")
    with file.open("wb") as opened:
        writer = writer_of.Writer(opened)
        writer.start()
        schema = writer.register_schema("Sample", "jsonschema", b"{}")
        topics = {
            name: writer.register_channel(f"/rig/{name}", encoding, schema)
            for name in ("stroke", "air")
        }
        samples = [(t, "stroke", {"stroke": s}) for t, s in zip(TIME, STROKE, strict=True)]
        samples += [(t, "air", {"lower": {"bar": p}}) for t, p in zip(LATE, PRESSURE, strict=True)]
        for at, topic, content in sorted(samples, key=lambda s: s[0]):
            stamp = round(at * 1e9)
            writer.add_message(topics[topic], stamp, json.dumps(content).encode(), stamp)
        writer.finish()
    return file


def test_mcap_of_json_is_read_by_topic(tmp_path: Path) -> None:
    table = read(mcap_with(tmp_path / "r.mcap", "json"))
    check_two_rates(table, "rig.stroke.stroke", "rig.air.lower.bar")


def test_mcap_of_another_encoding_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="encoded as cdr; JSON is read"):
        read(mcap_with(tmp_path / "r.mcap", "cdr"))


@pytest.mark.parametrize(
    "opening", [b"MDF     4.10    ", b"TDSm" + bytes(24), b"\x89MCAP0\r\n", b"\x89HDF\r\n\x1a\n"]
)
def test_a_log_that_was_cut_off_is_said(tmp_path: Path, opening: bytes) -> None:
    pytest.importorskip("nptdms")
    pytest.importorskip("mcap")
    file = tmp_path / "r.dat"
    file.write_bytes(opening + b"\xff" * 40)
    with pytest.raises(InputError, match=str(file)):
        read(file)


def test_times_that_run_backwards_are_said(tmp_path: Path) -> None:
    h5 = pytest.importorskip("asammdf")
    log, back = h5.MDF(version="4.10"), TIME.copy()
    back[50] = 0.1
    log.append([h5.Signal(STROKE, back, name="stroke")])
    log.save(tmp_path / "r.mf4", overwrite=True)
    log.close()
    with pytest.raises(InputError, match="the times of 'stroke' do not rise"):
        read(tmp_path / "r.mf4")


def test_too_much_is_refused_before_it_is_held(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "r.h5", "w") as log:
        log.create_dataset("stroke", shape=(2**40,), dtype="f8", chunks=(1024,))
    with pytest.raises(InputError, match="numbers are more than"):
        read(tmp_path / "r.h5")


def test_a_missing_package_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(name: str) -> Any:
        raise ImportError(name)

    (tmp_path / "r.tdms").write_bytes(b"TDSm" + bytes(60))
    monkeypatch.setattr(measurement_files.importlib, "import_module", none)
    with pytest.raises(InputError, match=r'pip install "sms\[logs\]"'):
        read(tmp_path / "r.tdms")


# ---- MATLAB --------------------------------------------------------------------------------------


def test_a_structure_with_time_of_simulink(tmp_path: Path) -> None:
    both = np.zeros(2, dtype=[("values", "O"), ("label", "O")])
    both[0] = (STROKE[:, None], "stroke [mm]")
    both[1] = (np.column_stack([STROKE, -STROKE]), "pair")
    scipy.io.savemat(tmp_path / "r.mat", {"out": {"time": TIME[:, None], "signals": both}})
    table = read(tmp_path / "r.mat")
    assert table.names == ("time [s]", "stroke [mm]", "pair(1)", "pair(2)")
    np.testing.assert_array_equal(column(table, "pair(2)"), -STROKE)


@pytest.mark.parametrize("version", ["v7", "v7.3"])
def test_vectors_and_structures_are_the_same_in_every_version(tmp_path: Path, version: str) -> None:
    matio = pytest.importorskip("matio")
    variables = {
        "log": {"t": TIME[:, None], "air": {"lower": STROKE[None, :]}},
        "comment": "morning",
        "one": 1.0,
    }
    matio.save_to_mat(str(tmp_path / "r.mat"), variables, version=version)
    table = read(tmp_path / "r.mat")
    assert set(table.names) == {"log.t", "log.air.lower"}
    np.testing.assert_array_equal(column(table, "log.air.lower"), STROKE)


@pytest.mark.parametrize("version", ["v7", "v7.3"])
@pytest.mark.parametrize("even", [False, True])
def test_timeseries_in_a_data_set_of_simulink(tmp_path: Path, version: str, even: bool) -> None:
    matio = pytest.importorskip("matio")
    opaque = importlib.import_module("matio.utils.matclass").MatlabOpaque

    def series(name: str, time: np.ndarray, values: np.ndarray) -> Any:
        step = float(time[1] - time[0])
        told = {"Start": time[0], "Increment": step, "Length": float(len(time))}
        return opaque(
            {
                "Name": np.array([name]),
                "Time_": np.empty((0, 0)) if even else time[:, None],
                "TimeInfo": opaque(told, "tsdata.timemetadata"),
                "Data_": values[:, None],
                "DataInfo": opaque({"Units": np.array(["mm"])}, "tsdata.datametadata"),
            },
            "timeseries",
        )

    elements = np.empty((1, 2), dtype=object)
    for k, (name, time, values) in enumerate(
        [("stroke", TIME, STROKE), ("pressure", LATE, PRESSURE)]
    ):
        elements[0, k] = opaque(
            {"Values": series(name, time, values)}, "Simulink.SimulationData.Signal"
        )
    logged = opaque({"Elements": elements}, "Simulink.SimulationData.Dataset")
    matio.save_to_mat(str(tmp_path / "r.mat"), {"logsout": logged}, version=version)
    check_two_rates(read(tmp_path / "r.mat"), "stroke [mm]", "pressure [mm]")


def test_a_table_written_for_simulink_is_read_as_it_was(tmp_path: Path) -> None:
    pytest.importorskip("matio")
    columns = {"time [s]": TIME, "stroke [mm]": STROKE, "gate": np.round(TIME)}
    write_table(tmp_path / "r.mat", columns)
    assert [f.name for f in tmp_path.iterdir()] == ["r.mat"]
    table = read(tmp_path / "r.mat")
    assert table.names == tuple(columns)
    for name, values in columns.items():
        np.testing.assert_array_equal(column(table, name), values)
    with pytest.raises(InputError, match="needs a column time"):
        write_table(tmp_path / "s.mat", {"stroke [mm]": STROKE})


def test_objects_without_the_package_are_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    matio = pytest.importorskip("matio")
    matio.save_to_mat(str(tmp_path / "r.mat"), {"t": TIME}, version="v7.3")

    def none(name: str) -> Any:
        raise ImportError(name)

    monkeypatch.setattr(matlab_files.importlib, "import_module", none)
    with pytest.raises(InputError, match="save -v7"):
        read(tmp_path / "r.mat")
