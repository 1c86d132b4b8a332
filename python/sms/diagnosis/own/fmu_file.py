"""A rig file of kind "fmu": an FMU as the plant, its effects, and measured records; diagnosed as a plant of one's own.

    [rig]
    kind = "fmu"

    [fmu]
    file = "tanks.fmu"
    window = 60.0                                       # s

    [states]
    level_upper = { scale = 0.01, equation = "balance of the upper tank" }

    [inputs]
    pump_voltage = { held = true }

    [outputs]
    level_upper = { variable = "gauge_upper", noise = 0.0004 }

    [parameters]
    outlet_upper = { lower = 5e-6, upper = 40e-6, uncertainty = 0.2e-6 }

    [[effect]]
    ...

A name is that of the FMU's variable where no `variable` is given; numbers are in the unit that the FMU declares for it,
or that `unit` says where it declares none.
docs/fmu_plants.md explains it.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import tomlkit
from pydantic import Field

from sms.callbacks import Progress
from sms.diagnosis.own.answer import Answer
from sms.diagnosis.own.engine import diagnose_model
from sms.diagnosis.own.fmu_calls import Fmu, Names
from sms.diagnosis.own.fmu_plant import Exchange, Slave
from sms.diagnosis.own.model import Effect, Input, Model, Output, Parameter, State
from sms.diagnosis.own.records import Record, read_record
from sms.diagnosis.result import as_json
from sms.errors import InputError
from sms.io.data_files import beside
from sms.io.json_files import input_hashes
from sms.io.toml_tables import Table, checked, parse_toml, place, read_text
from sms.io.write import write_text_atomically
from sms.report.diagnosis import report_html
from sms.report.files import header_of
from sms.report.page import write_page

Number = Annotated[float, Field(allow_inf_nan=False)]
KIND = "fmu"


class FmuRigTable(Table):
    """[rig]"""

    kind: Literal["fmu"]
    title: str = ""
    notes: str = ""


class FmuTable(Table):
    """[fmu]"""

    file: str
    window: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
    """s, of a simulation from one initial state: a few time constants, a tenth of a record or less."""
    interface: Literal["model_exchange", "co_simulation"] | None = None
    """Model exchange where it has both."""
    longest_step: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None


class StateTable(Table):
    """An entry of [states]."""

    variable: str | None = None
    unit: str | None = None
    scale: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
    equation: str = ""
    start: Number | None = None


class InputTable(Table):
    """An entry of [inputs]."""

    variable: str | None = None
    unit: str | None = None
    held: bool = False


class OutputTable(Table):
    """An entry of [outputs]."""

    variable: str | None = None
    unit: str | None = None
    noise: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None
    range: Annotated[list[Number], Field(min_length=2, max_length=2)] | None = None


class FmuParameterTable(Table):
    """An entry of [parameters]."""

    variable: str | None = None
    unit: str | None = None
    value: Number | None = None
    lower: Number | None = None
    upper: Number | None = None
    uncertainty: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] = 0.0
    fit: bool = False


class FmuEffect(Table):
    """One [[effect]]: a parameter of the FMU that may be another than declared, or a term that is neutral at it."""

    id: Annotated[str, Field(min_length=1)]
    parameter: str
    title: Annotated[str, Field(min_length=1)]
    cause: Annotated[str, Field(min_length=1)]
    plausible: Annotated[list[Number], Field(min_length=2, max_length=2)] | None = None
    equation: str = ""
    separated_by: str = "A measurement of the quantity itself."
    step: Number | None = None


class FmuRecord(Table):
    """One [[records]]."""

    file: str
    role: Literal["identify", "validate", "test"]
    name: str = ""
    conditions: dict[str, Number] = Field(default_factory=dict)
    columns: dict[str, str] = Field(default_factory=dict)


class FmuFile(Table):
    """The whole file."""

    rig: FmuRigTable
    fmu: FmuTable
    states: dict[str, StateTable] = Field(min_length=1)
    inputs: dict[str, InputTable] = Field(default_factory=dict)
    outputs: dict[str, OutputTable] = Field(min_length=1)
    parameters: dict[str, FmuParameterTable] = Field(min_length=1)
    effect: list[FmuEffect] = Field(min_length=1)
    records: list[FmuRecord] = Field(min_length=1)


@dataclass(frozen=True)
class FmuRig:
    """A rig file of kind "fmu", read: the model, its records, and every file that belongs to it."""

    path: Path
    model: Model
    window: float
    records: tuple[Record, ...]
    files: tuple[Path, ...]


def is_fmu_rig(path: Path) -> bool:
    """Whether a file is a rig file of this kind; what cannot be read is none."""
    try:
        tables = parse_toml(read_text(path, "rig file", "[rig] and [[records]]"), path)
    except InputError:
        return False
    rig = tables.get("rig")
    return isinstance(rig, Mapping) and rig.get("kind") == KIND


def load_fmu_rig(path: Path) -> FmuRig:
    """InputError for whatever does not fit the FMU, or a record."""
    tables = parse_toml(read_text(path, "rig file", "[rig], [fmu] and [[records]]"), path)
    file = checked(FmuFile, tables, path)
    archive = beside(path, file.fmu.file, "[fmu] file", "FMU")
    fmu = Fmu(archive, file.fmu.interface)
    model = _model(file, fmu, path)
    records, files = [], [path, archive]
    for number, table in enumerate(file.records):
        there = beside(path, table.file, place("records", number, "file"), "record")
        files.append(there)
        records.append(
            read_record(
                there, model, table.role, table.name, table.conditions, table.columns or None
            )
        )
    return FmuRig(path, model, file.fmu.window, tuple(records), tuple(files))


def _model(file: FmuFile, fmu: Fmu, path: Path) -> Model:
    called: dict[str, dict[str, str]] = {}
    for what in ("states", "inputs", "outputs", "parameters"):
        tables: Mapping[str, Any] = getattr(file, what)
        called[what] = {name: t.variable or name for name, t in tables.items()}
        for name, variable in called[what].items():
            fmu.variable(variable, f"{path}, [{what}] {name}")
    names = Names(
        *(list(called[w].values()) for w in ("states", "inputs", "outputs", "parameters"))
    )
    if fmu.interface == "model_exchange":
        fmu.rates_of(names.states)

    def unit(what: str, name: str) -> str:
        said: str | None = getattr(file, what)[name].unit
        return said or fmu.unit(called[what][name])

    def started(name: str, table: StateTable) -> float:
        return table.start if table.start is not None else _number(fmu, called["states"][name])

    parameters = tuple(file.parameters)
    plant = (Exchange if fmu.interface == "model_exchange" else Slave)(fmu, names, parameters)
    return Model(
        states=[
            State(n, unit("states", n), t.scale, t.equation, started(n, t))
            for n, t in file.states.items()
        ],
        inputs=[Input(n, unit("inputs", n), t.held) for n, t in file.inputs.items()],
        outputs=[
            Output(
                n,
                unit("outputs", n),
                t.noise,
                None if t.range is None else (t.range[0], t.range[1]),
            )
            for n, t in file.outputs.items()
        ],
        parameters=[
            _parameter(n, t, fmu, called["parameters"][n], path) for n, t in file.parameters.items()
        ],
        derivative=plant.derivative,
        output=plant.output,
        effects=[
            Effect(
                e.id,
                e.parameter,
                e.title,
                e.cause,
                None if e.plausible is None else (e.plausible[0], e.plausible[1]),
                e.equation,
                e.separated_by,
                e.step,
            )
            for e in file.effect
        ],
        title=file.rig.title or fmu.description.modelName,
        longest_step=math.inf if plant.adaptive else file.fmu.longest_step,
        exact=plant if plant.adaptive or plant.by_state else None,
    )


def _parameter(
    name: str, table: FmuParameterTable, fmu: Fmu, variable: str, path: Path
) -> Parameter:
    declared = fmu.variables[variable]
    lower = table.lower if table.lower is not None else declared.min
    upper = table.upper if table.upper is not None else declared.max
    for key, bound in (("lower", lower), ("upper", upper)):
        if bound is None:
            raise InputError(
                f"{path}, [parameters] {name}: the FMU says no bound of '{variable}'; write {key} = ..., a value that "
                "it will not pass"
            )
    value = table.value if table.value is not None else _number(fmu, variable)
    return Parameter(
        name,
        table.unit or fmu.unit(variable),
        float(lower),
        value,
        float(upper),
        table.uncertainty,
        table.fit,
    )


def _number(fmu: Fmu, variable: str) -> float:
    """The start value of a variable; 0 where it has none."""
    start = fmu.variables[variable].start
    try:
        return 0.0 if start is None else float(start)
    except ValueError:
        raise InputError(
            f"{fmu.file}: the start value of '{variable}', {start}, is no number"
        ) from None


# ---- the diagnosis ---------------------------------------------------------------------------------


def diagnose_fmu(
    path: str | os.PathLike[str],
    seed: int = 1,
    progress: Progress = lambda text, done: None,
    empirical: bool = False,
) -> Answer:
    """As `diagnose` of a rig of this project. InputError for a file, an FMU or a record that cannot be used."""
    path = Path(path)
    progress("reading the FMU and its records", 0.0)
    rig = load_fmu_rig(path)
    found = diagnose_model(rig.model, rig.records, rig.window, seed, progress, empirical)
    return replace(found, rig=path.name, inputs=input_hashes(rig.files))


def write_fmu_diagnosis(answer: Answer, path: Path, out: Path) -> tuple[Path, ...]:
    """report.html, diagnosis.json and, with causes, extended.toml: the rig file with them, accepted again."""
    page, data, extended = out / "report.html", out / "diagnosis.json", out / "extended.toml"
    html, text = report_html(answer), as_json(answer)
    rig_text = (
        _extended_text(answer, path, out) if answer.extended is not None and answer.causes else None
    )
    write_page(page, html)
    write_text_atomically(data, text)
    if rig_text is None:
        return page, data
    write_text_atomically(extended, rig_text)
    return page, data, extended


def _extended_text(answer: Answer, path: Path, out: Path) -> str:
    assert answer.extended is not None
    document: Any = tomlkit.parse(read_text(path, "rig file", "[rig], [fmu] and [[records]]"))
    for p in answer.extended.parameters:
        entry = document["parameters"][p.name]
        was = answer.model.parameter(p.name) if answer.model is not None else None
        if was is not None and (was.value, was.uncertainty, was.fit) == (
            p.value,
            p.uncertainty,
            p.fit,
        ):
            continue
        entry["value"], entry["uncertainty"] = p.value, p.uncertainty
        if "fit" in entry:
            entry["fit"] = p.fit
    for table in (document["fmu"], *document["records"]):
        there = path.parent / str(table["file"])
        table["file"] = os.path.relpath(there, out)
    header = "".join(f"# {line}".rstrip() + "\n" for line in header_of(answer).splitlines())
    return f"{header}\n{tomlkit.dumps(document)}"
