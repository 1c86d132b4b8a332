"""A day of traffic in less than a day, without a growing process: `python -m validation.link_traffic --hours 24`.

A minute of a driven virtual rig is recorded in simulated time, all frames of rig and desk. Its log is replayed onto
a bus again and again, as fast as the bus takes it, while a desk listens, decodes every message ten times a second of
traffic, and draws the monitor's table once a second of it. Printed: how much faster than real time that is, and the
resident memory of the process after a twentieth of the traffic and at its end.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil
from rich.console import Console
from sms.link.bus import BusAddress, open_bus
from sms.link.codec import CONTROLLER, sent_by
from sms.link.drive import drive
from sms.link.logs import LogWriter, read_frames
from sms.link.monitor import picture
from sms.link.motion import PlatformMotion
from sms.link.real_time import SimulatedBus, SimulatedWorld
from sms.link.rig_link import RigLink
from sms.link.virtual_rig import VirtualRig

MINUTE = 60.0
DECODED, DRAWN = 0.1, 1.0  #: s of traffic
GROWTH_GOAL = 8.0  #: MiB; what the interpreter's own pools may still take


@dataclass(frozen=True)
class Traffic:
    """What was replayed and what it took."""

    frames: int
    hours: float  #: of traffic
    elapsed: float  #: s
    early: float  #: MiB; resident after a twentieth
    late: float  #: MiB; at the end

    @property
    def speed(self) -> float:
        """Times real time."""
        return 3600.0 * self.hours / self.elapsed

    @property
    def growth(self) -> float:
        """MiB"""
        return self.late - self.early

    def __str__(self) -> str:
        """One line for a person."""
        return (
            f"{self.hours:g} h of traffic, {self.frames} frames, in {self.elapsed:.0f} s: {self.speed:.0f} times real "
            f"time; resident {self.early:.1f} MiB after a twentieth of it, {self.late:.1f} MiB at the end"
        )


def record_minute(log: Path) -> float:
    """A driven minute, all frames, at least; its length, s."""
    rig = VirtualRig(height=0.5)
    address = BusAddress("virtual", "traffic-source")
    with open_bus(address) as far, LogWriter(log) as writer:
        world = SimulatedWorld(rig, far)
        with (
            SimulatedBus(open_bus(address), world) as bus,
            RigLink(bus, world.clock, 3) as link,
            open_bus(address) as ear,
        ):
            link.connect()
            time_ = np.arange(0.0, MINUTE, 0.05)
            roll = 0.04 * np.sin(2.0 * np.pi * 0.2 * time_)
            level = np.full(time_.size, 0.5)
            drive(link, PlatformMotion(time_, roll, 0.0 * roll, level + 0.3 * roll))
            frames = list(iter(lambda: ear.recv(0.0), None))
        begin = frames[0].timestamp
        length = world.clock()
        scale = length / max(
            frames[-1].timestamp - begin, 1e-9
        )  # the bus stamps with the computer's time
        for frame in frames:
            frame.timestamp = scale * (frame.timestamp - begin)
            writer.write(frame)
    return length


def replay_hours(hours: float) -> Traffic:
    """Replay so much traffic; measure time and memory."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "minute.blf"
        length = record_minute(log)
        console = Console(file=(Path(folder) / "screen.txt").open("w"), width=120)
        process = psutil.Process()
        telemetry = sent_by(CONTROLLER)
        rounds = max(20, round(3600.0 * hours / length))
        address = BusAddress("virtual", "traffic")
        now, frames, early = 0.0, 0, 0.0
        with (
            open_bus(address) as source,
            open_bus(address) as bus,
            RigLink(bus, lambda: now, 3) as link,
        ):
            begin = time.monotonic()
            for number in range(rounds):
                decoded = drawn = 0.0
                for frame in read_frames(log):
                    now = number * length + frame.timestamp
                    source.send(frame)
                    link.poll()
                    frames += 1
                    if frame.timestamp >= decoded:
                        decoded += DECODED
                        for message in telemetry.values():
                            link.latest(message.name)
                    if frame.timestamp >= drawn:
                        drawn += DRAWN
                        console.file.seek(0)
                        console.print(picture(link, {}, link.take_events()))
                if number + 1 == rounds // 20:
                    early = process.memory_info().rss / 2**20
            elapsed = time.monotonic() - begin
        late = process.memory_info().rss / 2**20
        console.file.close()
    return Traffic(frames, rounds * length / 3600.0, elapsed, early, late)


def main(arguments: Sequence[str] | None = None) -> None:
    """Replay and print; exit 1 when it is slower than real time or the process grows."""
    parser = argparse.ArgumentParser(prog="python -m validation.link_traffic", description=__doc__)
    parser.add_argument("--hours", type=float, default=1.0, help="of traffic")
    options = parser.parse_args(arguments)
    traffic = replay_hours(options.hours)
    print(traffic)
    raise SystemExit(traffic.speed < 1.0 or traffic.growth > GROWTH_GOAL)


if __name__ == "__main__":
    main()
