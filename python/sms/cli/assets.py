"""The option `--assets` of commands that write pages with figures."""

from __future__ import annotations

from typing import Annotated

import typer

from sms.report.assets import Place, placed


def _use(context: typer.Context, where: Place) -> Place:
    """Pages are made with it (report/assets.py) until the command ends."""
    context.with_resource(placed(where))
    return where


Assets = Annotated[
    Place,
    typer.Option(
        "--assets",
        callback=_use,
        help="Where a page has its plotting library: packed inside (one file of 2 MB and more, to be sent or kept), or "
        "beside it in the same folder, one file for all pages there.",
    ),
]
