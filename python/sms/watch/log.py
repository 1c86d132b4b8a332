"""What happened, one JSON object a line, appended; and what is started when an alarm is raised."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sms.errors import InputError
from sms.io.json_files import json_line

Listener = Callable[[str, Mapping[str, Any], str], str | None]
"""Is told an alarm, a diagnosis and the end of an alarm: event, content, line of the log. Returns what went wrong."""


class EventLog:
    """Appends events to a file, made with the first; a line is there whole or not at all."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._file: int | None = None

    def write(self, event: str, content: Mapping[str, Any]) -> str:
        """Append one event; the line."""
        now = datetime.now(UTC).isoformat(timespec="milliseconds")
        line = json_line("watch", {"event": event, "written": now, **content})
        if self._file is None:
            self._file = self._opened()
        os.write(self._file, line.encode())
        return line

    def close(self) -> None:
        """No more is written."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def _opened(self) -> int:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            return os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
        except OSError as problem:
            raise InputError(
                f"{self.path}: cannot be written ({problem.strerror}); choose another --out"
            ) from None


class OnAlarm:
    """Starts a command for each alarm and verdict, without a shell, and does not wait for it; a listener of `Watch`.

    The event is its last argument, as JSON.
    """

    MOST = 4
    """Of them that may run at once: one that hangs is not started without end."""

    def __init__(self, command: str) -> None:
        self.words = shlex.split(command)
        if not self.words or shutil.which(self.words[0]) is None:
            name = self.words[0] if self.words else ""
            raise InputError(
                f"--on-alarm: there is no program '{name}'; give one that can be run, with its arguments"
            )
        self._running: list[subprocess.Popen[bytes]] = []

    def __call__(self, event: str, content: Mapping[str, Any], line: str) -> str | None:
        """Start it with a line of the log; why not, in a sentence."""
        if event not in ("alarm", "diagnosed"):
            return None
        self._running = [p for p in self._running if p.poll() is None]
        if len(self._running) >= self.MOST:
            return f"--on-alarm: {self.MOST} of them run still, so it was not started"
        try:
            self._running.append(
                subprocess.Popen(
                    [*self.words, line.rstrip("\n")],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    start_new_session=True,
                )
            )
        except OSError as problem:
            return f"--on-alarm: it could not be started ({problem.strerror})"
        return None
