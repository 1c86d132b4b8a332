"""What a simulator is asked and answers, as JSON on its standard input and output."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import TypedDict

from validation.reference.multibody.peers.exchange import Mechanism, Vector

ROUNDS = 20


class Task(TypedDict):
    """Swing for `steps` steps of `step` s from q, qdot under force - stiffness extension."""

    mechanism: Mechanism
    q: Vector  #: roll, pitch, height
    qdot: Vector
    force: Vector  #: of the actuators at extension 0, N
    stiffness: float  #: N/m
    step: float  #: s
    steps: int


class Result(TypedDict):
    """Where the platform's reference point and axes ended, and what a step took."""

    software: str  #: name and version
    q: Vector  #: roll, pitch, height at the end
    microseconds: float  #: of one step


def fastest(prepare: Callable[[], Callable[[], object]]) -> float:
    """Seconds of the fastest of ROUNDS calls of what `prepare` gives, which itself is not timed."""
    best = float("inf")
    for _ in range(ROUNDS):
        work = prepare()
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best


def serve(answer: Callable[[Task], Result]) -> None:
    """Read the task, write the result."""
    json.dump(answer(json.load(sys.stdin)), sys.stdout)
