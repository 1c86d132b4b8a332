"""The structure of a rig file: its tables and keys.

Only the shape is checked here (which keys, text or number). What the text means (units, bounds,
files) is the subject of rig.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date, datetime
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, PlainSerializer, PlainValidator, WithJsonSchema

from sms.io.toml_tables import Table, TextOrNumber, checked, parse_toml, read_text


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
    hold: Literal["previous", "linear", "stepped"] | None = None
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


def read_rig_text(path: Path) -> str:
    """The text of the rig file; InputError when it is missing, empty or not text."""
    return read_text(path, "rig file", "[rig] and [[records]]")


def parse_rig_text(text: str, path: Path) -> RigFile:
    """Check the structure of a rig file's text; `path` is what an InputError names."""
    return checked(RigFile, parse_toml(text, path), path)
