"""`sms new`: rig files from records with foreign headers and units, and one sentence for what cannot be told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from cli_support import sms
from io_support import healthy_signals
from numpy.typing import NDArray
from sms.diagnosis import diagnose
from sms.diagnosis.pipeline import read_and_check
from sms.draft import Given, Question, draft_rig, read_columns
from sms.draft.header import header_of
from sms.io import load_rig

FOREIGN = Path(__file__).parents[3] / "shared" / "foreign"
needs_foreign = pytest.mark.skipif(
    not FOREIGN.is_dir(), reason=f"the foreign records are not at hand (looked in {FOREIGN})"
)
Array = NDArray[np.float64]


def bench(folder: Path, name: str, **renamed: str) -> Path:
    """A record of a bench, its columns in SI and named as asked: valve_command="u [V]"."""
    time = 0.005 * np.arange(2000.0)
    wave = np.sin(2.0 * np.pi * time)
    columns = {
        "time": time,
        "valve_command": 5.0 + 1.5 * np.cos(2.0 * np.pi * time),
        "extension": 0.2 + 0.05 * wave,
        "chamber_pressure_lower": 3e5 + 5e4 * wave,
        "chamber_pressure_upper": 3e5 - 5e4 * wave,
    }
    names = {signal: renamed.get(signal, signal) for signal in columns}
    pd.DataFrame(columns).rename(columns=names).to_csv(folder / name, index=False)
    return folder / name


NAMED = {
    "time": "t [s]",
    "valve_command": "u [V]",
    "extension": "pos [m]",
    "chamber_pressure_lower": "p1 [Pa abs]",
    "chamber_pressure_upper": "p2 [Pa abs]",
}


def two(folder: Path, **renamed: str) -> list[Path]:
    return [bench(folder, f"{name}.csv", **{**NAMED, **renamed}) for name in ("one", "two")]


def written(folder: Path, *arguments: str) -> str:
    """What `sms new` says, of a file that `sms diagnose` reads."""
    result = sms("new", *arguments, cwd=folder)
    assert result.returncode == 0, result.stderr
    path = folder / "rig.toml"
    assert path.read_text().startswith("#:schema ./rig.schema.json\n")
    assert (folder / "rig.schema.json").is_file()
    read_and_check(load_rig(path))
    return result.stdout


def refused(folder: Path, *arguments: str) -> str:
    """The one sentence with which `sms new` refuses, leaving no file."""
    result = sms("new", *arguments, cwd=folder)
    assert result.returncode == 2, result.stdout
    assert len(result.stderr.splitlines()) == 1
    assert not (folder / "rig.toml").exists()
    return result.stderr


# ---- from foreign records --------------------------------------------------------------------------


def foreign(
    folder: Path, files: list[Path], columns: dict[str, tuple[str, float, float]], **style: str
) -> list[str]:
    """Records with columns renamed, scaled and shifted: "pos_mm" <- ("extension [m]", 1e3, 0)."""
    names = []
    for number, file in enumerate(files):
        table = pd.read_csv(file)
        renamed = {
            new: (table[old] + shift) * factor for new, (old, factor, shift) in columns.items()
        }
        names.append(f"run{number}.csv")
        pd.DataFrame(renamed).to_csv(folder / names[-1], index=False, **style)  # type: ignore[call-overload]
    return names


def foreign_bench(folder: Path) -> list[str]:
    files = [FOREIGN / "set01" / f"set01_bench_{n}.csv.gz" for n in ("sine", "chirp", "aprbs")]
    columns = {
        "t (ms)": ("time [s]", 1e3, 0.0),
        "u": ("valve_command [V]", 1.0, 0.0),
        "x_soll": ("setpoint [m]", 1e3, 0.0),
        "pos_mm": ("extension [m]", 1e3, 0.0),
        "pA [bara]": ("p_lower [Pa abs]", 1e-5, 0.0),
        "pB [bara]": ("p_upper [Pa abs]", 1e-5, 0.0),
        "p_line [bara]": ("p_supply [Pa abs]", 1e-5, 0.0),
    }
    return foreign(folder, files, columns, sep=";", decimal=",")


@needs_foreign
def test_a_foreign_bench(tmp_path: Path) -> None:
    names = foreign_bench(tmp_path)
    assert '--offset extension="200 mm"' in refused(tmp_path, "bench", *names)
    said = written(tmp_path, "bench", *names, "--offset", "extension=200 mm")
    assert "not used: 'x_soll'" in said
    assert "validate: run2.csv (the last ones" in said
    rig = load_rig(tmp_path / "rig.toml")
    assert [record.role for record in rig.records] == ["identify", "identify", "validate"]
    assert rig.signals["chamber_pressure_lower"].column == "pA [bara]"
    assert rig.signals["extension"].offset == pytest.approx(0.2)
    assert not any(source.gauge for source in rig.signals.values())
    offset = ("--offset", "extension=200 mm", "--force")
    said = written(tmp_path, "bench", *names, *offset, "--scale", "time=1.1")
    assert "- run0.csv, time: one sample in" in said and "scale = 1 in [signals] time" in said


@pytest.mark.full
@needs_foreign
def test_a_foreign_bench_is_diagnosed(tmp_path: Path) -> None:
    written(tmp_path, "bench", *foreign_bench(tmp_path), "--yes")
    assert diagnose(tmp_path / "rig.toml").verdict


@needs_foreign
def test_a_foreign_platform(tmp_path: Path) -> None:
    files = [FOREIGN / "set10" / f"set10_platform_{n}.csv.gz" for n in ("roll", "aprbs")]
    columns = {"Zeit [ms]": ("time [s]", 1e3, 0.0), "ps": ("p_supply [Pa abs]", 1e-3, 0.0)}
    for leg in (1, 2, 3):
        columns |= {
            f"u{leg - 1} [V]": (f"valve_command_{leg} [V]", 1.0, -5.0),
            f"x{leg - 1} (cm)": (f"extension_{leg} [m]", 1e2, 0.2),
            f"pa{leg - 1}": (f"p_lower_{leg} [Pa abs]", 1e-3, 0.0),
            f"pb{leg - 1}": (f"p_upper_{leg} [Pa abs]", 1e-3, 0.0),
        }
    names = foreign(tmp_path, files, columns)
    assert "--offset valve_command=" in refused(
        tmp_path, "platform", *names, "--pressures", "absolute"
    )
    said = written(
        tmp_path, "platform", *names, "--pressures", "absolute", "--offset", "valve_command=5 V"
    )
    assert "doubtful" not in said
    rig = load_rig(tmp_path / "rig.toml")
    for leg in (1, 2, 3):
        assert rig.signals[f"extension_{leg}"].column == f"x{leg - 1} (cm)"
        assert rig.signals[f"chamber_pressure_upper_{leg}"].unit == "kPa"
        assert rig.signals[f"valve_command_{leg}"].offset == 5.0


@needs_foreign
def test_a_foreign_tank_whose_sensors_read_against_ambient(tmp_path: Path) -> None:
    files = [FOREIGN / "set11" / f"{n}charge_400kPa_0.50mm.csv" for n in ("", "dis")]
    columns = {
        "t": ("time [s]", 1.0, 0.0),
        "voltage": ("valve_command [V]", 1.0, 0.0),
        "p vessel": ("tank_pressure [Pa]", 1e-5, -86e3),
        "p line": ("supply_pressure [Pa]", 1e-5, -86e3),
    }
    names = foreign(tmp_path, files, columns, sep="\t")
    said = " ".join(written(tmp_path, "tank", *names).split())
    assert "gauge: down to 0.10 bar" in said and "the air outside is taken to have" in said
    ambient = ("--force", "--parameter", "ambient_pressure=86 kPa")
    assert "the air outside" not in written(tmp_path, "tank", *names, *ambient)
    rig = load_rig(tmp_path / "rig.toml")
    assert rig.signals["tank_pressure"].gauge and rig.signals["supply_pressure"].gauge
    assert rig.signals["tank_pressure"].unit == "bar"


# ---- of any records --------------------------------------------------------------------------------


def test_a_cylinder(tmp_path: Path) -> None:
    for name in ("a", "b"):
        of = healthy_signals()
        table = {
            "Zeit": of["time"],
            "Weg [mm]": 1e3 * of["extension"],
            "Kraft [N]": of["rod_force"],
        }
        table["Druck [mbar abs]"] = 1e-2 * of["chamber_pressure_lower"]
        pd.DataFrame(table).to_csv(tmp_path / f"{name}.csv", index=False)
    said = written(tmp_path, "cylinder", "a.csv", "b.csv", "--parameter", "stroke=40 mm")
    assert "rod_force" in said
    rig = load_rig(tmp_path / "rig.toml")
    assert rig.declared("stroke").value == 0.04
    assert rig.signals["chamber_pressure_lower"].column == "Druck [mbar abs]"


def test_options_say_what_no_header_tells(tmp_path: Path) -> None:
    two(tmp_path, extension="channel 7", valve_command="channel 9 [V]")
    files = ("one.csv", "two.csv")
    assert "--column extension=" in refused(tmp_path, "bench", *files, "--yes")
    options = ("--column", "extension=channel 7", "--unit", "extension=m")
    assert "--column valve_command=" in refused(tmp_path, "bench", *files, *options)
    written(tmp_path, "bench", *files, *options, "--column", "valve_command=channel 9")


def test_files_without_a_header_line(tmp_path: Path) -> None:
    for path in two(tmp_path):
        path.write_text("".join(path.read_text().splitlines(keepends=True)[1:]))
    assert '--names "time [s],u [V],..."' in refused(tmp_path, "bench", "one.csv", "two.csv")
    written(tmp_path, "bench", "one.csv", "two.csv", "--names", ",".join(NAMED.values()))


def test_a_file_is_overwritten_only_when_asked(tmp_path: Path) -> None:
    two(tmp_path)
    written(tmp_path, "bench", "one.csv", "two.csv")
    (tmp_path / "rig.toml").write_text("mine")
    again = sms("new", "bench", "one.csv", "two.csv", cwd=tmp_path)
    assert again.returncode == 2 and "--force" in again.stderr
    assert (tmp_path / "rig.toml").read_text() == "mine"
    written(tmp_path, "bench", "one.csv", "two.csv", "--force")


def test_what_is_doubtful_is_a_question_with_a_suggestion(tmp_path: Path) -> None:
    columns = read_columns(
        two(tmp_path, chamber_pressure_lower="p1 [Pa]", chamber_pressure_upper="p2 [Pa]"), None
    )
    with pytest.raises(Question) as asked:
        draft_rig(columns, "bench", tmp_path / "rig.toml", Given())
    assert (asked.value.subject, asked.value.suggestion) == ("pressures", "absolute")
    answered = Given().with_answer(asked.value.subject, asked.value.name, "gauge")
    assert (
        draft_rig(columns, "bench", tmp_path / "rig.toml", answered).text.count("gauge = true }")
        == 2
    )


@pytest.mark.parametrize(
    ("renamed", "arguments", "sentence"),
    [
        ({"time": "channel 1 [V]"}, (), "no column can be told to be the time"),
        (
            {"chamber_pressure_upper": "position 2 [m]"},
            (),
            "'pos [m]' and 'position 2 [m]' can both be",
        ),
        ({}, ("--column", "extenson=pos"), "did you mean 'extension'?"),
        ({}, ("--column", "extension=posi"), "did you mean 'pos'?"),
        ({}, ("--unit", "extension=bar"), "not a unit like 'm'"),
        ({}, ("--validate", "2"), "of 2 records write 1 to 1"),
        ({}, ("--unit", "extension"), "write NAME=VALUE"),
        ({}, ("--parameter", "strok=1 m"), "did you mean 'stroke'?"),
        ({"time": "t [min]"}, (), "one sample in"),
    ],
)
def test_bad_input_is_one_sentence(
    tmp_path: Path, renamed: dict[str, str], arguments: tuple[str, ...], sentence: str
) -> None:
    two(tmp_path, **renamed)
    if "time" in renamed and "V" in renamed["time"]:
        for name in ("one.csv", "two.csv"):
            table = pd.read_csv(tmp_path / name)
            table["channel 1 [V]"] = np.sin(np.arange(len(table)))
            table.to_csv(tmp_path / name, index=False)
    assert sentence in refused(tmp_path, "bench", "one.csv", "two.csv", *arguments)


def test_what_is_no_record_is_refused(tmp_path: Path) -> None:
    two(tmp_path)
    (tmp_path / "empty.csv").write_text("")
    assert "is empty" in refused(tmp_path, "bench", "empty.csv", "one.csv")
    assert "there is no such record" in refused(tmp_path, "bench", "one.csv", "three.csv")
    assert "no such kind" in refused(tmp_path, "bank", "one.csv", "two.csv")
    assert "one record only" in refused(tmp_path, "bench", "one.csv")
    assert "given twice" in refused(tmp_path, "bench", "one.csv", "one.csv")


@pytest.mark.parametrize(
    ("column", "name", "unit", "reading"),
    [
        ("pos (mm)", "pos", "mm", None),
        ("p1 / bar", "p1", "bar", None),
        ("time_ms", "time", "ms", None),
        ("p_s", "p_s", None, None),
        ("pA [barg]", "pA", "bar", "gauge"),
        ("p_lower [Pa abs]", "p_lower", "Pa", "absolute"),
        ("Weg in mm", "Weg", "mm", None),
        ("T_tank [°C]", "T_tank", "degC", None),
    ],
)
def test_headers_of_loggers(column: str, name: str, unit: str | None, reading: str | None) -> None:
    found = header_of(column)
    assert (found.name, found.unit, found.reading) == (name, unit, reading)
