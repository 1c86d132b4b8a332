"""Rows from a CAN bus, as they come: only listened to, nothing is sent.

A log is put on one time base when it is complete (io/can_logs.py); here the same is done running. Rows stand at the
frames of one message, the one that comes most often and has the sender's clock; signals of the others are led onto
these times by straight lines between their frames, so a row waits until each has a newer frame. A message that
stays away for a second holds up nobody: its signals then have no value, which is a state of the stream.
"""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import can
import numpy as np
import pandas as pd
from cantools.database import DecodeError

from sms.arrays import Array
from sms.errors import InputError
from sms.io.can_frames import CLOCK, TIME, Channel, find_channels, load_dbc, no_value
from sms.io.can_logs import CLOCK_JUMP
from sms.io.records import record_of
from sms.io.rig import RecordSource, Rig
from sms.io.table import Table
from sms.link.bus import BusAddress, open_bus
from sms.watch.feed import Chunk, Feed

TELLING = 1.0
"""s of frames that tell which message comes most often."""
LONGEST_WAIT = 1.0
"""s that a row waits for a newer frame of another message."""
TOGETHER = 0.5
"""s of rows in a chunk."""


@dataclass
class _Series:
    """Frames of one signal that are still needed: at least the last before the next row."""

    times: list[float] = field(default_factory=list)
    values: list[float] = field(default_factory=list)

    def at(self, times: Array, held: bool) -> Array:
        """(n,): NaN beyond what came."""
        if not self.times:
            return np.full(times.shape, np.nan)
        known, values = np.array(self.times), np.array(self.values)
        if held:
            place = np.searchsorted(known, times, side="right") - 1
            return np.where(place >= 0, values[np.maximum(place, 0)], np.nan)
        out = np.interp(times, known, values, left=np.nan, right=np.nan)
        return np.asarray(out)

    def forget(self, before: float) -> None:
        """All but the last one before a time."""
        keep = max(int(np.searchsorted(self.times, before, side="right")) - 1, 0)
        del self.times[:keep], self.values[:keep]


class Clock:
    """The sender's clock, running on: its readings wrap, and where the sender was started again it goes on by the time
    at which frames were seen."""

    def __init__(self) -> None:
        self._seen, self._reading = 0.0, 0.0
        self._begun = False
        self.restarts = 0

    def reading(self, stamp: float, wrap: float, seen: float) -> float:
        """s since the first stamp, of a stamp that a frame carries which was seen at a time."""
        if not self._begun:
            self._begun, self._origin = True, stamp
            self._reading, self._seen = 0.0, seen
            return 0.0
        expected = self._reading + (seen - self._seen)
        plain = stamp - self._origin
        reading = plain + wrap * round((expected - plain) / wrap)
        if abs(reading - expected) > CLOCK_JUMP:
            self.restarts += 1
            self._origin, reading = stamp - expected, expected
        self._reading = reading
        self._seen = seen
        return self._reading

    def now(self, seen: float) -> float:
        """The same of a frame without a stamp."""
        if not self._begun:
            self._begun, self._origin, self._seen = True, 0.0, seen
        return self._reading + (seen - self._seen)


class Decoder:
    """Frames to rows. It holds the frames of two seconds at most."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self.restarts = 0
        """Of the sender's clock, that were seen."""
        self._source = RecordSource("bus", rig.path, "identify")
        database = load_dbc(rig.layout.dbc)
        wanted = {s.column: s.optional for s in rig.signals.values()}
        self.channels: Mapping[str, Channel] = find_channels(rig.path, database, wanted)
        self._messages = {c.message.frame_id: c.message for c in self.channels.values()}
        self._series = {column: _Series() for column in self.channels}
        self._of_message: dict[int, list[tuple[str, Channel]]] = {}
        for column, channel in self.channels.items():
            self._of_message.setdefault(channel.message.frame_id, []).append((column, channel))
        self._clocks = {
            number: next((s for s in m.signals if s.name == CLOCK), None)
            for number, m in self._messages.items()
        }
        self._clock = Clock()
        self._counts: Counter[int] = Counter()
        self._base: int | None = None
        self._begin: float | None = None
        self._due: list[float] = []
        self.unfit = 0
        """Frames that the DBC does not describe."""

    def take(self, frame: can.Message) -> dict[str, Array] | None:
        """One frame; rows, signal -> (n,), once there are some."""
        number = frame.arbitration_id
        described = self._messages.get(number)
        if described is None or frame.is_remote_frame:
            return None
        try:
            told = described.decode(bytes(frame.data), decode_choices=False)
        except (DecodeError, ValueError):
            self.unfit += 1
            return None
        assert isinstance(told, dict)
        values = {n: float(v) for n, v in told.items() if isinstance(v, int | float)}
        clock = self._clocks[number]
        if clock is not None and CLOCK in values:
            wrap = 2.0**clock.length * float(clock.scale)
            time = self._clock.reading(values[CLOCK], wrap, frame.timestamp)
        else:
            time = self._clock.now(frame.timestamp)
        if self._clock.restarts > self.restarts:
            self.restarts = self._clock.restarts
            self._due.clear()
            for series in self._series.values():
                series.times.clear()
                series.values.clear()
        for column, channel in self._of_message[number]:
            name = channel.signal.name
            if name in values:
                value = values[name]
                series = self._series[column]
                if not series.times or time > series.times[-1]:
                    series.times.append(time)
                    series.values.append(np.nan if no_value(channel.signal, value) else value)
        self._counts[number] += 1
        self._begin = time if self._begin is None else self._begin
        if self._base is None:
            if time - self._begin < TELLING:
                return None
            self._base = max(self._counts, key=lambda n: (self._is_stamped(n), self._counts[n]))
        if number == self._base:
            self._due.append(time)
        return self._rows(time)

    def _is_stamped(self, number: int) -> bool:
        return self._clocks[number] is not None

    def _rows(self, now: float) -> dict[str, Array] | None:
        if not self._due or now - self._due[0] < TOGETHER:
            return None
        newest = [
            s.times[-1]
            for column, s in self._series.items()
            if s.times and not self.channels[column].signal.choices
        ]
        ready = max(min(newest, default=now), now - LONGEST_WAIT)
        count = int(np.searchsorted(self._due, ready, side="right"))
        if not count or self._due[count - 1] - self._due[0] < TOGETHER:
            return None
        times = np.array(self._due[:count])
        del self._due[:count]
        columns = {f"{TIME} [s]": times}
        for column, channel in self.channels.items():
            series = self._series[column]
            columns[channel.column] = series.at(times, bool(channel.signal.choices))
            series.forget(float(times[-1]))
        cells = pd.DataFrame({i: v for i, v in enumerate(columns.values())})
        table = Table(self._rig.path, tuple(columns), cells, np.arange(count, dtype=np.int64), {})
        return dict(record_of(self._rig, self._source, table).signals)


def decoded(
    frames: Iterator[can.Message | None], decoder: Decoder, stop: threading.Event
) -> Iterator[Chunk]:
    """Chunks of the frames of a bus; error frames are said once a second of them."""
    faults, said = 0, 0.0
    for frame in frames:
        if stop.is_set():
            return
        if frame is None:
            continue
        if frame.is_error_frame:
            faults += 1
            if frame.timestamp - said >= 1.0:
                yield Chunk(condition="bus fault", detail=f"{faults} error frames")
                faults, said = 0, frame.timestamp
            continue
        restarts = decoder.restarts
        rows = decoder.take(frame)
        if decoder.restarts > restarts:
            yield Chunk(condition="restarted")
        if rows is not None:
            yield Chunk(rows)


def listen(
    rig: Rig,
    interface: str,
    channel: str | None,
    bitrate: int,
    feed: Feed,
    stop: threading.Event,
) -> None:
    """Put the rows of a bus into a feed until `stop`.

    InputError, before anything is put, for a bus that cannot be opened or a signal that its definition has not.
    """
    bus = open_bus(BusAddress(interface, channel, bitrate))
    try:
        decoder = Decoder(rig)
    except InputError:
        bus.shutdown()
        raise
    threading.Thread(target=_listened, args=(bus, decoder, feed, stop), daemon=True).start()


def _listened(bus: can.BusABC, decoder: Decoder, feed: Feed, stop: threading.Event) -> None:
    def frames() -> Iterator[can.Message | None]:
        while not stop.is_set():
            try:
                yield bus.recv(0.2)
            except can.CanError as problem:
                feed.put(Chunk(condition="bus fault", detail=str(problem)))
                stop.wait(1.0)

    with bus:
        for chunk in decoded(frames(), decoder, stop):
            feed.put(chunk)
    feed.put(Chunk(condition="ended"))
