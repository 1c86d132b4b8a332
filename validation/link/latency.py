"""How fast the link is, and what the virtual rig costs: `python -m validation.link.latency`.

Real time, the virtual rig under a desk that streams set-points every 10 ms: once on python-can's virtual bus inside one
process, once as `sms can rig` in a process of its own on a bus over UDP multicast. Printed: from sending a set-point to
receiving the telemetry that answers it, the jitter of the stream, and the share of one core that the rig takes.

Other work on the computer shows in the numbers: run it on a quiet one. The load average is printed beside them.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import psutil
from sms.io.json_files import json_text
from sms.link.bus import BusAddress, open_bus
from sms.link.codec import period
from sms.link.drive import is_answer
from sms.link.real_time import running
from sms.link.rig_link import RigLink
from sms.link.virtual_rig import VirtualRig

CHANNEL = "239.74.163.2:43177"  #: a port of its own, so that a rig which runs on the usual bus is left alone
MEDIAN_GOAL = 2e-3  #: s
CORE_GOAL = 0.2
START = 30.0  #: s; the longest that a rig's process may take to be heard


@dataclass(frozen=True)
class Measured:
    """One run. Times in s."""

    bus: str
    setpoints: int
    unanswered: int
    delay_median: float
    delay_99: float
    jitter_median: float
    jitter_99: float
    core: float  #: share of one core; of the rig's process, or on the virtual bus of rig and desk together
    load: float  #: load average of the computer

    def __str__(self) -> str:
        """One line for a person."""
        return (
            f"{self.bus}: set-point to telemetry median {1e3 * self.delay_median:.2f} ms, 99 % below "
            f"{1e3 * self.delay_99:.2f} ms, {self.unanswered} of {self.setpoints} not answered within 10 ms; "
            f"jitter median {1e3 * self.jitter_median:.3f} ms, 99 % below {1e3 * self.jitter_99:.3f} ms; "
            f"{100.0 * self.core:.1f} % of one core (load average {self.load:.1f})"
        )


def stream(link: RigLink, process: psutil.Process, name: str, seconds: float) -> Measured:
    """Level the platform under a stream of set-points and measure."""
    link.connect(START)
    link.request_mode("levelling")
    interval = period("AttitudeSetpoint")
    level: dict[str, float | int | str] = {
        "roll_setpoint": 0.0,
        "pitch_setpoint": 0.0,
        "height_setpoint": 0.45,
    }
    count = round(seconds / interval)
    sent, delays = np.empty(count), []
    begin, used = link.clock(), sum(process.cpu_times()[:2])
    for i in range(count):
        while link.clock() < begin + i * interval:
            link.poll(begin + i * interval)
        frame = link.send("AttitudeSetpoint", level)
        sent[i] = link.clock()
        if link.wait(lambda frame=frame: is_answer(link, frame), 0.99 * interval):  # type: ignore[misc]
            delays.append(link.clock() - sent[i])
    elapsed = link.clock() - begin
    jitter = np.abs(np.diff(sent) - interval)
    return Measured(
        bus=name,
        setpoints=count,
        unanswered=count - len(delays),
        delay_median=float(np.median(delays)),
        delay_99=float(np.quantile(delays, 0.99)),
        jitter_median=float(np.median(jitter)),
        jitter_99=float(np.quantile(jitter, 0.99)),
        core=(sum(process.cpu_times()[:2]) - used) / elapsed,
        load=os.getloadavg()[0],
    )


def on_virtual_bus(seconds: float) -> Measured:
    """Rig and desk as two threads of this process."""
    address = BusAddress("virtual", "latency")
    rig = VirtualRig()
    with (
        open_bus(address) as far,
        open_bus(address) as near,
        running(rig, far),
        RigLink(near) as link,
    ):
        return stream(link, psutil.Process(), "virtual, one process (rig and desk)", seconds)


def on_multicast(seconds: float) -> Measured:
    """The rig as a process of its own."""
    command = [sys.executable, "-m", "sms.cli", "can", "rig", "--channel", CHANNEL, "--quiet"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        try:
            with open_bus(BusAddress("udp_multicast", CHANNEL)) as bus, RigLink(bus) as link:
                link.listen(START)
                time.sleep(0.5)
                return stream(
                    link, psutil.Process(process.pid), "udp_multicast, rig alone", seconds
                )
        finally:
            process.terminate()


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure both and hold them against the goals."""
    parser = argparse.ArgumentParser(prog="python -m validation.link.latency", description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each stream")
    parser.add_argument("--json", type=Path, help="also write the rows there")
    options = parser.parse_args(arguments)
    rows = [on_virtual_bus(options.seconds), on_multicast(options.seconds)]
    for row in rows:
        print(row)
    print(
        f"goals: median below {1e3 * MEDIAN_GOAL:g} ms on the virtual bus: "
        f"{'kept' if rows[0].delay_median < MEDIAN_GOAL else 'missed'}; the rig at most {CORE_GOAL:.0%} of one core: "
        f"{'kept' if rows[1].core <= CORE_GOAL else 'missed'}"
    )
    if options.json:
        options.json.write_text(json_text("measurements", {"rows": [asdict(row) for row in rows]}))


if __name__ == "__main__":
    main()
