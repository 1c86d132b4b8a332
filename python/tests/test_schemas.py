"""The JSON schemas say what the models say: of every rig file and scenario of the repository, and of mistakes."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from cli_support import sms
from io_support import PLAIN_RIG
from sms import schemas

ROOT = Path(__file__).resolve().parents[2]
RIGS = sorted(
    [
        *(ROOT / "python/sms/data").glob("*/cylinder_*.toml"),
        *(ROOT / "validation/measured/rigs").glob("*.toml"),
    ]
)
SCENARIOS = sorted(
    [
        *(ROOT / "python/sms/validation/scenarios").glob("*.toml"),
        *(ROOT / "python/sms/data").glob("*/waves_*.toml"),
    ]
)


def faults(subject: schemas.Subject, text: str) -> list[str]:
    validator = jsonschema.Draft202012Validator(json.loads(schemas.shipped(subject)))
    return [error.message for error in validator.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("subject", schemas.SUBJECTS)
def test_what_is_shipped_is_what_the_models_make(subject: schemas.Subject) -> None:
    assert schemas.shipped(subject) == schemas.made(subject), (
        "not current: ./dev docs regenerates it"
    )
    jsonschema.Draft202012Validator.check_schema(json.loads(schemas.shipped(subject)))


def undescribed(table: Mapping[str, Any], schema: Mapping[str, Any]) -> Iterator[str]:
    """Keys of a table, and of those written out inside of it, of which a schema says nothing."""

    def described(entry: Mapping[str, Any]) -> bool:
        if "description" in entry:
            return True
        if "$ref" in entry:
            return described(schema["$defs"][entry["$ref"].rpartition("/")[2]])
        parts = [*entry.get("anyOf", ()), *entry.get("oneOf", ())]
        parts += [entry[key] for key in ("items", "additionalProperties") if key in entry]
        return any(described(part) for part in parts if isinstance(part, Mapping))

    for key, entry in table.get("properties", {}).items():
        if not described(entry):
            yield key
        yield from (f"{key}.{inner}" for inner in undescribed(entry, schema))


@pytest.mark.parametrize("subject", schemas.SUBJECTS)
def test_every_key_is_described(subject: schemas.Subject) -> None:
    schema = json.loads(schemas.shipped(subject))
    tables = {"the file": schema, **schema["$defs"]}
    missing = [f"{name} {key}" for name, of in tables.items() for key in undescribed(of, schema)]
    assert not missing, f"a docstring is missing below {', '.join(missing)}"


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_rig_files_are_valid(path: Path) -> None:
    assert not faults("rig", path.read_text())


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_scenarios_are_valid(path: Path) -> None:
    assert not faults("scenario", path.read_text())


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('kind = "cylinder"', 'kind = "cilinder"'),
        ('stroke = "40 mm"', 'strok = "40 mm"'),
        ('role = "identify"', 'rolle = "identify"'),
        ("[parameters]", "[signals]\nexten = 'x [mm]'\n[parameters]"),
        ("fit = true", "fit = 1"),
    ],
)
def test_a_mistake_is_seen(right: str, wrong: str) -> None:
    assert not faults("rig", PLAIN_RIG)
    assert faults("rig", PLAIN_RIG.replace(right, wrong))


def test_both_forms_of_a_signal_and_a_parameter_of_one_leg_are_valid() -> None:
    tables = 'extension_1 = "x [mm]"\nextension_2 = { column = "y", unit = "mm" }\n'
    text = f'[rig]\nkind = "platform"\n[signals]\n{tables}[parameters]\n"chamber_leakage_lower:2" = 0\n'
    assert not faults("rig", text + '[[records]]\nfile = "a.csv"\nrole = "identify"\n')


def test_the_command_writes_it(tmp_path: Path) -> None:
    written = sms("schema", "rig", "--out", "rig.schema.json", cwd=tmp_path)
    assert written.returncode == 0
    assert (tmp_path / "rig.schema.json").read_text() == schemas.shipped("rig")
    printed: dict[str, Any] = json.loads(sms("schema", "scenario", cwd=tmp_path).stdout)
    assert printed["title"] == "sms scenario"
    assert "rig, scenario" in sms("schema", "report", cwd=tmp_path).stderr
