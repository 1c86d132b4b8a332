"""Writing: whole files or none, tables that read back, and the rig file extended in place."""

from __future__ import annotations

import gzip
import os
from pathlib import Path

import numpy as np
import pytest
from io_support import PLAIN_RIG, healthy_signals, write_rig
from sms.io import (
    Declaration,
    InputError,
    load_rig,
    write_extended_rig,
    write_record,
    write_table,
    write_text_atomically,
)
from sms.io.declarations import least_uncertainty
from sms.io.write import write_bytes_atomically
from sms.parameters import PARAMETERS

from validation.random_cases import draw


def test_text_is_written_whole_into_a_new_folder(tmp_path: Path) -> None:
    path = tmp_path / "new" / "report.html"
    write_text_atomically(path, "old µ\n")
    write_text_atomically(path, "new µ\n")
    assert path.read_bytes() == "new µ\n".encode()
    assert [file.name for file in path.parent.iterdir()] == ["report.html"]


def test_a_failed_write_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "report.html"
    write_text_atomically(path, "old")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(InputError, match=r"cannot be written .No space left") as caught:
        write_text_atomically(path, "new")
    assert str(path) in str(caught.value)
    assert "another output folder" in str(caught.value)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    path = tmp_path / "file" / "diagnosis.json"
    with pytest.raises(InputError, match="cannot be written") as caught:
        write_text_atomically(path, "{}")
    assert str(path) in str(caught.value)


def test_a_table_reads_back_bit_for_bit(tmp_path: Path) -> None:
    values = draw("table").normal(size=50) * 1e5
    write_table(tmp_path / "t.csv.gz", {"time [s]": np.arange(50), "rod_force [N]": values})
    lines = gzip.decompress((tmp_path / "t.csv.gz").read_bytes()).decode().splitlines()
    assert lines[0] == "time [s],rod_force [N]"
    assert [float(line.split(",")[1]) for line in lines[1:]] == values.tolist()
    first = (tmp_path / "t.csv.gz").read_bytes()
    write_table(tmp_path / "t.csv.gz", {"time [s]": np.arange(50), "rod_force [N]": values})
    assert (tmp_path / "t.csv.gz").read_bytes() == first


def test_a_record_is_written_under_the_projects_names(tmp_path: Path) -> None:
    write_record(tmp_path / "r.csv", healthy_signals())
    header = (tmp_path / "r.csv").read_text().splitlines()[0]
    assert header == "time [s],extension [m],chamber_pressure_lower [Pa],rod_force [N]"


UPDATES = {
    "bore_diameter": Declaration(0.02513, 1e-5),
    "stroke": Declaration(0.041, 0.001),
    "coulomb_force": Declaration(7.25, 0.1),
    "moving_mass": Declaration(0.2, 0.05, fit=True),
}


def test_an_extended_rig_keeps_comments_units_and_all_else(tmp_path: Path) -> None:
    original = write_rig(tmp_path, "# my rig\n" + PLAIN_RIG)
    extended = tmp_path / "out" / "extended.toml"
    write_extended_rig(original, extended, UPDATES, "Extended by the diagnosis.\n\nSeed 7.")
    text = extended.read_text()
    assert text.startswith("# Extended by the diagnosis.\n#\n# Seed 7.\n\n# my rig\n")
    assert "# measured with a gauge" in text
    assert 'bore_diameter = { value = "25.13 mm", uncertainty = "0.01 mm" }' in text
    assert 'stroke = { value = "41 mm", uncertainty = "1 mm" }' in text
    assert 'coulomb_force = { value = "7.25 N", uncertainty = "0.1 N" }' in text
    assert 'moving_mass = { value = "0.2 kg", uncertainty = "0.05 kg", fit = true }' in text
    before, after = load_rig(original), load_rig(extended)
    assert after.records == before.records
    for name, update in UPDATES.items():
        declared = after.parameters[name]
        assert declared.value == pytest.approx(update.value, rel=1e-12)
        assert declared.uncertainty == pytest.approx(update.uncertainty, rel=1e-12)
        assert declared.fit == update.fit
    assert after.parameters["ambient_pressure"] == before.parameters["ambient_pressure"]


def test_an_extended_rig_can_be_extended_again_and_in_place(tmp_path: Path) -> None:
    original = write_rig(tmp_path)
    write_extended_rig(original, tmp_path / "a" / "b" / "e.toml", UPDATES, "first")
    write_extended_rig(tmp_path / "a" / "b" / "e.toml", tmp_path / "c" / "e.toml", {}, "second")
    write_extended_rig(original, original, UPDATES, "in place")
    for path in (tmp_path / "c" / "e.toml", original):
        assert load_rig(path).records == load_rig(tmp_path / "a" / "b" / "e.toml").records


@pytest.mark.parametrize("parameters", [
    "",
    '[parameters]\nbore_diameter = "25 mm"  # caliper\n',
    '[parameters.bore_diameter]\nvalue = "25 mm"  # caliper\nfit = true\n',
    '[parameters]\nbore_diameter.value = "25 mm"  # caliper\n',
    '[parameters]\nbore_diameter = { fit = true }  # caliper\n',
])  # fmt: skip
def test_every_way_to_write_a_parameter_can_be_updated(tmp_path: Path, parameters: str) -> None:
    records = PLAIN_RIG[PLAIN_RIG.index("[[records]]") :]
    for text in (parameters + records, records + parameters):
        original = write_rig(tmp_path, f'[rig]\nkind = "cylinder"\n{text}')
        write_extended_rig(original, tmp_path / "e.toml", UPDATES, "")
        written = load_rig(tmp_path / "e.toml")
        assert written.parameters["bore_diameter"].value == pytest.approx(0.02513, rel=1e-12)
        assert not written.parameters["bore_diameter"].fit
        assert ("caliper" in (tmp_path / "e.toml").read_text()) == bool(parameters)


def test_random_values_of_every_parameter_survive(tmp_path: Path) -> None:
    random = draw("extended")
    updates = {
        name: Declaration(float(random.uniform(p.lower, p.upper)), float(random.uniform(0, 1)))
        for name, p in PARAMETERS.items()
    }
    rod, bore = PARAMETERS["rod_diameter"], updates["bore_diameter"].value
    within = float(random.uniform(rod.lower, min(rod.upper, 0.99 * bore)))
    updates["rod_diameter"] = Declaration(within, 0.01)
    original = write_rig(tmp_path)
    write_extended_rig(original, tmp_path / "e.toml", updates, "all")
    written = load_rig(tmp_path / "e.toml")
    for name, update in updates.items():
        assert written.declared(name).value == pytest.approx(update.value, rel=1e-11), name
        widest = PARAMETERS[name].upper - PARAMETERS[name].lower
        least = (1.0 + 1e-9) * least_uncertainty(PARAMETERS[name])
        expected = max(min(update.uncertainty, widest), least)
        assert written.declared(name).uncertainty == pytest.approx(expected, rel=1e-11), name


def test_a_standard_error_narrower_than_what_is_read_is_written_as_that(tmp_path: Path) -> None:
    """And none as none: the value is known exactly."""
    name, original = "supply_line_turbulence", write_rig(tmp_path)
    least = least_uncertainty(PARAMETERS[name])
    for error, written in ((0.5 * least, least), (2.0 * least, 2.0 * least), (0.0, 0.0)):
        write_extended_rig(original, tmp_path / "e.toml", {name: Declaration(1e9, error)}, "")
        declared = load_rig(tmp_path / "e.toml").declared(name)
        assert declared.uncertainty == pytest.approx(written, rel=2e-9)


def test_data_found_by_sms_data_is_left_as_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "data" / "bench").mkdir(parents=True)
    write_rig(tmp_path / "data" / "bench")
    monkeypatch.setenv("SMS_DATA", str(tmp_path / "data"))
    original = tmp_path / "rig.toml"
    original.write_text(f'[data]\nfolder = "bench"\n{PLAIN_RIG}')
    write_extended_rig(original, tmp_path / "out" / "e.toml", {}, "")
    assert 'folder = "bench"' in (tmp_path / "out" / "e.toml").read_text()
    assert load_rig(tmp_path / "out" / "e.toml").records == load_rig(original).records


@pytest.mark.parametrize(("name", "value", "words"), [
    ("bore_diametre", 0.025, ["bore_diametre", "did you mean 'bore_diameter'?"]),
    ("bore_diameter", 25.0, ["25 m is outside the allowed range"]),
])  # fmt: skip
def test_a_wrong_update_writes_nothing(
    tmp_path: Path, name: str, value: float, words: list[str]
) -> None:
    original = write_rig(tmp_path)
    with pytest.raises(InputError) as caught:
        write_extended_rig(original, tmp_path / "e.toml", {name: Declaration(value, 0.0)}, "")
    for word in words:
        assert word in str(caught.value)
    assert not (tmp_path / "e.toml").exists()


def test_what_is_no_file_is_written_to_and_stays(tmp_path: Path) -> None:
    """Run as root, a table written to /dev/null took its place."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_bytes_atomically(pipe, b"1,2\n")
    assert os.read(reader, 10) == b"1,2\n"
    os.close(reader)
    assert [p.name for p in tmp_path.iterdir()] == ["pipe"]
    write_bytes_atomically(Path("/dev/null"), b"nothing")
    assert Path("/dev/null").is_char_device()
