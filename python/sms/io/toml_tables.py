"""TOML files as tables of a model: reading them, and one clear sentence for each mistake in one.

A file is a subclass of `Table`: schema.py has that of a rig file. Only the shape is checked here (which keys, text or
number); what a text means (units, bounds, files) is the subject of whoever asked for the file.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_args

from pydantic import (
    BaseModel,
    ConfigDict,
    PlainSerializer,
    PlainValidator,
    ValidationError,
    WithJsonSchema,
)

from sms.errors import InputError, did_you_mean, nearest


def _text_or_number(value: object) -> str | float:
    if isinstance(value, str):
        return value
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if not is_finite(value):
            raise ValueError("must be a finite number")
        return value
    raise ValueError('must be text with a number and a unit, like "25 mm"')


def is_finite(number: float) -> bool:
    """Whether a number of a TOML file, which may be an integer of any length, is one that can be calculated with."""
    try:
        return math.isfinite(number)
    except OverflowError:
        return False


TextOrNumber = Annotated[
    str | float,
    PlainValidator(_text_or_number),
    PlainSerializer(lambda value: value),
    WithJsonSchema({"type": ["string", "number"]}),
]


class Table(BaseModel):
    """A TOML table in which an unknown key is a mistake and nothing is silently converted."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        strict=True,
        allow_inf_nan=False,
        use_attribute_docstrings=True,
    )


Model = TypeVar("Model", bound=Table)
_LISTS = ("records", "related", "effect")
"""Tables of which there can be several, [[records]]."""
_EXPECTED = {
    "string_type": "must be text in quotes",
    "bool_type": "must be true or false",
    "int_type": "must be a whole number",
    "finite_number": "must be a finite number",
    "float_type": "must be a number without quotes",
    "list_type": "must be a list in brackets",
    "model_type": "must be a table",
    "dict_type": "must be a table",
    "greater_than_equal": "must not be negative",
    "too_short": "must not be empty",
}


def read_text(path: Path, what: str, least: str) -> str:
    """The text of a TOML file; InputError when it is missing, empty or not text. least: the tables that it needs."""
    text = decoded(path, what, what)
    if not text.strip():
        raise InputError(f"{path}: the {what} is empty; it needs {least} at least")
    return text


LARGEST_TOML = 2**24  #: bytes; a rig of a thousand records has a hundredth of it


def decoded(path: Path, what: str, file: str) -> str:
    """The text of a TOML file; InputError when it is missing, no text, or endless. what, file: what it is called."""
    try:
        with path.open("rb") as opened:
            content = opened.read(LARGEST_TOML + 1)
        text = content.decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such {file}; check the path") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: not a text file in UTF-8; a {what} is TOML text") from None
    except OSError as problem:
        raise InputError(f"{path}: cannot be read ({problem.strerror})") from None
    if len(content) > LARGEST_TOML:
        raise InputError(f"{path}: more than {LARGEST_TOML // 2**20} MiB, which no {what} has")
    return text


_DEEP_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){200}""")


def parse_toml(text: str, path: Path) -> dict[str, Any]:
    """The tables of a TOML text; InputError where it is none."""
    nested = f"{path}: arrays or tables in it are nested hundreds deep; correct it"
    if _DEEP_KEY.search(text):  # takes the parser minutes
        raise InputError(nested)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise InputError(f"{path}: not valid TOML: {problem}; correct it there") from None
    except ValueError:  # of int(), which refuses to read thousands of digits
        raise InputError(f"{path}: a number in it has thousands of digits; correct it") from None
    except RecursionError:
        raise InputError(nested) from None


def checked(model: type[Model], tables: Mapping[str, Any], path: Path) -> Model:
    """The tables of a file in the structure of `model`; InputError names file, table and key."""
    try:
        return model.model_validate(tables)
    except ValidationError as problem:
        error, more = first_mistake(problem)
    raise InputError(f"{path}, {_sentence(model, error, tables)}{more}")


def first_mistake(problem: ValidationError) -> tuple[dict[str, Any], str]:
    """The error to speak of, and in words how many more there are."""
    errors: list[dict[str, Any]] = [dict(error) for error in problem.errors()]
    # A misspelt key also makes its right spelling missing: the misspelling alone is what to say.
    misspelt = [error["loc"][:-1] for error in errors if error["type"] == "extra_forbidden"]
    errors = [e for e in errors if e["type"] != "missing" or e["loc"][:-1] not in misspelt]
    return errors[0], f" (and {len(errors) - 1} more in this file)" if len(errors) > 1 else ""


def place(*location: str | int) -> str:
    """How a place in a rig file is named: "[data] skip_first", "[[records]] number 2, role"."""
    table, *keys = location
    if table not in _LISTS:
        return " ".join([f"[{table}]", ".".join(str(key) for key in keys)]).strip()
    name = f"[[{table}]] number {int(keys[0]) + 1}" if keys else f"[[{table}]]"
    return ", ".join([name, *(str(key) for key in keys[1:])])


def _sentence(model: type[Table], error: Mapping[str, Any], tables: Mapping[str, Any]) -> str:
    """One pydantic error as place, what is wrong, remedy."""
    *parents, key = error["loc"]
    kind = error["type"]
    if kind == "extra_forbidden":
        return _unknown_key(model, parents, str(key))
    if kind == "missing":
        return _missing_key(parents, str(key))
    where = place(*error["loc"])
    if len(error["loc"]) == 1 and key in _LISTS and isinstance(tables.get(str(key)), Mapping):
        return f"[{key}]: there can be several; write [[{key}]] with double brackets"
    if kind == "literal_error":
        given = str(error["input"])
        words = _words(_home(model, parents), str(key))
        return f"{where}: '{given}' is not known; {did_you_mean(given, words)}"
    problem = error["ctx"]["error"] if kind == "value_error" else _EXPECTED.get(kind, error["msg"])
    return f"{where}: {problem}"


def _missing_key(parents: list[str | int], key: str) -> str:
    if parents:
        return f"{place(*parents)}: the key '{key}' is missing; add it"
    return f"the table {f'[[{key}]]' if key in _LISTS else f'[{key}]'} is missing; add it"


def _unknown_key(model: type[Table], parents: list[str | int], key: str) -> str:
    tables = _tables_of(model)
    known = list(_home(model, parents).model_fields)
    if not parents:
        return f"the table [{key}] is not known; {did_you_mean(key, known)}"
    where = place(*parents)
    homes = [table for table, other in tables.items() if key in other.model_fields]
    if homes and nearest(key, known) is None:
        return f"{where}: the key '{key}' does not belong here; move it to [{homes[0]}]"
    return f"{where}: the key '{key}' is not known; {did_you_mean(key, known)}"


def _home(model: type[Table], keys: list[str | int]) -> type[Table]:
    """The table at a place of a file."""
    here = model
    for key in keys:
        here = _tables_of(here).get(str(key), here)
    return here


def keys_of(model: type[Table]) -> dict[str, list[str]]:
    """Name of a table of a file -> the names of its keys."""
    return {name: list(table.model_fields) for name, table in _tables_of(model).items()}


def _tables_of(model: type[Table]) -> dict[str, type[Table]]:
    """Name of a table of a file -> its keys."""
    found = {name: _table_in(field.annotation) for name, field in model.model_fields.items()}
    return {name: table for name, table in found.items() if table is not None}


def _table_in(annotation: Any) -> type[Table] | None:
    """The table in `list[RecordTable]` or `dict[str, Annotated[SignalTable, ...]] | None`."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return annotation
    return next(filter(None, map(_table_in, get_args(annotation))), None)


def _words(table: type[Table], key: str) -> list[str]:
    """The words allowed for a key that takes one of a few."""
    annotation: Any = table.model_fields[key].annotation
    if (
        type(None) in annotation.__args__
    ):  # of a key that may be left out, the other half of its type
        annotation = next(half for half in annotation.__args__ if half is not type(None))
    return [str(word) for word in annotation.__args__]
