"""The faults of rig_faults.py: how each is made, what has to be said, what the platform does, how it comes back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sms.link.codec import checksum
from sms.link.parameters import read_parameter, write_parameters
from sms.link.rig_link import RefusedError

from validation.link.rig_fault_stage import TRACK, Stage

MINUTE = 60.0  #: s


@dataclass(frozen=True)
class Trial:
    """One fault: how it is made, what has to be said, what the platform does, how it comes back."""

    fault: str
    says: tuple[str, ...]  #: any of these faults has to be said
    modes: tuple[str, ...]  #: the mode at the end is one of these
    does: str
    comes_back: str
    run: Callable[
        [Stage, float], float | None
    ]  #: for so many seconds; a time of detection of its own, s
    cure: Callable[[Stage], None] = lambda _stage: None
    seconds: float = 3.0
    by_itself: bool = False  #: it comes back without anybody doing anything


def disturbed(kind: str) -> Trial:
    """30 percent of all frames, both ways, for a minute."""
    name = f"frames_{kind}:0.3"

    def run(stage: Stage, seconds: float) -> None:
        stage.fault(name)
        stage.stream(seconds)

    return Trial(
        f"30 % of the frames {kind}, a minute",
        ("link_disturbed", "setpoint_timeout", "host_gone"),
        ("tracking", "levelling"),
        "follows the frames that are right; levels when set-points or heartbeats stay away",
        "by itself; the desk asks for tracking again",
        run,
        cure=lambda stage: stage.clear(name),
        seconds=MINUTE,
        by_itself=True,
    )


def of_machine(text: str, title: str, says: str, mode: str, does: str, back: str) -> Trial:
    """A fault of the rig's own, until it is cured."""

    def run(stage: Stage, seconds: float) -> None:
        stage.fault(text)
        stage.stream(seconds)

    return Trial(title, (says,), (mode,), does, back, run, cure=lambda stage: stage.clear(text))


def bus_off(stage: Stage, seconds: float) -> None:
    """The controller is off the bus, and so is the desk."""
    stage.fault("bus_off")
    stage.rig.frame_faults.bus_off = True
    stage.stream(seconds)


def bus_on(stage: Stage) -> None:
    """Back on the bus."""
    stage.clear("bus_off")
    stage.rig.frame_faults.bus_off = False


def silence(stage: Stage, seconds: float) -> None:
    """The host is gone."""
    stage.desk.release()
    stage.world.run(seconds)


def no_setpoints(stage: Stage, seconds: float) -> None:
    """Heartbeats go on, set-points do not."""
    stage.desk.wait(lambda: False, seconds)


def second_host(session: int) -> Callable[[Stage, float], None]:
    """Another desk that sends set-points of its own, and asks for modes."""

    def run(stage: Stage, seconds: float) -> None:
        other = stage.new_desk(session)
        other.listen()
        stage.world.forget()
        heartbeat = {
            "params_hash": stage.desk.value("ControllerHeartbeat", "params_hash") or 0,
            "protocol_version": 1,
        }
        setpoint: dict[str, float | int | str] = {
            "roll_setpoint": 0.1,
            "pitch_setpoint": -0.1,
            "height_setpoint": 0.4,
        }

        def intrude() -> None:
            other.drain()
            other.send("HostHeartbeat", heartbeat)
            other.send("AttitudeSetpoint", setpoint)
            other.send("ModeRequest", TRACK | {"mode_request": "levelling"})

        stage.stream(seconds, intrude)

    return run


def bad_setpoints(stage: Stage, seconds: float) -> None:
    """Nothing but set-points whose roll is no number."""
    end = stage.world.clock() + seconds
    while stage.world.clock() < end:
        frame = stage.desk.sender.frame(
            "AttitudeSetpoint",
            {"roll_setpoint": 0.0, "pitch_setpoint": 0.0, "height_setpoint": 0.5},
        )
        frame.data[2:4] = b"\x00\x80"
        frame.data[0] = checksum(
            frame.arbitration_id, stage.desk.sender.challenge, bytes(frame.data)
        )
        stage.desk.transmit(frame)
        stage.desk.wait(lambda: False, 0.01)


def far_setpoints(stage: Stage, seconds: float) -> None:
    """Set-points far outside the workspace."""
    end = stage.world.clock() + seconds
    while stage.world.clock() < end:
        far: dict[str, float | int | str] = {
            "roll_setpoint": 0.3,
            "pitch_setpoint": 0.3,
            "height_setpoint": 0.65,
        }
        stage.desk.send("AttitudeSetpoint", far)
        stage.desk.wait(lambda: False, 0.01)


def write_while_moving(stage: Stage, seconds: float) -> float | None:
    """A parameter set while the platform tracks."""
    before = read_parameter(stage.desk, "position_gain")
    begin = stage.world.clock()
    try:
        write_parameters(stage.desk, {"position_gain": before + 1.0})
    except RefusedError:
        detected = stage.world.clock() - begin
        stage.stream(seconds)
        return detected if read_parameter(stage.desk, "position_gain") == before else None
    return None


def wrong_hash(stage: Stage, seconds: float) -> None:
    """A desk with another params.def tries to take part."""
    other = stage.new_desk(5)
    other.listen()
    stage.world.forget()
    content = {"params_hash": 0xDEADBEEF, "protocol_version": 1}
    alive = (stage.desk.sender.frame("HostHeartbeat", content).data[1]) & 0x0F
    frame = stage.desk.sender.frame("HostHeartbeat", content)
    assert frame.data[1] & 0x0F == (alive + 1) % 16
    stage.desk.transmit(frame)
    stage.stream(seconds)


ACKNOWLEDGE = "cause away, then acknowledge, level, track"
TRIALS: tuple[Trial, ...] = (
    *(
        disturbed(k)
        for k in ("lost", "corrupted", "duplicated", "reordered", "delayed", "replayed")
    ),
    Trial(
        "bus off",
        ("bus_off",),
        ("levelling",),
        "levels",
        "by itself once the bus is back; the desk asks for tracking again",
        bus_off,
        cure=bus_on,
        by_itself=True,
    ),
    Trial(
        "host gone",
        ("setpoint_timeout", "host_gone"),
        ("levelling",),
        "levels; control is free after 300 ms",
        "a host connects and asks for tracking",
        silence,
    ),
    Trial(
        "set-points stay away",
        ("setpoint_timeout",),
        ("levelling",),
        "levels",
        "set-points come; the desk asks for tracking again",
        no_setpoints,
        by_itself=True,
    ),
    Trial(
        "two hosts",
        ("second_host",),
        ("tracking",),
        "follows the one in control",
        "nothing to do",
        second_host(9),
        by_itself=True,
    ),
    Trial(
        "two hosts of one session",
        ("link_disturbed",),
        ("tracking", "levelling"),
        "follows either; says so",
        "the second one goes; the desk asks for tracking again",
        second_host(5),
        by_itself=True,
    ),
    of_machine(
        "sensor_broken:2",
        "sensor broken",
        "sensor_broken_2",
        "fault",
        "valves to their centre",
        ACKNOWLEDGE,
    ),
    of_machine(
        "sensor_stuck:2",
        "sensor stuck",
        "sensor_stuck_2",
        "fault",
        "valves to their centre",
        ACKNOWLEDGE,
    ),
    of_machine(
        "sensor_jump:2",
        "sensor jumps by 20 mm",
        "sensor_jump_2",
        "fault",
        "valves to their centre",
        ACKNOWLEDGE,
    ),
    of_machine(
        "supply_lost",
        "supply lost (time constant 0.3 s)",
        "supply_lost",
        "fault",
        "valves to their centre",
        ACKNOWLEDGE,
    ),
    of_machine(
        "valve_stuck:2",
        "valve stuck",
        "valve_stuck_2",
        "fault",
        "valves to their centre",
        ACKNOWLEDGE,
    ),
    Trial(
        "set-point not a number",
        ("setpoint_not_a_number",),
        ("levelling",),
        "refuses it; levels when no other comes",
        "right set-points come; the desk asks for tracking again",
        bad_setpoints,
        by_itself=True,
    ),
    Trial(
        "set-point out of the workspace",
        ("setpoint_out_of_workspace",),
        ("tracking", "levelling"),
        "goes as far as it may, or refuses and levels",
        "right set-points come",
        far_setpoints,
        by_itself=True,
    ),
    Trial(
        "parameters written while moving",
        (),
        ("tracking",),
        "refuses all; nothing is changed",
        "nothing to do",
        write_while_moving,
        by_itself=True,
        seconds=1.0,
    ),
    Trial(
        "wrong hash of params.def",
        ("params_hash_mismatch",),
        ("tracking",),
        "refuses the frame",
        "nothing to do",
        wrong_hash,
        by_itself=True,
        seconds=1.0,
    ),
    of_machine(
        "enable_open",
        "enable switch opened",
        "enable_open",
        "disabled",
        "valves without power, at their centre",
        "switch closed, then level, track",
    ),
    of_machine(
        "loop_overrun",
        "loop overrun, every tick",
        "loop_overrun",
        "fault",
        "valves to their centre",
        ACKNOWLEDGE,
    ),
    of_machine(
        "hang",
        "program hangs, watchdog",
        "watchdog_reset",
        "disabled",
        "valves to their centre after the reset",
        ACKNOWLEDGE,
    ),
)
