"""Logs of buses that are not the project's own: J1939, merged definitions, and columns that are called otherwise."""

from __future__ import annotations

import json
from pathlib import Path

import can
import cantools.database
import numpy as np
import pandas as pd
import pytest
from cli_support import sms
from sms.errors import InputError
from sms.io.can_files import LogWriter
from sms.io.can_frames import load_dbc
from sms.io.can_logs import read_bus, read_can_log
from sms.io.table import renamed
from sms.io.table_files import open_table

J1939 = """
VERSION ""
BU_: ENGINE
BO_ 2364540158 EEC1: 8 ENGINE
 SG_ speed : 24|16@1+ (0.125,0) [0|8031.875] "rpm" ENGINE
BA_DEF_ BO_ "VFrameFormat" ENUM "StandardCAN","ExtendedCAN","reserved","J1939PG";
BA_DEF_DEF_ "VFrameFormat" "J1939PG";
BA_ "VFrameFormat" BO_ 2364540158 3;
"""
MERGED = """
VERSION ""
BU_: RIG
BO_ 256 Leg: 8 RIG
 SG_ stroke : 0|32@1- (1E-6,0) [0|0.5] "m" RIG
BO_ 257 Leg: 8 RIG
 SG_ stroke : 0|32@1- (1E-6,0) [0|0.5] "m" RIG
BO_ 258 Air: 8 RIG
 SG_ lower : 0|24@1+ (0.1,0) [0|1600000] "Pa" RIG
"""
TIMES = 0.01 * np.arange(80)


def written(folder: Path, dbc: str, frames: list[can.Message]) -> tuple[Path, Path]:
    definition, log = folder / "bus.dbc", folder / "run.asc"
    definition.write_text(dbc)
    with LogWriter(log) as writer:
        for frame in sorted(frames, key=lambda f: f.timestamp):
            writer.write(frame)
    return definition, log


def engine(time: float, rpm: float, source: int, priority: int = 3) -> can.Message:
    """EEC1 (parameter group 0xF004) as an engine at this address sends it."""
    raw = round(rpm / 0.125)
    data = bytes([255] * 3 + [raw & 255, raw >> 8] + [255] * 3)
    identifier = priority << 26 | 0xF004 << 8 | source
    return can.Message(timestamp=time, arbitration_id=identifier, is_extended_id=True, data=data)


def merged_frames() -> list[can.Message]:
    frames = []
    for t in TIMES:
        for identifier, stroke in ((256, 0.1 + 0.1 * t), (257, 0.3 - 0.1 * t)):
            data = round(stroke * 1e6).to_bytes(4, "little", signed=True) + bytes(4)
            frames.append(
                can.Message(timestamp=t, arbitration_id=identifier, is_extended_id=False, data=data)
            )
    return frames


@pytest.mark.parametrize("priority", [3, 6])
def test_a_message_of_j1939_is_known_by_its_parameter_group(tmp_path: Path, priority: int) -> None:
    frames = [engine(t, 800.0 + 100.0 * t, 0x00, priority) for t in TIMES]
    other = 6 << 26 | 0xFEF1 << 8
    frames += [can.Message(timestamp=t, arbitration_id=other, data=bytes(8)) for t in TIMES]
    dbc, log = written(tmp_path, J1939, frames)
    table = read_bus(log, dbc)
    assert table.names == ("time [s]", "speed [rpm]")
    np.testing.assert_allclose(table.numbers(1)[0], 800.0 + 100.0 * TIMES, atol=0.0626)
    assert not table.remarks


def test_several_senders_of_one_group_are_said(tmp_path: Path) -> None:
    frames = [engine(t + 0.001 * k, 800.0, k) for t in TIMES for k in (0, 1)]
    dbc, log = written(tmp_path, J1939, frames)
    said = [r.message for r in read_bus(log, dbc).remarks]
    assert any("'EEC1' came from several addresses (0x00, 0x01)" in text for text in said)


def test_messages_of_one_name_are_told_apart_by_identifier(tmp_path: Path) -> None:
    dbc, log = written(tmp_path, MERGED, merged_frames())
    table = read_bus(log, dbc)
    assert table.names == ("time [s]", "0x100.stroke [m]", "0x101.stroke [m]")
    np.testing.assert_allclose(table.numbers(2)[0], 0.3 - 0.1 * TIMES, atol=1e-6)
    with pytest.raises(InputError, match=r"write one of 0x100\.stroke, 0x101\.stroke"):
        read_can_log(log, load_dbc(dbc), {"Leg.stroke": False})
    one = read_can_log(log, load_dbc(dbc), {"0x100.stroke": False})
    np.testing.assert_allclose(one.numbers(1)[0], 0.1 + 0.1 * TIMES, atol=1e-6)


def test_table_and_noise_take_another_bus(tmp_path: Path) -> None:
    dbc, log = written(tmp_path, MERGED, merged_frames())
    done = sms("can", "table", log.name, "--dbc", dbc.name, "--out", "t.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert list(pd.read_csv(tmp_path / "t.csv").columns) == [
        "time [s]", "0x100.stroke [m]", "0x101.stroke [m]"
    ]  # fmt: skip
    done = sms(
        "noise", log.name, "--dbc", dbc.name, "--column", "extension=0x101.stroke", "--signal", "extension",
        "--out", "n", "--json", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["signal"] == "extension"


def test_columns_that_are_called_otherwise(tmp_path: Path) -> None:
    file = tmp_path / "r.csv"
    file.write_text("t [ms],stroke,p [bar]\n0,1,2\n10,2,3\n20,3,5\n", encoding="utf-8")
    table = open_table(file, {"time": "t", "extension": "stroke [mm]"})
    assert table.names == ("time [ms]", "extension [mm]", "p [bar]")
    with pytest.raises(InputError, match="there is no column 'x' for time"):
        open_table(file, {"time": "x"})
    with pytest.raises(InputError, match="there is a column 'p' already"):
        renamed(table, {"p": "extension"})
    with pytest.raises(InputError, match="--dbc is for logs of CAN frames"):
        open_table(file, dbc=file)


@pytest.mark.parametrize("said", ["time", "=t", "time="])
def test_a_pair_that_is_none_is_said(tmp_path: Path, said: str) -> None:
    file = tmp_path / "r.csv"
    file.write_text("t [ms],x\n0,1\n10,2\n", encoding="utf-8")
    done = sms("noise", file.name, "--column", said, cwd=tmp_path)
    assert done.returncode == 2
    assert "write SIGNAL=COLUMN" in done.stderr


def test_the_group_of_the_definition_is_the_standards() -> None:
    """Against cantools' own: PDU 1 carries a destination where PDU 2 carries a group extension."""
    from cantools.j1939 import pgn_from_frame_id  # noqa: PLC0415
    from sms.io.can_frames import _parameter_group  # noqa: PLC0415

    rng = np.random.default_rng(20)
    for identifier in (int(i) for i in rng.integers(0, 2**29, 2000)):
        assert _parameter_group(identifier) == pgn_from_frame_id(identifier)
    assert isinstance(cantools.database.load_string(J1939), cantools.database.can.Database)


def test_a_definition_that_is_refused_in_several_lines_is_one_sentence(tmp_path: Path) -> None:
    """A value of a signal that is not there: cantools lists such over lines of their own."""
    definition = tmp_path / "bus.dbc"
    definition.write_text(MERGED + 'VAL_ 258 upper 1 "open" 0 "shut" ;\n')
    with pytest.raises(InputError, match="not a readable DBC file") as refused:
        load_dbc(definition)
    assert "258 upper" in str(refused.value)
    assert "\n" not in str(refused.value)
