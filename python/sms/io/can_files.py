"""Logs of a CAN bus: BLF, ASC, MF4, CSV, candump, TRC and SQLite by the ending of the name, through python-can.

Writing is safe: frames go to a hidden file beside the wanted one, which takes its name when it is closed. So a reader
sees a whole log or none, whatever stops the recording.
"""

from __future__ import annotations

import gzip
import logging
import secrets
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Any

import can

from sms.errors import InputError
from sms.io.mdf_library import quiet_about_broken_files
from sms.io.table import ending_of, is_packed

#: what `record` writes
WRITTEN = (".blf", ".asc", ".mf4", ".csv")
_READERS: Mapping[str, type[can.io.generic.MessageReader]] = MappingProxyType(
    {
        ".blf": can.BLFReader,
        ".asc": can.ASCReader,
        ".mf4": can.MF4Reader,
        ".csv": can.CSVReader,
        ".log": can.CanutilsLogReader,
        ".trc": can.TRCReader,
        ".db": can.SqliteReader,
    }
)
LATEST = 1e11  #: s, of a frame; loggers count from 1970 at the earliest
_NEVER_PACKED = (can.BLFReader, can.MF4Reader, can.SqliteReader)
_NEEDS_MF4 = "MF4 needs one more package: pip install 'sms[can]', or use .blf"


def read_frames(file: Path) -> Iterator[can.Message]:
    """The frames of a log, packed (.gz) or not, in the order in which they stand there, times in s.

    InputError names a file that is missing, of another kind or broken, and what to do.
    """
    reader = _READERS.get(ending_of(file))
    if reader is None or (is_packed(file) and reader in _NEVER_PACKED):
        raise InputError(f"{file}: not a CAN log (known endings: {', '.join(_READERS)})")
    if not file.is_file():
        raise InputError(f"{file}: there is no such log; check the path")
    logging.getLogger("can").setLevel(logging.CRITICAL)  # it stands in the sentence below
    if reader is can.MF4Reader:
        quiet_about_broken_files()
    # times as written, not shifted to the date of the header
    options = {"relative_timestamp": True} if reader is can.ASCReader else {}
    number = 0
    try:
        with _opened(file) as source, reader(source, **options) as log:
            for number, frame in enumerate(log, 1):  # noqa: B007 (named in the error below)
                if not abs(frame.timestamp) < LATEST:
                    raise ValueError("its time is none")
                yield frame
    except NotImplementedError:
        raise InputError(f"{file}: {_NEEDS_MF4}") from None
    except Exception as problem:  # each format's reader has errors of its own
        raise InputError(
            f"{file}: not a readable {ending_of(file)} log after frame {number} ({problem}); "
            "it may have been cut off"
        ) from None


@contextmanager
def _opened(file: Path) -> Iterator[Any]:
    """What python-can is to read: a text that was packed, or the file itself."""
    if is_packed(file):
        with gzip.open(file, "rt") as text:
            yield text
    else:
        yield file


class LogWriter:
    """A log that is written frame by frame and appears, whole, when it is closed."""

    def __init__(self, file: Path) -> None:
        """InputError for an ending that is not written, or a folder that cannot be."""
        self.file = file
        self.frames = 0
        self._first: float | None = None
        self._last = 0.0
        ending = file.suffix.lower()
        if ending not in WRITTEN:
            raise InputError(f"{file}: the ending says the format; use {', '.join(WRITTEN)}")
        self._temporary = file.with_name(f".{file.stem}.{secrets.token_hex(4)}{ending}")
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            self._writer = can.Logger(self._temporary)
        except NotImplementedError:
            raise InputError(f"{file}: {_NEEDS_MF4}") from None
        except OSError as problem:
            raise InputError(
                f"{file}: cannot be written ({problem.strerror}); choose another folder"
            ) from None

    @property
    def duration(self) -> float:
        """From the first frame to the last, s."""
        return 0.0 if self._first is None else self._last - self._first

    def write(self, frame: can.Message) -> None:
        """Append one frame."""
        if self._first is None:
            self._first = frame.timestamp
        self._last = frame.timestamp
        self.frames += 1
        self._writer.on_message_received(frame)

    def close(self) -> None:
        """Finish the log and give it its name. A log without a frame is an InputError and no file."""
        self._writer.stop()
        if self.frames == 0:
            self._temporary.unlink(missing_ok=True)
            raise InputError(f"{self.file}: no frame came, so nothing was written")
        self._temporary.replace(self.file)

    def discard(self) -> None:
        """Close without leaving anything."""
        with suppress(Exception):  # the reason for discarding is what the caller reports
            self._writer.stop()
        self._temporary.unlink(missing_ok=True)

    def __enter__(self) -> LogWriter:
        """The writer itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        problem: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Finish the log; what was recorded before Ctrl-C is kept, after an error it is not."""
        if kind is None or issubclass(kind, KeyboardInterrupt):
            self.close()
        else:
            self.discard()
