"""Options of every command that reads a record: what its columns are called, and the bus whose log it is."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from sms.errors import InputError

Columns = Annotated[
    list[str],
    typer.Option(
        "--column",
        metavar="SIGNAL=COLUMN",
        help='What the record calls otherwise: *"time=t [ms]"*; may be repeated.',
    ),
]
Dbc = Annotated[
    Path | None,
    typer.Option(
        "--dbc", help="Definition of the bus of a CAN log; without it, the project's own."
    ),
]


def columns_of(said: Sequence[str]) -> dict[str, str]:
    """Signal -> column. InputError for what is no such pair."""
    columns: dict[str, str] = {}
    for text in said:
        signal, equals, column = (part.strip() for part in text.partition("="))
        if not (signal and equals and column):
            raise InputError(f'--column {text}: write SIGNAL=COLUMN, such as "time=t [ms]"')
        if signal in columns:
            raise InputError(f"--column {text}: {signal} is said twice; leave one out")
        columns[signal] = column
    return columns
