"""The columns that all records of a rig have: their headers and their readings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from sms.draft.header import Header, header_of
from sms.errors import InputError
from sms.io.table import Table
from sms.io.table_files import delimiter_of, is_can_log, read_table

EVEN = 0.5  #: of the median step: how far steps of a column that can be time may be off it


@dataclass(frozen=True, eq=False)
class Column:
    """One column, over all records."""

    name: str  #: as it stands in the files
    header: Header
    parts: tuple[NDArray[np.float64], ...]  #: readings, one array a record
    holes: int  #: cells that are no numbers

    @cached_property
    def readings(self) -> NDArray[np.float64]:
        """Those that are numbers."""
        together = np.concatenate(self.parts)
        return together[np.isfinite(together)]

    @property
    def step(self) -> float | None:
        """The median step, of a column that runs evenly upwards in every record, as time does."""
        steps = [np.diff(part) for part in self.parts]
        if any(s.size < 2 or not np.all(s > 0.0) for s in steps):
            return None
        medians = [float(np.median(s)) for s in steps]
        even = all(np.all(np.abs(s / m - 1.0) < EVEN) for s, m in zip(steps, medians, strict=True))
        return medians[0] if even else None


@dataclass(frozen=True, eq=False)
class Columns:
    """What the records have in common."""

    files: tuple[Path, ...]
    delimiter: str  #: of the text files
    names: tuple[str, ...] | None  #: of columns, where the files have no header line
    columns: tuple[Column, ...]

    def called(self, name: str) -> Column | None:
        """By its whole name, or by its name without the unit."""
        for column in self.columns:
            if column.name == name:
                return column
        found = [column for column in self.columns if column.header.name == name]
        return found[0] if len(found) == 1 else None

    @property
    def listed(self) -> str:
        """Their names, for a sentence."""
        return ", ".join(f"'{column.name}'" for column in self.columns)


def read_columns(files: Sequence[Path], names: Sequence[str] | None) -> Columns:
    """Read the records of one rig. InputError for what is no table, or has not the columns of the others."""
    for file in files:
        if is_can_log(file):
            raise InputError(
                f"{file}: a CAN log; make a table of it first, sms can table {file.name} --out run.csv"
            )
    delimiters = [delimiter_of(file) for file in files]
    for file, delimiter in zip(files, delimiters, strict=True):
        if delimiter != delimiters[0]:
            raise InputError(
                f"{file}: its columns are separated by {delimiter}, those of {files[0].name} by {delimiters[0]}; "
                "save all records of a rig alike"
            )
    try:
        tables = [read_table(file, delimiters[0], names) for file in files]
    except InputError as problem:
        _in_words_of_options(problem)
    shared = [n for n in tables[0].names if all(n in table.names for table in tables)]
    if len(shared) < 2 and len(files) > 1:
        raise InputError(
            f"{files[0]}: its columns are not those of {files[1].name}; a rig's records have the same columns"
        )
    return Columns(
        tuple(files),
        delimiters[0],
        None if names is None else tuple(names),
        tuple(_column(name, tables) for name in dict.fromkeys(shared)),
    )


def _in_words_of_options(problem: InputError) -> NoReturn:
    """There is no rig file yet, into which something could be written."""
    said = str(problem)
    if "there is no header line" in said:
        place = said.partition(": there is no header line")[0]
        raise InputError(
            f'{place}: there is no header line; name the columns with --names "time [s],u [V],..."'
        ) from None
    if "the file has a header line" in said:
        raise InputError(f"{said.partition(';')[0]}; leave --names out") from None
    raise problem


def _column(name: str, tables: Sequence[Table]) -> Column:
    parts, holes = [], 0
    for table in tables:
        values, bad = table.numbers(table.names.index(name))
        parts.append(values)
        holes += len(bad)
    return Column(name, header_of(name), tuple(parts), holes)
