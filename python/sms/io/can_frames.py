"""Frames of a CAN log, decoded by a DBC: which signal a column names, and all that a log holds of it."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import cantools.database
import numpy as np
from cantools.database.can import Database, Message, Signal
from numpy.typing import NDArray

from sms import _core
from sms.arrays import Array
from sms.errors import InputError, did_you_mean
from sms.io.can_decode import Payloads
from sms.io.can_files import read_frames
from sms.io.table import Remark
from sms.io.units import split_column_name

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
    except Exception as problem:  # the parser's errors are of many kinds, and of several lines
        said = " ".join(str(problem).split())
        raise InputError(f"{path}: not a readable DBC file ({said})") from None
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
    """What a log holds of one message. Arrays (frames,)."""

    times: Array  #: of the logger, s, from its first frame on
    stamps: Array  #: of the sender, s, where it sends them; else empty
    numbers: NDArray[np.int64]  #: place in the log, from 1
    values: dict[str, Array]


@dataclass
class _Kept:
    """Frames of one message as they are read: packed, because there may be millions."""

    message: Message
    times: array[float] = field(default_factory=lambda: array("d"))
    numbers: array[int] = field(default_factory=lambda: array("q"))
    octets: bytearray = field(default_factory=bytearray)
    unfit: array[int] = field(default_factory=lambda: array("q"))  #: numbers of those too short

    def take(self, time: float, number: int, data: bytearray) -> None:
        """One frame."""
        length = self.message.length
        if len(data) < length:
            self.unfit.append(number)
            return
        self.times.append(time)
        self.numbers.append(number)
        self.octets += data[:length]

    def decoded(self, wanted: Iterable[str]) -> Frames:
        """The wanted signals and the sender's clock; `unfit` grows by what the DBC does not describe."""
        length = self.message.length
        octets = np.frombuffer(self.octets, np.uint8).reshape(len(self.times), length)
        numbers = np.array(self.numbers, dtype=np.int64)
        fits = Payloads(self.message, octets).fit()
        self.unfit.extend(numbers[~fits].tolist())
        payloads = Payloads(self.message, octets[fits])
        signals = {signal.name: signal for signal in self.message.signals}
        stamps = payloads.column(signals[CLOCK]) if CLOCK in signals else np.array([])
        values = {name: payloads.column(signals[name]) for name in wanted}
        return Frames(np.array(self.times)[fits], stamps, numbers[fits], values)


def no_value(signal: Signal, value: object) -> bool:
    """Whether a decoded value lies outside the range of its signal: there is none."""
    if not isinstance(value, (int, float)) or signal.minimum is None or signal.maximum is None:
        return False
    margin = 0.5 * abs(float(signal.scale))
    return not float(signal.minimum) - margin <= value <= float(signal.maximum) + margin


def lacks_value(signal: Signal, column: Array) -> NDArray[np.bool_]:
    """`no_value` of many decoded values (frames,), NaN among them."""
    if signal.minimum is None or signal.maximum is None:
        return np.zeros(column.shape, dtype=np.bool_)
    margin = 0.5 * abs(float(signal.scale))
    inside = (column >= float(signal.minimum) - margin) & (column <= float(signal.maximum) + margin)
    return np.asarray(~inside)


def find_channel(database: Database, column: str) -> Channel | None:
    """The signal that a column names: "extension_1", "Extension.extension_1" or, with the message's identifier,
    "0x181.extension_1"; each also with unit.

    InputError when several messages have a signal of that name; None when none has.
    """
    wanted, _ = split_column_name(column)
    message_name, _, signal_name = wanted.rpartition(".")
    found = [
        Channel(wanted, message, signal)
        for message in database.messages
        if message_name in ("", message.name, f"0x{message.frame_id:X}")
        for signal in message.signals
        if signal.name == signal_name
    ]
    if len(found) > 1:
        raise InputError(_ambiguous(column, found))
    return found[0] if found else None


def _ambiguous(column: str, found: Sequence[Channel]) -> str:
    """Which name tells them apart; where none does, what to change in the DBC."""
    called = Counter(c.message.name for c in found)
    choices = list(
        dict.fromkeys(
            f"{c.message.name if called[c.message.name] == 1 else f'0x{c.message.frame_id:X}'}.{c.signal.name}"
            for c in found
        )
    )
    if len(choices) > 1:
        return f"the column '{column}' is in several messages; write one of {', '.join(choices)}"
    message, signal = found[0].message.name, found[0].signal.name
    return (
        f"the column '{column}': message '{message}' of the DBC has {len(found)} signals of the name '{signal}', which "
        "no column name can tell apart; rename all but one of them in the DBC"
    )


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
    kept = {
        m.frame_id: _Kept(m) for m in database.messages if any(s.name == CLOCK for s in m.signals)
    }
    signals: dict[int, list[str]] = {}
    by_group = _by_parameter_group(database)
    senders: dict[int, set[int]] = {}
    for channel in channels.values():
        kept.setdefault(channel.message.frame_id, _Kept(channel.message))
        signals.setdefault(channel.message.frame_id, []).append(channel.signal.name)
    start: float | None = None
    broken: list[int] = []
    for number, frame in enumerate(read_frames(file), 1):
        start = frame.timestamp if start is None else start
        if frame.is_error_frame:
            broken.append(number)
            continue
        identifier = frame.arbitration_id
        if frame.is_extended_id and by_group and identifier not in kept:
            identifier = by_group.get(_parameter_group(identifier), identifier)
        if (into := kept.get(identifier)) is not None and not frame.is_remote_frame:
            into.take(frame.timestamp - start, number, frame.data)
            if identifier in by_group.values():
                senders.setdefault(identifier, set()).add(frame.arbitration_id & 0xFF)
    if start is None:
        raise InputError(f"{file}: there is no frame in this log; record it again")
    frames = {number: k.decoded(signals.get(number, ())) for number, k in kept.items()}
    if broken:
        what = f"{len(broken)} error frames stand in the log"
        remarks.append(Remark(broken[0], None, what, "check bit rate, termination and cable"))
    for identifier, addresses in senders.items():
        if len(addresses) > 1 and identifier in signals:
            who = ", ".join(f"0x{a:02X}" for a in sorted(addresses))
            what = f"'{kept[identifier].message.name}' came from several addresses ({who}), taken for one sender"
            remarks.append(Remark(None, None, what, "cut the log to the frames of one of them"))
    for k in kept.values():
        if k.unfit:
            what = (
                f"{len(k.unfit)} frames of '{k.message.name}' do not fit the DBC and were left out"
            )
            remarks.append(Remark(min(k.unfit), None, what, "check that it is the DBC of this bus"))
    return frames


# ---- J1939 -----------------------------------------------------------------------------------------


def _parameter_group(identifier: int) -> int:
    """Of a 29-bit identifier the parameter group number (SAE J1939-21): without priority and source address, and
    without the destination where a message is addressed to one."""
    group = (identifier >> 8) & 0x3FFFF
    return group if (group >> 8) & 0xFF >= 240 else group & 0x3FF00


def _by_parameter_group(database: Database) -> dict[int, int]:
    """Parameter group -> identifier in the DBC, of its messages of J1939; senders and priorities may be others."""
    return {
        _parameter_group(m.frame_id): m.frame_id
        for m in database.messages
        if m.is_extended_frame and m.protocol == "j1939"
    }
