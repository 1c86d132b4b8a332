"""How many threads the core takes to evaluate the windows of a record, which do not depend on each other; and that
linear algebra takes one.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits

from sms.errors import InputError

VARIABLE = "SMS_THREADS"
_USUAL = 2


def threads() -> int:
    """As the environment's SMS_THREADS says, 2 without it. InputError where that is no number of threads."""
    said = os.environ.get(VARIABLE, "").strip()
    if not said:
        return _USUAL
    if not (said.isdecimal() and int(said) > 0):
        raise InputError(
            f"{VARIABLE} is '{said}'; write a number of threads, 1 or more, or leave it out"
        )
    return int(said)


def use_threads(number: int) -> None:
    """For the rest of this process."""
    os.environ[VARIABLE] = str(number)


@contextmanager
def one_thread_for_matrices() -> Iterator[None]:
    """BLAS on one thread meanwhile. Products of a few milliseconds gain nothing from two, which wait for each other
    in a loop: beside any other work on the machine a hundred times as long as the product takes.
    """
    with threadpool_limits(1, user_api="blas"):
        yield
