"""What one measurement of speed is: a value beside its peer's, and the goal it should reach."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """What a measurement should reach; each part that is given must hold."""

    at_most: float | None = None  #: in the unit of the measured value
    ratio_at_least: float | None = None  #: peer's value over the measured one

    def __str__(self) -> str:
        parts = []
        if self.at_most is not None:
            parts.append(f"<= {self.at_most:g}")
        if self.ratio_at_least is not None:
            parts.append(f">= {self.ratio_at_least:g}x")
        return ", ".join(parts)

    def met(self, value: float, ratio: float | None) -> bool:
        """True when every part holds; a goal against a peer needs the peer's ratio."""
        if self.at_most is not None and value > self.at_most:
            return False
        return self.ratio_at_least is None or (ratio is not None and ratio >= self.ratio_at_least)


@dataclass(frozen=True)
class Row:
    """One measurement, as it is written to the JSON file."""

    name: str
    value: float
    unit: str
    peer: str | None
    peer_value: float | None  #: in `unit`
    ratio: float | None  #: peer_value / value
    goal: str | None
    met: bool | None


def row(
    name: str,
    value: float,
    unit: str,
    peer: tuple[str, float | None] | None = None,
    goal: Goal | None = None,
) -> Row:
    """A measurement beside its peer and its goal, which without the peer's value is not judged.

    Args:
        name: of the measurement.
        value: measured.
        unit: of `value`.
        peer: name, and value in the same unit; None where it could not be measured.
        goal: to be met.
    """
    peer_name, peer_value = peer if peer is not None else (None, None)
    ratio = None if peer_value is None else peer_value / value
    open_question = peer is not None and peer_value is None
    met = None if goal is None or open_question else goal.met(value, ratio)
    return Row(
        name, value, unit, peer_name, peer_value, ratio, None if goal is None else str(goal), met
    )


def fastest(work: Callable[[], object], rounds: int = 30) -> float:
    """Seconds of the fastest of `rounds` calls: whatever disturbs a measurement makes it longer."""
    best = float("inf")
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best
