"""The rig file: what was measured, what is known about it, and which column is which signal.

`load_rig` reads a TOML file into a `Rig`, in SI units, with every record's file found on disk.
docs/rig_file.md describes the format; the files sms/data/*/cylinder_*.toml show it with comments.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import date, datetime
from pathlib import Path
from typing import Literal

from sms import _core
from sms.errors import InputError, did_you_mean
from sms.io.data_files import beside, find_files
from sms.io.declarations import Declaration, as_calibrated, check_rod, declaration, parameters_of
from sms.io.schema import (
    ControlTable,
    DataTable,
    ModelTable,
    ParameterTable,
    RecordControl,
    RecordTable,
    RigFile,
    parse_rig_text,
    read_rig_text,
)
from sms.io.signal_sources import SignalSource, sources_of
from sms.io.signals import (
    KINDS,
    LEGS,
    without_leg,
)
from sms.io.toml_tables import place
from sms.io.units import interval_to_si, to_si
from sms.parameters import (
    FLOW_MAP,
    FRICTION_MAP,
    LINEARITY,
    PARAMETERS,
    SPECIMENS,
    Parameter,
    is_of_leg,
)

Role = Literal["identify", "validate", "test", "reference"]


@dataclass(frozen=True)
class RecordSource:
    """One record: its name, its file on disk and what it is for."""

    name: str
    file: Path
    role: Role
    conditions: Mapping[str, float] = field(default_factory=dict)
    """Parameters known to have another value in this run (SI): an added mass, another supply."""
    control: ControlTable = field(default_factory=ControlTable)
    """As [control] of the rig file, and the record, have it."""


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
    """With the controller that is simulated, if in any record."""
    effects: Path | None = None  #: a file with effects beside those of the catalogue
    geometry: Path | None = None  #: the mechanism as calibrated; `parameters` has its values
    measured: date | datetime | None = None  #: the records, as the file says

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file that is read with it: itself, its records, and what it names beside them."""
        beside_it = (self.layout.dbc, self.effects, self.geometry, *(r.file for r in self.related))
        return (self.path, *(r.file for r in self.records), *(f for f in beside_it if f))

    def declared(self, name: str) -> Declaration:
        """What is known of a parameter: from the file, else the default and its uncertainty."""
        if name in self.parameters:
            return self.parameters[name]
        if name not in self.table:
            raise KeyError(f"no parameter '{name}'; {did_you_mean(name, PARAMETERS)}")
        return Declaration(self.table[name].default, self.table[name].uncertainty)

    @property
    def unknown_zeros(self) -> dict[str, float]:
        """Parameter -> half a step, of sensors of which it is not declared whether their converter rounds down."""
        zeros = {
            f"sensor_offset_{without_leg(signal)}": 0.5 * source.resolution
            for signal, source in self.signals.items()
            if source.resolution > 0.0 and source.rounding is None
        }
        return {name: half for name, half in zeros.items() if name in self.table}

    @property
    def table(self) -> Mapping[str, Parameter]:
        """Bounds and units of every parameter that the model has."""
        return parameters_of(self.kind)

    def start(self) -> _core.Params:
        """Every parameter as declared."""
        declared = {name: known.value for name, known in self.parameters.items()}
        declared = self._datums() | declared
        common = _core.Params(**{n: value for n, value in declared.items() if not is_of_leg(n)})
        if self.kind != "platform":
            return common
        machine = _core.LegParams(common)
        for name, value in declared.items():
            if is_of_leg(name):
                machine[name] = value
        return machine

    def _datums(self) -> dict[str, float]:
        """Where each sensor itself reads nothing: where its column is zero, and at ambient of one that reads against
        it. A cylinder's gauge pressures stay so (estimation/cylinder.hpp). Of three legs' sensors: the first one's, and
        by how much the others' are larger."""
        ambient = 0.0 if self.kind == "cylinder" else self.declared("ambient_pressure").value
        at = {s: w.offset + (ambient if w.gauge else 0.0) for s, w in self.signals.items()}
        datums: dict[str, float] = {}
        for signal, value in at.items():
            name = f"sensor_datum_{without_leg(signal)}"
            if name not in PARAMETERS:
                continue
            common = datums.setdefault(name, value)
            if value != common:
                datums[f"{name}:{signal[-1]}"] = value - common
        # What is beyond is found where the readings are looked at.
        return {n: v for n, v in datums.items() if self.table[n].lower <= v <= self.table[n].upper}


def load_rig(path: str | os.PathLike[str]) -> Rig:
    """Read a rig file and find its records. InputError says file, table, key and what to do."""
    path = Path(path)
    return interpret(parse_rig_text(read_rig_text(path), path), path)


def interpret(file: RigFile, path: Path) -> Rig:
    """Turn a rig file of right structure into SI units, known names and files that exist."""
    data, kind = file.data, file.rig.kind
    controls = [
        _control(table, file.control, number, path) for number, table in enumerate(file.records)
    ]
    control = next((c for c in controls if c.controller == "simulated"), file.control)
    if all(c.controller == "recorded" for c in controls):
        control = control.model_copy(update={"controller": "recorded"})
    geometry, calibrated = as_calibrated(file.rig, path)
    speed_above = None
    if data.speed_above is not None:
        where = f"{path}, [data] speed_above"
        speed_above = to_si(data.speed_above, "m/s", where)
        if speed_above < 0.0:
            raise InputError(f"{where}: a speed is not negative; write 0 or more")
    rig = Rig(
        path=path,
        kind=kind,
        title=file.rig.title or path.stem,
        notes=file.rig.notes,
        layout=DataLayout(
            data.delimiter,
            tuple(data.columns) if data.columns else None,
            None if data.dbc is None else beside(path, data.dbc, "[data] dbc", "DBC file"),
        ),
        skip_first=data.skip_first,
        speed_above=speed_above,
        signals=sources_of(file, controls, path),
        parameters=_of_each_leg(
            calibrated
            | _half_widths(file, path)
            | {
                name: declaration(name, table, f"{path}, [parameters]", parameters_of(kind))
                for name, table in file.parameters.items()
            },
            kind,
        ),
        records=_records(file.records, controls, data, path),
        related=tuple(
            RelatedRig(
                beside(path, table.file, place("related", number, "file"), "rig file"),
                table.differs,
            )
            for number, table in enumerate(file.related)
        ),
        model=file.model,
        control=control,
        effects=None
        if file.effects is None
        else beside(path, file.effects.file, "[effects] file", "file of effects"),
        measured=file.rig.measured,
        geometry=geometry,
    )
    _check_machine(rig)
    return rig


def _check_machine(rig: Rig) -> None:
    """InputError for values that are allowed each by itself, and together make no machine."""
    if rig.kind in ("bench", "platform") or "rod_diameter" in rig.parameters:
        check_rod({n: rig.declared(n).value for n in ("bore_diameter", "rod_diameter")}, rig.path)


def _control(table: RecordTable, rig: ControlTable, number: int, path: Path) -> ControlTable:
    """Of one record: as [control] has it, but for what the record says. An open loop has no controller."""
    said = table.control
    implied: dict[str, str] = {}
    if said.loop == "open":
        implied["controller"] = "recorded"
    if said.controller == "simulated":
        implied["loop"] = "closed"
    control = rig.model_copy(update=implied | said.model_dump(exclude_none=True))
    if control.loop == "open" and control.controller == "simulated":
        where = "[control]" if said == RecordControl() else place("records", number, "control")
        raise InputError(
            f"{path}, {where}: in an open loop there is no controller to be simulated; "
            'write loop = "closed", or controller = "recorded"'
        )
    return control


def _half_widths(file: RigFile, path: Path) -> dict[str, Declaration]:
    """Of errors of flow, friction and sensors' lines, where [model] says how large these may be."""
    kind, model = file.rig.kind, file.model
    commanded = kind != "spool_test" and "valve_command" in map(without_leg, KINDS[kind].needed)
    moves = kind in ("bench", "platform")
    said = {
        "flow_map_uncertainty": (FLOW_MAP, 1.0, commanded),
        "friction_map_uncertainty": (FRICTION_MAP, 1.0, moves),
        "sensor_linearity": (LINEARITY, 0.02, moves or kind == "tank"),
    }
    declared: dict[str, Declaration] = {}
    for key, (names, most, has_any) in said.items():
        text = getattr(model, key)
        if text is None:
            continue
        where = f"{path}, [model] {key}"
        if not has_any:
            raise InputError(f"{where}: nothing of a {kind} depends on it; leave it out")
        half_width = interval_to_si(text, "1", where)
        if not 0.0 <= half_width < most:
            raise InputError(f"{where}: {text} is no half width; write 0 to {100.0 * most:.0f} %")
        declared |= {name: Declaration(PARAMETERS[name].default, half_width) for name in names}
    return declared


def _of_each_leg(declared: dict[str, Declaration], kind: str) -> dict[str, Declaration]:
    """How well curves and sensors are known, said of a platform in a word, is said of those of each leg."""
    if kind != "platform":
        return declared
    legs: dict[str, Declaration] = {}
    for name in SPECIMENS:
        if name in declared and not declared[name].fit:
            own = Declaration(0.0, declared[name].uncertainty)
            legs |= {f"{name}:{leg}": own for leg in LEGS}
            declared[name] = replace(declared[name], uncertainty=0.0)
    return legs | declared


def _records(
    tables: list[RecordTable], controls: Sequence[ControlTable], data: DataTable, path: Path
) -> tuple[RecordSource, ...]:
    files = find_files([table.file for table in tables], data, path)
    records = tuple(
        # "O-ring_1bar.csv.gz" is named "O-ring_1bar" when the rig file gives no name.
        RecordSource(
            table.name or Path(file.name.removesuffix(".gz")).stem,
            file,
            table.role,
            _conditions(table, f"{path}, {place('records', number, 'conditions')}"),
            control,
        )
        for number, (table, file, control) in enumerate(zip(tables, files, controls, strict=True))
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
        name: declaration(name, ParameterTable(value=value), where).value
        for name, value in table.conditions.items()
    }


def _repeated(words: list[str]) -> str | None:
    """The first word that occurs more than once."""
    return next((word for word, count in Counter(words).items() if count > 1), None)
