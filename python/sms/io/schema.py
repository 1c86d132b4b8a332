"""The structure of a rig file: its tables and keys, and one clear sentence for each mistake in it.

Only the shape is checked here (which keys, text or number). What the text means (units, bounds,
files) is the subject of rig.py.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from datetime import date, datetime
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar, get_args

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
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


def _moment(value: object) -> date | datetime:
    if isinstance(value, date):  # a datetime is one, too
        return value
    raise ValueError("must be a date without quotes, like 2026-11-25 or 2026-11-25T14:30:00")


Moment = Annotated[
    date | datetime,
    PlainValidator(_moment),
    PlainSerializer(lambda value: value),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "format": f} for f in ("date", "date-time", "partial-date-time")
            ]
        }
    ),
]
"""A date of TOML, with or without a time of day."""


def _short_form(key: str) -> BeforeValidator:
    """Let a bare value stand for a table with this one key."""

    def expand(value: object) -> object:
        return value if isinstance(value, Mapping) else {key: value}

    return BeforeValidator(expand)


class Table(BaseModel):
    """A TOML table in which an unknown key is a mistake and nothing is silently converted."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        strict=True,
        allow_inf_nan=False,
        use_attribute_docstrings=True,
    )


class RigTable(Table):
    """[rig]: what was measured."""

    kind: Literal["cylinder", "tank", "bench", "platform", "flow_test", "spool_test"]
    """`cylinder`: its motion, chamber pressure and rod force; `tank`: charged and vented by the valve; `bench`: one
    actuator with its valve; `platform`: three of them; `flow_test`: a tank charged or discharged at a held opening;
    `spool_test`: the valve alone, the position of its spool measured.
    """
    title: str = ""
    """Title of the reports; without it, the file's name."""
    notes: str = ""
    """Remarks, below the title of the report."""
    measured: Moment | None = None
    """When its records were measured; without it, when their files were changed last."""
    geometry: str | None = None
    """Of a platform: a parameter file, such as geometry.toml of `sms calibrate geometry`. [parameters] go before it."""


class ModelTable(Table):
    """[model]: which laws the simulation uses, and how well its curves are known."""

    friction: Literal["acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre"] = (
        "acceleration_dependent"
    )
    """Friction law of the actuators: `acceleration_dependent` (eq. 6.5), `two_branch` (eq. 6.2), `stribeck` (eq. 6.1);
    `dahl` and `lugre` have the deflection of the seals as a state.
    """
    valve: Literal["iso_0_4_mpa", "iso_0_2_mpa", "classic"] = "iso_0_4_mpa"
    """Flow law of the valve: ISO 6358 with the table measured at 0.4 or 0.2 MPa gauge; `classic`, orifice area and
    discharge coefficient. Of a `tank` without this key, the table measured nearest to the supply of each record.
    """
    chambers: Literal["polytropic", "energy"] = "polytropic"
    """`polytropic`: temperature constant, a heat ratio for each term (eq. 4.30); `energy`: temperature a state, heat
    through the wall.
    """
    flow_map_uncertainty: TextOrNumber | None = None
    """Relative half width of the flow through the valve at an opening; without it, that of params.def."""
    friction_map_uncertainty: TextOrNumber | None = None
    """Relative half width of friction at a speed; without it, that of params.def."""
    sensor_linearity: TextOrNumber | None = None
    """Half width of a sensor's deviation from its best straight line, of its span; without it, that of signals.def."""


class ControlTable(Table):
    """[control]: whether a controller closed the loop, and which is simulated; its gains are parameters."""

    loop: Literal["open", "closed"] = "open"
    """Whether the records were measured under a position controller."""
    controller: Literal["recorded", "simulated"] = "recorded"
    """`recorded`: the valve's command is that of the record; `simulated`, in a closed loop: what the controller makes
    of the recorded set-point and the simulated extension.
    """
    law: Literal["pid", "state_feedback"] = "pid"
    """Control law that is simulated, `pid` (eq. 7.4) or `state_feedback` (Figure 8.3)."""
    compensated: bool = True
    """Whether the simulated controller's output steps over the valve's dead band (eq. 7.5)."""
    electronics: bool = False
    """Whether the anti-alias filter before the simulated controller and the filter of the pulse width behind it are
    simulated (section 7.3.3).
    """


class DataTable(Table):
    """[data]: where the record files are and how they are laid out."""

    folder: str | None = None
    """Folder of the records, looked up in that of the environment variable `SMS_DATA`, beside this file and in
    ../shared/data; without it, the records lie in one of these.
    """
    obtain: str | None = None
    """Where the records can be had, for the message where they are not found."""
    delimiter: Literal["comma", "semicolon", "tab", "whitespace"] = "comma"
    """Between the columns of a text file."""
    columns: list[str] | None = Field(default=None, min_length=1)
    """Names of the columns, in order, of text files without a header line or of the one matrix of a .mat file."""
    dbc: str | None = None
    """DBC file that decodes CAN logs, relative to this file; without it, that of the project's own bus."""
    skip_first: int = Field(default=0, ge=0)
    """Number of samples at the start of each record that are not used."""
    speed_above: TextOrNumber | None = None
    """Of a `cylinder`: the speed above which samples are compared; without it, whenever it moves."""


class SignalTable(Table):
    """[signals.NAME]: value in SI = scale * column in SI + offset. A bare text is the column."""

    column: str | None = None
    """Name of the column, with or without its unit in brackets; without it, the signal's name, `extension [m]`."""
    unit: str | None = None
    """Unit of the column; without it, the one in brackets in the column's name."""
    scale: float = 1.0
    """Factor on the column, not 0."""
    offset: TextOrNumber | None = None
    """What is added after `scale`, in the dimension of the signal; without it, 0."""
    gauge: bool = False
    """Whether a pressure is read against ambient; otherwise it is absolute."""
    noise: TextOrNumber | None = None
    """Standard deviation of one sample; without it, estimated from the records."""
    resolution: TextOrNumber | None = None
    """Step of the converter; without it, none."""
    rounding: Literal["nearest", "down"] | None = None
    """Of a converter: to the nearest step, as without it, or down to the step below."""
    range: list[TextOrNumber] | None = None
    """Of a sensor: the smallest and the largest reading, where it clips."""
    hold: Literal["previous", "linear"] | None = None
    """Of a command: whether it stays at the last sample until the next, or goes straight there; without it, as the
    record looks.
    """


class ParameterTable(Table):
    """[parameters.NAME]: what is known, or that it is to be fitted. A bare text or number is the value."""

    value: TextOrNumber | None = None
    """In the dimension of the parameter; without it, the default of docs/parameters.md."""
    uncertainty: TextOrNumber | None = None
    """Half width within which the value is believed to hold; without it, that of docs/parameters.md."""
    fit: bool = False
    """Whether it is unknown and fitted, with the value as the start."""


class RecordControl(Table):
    """What [control] says, where it is otherwise in one record."""

    loop: Literal["open", "closed"] | None = None
    """Without it, as in [control]; `open` makes the controller `recorded`, too."""
    controller: Literal["recorded", "simulated"] | None = None
    """Without it, as in [control]; `simulated` makes the loop `closed`, too."""


class RecordTable(Table):
    """[[records]]: one measured run."""

    file: str
    """The record under the folder of [data]; docs/logs.md lists the formats."""
    role: Literal["identify", "validate", "test", "reference"]
    """`identify`: parameters are fitted to it; `validate`: what is found is judged on it; `test`: takes part in no
    choice; `reference`: the healthy machine.
    """
    name: str | None = None
    """What reports call it; without it, the file's name without its ending."""
    conditions: dict[str, TextOrNumber] = Field(default_factory=dict)
    """Parameters that are known to have another value in this run, by name."""
    control: RecordControl = RecordControl()


class RelatedTable(Table):
    """[[related]]: a rig of the same bench, on which causes that are found are looked up."""

    file: str
    """Its rig file, relative to this file."""
    differs: str
    """The part that is another one there, such as `seal`; `repeat`: the same parts, mounted again."""


class EffectsTable(Table):
    """[effects]: a file with effects of one's own, beside those of the catalogue."""

    file: str
    """Its name, relative to this file; docs/rig_file.md describes its entries."""


Parameters = dict[str, Annotated[ParameterTable, _short_form("value")]]


class ParameterFile(Table):
    """A file of parameters alone."""

    parameters: Parameters


class RigFile(Table):
    """The whole rig file."""

    rig: RigTable
    model: ModelTable = ModelTable()
    control: ControlTable = ControlTable()
    data: DataTable = DataTable()
    signals: dict[str, Annotated[SignalTable, _short_form("column")]] | None = None
    """Which column is which signal; without this table, each column has the name of its signal, `extension [m]`."""
    parameters: Parameters = Field(default_factory=dict)
    """Parameters of the model; of those without an entry, value and half width of docs/parameters.md hold."""
    records: list[RecordTable] = Field(min_length=1)
    related: list[RelatedTable] = Field(default_factory=list)
    effects: EffectsTable | None = None


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


def read_rig_text(path: Path) -> str:
    """The text of the rig file; InputError when it is missing, empty or not text."""
    return read_text(path, "rig file", "[rig] and [[records]]")


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


def parse_rig_text(text: str, path: Path) -> RigFile:
    """Check the structure of a rig file's text; `path` is what an InputError names."""
    return checked(RigFile, parse_toml(text, path), path)


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
        errors: list[dict[str, Any]] = [dict(error) for error in problem.errors()]
    # A misspelt key also makes its right spelling missing: the misspelling alone is what to say.
    misspelt = [error["loc"][:-1] for error in errors if error["type"] == "extra_forbidden"]
    errors = [e for e in errors if e["type"] != "missing" or e["loc"][:-1] not in misspelt]
    more = f" (and {len(errors) - 1} more in this file)" if len(errors) > 1 else ""
    raise InputError(f"{path}, {_sentence(model, errors[0], tables)}{more}")


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
