"""An alarm as a CAN frame: alarm.dbc says what is in it, so that a controller or a logger can read it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib.resources import as_file, files
from typing import Any

import can
from cantools.database.can import Database

from sms.errors import InputError
from sms.io.can_frames import load_dbc
from sms.link.bus import BusAddress, open_bus

LARGEST = 0x7FF
"""Of the identifiers of classic CAN; more is an extended one, to 0x1FFFFFFF."""
EXTENDED = 0x1FFFFFFF
OWN = "of_its_user"
"""An effect of a file that the rig file names: alarm.dbc knows those of the catalogue."""


class AlarmFrame:
    """Sends one frame at each alarm, diagnosis and end of an alarm; a listener of `Watch`."""

    def __init__(self, address: BusAddress, identifier: int, bus: Database) -> None:
        """InputError for an identifier that CAN has not or a frame of the bus has, and a bus that cannot be opened."""
        self.identifier = checked(identifier, bus)
        with as_file(files("sms.watch").joinpath("alarm.dbc")) as path:
            self._message = load_dbc(path).get_message_by_name("WatchAlarm")
        self._choices = {
            s.name: {str(name) for name in s.choices.values()}
            for s in self._message.signals
            if s.choices
        }
        self._onsets: dict[int, float] = {}
        self._bus = open_bus(address)

    def __call__(self, event: str, content: Mapping[str, Any], line: str) -> str | None:
        """Send one event; why it was not sent, in a sentence. Of those that are no alarms nothing is sent."""
        if event not in self._choices["watch_event"]:
            return None
        frame = can.Message(
            arbitration_id=self.identifier,
            is_extended_id=self.identifier > LARGEST,
            data=self._message.encode(self.signals(event, content)),
        )
        try:
            self._bus.send(frame, timeout=0.1)
        except (can.CanError, OSError) as problem:
            return f"--alarm-frame: it was not sent ({problem})"
        return None

    def signals(self, event: str, content: Mapping[str, Any]) -> dict[str, float | str]:
        """What the frame says of an event; ages and evidence beyond its range are its largest."""
        number = int(content["alarm"])
        if event == "alarm":
            self._onsets[number] = float(content["since_s"])
        now = float(content.get("raised_s", content.get("time_s", 0.0)))
        age = now - self._onsets.get(number, now)
        named = [g["effect"] for g in content.get("guesses", [])] or list(content.get("causes", []))
        effect, leg = self._effect(named[0]) if named else ("none", 0)
        return {
            "watch_event": event,
            "watch_verdict": content.get("verdict", "none"),
            "alarm_number": number % 256,
            "alarm_age": min(max(age, 0.0), 6553.5),
            "fitting_effect": effect,
            "fitting_leg": leg,
            "evidence": min(content["z"] / content["threshold"], 655.35) if "z" in content else 0.0,
        }

    def _effect(self, key: str) -> tuple[str, int]:
        """An effect's id, and its leg, of a key: "fitting_leakage of lower, leg 2"."""
        name = key.partition(" of ")[0]
        leg = re.search(r"\bleg (\d)", key)
        return name if name in self._choices["fitting_effect"] else OWN, int(leg[1]) if leg else 0

    def close(self) -> None:
        """Leave the bus."""
        self._bus.shutdown()


def checked(identifier: int, bus: Database) -> int:
    """An identifier of classic CAN that no other frame of this bus has: what it says is not to be taken for a command.

    InputError else.
    """
    if not 0 <= identifier <= EXTENDED:
        raise InputError(
            f"--alarm-frame 0x{identifier:X}: write 0 to 0x{LARGEST:X}, or an extended identifier to 0x{EXTENDED:X}"
            if identifier >= 0
            else f"--alarm-frame {identifier}: an identifier is not negative"
        )
    taken = {message.frame_id: message.name for message in bus.messages}
    if identifier in taken:
        raise InputError(
            f"--alarm-frame 0x{identifier:X}: this is {taken[identifier]} on this bus; choose one that is free"
        )
    return identifier
