"""CAN logs as records: frames decoded by a DBC into columns on one time base.

The messages of a bus come at different times and rates. The times of a record are those of one of its messages: of
those that hold a wanted signal, the one with the most frames. The signals of the others are led onto these times by
straight lines between their frames; a signal with named values (a mode, a switch) keeps its last value instead. Before
the first frame of the latest message and after the last of the earliest there is nothing to lead, so the record begins
and ends there.

A signal `sample_time` is the sender's own clock, free of what the bus and the logger add: where a message has it, it is
the message's time (unwrapped), and a message with it is preferred as the time base. A frame without one takes that of
the frame with one before it, plus the time between the two.

A value outside the range that the DBC gives its signal says that there is no value.

Nothing is repaired in silence: gaps, frames out of order or too short for their message, missing values, a clock that
jumps and bus errors are said.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from cantools.database.can import Database, Message, Signal
from numpy.typing import NDArray

from sms.arrays import Array
from sms.errors import InputError
from sms.io.can_frames import (
    CLOCK,
    TIME,
    Channel,
    Frames,
    collect,
    find_channels,
    lacks_value,
    load_dbc,
)
from sms.io.table import Remark, Table

TELEMETRY = "Controller"  #: who sends the telemetry of the project's own bus
GAP = 5.0  #: times the usual interval of a message
CLOCK_JUMP = 1.0  #: s between the sender's clock and the logger's


def read_can_log(file: Path, database: Database, wanted: Mapping[str, bool]) -> Table:
    """The wanted columns of a log as a table; `wanted` says of each whether the record may lack it.

    The column "time [s]" counts from the log's first frame, or first clock reading. InputError for
    a column that no message has, or that never came, unless it may lack.
    """
    channels = find_channels(file, database, wanted)
    remarks: list[Remark] = []
    per_message = collect(file, database, channels, remarks)
    clock = _clock(database, per_message, remarks)
    kept: list[Channel] = []
    series: dict[int, Series] = {}
    for column, channel in channels.items():
        number = channel.message.frame_id
        if number not in series:
            series[number] = _in_order(per_message[number], clock, channel.message, remarks)
        count = np.count_nonzero(np.isfinite(series[number].values[channel.signal.name]))
        if count >= 2:
            kept.append(channel)
        elif not wanted[column]:
            raise InputError(
                f"{file}: '{channel.message.name}' came {len(per_message[number].times)} times, "
                f"with {count} values of '{channel.signal.name}'; a record needs two at least"
            )
    if not kept:
        raise InputError(f"{file}: none of the wanted messages came; check the DBC and the log")
    return _on_one_time_base(file, kept, series, remarks)


def read_telemetry(file: Path) -> Table:
    """All physical signals, that is those with a unit, that the controller of the project's bus sent.

    A name that a command has, too, is written with its message: "Setpoint.extension_setpoint_1".
    """
    database = load_dbc()
    sent = [m for m in database.messages if TELEMETRY in m.senders and m.cycle_time]
    return read_can_log(file, database, dict.fromkeys(_columns_of(database, sent), True))


def read_bus(file: Path, dbc: Path) -> Table:
    """All physical signals of a log of another bus; those that never came are left out."""
    database = load_dbc(dbc)
    return read_can_log(
        file, database, dict.fromkeys(_columns_of(database, database.messages), True)
    )


def _columns_of(database: Database, messages: Sequence[Message]) -> list[str]:
    """Each physical signal by the shortest name that no other has: alone, with its message, or with its identifier."""
    every = [(m, s.name) for m in database.messages for s in m.signals]
    alone = Counter(name for _, name in every)
    with_message = Counter(f"{m.name}.{name}" for m, name in every)
    columns = []
    for message in messages:
        for signal in message.signals:
            if not signal.unit or signal.name == CLOCK:
                continue
            name = f"{message.name}.{signal.name}"
            if alone[signal.name] == 1:
                name = signal.name
            elif with_message[name] > 1:
                name = f"0x{message.frame_id:X}.{signal.name}"
            columns.append(name)
    return columns


@dataclass(frozen=True)
class Clock:
    """The sender's clock: its readings (readings,), unwrapped, and when the logger saw them."""

    seen: Array  #: s
    reading: Array  #: s

    def time(self, seen: Array) -> Array:
        """The sender's time of frames without a reading, from when the logger saw them."""
        if self.seen.size == 0:
            return seen
        last = np.maximum(np.searchsorted(self.seen, seen, side="right") - 1, 0)
        return np.asarray(self.reading[last] + (seen - self.seen[last]))


def _unwrapped(stamps: Array, seen: Array, wrap: float) -> Array:
    """Readings of a clock that runs over every `wrap` seconds, by when the logger saw them."""
    turns = np.round((seen - seen[0] - (stamps - stamps[0])) / wrap)
    return np.asarray(stamps - stamps[0] + wrap * turns)


def _clock(database: Database, per_message: dict[int, Frames], remarks: list[Remark]) -> Clock:
    """All readings in the order in which the logger saw them; each message's are unwrapped."""
    stamped = {n: frames for n, frames in per_message.items() if frames.stamps.size}
    if not stamped:
        return Clock(np.array([]), np.array([]))
    signal = database.get_message_by_frame_id(next(iter(stamped))).get_signal_by_name(CLOCK)
    wrap = 2.0**signal.length * float(signal.scale)
    seen = np.concatenate([frames.times for frames in stamped.values()])
    stamps = np.concatenate([frames.stamps for frames in stamped.values()])
    numbers = np.concatenate([frames.numbers for frames in stamped.values()])
    order = np.argsort(numbers, kind="stable")
    readings = np.empty(seen.size)
    readings[order] = _unwrapped(stamps[order], seen[order], wrap)
    drift = np.abs(np.diff(readings[order] - seen[order]))
    if drift.size and float(drift.max()) > CLOCK_JUMP:
        worst = order[int(np.argmax(drift)) + 1]
        what = f"the sender's clock jumps by {drift.max():.3g} s"
        remarks.append(Remark(int(numbers[worst]), None, what, "was it reset while recording?"))
    begin = 0
    for frames in stamped.values():
        end = begin + len(frames.times)
        frames.stamps = readings[begin:end]
        begin = end
    order = np.argsort(seen, kind="stable")
    return Clock(seen[order], readings[order])


@dataclass(frozen=True)
class Series:
    """One message in order of time: each array (frames,)."""

    stamped: bool  #: by the sender's clock
    times: Array
    numbers: NDArray[np.int64]
    values: Mapping[str, Array]


def _in_order(frames: Frames, clock: Clock, message: Message, remarks: list[Remark]) -> Series:
    """Sorted by time; of frames with the same time the first is kept; both are remarked."""
    stamped = frames.stamps.size > 0
    times = frames.stamps if stamped else clock.time(frames.times)
    numbers = frames.numbers
    order = np.argsort(times, kind="stable")
    back = np.flatnonzero(np.diff(times) < 0.0)
    if back.size:
        what = f"{back.size} frames of '{message.name}' stand out of order and were sorted by time"
        remarks.append(Remark(int(numbers[back[0] + 1]), None, what, "check the logger"))
    kept = order[np.flatnonzero(np.diff(times[order], prepend=-np.inf) > 0.0)]
    if kept.size < order.size:
        what = f"{order.size - kept.size} frames of '{message.name}' have the time of another one"
        remarks.append(
            Remark(None, None, what + "; the first of each was kept", "check the logger")
        )
    _remark_gaps(times[kept], numbers[kept], message, remarks)
    values = {name: column[kept] for name, column in frames.values.items()}
    for name, column in values.items():
        _drop_out_of_range(message.get_signal_by_name(name), column, numbers[kept], remarks)
    return Series(stamped, times[kept], numbers[kept], values)


def _drop_out_of_range(
    signal: Signal, column: Array, numbers: NDArray[np.int64], remarks: list[Remark]
) -> None:
    """Make values outside the DBC's range NaN; remark when there are others too."""
    lacking = lacks_value(signal, column)
    if signal.multiplexer_signal is not None:  # what another frame holds is not lacking here
        lacking &= np.isfinite(column)
    column[lacking] = np.nan
    count = np.count_nonzero(lacking)
    if 0 < count < column.size:
        first = int(np.argmax(lacking))
        what = f"{count} of {column.size} values are outside the DBC's range, that is, no value"
        remedy = "they are straight lines between the others; check the sensor, or the DBC"
        remarks.append(Remark(int(numbers[first]), signal.name, what, remedy))


def _remark_gaps(
    times: Array, numbers: NDArray[np.int64], message: Message, remarks: list[Remark]
) -> None:
    steps = np.diff(times)
    usual = float(np.median(steps)) if steps.size else 0.0
    gaps = np.flatnonzero(steps > GAP * usual)
    if gaps.size:
        worst = int(gaps[np.argmax(steps[gaps])])
        more = f" (the longest of {gaps.size} gaps)" if gaps.size > 1 else ""
        remarks.append(
            Remark(
                int(numbers[worst]),
                None,
                f"no frame of '{message.name}' for {steps[worst]:.3g} s after {times[worst]:.3f} s, "
                f"usually every {1e3 * usual:.3g} ms{more}",
                "its signals are straight lines there; leave that stretch out if it matters",
            )
        )


def _on_one_time_base(
    file: Path, channels: Sequence[Channel], series: Mapping[int, Series], remarks: list[Remark]
) -> Table:
    present = {channel.message.frame_id for channel in channels}
    base = max((series[i] for i in sorted(present)), key=lambda s: (s.stamped, s.times.size))
    known = [_known(channel, series[channel.message.frame_id]) for channel in channels]
    begin = max(float(times[0]) for times, _ in known)
    end = min(float(times[-1]) for times, _ in known)
    inside = (base.times >= begin) & (base.times <= end)
    if np.count_nonzero(inside) < 2:
        raise InputError(
            f"{file}: the messages wanted are never on the bus at the same time; "
            "record them together, or map fewer signals"
        )
    at = base.times[inside]
    columns = {f"{TIME} [s]": at}
    for channel, (times, values) in zip(channels, known, strict=True):
        if channel.signal.choices:
            columns[channel.column] = values[np.searchsorted(times, at, side="right") - 1]
        else:
            columns[channel.column] = np.interp(at, times, values)
    cells = pd.DataFrame({i: column for i, column in enumerate(columns.values())})
    return Table(file, tuple(columns), cells, base.numbers[inside], {}, tuple(remarks))


def _known(channel: Channel, series: Series) -> tuple[Array, Array]:
    """Times and values of one signal; a multiplexed one is in some frames of its message only."""
    values = series.values[channel.signal.name]
    there = np.isfinite(values)
    return series.times[there], values[there]
