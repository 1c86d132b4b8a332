"""What is done to tables: cells, columns, time, values, layout; and the same tables as Parquet and .mat."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import scipy.io

from validation.fuzz.mutations import (
    NAMES,
    NUMBERS,
    UNITS,
    Mutation,
    Random,
    pick,
    spoil_bytes,
    spoil_encoding,
)

Rows = list[list[str]]
Odd = Callable[[Any], Any]


def _table(content: bytes) -> tuple[list[str], Rows]:
    lines = content.decode("utf-8", "replace").splitlines()
    head, *rows = [line.split(",") for line in lines] or [[""]]
    return head, rows


def _written(head: list[str], rows: Rows, separator: str = ",") -> bytes:
    text = "\n".join(separator.join(row) for row in [head, *rows]) + "\n"
    return text.encode("utf-8", "surrogatepass")


def spoil_cells(content: bytes, random: Random) -> bytes:
    """Some cells of a column, or of rows."""
    head, rows = _table(content)
    column, how = int(random.integers(len(head))), int(random.integers(7))
    cell = pick((*NUMBERS, "NaN", "", "NULL", "-", "1,5", "1;5"), random)
    first = int(random.integers(max(len(rows), 1)))
    for row in rows[first : first + pick((1, 1, 3, 60, 10**6), random)]:
        if how == 0:
            row[column:] = [cell] * (len(row) - column)
        elif how == 1:
            del row[column:]
        elif how == 2:
            row.insert(column, cell)
        elif column < len(row):
            row[column] = cell
    return _written(head, rows)


def spoil_columns(content: bytes, random: Random) -> bytes:
    """Swapped, missing, doubled, constant; or a header that says otherwise, or nothing."""
    head, rows = _table(content)
    i, j = (int(k) for k in random.integers(len(head), size=2))
    how = int(random.integers(8))
    for row in [row for row in [head, *rows] if len(row) == len(head)]:
        if how == 0:
            row[i], row[j] = row[j], row[i]
        elif how == 1:
            del row[i]
        elif how == 2:
            row.insert(j, row[i])
        elif how == 3 and row is not head and len(rows[0]) == len(head):
            row[i] = rows[0][i]
    if how == 4:
        head[i] = pick(NAMES, random)
    elif how == 5:
        head[i] = re.sub(r"\[.*\]", f"[{pick(UNITS, random)}]", head[i])
    elif how == 6:
        head = rows[0] if rows else []
    elif how == 7:
        head, rows = (
            head + [f"x{k} [m]" for k in range(2000)],
            [r + ["0"] * 2000 for r in rows[:50]],
        )
    return _written(head, rows)


def spoil_time(content: bytes, random: Random) -> bytes:
    """Its unit, direction, gaps, length and rate."""
    head, rows = _table(content)
    try:
        table = np.array(rows, dtype=np.float64)
        time = table[:, 0].copy()
    except (ValueError, IndexError):  # spoilt before
        return content
    how, middle = int(random.integers(14)), max(len(time) // 2, 1)
    step = time[1] - time[0] if time.size > 1 else 0.01
    if how <= 4:
        with np.errstate(all="ignore"):  # a cell may be infinite by now
            table[:, 0] = (time * 1e3, time / 1e3, time[::-1], 0.0 * time, time * 1e40)[how]
    elif how == 5:
        table[middle:, 0] += pick((1.0, 1e6, -1.0, 1e-9, 1e300), random)
    elif how == 6:
        table = np.delete(table, slice(middle, middle + int(random.integers(2, 100))), axis=0)
    elif how <= 9:
        table = (table[:5], table[:1], table[: int(random.integers(6, 120))])[how - 7]
    elif how == 10:
        table = table[:: max(round(0.25 / step), 1)] if step > 0.0 else table[::50]
    elif how == 11:
        fine = np.arange(60_000) / 20_000.0
        table = np.column_stack([fine, *(np.interp(fine, time, c) for c in table[:, 1:].T)])
    elif how == 12:
        table[:, 0] = random.permutation(time)
    else:
        table[:, 0] += pick((1e9, 1e15, -5.0), random) + random.normal(0.0, 0.2, time.size) * step
    return _written(head, [[f"{x:.10g}" for x in row] for row in table])


def spoil_values(content: bytes, random: Random) -> bytes:
    """A channel in another unit, of another sign, stuck, noisy, coarse, huge or tiny."""
    head, rows = _table(content)
    column = int(random.integers(len(head)))
    factor = pick((1e3, 1e-5, -1.0, 0.0, 1e150, 1e40, 1e8, 1e-40, 1e-300), random)
    plus, steps = pick((0.0, 0.0, 1e308, 1e5), random), pick((None, None, 1, 3), random)
    noise = pick((0.0, 0.0, 1.0), random)
    for row in rows:
        try:
            value = factor * float(row[column]) + plus + noise * random.normal()
            row[column] = repr(value if steps is None else round(value, steps))
        except (ValueError, IndexError, OverflowError):
            continue
    return _written(head, rows)


def spoil_layout(content: bytes, random: Random) -> bytes:
    """Another separator, decimal commas, lines that are none."""
    head, rows = _table(content)
    options = (
        _written(head, [[c.replace(".", ",") for c in row] for row in rows], ";"),
        _written(head, rows, pick((";", "\t", " ", "|", ", "), random)),
        content.replace(b"\n", pick((b"\r", b"\r\r\n", b"\n\n", b"\n# x\n"), random)),
        b"logger 3000\nstarted: now\n\n" + content,
        content.replace(b",", b'","', int(random.integers(1, 30))),
        content.replace(b"\n", b"\n\x00", 3) + b"\x1a",
    )
    return pick(options, random)


TABLES: tuple[Mutation, ...] = (
    spoil_cells, spoil_columns, spoil_time, spoil_values, spoil_layout, spoil_encoding, spoil_bytes,
)  # fmt: skip
_ODD_COLUMNS: tuple[Odd, ...] = (
    lambda c: c, lambda c: c.astype(str), lambda c: c > c.median(), lambda c: c.astype("category"),
    lambda c: pd.to_datetime(c, unit="s", errors="coerce"), lambda c: pd.to_timedelta(c, unit="s"),
    lambda c: c.astype("float32"), lambda c: c.mask(c > c.median()).astype("Float64"), lambda c: [None] * len(c),
    lambda c: [[x] for x in c], lambda c: [{"a": x} for x in c], lambda c: [str(x).encode() for x in c],
)  # fmt: skip
_ODD_VARIABLES: tuple[Odd, ...] = (
    lambda a: a, lambda a: a + 1j, lambda a: np.tile(a, (2, 2, 1)), lambda a: "text", lambda a: a[:0],
    lambda a: np.array([a, "x"], dtype=object), lambda a: {"t": a, "s": {"u": a}}, lambda a: 5.0, lambda a: a > 0,
    lambda a: a[: a.size // 2], lambda a: a.astype("int8"), lambda a: a.reshape(-1, 1),
    lambda a: np.array([(1, 2.0)], dtype=[("a", int), ("b", float)]),
)  # fmt: skip


def as_parquet(content: bytes, random: Random) -> bytes:
    """As Parquet, with a column of an odd type."""
    frame = pd.read_csv(io.BytesIO(content))
    column = pick(list(frame.columns), random)
    frame[column] = pick(_ODD_COLUMNS, random)(frame[column])
    buffer = io.BytesIO()
    frame.to_parquet(buffer, index=bool(random.integers(2)))
    return _sometimes_spoilt(buffer.getvalue(), random)


def as_matlab(content: bytes, random: Random) -> bytes:
    """As .mat, with a variable of an odd type."""
    frame = pd.read_csv(io.BytesIO(content))
    arrays: dict[str, Any] = {str(c).partition(" [")[0]: frame[c].to_numpy() for c in frame.columns}
    one = pick(list(arrays), random)
    with np.errstate(all="ignore"):
        arrays[one] = pick(_ODD_VARIABLES, random)(arrays[one])
    buffer: Any = io.BytesIO()
    scipy.io.savemat(buffer, arrays, do_compression=bool(random.integers(2)))
    return _sometimes_spoilt(buffer.getvalue(), random)


def _sometimes_spoilt(content: bytes, random: Random) -> bytes:
    return spoil_bytes(content, random) if random.integers(3) == 0 else content
