"""Frames of a CAN log, decoded by a DBC: which signal a column names, and all that a log holds of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import cantools.database
import numpy as np
from cantools.database.can import Database, Message, Signal

from sms import _core
from sms.io.errors import InputError, did_you_mean
from sms.io.tables import Remark
from sms.io.units import split_column_name
from sms.link.logs import read_frames

TIME = "time"  #: the column of the frames' times, from the log's first frame on
CLOCK = "sample_time"  #: the signal by which a sender says when it sampled
#: The project's own bus, libsms/firmware/sms.dbc, installed beside the compiled module.
DBC_FILE = Path(_core.__file__).with_name("sms.dbc")


def load_dbc(path: Path | None = None) -> Database:
    """Read a DBC file, by default the project's own. InputError when it is missing or not one."""
    path = DBC_FILE if path is None else path
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

    times: list[float] = field(default_factory=list)  #: of the logger, s, from its first frame on
    stamps: list[float] = field(default_factory=list)  #: of the sender, s, where it sends them
    numbers: list[int] = field(default_factory=list)  #: place in the log, from 1
    values: dict[str, list[float]] = field(default_factory=dict)


def no_value(signal: Signal, value: object) -> bool:
    """Whether a decoded value lies outside the range of its signal: there is none."""
    if not isinstance(value, (int, float)) or signal.minimum is None or signal.maximum is None:
        return False
    margin = 0.5 * abs(float(signal.scale))
    return not float(signal.minimum) - margin <= value <= float(signal.maximum) + margin


def find_channel(database: Database, column: str) -> Channel | None:
    """The signal that a column names: "extension_1", "Extension.extension_1", each also with unit.

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


def find_channels(file: Path, database: Database, wanted: Mapping[str, bool]) -> dict[str, Channel]:
    """The signal of each wanted column but the time; InputError for one that the DBC has not."""
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
            known = {signal.name for message in database.messages for signal in message.signals}
            name = split_column_name(column)[0]
            remedy = did_you_mean(name, sorted(known))
            raise InputError(f"{file}: the DBC has no signal '{name}'; {remedy}")
    return channels


def collect(
    file: Path, database: Database, channels: Mapping[str, Channel], remarks: list[Remark]
) -> dict[int, Frames]:
    """The frames of the wanted messages and of those with a clock, decoded, by identifier."""
    wanted: dict[int, Frames] = {
        m.frame_id: Frames() for m in database.messages if any(s.name == CLOCK for s in m.signals)
    }
    for channel in channels.values():
        frames = wanted.setdefault(channel.message.frame_id, Frames())
        frames.values[channel.signal.name] = []
    messages = {number: database.get_message_by_frame_id(number) for number in wanted}
    start: float | None = None
    unfit: Counter[str] = Counter()
    first: dict[str, int] = {}
    for number, frame in enumerate(read_frames(file), 1):
        start = frame.timestamp if start is None else start
        if frame.is_error_frame:
            unfit[""] += 1
            first.setdefault("", number)
            continue
        message = messages.get(frame.arbitration_id)
        if message is None or frame.is_remote_frame:
            continue
        try:
            decoded = message.decode_simple(bytes(frame.data), decode_choices=False)
        except Exception:  # cantools: DecodeError and its relatives
            unfit[message.name] += 1
            first.setdefault(message.name, number)
            continue
        into = wanted[frame.arbitration_id]
        into.times.append(frame.timestamp - start)
        into.numbers.append(number)
        if isinstance(stamp := decoded.get(CLOCK), (int, float)):
            into.stamps.append(float(stamp))
        for name, values in into.values.items():
            value = decoded.get(name)  # absent: another frame of a multiplexed message
            values.append(float(value) if isinstance(value, (int, float)) else np.nan)
    if start is None:
        raise InputError(f"{file}: there is no frame in this log; record it again")
    for name, count in unfit.items():
        if name:
            what = f"{count} frames of '{name}' do not fit the DBC and were left out"
            remarks.append(Remark(first[name], None, what, "check that it is the DBC of this bus"))
        else:
            what = f"{count} error frames stand in the log"
            remarks.append(Remark(first[name], None, what, "check bit rate, termination and cable"))
    return wanted
