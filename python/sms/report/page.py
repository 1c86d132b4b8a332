"""One HTML file that needs nothing else: no network, no server."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any

from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from sms.report.markup import esc

# The browser itself refuses to load anything from elsewhere.
_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"
)


def page(title: str, body: str, script: str = "", style: str = "") -> str:
    """The file's text; `body` and `script` are HTML, `style` is CSS after style.css."""
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{esc(title)}</title><style>{asset('style.css')}{style}</style></head>"
        f"<body>{body}{script}</body></html>\n"
    )


def asset(name: str) -> str:
    """The text of a file of this folder."""
    return files("sms.report").joinpath(name).read_text(encoding="utf-8")


def plots(data: dict[str, Any], drawing: str) -> str:
    """Plotly, the numbers as JSON in #plot-data, and the script of this folder that draws them."""
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
    return (
        f"<script>{get_plotlyjs()}</script>"
        f'<script type="application/json" id="plot-data">{text}</script>'
        f"<script>{asset(drawing)}</script>"
    )
