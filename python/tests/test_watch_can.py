"""A bus as a stream of rows: the same rows as from its log, and what a bus does to it."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import can
import numpy as np
import pytest
from link_support import desk_and_rig
from sms.errors import InputError
from sms.io.can_files import LogWriter, read_frames
from sms.io.records import load_record
from sms.io.rig import RecordSource, Rig, load_rig
from sms.link.bus import BusAddress, open_bus
from sms.watch.can_source import Clock, Decoder, decoded, listen
from sms.watch.feed import Chunk, Feed

SIGNALS = (
    *(f"valve_command_{leg}" for leg in (1, 2, 3)),
    *(f"extension_{leg}" for leg in (1, 2, 3)),
    *(f"chamber_pressure_lower_{leg}" for leg in (1, 2, 3)),
    *(f"chamber_pressure_upper_{leg}" for leg in (1, 2, 3)),
)


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four seconds of a virtual rig."""
    file = tmp_path_factory.mktemp("bus") / "run.blf"
    with desk_and_rig() as (link, world), LogWriter(file) as writer:
        link.connect()
        link.listener = writer.write
        end = world.clock() + 4.0
        while world.clock() < end:
            link.poll(end)
    return file


@pytest.fixture(scope="module")
def rig(log: Path) -> Rig:
    lines = "\n".join(f"{s} = {{}}" for s in SIGNALS)
    path = log.with_name("rig.toml")
    path.write_text(
        f'[rig]\nkind = "platform"\n[signals]\ntime = "time"\n{lines}\n'
        f'[[records]]\nfile = "{log.name}"\nrole = "identify"\n'
    )
    return load_rig(path)


def chunks_of(frames: Iterator[can.Message | None], rig: Rig) -> list[Chunk]:
    return list(decoded(frames, Decoder(rig), threading.Event()))


def test_frames_as_they_come_are_the_rows_of_their_log(log: Path, rig: Rig) -> None:
    chunks = chunks_of(iter(read_frames(log)), rig)
    whole = load_record(rig, RecordSource("run", log, "identify"))
    time = np.concatenate([c.rows["time"] for c in chunks])
    assert np.all(np.diff(time) > 0.0)
    assert np.median(np.diff(time)) == pytest.approx(0.01)
    told = {s: np.concatenate([c.rows[s] for c in chunks]) for s in SIGNALS}
    n = time.size
    # Which row of the log the first one is: noise repeats nowhere.
    places = range(len(whole) - n + 1)
    first = next(
        k
        for k in places
        if np.array_equal(whole.signals["extension_1"][k : k + n], told["extension_1"])
    )
    for signal in SIGNALS:
        assert np.allclose(told[signal], whole.signals[signal][first : first + n]), signal


def test_a_message_that_stays_away_holds_up_nobody(log: Path, rig: Rig) -> None:
    decoder = Decoder(rig)
    gone = decoder.channels["chamber_pressure_lower_2 [Pa]"].message.frame_id
    frames = list(read_frames(log))
    half = frames[0].timestamp + 2.0
    left = (f for f in frames if f.arbitration_id != gone or f.timestamp < half)
    chunks = chunks_of(iter(left), rig)
    pressure = np.concatenate([c.rows["chamber_pressure_lower_2"] for c in chunks])
    extension = np.concatenate([c.rows["extension_2"] for c in chunks])
    assert np.isfinite(extension).all()
    assert np.isfinite(pressure[:100]).all()
    assert np.isnan(pressure[-1])
    assert extension.size > 140


def test_the_decoder_holds_a_few_seconds_of_frames_however_long_it_listens(
    log: Path, rig: Rig
) -> None:
    """The rig is started again and again, too: its clock begins anew."""
    decoder, frames = Decoder(rig), list(read_frames(log))
    length = frames[-1].timestamp - frames[0].timestamp + 0.001
    held = []
    for turn in range(5):
        for frame in frames:
            frame.timestamp += length if turn else 0.0
            decoder.take(frame)
        held.append(sum(len(s.times) for s in decoder._series.values()) + len(decoder._due))
    assert max(held) < 2000
    assert decoder.restarts == 4


def test_error_frames_and_frames_that_do_not_fit_are_no_rows(log: Path, rig: Rig) -> None:
    frames = list(read_frames(log))
    number = Decoder(rig).channels["extension_1 [m]"].message.frame_id
    spoilt = can.Message(arbitration_id=number, is_extended_id=False, data=b"\x01")
    broken = can.Message(is_error_frame=True, timestamp=frames[0].timestamp + 1.5)
    decoder = Decoder(rig)
    found = list(decoded(iter([spoilt, broken, *frames]), decoder, threading.Event()))
    assert decoder.unfit == 1
    assert [c.detail for c in found if c.condition == "bus fault"] == ["1 error frames"]


def test_the_senders_clock_runs_on_when_its_reading_wraps() -> None:
    clock = Clock()
    told = [clock.reading((65.0 + 0.01 * k) % 65.536, 65.536, 7.0 + 0.01 * k) for k in range(200)]
    assert np.allclose(told, 0.01 * np.arange(200))
    assert clock.now(7.0 + 1.995) == pytest.approx(1.995)


def test_a_bus_is_listened_to_until_it_is_stopped(log: Path, rig: Rig) -> None:
    feed, stop = Feed(), threading.Event()
    listen(rig, "virtual", "watched", 500_000, feed, stop)
    with open_bus(BusAddress("virtual", "watched")) as bus:
        for frame in read_frames(log):
            bus.send(frame)
        chunk = feed.take(10.0)
    stop.set()
    assert chunk is not None
    assert chunk.rows.keys() == {"time", *SIGNALS}
    with pytest.raises(InputError, match="there is no CAN interface"):
        listen(rig, "socketcn", None, 500_000, Feed(), threading.Event())
