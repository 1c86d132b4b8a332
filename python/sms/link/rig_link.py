"""A desk on the bus: takes control of a rig, commands it, and knows what it said last.

One thread does everything: whoever waits, for an answer or for the next set-point, calls `poll`, which receives frames
and sends the heartbeat when it is due. The clock is a parameter, so that a test can run in simulated time.

Frames are kept undecoded until somebody asks: a desk that only listens costs next to nothing.
"""

from __future__ import annotations

import random
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import TracebackType

import can

from sms import _core
from sms.link.codec import (
    CONTROLLER,
    HOST,
    Sender,
    Value,
    decode,
    message,
    period,
    sent_by,
    time_out,
)

PROTOCOL_VERSION = 1
ANSWER = 0.05  #: s; a parameter frame that is not confirmed by then is sent again
TRIES = 5
KEY_TOLD = 0.3  #: s; a rig with a key tells its nonce within that: three of its periods
SESSIONS = range(1, 15)


class LinkError(RuntimeError):
    """The rig did not do what was asked. The text is one sentence: what, why, what to do."""


class BusError(LinkError):
    """The bus itself fails."""


class NotConnectedError(LinkError):
    """No rig answers, or it is another kind of rig."""


class RefusedError(LinkError):
    """The rig refused: the mode, the parameter, or control."""


@dataclass(frozen=True)
class Reading:
    """One frame of the rig, decoded; signals without a value are left out."""

    message: str
    time: float  #: when it was received, s, on the desk's clock
    signals: Mapping[str, Value]


class RigLink:
    """A desk's link with one rig."""

    def __init__(
        self,
        bus: can.BusABC,
        clock: Callable[[], float] = time.monotonic,
        session: int | None = None,
        key: bytes | None = None,
    ) -> None:
        """A link on an open bus, which stays the caller's. Nothing is sent before `connect`.

        `key`: 16 octets, the rig's; None for a rig without one.
        """
        self.bus = bus
        self.clock = clock
        self.sender = Sender(session or random.choice(SESSIONS), key=key)
        self.counts: Counter[int] = Counter()  #: frames received, by identifier
        self.events: list[Reading] = []  #: not yet taken by `take_events`
        self.listener: Callable[[can.Message], None] | None = (
            None  #: sees every frame on the bus, once
        )
        self._latest: dict[int, tuple[float, can.Message]] = {}
        self._next_heartbeat: float | None = None
        self._from_rig, self._from_desk = sent_by(CONTROLLER), sent_by(HOST)
        self._event = message("Event").frame_id
        self._heartbeat = message("ControllerHeartbeat").frame_id
        self._nonce = message("SessionNonce").frame_id

    # ---- listening ---------------------------------------------------------------------------------------------

    def poll(self, until: float | None = None) -> can.Message | None:
        """Receive one frame, or None when the clock reaches `until` (None: only what is there).

        Sends the heartbeat when it is due.
        """
        now = self.clock()
        while True:
            if self._next_heartbeat is not None and now >= self._next_heartbeat:
                self._send_heartbeat(now)
            wake = until if until is not None else now
            if self._next_heartbeat is not None:
                wake = min(wake, self._next_heartbeat)
            frame = self._receive(max(0.0, wake - now))
            now = self.clock()
            if frame is not None:
                self._take(frame, now)
                return frame
            if until is None or now >= until:
                return None

    def _receive(self, seconds: float) -> can.Message | None:
        try:
            return self.bus.recv(seconds)
        except can.CanError as problem:
            raise BusError(f"the bus cannot be read ({problem}); check cable and driver") from None

    def drain(self) -> None:
        """Receive all that is there."""
        while self.poll() is not None:
            pass

    def latest(self, name: str) -> Reading | None:
        """The last frame of a message."""
        found = self._latest.get(message(name).frame_id)
        if found is None:
            return None
        decoded = decode(found[1])
        return None if decoded is None else Reading(name, found[0], decoded[1])

    def value(self, name: str, signal: str) -> Value | None:
        """The last value of a signal; None when there is none."""
        reading = self.latest(name)
        return None if reading is None else reading.signals.get(signal)

    def is_alive(self) -> bool:
        """Whether the rig's heartbeat came within its time-out."""
        found = self._latest.get(self._heartbeat)
        return found is not None and self.clock() - found[0] <= time_out("ControllerHeartbeat")

    def take_events(self) -> list[Reading]:
        """The events since the last call."""
        taken, self.events = self.events, []
        return taken

    def wait(self, is_true: Callable[[], bool], seconds: float) -> bool:
        """Poll until something is true; False when it is not within that time."""
        end = self.clock() + seconds
        while not is_true():
            if self.clock() >= end:
                return False
            self.poll(end)
        return True

    def _take(self, frame: can.Message, now: float) -> None:
        number = frame.arbitration_id
        if self.listener is not None and not self._is_own(frame):
            self.listener(frame)
        if number not in self._from_rig or frame.is_error_frame:
            return
        self.counts[number] += 1
        self._latest[number] = now, frame
        if number == self._event and (decoded := decode(frame)) is not None:
            self.events.append(Reading("Event", now, decoded[1]))
        elif number == self._heartbeat and (decoded := decode(frame)) is not None:
            self.sender.challenge = int(decoded[1]["challenge"])
        elif number == self._nonce and (decoded := decode(frame)) is not None:
            signals = decoded[1]
            self.sender.hear_nonce(int(signals["nonce_high"]) << 32 | int(signals["nonce_low"]))

    def _is_own(self, frame: can.Message) -> bool:
        """Whether a frame is the echo of one that this desk sent, as some interfaces give it."""
        session = frame.data[1] >> 4 if len(frame.data) > 1 else 0
        return frame.arbitration_id in self._from_desk and session == self.sender.session

    # ---- control -----------------------------------------------------------------------------------------------

    def connect(self, seconds: float = 1.0) -> None:
        """Take control of the rig.

        NotConnectedError when none answers, RefusedError when another desk has it or it wants another key.
        """
        self.listen(seconds)
        heartbeat = self._signals("ControllerHeartbeat")
        version, hash_there = int(heartbeat["protocol_version"]), int(heartbeat["params_hash"])
        if version != PROTOCOL_VERSION:
            raise NotConnectedError(
                f"the rig speaks protocol version {version}, this program {PROTOCOL_VERSION}; "
                "use the program that came with the rig's firmware"
            )
        if hash_there != _core.firmware_hash():
            raise NotConnectedError(
                f"the rig has other parameters (hash {hash_there:08x}, here "
                f"{_core.firmware_hash():08x}); use the program that came with the rig's firmware"
            )
        if self.sender.key is not None and not self.wait(self.has_key, KEY_TOLD):
            raise NotConnectedError(
                "the rig has no key and would obey anybody on this bus; "
                "give the rig its key, or leave --key-file out"
            )
        while self._in_control() == self.sender.session:  # another desk drew the same number
            self.sender = replace(self.sender, session=random.choice(SESSIONS))
        self._next_heartbeat = self.clock()
        if not self.wait(lambda: self._in_control() == self.sender.session, seconds):
            self._next_heartbeat = None
            other = self._in_control()
            if other == 0 and self.has_key():
                raise RefusedError(self._wrong_key())
            who = {0: "nobody", 15: "the console"}.get(other, f"another desk (session {other})")
            raise RefusedError(f"the rig does not take this desk: {who} has control; wait for it")

    def has_key(self) -> bool:
        """Whether the rig obeys authentic commands only."""
        return self._nonce in self._latest

    def _wrong_key(self) -> str:
        if self.sender.key is None:
            return "the rig obeys authenticated commands only; give its key: --key-file FILE"
        return (
            "the rig refuses this desk's frames as not authentic: its key is another one; "
            "check --key-file"
        )

    def listen(self, seconds: float = 1.0) -> None:
        """Wait for the rig's heartbeat, sending nothing. NotConnectedError when none comes."""
        if not self.wait(self.is_alive, seconds):
            raise NotConnectedError(
                f"no rig answers on this bus within {seconds:g} s; "
                "is it switched on, and are interface, channel and bit rate right?"
            )

    def release(self) -> None:
        """Stop the heartbeat: the rig levels, and gives control back after its time-out."""
        self._next_heartbeat = None

    def send(self, name: str, signals: Mapping[str, Value] | None = None) -> can.Message:
        """Send one command frame; what was sent."""
        frame = self.sender.frame(name, signals)
        self.transmit(frame)
        return frame

    def transmit(self, frame: can.Message) -> None:
        """Put a command frame on the bus, its authenticator before it where there is a key.

        BusError when the bus takes none.
        """
        if self.sender.key is not None:
            self._put(self.sender.authenticator(frame))
        self._put(frame)

    def _put(self, frame: can.Message) -> None:
        try:
            self.bus.send(frame)
        except can.CanError as problem:
            raise BusError(
                f"the bus takes no frame ({problem}); check cable, termination and bit rate"
            ) from None
        if self.listener is not None:
            frame.timestamp = time.time() if self.clock is time.monotonic else self.clock()
            self.listener(frame)

    def request_mode(
        self, mode: str, seconds: float = 0.5, law: str = "unchanged", acknowledge: bool = False
    ) -> None:
        """Ask for a mode until the rig is in it. RefusedError with the rig's reason."""
        self.take_events()
        end = self.clock() + seconds
        request: dict[str, Value] = {
            "mode_request": mode,
            "control_law_request": law,
            "acknowledge": "yes" if acknowledge else "no",
        }
        while self.clock() < end:
            self.send("ModeRequest", request)
            answer = self.clock() + ANSWER
            self.wait(lambda: self._mode_answered(mode), ANSWER)
            if self.value("Status", "mode") == mode:
                return
            for event in self.take_events():
                if event.signals["event"] == "mode_refused":
                    reason = REASONS.get(int(event.signals["event_detail"]), "for a reason unknown")
                    raise RefusedError(f"the rig refuses the mode {mode}: {reason}")
            self.poll(answer)
        raise NotConnectedError(f"the rig did not answer the request for the mode {mode}")

    def _mode_answered(self, mode: str) -> bool:
        refused = any(event.signals["event"] == "mode_refused" for event in self.events)
        return refused or self.value("Status", "mode") == mode

    def _in_control(self) -> int:
        return int(self.value("ControllerHeartbeat", "session_in_control") or 0)

    def _signals(self, name: str) -> Mapping[str, Value]:
        reading = self.latest(name)
        assert reading is not None, f"{name} was waited for"
        return reading.signals

    def _send_heartbeat(self, now: float) -> None:
        content = {"params_hash": _core.firmware_hash(), "protocol_version": PROTOCOL_VERSION}
        self.send("HostHeartbeat", content)
        self._next_heartbeat = now + period("HostHeartbeat")

    def __enter__(self) -> RigLink:
        """The link itself; `connect` is for the caller to call."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        problem: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the rig without a master."""
        self.release()


#: `event_detail` of a refused mode, docs/protocol.md
REASONS = {
    7: "no set-point came in the last 100 ms",
    8: "a fault is present",
    9: "the enable switch is open",
    10: "it cannot be reached from the mode that it is in",
    11: "another desk is in control",
}
