"""How a run is cut into commands, steps of integration and points that are kept."""

from __future__ import annotations

from typing import NamedTuple


class Clock(NamedTuple):
    """Of one run."""

    period: float  # s between two commands
    steps: int  # of integration between them
    fine: int  # points between them at which the motion is kept
    held: bool  # the command is held until the next one; else it runs straight to it

    @property
    def fine_step(self) -> float:
        """s between two points that are kept."""
        return self.period / self.fine


def holding(period: float, step: float) -> Clock:
    """Of a controller that holds its command for `period`, integrated in steps of `step`, s, kept every millisecond."""
    return Clock(period, round(period / step), round(period / 1e-3), held=True)
