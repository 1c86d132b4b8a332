"""Frames and signals: the bus as libsms/firmware/sms.dbc defines it, for the desk's side.

Command frames carry an alive counter, the session of the desk that sends them, and a CRC-8 which
also covers the identifier and the controller's challenge; docs/protocol.md says what each is for.
Signals are packed by cantools, by which the firmware's own codec is tested; the CRC is the core's.
Where the controller has a key, an authenticator goes before each command; its MAC is the core's too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

import can
from cantools.database.can import Database, Message
from cantools.database.namedsignalvalue import NamedSignalValue

from sms import _core
from sms.errors import InputError, did_you_mean
from sms.io.can_frames import load_dbc, no_value

HOST, CONTROLLER = "Host", "Controller"
CHECKED = ("crc", "alive", "session")  #: the signals that protect a command frame
_ALIVE_MODULUS, _FRESHNESS_MODULUS = 16, 4096

Value = float | int | str  #: a signal's value; the name where the DBC names values


@cache
def bus_definition() -> Database:
    """The project's bus."""
    return load_dbc()


def message(name: str) -> Message:
    """One message by its name. InputError for an unknown one."""
    known = {m.name: m for m in bus_definition().messages}
    if name not in known:
        raise InputError(f"the bus has no message '{name}'; {did_you_mean(name, known)}")
    return known[name]


@cache
def sent_by(node: str) -> Mapping[int, Message]:
    """The messages that a node sends, by identifier."""
    return {m.frame_id: m for m in bus_definition().messages if node in m.senders}


@cache
def period(name: str) -> float:
    """The usual interval of a cyclic message, s."""
    return float(message(name).cycle_time or 0) / 1e3


@cache
def time_out(name: str) -> float:
    """After how long without it a message counts as gone, s."""
    attributes = message(name).dbc.attributes  # type: ignore[union-attr]
    return float(attributes["GenMsgTimeoutTime"].value) / 1e3


def checksum(identifier: int, challenge: int, data: bytes) -> int:
    """CRC-8/SAE-J1850 over identifier (low, high octet), challenge and octets 1 to 7 of a frame."""
    return _core.command_crc(identifier, challenge, data)


def decode(frame: can.Message) -> tuple[str, dict[str, Value]] | None:
    """Name and signals of one frame; None for one that is not of this bus or does not fit it.

    A signal that carries no value is left out.
    """
    if frame.is_error_frame or frame.is_remote_frame or frame.is_extended_id:
        return None
    try:
        described = bus_definition().get_message_by_frame_id(frame.arbitration_id)
        signals = described.decode_simple(bytes(frame.data))
    except Exception:  # unknown, too short: not ours
        return None
    return described.name, {
        name: value.name if isinstance(value, NamedSignalValue) else value
        for name, value in signals.items()
        if not no_value(described.get_signal_by_name(name), value)
    }


@dataclass
class Sender:
    """Makes the command frames of one desk."""

    session: int  #: 1 to 14
    challenge: int = 0  #: the last one that the controller's heartbeat told
    key: bytes | None = field(
        default=None, repr=False
    )  #: 16 octets; None: nothing is authenticated
    nonce: int = 0  #: the last one that the controller told; only one with a key does

    def __post_init__(self) -> None:
        """Counters start at zero."""
        self._alive: dict[int, int] = {}
        self._counter = 0

    def hear_nonce(self, nonce: int) -> None:
        """Authenticate for this nonce; with another one the counter begins anew."""
        if nonce != self.nonce:
            self.nonce, self._counter = nonce, 0

    def authenticator(self, frame: can.Message) -> can.Message:
        """What has to go before a command frame on the bus of a controller with a key."""
        assert self.key is not None, "only a desk with a key authenticates"
        self._counter += 1
        data, number = bytes(frame.data), frame.arbitration_id
        mac = _core.command_mac(self.key, self.nonce, self._counter, number, data)
        described = message("CommandAuthenticator")
        values = {
            "freshness": self._counter % _FRESHNESS_MODULUS,
            "session": self.session,
            "command_crc": data[0],
            "mac_low": mac & 0xFFFFFFFF,
            "mac_high": mac >> 32,
        }
        return can.Message(
            arbitration_id=described.frame_id,
            is_extended_id=False,
            data=_encoded(described, values),
        )

    def frame(self, name: str, signals: Mapping[str, Value] | None = None) -> can.Message:
        """A command frame with counter and CRC; reserved bits are zero.

        InputError for a signal that is missing, unknown or out of its range.
        """
        described = message(name)
        alive = (self._alive.get(described.frame_id, -1) + 1) % _ALIVE_MODULUS
        self._alive[described.frame_id] = alive
        values: dict[str, Value] = {"crc": 0, "alive": alive, "session": self.session}
        if any(signal.name == "reserved" for signal in described.signals):
            values["reserved"] = 0
        values.update(signals or {})
        data = bytearray(_encoded(described, values))
        data[0] = checksum(described.frame_id, self.challenge, bytes(data))
        return can.Message(arbitration_id=described.frame_id, is_extended_id=False, data=data)


def _encoded(described: Message, values: Mapping[str, Value]) -> bytes:
    try:
        return described.encode(dict(values), strict=True)
    except Exception as problem:  # cantools: EncodeError, KeyError, ...
        raise InputError(f"{described.name}: {problem}") from None
