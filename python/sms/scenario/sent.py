"""What is sent to the plant over time."""

from __future__ import annotations

from dataclasses import dataclass

from sms.arrays import Array
from sms.motion.feasible import Feasible


@dataclass(frozen=True)
class Command:
    """What is sent, once a controller period."""

    time: Array  #: (n,) s, from 0
    values: Array  #: (n, m) m or V, m = 3 on the platform, 1 on the bench
    unit: str  #: "m": set-points of the extensions; "V": at the valves
    pose: Array | None  #: (n, 3) roll, pitch, height asked for, after all cuts; None in volts
    motion: Feasible | None  #: how it was made feasible, for a deck's motion
    words: tuple[str, ...]  #: what it is, a sentence each
