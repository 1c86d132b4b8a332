"""A desk with a virtual rig, in simulated time: control, parameters, driving, and effects that stay hidden."""

from __future__ import annotations

import numpy as np
import pytest
from link_support import desk_and_rig
from sms import Params
from sms.io import InputError
from sms.link.codec import checksum
from sms.link.drive import InterruptedDriveError, drive
from sms.link.faulty_bus import FaultyBus, FrameFaults
from sms.link.motion import PlatformMotion
from sms.link.parameters import (
    is_default,
    known_parameters,
    parse_setting,
    read_parameter,
    write_parameters,
)
from sms.link.rig_link import LinkError, NotConnectedError, RefusedError, RigLink
from sms.link.virtual_rig import FAULTS, VirtualRig, parse_fault


def gentle(seconds: float = 3.0) -> PlatformMotion:
    time = np.arange(0.0, seconds, 0.05)
    wave = np.sin(2.0 * np.pi * 0.25 * time)
    return PlatformMotion(time, 0.03 * wave, -0.02 * wave, 0.5 + 0.02 * wave)


def test_a_desk_takes_control_and_gives_it_back() -> None:
    with desk_and_rig() as (link, world):
        assert not link.is_alive()
        link.connect()
        assert world.machine.truth.session == link.sender.session
        other = RigLink(link.bus, world.clock, link.sender.session % 14 + 1)
        with pytest.raises(
            RefusedError, match=f"another desk .session {link.sender.session}. has control"
        ):
            other.connect(0.12)  # while the first desk's last heartbeat counts
        link.release()
        world.run(0.5)
        assert world.machine.truth.session == 0
        link.drain()
        other.connect()
        assert world.machine.truth.session == other.sender.session


def test_a_desk_that_drew_a_session_in_use_draws_again() -> None:
    with desk_and_rig() as (link, world):
        link.connect()
        session = link.sender.session
        other = RigLink(link.bus, world.clock, session)
        with pytest.raises(RefusedError):
            other.connect(0.12)
        assert other.sender.session != session


def test_no_rig_is_one_sentence() -> None:
    with (
        desk_and_rig(faults=["bus_off@0s"]) as (link, _),
        pytest.raises(NotConnectedError, match="no rig answers"),
    ):
        link.connect()


def test_a_foreign_rig_is_not_commanded(monkeypatch: pytest.MonkeyPatch) -> None:
    with desk_and_rig() as (link, world):
        monkeypatch.setattr("sms.link.rig_link._core.firmware_hash", lambda: 1)
        with pytest.raises(NotConnectedError, match=r"other parameters .*, here 00000001"):
            link.connect()
        assert world.machine.frames_in == 0


def test_modes_and_refusals() -> None:
    with desk_and_rig() as (link, _):
        link.connect()
        with pytest.raises(RefusedError, match="tracking: it cannot be reached from the mode"):
            link.request_mode("tracking")
        link.request_mode("levelling")
        with pytest.raises(RefusedError, match="no set-point came"):
            link.request_mode("tracking")
        link.request_mode("disabled")
        assert link.value("Status", "mode") == "disabled"


def test_parameters_are_written_all_or_none() -> None:
    with desk_and_rig() as (link, _):
        link.connect()
        wanted = {"position_gain": 33.0, "level_height": 0.49, "payload_mass": 261.5}
        stored = write_parameters(link, wanted)
        assert stored == pytest.approx(wanted, rel=1e-7)
        for name, value in wanted.items():
            assert read_parameter(link, name) == pytest.approx(value, rel=1e-7)
            assert not is_default(name, read_parameter(link, name))
        assert is_default("stroke", read_parameter(link, "stroke"))
        with pytest.raises(InputError, match=r"position_gain = 1e\+09 .* is outside"):
            write_parameters(link, {"level_height": 0.48, "position_gain": 1e9})
        with pytest.raises(RefusedError, match="no machine"):
            write_parameters(link, {"position_gain": 1.0, "level_height": 5.0})
        assert read_parameter(link, "level_height") == pytest.approx(0.49)
        assert read_parameter(link, "position_gain") == pytest.approx(33.0)
        link.request_mode("levelling")
        with pytest.raises(RefusedError, match="not disabled"):
            write_parameters(link, {"position_gain": 12.0})
        assert read_parameter(link, "position_gain") == pytest.approx(33.0)


def test_lost_confirmations_do_not_break_a_transaction() -> None:
    with desk_and_rig() as (link, world):
        link.connect()
        quiet = link.bus
        lossy = FaultyBus(quiet, world.clock, seed=3, faults=FrameFaults(lost=0.2))
        link.bus = lossy
        wanted = {"position_gain": 21.0, "level_height": 0.495}
        assert write_parameters(link, wanted) == pytest.approx(wanted)
        assert lossy.befallen > 0
        link.bus = quiet
        assert read_parameter(link, "position_gain") == pytest.approx(21.0)


def test_settings_as_typed() -> None:
    assert parse_setting("position_gain=20") == ("position_gain", 20.0)
    assert parse_setting("bore_diameter = 100 mm") == ("bore_diameter", pytest.approx(0.1))
    with pytest.raises(InputError, match="write NAME=VALUE"):
        parse_setting("position_gain")
    with pytest.raises(InputError, match="did you mean 'position_gain'"):
        parse_setting("position_gian=1")
    indices = [p.index for p in known_parameters().values()]
    assert len(set(indices)) == len(indices)


def test_a_motion_is_driven_and_followed() -> None:
    said: list[tuple[str, float]] = []
    with desk_and_rig() as (link, world):
        link.connect()
        stream = drive(link, gentle(), progress=lambda what, done: said.append((what, done)))
        assert link.value("Status", "mode") == "levelling"
        assert world.machine.truth.faults == 0
    assert stream.sent.size == 296
    assert np.abs(stream.jitter).max() <= 1.001e-3  # simulated time runs in periods of 1 ms
    assert max(stream.delays) <= 2e-3
    error = np.abs(stream.followed - stream.pose)
    assert np.nanmax(error[:, 2]) < 0.02
    assert "set-points, one every 10 ms" in stream.summary()
    assert [what for what, _ in said][:1] == ["levelling"]
    assert said[-1] == ("returning", 1.0)


def test_a_listener_sees_every_frame_of_both_sides_once() -> None:
    with desk_and_rig() as (link, world):
        seen: list[tuple[float, int]] = []
        link.listener = lambda frame: seen.append((frame.timestamp, frame.arbitration_id))
        link.connect()
        link.wait(lambda: False, 1.0)
        times = [time for time, _ in seen]
        assert times == sorted(times)
        numbers = [number for _, number in seen]
        assert numbers.count(0x90) == world.machine.frames_in
        assert numbers.count(0x110) == link.counts[0x110]


def test_a_motion_of_years_is_refused_before_anything_moves() -> None:
    """Its time was in microseconds, say."""
    motion = gentle()
    with desk_and_rig() as (link, world):
        link.connect()
        with pytest.raises(InputError, match="at most a day"):
            drive(link, PlatformMotion(1e9 * motion.time, motion.roll, motion.pitch, motion.height))
        assert world.machine.truth.mode == 0


def test_a_drive_that_the_rig_leaves_says_why() -> None:
    with desk_and_rig(faults=["sensor_broken:2@6s"]) as (link, _):
        link.connect()
        with pytest.raises(
            InterruptedDriveError, match="left tracking for fault, first fault: sensor_broken_2"
        ):
            drive(link, gentle(20.0))


def test_a_desk_that_was_late_drives_on_and_says_so() -> None:
    with desk_and_rig() as (link, world):
        link.connect()
        stalled: list[float] = []

        def progress(_what: str, _done: float) -> None:
            if world.clock() > 6.0 and not stalled:
                stalled.append(world.clock())
                world.run(0.2)  # the desk's computer had something else to do

        stream = drive(link, gentle(6.0), progress=progress)
        assert link.value("Status", "mode") == "levelling"
    assert stream.resumed == 1
    assert "was asked to track again: 1 times" in stream.summary()


def test_a_rig_that_does_not_come_up_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sms.link.drive.LEVEL_TIME", 0.3)
    with desk_and_rig(height=0.33) as (link, _):
        link.connect()
        with pytest.raises(LinkError, match="did not come to mid-height"):
            drive(link, gentle())


def test_the_same_seed_is_the_same_rig_to_the_bit() -> None:
    runs = []
    for _ in range(2):
        with desk_and_rig() as (link, world):
            link.connect()
            link.request_mode("levelling")
            world.run(1.0)
            runs.append((world.machine.truth.extension, world.machine.truth.chamber_pressure_lower))
    assert runs[0] == runs[1]


def test_effects_change_the_plant_and_the_controller_does_not_know() -> None:
    pressures = {}
    for effect in ([], ["chamber_leakage_lower:2=2e-9"]):
        with desk_and_rig(effects=effect) as (link, world):
            link.connect()
            world.run(1.5)
            pressures[len(effect)] = world.machine.truth.chamber_pressure_lower
            assert read_parameter(link, "chamber_leakage_lower") == 0.0
    assert pressures[1][0] == pytest.approx(pressures[0][0], rel=0.02)
    assert pressures[1][1] < 0.98 * pressures[0][1]


@pytest.mark.parametrize(("effect", "said"), [
    ("valve_leak=1", "did you mean 'valve_leakage'"),
    ("valve_leakage", "write NAME=VALUE"),
    ("valve_leakage=1", "outside the allowed range"),
    ("valve_leakage:4=1e-10", "'4' is no leg"),
    ("tube_length=2 kg", "does not fit"),
])  # fmt: skip
def test_effects_that_cannot_be_are_said(effect: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        VirtualRig(effects=[effect])
    assert said in str(caught.value)


@pytest.mark.parametrize(("fault", "said"), [
    ("sensor_stuk:1@2s", "did you mean 'sensor_stuck'"),
    ("sensor_stuck@2s", "which leg"),
    ("sensor_stuck:5@2s", "'5' is no leg"),
    ("sensor_stuck:1", "write NAME"),
    ("frames_lost@1s", "takes SHARE"),
    ("frames_lost:3@1s", "no share"),
    ("bus_off@3s..2s", "ends before it begins"),
    ("bus_off:1@3s", "bus_off takes"),
])  # fmt: skip
def test_faults_that_cannot_be_are_said(fault: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_fault(fault)
    assert said in str(caught.value)


def test_faults_as_typed() -> None:
    fault = parse_fault("sensor_jump:3:0.015@2.5s..4s")
    assert (fault.name, fault.leg, fault.amount, fault.begin, fault.end) == (
        "sensor_jump",
        2,
        0.015,
        2.5,
        4.0,
    )
    assert parse_fault("supply_lost@1").amount == 0.3
    for name in FAULTS:
        argument = {"LEG": ":1", "SHARE": ":0.3"}.get(
            FAULTS[name].split(",")[0].split(":")[0].split("[")[0], ""
        )
        assert parse_fault(f"{name}{argument}@1s").name == name


def test_planned_faults_begin_and_end_on_time() -> None:
    with desk_and_rig(faults=["enable_open@1s..1.5s"]) as (link, world):
        link.connect()
        link.request_mode("levelling")
        events = []
        while world.clock() < 2.0:
            link.wait(lambda: False, 0.1)
            events += link.take_events()
    raised = {
        e.signals["event"]: e.signals["event_time"]
        for e in events
        if e.signals["event_detail"] == 1
    }
    assert raised["fault_raised"] == pytest.approx(1.001, abs=0.0015)
    assert raised["fault_cleared"] == pytest.approx(1.501, abs=0.0015)


def test_a_replayed_recording_moves_nothing() -> None:
    with desk_and_rig() as (link, world):
        link.connect()
        old = []
        for _ in range(40):
            old.append(
                link.send(
                    "ModeRequest",
                    {"mode_request": "levelling", "control_law_request": 0, "acknowledge": 0},
                )
            )
            link.wait(lambda: False, 0.01)
        link.request_mode("disabled")
        link.release()
        world.run(1.0)
        challenge = link.value("ControllerHeartbeat", "challenge")
        link.drain()
        assert link.value("ControllerHeartbeat", "challenge") != challenge
        for frame in old:
            link.bus.send(frame)
            world.run(0.01)
        assert world.machine.truth.mode == 0
        assert (
            checksum(old[0].arbitration_id, int(challenge or 0), bytes(old[0].data))
            == old[0].data[0]
        )


def test_the_plant_has_the_machine_of_params_def() -> None:
    rig = VirtualRig(noisy=False)
    assert rig.truth.pose == pytest.approx((0.0, 0.0, 0.32))
    rig.step(200)
    assert rig.truth.pose[2] == pytest.approx(0.32, abs=1e-3)  # valves closed: the air holds it
    assert all(0.0 < e < Params().stroke for e in rig.truth.extension)
