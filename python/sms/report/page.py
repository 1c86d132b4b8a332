"""HTML pages that need no network and no server, and that run no script but their own.

What a page shows (titles, notes, names of columns) is somebody's data. It is escaped where it is put in; should that
ever fail, the page's content security policy names the hashes of its own scripts, and a browser runs no other. Plotly
is packed inside (assets.py): start.js unpacks it into a script element, which the policy allows by its hash. A page
whose plotly lies beside it allows the scripts of its own folder instead, since no hash is accepted for a local file.
"""

from __future__ import annotations

import json
from base64 import b64encode
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from importlib.resources import files
from pathlib import Path
from typing import Any

from sms.io.write import write_text_atomically
from sms.report.assets import Place, library, packed_library, place, shared_name
from sms.report.markup import esc


@dataclass(frozen=True)
class Scripts:
    """What a page runs once Plotly is there, and the JSON that it reads from #plot-data."""

    text: str = ""
    data: str = ""
    place: Place = Place.inside

    @property
    def html(self) -> str:
        """The end of the page's body."""
        if not self.text:
            return ""
        data = f'<script type="application/json" id="plot-data">{self.data}</script>'
        plotly = f'<script type="application/gzip" id="plotly">{packed_library()}</script>'
        if self.place is Place.beside:
            plotly = shared_script()
        return f"{data}{plotly}<script>{self.text}</script>"

    @property
    def policy(self) -> str:
        """Nothing is loaded from elsewhere, and no other script is run."""
        allowed = "'none'"
        if self.text:
            plotly = f"'{_library_digest()}'" if self.place is Place.inside else "'self' file:"
            allowed = f"{plotly} '{digest(self.text)}'"
        return (
            f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; "
            "img-src data: blob:; base-uri 'none'; form-action 'none'"
        )


def digest(text: str) -> str:
    """As a policy names a script. A browser hashes the text as it parses it, line ends as \\n."""
    return f"sha256-{b64encode(sha256(text.encode('utf-8')).digest()).decode('ascii')}"


@cache
def _library_digest() -> str:
    return digest(library())


def shared_script() -> str:
    """How a page loads the library beside it."""
    return f'<script src="{shared_name()}"></script>'


def page(title: str, body: str, scripts: Scripts | None = None, style: str = "") -> str:
    """The file's text; `body` is HTML, `style` is CSS between style.css and paper.css."""
    scripts = scripts or Scripts()
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{scripts.policy}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{esc(title)}</title><style>{asset('style.css')}{style}{asset('paper.css')}</style></head>"
        f"<body>{body}{scripts.html}</body></html>\n"
    )


def write_page(path: Path, html: str) -> None:
    """Write a page, and beside it the library that it shares with others where it asks for that.

    Each file is there whole or not at all. InputError when that cannot be done.
    """
    shared = path.with_name(shared_name())
    if shared_script() in html and not shared.exists():
        write_text_atomically(shared, library())
    write_text_atomically(path, html)


def asset(name: str) -> str:
    """The text of a file of this folder."""
    return files("sms.report").joinpath(name).read_text(encoding="utf-8")


def plots(data: dict[str, Any], *drawings: str) -> Scripts:
    """Plotly, the numbers as JSON, and the scripts of this folder that draw them."""
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
    draw = "\n".join(map(asset, drawings))
    run = f"{asset('start.js')}unpack().then(() => {{\n{draw}}}).catch(complain);\n"
    return Scripts(run, text, place())
