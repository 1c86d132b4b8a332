"""Records of an own plant: arrays by name, and what in them would make an answer worthless."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.diagnosis.own.model import Input, Model, Output
from sms.diagnosis.own.shooting import samples_before
from sms.diagnosis.result import Finding
from sms.errors import InputError, did_you_mean
from sms.io.rig import Role
from sms.io.table_files import read_table
from sms.io.units import array_to_si, split_column_name

UNEVEN = 1e-2
"""Of a step: samples that lie further off an even grid are refused."""
AT_END = 1e-6
"""Of a sensor's range: as near to its end is at its end."""


@dataclass(frozen=True, eq=False)
class Record:
    """One measured run: `time` in s, evenly sampled, and every input and output of the model by its name."""

    name: str
    role: Role
    """"identify": fitted; "validate": judged on; "test": neither, the gain on it is only reported."""
    signals: Mapping[str, Array]
    conditions: Mapping[str, float] = field(default_factory=dict)
    """Parameter -> its value in this run, where that is known to be another: an added mass."""


def read_record(
    path: str | os.PathLike[str],
    model: Model,
    role: Role,
    name: str = "",
    conditions: Mapping[str, float] | None = None,
    columns: Mapping[str, str] | None = None,
) -> Record:
    """A record from a table on disk (CSV, .mat, Parquet) with columns `name [unit]`, converted to the model's units.

    columns: signal -> "column [unit]", where the table calls it otherwise, or says no unit; "time" is a signal too.
    InputError for a missing column, a unit that does not fit, or a cell that is no number.
    """
    path, columns = Path(path), columns or {}
    table = read_table(path, "comma", None)
    names = [split_column_name(column) for column in table.names]
    plain = [n for n, _ in names]
    signals = {}
    wanted: list[Input | Output] = [Input("time", "s"), *model.signals]
    known = [s.name for s in wanted]
    for renamed in columns:
        if renamed not in known:
            raise InputError(
                f"{path}, columns: the model has no signal '{renamed}'; {did_you_mean(renamed, known)}"
            )
    for signal in wanted:
        called, unit = split_column_name(columns.get(signal.name, signal.name))
        if called not in plain:
            raise InputError(
                f"{path}: there is no column '{called}'; {did_you_mean(called, plain)}"
                + ("" if columns else ", or say by columns={...} which column it is")
            )
        column = plain.index(called)
        values, bad = table.numbers(column)
        if bad:
            line = int(table.lines[bad[0][0]])
            raise InputError(
                f"{path}, line {line}, {signal.name}: '{bad[0][1]}' is no number; mend or cut the line"
            )
        unit = unit or names[column][1]
        where = f"{path}, column {table.names[column]}"
        try:
            signals[signal.name] = (
                values if unit is None else array_to_si(values, unit, signal.unit, where)
            )
        except InputError as problem:
            if signal.unit != "1":
                raise
            raise InputError(f"{problem}, or declare a unit of {signal.name}") from None
    return Record(name or path.stem, role, signals, conditions or {})


def check(model: Model, records: Sequence[Record]) -> tuple[Finding, ...]:
    """InputError for what is no record of this model; what cannot be true comes back as findings."""
    for role in ("identify", "validate"):
        if not any(r.role == role for r in records):
            raise InputError(
                f"{model.title}: no record has the role {role}; a diagnosis needs one to fit and another to judge on"
            )
    names = [r.name for r in records]
    twice = sorted({n for n in names if names.count(n) > 1})
    if twice:
        raise InputError(f"{model.title}: two records are named '{twice[0]}'; rename one")
    return tuple(found for record in records for found in check_record(model, record))


def check_record(model: Model, record: Record) -> list[Finding]:
    """The same of one record."""
    where = f"{model.title}, record {record.name}"
    wanted: list[Input | Output] = [Input("time", "s"), *model.signals]
    for signal in wanted:
        if signal.name not in record.signals:
            raise InputError(
                f"{where}: there is no signal '{signal.name}'; {did_you_mean(signal.name, record.signals)}"
            )
        values = np.asarray(record.signals[signal.name])
        if values.shape != np.shape(record.signals["time"]) or values.ndim != 1:
            raise InputError(
                f"{where}, {signal.name}: its shape is {values.shape}; every signal is one array as long as time"
            )
        if not np.all(np.isfinite(values)):
            first = int(np.flatnonzero(~np.isfinite(values))[0])
            raise InputError(f"{where}, {signal.name}: sample {first} is not finite; cut it out")
    time = np.asarray(record.signals["time"])
    if len(time) < 10:
        raise InputError(f"{where}: {len(time)} samples are too few; ten are the least")
    steps = np.diff(time)
    even = (time[-1] - time[0]) / len(steps)
    if not even > 0.0 or np.max(np.abs(time - time[0] - even * np.arange(len(time)))) > max(
        UNEVEN * even, 1e-12
    ):
        raise InputError(f"{where}: time is not even; interpolate all signals to a constant step")
    before = samples_before(model, even)
    if len(time) - before < 10:
        raise InputError(
            f"{where}: of {len(time)} samples {before} are as long as the longest dead time, and what acts then is not "
            "recorded; lower the upper bound of that parameter, or take a longer record"
        )
    known = [p.name for p in model.parameters]
    for name in record.conditions:
        if name not in known:
            raise InputError(
                f"{where}: there is no parameter '{name}' to change; {did_you_mean(name, known)}"
            )
    return [
        *(
            Finding(
                "error",
                record.name,
                None,
                output.name,
                f"the reading never changes from {float(record.signals[output.name][0]):g} {output.unit}",
                "look whether the sensor is alive, or leave the record out",
            )
            for output in model.outputs
            if np.ptp(record.signals[output.name]) == 0.0
        ),
        *(
            _of_range(model, record, output, int(at_end.sum()))
            for output, at_end in clipped(model, record).items()
        ),
    ]


def clipped(model: Model, record: Record) -> dict[str, NDArray[np.bool_]]:
    """Output -> (samples,) at which its reading is at an end of its range; only outputs that have such."""
    found = {}
    for output in model.outputs:
        if output.range is not None:
            low, high = output.range
            values, near = np.asarray(record.signals[output.name]), AT_END * (high - low)
            at_end = (values <= low + near) | (values >= high - near)
            if at_end.any():
                found[output.name] = at_end
    return found


def _of_range(model: Model, record: Record, name: str, at_end: int) -> Finding:
    output = next(o for o in model.outputs if o.name == name)
    low, high = output.range or (-np.inf, np.inf)
    return Finding(
        "warning",
        record.name,
        None,
        name,
        f"{at_end} of {len(record.signals['time'])} readings are at an end of the range from {low:g} to {high:g} "
        f"{output.unit}, and are compared with nothing",
        "choose a sensor of another range where what happens there matters",
    )
