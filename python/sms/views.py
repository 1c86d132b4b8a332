"""Results show themselves in a notebook, and give the figures of their pages one by one.

A result stands below the page that shows it (docs/architecture.md) and imports nothing of `sms.report`; what draws it
is found by name when somebody looks.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from typing import TYPE_CHECKING, Any

from sms.callbacks import Progress

if TYPE_CHECKING:
    import plotly.graph_objects as go  # type: ignore[import-untyped]

DRAWN_BY = "sms.report.views"


class Shown:
    """A result that `sms.report` can draw."""

    __slots__ = ()

    def figure(self, name: str, **chosen: str | int) -> go.Figure:
        """A figure of the result's page, as an object of plotly: `answer.figure("gain")`.

        ValueError that names what there is; what may be chosen of a figure (record, signal, number) is said there too.
        """
        return importlib.import_module(DRAWN_BY).figure_of(self, name, **chosen)

    def _repr_html_(self) -> str:
        """What a notebook shows of it."""
        return str(importlib.import_module(DRAWN_BY).html_of(self))


@contextmanager
def notebook_progress() -> Iterator[Progress]:
    """A progress bar in a notebook: `with sms.notebook_progress() as tell: answer = diagnose(rig, progress=tell)`.

    Nothing where there is no IPython. The bar goes when the block ends.
    """
    try:
        display: Any = importlib.import_module("IPython.display")
    except ImportError:
        yield lambda text, done: None
        return
    shown = display.display(display.HTML(_bar("", 0.0)), display_id=True)
    try:
        yield lambda text, done: shown.update(display.HTML(_bar(text, done)))
    finally:
        shown.update(display.HTML(""))


def _bar(text: str, done: float) -> str:
    share = min(max(done, 0.0), 1.0)
    return f'<progress value="{share:.3f}" max="1"></progress> {escape(text)}'
