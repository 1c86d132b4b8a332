"""A desk and a virtual rig in simulated time, over python-can's virtual bus."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from sms.link.bus import BusAddress, open_bus
from sms.link.real_time import SimulatedBus, SimulatedWorld
from sms.link.rig_link import RigLink
from sms.link.virtual_rig import VirtualRig

_names = itertools.count()


@contextmanager
def desk_and_rig(
    effects: Sequence[str] = (),
    faults: Sequence[str] = (),
    session: int = 4,
    height: float = 0.5,
    rigs_key: bytes | None = None,
    desks_key: bytes | None = None,
) -> Iterator[tuple[RigLink, SimulatedWorld]]:
    """A link that is not connected yet, and the world that its clock belongs to."""
    address = BusAddress("virtual", f"test-{next(_names)}")
    rig = VirtualRig(effects=effects, faults=faults, height=height, key=rigs_key)
    with open_bus(address) as far:
        world = SimulatedWorld(rig, far)
        with (
            SimulatedBus(open_bus(address), world) as bus,
            RigLink(bus, world.clock, session, desks_key) as link,
        ):
            yield link, world
