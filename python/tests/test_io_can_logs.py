"""CAN logs as records: every format gives the same signals, and what a log hides is said."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import can
import cantools.database
import numpy as np
import pytest
from io_support import PARAMETERS, healthy_signals
from sms.io import InputError, Record, check_record, load_record, load_rig, write_extended_rig
from sms.io.can_files import WRITTEN, LogWriter, read_frames
from sms.io.can_frames import find_channel, load_dbc
from sms.io.can_logs import read_can_log
from sms.io.table_files import is_can_log

from validation.random_cases import draw

DBC = """
VERSION ""
BU_: LOGGER BENCH
BO_ 256 Motion: 8 BENCH
 SG_ stroke : 0|32@1- (1E-6,0) [0|0.5] "m" LOGGER
 SG_ force : 32|24@1- (1E-3,0) [-8000|8000] "N" LOGGER
 SG_ count : 56|8@1+ (1,0) [0|255] "" LOGGER
BO_ 512 Air: 8 BENCH
 SG_ lower : 0|24@1+ (0.1,0) [0|1600000] "Pa" LOGGER
 SG_ gate : 24|8@1+ (1,0) [0|1] "" LOGGER
 SG_ temperature : 32|16@1- (0.01,0) [-100|200] "degC" LOGGER
BO_ 768 Other: 8 BENCH
 SG_ which M : 0|8@1+ (1,0) [0|1] "" LOGGER
 SG_ first m0 : 8|16@1- (0.1,0) [-1000|1000] "N" LOGGER
 SG_ second m1 : 8|16@1- (0.1,0) [-1000|1000] "N" LOGGER
 SG_ temperature : 32|16@1- (0.01,0) [-100|200] "degC" LOGGER
VAL_ 512 gate 0 "closed" 1 "open" ;
"""
SIGNALS = """
[signals]
time = "time"
extension = "stroke"
chamber_pressure_lower = "Air.lower [Pa]"
rod_force = "force"
"""
STEP, AIR_STEP, AIR_LATE = 0.01, 0.025, 0.0037  # s: Motion's interval, Air's, and Air's delay
START = 1_700_000_000.0  # s; a logger's clock


@pytest.fixture
def dbc(tmp_path: Path) -> Path:
    path = tmp_path / "bench.dbc"
    path.write_text(DBC)
    return path


BENCH = cantools.database.load_string(DBC)


def frame(time: float, message: str, **values: float) -> can.Message:
    described = BENCH.get_message_by_name(message)
    return can.Message(
        timestamp=float(START + time),
        arbitration_id=described.frame_id,
        is_extended_id=False,
        data=described.encode(values),
        channel=1,
    )


def healthy_frames() -> list[can.Message]:
    """The healthy cylinder as frames: Motion every 10 ms, Air every 25 ms and a little later."""
    signals = healthy_signals()
    time = signals["time"]
    frames = [
        frame(t, "Motion", stroke=x, force=f, count=i % 256)
        for i, (t, x, f) in enumerate(
            zip(time, signals["extension"], signals["rod_force"], strict=True)
        )
    ]
    for t in np.arange(AIR_LATE, time[-1], AIR_STEP):
        lower = np.interp(t, time, signals["chamber_pressure_lower"])
        frames.append(frame(t, "Air", lower=lower, gate=int(t > 6.0), temperature=20.0))
    return sorted(frames, key=lambda f: f.timestamp)


def write_log(path: Path, frames: list[can.Message]) -> Path:
    with LogWriter(path) as log:
        for one in frames:
            log.write(one)
    return path


def read(folder: Path, log: str, signals: str = SIGNALS) -> Record:
    record = f'\n[[records]]\nfile = "{log}"\nrole = "identify"\n'
    rig_file = folder / "rig.toml"
    rig_file.write_text(
        f'[rig]\nkind = "cylinder"\n[data]\ndbc = "bench.dbc"\n{signals}{PARAMETERS}{record}'
    )
    rig = load_rig(rig_file)
    return load_record(rig, rig.records[0])


def write_elsewhere(path: Path, frames: list[can.Message]) -> Path:
    """A log in a format that other programs write: candump, TRC, SQLite, packed."""
    if path.suffix == ".db":  # python-can's writer may be stopped before it has written all
        rows = [(f.timestamp, f.arbitration_id, 0, 0, 0, f.dlc, bytes(f.data)) for f in frames]
        with closing(sqlite3.connect(path)) as database, database:
            database.execute(
                "CREATE TABLE messages (ts REAL, arbitration_id INTEGER, extended INTEGER, "
                "remote INTEGER, error INTEGER, dlc INTEGER, data BLOB)"
            )
            database.executemany("INSERT INTO messages VALUES (?, ?, ?, ?, ?, ?, ?)", rows)
    else:
        with can.Logger(path) as log:
            for one in frames:
                log.on_message_received(one)
    return path


@pytest.mark.parametrize("ending", [*WRITTEN, ".log", ".trc", ".db", ".asc.gz", ".TRC.gz"])
def test_every_format_gives_the_same_record(tmp_path: Path, dbc: Path, ending: str) -> None:
    frames = healthy_frames()
    write = write_log if ending in WRITTEN else write_elsewhere
    log = write(tmp_path / f"run{ending}", frames)
    assert is_can_log(log)
    assert [f for f in tmp_path.iterdir() if f.name.startswith(".")] == []

    record = read(tmp_path, log.name)
    signals = healthy_signals()
    time = record.signals["time"]
    # Air comes last at first: the record begins with the first Motion after it.
    np.testing.assert_allclose(time, signals["time"][1 : time.size + 1], atol=2e-6)
    index = np.arange(1, time.size + 1)
    np.testing.assert_allclose(
        record.signals["extension"], signals["extension"][index], atol=0.51e-6
    )
    np.testing.assert_allclose(
        record.signals["rod_force"], signals["rod_force"][index], atol=0.51e-3
    )
    assert record.findings == ()

    # The pressure lies on the straight lines between Air's frames.
    at = np.array([f.timestamp - START for f in frames if f.arbitration_id == 512])
    there = np.interp(at, signals["time"], signals["chamber_pressure_lower"])
    expected = np.interp(time, at, there)
    np.testing.assert_allclose(record.signals["chamber_pressure_lower"], expected, atol=5.0)
    assert record.lines[0] == 3  # Motion, Air, Motion


def test_a_record_from_a_log_passes_the_data_check(tmp_path: Path, dbc: Path) -> None:
    write_log(tmp_path / "run.blf", healthy_frames())
    record = read(tmp_path, "run.blf")
    rig = load_rig(tmp_path / "rig.toml")
    assert check_record(rig, record) == ()


def test_named_values_are_held_and_numbers_led(tmp_path: Path, dbc: Path) -> None:
    log = write_log(tmp_path / "run.blf", healthy_frames())
    table = read_can_log(log, load_dbc(dbc), {"stroke": False, "gate": False})
    assert table.names == ("time [s]", "stroke [m]", "gate [1]")
    gate = table.numbers(2)[0]
    assert set(gate) == {0.0, 1.0}


def test_a_multiplexed_signal_is_taken_from_the_frames_that_hold_it(
    tmp_path: Path, dbc: Path
) -> None:
    frames = []
    for i in range(40):
        value = {"first": 0.5 * i} if i % 2 == 0 else {"second": -1.0}
        frames.append(
            frame(0.01 * i, "Other", which=i % 2, temperature=20.0, **value)  # type: ignore[arg-type]
        )
    log = write_log(tmp_path / "run.asc", frames)
    table = read_can_log(log, load_dbc(dbc), {"first": False})
    np.testing.assert_allclose(table.numbers(1)[0], 0.5 * np.arange(39), atol=1e-9)


def test_gaps_disorder_and_bus_errors_are_said(tmp_path: Path, dbc: Path) -> None:
    frames = healthy_frames()
    lost = [f for f in frames if not (f.arbitration_id == 512 and 4.0 < f.timestamp - START < 4.5)]
    lost.append(can.Message(timestamp=START + 5.0, is_error_frame=True, channel=1))
    cut = frame(5.0, "Air", lower=1e5, gate=0, temperature=0.0)
    lost.append(can.Message(timestamp=START + 5.0, arbitration_id=512, data=cut.data[:2]))
    lost[-1].is_extended_id = False
    lost[100], lost[101] = lost[101], lost[100]
    write_log(tmp_path / "run.csv", lost)
    findings = [str(f) for f in read(tmp_path, "run.csv").findings]
    assert any("no frame of 'Air' for 0.525 s" in f and "every 25 ms" in f for f in findings)
    assert any("1 error frames" in f for f in findings)
    assert any("1 frames of 'Air' do not fit the DBC" in f for f in findings)


def test_frames_out_of_order_are_sorted_and_said(tmp_path: Path, dbc: Path) -> None:
    frames = [frame(0.01 * i, "Motion", stroke=1e-3 * i, force=0, count=i) for i in range(9)]
    frames[4], frames[5] = frames[5], frames[4]
    log = write_log(tmp_path / "run.csv", [*frames, frames[-1]])
    table = read_can_log(log, load_dbc(dbc), {"stroke": False})
    np.testing.assert_allclose(table.numbers(1)[0], 1e-3 * np.arange(9))
    said = [remark.message for remark in table.remarks]
    assert any("1 frames of 'Motion' stand out of order" in message for message in said)
    assert any("1 frames of 'Motion' have the time of another" in message for message in said)


def failure(folder: Path, log: str, signals: str) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, log, signals)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_what_cannot_be_a_record_is_said(tmp_path: Path, dbc: Path) -> None:
    write_log(tmp_path / "run.blf", healthy_frames())
    assert "did you mean 'stroke'?" in failure(
        tmp_path, "run.blf", SIGNALS.replace('"stroke"', '"strike"')
    )
    both = SIGNALS + 'chamber_pressure_upper = "temperature"\n'
    sentence = failure(tmp_path, "run.blf", both)
    assert "Air.temperature, Other.temperature" in sentence
    other = SIGNALS + 'chamber_pressure_upper = "Other.temperature"\n'
    assert "'Other' came 0 times, with 0 values of 'temperature'" in failure(
        tmp_path, "run.blf", other
    )
    (tmp_path / "run.blf").write_bytes(b"LOGG but no log")
    assert "not a readable .blf log" in failure(tmp_path, "run.blf", SIGNALS)
    for name in ("run.db", "run.mf4"):
        (tmp_path / name).write_bytes(b"no log")
        assert f"not a readable {name[3:]} log" in failure(tmp_path, name, SIGNALS)
    (tmp_path / "run.trc.gz").write_bytes(b"not packed")
    assert "not a readable .trc log" in failure(tmp_path, "run.trc.gz", SIGNALS)
    with pytest.raises(InputError, match=r"use \.blf, \.asc, \.mf4, \.csv"):
        LogWriter(tmp_path / "run.xyz")
    dbc.write_text("no bus")
    write_log(tmp_path / "new.blf", [can.Message(arbitration_id=1, data=b"\0", timestamp=1.0)])
    assert "not a readable DBC" in failure(tmp_path, "new.blf", SIGNALS)
    dbc.unlink()
    assert "[data] dbc: there is no DBC file" in failure(tmp_path, "new.blf", SIGNALS)


def test_a_table_of_numbers_is_no_log(tmp_path: Path) -> None:
    for name, text in (
        ("a.csv", "time [s],x [m]\n0,1\n"),
        ("a.asc", "0.0 1.0\n"),
        ("a.log", "time x\n"),
    ):
        (tmp_path / name).write_text(text)
        assert not is_can_log(tmp_path / name)
    assert not is_can_log(tmp_path / "absent.csv")


def test_an_extended_rig_file_still_finds_the_dbc(tmp_path: Path, dbc: Path) -> None:
    write_log(tmp_path / "run.blf", healthy_frames())
    read(tmp_path, "run.blf")
    there = tmp_path / "elsewhere" / "extended.toml"
    write_extended_rig(tmp_path / "rig.toml", there, {}, "extended")
    assert load_rig(there).layout.dbc == dbc


def test_an_unfinished_log_is_not_left(tmp_path: Path) -> None:
    one = can.Message(arbitration_id=1, data=b"\0", timestamp=1.0)
    with pytest.raises(RuntimeError), LogWriter(tmp_path / "run.blf") as log:
        log.write(one)
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(KeyboardInterrupt), LogWriter(tmp_path / "run.blf") as log:
        log.write(one)
        raise KeyboardInterrupt
    assert [f.name for f in tmp_path.iterdir()] == ["run.blf"]
    assert len(list(read_frames(tmp_path / "run.blf"))) == 1
    with pytest.raises(InputError, match="no frame came"), LogWriter(tmp_path / "empty.blf"):
        pass
    assert [f.name for f in tmp_path.iterdir()] == ["run.blf"]


def test_columns_name_signals(dbc: Path) -> None:
    database = load_dbc(dbc)
    for column in ("stroke", "stroke [m]", "Motion.stroke", "Motion.stroke [m]"):
        channel = find_channel(database, column)
        assert channel is not None
        assert channel.column == f"{column.removesuffix(' [m]')} [m]"
        assert channel.message.name == "Motion"
    assert find_channel(database, "Air.stroke") is None


@pytest.mark.parametrize(
    ("more", "column", "said"),
    [
        ("BO_ 769 Other: 8 BENCH\n SG_ second : 0|8@1+ (1,0) [0|0] \"N\" LOGGER\n", "Other.second",
         "write one of 0x300.second, 0x301.second"),
        (" SG_ first m1 : 24|8@1+ (1,0) [0|0] \"N\" LOGGER\n", "first",
         "message 'Other' of the DBC has 2 signals of the name 'first'"),
        ("", "temperature", "write one of Air.temperature, Other.temperature"),
    ],
)  # fmt: skip
def test_a_name_that_several_signals_have_is_told_apart_or_asked_to_be_changed(
    more: str, column: str, said: str, dbc: Path
) -> None:
    dbc.write_text(DBC.replace("VAL_ 512", f"{more}VAL_ 512"))
    with pytest.raises(InputError) as refused:
        find_channel(load_dbc(dbc), column)
    assert said in str(refused.value)


def test_random_logs_decode_as_frame_by_frame(tmp_path: Path, dbc: Path) -> None:
    random = draw("test_random_logs_decode_as_frame_by_frame")
    stroke = random.uniform(0.0, 0.4, 50)
    frames = [frame(0.01 * i, "Motion", stroke=x, force=0, count=0) for i, x in enumerate(stroke)]
    table = read_can_log(
        write_log(tmp_path / "run.mf4", frames), load_dbc(dbc), {"Motion.stroke": False}
    )
    np.testing.assert_allclose(table.numbers(1)[0], stroke, atol=0.51e-6)
