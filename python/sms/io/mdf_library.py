"""What asammdf, which reads MDF files for us and for python-can, would print of a broken file."""

from __future__ import annotations

import contextlib
import importlib
import logging
from functools import cache
from typing import Any


@cache
def quiet_about_broken_files() -> None:
    """What is wrong with a file is said in our sentence. Nothing where asammdf is not installed.

    The destructor of a file that its constructor refused looks for attributes that were never set, and Python prints
    that as a traceback (asammdf 8.8.28).
    """
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)
    for version in "34":
        try:
            module = importlib.import_module(f"asammdf.blocks.mdf_v{version}")
        except ImportError:
            return
        _forgiving_destructor(getattr(module, f"MDF{version}"))


def _forgiving_destructor(mdf: Any) -> None:
    destroy = getattr(mdf, "__del__", None)
    if destroy is None:
        return

    def closed(self: Any) -> None:
        with contextlib.suppress(AttributeError):
            destroy(self)

    mdf.__del__ = closed
