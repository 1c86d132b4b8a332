"""Where a page has its plotting library: packed inside it, or in one file beside it that several pages share.

Packed (gzip, as base64), plotly.js is 2 MB of a page in place of 4.8 MB; the browser unpacks it. Beside, a page is as
small as its numbers, but no longer one file that can be sent, and it allows scripts of its own folder.
"""

from __future__ import annotations

import gzip
from base64 import b64encode
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from enum import StrEnum
from functools import cache


class Place(StrEnum):
    """Of the plotting library."""

    inside = "inside"
    beside = "beside"


_place: ContextVar[Place] = ContextVar("place", default=Place.inside)


def place() -> Place:
    """Where pages made now have it."""
    return _place.get()


@contextmanager
def placed(where: Place) -> Iterator[None]:
    """Pages made within have it there."""
    before = _place.set(where)
    try:
        yield
    finally:
        _place.reset(before)


@cache
def library() -> str:
    """The text of plotly.js, as the Python package plotly holds it."""
    from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]  # noqa: PLC0415

    return str(get_plotlyjs())


@cache
def packed_library() -> str:
    """The same, gzip as base64; without the time, so that equal pages are equal files."""
    return b64encode(gzip.compress(library().encode("utf-8"), mtime=0)).decode("ascii")


@cache
def shared_name() -> str:
    """Of the file beside the pages; with its version, so that a page keeps what it was drawn with."""
    from plotly.offline import get_plotlyjs_version  # noqa: PLC0415

    return f"plotly-{get_plotlyjs_version()}.min.js"
