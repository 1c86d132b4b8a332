"""Opening buses, replaying logs, and a bus that loses, turns and delays frames."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import can
import pytest
from sms.io import InputError
from sms.io.can_files import LogWriter
from sms.link.bus import BusAddress, open_bus
from sms.link.faulty_bus import DELAY, REORDER, FaultyBus, FrameFaults
from sms.link.replay import LogBus, replay

from validation.random_cases import draw


@pytest.mark.parametrize(("address", "said"), [
    (BusAddress("socketcn"), "did you mean 'socketcan'"),
    (BusAddress("kvaser"), "needs a channel"),
    (BusAddress("pcan"), "install the driver of PEAK"),
    (BusAddress("udp_multicast", "127.0.0.1"), "multicast group"),
    (BusAddress("slcan", "/dev/there_is_no_such_port"), "pip install pyserial"),
])  # fmt: skip
def test_a_bus_that_cannot_be_opened_is_one_sentence(address: BusAddress, said: str) -> None:
    with pytest.raises(InputError) as caught:
        open_bus(address)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_buses_over_udp_are_parted_by_their_port() -> None:
    pytest.importorskip("msgpack", reason="the bus over UDP needs the extra sms[can]")
    first, second = (BusAddress("udp_multicast", f"239.74.163.2:{port}") for port in (43301, 43302))
    with open_bus(first) as bus, open_bus(first) as ear, open_bus(second) as other:
        bus.send(data_frame(7))
        heard = ear.recv(2.0)
        assert heard is not None
        assert heard.data[0] == 7
        assert other.recv(0.05) is None


def data_frame(number: int, identifier: int = 0x115, timestamp: float = 0.0) -> can.Message:
    return can.Message(
        arbitration_id=identifier,
        is_extended_id=False,
        data=number.to_bytes(8, "little"),
        timestamp=timestamp,
    )


def test_a_log_is_a_bus_to_listen_to(tmp_path: Path) -> None:
    log = tmp_path / "run.blf"
    with LogWriter(log) as writer:
        for i in range(5):
            writer.write(data_frame(i, timestamp=3.0 + 100.0 * i))
    with LogBus(log, speed=0.0) as bus:
        heard = [bus.recv(0.0) for _ in range(6)]
        assert [frame.data[0] for frame in heard[:5] if frame] == [0, 1, 2, 3, 4]
        assert heard[5] is None
        assert bus.is_over
    with LogBus(log, speed=1.0) as bus:
        assert bus.recv(0.0) is not None
        assert bus.recv(0.001) is None  # the next one comes after 100 s
        assert not bus.is_over
    with pytest.raises(InputError, match="time does not run backwards"):
        LogBus(log, speed=-1.0)
    with pytest.raises(InputError, match="there is no such log"):
        LogBus(tmp_path / "none.blf")


def test_a_log_is_replayed_without_commands(tmp_path: Path) -> None:
    log = tmp_path / "run.blf"
    with LogWriter(log) as writer:
        for i in range(50):
            writer.write(data_frame(i, 0xA0 if i % 5 == 0 else 0x115, 10.0 + 0.002 * i))
    with (
        open_bus(BusAddress("virtual", "replay")) as bus,
        open_bus(BusAddress("virtual", "replay")) as ear,
    ):
        done = replay(log, bus, speed=0.0)
        heard = [frame.arbitration_id for frame in iter(lambda: ear.recv(0.0), None)]
        assert heard == [0x115] * 40
        assert (done.frames, round(done.duration, 3)) == (40, 0.096)
        all_frames = replay(log, bus, speed=1.0, commands=True)
        assert all_frames.frames == 50
        assert all_frames.elapsed >= 0.098
        with pytest.raises(InputError, match="backwards"):
            replay(log, bus, speed=-1.0)


class Wire:
    """Two ends of a virtual bus, the first one faulty, under a clock that the test moves."""

    def __init__(self, faults: FrameFaults, seed: int, name: str) -> None:
        self.now = 0.0
        self.far = open_bus(BusAddress("virtual", name))
        self.near = FaultyBus(open_bus(BusAddress("virtual", name)), lambda: self.now, seed, faults)

    def send(self, frames: int) -> None:
        for i in range(frames):
            self.now = 0.01 * i
            self.near.send(data_frame(i))
            self.near.recv(0.0)
        self.now += 1.0
        self.near.recv(0.0)

    def heard(self) -> list[int]:
        got = iter(lambda: self.far.recv(0.0), None)
        return [int.from_bytes(frame.data, "little") for frame in got]

    def __enter__(self) -> Wire:
        return self

    def __exit__(self, *_: object) -> None:
        self.near.shutdown()
        self.far.shutdown()


COUNT, SHARE = 3000, 0.3


@pytest.mark.parametrize(
    "fault", ["lost", "corrupted", "duplicated", "reordered", "delayed", "replayed"]
)
def test_each_fault_befalls_its_share_and_does_what_its_name_says(fault: str) -> None:
    seed = int(draw(fault).integers(1 << 30))
    faults = FrameFaults()
    faults.set(fault, SHARE)
    with Wire(faults, seed, fault) as wire:
        wire.send(COUNT)
        heard = wire.heard()
        befallen = wire.near.befallen
    assert abs(befallen - SHARE * COUNT) < 6.0 * (COUNT * SHARE * (1.0 - SHARE)) ** 0.5
    seen = Counter(heard)
    if fault == "lost":
        assert len(heard) == COUNT - befallen
        assert heard == sorted(heard)
    elif fault == "corrupted":
        turned = [(i, h) for i, h in enumerate(heard) if i != h]
        assert len(turned) == befallen
        assert all(1 <= (i ^ h).bit_count() <= 3 for i, h in turned)
    elif fault == "duplicated":
        assert seen == Counter({i: seen[i] for i in range(COUNT)})
        assert sum(n == 2 for n in seen.values()) == befallen
    elif fault in ("reordered", "delayed"):
        assert seen == Counter(range(COUNT))
        late = max(max(heard[: k + 1]) - h for k, h in enumerate(heard))
        assert 0 < late <= (REORDER if fault == "reordered" else DELAY) / 0.01 + 1
    else:
        assert len(heard) == COUNT + befallen
        assert set(heard) == set(range(COUNT))


def test_a_bus_that_is_off_takes_and_gives_nothing() -> None:
    faults = FrameFaults(bus_off=True)
    with Wire(faults, 1, "off") as wire:
        with pytest.raises(can.CanOperationError, match="bus off"):
            wire.near.send(data_frame(1))
        wire.far.send(data_frame(2))
        assert wire.near.recv(0.0) is None
        faults.set("bus_off", 0.0)
        wire.far.send(data_frame(3))
        got = wire.near.recv(0.0)
        assert got is not None
        assert got.data[0] == 3


def test_the_same_seed_gives_the_same_faults() -> None:
    runs = []
    for _ in range(2):
        with Wire(FrameFaults(lost=0.2, delayed=0.2), 7, "same") as wire:
            wire.send(200)
            runs.append(wire.heard())
    assert runs[0] == runs[1]


def test_faults_have_names_and_shares() -> None:
    with pytest.raises(InputError, match="did you mean 'corrupted'"):
        FrameFaults().set("corupted", 0.3)
    with pytest.raises(InputError, match="no share"):
        FrameFaults().set("lost", 30.0)
