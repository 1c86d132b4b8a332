"""A table of one file, as it stands there, and what a file's name says of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

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


def is_packed(file: Path) -> bool:
    """Whether a file is packed by gzip, by its name."""
    return file.name.lower().endswith(".gz")


def ending_of(file: Path) -> str:
    """What the name says of the format, without what it says of packing: ".asc" of "Run.ASC.gz"."""
    return Path(file.name.lower().removesuffix(".gz")).suffix
