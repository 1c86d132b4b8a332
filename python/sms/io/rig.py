"""The rig file: what was measured, what is known about it, and which column is which signal.

`load_rig` reads a TOML file into a `Rig`, in SI units, with every record's file found on disk.
The files validation/measured/rigs/*.toml show the format with comments.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from sms import _core
from sms.io.errors import InputError, did_you_mean, nearest
from sms.io.schema import (
    ControlTable,
    DataTable,
    ModelTable,
    ParameterTable,
    RecordTable,
    RelatedTable,
    RigFile,
    SignalTable,
    parse_rig_text,
    place,
    read_rig_text,
)
from sms.io.signals import KINDS, SIGNAL_UNITS, column_name, is_pressure, with_controller_simulated
from sms.io.units import interval_to_si, to_si
from sms.parameters import LEG_PARAMETERS, PARAMETERS, Parameter, is_of_leg

Hold = Literal["previous", "linear"]
Role = Literal["identify", "validate", "test", "reference"]


@dataclass(frozen=True)
class SignalSource:
    """Which column holds a signal: value in SI = scale * column in SI + offset."""

    signal: str
    column: str  #: "stroke" or "stroke [mm]"
    unit: str | None = None  #: overrides the unit in the column's name
    scale: float = 1.0
    offset: float = 0.0  #: in the SI unit of the signal
    gauge: bool = False  #: the sensor reads against ambient
    optional: bool = False  #: a record may lack this column
    noise: float | None = None  #: declared standard deviation of one sample, SI; None: not declared
    resolution: float = 0.0  #: one step of the converter, SI
    hold: Hold | None = None  #: of a command, between its samples; None: as the record looks


@dataclass(frozen=True)
class Declaration:
    """What is known of one parameter, in its SI unit."""

    value: float
    uncertainty: float  #: half width within which it may move unasked
    fit: bool = False  #: unknown: to be fitted, `value` is the start


@dataclass(frozen=True)
class RecordSource:
    """One record: its name, its file on disk and what it is for."""

    name: str
    file: Path
    role: Role
    conditions: Mapping[str, float] = field(default_factory=dict)
    """Parameters known to have another value in this run (SI): an added mass, another supply."""


@dataclass(frozen=True)
class RelatedRig:
    """Another rig of the same bench, and what is different there: "seal", "repeat"."""

    file: Path
    differs: str


@dataclass(frozen=True)
class DataLayout:
    """How the record files are laid out."""

    delimiter: Literal["comma", "semicolon", "tab", "whitespace"]
    columns: tuple[str, ...] | None  #: names for files without a header line
    dbc: Path | None = None  #: the definition of the bus of CAN logs; None: the project's own


@dataclass(frozen=True)
class Rig:
    """One rig file, in SI units, with every record's file found."""

    path: Path
    kind: str
    title: str
    notes: str
    layout: DataLayout
    skip_first: int  #: samples at the start of a record that are not used
    speed_above: float | None  #: m/s; only faster samples are compared
    signals: Mapping[str, SignalSource]
    parameters: Mapping[str, Declaration]  #: those that the file mentions
    records: tuple[RecordSource, ...]
    related: tuple[RelatedRig, ...] = ()
    model: ModelTable = field(default_factory=ModelTable)
    control: ControlTable = field(default_factory=ControlTable)

    def declared(self, name: str) -> Declaration:
        """What is known of a parameter: from the file, else the default and its uncertainty."""
        if name in self.parameters:
            return self.parameters[name]
        if is_of_leg(name) and name in self.table:
            return Declaration(0.0, 0.0)
        if name not in PARAMETERS:
            raise KeyError(f"no parameter '{name}'; {did_you_mean(name, PARAMETERS)}")
        return Declaration(PARAMETERS[name].default, PARAMETERS[name].uncertainty)

    @property
    def table(self) -> Mapping[str, Parameter]:
        """Bounds and units of every parameter that the model has."""
        return _parameters_of(self.kind)

    def start(self) -> _core.Params:
        """Every parameter as declared."""
        declared = {name: known.value for name, known in self.parameters.items()}
        common = _core.Params(**{n: value for n, value in declared.items() if not is_of_leg(n)})
        if self.kind != "platform":
            return common
        machine = _core.LegParams(common)
        for name, value in declared.items():
            if is_of_leg(name):
                machine[name] = value
        return machine


def load_rig(path: str | os.PathLike[str]) -> Rig:
    """Read a rig file and find its records. InputError says file, table, key and what to do."""
    path = Path(path)
    return interpret(parse_rig_text(read_rig_text(path), path), path)


def interpret(file: RigFile, path: Path) -> Rig:
    """Turn a rig file of right structure into SI units, known names and files that exist."""
    data = file.data
    speed_above = None
    if data.speed_above is not None:
        where = f"{path}, [data] speed_above"
        speed_above = to_si(data.speed_above, "m/s", where)
        if speed_above < 0.0:
            raise InputError(f"{where}: a speed is not negative; write 0 or more")
    return Rig(
        path=path,
        kind=file.rig.kind,
        title=file.rig.title or path.stem,
        notes=file.rig.notes,
        layout=DataLayout(
            data.delimiter, tuple(data.columns) if data.columns else None, _dbc(data, path)
        ),
        skip_first=data.skip_first,
        speed_above=speed_above,
        signals=_signals(file, path),
        parameters={
            name: _declaration(name, table, f"{path}, [parameters]", _parameters_of(file.rig.kind))
            for name, table in file.parameters.items()
        },
        records=_records(file.records, data, path),
        related=tuple(
            RelatedRig(_related_file(table, number, path), table.differs)
            for number, table in enumerate(file.related)
        ),
        model=file.model,
        control=file.control,
    )


def _related_file(table: RelatedTable, number: int, path: Path) -> Path:
    """The rig file of a relative, beside this one."""
    file = (path.parent / Path(table.file).expanduser()).resolve()
    if not file.is_file():
        near = nearest(file.name, (f.name for f in path.parent.glob("*.toml")))
        remedy = f"did you mean '{near}'?" if near else "name a rig file beside this one"
        raise InputError(
            f"{path}, {place('related', number, 'file')}: there is no rig file {file}; {remedy}"
        )
    return file


def _dbc(data: DataTable, path: Path) -> Path | None:
    """The file that [data] dbc names, beside the rig file."""
    if data.dbc is None:
        return None
    file = (path.parent / Path(data.dbc).expanduser()).resolve()
    if not file.is_file():
        near = nearest(file.name, (f.name for f in path.parent.glob("*.dbc")))
        remedy = f"did you mean '{near}'?" if near else "name a DBC file beside the rig file"
        raise InputError(f"{path}, {place('data', 'dbc')}: there is no file {file}; {remedy}")
    return file


def _signals(file: RigFile, path: Path) -> dict[str, SignalSource]:
    kind = KINDS[file.rig.kind]
    if file.control.controller == "simulated":
        if file.control.loop == "open":
            raise InputError(
                f"{path}, [control]: in an open loop there is no controller to be simulated; "
                'write loop = "closed", or controller = "recorded"'
            )
        kind = with_controller_simulated(kind)
    if file.signals is None:
        return {
            signal: SignalSource(signal, column_name(signal), optional=signal in kind.optional)
            for signal in kind.signals
        }
    for signal in file.signals:
        if signal not in kind.signals:
            raise InputError(
                f"{path}, [signals]: a rig of kind '{file.rig.kind}' has no signal '{signal}'; "
                f"{did_you_mean(signal, kind.signals)}"
            )
    for signal in kind.needed:
        if signal not in file.signals:
            raise InputError(
                f"{path}, [signals]: the signal '{signal}' is needed but not listed; "
                f'add a line {signal} = "name of its column"'
            )
    return {signal: _signal(signal, table, path) for signal, table in file.signals.items()}


def _signal(signal: str, table: SignalTable, path: Path) -> SignalSource:
    where = f"{path}, [signals] {signal}"
    offset = 0.0
    if table.offset is not None:
        offset = interval_to_si(table.offset, SIGNAL_UNITS[signal], f"{where}, offset")
    if table.gauge and not is_pressure(signal):
        raise InputError(f"{where}: only a pressure can be gauge; remove gauge = true")
    if table.scale == 0.0:
        raise InputError(f"{where}: scale = 0 leaves nothing of the column; write its real scale")
    if table.hold is not None and not signal.startswith("valve_command"):
        raise InputError(f"{where}: only a valve command can have a hold; remove hold")
    noise = None if table.noise is None else _size(signal, table.noise, f"{where}, noise")
    resolution = 0.0
    if table.resolution is not None:
        resolution = _size(signal, table.resolution, f"{where}, resolution")
    return SignalSource(
        signal,
        table.column or column_name(signal),
        table.unit,
        table.scale,
        offset,
        table.gauge,
        noise=noise,
        resolution=resolution,
        hold=table.hold,
    )


def _size(signal: str, text: str | float, where: str) -> float:
    """A noise or a resolution in SI: a difference, not negative."""
    size = interval_to_si(text, SIGNAL_UNITS[signal], where)
    if size < 0.0:
        raise InputError(f"{where}: {text} is negative; write its size")
    return size


def _parameters_of(kind: str) -> Mapping[str, Parameter]:
    """A platform has parameters of one leg, too: "chamber_leakage_lower:2"."""
    return LEG_PARAMETERS if kind == "platform" else PARAMETERS


def _declaration(
    name: str,
    table: ParameterTable,
    where: str,
    known: Mapping[str, Parameter] = PARAMETERS,
) -> Declaration:
    where = f"{where} {name}"
    if name not in known:
        near = nearest(name, PARAMETERS)
        remedy = f"did you mean '{near}'?" if near else "see the table of parameters (params.def)"
        raise InputError(f"{where}: there is no such parameter; {remedy}")
    parameter = known[name]
    value, uncertainty = parameter.default, parameter.uncertainty
    if table.value is not None:
        value = to_si(table.value, parameter.unit, where)
        check_bounds(parameter, value, where)
    if table.uncertainty is not None:
        uncertainty = interval_to_si(table.uncertainty, parameter.unit, f"{where}, uncertainty")
        if uncertainty < 0.0:
            raise InputError(f"{where}: an uncertainty is not negative; write its half width")
    return Declaration(value, uncertainty, table.fit)


def check_bounds(parameter: Parameter, value: float, where: str) -> None:
    """InputError, with the allowed range, unless lower <= value <= upper (SI)."""
    if not parameter.lower <= value <= parameter.upper:
        unit = "" if parameter.unit == "1" else f" {parameter.unit}"
        raise InputError(
            f"{where}: {value:g}{unit} is outside the allowed range "
            f"{parameter.lower:g} to {parameter.upper:g}{unit}; check the number and its unit"
        )


def _records(tables: list[RecordTable], data: DataTable, path: Path) -> tuple[RecordSource, ...]:
    files = find_files([table.file for table in tables], data, path)
    records = tuple(
        # "O-ring_1bar.csv.gz" is named "O-ring_1bar" when the rig file gives no name.
        RecordSource(
            table.name or Path(file.name.removesuffix(".gz")).stem,
            file,
            table.role,
            _conditions(table, f"{path}, {place('records', number, 'conditions')}"),
        )
        for number, (table, file) in enumerate(zip(tables, files, strict=True))
    )
    if (file := _repeated([str(record.file) for record in records])) is not None:
        raise InputError(
            f"{path}, [[records]]: the file '{Path(file).name}' is listed twice; a record is used "
            "once, for identify or for validate"
        )
    if (name := _repeated([record.name for record in records])) is not None:
        raise InputError(
            f"{path}, [[records]]: two records have the name '{name}'; "
            'give each its own, name = "..."'
        )
    return records


def _conditions(table: RecordTable, where: str) -> dict[str, float]:
    """What was different in one run, in SI."""
    return {
        name: _declaration(name, ParameterTable(value=value), where).value
        for name, value in table.conditions.items()
    }


def _repeated(words: list[str]) -> str | None:
    """The first word that occurs more than once."""
    return next((word for word, count in Counter(words).items() if count > 1), None)


def find_files(names: list[str], data: DataTable, path: Path) -> list[Path]:
    """The record files, all under one place: $SMS_DATA, beside the rig file, ../shared/data.

    The first place that has every file is taken. InputError lists the places looked at.
    """
    folder = Path(data.folder or "").expanduser()
    places = [place_ / folder for place_ in search_places(path)] if not folder.is_absolute() else []
    for where in places or [folder]:
        if (files := files_in(where, names)) is not None:
            return files
    raise InputError(_nowhere(names, places or [folder], data, path))


def files_in(folder: Path, names: list[str]) -> list[Path] | None:
    """The named files in one folder, or None when one is missing."""
    files = [_on_disk(folder / Path(name).expanduser()) for name in names]
    found = [file for file in files if file is not None]
    return found if len(found) == len(names) else None


def _on_disk(file: Path) -> Path | None:
    """The file, or the same one packed or unpacked ("run.csv.gz" for "run.csv" and back)."""
    file = file.resolve()
    twin = file.with_suffix("") if file.suffix == ".gz" else file.with_name(file.name + ".gz")
    return next((candidate for candidate in (file, twin) if candidate.is_file()), None)


def search_places(path: Path) -> list[Path]:
    """Where a relative data path of the rig file `path` is looked up, in this order."""
    named = os.environ.get("SMS_DATA")
    places = [Path(named).expanduser()] if named else []
    return [*places, path.parent, Path("../shared/data")]


def _nowhere(names: list[str], places: list[Path], data: DataTable, path: Path) -> str:
    """The sentence for records that are not on disk: which, the places looked at, the remedy."""

    def missing_in(folder: Path) -> list[str]:
        return [name for name in names if _on_disk(folder / name) is None]

    best = min(places, key=lambda folder: len(missing_in(folder)))
    missing = missing_in(best)
    if len(missing) < len(names) or (data.folder and best.is_dir()):
        near = nearest(missing[0], (file.name for file in best.iterdir()))
        hint = f"did you mean '{near}'?" if near else "check the name, or put the file there"
        where = place("records", names.index(missing[0]), "file")
        return f"{path}, {where}: there is no file '{missing[0]}' in {best.resolve()}; {hint}"
    what = f"the data folder '{data.folder}'" if data.folder else f"the record '{missing[0]}'"
    looked = ", ".join(str(folder.resolve()) for folder in places)
    obtain = f"it can be had from {data.obtain}" if data.obtain else "put it into one of these"
    return (
        f"{path}: {what} is nowhere (looked in: {looked}); {obtain}, "
        "or set SMS_DATA to the folder that holds it"
    )
