"""Processes that work on trials side by side, and end with the command that started them, however it ends."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from threading import Thread


def processes(workers: int) -> ProcessPoolExecutor:
    """A pool of so many new processes: forked ones would have the threads of this one's linear algebra loaded."""
    return ProcessPoolExecutor(
        workers, mp_context=get_context("spawn"), initializer=_end_with_parent
    )


def _end_with_parent() -> None:
    """A worker would else finish its trial, minutes of a core, for a command that was killed."""
    parent = parent_process()
    assert parent is not None

    def wait(sentinel: int) -> None:
        connection.wait([sentinel])
        os._exit(1)

    Thread(target=wait, args=(parent.sentinel,), daemon=True).start()
