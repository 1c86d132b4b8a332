"""What this site asks of Sphinx beside its own extensions: docstrings as plain prose, and a grid of pictures."""

from __future__ import annotations

from html import escape
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive

from tools.site.prose import docstring


class PictureGrid(Directive):
    """Lines "page | title": each a picture that leads to its page."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """The grid as HTML, with relative links."""
        cells = []
        for line in self.content:
            page, _, text = (part.strip() for part in line.partition("|"))
            cells.append(
                f'<a href="{escape(page)}.html"><span><img src="../_static/gallery/{escape(page)}.svg" alt=""></span>'
                f"<b>{escape(text)}</b></a>"
            )
        return [nodes.raw("", f'<div class="picture-grid">{"".join(cells)}</div>', format="html")]


def process(_app: Any, what: str, _name: str, _obj: Any, _options: Any, lines: list[str]) -> None:
    """Docstrings are prose, not markup."""
    lines[:] = docstring(lines)
    if what in ("property", "attribute"):  # napoleon takes words before a colon there for a type
        lines.insert(0, "")


def setup(app: Any) -> None:
    """Register both."""
    app.add_directive("grid-of-pictures", PictureGrid)
    app.connect("autodoc-process-docstring", process, priority=1)
