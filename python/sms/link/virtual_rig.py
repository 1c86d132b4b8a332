"""The virtual rig: the controller's own program over a simulated platform, with effects and faults to switch on.

The machine is in libsms/firmware/virtual_rig.hpp; here are the names a person types, the plan of what goes wrong when,
and the frames as python-can has them. Time is the rig's: whoever steps it decides how fast it runs.
"""

from __future__ import annotations

import re
import secrets
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import can

from sms import Params, _core
from sms.errors import InputError, did_you_mean
from sms.io.declarations import check_bounds
from sms.io.units import to_si
from sms.link.codec import HOST, sent_by
from sms.link.faulty_bus import FrameFaults
from sms.parameters import PARAMETERS
from sms.simulation import MEAN_PRESSURE

PERIOD = 1e-3  #: s; of the controller
MOST_PERIODS = 60_000
"""Of one call of the core."""
LEGS = 3
START_HEIGHT = 0.32  #: m; a little above the lower end of the stroke
STEP = 2.5e-4  #: s; of the integrator
POSITION_NOISE, PRESSURE_NOISE = 0.4, 1.0  #: counts of the converters, standard deviation
JUMP = 0.02  #: m; of a sensor that jumps, unless said
SUPPLY_TIME = 0.3  #: s; with which a lost supply falls, unless said

#: What can be made to go wrong, and what its argument is.
FAULTS: Mapping[str, str] = MappingProxyType(
    {
        "sensor_broken": "LEG: the position sensor's wire is broken",
        "sensor_stuck": "LEG: the position sensor keeps its reading",
        "sensor_jump": "LEG[:METRES]: the position sensor reads so much more",
        "valve_stuck": "LEG: the spool stays where it is",
        "supply_lost": "[SECONDS]: the supply falls to ambient with this time constant",
        "enable_open": "the enable switch is opened",
        "bus_off": "the controller is off the bus",
        "loop_overrun": "every tick of the controller comes a period late",
        "hang": "the controller's program stands still until the watchdog resets it",
        "frames_lost": "SHARE, 0 to 1: frames get lost, in both directions",
        "frames_corrupted": "SHARE: one to three bits of a frame are turned",
        "frames_duplicated": "SHARE: frames come twice",
        "frames_reordered": "SHARE: frames come after later ones",
        "frames_delayed": "SHARE: frames come up to 250 ms late",
        "frames_replayed": "SHARE: an old frame comes as well",
    }
)
_OF_LEG = ("sensor_broken", "sensor_stuck", "sensor_jump", "valve_stuck")
_DEFAULT_AMOUNT = {"sensor_jump": JUMP, "supply_lost": SUPPLY_TIME}


@dataclass(frozen=True)
class PlannedFault:
    """One fault, when it begins and when it ends, s of the rig's time."""

    name: str
    begin: float
    end: float | None = None
    leg: int = 0  #: from 0
    amount: float = 0.0  #: m, s or a share, by the fault


class VirtualRig:
    """A rig that exists in this process alone. Not thread-safe: one thread steps it and hands it frames."""

    def __init__(
        self,
        effects: Sequence[str] = (),
        faults: Iterable[str | PlannedFault] = (),
        seed: int = 1,
        height: float = START_HEIGHT,
        noisy: bool = True,
        key: bytes | None = None,
    ) -> None:
        """At rest, level, disabled. `effects` are of the plant: "valve_leakage=2e-10", of one leg
        "valve_leakage:2=2e-10", with units "tube_length=2 m". With a `key` it obeys authentic commands only.
        InputError for what cannot be."""
        params = [Params() for _ in range(LEGS)]
        for effect in effects:
            _apply_effect(params, effect)
        self.seed = seed
        self.frame_faults = FrameFaults()
        self.frames_in = self.frames_out = self.frames_dropped = 0
        self._plan = [f if isinstance(f, PlannedFault) else parse_fault(f) for f in faults]
        self._due = sorted(
            [(f.begin, True, f) for f in self._plan]
            + [(f.end, False, f) for f in self._plan if f.end is not None],
            key=lambda change: change[0],
        )
        self._commands = sent_by(HOST)
        self._core = _core.VirtualRig(
            params=params,
            height=height,
            mean_pressure=MEAN_PRESSURE,
            step=STEP,
            position_noise=POSITION_NOISE if noisy else 0.0,
            pressure_noise=PRESSURE_NOISE if noisy else 0.0,
            seed=seed,
            key=key or b"",
            nonce=secrets.randbits(64),
        )

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._core.time

    @property
    def truth(self) -> _core.VirtualRig:
        """What no sensor says: pose, extension, pressures of the plant."""
        return self._core

    @property
    def has_frame_faults(self) -> bool:
        """Whether its bus has to be a faulty one."""
        return any(fault.name.startswith("frames_") for fault in self._plan)

    def receive(self, frame: can.Message) -> None:
        """Hand it a frame of the bus; only commands reach the controller."""
        if frame.arbitration_id in self._commands and not frame.is_error_frame:
            self.frames_in += 1
            if not self._core.receive(frame.arbitration_id, bytes(frame.data)):
                self.frames_dropped += 1

    def step(self, periods: int = 1) -> list[can.Message]:
        """Run so many control periods; the frames that the controller sent, stamped with the rig's time."""
        frames = []
        end = self.time + periods * PERIOD
        left = periods
        while left > 0:
            self._switch()
            count = min(left, MOST_PERIODS)
            if self._due and self._due[0][0] < end:
                until_due = round((self._due[0][0] - self.time) / PERIOD)
                count = min(count, max(1, until_due))
            frames += self._core.step(count)
            left -= count
        self.frames_out += len(frames)
        return [
            can.Message(timestamp=time, arbitration_id=number, data=data, is_extended_id=False)
            for time, number, data in frames
        ]

    def set_fault(self, fault: PlannedFault, on: bool = True) -> None:
        """Switch one on or off now."""
        if fault.name.startswith("frames_"):
            self.frame_faults.set(fault.name.removeprefix("frames_"), fault.amount if on else 0.0)
        elif on:
            self._core.set_fault(fault.name, fault.leg, fault.amount)
        else:
            self._core.clear_fault(fault.name)

    def summary(self) -> str:
        """What it did, for a person."""
        dropped = f", {self.frames_dropped} lost in its mailboxes" if self.frames_dropped else ""
        return (
            f"{self.time:.1f} s of the rig; frames: {self.frames_in} commands received{dropped}, "
            f"{self.frames_out} sent"
        )

    def _switch(self) -> None:
        while self._due and self._due[0][0] <= self.time + 0.5 * PERIOD:
            _, on, fault = self._due.pop(0)
            self.set_fault(fault, on)


def _apply_effect(params: Sequence[Params], text: str) -> None:
    name, equals, value = (part.strip() for part in text.partition("="))
    name, _, leg = name.partition(":")
    where = f"--effect {text}"
    if not equals:
        raise InputError(f"{where}: write NAME=VALUE, for instance valve_leakage=2e-10")
    if name not in PARAMETERS:
        raise InputError(
            f"{where}: {did_you_mean(name, PARAMETERS, 'docs/parameters.md lists all')}"
        )
    parameter = PARAMETERS[name]
    try:
        number = float(value)
    except ValueError:
        number = to_si(value, parameter.unit, where)
    check_bounds(parameter, number, where)
    for one in params if not leg else [params[_leg(leg, where)]]:
        one[name] = number


def parse_fault(text: str) -> PlannedFault:
    """A fault as typed: "sensor_stuck:2@5s", "frames_lost:0.3@5s..65s". InputError."""
    where = f"--fault {text}"
    match = re.fullmatch(r"(\w+)((?::[^:@]+)*)@([\d.]+)\s*s?(?:\.\.([\d.]+)\s*s?)?", text.strip())
    if match is None:
        raise InputError(f"{where}: write NAME[:ARGUMENT]@TIME, for instance sensor_stuck:2@5s")
    name, arguments = match[1], match[2].split(":")[1:]
    if name not in FAULTS:
        raise InputError(f"{where}: {did_you_mean(name, FAULTS)}")
    begin = _number(match[3], where)
    end = None if match[4] is None else _number(match[4], where)
    if end is not None and end <= begin:
        raise InputError(f"{where}: it ends before it begins; write FIRST..LAST")
    leg = 0
    if name in _OF_LEG:
        if not arguments:
            raise InputError(f"{where}: which leg? write {name}:1, {name}:2 or {name}:3")
        leg = _leg(arguments.pop(0), where)
    amount = _DEFAULT_AMOUNT.get(name, 0.0)
    if arguments and (name in _DEFAULT_AMOUNT or name.startswith("frames_")):
        amount = _number(arguments.pop(0), where)
    if arguments or (name.startswith("frames_") and amount == 0.0):
        raise InputError(f"{where}: {name} takes {FAULTS[name].partition(':')[0]}")
    if name.startswith("frames_"):
        FrameFaults().set(name.removeprefix("frames_"), amount)
    return PlannedFault(name, begin, end, leg, amount)


def _leg(text: str, where: str) -> int:
    if text not in ("1", "2", "3"):
        raise InputError(f"{where}: '{text}' is no leg; the legs are 1, 2 and 3")
    return int(text) - 1


def _number(text: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{where}: '{text}' is not a number") from None
