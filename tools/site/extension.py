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


class Prose:
    """Docstrings are prose, not markup."""

    def __init__(self) -> None:
        self.kept: list[str] | None = None

    def before(
        self, _app: Any, what: str, _name: str, _obj: Any, _options: Any, lines: list[str]
    ) -> None:
        """Before napoleon, which makes fields of what stands under "Args:" and its like."""
        lines[:] = docstring(lines)
        self.kept = list(lines) if what in ("property", "attribute") else None

    def after(
        self, _app: Any, _what: str, _name: str, _obj: Any, _options: Any, lines: list[str]
    ) -> None:
        """Of a property napoleon takes the words before a colon for a type: they are words again."""
        if self.kept is not None:
            lines[:] = self.kept


def setup(app: Any) -> None:
    """Register both."""
    prose = Prose()
    app.add_directive("grid-of-pictures", PictureGrid)
    app.connect("autodoc-process-docstring", prose.before, priority=1)
    app.connect("autodoc-process-docstring", prose.after, priority=900)
