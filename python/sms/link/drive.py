"""Streaming a deck motion to a rig: approach, motion, return, and how even the stream was."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import can
import numpy as np

from sms.arrays import Array
from sms.callbacks import Progress
from sms.errors import InputError
from sms.link.codec import Value, period
from sms.link.motion import MID_HEIGHT, PlatformMotion
from sms.link.rig_link import LinkError, RigLink

LONGEST = 86400.0  #: s; of a motion
APPROACH = 4.0  #: s; from level to the motion's first sample, and back at the end
LEVEL_TIME = 20.0  #: s; the longest that a platform may take to come up to mid-height
LEVEL_BAND = 0.005  #: m; closer than this to mid-height counts as there
LEFT = 0.15  #: s; a rig that says so long that it is not tracking is believed: three Status frames
RESUMES = 5  #: times that a rig which levelled is asked to track again
ECHO = 0.1  #: s; the longest until a set-point is taken
TAKEN = ("accepted", "limited")
LATE = 0.5  #: of a period; a set-point sent later than this counts as late


class InterruptedDriveError(LinkError):
    """The rig left the mode tracking while it was driven."""


@dataclass
class Stream:
    """How a motion was streamed and followed. Arrays have one entry a set-point."""

    interval: float  #: s; intended
    sent: Array = field(default_factory=lambda: np.empty(0))  #: s; when each set-point was sent
    pose: Array = field(default_factory=lambda: np.empty((0, 3)))  #: (n, 3) as sent
    followed: Array = field(
        default_factory=lambda: np.empty((0, 3))
    )  #: as the rig then said it was
    left: float | None = None  #: s; since when the rig has said that it is not tracking
    resumed: int = (
        0  #: times that the rig levelled, because set-points were late, and was asked again
    )
    limited: Counter[str] = field(
        default_factory=Counter
    )  #: set-points limited in range, rate, ...
    delays: list[float] = field(default_factory=list)  #: s; from set-point to its telemetry

    @property
    def lateness(self) -> Array:
        """By how much each set-point was later than its due time, s."""
        due = self.sent[0] + self.interval * np.arange(self.sent.size)
        return np.asarray(self.sent - due)

    @property
    def jitter(self) -> Array:
        """By how much each interval differs from the intended one, s."""
        return np.asarray(np.diff(self.sent) - self.interval)

    def summary(self) -> str:
        """What a person should know about the stream."""
        jitter = 1e3 * np.abs(self.jitter)
        late = int(np.count_nonzero(self.lateness > LATE * self.interval))
        lines = [
            f"{self.sent.size} set-points, one every {1e3 * self.interval:g} ms; jitter of the interval: "
            f"median {np.median(jitter):.3f} ms, 99 % below {np.quantile(jitter, 0.99):.3f} ms, "
            f"largest {jitter.max():.3f} ms; {late} late by more than {LATE:.0%} of it"
        ]
        if self.delays:
            delay = 1e3 * np.array(self.delays)
            lines.append(
                f"set-point to telemetry: median {np.median(delay):.2f} ms, largest {delay.max():.2f} ms"
            )
        error = self.followed - self.pose
        if np.isfinite(error).any():
            rms = np.sqrt(np.nanmean(error**2, axis=0))
            lines.append(
                f"the rig followed with an error (rms) of {np.degrees(rms[0]):.3f}° roll, "
                f"{np.degrees(rms[1]):.3f}° pitch, {1e3 * rms[2]:.1f} mm height"
            )
        if self.resumed:
            lines.append(
                f"set-points were so late that the rig levelled, and was asked to track again: {self.resumed} times"
            )
        if self.limited.total():
            shares = (f"{name} {n / self.sent.size:.0%}" for name, n in self.limited.items())
            lines.append(f"the rig limited the set-points, of the time: {', '.join(shares)}")
        return "\n".join(lines)


def drive(
    link: RigLink,
    motion: PlatformMotion,
    *,
    rate: float | None = None,
    law: str = "unchanged",
    progress: Progress = lambda _what, _done: None,
) -> Stream:
    """Level the platform, approach the motion's begin, stream it, return to level.

    `rate` in Hz; by default that of the DBC. The link must be connected; afterwards the rig is levelling.
    LinkError when the rig refuses or stops following, InputError for a motion of more than a day.
    """
    if motion.duration > LONGEST:
        raise InputError(
            f"the motion takes {motion.duration:.3g} s, and at most a day, {LONGEST:g} s, is driven; check its unit"
        )
    interval = period("AttitudeSetpoint") if rate is None else 1.0 / rate
    approach = motion.at(np.array([0.0]))[0]
    level = np.array([0.0, 0.0, MID_HEIGHT])
    ways = motion.at(np.arange(0.0, motion.duration + 0.5 * interval, interval))
    begin, end = _way(level, approach, interval), _way(ways[-1], level, interval)
    whole = len(begin) + len(ways) + len(end)

    progress("levelling", 0.0)
    link.request_mode("levelling", law=law)
    _wait_level(link)
    _send_and_await(link, level)
    link.request_mode("tracking")
    _stream(link, begin, interval, lambda done: progress("approaching", done / whole))
    stream = _stream(
        link, ways, interval, lambda done: progress("driving", (len(begin) + done) / whole)
    )
    done_before = len(begin) + len(ways)
    _stream(link, end, interval, lambda done: progress("returning", (done_before + done) / whole))
    link.request_mode("levelling")
    return stream


def _way(begin: Array, end: Array, interval: float) -> Array:
    """A path without jump in velocity or acceleration, (n, 3): a polynomial of degree 5 in time."""
    s = np.linspace(0.0, 1.0, max(2, round(APPROACH / interval)))[:, np.newaxis]
    return np.asarray(begin + (10.0 - 15.0 * s + 6.0 * s**2) * s**3 * (end - begin))


def _setpoint(pose: Array) -> dict[str, float | int | str]:
    roll, pitch, height = (float(value) for value in pose)
    return {"roll_setpoint": roll, "pitch_setpoint": pitch, "height_setpoint": height}


def _send_and_await(link: RigLink, pose: Array) -> None:
    """Set-points until the rig says that it takes them: a request to track needs a fresh one.

    The first of a stream, which may be far from where the platform is, has to be confirmed by the next.
    """
    end = link.clock() + ECHO
    while link.clock() < end:
        frame = link.send("AttitudeSetpoint", _setpoint(pose))
        link.wait(lambda frame=frame: is_answer(link, frame), ECHO)  # type: ignore[misc]
        if is_answer(link, frame) and link.value("Setpoint", "setpoint_result") in TAKEN:
            return
        link.wait(lambda: False, period("AttitudeSetpoint"))
    raise LinkError(
        f"the rig does not take set-points ({link.value('Setpoint', 'setpoint_result')}); "
        "`sms can monitor` shows its state"
    )


def _wait_level(link: RigLink) -> None:
    def there() -> bool:
        height = link.value("Attitude", "height")
        return isinstance(height, float) and abs(height - MID_HEIGHT) < LEVEL_BAND

    if not link.wait(there, LEVEL_TIME):
        raise LinkError(
            f"the platform did not come to mid-height within {LEVEL_TIME:g} s; "
            "is there air, and is a control law with enough gain chosen?"
        )


def _stream(
    link: RigLink, poses: Array, interval: float, progress: Callable[[int], None]
) -> Stream:
    stream = Stream(interval)
    sent, followed = np.empty(len(poses)), np.full((len(poses), 3), np.nan)
    start = link.clock()
    unanswered: can.Message | None = None
    for number, pose in enumerate(poses):
        due = start + number * interval
        while link.clock() < due:
            link.poll(due)
            if unanswered is not None and is_answer(link, unanswered):
                stream.delays.append(link.clock() - sent[number - 1])
                unanswered = None
        _check_tracking(link, stream)
        frame = link.send("AttitudeSetpoint", _setpoint(pose))
        sent[number] = link.clock()
        unanswered = frame
        attitude = link.latest("Attitude")
        if attitude is not None:
            values = [attitude.signals.get(name) for name in ("roll", "pitch", "height")]
            followed[number] = [v if isinstance(v, float) else np.nan for v in values]
        progress(number + 1)
    stream.sent, stream.pose, stream.followed = sent, poses, followed
    return stream


def is_answer(link: RigLink, setpoint: can.Message) -> bool:
    """Whether the last telemetry of set-points is the answer to this frame."""
    reading = link.latest("Setpoint")
    return (
        reading is not None
        and reading.signals["setpoint_alive"] == setpoint.data[1] & 0x0F
        and reading.signals["setpoint_session"] == setpoint.data[1] >> 4
    )


def _check_tracking(link: RigLink, stream: Stream) -> None:
    status = link.latest("Status")
    if not link.is_alive() or status is None:
        raise InterruptedDriveError("the rig fell silent while it was driven; check the bus")
    if status.signals["mode"] == "tracking":
        stream.left = None
    elif stream.left is None:
        stream.left = link.clock()
    elif link.clock() - stream.left > LEFT and _is_late_only(status.signals, stream):
        stream.resumed += 1
        stream.left = link.clock()
        link.send(
            "ModeRequest", {"mode_request": "tracking", "control_law_request": 0, "acknowledge": 0}
        )
    elif link.clock() - stream.left > LEFT:
        raise InterruptedDriveError(
            f"the rig left tracking for {status.signals['mode']}, "
            f"first fault: {status.signals['first_fault']}; `sms can monitor` shows its state"
        )
    for name in ("range", "rate", "acceleration"):
        stream.limited[name] += bool(status.signals[f"limited_{name}"])


def _is_late_only(signals: Mapping[str, Value], stream: Stream) -> bool:
    """Whether a rig has levelled for no other reason than a desk that was late, and not too often."""
    late = signals["first_fault"] in ("none", "setpoint_timeout", "host_gone", "link_disturbed")
    return signals["mode"] == "levelling" and late and stream.resumed < RESUMES
