"""A bus that loses, corrupts, duplicates, reorders, delays and replays frames: for trials.

It wraps another bus and does so in both directions, each frame with a given probability. A real bus retransmits and
checks a frame itself; these faults stand for what gateways, drivers and adapters do to frames above that.
"""

from __future__ import annotations

import heapq
import itertools
import random
from collections import deque
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, fields

import can

from sms.errors import InputError, did_you_mean

REPLAY_FROM = 2000  #: frames back, from which a replayed one is taken
DELAY = 0.25  #: s; the longest delay
REORDER = 0.025  #: s; a reordered frame lets those of this time pass: two periods of set-points


@dataclass
class FrameFaults:
    """Share of the frames, 0 to 1, that each fault befalls; may be changed at any time."""

    lost: float = 0.0
    corrupted: float = 0.0  #: one to three bits of the data are turned
    duplicated: float = 0.0
    reordered: float = 0.0  #: comes after frames that were sent later
    delayed: float = 0.0  #: by up to DELAY
    replayed: float = 0.0  #: an old frame of the same sender comes as well
    bus_off: bool = False  #: the whole bus is away: nothing is sent or received

    def set(self, name: str, share: float) -> None:
        """Switch one on (or off, 0). InputError for an unknown name or a share that is none."""
        known = [f.name for f in fields(self)]
        if name not in known:
            raise InputError(f"there is no fault of frames '{name}'; {did_you_mean(name, known)}")
        if not 0.0 <= share <= 1.0:
            raise InputError(f"frames_{name}: {share:g} is no share; write one from 0 to 1")
        setattr(self, name, share > 0.0 if name == "bus_off" else share)


class FaultyBus(can.BusABC):
    """A bus whose frames suffer. The wrapped bus is closed with it."""

    def __init__(
        self,
        inner: can.BusABC,
        clock: Callable[[], float],
        seed: int,
        faults: FrameFaults | None = None,
    ) -> None:
        """`clock` (s) times delays; the same seed gives the same faults for the same frames."""
        super().__init__(channel=inner.channel_info)
        self.inner = inner
        self.clock = clock
        self.faults = faults or FrameFaults()
        self.befallen = 0  #: frames that a fault befell
        self._random = random.Random(seed)
        self._order = itertools.count()
        self._out: list[tuple[float, int, can.Message]] = []
        self._in: list[tuple[float, int, can.Message]] = []
        self._sent: deque[can.Message] = deque(maxlen=REPLAY_FROM)
        self._received: deque[can.Message] = deque(maxlen=REPLAY_FROM)
        self.channel_info = f"faulty {inner.channel_info}"

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send, with what befalls the frame on the way. CanOperationError while the bus is off."""
        if self.faults.bus_off:
            raise can.CanOperationError("bus off")
        self._befall(msg, self._out, self._sent)
        self._flush(timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """The next frame that gets through, or None after so long on this bus's clock."""
        end = None if timeout is None else self.clock() + timeout
        while True:
            self._flush(None)
            frame = self.inner.recv(
                self._until_due(None if end is None else max(0.0, end - self.clock()))
            )
            while frame is not None:  # all that is there, so that late ones find their place
                if not self.faults.bus_off:
                    self._befall(frame, self._in, self._received)
                frame = self.inner.recv(0.0)
            self._flush(None)
            if self._in and self._in[0][0] <= self.clock():
                return heapq.heappop(self._in)[2]
            if end is not None and self.clock() >= end:
                return None

    def shutdown(self) -> None:
        """Close the wrapped bus too."""
        super().shutdown()
        self.inner.shutdown()

    def _until_due(self, timeout: float | None) -> float | None:
        """The time-out, or less when a delayed frame is due before."""
        due = [queue[0][0] for queue in (self._in, self._out) if queue]
        if not due:
            return timeout
        wait = max(0.0, min(due) - self.clock())
        return wait if timeout is None else min(wait, timeout)

    def _flush(self, timeout: float | None) -> None:
        while self._out and self._out[0][0] <= self.clock():
            frame = heapq.heappop(self._out)[2]
            if not self.faults.bus_off:
                self.inner.send(frame, timeout)

    def _befall(
        self,
        frame: can.Message,
        queue: list[tuple[float, int, can.Message]],
        before: deque[can.Message],
    ) -> None:
        """Put a frame, or what becomes of it, into a queue by the time at which it is due."""
        faults, now = self.faults, self.clock()

        def happens(share: float) -> bool:
            return share > 0.0 and self._random.random() < share

        copies, delay = [frame], 0.0
        before.append(frame)
        if happens(faults.lost):
            copies = []
        if happens(faults.corrupted):
            copies = [self._turned(frame)]
        if happens(faults.duplicated):
            copies = [frame, frame]
        if happens(faults.reordered):
            delay = REORDER
        if happens(faults.delayed):
            delay = self._random.uniform(0.0, DELAY)
        if happens(faults.replayed):
            copies = [*copies, self._random.choice(before)]
        self.befallen += copies != [frame] or delay > 0.0
        for copy in copies:
            heapq.heappush(queue, (now + delay, next(self._order), copy))

    def _turned(self, frame: can.Message) -> can.Message:
        copy = deepcopy(frame)
        for bit in self._random.sample(range(8 * len(copy.data)), self._random.randint(1, 3)):
            copy.data[bit // 8] ^= 1 << bit % 8
        return copy
