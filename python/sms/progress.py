"""A progress bar for commands that take longer than two seconds, and what Ctrl-C does to them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import typer
from rich.console import Console

INTERRUPTED_CODE = 130  #: what a shell gives to Ctrl-C


@contextmanager
def progress_bar(
    text: str, stopped: str = "nothing was written"
) -> Iterator[Callable[[str, float], None]]:
    """A bar on stderr; what it gives is told (what is done now, the share). Ctrl-C ends it."""
    from rich.progress import (  # noqa: PLC0415 (--help must not wait for it)
        BarColumn,
        Progress,
        SpinnerColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeRemainingColumn(),
    )
    try:
        with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
            task = progress.add_task(text, total=1.0)
            yield lambda now, share: progress.update(task, description=now, completed=share)
    except KeyboardInterrupt:
        print(f"sms: stopped; {stopped}", file=sys.stderr)
        raise typer.Exit(INTERRUPTED_CODE) from None
