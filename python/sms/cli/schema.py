"""The command `sms schema`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from sms.errors import InputError, did_you_mean


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Example: **sms schema rig --out rig.schema.json**, and **#:schema ./rig.schema.json** as the first "
        "line of a rig file beside it: an editor with TOML support then completes keys and marks mistakes."
    )(schema)


def schema(
    subject: Annotated[
        str, typer.Argument(help="rig, scenario or poses (a rig file of `sms calibrate geometry`).")
    ],
    out: Annotated[
        Path | None, typer.Option(help="The file; without it the schema is printed.")
    ] = None,
) -> None:
    """The JSON schema of rig files, of scenarios or of rig files of poses, for editors and other programs."""
    from sms.io.write import write_text_atomically  # noqa: PLC0415 (pandas takes its time)
    from sms.schemas import SUBJECTS, shipped  # noqa: PLC0415

    for known in SUBJECTS:
        if subject == known:
            text = shipped(known)
            break
    else:
        raise InputError(f"{subject}: there is no such schema; {did_you_mean(subject, SUBJECTS)}")
    if out is None:
        print(text, end="")
        return
    write_text_atomically(out, text)
    print(f"written: {out}")
