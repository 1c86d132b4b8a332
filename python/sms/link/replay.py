"""A log onto a bus again, or as a bus that one can listen to; in its own time or faster."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import can

from sms.errors import InputError
from sms.io.can_files import read_frames
from sms.link.codec import HOST, sent_by
from sms.link.rig_link import BusError

REPORT = 500  #: frames between two calls of the progress


class LogBus(can.BusABC):
    """A bus on which a log is played, for one who listens; what is sent on it goes nowhere."""

    def __init__(self, log: Path, *, speed: float = 1.0) -> None:
        """`speed` times real time, 0 as fast as the listener asks. InputError for a speed below 0."""
        # What may be refused comes first: a bus that was not opened need not be shut down.
        speed, frames = _checked(speed), read_frames(log)
        first = next(frames, None)
        super().__init__(channel=str(log))
        self.channel_info = f"log {log}"
        self.is_over = False
        self._speed = speed
        self._frames = frames
        self._next = first
        self._first = self._next.timestamp if self._next is not None else 0.0
        self._begin: float | None = None

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        frame = self._next
        if frame is None:
            self.is_over = True
            if timeout:
                time.sleep(timeout)
            return None, True
        if self._speed > 0.0:
            now = time.monotonic()
            self._begin = now if self._begin is None else self._begin
            wait = self._begin + (frame.timestamp - self._first) / self._speed - now
            if timeout is not None and wait > timeout:
                time.sleep(timeout)
                return None, True
            time.sleep(max(0.0, wait))
        self._next = next(self._frames, None)
        return frame, True

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Nobody is there to receive it."""


def _checked(speed: float) -> float:
    if speed < 0.0:
        raise InputError(f"--speed {speed:g}: time does not run backwards; write 0 or more")
    return speed


@dataclass
class Replayed:
    """What was sent."""

    frames: int = 0
    duration: float = 0.0  #: of the traffic, s
    elapsed: float = 0.0  #: that it took, s


def replay(
    log: Path,
    bus: can.BusABC,
    *,
    speed: float = 1.0,
    commands: bool = False,
    progress: Callable[[int], None] = lambda _frames: None,
) -> Replayed:
    """Send the frames of a log; `speed` times real time, 0 as fast as the bus takes them.

    Without `commands` what a desk sent is left out. InputError for a log that cannot be read, BusError.
    """
    _checked(speed)
    ours = sent_by(HOST)
    done = Replayed()
    begin = time.monotonic()
    first: float | None = None
    for frame in read_frames(log):
        if frame.is_error_frame or (not commands and frame.arbitration_id in ours):
            continue
        first = frame.timestamp if first is None else first
        done.duration = frame.timestamp - first
        if speed > 0.0:
            time.sleep(max(0.0, begin + done.duration / speed - time.monotonic()))
        try:
            bus.send(frame)
        except can.CanError as problem:
            raise BusError(f"the bus took {done.frames} frames, then none ({problem})") from None
        done.frames += 1
        if done.frames % REPORT == 0:
            progress(done.frames)
    if done.frames == 0:
        raise InputError(
            f"{log}: there is nothing to replay in it; --commands sends a desk's frames too"
        )
    done.elapsed = time.monotonic() - begin
    return done
