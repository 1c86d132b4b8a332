"""What is read of logs that other programs wrote: one line a file, its rows or frames, or the sentence of refusal.

python -m validation.link.other_logs FOLDER ...

The files are not part of this repository; those that docs/logs.md names are the test files of python-can, asammdf,
npTDMS and cantools, in the source archives of these packages.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from sms.errors import InputError
from sms.io.can_files import read_frames
from sms.io.can_frames import load_dbc
from sms.io.table import Table, ending_of
from sms.io.table_files import TEXT_ENDINGS, is_can_log, read_table

TRIED = (
    *TEXT_ENDINGS, ".blf", ".mf4", ".mdf", ".trc", ".db", ".mat", ".parquet", ".tdms", ".mcap", ".h5", ".hdf5", ".dbc"
)  # fmt: skip


def read(file: Path) -> tuple[str, str]:
    """("frames" | "table" | "definition" | "refused", what of it)."""
    try:
        if ending_of(file) == ".dbc":
            return "definition", f"{len(load_dbc(file).messages)} messages"
        if is_can_log(file):
            frames = list(read_frames(file))
            numbers = {f.arbitration_id for f in frames}
            return "frames", f"{len(frames)} frames, {len(numbers)} identifiers"
        return "table", _rows(read_table(file, "comma", None))
    except InputError as refused:
        return "refused", str(refused).replace(f"{file.parent}/", "")


def _rows(table: Table) -> str:
    finite = [bool(np.isfinite(table.numbers(k)[0]).all()) for k in range(len(table.names))]
    return (
        f"{len(table.lines)} rows, {len(table.names)} columns, {sum(finite)} of numbers throughout"
    )


def files_in(folders: list[Path]) -> Iterator[Path]:
    """Every file that may be a log, in order."""
    for folder in folders:
        every = sorted(folder.rglob("*")) if folder.is_dir() else [folder]
        yield from (f for f in every if f.is_file() and ending_of(f) in TRIED)


def main() -> int:
    """Print one line a file, and how many of each kind."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", nargs="+", type=Path, help="folders with logs, or logs")
    counts: Counter[str] = Counter()
    for file in files_in(parser.parse_args().folder):
        kind, what = read(file)
        counts[kind] += 1
        print(
            f"{file.name}: {kind}, {what}" if kind != "refused" else f"{file.name}: {kind}: {what}"
        )
    print(", ".join(f"{kind} {n}" for kind, n in sorted(counts.items())) or "no file")
    return 0 if counts else 1


if __name__ == "__main__":
    sys.exit(main())
