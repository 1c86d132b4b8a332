"""CAN logs as records: frames decoded by a DBC into columns on one time base.

The messages of a bus come at different times and rates. The times of a record are those of its fastest message: of the
messages that hold a wanted signal, the one with the most frames. The signals of the others are led onto these times by
straight lines between their frames; a signal with named values (a mode, a switch) keeps its last value instead. Before
the first frame of the latest message and after the last of the earliest there is nothing to lead, so the record begins
and ends there.

Nothing is repaired in silence: gaps, frames out of order, frames too short for their message and bus errors are said.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import cantools.database
import numpy as np
import pandas as pd
from cantools.database.can import Database, Message, Signal
from numpy.typing import NDArray

from sms.io.errors import InputError, did_you_mean, nearest
from sms.io.tables import Remark, Table
from sms.io.units import split_column_name
from sms.link.logs import read_frames

GAP = 5.0  #: times the usual interval of a message
TIME = "time"  #: the column of the frames' times, from the log's first frame on

Array = NDArray[np.float64]


def load_dbc(path: Path) -> Database:
    """Read a DBC file. InputError when it is missing or not one."""
    try:
        database = cantools.database.load_file(path, database_format="dbc", strict=True)
    except OSError as problem:
        raise InputError(f"{path}: cannot be read ({problem.strerror}); check the path") from None
    except Exception as problem:  # the parser's errors are of many kinds
        raise InputError(f"{path}: not a readable DBC file ({problem})") from None
    assert isinstance(database, Database)
    return database


@dataclass(frozen=True)
class Channel:
    """One wanted column: which signal of which message."""

    name: str  #: as the rig file wrote it, without the unit: "extension_1", "Air.temperature"
    message: Message
    signal: Signal

    @property
    def column(self) -> str:
        """The column's name with the unit of the DBC: "extension_1 [m]"."""
        return f"{self.name} [{self.signal.unit or '1'}]"


@dataclass
class Frames:
    """What a log holds of one message."""

    times: list[float] = field(default_factory=list)
    numbers: list[int] = field(default_factory=list)  #: place in the log, from 1
    values: dict[str, list[float]] = field(default_factory=dict)


def find_channel(database: Database, column: str) -> Channel | None:
    """The signal that a column names: "extension_1", "Extensions.extension_1", each also with unit.

    InputError when several messages have a signal of that name; None when none has.
    """
    wanted, _ = split_column_name(column)
    message_name, _, signal_name = wanted.rpartition(".")
    found = [
        Channel(wanted, message, signal)
        for message in database.messages
        if message_name in ("", message.name)
        for signal in message.signals
        if signal.name == signal_name
    ]
    if len(found) > 1:
        choices = ", ".join(f"{c.message.name}.{c.signal.name}" for c in found)
        raise InputError(f"the column '{column}' is in several messages; write one of {choices}")
    return found[0] if found else None


def read_can_log(file: Path, database: Database, wanted: Mapping[str, bool]) -> Table:
    """The wanted columns of a log as a table; `wanted` says of each whether the record may lack it.

    The column "time [s]" counts from the log's first frame. InputError for a column that no message
    has, or a message that never came, unless it may lack.
    """
    channels = _channels(file, database, wanted)
    messages = {channel.message.frame_id: channel.message for channel in channels.values()}
    per_message = {
        frame_id: Frames(
            values={c.signal.name: [] for c in channels.values() if c.message is message}
        )
        for frame_id, message in messages.items()
    }
    remarks = _collect(file, messages, per_message)
    for column, channel in list(channels.items()):
        if len(per_message[channel.message.frame_id].times) < 2:
            if not wanted[column]:
                count = len(per_message[channel.message.frame_id].times)
                raise InputError(
                    f"{file}: the message '{channel.message.name}' with '{channel.signal.name}' "
                    f"came {count} times; a record needs two frames at least"
                )
            del channels[column]
    present = {c.message.frame_id for c in channels.values()}
    if not present:
        raise InputError(f"{file}: none of the wanted messages came; check the DBC and the log")
    ordered = {i: _in_order(per_message[i], messages[i], remarks) for i in sorted(present)}
    return _on_one_time_base(file, list(channels.values()), ordered, remarks)


def _channels(file: Path, database: Database, wanted: Mapping[str, bool]) -> dict[str, Channel]:
    channels: dict[str, Channel] = {}
    for column, may_lack in wanted.items():
        if split_column_name(column)[0] == TIME:
            continue
        try:
            channel = find_channel(database, column)
        except InputError as problem:
            raise InputError(f"{file}: {problem}") from None
        if channel is not None:
            channels[column] = channel
        elif not may_lack:
            known = [signal.name for message in database.messages for signal in message.signals]
            name = split_column_name(column)[0]
            near = nearest(name, known)
            remedy = did_you_mean(name, known) if near else "`sms can signals` lists them"
            raise InputError(f"{file}: the DBC has no signal '{name}'; {remedy}")
    return channels


def _collect(
    file: Path, messages: Mapping[int, Message], into: Mapping[int, Frames]
) -> list[Remark]:
    """Decode the frames of the wanted messages; remarks on those that could not be used."""
    start: float | None = None
    short: Counter[str] = Counter()
    first_short: dict[str, int] = {}
    errors, first_error = 0, 0
    for number, frame in enumerate(read_frames(file), 1):
        start = frame.timestamp if start is None else start
        if frame.is_error_frame:
            errors, first_error = errors + 1, first_error or number
            continue
        message = messages.get(frame.arbitration_id)
        if message is None or frame.is_remote_frame:
            continue
        try:
            decoded = message.decode_simple(bytes(frame.data), decode_choices=False)
        except Exception:  # cantools: DecodeError and its relatives
            short[message.name] += 1
            first_short.setdefault(message.name, number)
            continue
        frames = into[frame.arbitration_id]
        frames.times.append(frame.timestamp - start)
        frames.numbers.append(number)
        for name, values in frames.values.items():
            value = decoded.get(name)  # absent: another frame of a multiplexed message
            values.append(float(value) if isinstance(value, (int, float)) else np.nan)
    if start is None:
        raise InputError(f"{file}: there is no frame in this log; record it again")
    remarks = [
        Remark(
            first_short[name],
            None,
            f"{count} frames of '{name}' do not fit the DBC and were left out",
            "check that the DBC is the one the bus was using",
        )
        for name, count in short.items()
    ]
    if errors:
        what = f"{errors} error frames stand in the log"
        remarks.append(Remark(first_error, None, what, "check bit rate, termination and cable"))
    return remarks


@dataclass(frozen=True)
class Series:
    """One message in order of time: each array (frames,)."""

    times: Array
    numbers: NDArray[np.int64]
    values: Mapping[str, Array]


def _in_order(frames: Frames, message: Message, remarks: list[Remark]) -> Series:
    """Sorted by time; of frames with the same time the first is kept; both are remarked."""
    times = np.array(frames.times)
    numbers = np.array(frames.numbers, dtype=np.int64)
    order = np.argsort(times, kind="stable")
    back = np.flatnonzero(np.diff(times) < 0.0)
    if back.size:
        what = f"{back.size} frames of '{message.name}' stand out of order and were sorted by time"
        remarks.append(Remark(int(numbers[back[0] + 1]), None, what, "check the logger"))
    kept = order[np.concatenate([[True], np.diff(times[order]) > 0.0])]
    if kept.size < order.size:
        what = f"{order.size - kept.size} frames of '{message.name}' have the time of another one"
        remarks.append(
            Remark(None, None, what + "; the first of each was kept", "check the logger")
        )
    _remark_gaps(times[kept], numbers[kept], message, remarks)
    values = {name: np.array(v)[kept] for name, v in frames.values.items()}
    return Series(times[kept], numbers[kept], values)


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
    base = max(series.values(), key=lambda s: s.times.size)
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
