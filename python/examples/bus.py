"""A desk drives the virtual rig over a CAN bus: take control, stream a roll, read what the controller reports.

The rig is the firmware's own application around a simulated platform, and the bus is python-can's virtual one; with
`socketcan` and `can0` in its place the same desk drives a real rig. Time is simulated here: nothing waits.
"""

import argparse

import numpy as np
from sms.link.bus import BusAddress, open_bus
from sms.link.drive import drive
from sms.link.motion import PlatformMotion
from sms.link.real_time import SimulatedBus, SimulatedWorld
from sms.link.rig_link import RigLink
from sms.link.virtual_rig import VirtualRig

parser = argparse.ArgumentParser(description="A desk, a CAN bus, a virtual rig.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
picture = parser.parse_args().picture

time = np.arange(0.0, 16.0, 0.05)
roll = np.radians(2.0) * np.sin(2.0 * np.pi * 0.2 * time) * np.minimum(time / 2.0, 1.0)
motion = PlatformMotion(time, roll, np.zeros_like(time), np.full_like(time, 0.5))

address = BusAddress("virtual", "example")
with open_bus(address) as far:
    world = SimulatedWorld(VirtualRig(height=0.5), far)
    with (
        SimulatedBus(open_bus(address), world) as bus,
        RigLink(bus, world.clock, session=4) as link,
    ):
        link.connect()
        stream = drive(link, motion)
        link.release()
for line in stream.summary().splitlines():
    print(line)
print(world.machine.summary())

if picture:
    import matplotlib.pyplot as plt

    sent = stream.sent - stream.sent[0]
    figure, axes = plt.subplots(figsize=(8, 3.4), layout="constrained")
    axes.plot(sent, np.degrees(stream.pose[:, 0]), "k--", label="set-point sent")
    axes.plot(sent, np.degrees(stream.followed[:, 0]), label="telemetry of the rig")
    axes.set(xlabel="time [s]", ylabel="roll [deg]")
    axes.legend()
    figure.savefig(picture)
