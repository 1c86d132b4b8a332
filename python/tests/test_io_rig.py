"""The rig file: what it says, what is missing or misspelt, and where the data is looked up."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from io_support import PARAMETERS, PLAIN_RIG, RECORDS, write_rig
from sms.io import Declaration, InputError, SignalSource, load_rig
from sms.io.schema import RigFile, parse_rig_text
from sms.io.toml_tables import keys_of
from sms.parameters import PARAMETERS as TABLE

SIGNALS = """
[signals]
time = "t"
extension = { column = "stroke", scale = -1, offset = "40 mm" }
chamber_pressure_lower = { column = "p [bar]", gauge = true }
rod_force = { column = "F", unit = "kN" }
"""
WITH_SIGNALS = '[rig]\nkind = "cylinder"\n' + SIGNALS + PARAMETERS + RECORDS


def failure(path: Path) -> str:
    """The sentence with which reading this rig file ends."""
    with pytest.raises(InputError) as caught:
        load_rig(path)
    return str(caught.value)


def test_a_plain_rig_file_is_read_in_si(tmp_path: Path) -> None:
    rig = load_rig(str(write_rig(tmp_path)))
    assert (rig.kind, rig.title, rig.skip_first, rig.speed_above) == ("cylinder", "rig", 0, None)
    assert [(r.name, r.role, r.file.name) for r in rig.records] == [
        ("one", "identify", "one.csv"),
        ("two", "validate", "two.csv"),
    ]
    assert all(record.file.is_absolute() for record in rig.records)
    assert rig.parameters["bore_diameter"].uncertainty == pytest.approx(2e-5)
    assert rig.parameters["coulomb_force"] == Declaration(
        5.0, TABLE["coulomb_force"].uncertainty, True
    )
    assert rig.parameters["stroke"].uncertainty == TABLE["stroke"].uncertainty
    assert set(rig.signals) == {
        *("time", "extension", "chamber_pressure_lower", "chamber_pressure_upper", "rod_force")
    }
    assert rig.signals["extension"].column == "extension [m]"
    assert [name for name, source in rig.signals.items() if source.optional] == [
        "chamber_pressure_upper"
    ]


def test_what_is_not_declared_comes_from_the_parameter_table(tmp_path: Path) -> None:
    rig = load_rig(write_rig(tmp_path))
    assert rig.declared("bore_diameter").value == 0.025
    mass = TABLE["moving_mass"]
    assert rig.declared("moving_mass") == Declaration(mass.default, mass.uncertainty, False)
    with pytest.raises(KeyError, match="did you mean 'moving_mass'"):
        rig.declared("moving_maas")


def test_signals_and_data_are_read_in_si(tmp_path: Path) -> None:
    data = '[data]\nskip_first = 15\nspeed_above = "4 mm/s"\ndelimiter = "tab"\ncolumns = ["a"]\n'
    rig = load_rig(write_rig(tmp_path, data + WITH_SIGNALS))
    assert rig.skip_first == 15
    assert rig.speed_above == pytest.approx(0.004)
    assert (rig.layout.delimiter, rig.layout.columns) == ("tab", ("a",))
    assert rig.signals["time"] == SignalSource("time", "t")
    assert (rig.signals["extension"].column, rig.signals["extension"].scale) == ("stroke", -1.0)
    assert rig.signals["extension"].offset == pytest.approx(0.04)
    assert rig.signals["chamber_pressure_lower"].gauge
    assert rig.signals["rod_force"].unit == "kN"


@pytest.mark.parametrize(("old", "new", "words"), [
    # misspelt keys and words: the nearest right one is said
    ("kind =", "knid =", ["[rig]", "'knid'", "did you mean 'kind'?"]),
    ('"cylinder"', '"cylindre"', ["[rig] kind", "'cylindre'", "did you mean 'cylinder'?"]),
    ("[parameters]", "[parametres]", ["[parametres]", "did you mean 'parameters'?"]),
    ("[[records]]", "[[recrods]]", ["[recrods]", "did you mean 'records'?"]),
    ("uncertainty =", "uncertanty =",
     ["[parameters] bore_diameter", "'uncertanty'", "did you mean 'uncertainty'?"]),
    ("bore_diameter =", "bore_diametre =", ["[parameters] bore_diametre", "'bore_diameter'?"]),
    ('role = "validate"', 'role = "validation"',
     ["[[records]] number 2, role", "'validation'", "did you mean 'validate'?"]),
    ('file = "two.csv"', 'fiel = "two.csv"',
     ["[[records]] number 2: the key 'fiel' is not known; did you mean 'file'?"]),
    ("[parameters]", "[data]\nskip_frist = 3\n[parameters]", ["[data]", "'skip_first'?"]),
    ("[parameters]", '[data]\ndelimiter = "comas"\n[parameters]',
     ["[data] delimiter", "'comas'", "did you mean 'comma'?"]),
    ("[parameters]", "[signals]\nextention = 's'\n[parameters]",
     ["[signals]", "no signal 'extention'", "did you mean 'extension'?"]),
    ("[parameters]", "[signals.time]\ncolum = 't'\n[parameters]",
     ["[signals] time", "'colum'", "did you mean 'column'?"]),
    ('kind = "cylinder"', 'kind = "cylinder"\nskip_first = 3', ["[rig]", "move it to [data]"]),
    # missing
    ('kind = "cylinder"', "", ["[rig]", "'kind' is missing"]),
    ('role = "validate"', "", ["[[records]] number 2", "'role' is missing"]),
    ('[rig]\nkind = "cylinder"', "", ["the table [rig] is missing"]),
    ("[parameters]", "[signals]\ntime = 't'\n[parameters]", ["[signals]", "'extension' is needed"]),
    # wrong kind of value
    ('"25 mm"', "true", ["[parameters] bore_diameter.value", '"25 mm"']),
    ("fit = true", 'fit = "yes"', ["[parameters] coulomb_force.fit", "true or false"]),
    ("[parameters]", '[data]\nskip_first = "15"\n[parameters]', ["skip_first", "whole number"]),
    ("[parameters]", "[data]\nskip_first = -1\n[parameters]", ["skip_first", "not be negative"]),
    ("[parameters]", "[data]\ncolumns = []\n[parameters]", ["columns", "not be empty"]),
    ("[parameters]", "[data]\ncolumns = 'time'\n[parameters]", ["columns", "list in brackets"]),
    ("[parameters]", "[signals]\ntime = 3\n[parameters]", ["[signals] time", "text in quotes"]),
    # wrong unit, out of bounds, no sense
    ('"25 mm"', '"25 kg"', ["[parameters] bore_diameter", "'kg' does not fit", "'m'"]),
    ('"25 mm"', '"25"', ["[parameters] bore_diameter", "has no unit"]),
    ('"25 mm"', '"25 m"', ["[parameters] bore_diameter", "25 m is outside", "0.001 to 1 m"]),
    ('"0.02 mm"', '"-0.02 mm"', ["bore_diameter", "uncertainty is not negative"]),
    ('"0.02 mm"', '"0.02 N"', ["bore_diameter, uncertainty", "'N' does not fit"]),
    ("[parameters]", '[data]\nspeed_above = "4 mm"\n[parameters]', ["speed_above", "'m/s'"]),
    ("[parameters]", '[data]\nspeed_above = "-4 mm/s"\n[parameters]', ["not negative"]),
    ('file = "two.csv"', 'file = "one.csv"', ["'one.csv' is listed twice"]),
    ('file = "two.csv"', 'file = "two.csv"\nname = "one"', ["two records have the name 'one'"]),
    ("[parameters]", '[parameters]\nrod_diameter = "25 mm"',
     ["a rod of 25 mm does not go into a bore of 25 mm"]),
    # numbers that nothing can be calculated with
    ('"0.02 mm"', "nan", ["bore_diameter.uncertainty", "must be a finite number"]),
    ('"0.02 mm"', "1" + 400 * "0", ["bore_diameter.uncertainty", "must be a finite number"]),
    ('"0.02 mm"', '"1e-320 m"', ["bore_diameter", "write 0 where the value is known exactly"]),
    ('"0.02 mm"', '"1e308 m"', ["bore_diameter", "wider than the whole allowed range, 0.001 to 1 m"]),
    ('"25 mm"', 5000 * "9", ["a number in it has thousands of digits"]),
    ("[parameters]", f"x = {999 * '['}{999 * ']'}\n[parameters]", ["nested hundreds deep"]),
    # names that no file can have
    ('file = "two.csv"', 'file = "~nosuchuser/two.csv"', ["number 2, file", "cannot be a path"]),
    ('file = "two.csv"', r'file = "a\u0000.csv"', ["number 2, file", r"'a\x00.csv' cannot be a path"]),
    ('file = "two.csv"', f'file = "{300 * "a"}"', ["number 2, file", "there is no file"]),
    ('file = "two.csv"', 'file = "/"', ["number 2, file", "there is no file '/'"]),
    # not TOML
    ("[rig]", "[rig", ["not valid TOML", "line 1"]),
])  # fmt: skip
def test_a_mistake_is_said_with_its_place(
    tmp_path: Path, old: str, new: str, words: list[str]
) -> None:
    assert old in PLAIN_RIG
    path = write_rig(tmp_path, PLAIN_RIG.replace(old, new))
    sentence = failure(path)
    for word in [str(path), *words]:
        assert word in sentence
    assert "\n" not in sentence


@pytest.mark.parametrize(("old", "new", "words"), [
    ("offset = \"40 mm\"", 'offset = "40 N"', ["[signals] extension, offset", "'N' does not fit"]),
    ("offset = \"40 mm\"", "offset = 40", ["[signals] extension, offset", "has no unit"]),
    ('time = "t"', 'time = { column = "t", gauge = true }', ["[signals] time", "only a pressure"]),
    ("scale = -1", "scale = 0", ["[signals] extension", "scale = 0"]),
    ("scale = -1", 'scale = "-1"', ["[signals] extension.scale", "without quotes"]),
    ('rod_force = { column = "F", unit = "kN" }', "", ["'rod_force' is needed"]),
])  # fmt: skip
def test_a_mistake_among_the_signals_is_said(
    tmp_path: Path, old: str, new: str, words: list[str]
) -> None:
    assert old in WITH_SIGNALS
    sentence = failure(write_rig(tmp_path, WITH_SIGNALS.replace(old, new)))
    for word in ["rig.toml", *words]:
        assert word in sentence


def test_single_brackets_around_records_are_explained(tmp_path: Path) -> None:
    one = '[rig]\nkind = "cylinder"\n[records]\nfile = "one.csv"\nrole = "identify"\n'
    assert "write [[records]] with double brackets" in failure(write_rig(tmp_path, one))


def test_a_missing_an_empty_and_a_binary_rig_file(tmp_path: Path) -> None:
    assert f"{tmp_path / 'no.toml'}: there is no such rig file" in failure(tmp_path / "no.toml")
    assert "cannot be read" in failure(tmp_path)
    empty = tmp_path / "empty.toml"
    empty.write_text("\n \n")
    assert f"{empty}: the rig file is empty" in failure(empty)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00\x80")
    assert "not a text file" in failure(tmp_path / "binary.toml")


def test_several_mistakes_are_counted(tmp_path: Path) -> None:
    text = PLAIN_RIG.replace("uncertainty", "uncertanty").replace("role", "rule")
    assert "more in this file)" in failure(write_rig(tmp_path, text))


class TestWhereTheDataIs:
    """A relative data path: under $SMS_DATA, else beside the rig file, else ../shared/data."""

    TEXT = '[data]\nfolder = "bench"\nobtain = "the archive of the bench"\n' + PLAIN_RIG

    @pytest.fixture
    def places(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Path]:
        rigs, checkout = tmp_path / "rigs", tmp_path / "checkout"
        rigs.mkdir()
        checkout.mkdir()
        monkeypatch.chdir(checkout)
        monkeypatch.setenv("SMS_DATA", str(tmp_path / "data"))
        (rigs / "rig.toml").write_text(self.TEXT)
        return {
            "named": tmp_path / "data" / "bench",
            "beside": rigs / "bench",
            "shared": tmp_path / "shared" / "data" / "bench",
            "rig": rigs / "rig.toml",
        }

    def test_the_order_of_the_places(self, places: dict[str, Path]) -> None:
        for name in ("shared", "beside", "named"):  # each one found hides the one before
            places[name].mkdir(parents=True)
            write_rig(places[name])
            assert load_rig(places["rig"]).records[0].file == places[name].resolve() / "one.csv"

    def test_all_records_come_from_one_place(self, places: dict[str, Path]) -> None:
        for name in ("named", "shared"):
            places[name].mkdir(parents=True)
            write_rig(places[name])
        (places["named"] / "two.csv").unlink()
        files = [record.file for record in load_rig(places["rig"]).records]
        assert [file.parent for file in files] == [places["shared"].resolve()] * 2

    def test_nowhere(self, places: dict[str, Path]) -> None:
        sentence = failure(places["rig"])
        assert "'bench' is nowhere" in sentence
        for name in ("named", "beside", "shared"):
            assert str(places[name].resolve()) in sentence
        assert "the archive of the bench" in sentence
        assert "SMS_DATA" in sentence

    def test_one_file_is_missing(self, places: dict[str, Path]) -> None:
        places["beside"].mkdir(parents=True)
        write_rig(places["beside"])
        (places["beside"] / "two.csv").rename(places["beside"] / "twoo.csv")
        sentence = failure(places["rig"])
        assert "[[records]] number 2, file: there is no file 'two.csv'" in sentence
        assert "did you mean 'twoo.csv'?" in sentence

    def test_an_absolute_folder_is_looked_up_nowhere_else(
        self, places: dict[str, Path], tmp_path: Path
    ) -> None:
        write_rig(tmp_path)
        text = self.TEXT.replace('"bench"', f"'{tmp_path}'")
        places["rig"].write_text(text)
        assert load_rig(places["rig"]).records[0].file == tmp_path.resolve() / "one.csv"
        places["rig"].write_text(text.replace(str(tmp_path), str(tmp_path / "gone")))
        assert f"(looked in: {tmp_path / 'gone'})" in failure(places["rig"])

    def test_without_a_folder_records_lie_beside_the_rig_file(self, tmp_path: Path) -> None:
        path = write_rig(tmp_path)
        assert load_rig(path).records[0].file == tmp_path.resolve() / "one.csv"
        (tmp_path / "one.csv").unlink()
        assert "there is no file 'one.csv'" in failure(path)
        (tmp_path / "two.csv").unlink()
        assert "the record 'one.csv' is nowhere" in failure(path)

    def test_a_packed_record_is_also_found_unpacked(self, tmp_path: Path) -> None:
        path = write_rig(tmp_path, PLAIN_RIG.replace("two.csv", "two.csv.gz"))
        record = load_rig(path).records[1]
        assert (record.name, record.file.name) == ("two", "two.csv")


def test_the_hold_of_a_command_is_one_of_three_words_and_of_a_command_only(tmp_path: Path) -> None:
    wrong = WITH_SIGNALS.replace("scale = -1", 'scale = -1, hold = "nxt"')
    assert failure(write_rig(tmp_path, wrong)).endswith("known are: previous, linear, stepped")
    other = WITH_SIGNALS.replace("scale = -1", 'scale = -1, hold = "linear"')
    assert "only a valve command can have a hold" in failure(write_rig(tmp_path, other))


def test_every_key_is_on_the_page_of_the_rig_file() -> None:
    """In the row of its table; what the rows of a table hold is a key of it."""
    page = (Path(__file__).parents[2] / "docs" / "rig_file.md").read_text(encoding="utf-8")
    said: dict[str, set[str]] = {}
    table = ""
    for line in page.splitlines():
        cells = line.split("|")[1:3]
        if line.startswith("|") and "`" in cells[1]:
            table = cells[0].strip(" `[]") or table
            said.setdefault(table, set()).update(re.findall(r"`(\w+)`", cells[1]))
    assert said == {name: set(keys) for name, keys in keys_of(RigFile).items()}


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("2026-11-25", "2026-11-25"),
        ("2026-11-25T10:30:00", "2026-11-25T10:30:00"),
        ("2026-11-25T10:30:00+01:00", "2026-11-25T10:30:00+01:00"),
    ],
)
def test_a_rig_file_says_when_its_records_were_measured(
    tmp_path: Path, written: str, read: str
) -> None:
    text = PLAIN_RIG.replace("[rig]", f"[rig]\nmeasured = {written}")
    assert parse_rig_text(text, tmp_path / "rig.toml").rig.measured.isoformat() == read  # type: ignore[union-attr]


@pytest.mark.parametrize("written", ['"2026-11-25"', "5", "10:00:00"])
def test_what_is_no_date_is_refused(tmp_path: Path, written: str) -> None:
    text = PLAIN_RIG.replace("[rig]", f"[rig]\nmeasured = {written}")
    with pytest.raises(InputError, match=r"\[rig\] measured: must be a date without quotes"):
        parse_rig_text(text, tmp_path / "rig.toml")
