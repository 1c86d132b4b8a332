"""Every fault that is expected of a rig, through the whole chain of desk, bus, controller and plant.

    python -m validation.rig_faults

The controller alone is tried by validation.faults, exactly and with limits of time. Here the virtual rig
(libsms/firmware/virtual_rig.hpp) follows a motion under a desk, over python-can's virtual bus, in simulated time.
Then something goes wrong. Measured at every millisecond: when the controller says so, which mode it takes, how far
and how fast the pistons went. Then the cause is taken away, and the way back is gone. A trial fails when a fault is
not said, the mode is another one, a piston leaves the stroke, or the way back leads nowhere.

The table in docs/rig_faults.md is what this program prints.
"""

from __future__ import annotations

import argparse
import itertools
import statistics
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import can
import numpy as np
from sms.link.bus import BusAddress, open_bus
from sms.link.codec import checksum, message, period
from sms.link.faulty_bus import FaultyBus
from sms.link.monitor import fault_names
from sms.link.parameters import read_parameter, write_parameters
from sms.link.real_time import SimulatedBus, SimulatedWorld
from sms.link.rig_link import BusError, LinkError, RefusedError, RigLink
from sms.link.virtual_rig import VirtualRig, parse_fault

PAGE = Path(__file__).resolve().parent.parent / "docs" / "rig_faults.md"
LEVEL = (0.0, 0.0, 0.5)
STROKE = 0.4  #: m
FASTEST = 1.0  #: m/s; no piston may be faster: the limit of the set-points' rate
BACK = 8.0  #: s; the longest that a way back may take
MINUTE = 60.0
_names = itertools.count()


class WatchedWorld(SimulatedWorld):
    """A simulated world that notes what the controller says and where the pistons are, every millisecond."""

    def __init__(self, machine: VirtualRig, bus: can.BusABC) -> None:
        """Notes from the beginning on."""
        super().__init__(machine, bus)
        self.first_said: dict[str, float] = {}  #: s; since `forget`
        self.modes: list[tuple[float, str]] = []
        self.extension = [np.inf, -np.inf]  #: m; least and most
        self.fastest = 0.0  #: m/s
        self.since = 0.0  #: s; begin of the notes
        self._faults = 0

    def forget(self) -> None:
        """Begin the notes anew, now; what is said already counts as known."""
        self.since = self.clock()
        self.first_said.clear()
        self.modes.clear()
        self._faults = self.machine.truth.faults

    def step(self) -> None:
        """One period, watched."""
        super().step()
        truth = self.machine.truth
        self.extension = [
            min(self.extension[0], *truth.extension),
            max(self.extension[1], *truth.extension),
        ]
        self.fastest = max(self.fastest, *(abs(rate) for rate in truth.extension_rate))
        if new := truth.faults & ~self._faults:
            for name in fault_names(new):
                self.first_said.setdefault(name, self.clock())
        self._faults = truth.faults
        mode = mode_name(truth.mode)
        if not self.modes or self.modes[-1][1] != mode:
            self.modes.append((self.clock(), mode))


def mode_name(mode: int) -> str:
    """The name of a mode of the controller."""
    choices: Mapping[int, object] = message("Status").get_signal_by_name("mode").choices or {}
    return str(choices[mode])


class Stage:
    """A rig that tracks a motion under a desk; the setting of every trial."""

    def __init__(self, seed: int) -> None:
        """Connected, levelled and tracking."""
        self.rig = VirtualRig(seed=seed, height=0.5)
        self.address = BusAddress("virtual", f"rig-faults-{next(_names)}")
        self.random = np.random.default_rng(seed)
        self.buses: list[can.BusABC] = []
        wire = FaultyBus(open_bus(self.address), lambda: self.rig.time, seed, self.rig.frame_faults)
        self.buses.append(wire)
        self.world = WatchedWorld(self.rig, wire)
        self.desk = self.new_desk(session=5)
        self.desk.connect()
        self.desk.request_mode("levelling")
        self.begin = self.world.clock()
        self.stream(0.1)
        self.desk.request_mode("tracking")
        self.stream(1.0 + 0.01 * float(self.random.uniform()))

    def new_desk(self, session: int) -> RigLink:
        """Another desk on the same bus."""
        bus = SimulatedBus(open_bus(self.address), self.world)
        self.buses.append(bus)
        return RigLink(bus, self.world.clock, session)

    def pose(self) -> tuple[float, float, float]:
        """Where the platform shall be now: roll, pitch, rad; height, m."""
        t = self.world.clock() - self.begin
        return (
            0.04 * float(np.sin(2.0 * np.pi * 0.3 * t)),
            0.03 * float(np.sin(2.0 * np.pi * 0.2 * t)),
            LEVEL[2] + 0.03 * float(np.sin(2.0 * np.pi * 0.25 * t)),
        )

    def stream(self, seconds: float, each: Callable[[], None] | None = None) -> None:
        """Send set-points for a while, one every 10 ms; a desk that wants to track asks again when it is not."""
        end = self.world.clock() + seconds
        asked = self.world.clock()
        while self.world.clock() < end:
            roll, pitch, height = self.pose()
            try:
                self.desk.send(
                    "AttitudeSetpoint",
                    {"roll_setpoint": roll, "pitch_setpoint": pitch, "height_setpoint": height},
                )
                if (
                    self.world.clock() - asked > 0.5
                    and self.desk.value("Status", "mode") == "levelling"
                ):
                    asked = self.world.clock()
                    self.desk.send("ModeRequest", TRACK)
            except BusError:
                pass  # the bus is off: a desk goes on trying
            if each is not None:
                each()
            self.desk.wait(lambda: False, period("AttitudeSetpoint"))

    def fault(self, text: str) -> None:
        """Switch one of the rig's faults on now."""
        self.rig.set_fault(parse_fault(f"{text}@0s"))

    def clear(self, text: str) -> None:
        """Switch it off."""
        self.rig.set_fault(parse_fault(f"{text}@0s"), on=False)

    def come_back(self) -> bool:
        """What a person does: acknowledge, level, track. Whether that leads to tracking."""
        end = self.world.clock() + BACK
        while self.world.clock() < end:
            try:
                if self.rig.truth.session != self.desk.sender.session:
                    self.desk.connect()
                if self.desk.value("Status", "mode") != "tracking":
                    self.desk.request_mode("disabled", acknowledge=True)
                    self.desk.request_mode("levelling")
                self.stream(0.7)
            except LinkError:
                self.stream(0.2)
            if mode_name(self.rig.truth.mode) == "tracking":
                return True
        return False

    def close(self) -> None:
        """Close all ends of the bus."""
        for bus in self.buses:
            bus.shutdown()


TRACK: dict[str, float | int | str] = {
    "mode_request": "tracking",
    "control_law_request": "unchanged",
    "acknowledge": "no",
}


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


@dataclass
class Outcome:
    """What one trial showed."""

    trial: Trial
    detected: list[float] = field(default_factory=list)  #: s, of each seed
    modes: set[str] = field(default_factory=set)
    least: float = np.inf  #: extension, m
    most: float = -np.inf
    fastest: float = 0.0  #: m/s
    failures: list[str] = field(default_factory=list)


def run_trial(trial: Trial, seed: int, seconds: float, outcome: Outcome) -> None:
    """One fault with one seed."""
    stage = Stage(1000 * TRIALS.index(trial) + seed if trial in TRIALS else seed)
    try:
        stage.world.forget()
        own = trial.run(stage, seconds)
        world = stage.world
        said = [at - world.since for name, at in world.first_said.items() if name in trial.says]
        detected = own if own is not None else min(said, default=None)
        mode = mode_name(stage.rig.truth.mode)
        outcome.modes.add(mode)
        if detected is None:
            names = ", ".join(stage.world.first_said) or "nothing"
            outcome.failures.append(f"seed {seed}: not said; said was {names}")
        else:
            outcome.detected.append(detected)
        if mode not in trial.modes:
            outcome.failures.append(f"seed {seed}: the mode is {mode}")
        trial.cure(stage)
        if trial.by_itself:
            stage.stream(2.0)
        if not (trial.by_itself and mode_name(stage.rig.truth.mode) == "tracking") and (
            trial.by_itself or not stage.come_back()
        ):
            outcome.failures.append(f"seed {seed}: it does not come back")
        outcome.least = min(outcome.least, world.extension[0])
        outcome.most = max(outcome.most, world.extension[1])
        outcome.fastest = max(outcome.fastest, world.fastest)
        if world.extension[0] < 0.0 or world.extension[1] > STROKE:
            outcome.failures.append(f"seed {seed}: a piston ran into its end")
        if world.fastest > FASTEST:
            outcome.failures.append(f"seed {seed}: a piston moved at {world.fastest:.2f} m/s")
    finally:
        stage.close()


# ---- the trials ----------------------------------------------------------------------------------------------------


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


# ---- the page ------------------------------------------------------------------------------------------------------

HEAD = """\
# Faults through the whole chain

Made by `python -m validation.rig_faults`: every fault is made on the virtual rig, that is on the firmware's own
application over the simulated plant, while it tracks a motion of 2.3 deg roll, 1.7 deg pitch and 30 mm heave under a
desk on python-can's virtual bus, in simulated time; each with {seeds} seeds. The controller alone, with the limits of
time that it has to keep: [faults.md](faults.md).

- *detected*: from the fault to the first millisecond in which the controller says it; median and worst. Where
  frames are disturbed that includes the time until the first command frame is hit.
- *pistons*: the extensions reached in the whole trial, with the way back, of a stroke of 0 to 400 mm; the fastest.
- A row without a remark passed all its checks: the fault is said, the mode is the one given, no piston touched an end
  or was faster than {fastest:g} m/s, and the way back led to tracking.

| fault | detected, ms | mode | what the platform does | how it comes back | pistons | remark |
|---|---|---|---|---|---|---|
"""


def row(outcome: Outcome) -> str:
    """One line of the table."""
    trial = outcome.trial
    times = [1e3 * t for t in outcome.detected]
    detected = f"{statistics.median(times):.0f}, {max(times):.0f}" if times else "never"
    cells = (
        trial.fault,
        detected,
        ", ".join(sorted(outcome.modes)),
        trial.does,
        trial.comes_back,
        f"{1e3 * outcome.least:.0f} to {1e3 * outcome.most:.0f} mm, {outcome.fastest:.2f} m/s",
        "; ".join(outcome.failures),
    )
    return "| " + " | ".join(cells) + " |\n"


def main() -> None:
    """Run the trials, print the table, write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.rig_faults", description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="how often each fault is tried")
    parser.add_argument("--short", type=float, help="trials of a minute last only so many seconds")
    parser.add_argument("--only", help="only faults with this word")
    parser.add_argument("--no-page", action="store_true", help="do not write docs/rig_faults.md")
    options = parser.parse_args()
    text = HEAD.format(seeds=options.seeds, fastest=FASTEST)
    failed = False
    for trial in TRIALS:
        if options.only and options.only not in trial.fault:
            continue
        outcome = Outcome(trial)
        for seed in range(1, options.seeds + 1):
            run_trial(trial, seed, min(trial.seconds, options.short or MINUTE), outcome)
        failed = failed or bool(outcome.failures)
        line = row(outcome)
        print(line, end="", flush=True)
        text += line
    if not options.no_page and options.only is None and options.short is None:
        PAGE.write_text(text)
        print(f"written: {PAGE}")
    raise SystemExit(failed)


if __name__ == "__main__":
    main()
