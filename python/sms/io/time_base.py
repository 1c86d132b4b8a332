"""Signals that a logger took at times of their own, on one time base: the table that a record is.

The times of the table are those of the group with the most samples. The others are led onto them by straight lines;
before the first sample of the latest group and after the last of the earliest there is nothing to lead, so the table
begins and ends there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from sms.arrays import Array
from sms.errors import InputError
from sms.io.table import Remark, Table

LARGEST = 20_000_000
"""Numbers of one file: 160 MB as they are held. Judgement: a million rows of twenty channels."""
TIME = "time [s]"


@dataclass(frozen=True)
class Group:
    """Signals with common times."""

    name: str
    time: Array
    """(samples,) s"""
    signals: Mapping[str, NDArray[np.generic]]
    """"stroke [mm]" -> (samples,)"""


def named(name: str, unit: str | None) -> str:
    """As a column is named: "stroke [mm]"."""
    return f"{name} [{unit.strip()}]" if unit and unit.strip() else name


def raise_if_too_many(file: Path, numbers: int) -> None:
    """InputError before so much is held in memory."""
    if numbers > LARGEST:
        raise InputError(
            f"{file}: {numbers} numbers are more than the {LARGEST} that are read of one file; "
            "cut the record, or leave channels out where it is saved"
        )


def on_one_time(file: Path, groups: Sequence[Group]) -> Table:
    """All signals of a file; a name that several groups have is preceded by its group's. InputError for none."""
    groups = [g for g in groups if len(g.time) > 1 and g.signals]
    if not groups:
        raise InputError(
            f"{file}: there is no signal with times in it; save signals of numbers with their times"
        )
    for group in groups:
        if not np.all(np.diff(group.time) > 0.0):
            raise InputError(
                f"{file}: the times of '{_said(group)}' do not rise from sample to sample; save the log anew"
            )
    base = max(groups, key=lambda g: len(g.time))
    first, last = (pick(g.time[end] for g in groups) for pick, end in ((max, 0), (min, -1)))
    inside = (base.time >= first) & (base.time <= last)
    if np.count_nonzero(inside) < 2:
        raise InputError(
            f"{file}: its signals were not logged at the same time; there is nothing to compare"
        )
    time = base.time[inside]
    columns: dict[str, NDArray[np.generic]] = {TIME: time}
    remarks = []
    twice = {n for n, count in Counter(n for g in groups for n in g.signals).items() if count > 1}
    for group in groups:
        same = len(group.time) == len(base.time) and bool(np.all(group.time == base.time))
        for name, values in group.signals.items():
            called = f"{group.name}.{name}" if name in twice or name == TIME else name
            columns[called] = (
                values[inside]
                if same
                else np.asarray(np.interp(time, group.time, values.astype(np.float64)))
            )
        if not same:
            remarks.append(
                Remark(
                    None,
                    None,
                    f"'{_said(group)}' has times of its own, and is led onto those of '{_said(base)}' by straight "
                    "lines",
                    "log all signals at one rate where it matters",
                )
            )
    return _table(file, columns, {}, remarks)


def _said(group: Group) -> str:
    return next(iter(group.signals)) if len(group.signals) == 1 else group.name


def vectors(file: Path, arrays: Mapping[str, NDArray[np.generic]]) -> Table:
    """A table of the vectors that have the most common length (of equals, the largest)."""
    if not arrays:
        raise InputError(f"{file}: there is no vector of numbers in it; save each signal as one")
    counts = Counter(array.size for array in arrays.values())
    length = max(counts, key=lambda size: (counts[size], size))
    kept = {name: array for name, array in arrays.items() if array.size == length}
    others = {name: array.size for name, array in arrays.items() if array.size != length}
    return _table(file, kept, others, ())


def _table(
    file: Path,
    columns: Mapping[str, NDArray[np.generic]],
    others: Mapping[str, int],
    remarks: Iterable[Remark],
) -> Table:
    rows = len(next(iter(columns.values())))
    cells = pd.DataFrame({i: np.asarray(array) for i, array in enumerate(columns.values())})
    return Table(file, tuple(columns), cells, np.arange(1, rows + 1), others, tuple(remarks))
