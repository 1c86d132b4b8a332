"""Work on the workers of a Dask cluster."""

from __future__ import annotations

from typing import Any

from sms.io.errors import InputError


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
