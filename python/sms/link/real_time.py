"""A virtual rig on a bus: in real time, or in lock-step with the desk in simulated time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import can

from sms.link.faulty_bus import FaultyBus
from sms.link.virtual_rig import PERIOD, VirtualRig

MOST_AT_ONCE = 50  #: periods made up for in one go; what is later than that is given up, and said
REPORT = 1.0  #: s


class RealTime:
    """How well a rig kept real time."""

    def __init__(self) -> None:
        """Nothing ran yet."""
        self.skipped = 0.0  #: s of real time that the rig did not live through
        self.running = True


def run(
    machine: VirtualRig,
    bus: can.BusABC,
    seconds: float | None = None,
    report: Callable[[str], None] = lambda _words: None,
    state: RealTime | None = None,
) -> None:
    """Step a rig once a control period until `seconds` are over or `state.running` is false."""
    state = state or RealTime()
    if machine.has_frame_faults:
        bus = FaultyBus(bus, time.monotonic, machine.seed, machine.frame_faults)
    begin = time.monotonic()
    due, told = begin, begin
    while state.running and (seconds is None or due - begin < seconds):
        now = time.monotonic()
        while now < due:
            if (frame := bus.recv(due - now)) is not None:
                machine.receive(frame)
            now = time.monotonic()
        behind = int((now - due) / PERIOD)
        if behind > MOST_AT_ONCE:
            state.skipped += behind * PERIOD
            due += behind * PERIOD
            behind = 0
        due += (behind + 1) * PERIOD
        while (frame := bus.recv(0.0)) is not None:
            machine.receive(frame)
        for sent in machine.step(behind + 1):
            _send(bus, sent)
        if now - told > REPORT:
            told = now
            late = f"; {state.skipped:.1f} s behind real time" if state.skipped else ""
            report(f"{machine.summary()}{late}; Ctrl-C stops it")


def _send(bus: can.BusABC, frame: can.Message) -> None:
    try:
        bus.send(frame)
    except can.CanError:
        return  # the bus is off or full: a controller's frames are lost then, too


@contextmanager
def running(machine: VirtualRig, bus: can.BusABC) -> Iterator[RealTime]:
    """The rig runs in a thread of its own as long as the context lasts."""
    state = RealTime()
    thread = threading.Thread(target=run, args=(machine, bus), kwargs={"state": state}, daemon=True)
    thread.start()
    try:
        yield state
    finally:
        state.running = False
        thread.join()


class SimulatedWorld:
    """A rig on a bus in simulated time, which runs whenever a desk waits."""

    def __init__(self, machine: VirtualRig, bus: can.BusABC) -> None:
        """`bus` is the rig's end of it."""
        self.machine = machine
        self.bus = bus

    def clock(self) -> float:
        """The time of everything in it, s."""
        return self.machine.time

    def step(self) -> None:
        """One control period."""
        while (frame := self.bus.recv(0.0)) is not None:
            self.machine.receive(frame)
        for sent in self.machine.step():
            _send(self.bus, sent)

    def run(self, seconds: float) -> None:
        """Let time pass without any desk."""
        end = self.clock() + seconds - 0.5 * PERIOD
        while self.clock() < end:
            self.step()


class SimulatedBus(can.BusABC):
    """A desk's end of a bus in a simulated world: waiting for a frame is what makes its time pass."""

    def __init__(self, inner: can.BusABC, world: SimulatedWorld) -> None:
        """`inner` is closed with it."""
        super().__init__(channel=inner.channel_info)
        self.inner = inner
        self.world = world
        self.channel_info = f"simulated {inner.channel_info}"

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send without letting time pass."""
        self.inner.send(msg, timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """The next frame, or None after so much simulated time (python-can's own would wait for real time)."""
        end = None if timeout is None else self.world.clock() + timeout
        while (frame := self.inner.recv(0.0)) is None:
            if end is not None and self.world.clock() >= end:
                return None
            self.world.step()
        frame.timestamp = self.world.clock()
        return frame

    def shutdown(self) -> None:
        """Close the wrapped bus too."""
        super().shutdown()
        self.inner.shutdown()
