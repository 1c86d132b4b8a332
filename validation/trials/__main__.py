"""`./dev trials`: each module that has trials of its own registers its commands here."""

from __future__ import annotations

import sys

import typer
from sms.errors import InputError

from validation.trials import (
    calibrate,
    foreign,
    foreign_pairs,
    history,
    lung,
    machine_commands,
    pairs,
    slips,
    watch,
)

app = typer.Typer(
    help="Blind trials: what the diagnosis names of what was hidden, counted.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
)
COMMANDS = (machine_commands, foreign, foreign_pairs, lung, slips, history, pairs, watch, calibrate)
"""Modules with a function register(app)."""
for module in COMMANDS:
    module.register(app)


def main() -> None:
    """Run the command; bad input is one sentence and exit code 2."""
    try:
        app(prog_name="./dev trials")
    except InputError as problem:
        print(f"trials: {problem}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("trials: stopped; those that are done are kept", file=sys.stderr)
        sys.exit(130)


if __name__ == "__main__":
    main()
