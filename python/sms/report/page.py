"""One HTML file that needs nothing else: no network, no server; and that runs no script but its own.

What a page shows (titles, notes, names of columns) is somebody's data. It is escaped where it is put in; should that
ever fail, the page's content security policy names the hashes of its own scripts, and a browser runs no other.
"""

from __future__ import annotations

import json
from base64 import b64encode
from dataclasses import dataclass
from hashlib import sha256
from importlib.resources import files
from typing import Any

from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from sms.report.markup import esc


@dataclass(frozen=True)
class Scripts:
    """What a page runs, in order, and the JSON that it reads from #plot-data."""

    texts: tuple[str, ...] = ()
    data: str = ""

    @property
    def html(self) -> str:
        """The end of the page's body."""
        read = f'<script type="application/json" id="plot-data">{self.data}</script>'
        run = "".join(f"<script>{text}</script>" for text in self.texts)
        return (read if self.data else "") + run

    @property
    def policy(self) -> str:
        """Nothing is loaded from elsewhere, and no other script is run."""
        allowed = " ".join(f"'sha256-{_digest(text)}'" for text in self.texts) or "'none'"
        return (
            f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; "
            "img-src data: blob:; base-uri 'none'; form-action 'none'"
        )


def _digest(text: str) -> str:
    # A browser hashes the text as it parses it, line ends as \n.
    return b64encode(sha256(text.encode("utf-8")).digest()).decode("ascii")


def page(title: str, body: str, scripts: Scripts | None = None, style: str = "") -> str:
    """The file's text; `body` is HTML, `style` is CSS after style.css."""
    scripts = scripts or Scripts()
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{scripts.policy}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{esc(title)}</title><style>{asset('style.css')}{style}</style></head>"
        f"<body>{body}{scripts.html}</body></html>\n"
    )


def asset(name: str) -> str:
    """The text of a file of this folder."""
    return files("sms.report").joinpath(name).read_text(encoding="utf-8")


def plots(data: dict[str, Any], *drawings: str) -> Scripts:
    """Plotly, the numbers as JSON, and the scripts of this folder that draw them."""
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
    return Scripts((get_plotlyjs(), *map(asset, drawings)), text)
