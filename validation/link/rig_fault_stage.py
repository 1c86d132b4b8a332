"""The setting of every trial of rig_faults.py: a rig that tracks a motion under a desk, watched every millisecond."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping

import can
import numpy as np
from sms.link.bus import BusAddress, open_bus
from sms.link.codec import message, period
from sms.link.faulty_bus import FaultyBus
from sms.link.monitor import fault_names
from sms.link.real_time import SimulatedBus, SimulatedWorld
from sms.link.rig_link import BusError, LinkError, RigLink
from sms.link.virtual_rig import VirtualRig, parse_fault

LEVEL_HEIGHT = 0.5  #: m
BACK = 8.0  #: s; the longest that a way back may take
_names = itertools.count()
TRACK: dict[str, float | int | str] = {
    "mode_request": "tracking",
    "control_law_request": "unchanged",
    "acknowledge": "no",
}


class WatchedWorld(SimulatedWorld):
    """A simulated world that notes what the controller says and where the pistons are, every millisecond."""

    def __init__(self, machine: VirtualRig, bus: can.BusABC) -> None:
        """Notes from the beginning on."""
        super().__init__(machine, bus)
        self.first_said: dict[str, float] = {}  #: s; since `forget`
        self.modes: list[tuple[float, str]] = []
        self.extension = [np.inf, -np.inf]  #: m; least and most
        self.fastest = 0.0  #: m/s
        self.since = 0.0  #: s; begin of the notes
        self._faults = 0

    def forget(self) -> None:
        """Begin the notes anew, now; what is said already counts as known."""
        self.since = self.clock()
        self.first_said.clear()
        self.modes.clear()
        self._faults = self.machine.truth.faults

    def step(self) -> None:
        """One period, watched."""
        super().step()
        truth = self.machine.truth
        self.extension = [
            min(self.extension[0], *truth.extension),
            max(self.extension[1], *truth.extension),
        ]
        self.fastest = max(self.fastest, *(abs(rate) for rate in truth.extension_rate))
        if new := truth.faults & ~self._faults:
            for name in fault_names(new):
                self.first_said.setdefault(name, self.clock())
        self._faults = truth.faults
        mode = mode_name(truth.mode)
        if not self.modes or self.modes[-1][1] != mode:
            self.modes.append((self.clock(), mode))


def mode_name(mode: int) -> str:
    """The name of a mode of the controller."""
    choices: Mapping[int, object] = message("Status").get_signal_by_name("mode").choices or {}
    return str(choices[mode])


class Stage:
    """A rig that tracks a motion under a desk; the setting of every trial."""

    def __init__(self, seed: int) -> None:
        """Connected, levelled and tracking."""
        self.rig = VirtualRig(seed=seed, height=0.5)
        self.address = BusAddress("virtual", f"rig-faults-{next(_names)}")
        self.random = np.random.default_rng(seed)
        self.buses: list[can.BusABC] = []
        wire = FaultyBus(open_bus(self.address), lambda: self.rig.time, seed, self.rig.frame_faults)
        self.buses.append(wire)
        self.world = WatchedWorld(self.rig, wire)
        self.desk = self.new_desk(session=5)
        self.desk.connect()
        self.desk.request_mode("levelling")
        self.begin = self.world.clock()
        self.stream(0.1)
        self.desk.request_mode("tracking")
        self.stream(1.0 + 0.01 * float(self.random.uniform()))

    def new_desk(self, session: int) -> RigLink:
        """Another desk on the same bus."""
        bus = SimulatedBus(open_bus(self.address), self.world)
        self.buses.append(bus)
        return RigLink(bus, self.world.clock, session)

    def pose(self) -> tuple[float, float, float]:
        """Where the platform shall be now: roll, pitch, rad; height, m."""
        t = self.world.clock() - self.begin
        return (
            0.04 * float(np.sin(2.0 * np.pi * 0.3 * t)),
            0.03 * float(np.sin(2.0 * np.pi * 0.2 * t)),
            LEVEL_HEIGHT + 0.03 * float(np.sin(2.0 * np.pi * 0.25 * t)),
        )

    def stream(self, seconds: float, each: Callable[[], None] | None = None) -> None:
        """Send set-points for a while, one every 10 ms; a desk that wants to track asks again when it is not."""
        end = self.world.clock() + seconds
        asked = self.world.clock()
        while self.world.clock() < end:
            roll, pitch, height = self.pose()
            try:
                self.desk.send(
                    "AttitudeSetpoint",
                    {"roll_setpoint": roll, "pitch_setpoint": pitch, "height_setpoint": height},
                )
                if (
                    self.world.clock() - asked > 0.5
                    and self.desk.value("Status", "mode") == "levelling"
                ):
                    asked = self.world.clock()
                    self.desk.send("ModeRequest", TRACK)
            except BusError:
                pass  # the bus is off: a desk goes on trying
            if each is not None:
                each()
            self.desk.wait(lambda: False, period("AttitudeSetpoint"))

    def fault(self, text: str) -> None:
        """Switch one of the rig's faults on now."""
        self.rig.set_fault(parse_fault(f"{text}@0s"))

    def clear(self, text: str) -> None:
        """Switch it off."""
        self.rig.set_fault(parse_fault(f"{text}@0s"), on=False)

    def come_back(self) -> bool:
        """What a person does: acknowledge, level, track. Whether that leads to tracking."""
        end = self.world.clock() + BACK
        while self.world.clock() < end:
            try:
                if self.rig.truth.session != self.desk.sender.session:
                    self.desk.connect()
                if self.desk.value("Status", "mode") != "tracking":
                    self.desk.request_mode("disabled", acknowledge=True)
                    self.desk.request_mode("levelling")
                self.stream(0.7)
            except LinkError:
                self.stream(0.2)
            if mode_name(self.rig.truth.mode) == "tracking":
                return True
        return False

    def close(self) -> None:
        """Close all ends of the bus."""
        for bus in self.buses:
            bus.shutdown()
