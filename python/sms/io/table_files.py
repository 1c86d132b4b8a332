"""Files into tables of numbers: CSV and its relatives (also .gz), Parquet, and by their own modules MATLAB's .mat
(matlab_files.py), logs of measurement systems (measurement_files.py) and of a bus (can_logs.py).

Nothing is dropped or repaired here: a cell that is not a number becomes NaN and is remembered with
its line, so that the data check can name it.
"""

from __future__ import annotations

import csv
import gzip
import io
import re
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from sms.errors import InputError
from sms.io.matlab_files import read_matlab
from sms.io.measurement_files import (
    ENDINGS,
    holds_frames,
    measurement_format,
    read_measurement,
)
from sms.io.table import Table, ending_of, is_packed, renamed

TEXT_ENDINGS = (".csv", ".txt", ".dat", ".tsv", ".asc", ".log")
_CAN_ENDINGS = (".blf", ".mf4", ".trc", ".db")
_CAN_OPENINGS = {  # the first line of a CAN log that is text; a table may have the same ending
    ".asc": r"\s*(date|//|base)\b",
    ".csv": r"timestamp,arbitration_id,extended,remote,error,dlc,data\s*$",
    ".log": r"\(\d+\.\d+\) \S+ [0-9A-Fa-f]+#",
}
_SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "whitespace": r"\s+"}
_HEADER_WORD = re.compile(r"[^\s\[\]]+(?:\s*\[[^\]]*\])?")


def is_can_log(file: Path) -> bool:
    """Whether a file holds CAN frames, by its ending and, for text, by its first line; packed (.gz) or not."""
    ending = ending_of(file)
    if ending == ".mf4":
        return measurement_format(file) is None or holds_frames(file)
    if ending not in _CAN_OPENINGS:
        return ending in _CAN_ENDINGS
    try:
        with (gzip.open if is_packed(file) else open)(file, "rb") as opened:
            first = opened.readline(200).decode("utf-8", "replace")
    except (OSError, EOFError, zlib.error):
        return False
    return re.match(_CAN_OPENINGS[ending], first) is not None


def delimiter_of(file: Path) -> str:
    """What most likely separates the columns of a file; "comma" for what is no text.

    The separator that finds as many cells in the header as in the numbers below it: decimal commas do not.
    """
    if ending_of(file) not in TEXT_ENDINGS or measurement_format(file) or is_can_log(file):
        return "comma"
    lines = [line for line in text_of_file(file).splitlines() if line.strip(" \t,;")]
    looked_at = [line for line in lines if not line.lstrip().startswith("#")][:LOOKED_AT]

    def cells(name: str) -> tuple[bool, int]:
        counts = [len(_split(line, name)) for line in looked_at] or [1]
        return counts[0] > 1 and len(set(counts)) == 1, min(counts)

    return max(("tab", "semicolon", "comma", "whitespace"), key=lambda n: (*cells(n), n == "comma"))


def read_table(file: Path, delimiter: str, columns: Sequence[str] | None) -> Table:
    """Read a file by its ending; of a CAN log everything that the controller told, see can_logs.py.

    `delimiter` ("comma", "semicolon", "tab", "whitespace") is for text files; `columns` names the
    columns of a file that has no header line, or of the one matrix of a .mat file.
    """
    if is_can_log(file):
        from sms.io.can_logs import read_telemetry  # noqa: PLC0415 (python-can takes its time)

        return read_telemetry(file)
    ending = ending_of(file)
    if ending == ".mat" and not is_packed(file):
        return read_matlab(file, columns)
    if (form := measurement_format(file)) is not None:
        return read_measurement(file, form)
    if ending in TEXT_ENDINGS:
        return _read_text(file, delimiter, columns)
    if ending == ".parquet":
        return _read_parquet(file)
    raise InputError(
        f"{file}: files with the ending '{ending}' are not read; save it as .csv "
        f"(readable: {', '.join(TEXT_ENDINGS)}, each also .gz, .mat, .parquet, {', '.join(ENDINGS)}; "
        "CAN logs .asc, .csv, .log, .trc, each also .gz, .blf, .mf4, .db)"
    )


def open_table(
    file: Path,
    columns: Mapping[str, str] | None = None,
    dbc: Path | None = None,
    delimiter: str = "comma",
) -> Table:
    """A record as the commands take it: columns that are called otherwise (signal -> column), and the definition of
    the bus whose frames a CAN log holds; None: the project's own. InputError for a DBC without such a log.
    """
    if not file.is_file():
        raise InputError(f"{file}: there is no such file; check the path")
    if dbc is not None:
        if not is_can_log(file):
            raise InputError(
                f"{file}: --dbc is for logs of CAN frames, and this is none; leave it out"
            )
        from sms.io.can_logs import read_bus  # noqa: PLC0415 (python-can takes its time)

        table = read_bus(file, dbc)
    else:
        table = read_table(file, delimiter, None)
    return renamed(table, columns or {})


LARGEST_TEXT = 128 * 2**20
"""bytes of a file of text, unpacked: a million lines of ten columns. The table in memory takes ten times as much."""


def text_of_file(file: Path) -> str:
    """The text of a file, unpacked if its name ends with .gz; InputError for what cannot be read or is far too long.

    No more is unpacked than is read.
    """
    try:
        with (gzip.open if is_packed(file) else open)(file, "rb") as opened:
            content = opened.read(LARGEST_TEXT + 1)
    except (gzip.BadGzipFile, EOFError, zlib.error):
        raise InputError(f"{file}: broken or cut-off gzip file; copy it again") from None
    except OSError as problem:
        raise InputError(f"{file}: cannot be read ({problem.strerror}); check the file") from None
    if len(content) > LARGEST_TEXT:
        raise InputError(
            f"{file}: more than {LARGEST_TEXT // 2**20} MiB of text; split the record, or log at a lower rate"
        )
    encoding = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        return content.decode(encoding)
    except UnicodeDecodeError:  # Western European text of an older logger; numbers read the same
        return content.decode("latin-1")


def _read_text(file: Path, delimiter: str, columns: Sequence[str] | None) -> Table:
    return table_of_text(file, text_of_file(file), delimiter, columns)


def table_of_text(
    file: Path, text: str, delimiter: str, columns: Sequence[str] | None = None
) -> Table:
    """A table of the text of a file, or of its header and some of its lines; as read_table has it."""
    numbered = [
        (number, line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not numbered:
        raise InputError(f"{file}: the file is empty; record it again or leave it out")
    first = _split(numbered[0][1], delimiter)
    if len(first) == 1:  # no record has one column
        other = max(_SEPARATORS, key=lambda name: len(_split(numbered[0][1], name)))
        raise InputError(
            f"{file}, line {numbered[0][0]}: one column only when separated by {delimiter}; "
            f'write delimiter = "{other}" in [data], or check the file'
        )
    looked_at = [cell for _, line in numbered[1:LOOKED_AT] for cell in _split(line, delimiter)]
    decimal = "," if _has_decimal_commas(looked_at) else "."
    has_header = not (
        any(map(_is_number, first)) or (decimal == "," and _has_decimal_commas(first))
    )
    if columns is None:
        if not has_header:
            raise InputError(
                f"{file}, line {numbered[0][0]}: there is no header line; "
                "name the columns in the rig file, [data] columns = [...]"
            )
        columns, numbered = first, numbered[1:]
        if _are_frames(columns):
            raise InputError(
                f"{file}: these are frames of a bus as another program writes them, their bytes in hexadecimal digits; "
                "save them as .blf, .asc, .trc or candump's .log, which are read with a DBC"
            )
    elif has_header:
        raise InputError(
            f"{file}, line {numbered[0][0]}: the file has a header line ('{first[0]}' ...); "
            "remove columns from [data] in the rig file"
        )
    if not numbered:
        raise InputError(f"{file}: there is a header line but no data below it; record it again")
    cells = _parse_cells(file, delimiter, decimal, numbered)
    cells = _without_trailing_delimiter(cells, len(columns))
    if cells.shape[1] != len(columns):
        raise InputError(
            f"{file}, line {numbered[0][0]}: {cells.shape[1]} columns, but {len(columns)} names "
            f"({', '.join(columns)}); check delimiter (now '{delimiter}') and columns in [data]"
        )
    lines = np.array([number for number, _ in numbered], dtype=np.int64)
    return Table(file, tuple(columns), cells, lines, {})


def _split(line: str, delimiter: str) -> list[str]:
    """The cells of one line; in a whitespace table "stroke [mm]" is one cell."""
    if delimiter == "whitespace":
        return _HEADER_WORD.findall(line)
    cells = next(csv.reader([line], delimiter=_SEPARATORS[delimiter], skipinitialspace=True))
    cells = [cell.strip() for cell in cells]
    return cells[:-1] if len(cells) > 1 and not cells[-1] else cells


_IDENTIFIER = re.compile(
    r"(?:can|message|msg|arbitration)?[ _]?id(?:entifier)?(?: ?\(hex\))?", re.I
)
_BYTES = re.compile(r"(?:data)? ?_?bytes?|data(?: ?\(hex\))?|(?:d|b|byte|data)[ _]?0?[01]", re.I)


def _are_frames(names: Sequence[str]) -> bool:
    """Whether columns are an identifier and the bytes of a frame: as decimal numbers they would be a wrong table."""
    return any(map(_IDENTIFIER.fullmatch, names)) and any(map(_BYTES.fullmatch, names))


LOOKED_AT = 50
"""Lines of a table that tell how its numbers are written."""
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?|[+-]?\d+")


def _has_decimal_commas(cells: Sequence[str]) -> bool:
    """Whether numbers are written as in "0,005": some are, and all others are whole numbers, or missing."""
    filled = [cell for cell in cells if cell]
    return any("," in cell for cell in filled) and all(map(_DECIMAL_COMMA.fullmatch, filled))


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _parse_cells(
    file: Path, delimiter: str, decimal: str, numbered: list[tuple[int, str]]
) -> pd.DataFrame:
    text = "\n".join(line.strip() if delimiter == "whitespace" else line for _, line in numbered)
    try:
        return pd.read_csv(
            io.StringIO(text),
            sep=_SEPARATORS[delimiter],
            header=None,
            decimal=decimal,
            keep_default_na=False,
            low_memory=False,
        )
    except pd.errors.ParserError as problem:
        found = re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", str(problem))
        if found is None:
            raise InputError(f"{file}: not a table ({problem}); check [data] delimiter") from None
        raise InputError(
            f"{file}, line {numbered[int(found[2]) - 1][0]}: {found[3]} cells, but "
            f"{found[1]} in the lines before; repair the line or check [data] delimiter"
        ) from None


def _without_trailing_delimiter(cells: pd.DataFrame, expected: int) -> pd.DataFrame:
    """Drop the empty last column that a delimiter at the end of every line makes."""
    if cells.shape[1] == expected + 1 and bool(cells.iloc[:, -1].isin([""]).all()):
        return cells.iloc[:, :-1]
    if cells.shape[1] == expected + 1 and bool(cells.iloc[:, -1].isna().all()):
        return cells.iloc[:, :-1]
    return cells


def _read_parquet(file: Path) -> Table:
    try:
        cells = pd.read_parquet(file)
    except ImportError:
        raise InputError(
            f"{file}: reading Parquet needs one more package; pip install pyarrow, or save as .csv"
        ) from None
    except Exception as problem:  # the engine behind pandas has errors of its own
        raise InputError(f"{file}: not a readable Parquet file ({problem})") from None
    if cells.empty:
        raise InputError(f"{file}: the file is empty; record it again")
    names = tuple(str(name) for name in cells.columns)
    return Table(file, names, cells, np.arange(1, len(cells) + 1), {})
