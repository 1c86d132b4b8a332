"""TOML files into checked tables, and one sentence for a mistake: the key, its value, what is allowed.

The models derive from `sms.io.toml_tables.Table`, in which an unknown key is an error.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from sms.errors import InputError, nearest
from sms.io.toml_tables import Table, decoded, first_mistake, parse_toml
from sms.io.units import to_si

Model = TypeVar("Model", bound=Table)

_EXPECTED = {
    "string_type": "must be text in quotes",
    "bool_type": "must be true or false",
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "float_type": "must be a number without quotes",
    "list_type": "must be a list in brackets",
    "model_type": "must be a table",
    "dict_type": "must be a table",
    "too_short": "must not be empty",
}


def read_toml(path: Path, what: str) -> dict[str, Any]:
    """The tables of a TOML file; InputError when it is missing, empty or not TOML."""
    tables = parse_toml(decoded(path, what, f"{what} file"), path)
    if not tables:
        raise InputError(f"{path}: the {what} file is empty; docs/simulation.md shows one")
    return tables


def checked(model: type[Model], tables: Mapping[str, Any], path: Path) -> Model:
    """The tables as `model`. InputError names file, table, key, value, and what is allowed."""
    try:
        return model.model_validate(tables)
    except ValidationError as problem:
        error, more = first_mistake(problem)
    raise InputError(f"{path}, {_sentence(model, error)}{more}")


def place(keys: Sequence[str | int]) -> str:
    """How a place in the file is named: "[excitation] amplitude"."""
    table, *rest = keys
    return " ".join([f"[{table}]", ".".join(str(key) for key in rest)]).strip()


def known_key(word: str, known: Sequence[str]) -> str:
    """The remedy for an unknown key: the nearest known one, and all that are allowed."""
    near = nearest(word, known)
    meant = f"did you mean '{near}'? " if near else ""
    return f"{meant}allowed are {', '.join(known)}"


def within(
    text: str | float, unit: str, lower: float, upper: float, where: str, above: bool = False
) -> float:
    """A quantity in SI, from `lower` (with `above`: beyond it) to `upper`. InputError otherwise."""
    value = to_si(text, unit, where)
    if not lower <= value <= upper or (above and value == lower):
        label = "" if unit == "1" else f" {unit}"
        start = "above " if above else ""
        raise InputError(
            f"{where}: {value:g}{label} is outside the allowed range, {start}{lower:g} to "
            f"{upper:g}{label}"
        )
    return value


def _sentence(model: type[Table], error: Mapping[str, Any]) -> str:
    """One pydantic error as place, what is wrong, what is allowed."""
    *parents, key = error["loc"]
    home = _model_at(model, parents)
    kind = error["type"]
    if kind == "extra_forbidden":
        known = list(home.model_fields)
        if not parents:
            return f"the table [{key}] is not known; {known_key(str(key), known)}"
        return f"{place(parents)}: the key '{key}' is not known; {known_key(str(key), known)}"
    if kind == "missing":
        if not parents:
            return f"the table [{key}] is missing; add it"
        return f"{place(parents)}: the key '{key}' is missing; add it"
    where = place(error["loc"])
    given = error.get("input")
    if kind == "literal_error":
        words = [str(word) for word in _words(home.model_fields[str(key)].annotation)]
        return f"{where}: '{given}' is not known; {known_key(str(given), words)}"
    if kind == "value_error":
        return f"{where}: {error['ctx']['error']}"
    problem = _EXPECTED.get(kind, str(error["msg"]).lower())
    shown = f"{given!r} is given; it " if isinstance(given, (str, int, float, bool)) else ""
    return f"{where}: {shown}{problem}"


def _model_at(model: type[Table], keys: Sequence[str | int]) -> type[BaseModel]:
    """The model of the table at `keys`."""
    here: type[BaseModel] = model
    for key in keys:
        field = here.model_fields.get(str(key))
        inner = _models(field.annotation) if field else []
        if inner:
            here = inner[0]
    return here


def _models(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for part in get_args(annotation) for found in _models(part)]


def _words(annotation: Any) -> list[object]:
    """The words of a Literal, also inside an Optional."""
    if get_origin(annotation) in (Union, UnionType):
        return [word for part in get_args(annotation) for word in _words(part)]
    return list(get_args(annotation))
