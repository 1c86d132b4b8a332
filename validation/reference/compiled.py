"""Numba's compiler as a typed decorator: without it a simulated second takes minutes.

Numba keeps what it has compiled, but notices only changes of a function's own file, not of what it
calls. So the store is named by a hash of every file here that compiles something: a change is a new store.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., object])


def _store() -> Path:
    here = Path(__file__).parents[1]  # every folder of validation that compiles
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(here.rglob("*.py")):
        text = path.read_bytes()
        if b"@compiled" in text:
            digest.update(text)
    return here.parent / "build" / "numba" / digest.hexdigest()[:16]


setattr(numba.config, "CACHE_DIR", str(_store()))  # noqa: B010, its names are made at run time


def compiled(function: F) -> F:
    """The same function, compiled at its first call and kept in build/numba."""
    return cast(F, numba.njit(cache=True, error_model="numpy")(function))
