"""Records: every file format gives the same signals, and what cannot be a record is said."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scipy.io
from io_support import PARAMETERS, PLAIN_RIG, Array, healthy_signals, write_rig
from sms.io import InputError, Record, load_record, load_rig
from sms.io.table_files import read_table

FOREIGN = """
[signals]
time = "t"
extension = { column = "stroke", scale = -1, offset = "40 mm" }
chamber_pressure_lower = { column = "pressure [bar]", gauge = true }
rod_force = { column = "F", unit = "kN" }
"""
ONE_RECORD = '\n[[records]]\nfile = "FILE"\nrole = "identify"\n'


def rig_text(file: str, data: str = "", signals: str = FOREIGN) -> str:
    record = ONE_RECORD.replace("FILE", file)
    return f'[rig]\nkind = "cylinder"\n[data]\n{data}\n{signals}{PARAMETERS}{record}'


def read(folder: Path, text: str) -> Record:
    path = folder / "rig.toml"
    path.write_text(text, encoding="utf-8")
    rig = load_rig(path)
    return load_record(rig, rig.records[0])


def failure(folder: Path, text: str) -> str:
    with pytest.raises(InputError) as caught:
        read(folder, text)
    assert "\n" not in str(caught.value)
    return str(caught.value)


TABLE = np.array(
    [[0.0, 0.0, 9.9, 3.0, 0.15], [10.0, 0.5, 9.9, 3.1, 0.16], [20.0, 1.0, 9.9, 3.2, 0.17]]
)
HEADER = ["t [ms]", "stroke [mm]", "pressure [V]", "pressure [bar]", "F"]
EXPECTED = {
    "time": [0.0, 0.01, 0.02],
    "extension": [0.04, 0.0395, 0.039],
    "chamber_pressure_lower": [3.0e5, 3.1e5, 3.2e5],
    "rod_force": [150.0, 160.0, 170.0],
}


def check_expected(record: Record) -> None:
    assert set(record.signals) == set(EXPECTED)
    for signal, values in EXPECTED.items():
        np.testing.assert_allclose(record.signals[signal], values, rtol=1e-12, err_msg=signal)
    assert record.gauge == {"chamber_pressure_lower"}
    assert record.findings == ()
    assert len(record) == 3


def lines_of(separator: str, end: str = "\n") -> str:
    return "".join(separator.join(f"{cell:g}" for cell in row) + end for row in TABLE)


@pytest.mark.parametrize(("file", "delimiter", "text", "first_line"), [
    ("r.csv", "comma", ",".join(HEADER) + "\n" + lines_of(","), 2),
    ("r.csv", "comma", ", ".join(f'"{n}"' for n in HEADER) + "\n" + lines_of(", "), 2),
    ("r.csv", "comma", "\ufeff" + ",".join(HEADER) + "\r\n" + lines_of(","), 2),
    ("r.csv", "comma", "# rig 7\n\n" + ",".join([*HEADER, "\n"]) + lines_of(",", end=",\n"), 4),
    ("r.txt", "semicolon", ";".join(HEADER) + "\n" + lines_of(";") + "\n\n", 2),
    ("r.tsv", "tab", "\t".join(HEADER) + "\n" + lines_of("\t"), 2),
    ("r.dat", "whitespace", "  ".join(HEADER) + "\n" + lines_of("   "), 2),
])  # fmt: skip
@pytest.mark.parametrize("packed", [False, True])
def test_text_tables(
    tmp_path: Path, *, file: str, delimiter: str, text: str, first_line: int, packed: bool
) -> None:
    name = file + ".gz" if packed else file
    content = text.encode()
    (tmp_path / name).write_bytes(gzip.compress(content) if packed else content)
    record = read(tmp_path, rig_text(name, f'delimiter = "{delimiter}"'))
    check_expected(record)
    assert record.first_line == first_line


def test_a_table_without_header_takes_the_names_of_the_rig_file(tmp_path: Path) -> None:
    (tmp_path / "r.csv.gz").write_bytes(gzip.compress(lines_of("\t").encode()))
    record = read(tmp_path, rig_text("r.csv.gz", f'delimiter = "whitespace"\ncolumns = {HEADER}'))
    check_expected(record)
    assert (record.name, record.role, record.first_line) == ("r", "identify", 1)


def test_older_encodings_are_read(tmp_path: Path) -> None:
    header = ",".join([*HEADER, "Temperatur [°C]"]) + "\n"
    text = header + lines_of(",", end=",20\n")
    for encoding in ("latin-1", "utf-16"):
        (tmp_path / "r.csv").write_bytes(text.encode(encoding))
        check_expected(read(tmp_path, rig_text("r.csv")))


MATLAB_SIGNALS = """
[signals]
time = { column = "t", unit = "ms" }
extension = { column = "log.stroke", unit = "mm", scale = -1, offset = "40 mm" }
chamber_pressure_lower = { column = "log.p", unit = "bar", gauge = true }
rod_force = { column = "F", unit = "kN" }
"""


def test_matlab_vectors_and_structures(tmp_path: Path) -> None:
    scipy.io.savemat(
        tmp_path / "r.mat",
        {
            "t": TABLE[:, [0]],
            "log": {"stroke": TABLE[:, 1], "p": TABLE[:, 3], "comment": "morning"},
            "F": TABLE[:, 4],
            "gain": 3.0,
            "calibration": np.eye(2),
        },
    )
    check_expected(read(tmp_path, rig_text("r.mat", signals=MATLAB_SIGNALS)))


def test_a_matlab_matrix_takes_the_names_of_the_rig_file(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "r.mat", {"data": TABLE, "other": np.eye(3)})
    check_expected(read(tmp_path, rig_text("r.mat", f"columns = {HEADER}")))
    scipy.io.savemat(tmp_path / "r.mat", {"data": TABLE, "again": TABLE})
    assert "2 matrices with 5 columns" in failure(
        tmp_path, rig_text("r.mat", f"columns = {HEADER}")
    )


def test_matlab_vectors_must_be_equally_long(tmp_path: Path) -> None:
    vectors = {"t": TABLE[:, 0], "F": TABLE[:2, 4]}
    scipy.io.savemat(
        tmp_path / "r.mat", {**vectors, "log": {"stroke": TABLE[:, 1], "p": TABLE[:, 3]}}
    )
    sentence = failure(tmp_path, rig_text("r.mat", signals=MATLAB_SIGNALS))
    assert "'F'" in sentence
    assert "2 values" in sentence


def test_parquet_is_read_when_pandas_can(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "r.parquet").write_bytes(b"PAR1")
    monkeypatch.setattr(pd, "read_parquet", lambda _: pd.DataFrame(TABLE, columns=HEADER))
    check_expected(read(tmp_path, rig_text("r.parquet")))

    def no_engine(_: Path) -> pd.DataFrame:
        raise ImportError("no engine")

    monkeypatch.setattr(pd, "read_parquet", no_engine)
    assert "pip install pyarrow" in failure(tmp_path, rig_text("r.parquet"))


def test_the_projects_own_columns_need_no_signals_table(tmp_path: Path) -> None:
    signals = healthy_signals() | {"chamber_pressure_upper": np.full(1200, 2e5)}
    rig = load_rig(write_rig(tmp_path, signals=signals))
    one, two = (load_record(rig, source) for source in rig.records)
    assert set(one.signals) == set(signals)
    assert "chamber_pressure_upper" not in two.signals  # optional: may be absent
    assert one.gauge == frozenset()
    for signal, values in signals.items():
        np.testing.assert_allclose(one.signals[signal], values, rtol=1e-14, err_msg=signal)


@pytest.mark.parametrize(("old", "new", "words"), [
    ('"stroke"', '"strok"', ["no column 'strok'", "'extension'", "did you mean 'stroke'?"]),
    ('"pressure [bar]"', '"pressure"', ["2 columns are named 'pressure'", "pressure [V]"]),
    ('"pressure [bar]"', '"pressure [V]"',
     ["column 'pressure [V]'", "'chamber_pressure_lower'", "'V' does not fit", "'Pa'"]),
    ('column = "F", unit = "kN"', 'column = "F"', ["'F'", "has no unit", "'F [N]'"]),
    ('unit = "kN"', 'unit = "kg"', ["'rod_force'", "'kg' does not fit", "'N'"]),
    ('unit = "kN"', 'unit = "kNn"', ["'kNn' is not a unit", "did you mean 'kN'?"]),
])  # fmt: skip
def test_a_wrong_column_or_unit_is_said(
    tmp_path: Path, old: str, new: str, words: list[str]
) -> None:
    (tmp_path / "r.csv").write_text(",".join(HEADER) + "\n" + lines_of(","))
    assert old in FOREIGN
    sentence = failure(tmp_path, rig_text("r.csv", signals=FOREIGN.replace(old, new)))
    for word in [str(tmp_path / "r.csv"), *words]:
        assert word in sentence


def test_two_columns_of_one_name_need_a_name_each(tmp_path: Path) -> None:
    twice = [HEADER[1] if name == HEADER[2] else name for name in HEADER]
    (tmp_path / "r.csv").write_text(",".join(twice) + "\n" + lines_of(","))
    sentence = failure(tmp_path, rig_text("r.csv", signals=FOREIGN))
    assert "2 columns are named 'stroke'; give each a name of its own" in sentence


GOOD = ",".join(HEADER) + "\n" + lines_of(",")


@pytest.mark.parametrize(("file", "content", "data", "words"), [
    ("r.csv", b"", "", ["the file is empty"]),
    ("r.csv", b"\n \n# nothing\n", "", ["the file is empty"]),
    ("r.csv", b"a,b\n", "", ["no data below"]),
    ("r.csv", b"just text\n", "", ["line 1", "one column only"]),
    ("r.csv", b"0;1;2\n", "columns = ['a', 'b', 'c']", ['delimiter = "semicolon"']),
    ("r.csv", lines_of(",").encode(), "", ["line 1", "no header line", "columns = [...]"]),
    ("r.csv", GOOD.encode(), "columns = ['a', 'b']", ["line 1", "remove columns"]),
    ("r.csv", lines_of(",").encode(), "columns = ['a', 'b']", ["5 columns, but 2 names"]),
    ("r.csv", GOOD.encode(), 'delimiter = "tab"', ["by tab", 'delimiter = "comma"']),
    ("r.csv", (GOOD + "1,2,3,4,5,6,7\n").encode(), "", ["line 5", "7 cells, but 5"]),
    ("r.csv.gz", b"not gzip", "", ["gzip", "copy it again"]),
    ("r.csv.gz", gzip.compress(GOOD.encode(), mtime=0)[:-9], "", ["cut-off gzip"]),
    ("r.mat", b"not MATLAB at all", "", ["not a readable .mat"]),
    ("r.mat", b"MATLAB 7.3 MAT-file" + b" " * 105 + b"\x00\x02IM" + b"\0" * 400, "",
     ["not a readable .mat"]),
    ("r.parquet", b"", "", ["r.parquet"]),
    ("r.xlsx", b"PK", "", ["'.xlsx' are not read", ".csv"]),
    ("r.csv", b"Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2\n1,00000123,false,Rx,0,2,11,22\n", "",
     ["frames of a bus", ".blf"]),
    ("r.csv", b"TimestampEpoch;BusChannel;ID;DLC;DataBytes\n1.5;1;211;2;1122\n", 'delimiter = "semicolon"',
     ["frames of a bus", "hexadecimal"]),
    ("r.csv", b"Timestamp;Type;ID;Data\n1.5;0;123;1122\n", 'delimiter = "semicolon"', ["frames of a bus"]),
])  # fmt: skip
def test_a_file_that_is_no_record_is_said(
    tmp_path: Path, file: str, content: bytes, data: str, words: list[str]
) -> None:
    (tmp_path / file).write_bytes(content)
    sentence = failure(tmp_path, rig_text(file, data))
    for word in [str(tmp_path / file), *words]:
        assert word in sentence


def test_columns_that_are_no_frames_are_a_table(tmp_path: Path) -> None:
    for header in ("id,x,y", "time,data,y", "time,d1,d2"):
        (tmp_path / "r.csv").write_text(f"{header}\n1,2,3\n")
        assert read_table(tmp_path / "r.csv", "comma", None).names == tuple(header.split(","))


def test_a_matlab_file_without_vectors(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "r.mat", {"comment": "morning"})
    assert "no vector of numbers" in failure(tmp_path, rig_text("r.mat"))


@pytest.mark.parametrize(("cell", "said"), [
    ("NaN", "'NaN' is not a number"),
    ("inf", "'inf' is not a number"),
    ("", "the cell is empty"),
    ("n/a", "'n/a' is not a number"),
    ("true", "'true' is not a number"),
])  # fmt: skip
@pytest.mark.parametrize("skip_first", [0, 2])
def test_a_cell_that_is_no_number_is_found_with_its_line(
    tmp_path: Path, cell: str, said: str, skip_first: int
) -> None:
    text = GOOD.replace("10,0.5,", f"10,{cell},")
    (tmp_path / "r.csv").write_text(text)
    record = read(tmp_path, rig_text("r.csv", f"skip_first = {skip_first}"))
    (finding,) = record.findings
    assert finding.severity == ("note" if skip_first else "error")
    assert (finding.file, finding.line, finding.signal) == (
        tmp_path.resolve() / "r.csv",
        3,
        "extension",
    )
    assert finding.message == said
    assert np.isnan(record.signals["extension"]).tolist() == [False, True, False]
    for word in ("r.csv", "line 3", "extension", said, finding.remedy):
        assert word in str(finding)


def test_a_line_that_ends_early(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text(GOOD.rpartition(",")[0])
    (finding,) = read(tmp_path, rig_text("r.csv")).findings
    assert (finding.line, finding.signal, finding.message) == (4, "rod_force", "the cell is empty")


@pytest.mark.parametrize("name", ["semicolon", "tab"])
def test_decimal_commas_are_read_where_commas_separate_nothing(tmp_path: Path, name: str) -> None:
    separator = {"semicolon": ";", "tab": "\t"}[name]
    (tmp_path / "r.csv").write_text(GOOD.replace(",", separator).replace(".", ","))
    check_expected(read(tmp_path, rig_text("r.csv", f'delimiter = "{name}"')))


def test_one_number_written_otherwise_is_said(tmp_path: Path) -> None:
    """Decimal points, and one comma: which of both is meant is not for us to guess."""
    (tmp_path / "r.csv").write_text(GOOD.replace(",", ";").replace("3.1", "3,1"))
    findings = read(tmp_path, rig_text("r.csv", 'delimiter = "semicolon"')).findings
    assert "'3,1' is not a number" in "".join(f.message for f in findings)
    assert all("decimal point" in finding.remedy for finding in findings)


def test_a_packed_file_is_unpacked_as_far_as_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sms.io.table_files.LARGEST_TEXT", 2**20)
    with gzip.open(tmp_path / "r.csv.gz", "wb") as packed:
        for _ in range(64):
            packed.write(bytes(2**20))
    assert "more than 1 MiB of text" in failure(tmp_path, rig_text("r.csv.gz"))


def test_columns_that_are_not_used_may_hold_anything(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text(GOOD.replace("9.9", "open"))
    check_expected(read(tmp_path, rig_text("r.csv")))


def test_random_numbers_survive_writing_and_reading(tmp_path: Path) -> None:
    signals: dict[str, Array] = healthy_signals()
    rig = load_rig(write_rig(tmp_path, PLAIN_RIG, signals))
    record = load_record(rig, rig.records[0])
    for signal, values in signals.items():
        np.testing.assert_allclose(record.signals[signal], values, rtol=1e-15, err_msg=signal)
