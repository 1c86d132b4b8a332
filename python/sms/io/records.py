"""Records: one measured run as signals in SI units; cells that are no numbers are remembered.

`load_record` raises InputError when a file cannot be a record at all (missing, empty, wrong column
or unit); what is wrong inside it is collected as findings, see check.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sms.errors import InputError, did_you_mean
from sms.io.rig import RecordSource, Rig, Role
from sms.io.signal_sources import SignalSource
from sms.io.signals import SIGNAL_UNITS, SIMULATED, without_leg
from sms.io.table import Table
from sms.io.table_files import is_can_log, read_table
from sms.io.units import array_to_si, split_column_name

Severity = Literal["error", "warning", "note"]


def in_words(
    file: Path | str, line: int | None, signal: str | None, message: str, remedy: str
) -> str:
    """What a data check saw, in one sentence: "r.csv, line 3, extension: the cell is empty; repair the line"."""
    at = f", line {line}" if line is not None else ""
    of = f", {signal}" if signal is not None else ""
    return f"{file}{at}{of}: {message}; {remedy}"


@dataclass(frozen=True)
class Finding:
    """One thing that the data check saw: where, what, and what to do about it."""

    severity: Severity  #: error: cannot be used; warning: used, look at it; note: good to know
    file: Path
    line: int | None  #: line of a text file, row of .mat and .parquet, from 1; None: all of it
    signal: str | None  #: None: the record as a whole
    message: str
    remedy: str

    def __str__(self) -> str:
        return in_words(self.file, self.line, self.signal, self.message, self.remedy)


@dataclass(frozen=True, eq=False)
class Record:
    """One measured run. Each signal is an array (samples,) in SI units, as measured."""

    name: str
    role: Role
    file: Path
    signals: Mapping[str, NDArray[np.float64]]
    gauge: frozenset[str]  #: signals that were measured against ambient and still are
    findings: tuple[Finding, ...]  #: from reading; `check_record` adds to them
    lines: NDArray[np.int64]  #: (samples,) line of the file that each sample stands in
    skipped: int = 0  #: samples at its start that are not used and still here

    @property
    def first_line(self) -> int:
        """The line of the first sample."""
        return int(self.lines[0])

    def __len__(self) -> int:
        """The number of samples."""
        return self.lines.size

    def used(self, signal: str) -> NDArray[np.float64]:
        """A signal without the samples that are skipped at the start."""
        return self.signals[signal][self.skipped :]

    def finding(
        self, severity: Severity, index: int | None, signal: str | None, message: str, remedy: str
    ) -> Finding:
        """A finding at one sample of this record, or (None) about all of it."""
        line = None if index is None else int(self.lines[index])
        return Finding(severity, self.file, line, signal, message, remedy)


def load_record(rig: Rig, source: RecordSource) -> Record:
    """Read one record of a rig into project signals in SI units.

    Cells that are not numbers are NaN in the arrays and stand in `findings`. The samples that the rig file skips at the
    start are dropped where all of a record is simulated; elsewhere they still serve for the speed at its first ones.
    """
    record = record_of(rig, source, _read(rig, source.file))
    if rig.kind not in SIMULATED or not record.skipped:
        return record
    if record.skipped >= len(record):
        raise InputError(
            f"{source.file}: skip_first leaves none of its {len(record)} samples; lower it in {rig.path}, [data]"
        )
    signals = {name: values[record.skipped :] for name, values in record.signals.items()}
    return replace(record, signals=signals, lines=record.lines[record.skipped :], skipped=0)


def record_of(rig: Rig, source: RecordSource, table: Table) -> Record:
    """The same of a table that has been read."""
    signals: dict[str, NDArray[np.float64]] = {}
    findings = [
        Finding("warning", source.file, r.line, r.column, r.message, r.remedy)
        for r in table.remarks
    ]
    for signal, wanted in rig.signals.items():
        column = _find_column(table, wanted, rig)
        if column is None:
            _spared(signal, source)
            continue
        values, bad = table.numbers(column)
        signals[signal] = _in_si(values, table.names[column], wanted, source.file)
        findings += _bad_cells(bad, signal, table, rig.skip_first)
    return Record(
        name=source.name,
        role=source.role,
        file=source.file,
        signals=signals,
        gauge=frozenset(s for s, wanted in rig.signals.items() if wanted.gauge and s in signals),
        findings=tuple(findings),
        lines=table.lines,
        skipped=rig.skip_first,
    )


def _spared(signal: str, source: RecordSource) -> None:
    """InputError for a set-point that a record lacks whose controller is simulated."""
    if source.control.controller == "simulated" and without_leg(signal) == "setpoint":
        raise InputError(
            f"{source.file}: there is no column for the signal '{signal}', which a simulated controller needs; record "
            'it, or write control = { controller = "recorded" } for this record'
        )


def _read(rig: Rig, file: Path) -> Table:
    """The table of a record: columns of a file, or a CAN log decoded by the rig's DBC."""
    if not is_can_log(file):
        return read_table(file, rig.layout.delimiter, rig.layout.columns)
    from sms.io.can_frames import load_dbc  # noqa: PLC0415 (python-can takes its time)
    from sms.io.can_logs import read_can_log  # noqa: PLC0415

    wanted = {source.column: source.optional for source in rig.signals.values()}
    return read_can_log(file, load_dbc(rig.layout.dbc), wanted)


def _find_column(table: Table, wanted: SignalSource, rig: Rig) -> int | None:
    """The column of a signal by its whole name or its name without unit; None if it may lack."""
    plain = [split_column_name(name)[0] for name in table.names]
    for known in (list(table.names), plain):
        found = [i for i, name in enumerate(known) if name == wanted.column]
        if len(found) > 1:
            names = [table.names[i] for i in found]
            remedy = (
                f"in {rig.path}, [signals] {wanted.signal}, write the one meant with its unit in "
                f"brackets ({', '.join(names)})"
                if len(set(names)) == len(names)
                else "give each a name of its own in the header line"
            )
            raise InputError(
                f"{table.file}: {len(found)} columns are named '{wanted.column}'; {remedy}"
            )
        if found:
            return found[0]
    if wanted.optional:
        return None
    where = f"{table.file}: there is no column '{wanted.column}' for the signal '{wanted.signal}'"
    if wanted.column in table.other_lengths:
        raise InputError(
            f"{where} of the same length: it has {table.other_lengths[wanted.column]} values, the "
            f"other signals have {len(table.lines)}; save all signals equally long"
        )
    raise InputError(
        f"{where} ({rig.path}, [signals] {wanted.signal}); "
        f"{did_you_mean(split_column_name(wanted.column)[0], plain)}"
    )


def _in_si(
    values: NDArray[np.float64], name: str, wanted: SignalSource, file: Path
) -> NDArray[np.float64]:
    """scale * column in SI + offset, with the unit from [signals] or from the column's name.

    What a converter rounded down lies half a step above on the average, in the sense in which the column counts.
    """
    si_unit = SIGNAL_UNITS[wanted.signal]
    unit = wanted.unit if wanted.unit is not None else split_column_name(name)[1]
    if unit is None:
        raise InputError(
            f"{file}: the column '{name}' for '{wanted.signal}' has no unit; name it "
            f"'{name} [{si_unit}]' or write unit = \"{si_unit}\" in [signals] {wanted.signal}"
        )
    where = f"{file}, column '{name}' for the signal '{wanted.signal}'"
    up = 0.5 * wanted.resolution if wanted.rounding == "down" else 0.0
    read = wanted.scale * array_to_si(values, unit, si_unit, where) + wanted.offset
    return read + float(np.copysign(up, wanted.scale))


def _bad_cells(
    bad: list[tuple[int, str]], signal: str, table: Table, skip_first: int
) -> list[Finding]:
    """Cells that are not numbers: a note among the samples that are skipped, else an error."""
    skipped = [cell for cell in bad if cell[0] < skip_first]
    used = [cell for cell in bad if cell[0] >= skip_first]
    findings = []
    groups: tuple[tuple[list[tuple[int, str]], Severity], ...] = (
        (skipped, "note"),
        (used, "error"),
    )
    for cells, severity in groups:
        if cells:
            index, text = cells[0]
            what = f"'{text}' is not a number" if text else "the cell is empty"
            more = f" (and {len(cells) - 1} more in this column)" if len(cells) > 1 else ""
            remedy = (
                "not used, because it lies within skip_first"
                if severity == "note"
                else "repair or remove the line; numbers are written with a decimal point"
            )
            line = int(table.lines[index])
            findings.append(Finding(severity, table.file, line, signal, what + more, remedy))
    return findings
