"""The terminal's view: a few lines that stay, and what happens above them."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from sms.watch.watch import Status

EVERY = 0.25
"""s between two pictures."""


class Terminal:
    """Prints alarms, their verdicts and their ends as they come; live: a view of the state below them."""

    def __init__(self, console: Console, live: bool) -> None:
        self._console = console
        self._live = Live(console=console, auto_refresh=False, transient=True) if live else None
        self._next = 0.0
        self._said: set[tuple[str, object]] = set()
        self._work = ""
        self._standing: int | None = None
        """Number of the alarm that stands."""

    def __enter__(self) -> Terminal:
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live is not None:
            self._live.stop()

    def progress(self, text: str, done: float) -> None:
        """What is being worked out."""
        self._work = f"{text} ({100.0 * done:.0f} %)"
        self._draw(Text(self._work, style="dim"))

    def show(self, status: Status) -> None:
        """The state as it is now."""
        if status.phase == "watching":
            self._once(
                ("learned", 0),
                f"learned from {hours(status.learned)} of the healthy machine",
                "dim",
            )
        if status.alarm is not None:
            self._once(("alarm", status.alarm.number), status.alarm.sentence, "bold red")
        if status.verdict is not None:
            told = f"alarm {status.verdict.alarm}, diagnosed: {status.verdict.sentence}"
            self._once(("verdict", status.verdict.alarm), told, "bold")
        standing = status.alarm.number if status.alarm is not None else None
        if self._standing is not None and standing is None:
            ended = f"alarm {self._standing} ended at {status.time:.0f} s"
            self._once(("ended", self._standing), ended, "bold")
        self._standing = standing
        self._draw(view(status))

    def _once(self, key: tuple[str, object], text: str, style: str) -> None:
        if key not in self._said:
            self._said.add(key)
            self._console.print(text, style=style, soft_wrap=True, highlight=False)

    def _draw(self, picture: Text | Group) -> None:
        if self._live is not None and time.monotonic() >= self._next:
            self._next = time.monotonic() + EVERY
            self._live.update(picture, refresh=True)


def hours(seconds: float) -> str:
    """ "2 h 05 min", "12 min", "40 s"."""
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60:02d} min"


def state_in_words(status: Status) -> str:
    """ "running", "learning, 120 s of 600 s", "late: 3000 rows wait"."""
    if status.phase == "learning":
        return f"learning, {status.learned:.0f} s of {status.wanted:.0f} s ({status.condition})"
    if status.late:
        return f"late: {status.waiting} rows wait"
    return status.condition


def view(status: Status) -> Group:
    """What is shown live."""
    table = Table(box=None, padding=(0, 2, 0, 0), show_header=False, pad_edge=False)
    table.add_row("stream", f"{state_in_words(status)}, at {status.time:.1f} s")
    if status.look is not None:
        bar = "#" * min(round(20.0 * status.look.highest), 40)
        table.add_row("evidence", f"{100.0 * status.look.highest:4.0f} % of the threshold  {bar}")
    table.add_row("watched", f"{status.segments} segments, {status.lost} rows lost")
    lines: list[Table | Text] = [table]
    if status.alarm is not None:
        lines.append(Text(status.alarm.sentence, style="red"))
    if status.diagnosing:
        lines.append(Text("a diagnosis is running", style="dim"))
    return Group(*lines)
