"""A day of traffic in minutes, without a growing process: `python -m validation.link.traffic --hours 24`.

A minute of a driven virtual rig is recorded in simulated time: all frames of rig and desk, as often as they are on the
bus. Its log is played again and again, as fast as it goes, to a desk that listens as `sms can monitor --log` does: it
hears every frame, decodes every message five times a second of traffic, and draws its table five times a second of the
computer. Printed: how much faster than real time that is, and the resident memory
of the process every twentieth of the way.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil
from pathlib import Path

import numpy as np
import psutil
from rich.console import Console
from sms.io.can_files import LogWriter
from sms.link.bus import BusAddress, open_bus
from sms.link.codec import CONTROLLER, sent_by
from sms.link.drive import drive
from sms.link.monitor import REFRESH, picture
from sms.link.motion import PlatformMotion
from sms.link.real_time import SimulatedBus, SimulatedWorld
from sms.link.replay import LogBus
from sms.link.rig_link import RigLink
from sms.link.virtual_rig import VirtualRig

MINUTE = 60.0
PARTS = 20  #: after each the memory is read
GROWTH_GOAL = 8.0  #: MiB; what the interpreter's own pools may still take


@dataclass
class Traffic:
    """What was replayed and what it took."""

    frames: int = 0
    hours: float = 0.0  #: of traffic
    elapsed: float = 0.0  #: s
    memory: list[tuple[float, float]] = field(default_factory=list)
    """Hours of traffic, resident MiB; after each part."""

    @property
    def speed(self) -> float:
        """Times real time."""
        return 3600.0 * self.hours / self.elapsed

    @property
    def growth(self) -> float:
        """From the first part's end to the largest after it, MiB."""
        resident = [mebibytes for _, mebibytes in self.memory]
        return max(resident) - resident[0]

    def __str__(self) -> str:
        """One line for a person."""
        return (
            f"{self.hours:g} h of traffic, {self.frames} frames, in {self.elapsed:.0f} s: {self.speed:.0f} times real "
            f"time; resident {self.memory[0][1]:.1f} MiB after a twentieth of it, {self.memory[-1][1]:.1f} MiB at the "
            f"end, {self.growth:.1f} MiB more at most"
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


def listen_to(link: RigLink, screen: Console, drawn: float) -> float:
    """What a desk that watches does besides hearing frames; when the table was drawn last, s."""
    for message in sent_by(CONTROLLER).values():
        link.latest(message.name)
    events = link.take_events()
    if time.monotonic() - drawn < REFRESH:
        return drawn
    screen.file.seek(0)
    screen.print(picture(link, {}, events))
    return time.monotonic()


def replay_hours(
    hours: float, report: Callable[[float, float], None] = lambda _hours, _mebibytes: None
) -> Traffic:
    """Replay so much traffic; measure time and memory, and report it after each part."""
    done = Traffic()
    process = psutil.Process()
    heard = 0.0
    with (
        tempfile.TemporaryDirectory() as folder,
        (Path(folder) / "screen.txt").open("w") as screen,
    ):
        log = Path(folder) / "minute.blf"
        length = record_minute(log)
        console = Console(file=screen, width=120)
        rounds = PARTS * ceil(3600.0 * hours / length / PARTS)
        begin, drawn = time.monotonic(), 0.0
        link = RigLink(LogBus(log, speed=0.0), lambda: heard, 3)
        for number in range(1, rounds + 1):
            with LogBus(log, speed=0.0) as link.bus:
                looked = 0.0
                while (frame := link.poll()) is not None:
                    heard = (number - 1) * length + frame.timestamp
                    done.frames += 1
                    if frame.timestamp >= looked:
                        looked += REFRESH
                        drawn = listen_to(link, console, drawn)
            if number % (rounds // PARTS) == 0:
                done.hours = number * length / 3600.0
                done.memory.append((done.hours, process.memory_info().rss / 2**20))
                report(*done.memory[-1])
        done.elapsed = time.monotonic() - begin
    return done


def main(arguments: Sequence[str] | None = None) -> None:
    """Replay and print; exit 1 when it is slower than real time or the process grows."""
    parser = argparse.ArgumentParser(prog="python -m validation.link.traffic", description=__doc__)
    parser.add_argument("--hours", type=float, default=1.0, help="of traffic")
    options = parser.parse_args(arguments)
    traffic = replay_hours(
        options.hours,
        lambda hours, mebibytes: print(f"{hours:6.2f} h: {mebibytes:.1f} MiB", flush=True),
    )
    print(traffic)
    raise SystemExit(traffic.speed < 1.0 or traffic.growth > GROWTH_GOAL)


if __name__ == "__main__":
    main()
