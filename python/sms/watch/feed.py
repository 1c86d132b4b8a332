"""A bounded queue between what brings rows and the watch.

A file waits for the watch, played or growing. A bus does not: where the watch falls behind by more than the queue
holds, the oldest rows are lost, counted, and the stream has a gap there. Memory stays what it is.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from sms.arrays import Array

MOST_ROWS = 200_000
"""Half an hour at 100 Hz: as long as the model is fitted and the healthy machine learned, rows wait here."""
SILENT = 2.0
"""s without a row, after which the stream is said to be silent."""

Condition = Literal["running", "silent", "restarted", "bus fault", "ended"]


@dataclass(frozen=True, eq=False)
class Chunk:
    """Rows, signal -> (n,) in SI, or what has become of the stream."""

    rows: Mapping[str, Array] = field(default_factory=dict)
    condition: Condition = "running"
    detail: str = ""

    @property
    def count(self) -> int:
        """Rows."""
        return int(self.rows["time"].size) if self.rows else 0


class Feed:
    """Chunks from one thread to another."""

    def __init__(self, most_rows: int = MOST_ROWS) -> None:
        self.most_rows = most_rows
        self.lost = 0
        """Rows that were dropped since the beginning."""
        self._chunks: deque[Chunk] = deque()
        self._rows = 0
        self._changed = threading.Condition()

    @property
    def waiting(self) -> int:
        """Rows that are held."""
        return self._rows

    def put(self, chunk: Chunk) -> None:
        """Never waits."""
        with self._changed:
            self._chunks.append(chunk)
            self._rows += chunk.count
            while self._rows > self.most_rows and len(self._chunks) > 1:
                oldest = self._chunks.popleft()
                self._rows -= oldest.count
                self.lost += oldest.count
            self._changed.notify_all()

    def put_when_there_is_room(self, chunk: Chunk, stop: threading.Event) -> None:
        """For what can wait: nothing is lost. Gives up when `stop` is set."""
        with self._changed:
            while self._rows and self._rows + chunk.count > self.most_rows:
                if stop.is_set():
                    return
                self._changed.wait(0.2)
        self.put(chunk)

    def take(self, seconds: float) -> Chunk | None:
        """The oldest chunk; None where none comes within so many seconds."""
        with self._changed:
            if not self._chunks:
                self._changed.wait(seconds)
            if not self._chunks:
                return None
            chunk = self._chunks.popleft()
            self._rows -= chunk.count
            self._changed.notify_all()
            return chunk

    def chunks(self) -> Iterator[Chunk]:
        """All of them until the stream ends; while none comes, every two seconds one that says so."""
        while True:
            chunk = self.take(SILENT) or Chunk(condition="silent")
            yield chunk
            if chunk.condition == "ended":
                return
