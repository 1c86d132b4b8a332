"""Work on the workers of a Dask cluster."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

from sms.errors import InputError


def client_of(scheduler: str) -> Any:
    """A client of the scheduler at "tcp://host:port", to be used in a `with`. InputError if none answers there."""
    try:
        from distributed import Client  # noqa: PLC0415 (an extra)
    except ImportError:
        raise InputError(
            'a Dask cluster needs one more package: pip install "sms[cluster]"'
        ) from None
    try:
        return Client(scheduler, timeout=5)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as problem:
        raise InputError(
            f"--scheduler {scheduler}: no Dask scheduler answers there ({problem}); start one with "
            "`dask scheduler`"
        ) from None


def call_from(folder: str, module: str, function: str, argument: dict[str, Any]) -> Any:
    """Call function(**argument) of a module that is not installed, on a worker.

    Workers know the package sms. The module comes from the folder in which the worker was started, or from `folder`,
    where both see the same files. InputError where it is in neither.
    """
    places = [Path.cwd(), Path(folder)]
    file = Path(*module.split(".")).with_suffix(".py")
    here = next((place for place in places if (place / file).is_file()), None)
    if here is None:
        raise InputError(
            f"{file} is neither in {places[0]}, where the worker runs, nor in {places[1]}; "
            "start workers in a checkout of the project"
        )
    if str(here) not in sys.path:
        sys.path.insert(0, str(here))
    return getattr(importlib.import_module(module), function)(**argument)
