"""A table of one file, as it stands there, and what a file's name says of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from sms.errors import InputError, did_you_mean
from sms.io.units import split_column_name

LARGEST_NUMBER = 1e50
"""A cell beyond it is as little a reading as "inf": no unit makes it one, and its powers overflow."""


@dataclass(frozen=True)
class Remark:
    """Something seen while reading a file that its user should know; the samples are used."""

    line: int | None  #: as in `Table.lines`; None: the file as a whole
    column: str | None
    message: str
    remedy: str


@dataclass(frozen=True, eq=False)
class Table:
    """Named columns of one file, as they stand there."""

    file: Path
    names: tuple[str, ...]  #: "stroke [mm]"
    cells: pd.DataFrame  #: columns 0 to n - 1, numbers or text
    lines: NDArray[np.int64]  #: (samples,) line (in .mat and .parquet: row) of each sample
    other_lengths: Mapping[str, int]  #: vectors of a .mat file that are not as long as the rest
    remarks: tuple[Remark, ...] = ()

    def numbers(self, column: int) -> tuple[NDArray[np.float64], list[tuple[int, str]]]:
        """One column as numbers (samples,), and the cells that are none: (index, their text)."""
        cells = self.cells.iloc[:, column]
        numeric = pd.api.types.is_numeric_dtype(cells) and not pd.api.types.is_bool_dtype(cells)
        plain = cells if numeric else cells.astype(str).str.strip()
        values = np.array(pd.to_numeric(plain, errors="coerce"), dtype=np.float64)
        bad = np.flatnonzero(~(np.abs(values) < LARGEST_NUMBER))
        texts = ["" if pd.isna(cells.iloc[i]) else str(cells.iloc[i]).strip() for i in bad]
        values[bad] = np.nan
        return values, [(int(i), text) for i, text in zip(bad, texts, strict=True)]


def renamed(table: Table, columns: Mapping[str, str]) -> Table:
    """The table with other names: signal -> column, "stroke [mm]" or "stroke"; a unit that is said holds.

    InputError for a column that is not there, or a name that two columns would have.
    """
    names, plain = list(table.names), [split_column_name(name)[0] for name in table.names]
    for signal, column in columns.items():
        wanted, unit = split_column_name(column)
        if wanted not in plain:
            raise InputError(
                f"{table.file}: there is no column '{wanted}' for {signal}; {did_you_mean(wanted, plain)}"
            )
        place = plain.index(wanted)
        unit = unit or split_column_name(table.names[place])[1]
        names[place] = signal if unit is None else f"{signal} [{unit}]"
    now = [split_column_name(name)[0] for name in names]
    for signal in columns:
        if now.count(signal) > 1:
            raise InputError(
                f"{table.file}: there is a column '{signal}' already; rename it too, or leave --column {signal} out"
            )
    return replace(table, names=tuple(names))


def is_packed(file: Path) -> bool:
    """Whether a file is packed by gzip, by its name."""
    return file.name.lower().endswith(".gz")


def ending_of(file: Path) -> str:
    """What the name says of the format, without what it says of packing: ".asc" of "Run.ASC.gz"."""
    return Path(file.name.lower().removesuffix(".gz")).suffix
