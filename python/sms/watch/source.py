"""Where rows come from: a record that is played, or a file that grows. A bus: can_source.py."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from sms.arrays import Array
from sms.errors import InputError
from sms.io.measurement_files import measurement_format
from sms.io.records import load_record, record_of
from sms.io.rig import RecordSource, Rig
from sms.io.table import Table, ending_of, is_packed
from sms.io.table_files import TEXT_ENDINGS, is_can_log, table_of_text
from sms.watch.feed import Chunk, Feed

LINES = 500
"""Of a file at a time: five seconds at 100 Hz."""
POLL = 0.1
"""s between two looks at a file that grows."""


def play(rig: Rig, files: Sequence[Path], speed: float = 0.0) -> Iterator[Chunk]:
    """The rows of records, one after the other; `speed` times real time, 0 as fast as they are taken.

    InputError for a file that is no record of this rig, or a speed below 0.
    """
    if not speed >= 0.0:
        raise InputError(f"--speed {speed:g}: time does not run backwards; write 0 or more")
    for file in files:
        if not file.is_file():
            raise InputError(f"{file}: there is no such file; check the path")
    return _played(rig, files, speed)


def _played(rig: Rig, files: Sequence[Path], speed: float) -> Iterator[Chunk]:
    for file in files:
        pace = _Pace(speed)
        for rows in _rows_of(rig, file):
            pace.wait(rows["time"])
            yield Chunk(rows)
    yield Chunk(condition="ended")


class _Pace:
    """Waits until rows would have come."""

    def __init__(self, speed: float) -> None:
        self.speed = speed
        self.begin: tuple[float, float] | None = None

    def wait(self, times: Array) -> None:
        good = times[np.isfinite(times)]
        if self.speed <= 0.0 or not good.size:
            return
        if self.begin is None:
            self.begin = time.monotonic(), float(good[0])
        due = self.begin[0] + (float(good[-1]) - self.begin[1]) / self.speed
        time.sleep(max(0.0, due - time.monotonic()))


def _rows_of(rig: Rig, file: Path) -> Iterator[dict[str, Array]]:
    """A text table is read as it goes, however long it is; what else there is, whole."""
    if is_text_table(file) and not is_packed(file):
        with TextLog(rig, file) as log:
            while (rows := log.read(at_end=True)) is not None:
                yield rows
        return
    record = load_record(rig, RecordSource(file.name, file, "identify"))
    n = len(record)
    for first in range(0, n, LINES):
        yield {s: v[first : first + LINES] for s, v in record.signals.items()}


def is_text_table(file: Path) -> bool:
    """Whether a file is a table in text, and not a log of frames or of a measurement system."""
    return (
        ending_of(file) in TEXT_ENDINGS
        and not is_can_log(file)
        and measurement_format(file) is None
    )


class TextLog:
    """A table in text, read on as it grows. Its header line is read once."""

    def __init__(self, rig: Rig, file: Path) -> None:
        self.rig, self.path = rig, file
        self._source = RecordSource(file.name, file, "identify")
        self._header: str | None = None
        self._rest = ""
        try:
            self._opened = file.open("r", encoding="utf-8-sig", errors="replace", newline=None)
        except OSError as problem:
            raise InputError(
                f"{file}: cannot be read ({problem.strerror}); check the file"
            ) from None

    def __enter__(self) -> TextLog:
        return self

    def __exit__(self, *_: object) -> None:
        self._opened.close()

    @property
    def was_cut(self) -> bool:
        """Whether the file is shorter than what was read of it: another one has its name."""
        return self.path.stat().st_size < self._opened.tell()

    def read(self, at_end: bool = False) -> dict[str, Array] | None:
        """The next rows, signal -> (n,); None where there are no whole lines. at_end: the last line needs no end.

        A line that cannot be read as one of the table is NaN. InputError for a header that lacks a signal.
        """
        lines: list[str] = []
        while len(lines) < LINES:
            line = self._opened.readline()
            if line and not line.endswith("\n") and not at_end:
                self._rest += line
                break
            if not line:
                break
            line, self._rest = self._rest + line, ""
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            if self._header is None and self.rig.layout.columns is None:
                self._header = line
                continue
            lines.append(line)
        if not lines:
            return None
        try:
            return self._parsed("".join(lines))
        except InputError:
            self._parsed_header(lines)
            return self._one_by_one(lines)

    def _table(self, text: str) -> Table:
        layout = self.rig.layout
        return table_of_text(
            self.path, (self._header or "") + text, layout.delimiter, layout.columns
        )

    def _parsed(self, text: str) -> dict[str, Array]:
        return dict(record_of(self.rig, self._source, self._table(text)).signals)

    def _parsed_header(self, lines: Sequence[str]) -> None:
        """InputError where it is not a line but the header that cannot be read."""
        for line in lines:
            try:
                table = self._table(line)
            except InputError:
                continue
            record_of(self.rig, self._source, table)
            return
        self._parsed(lines[0])

    def _one_by_one(self, lines: Sequence[str]) -> dict[str, Array]:
        parts = []
        for line in lines:
            try:
                parts.append(self._parsed(line))
            except InputError:
                parts.append({})
        names = next(p.keys() for p in parts if p)
        nothing = np.full(1, np.nan)
        return {n: np.concatenate([p.get(n, nothing) for p in parts]) for n in names}


def follow(rig: Rig, file: Path, feed: Feed, stop: threading.Event) -> None:
    """Put the rows of a file into a feed as they are written, until `stop`. From its beginning.

    InputError, before anything is put, for what is no table in text.
    """
    if not file.is_file():
        raise InputError(
            f"{file}: there is no such file yet; start the logger first, or check the path"
        )
    if not is_text_table(file) or is_packed(file):
        raise InputError(
            f"{file}: only a table in text ({', '.join(TEXT_ENDINGS)}) can be followed while it grows; "
            "let the logger write .csv, or play it when it is complete"
        )
    threading.Thread(target=_followed, args=(rig, file, feed, stop), daemon=True).start()


def _followed(rig: Rig, file: Path, feed: Feed, stop: threading.Event) -> None:
    log = TextLog(rig, file)
    try:
        while not stop.is_set():
            rows = log.read()
            if rows is not None:
                feed.put_when_there_is_room(Chunk(rows), stop)
            elif log.was_cut:
                log.__exit__()
                log = TextLog(rig, file)
            else:
                stop.wait(POLL)
        feed.put(Chunk(condition="ended"))
    except (InputError, OSError) as problem:
        feed.put(Chunk(condition="ended", detail=str(problem)))
    finally:
        log.__exit__()
