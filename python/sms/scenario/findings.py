"""What a run says: how well the attitude was followed, and where the limit is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.signal import welch

from sms.arrays import Array
from sms.comparison.metrics import Metrics, compare_signals
from sms.requirements.table import ACCURACY
from sms.scenario.load import Scenario
from sms.scenario.record import POSE, Record
from sms.scenario.sent import Command
from sms.units_display import format_quantity
from sms.workspace_survey import DEGREE

AXES = ("roll", "pitch", "height")
_UNITS = dict(POSE[:3])
_MOVED = 1e-3  # rad or m: below it an axis is at rest
_OSCILLATES = 2.0  # times the commanded speed, RMS
_AT_REST = 0.02  # m/s RMS: less is no oscillation
_SETTLING = 2.0  # s at the start that do not count
_OFTEN = 0.01  # of the time
_SATURATED = 0.01  # V from the end of the command


@dataclass(frozen=True)
class Following:
    """How one axis of the pose followed its command."""

    axis: str
    unit: str
    metrics: Metrics  #: reached against commanded
    moved: bool  #: whether it was commanded to move at all
    share_beyond: float  #: of the time with an error above 0.5 deg; NaN for the height
    without_lag: float  #: largest error when the lag is taken off, in the unit


@dataclass(frozen=True)
class Findings:
    """What came out of a run."""

    following: tuple[Following, ...]
    limit: str  #: "stroke", "flow", "bandwidth", "stability" or "" when nothing limits
    sentences: tuple[str, ...]
    saturated: float  #: share of the time with a valve at the end of its command
    least_stroke: float  #: the nearest an actuator came to an end, m
    fastest: float  #: m/s

    def to_dict(self) -> dict[str, Any]:
        """For programs, SI units, NaN as None."""
        return {
            "limit": self.limit,
            "findings": list(self.sentences),
            "saturated_share": self.saturated,
            "least_stroke_m": self.least_stroke,
            "largest_speed_m_per_s": self.fastest,
            "following": {
                f.axis: {
                    "unit": f.unit,
                    "largest_error": f.metrics.largest_error,
                    "largest_error_at_s": f.metrics.largest_error_at,
                    "rms_error": f.metrics.rms_error,
                    "mean_absolute_error": f.metrics.mean_absolute_error,
                    "largest_error_without_lag": _finite(f.without_lag),
                    "share_beyond_half_a_degree": _finite(f.share_beyond),
                    "amplitude_ratio": _finite(f.metrics.amplitude_ratio),
                    "lag_s": _finite(f.metrics.lag),
                }
                for f in self.following
            },
        }


def findings_of(scenario: Scenario, command: Command, run: Record) -> Findings:
    """Read a run against what was asked of it."""
    stroke = scenario.params.stroke
    least = float(np.minimum(run.extension, stroke - run.extension).min())
    off = np.abs(run.valve_command - scenario.params.command_offset)
    saturated = float((off >= 5.0 - _SATURATED).any(axis=1).mean())
    fastest = float(np.abs(run.velocity).max())
    following = _following(run) if run.asked is not None and run.pose is not None else ()
    cut = command.motion.cuts if command.motion else ()
    oscillating = _oscillation(run)
    limit = _limit(following, saturated, bool(cut), oscillating)
    sentences = [cut.sentence for cut in cut]
    sentences += _attitude_sentences(following)
    if cut:
        sentences.append(_against_asked(command, run))
    if following:
        sentences.append(_limit_sentence(limit, following, saturated, oscillating, bool(cut)))
    if least < 0.0:
        sentences.append("An actuator ran into its end stop.")
    sentences.append(
        f"The nearest an actuator came to an end of its stroke is {quantity(max(least, 0.0), 'm')}; the "
        f"fastest moved at {quantity(fastest, 'm/s')}; a valve was "
        f"fully open {100.0 * saturated:.1f} % of the time."
    )
    if command.motion is not None:
        sentences += command.motion.notes
    if not run.complete:
        sentences.insert(
            0,
            f"Partial: {run.ended} after {run.time[-1]:.2f} s of {run.planned:.2f} s; what was "
            "computed until then is kept.",
        )
    return Findings(following, limit, tuple(sentences), saturated, least, fastest)


def _following(run: Record) -> tuple[Following, ...]:
    assert run.asked is not None and run.pose is not None
    later = run.time >= min(_SETTLING, 0.25 * run.time[-1])
    if np.count_nonzero(later) < 8:
        return ()
    time = run.time[later]
    found = []
    for column, axis in enumerate(AXES):
        asked, reached = run.asked[later, column], run.pose[later, column]
        moved = bool(np.ptp(asked) > _MOVED)
        angle = axis != "height"
        if not (moved or angle):
            continue
        metrics = compare_signals(time, asked, reached)
        error = np.abs(reached - asked)
        found.append(
            Following(
                axis,
                _UNITS[axis],
                metrics,
                moved,
                float((error > ACCURACY).mean()) if angle else math.nan,
                _largest_without_lag(time, asked, reached, metrics.lag),
            )
        )
    return tuple(found)


def _largest_without_lag(time: Array, asked: Array, reached: Array, lag: float) -> float:
    if not math.isfinite(lag):
        return math.nan
    inside = (time - lag >= time[0]) & (time - lag <= time[-1])
    moved = np.interp(time - lag, time, asked)
    return float(np.abs(reached - moved)[inside].max())


def _oscillation(run: Record) -> float:
    """The frequency (Hz) at which the loop oscillates on its own; 0 when it does not."""
    if run.unit != "m" or run.time.size < 64:
        return 0.0
    later = run.time >= 0.25 * run.time[-1]
    commanded = np.gradient(run.setpoint[later], run.time[later], axis=0)
    moved = run.velocity[later]
    if np.sqrt((moved**2).mean()) < max(_OSCILLATES * np.sqrt((commanded**2).mean()), _AT_REST):
        return 0.0
    rate = 1.0 / float(run.time[1] - run.time[0])
    segment = min(moved.shape[0], int(8.0 * rate))
    frequency, density = welch(moved, rate, nperseg=segment, axis=0)
    return float(frequency[int(np.argmax(density.sum(axis=1)))])


def _limit(
    following: tuple[Following, ...], saturated: float, cut: bool, oscillating: float
) -> str:
    """What keeps the attitude from being followed better."""
    angles = [f for f in following if f.unit == "rad"]
    worst = max((abs(f.metrics.largest_error) for f in angles), default=0.0)
    if worst <= ACCURACY and any(f.moved for f in angles):
        return "stroke" if cut else ""
    if worst <= ACCURACY:  # only the height moves, of which Table 2.1 asks nothing
        return "flow" if saturated > _OFTEN else ""
    if oscillating:
        return "stability"
    return "flow" if saturated > _OFTEN else "bandwidth"


def _attitude_sentences(following: tuple[Following, ...]) -> list[str]:
    return [_followed(f) if f.moved else _held(f) for f in following]


def _against_asked(command: Command, run: Record) -> str:
    """The error against the motion before anything was cut off it."""
    assert command.motion is not None and run.pose is not None
    asked = command.motion.asked
    error = [
        np.abs(run.pose[:, column] - np.interp(run.time, asked.time, asked.axis(axis)))
        for column, axis in enumerate(("roll", "pitch"))
    ]
    largest = float(np.maximum(*error).max())
    return f"Against the motion before the cut the largest error is {quantity(largest, 'rad')}."


def _followed(f: Following) -> str:
    text = (
        f"{f.axis.capitalize()} follows its command with an error of "
        f"{quantity(f.metrics.rms_error, f.unit)} RMS and "
        f"{quantity(abs(f.metrics.largest_error), f.unit)} at most (at "
        f"{f.metrics.largest_error_at:.1f} s); it lags by {quantity(f.metrics.lag, 's')}, with "
        f"{f.metrics.amplitude_ratio:.2f} of the amplitude."
    )
    return text + _verdict(f)


def _held(f: Following) -> str:
    return (
        f"{f.axis.capitalize()} is to stay where it is and leaves it by "
        f"{quantity(abs(f.metrics.largest_error), f.unit)} at most." + _verdict(f)
    )


def _verdict(f: Following) -> str:
    if f.unit != "rad":
        return ""
    verdict = "meets" if abs(f.metrics.largest_error) <= ACCURACY else "misses"
    beyond = f", {100.0 * f.share_beyond:.1f} % of the time beyond" if f.share_beyond else ""
    return f" That {verdict} the {ACCURACY / DEGREE:g}° of Table 2.1{beyond}."


def quantity(value: float, unit: str) -> str:
    """A number for a sentence: "1.94°", "0.18 s"."""
    return format_quantity(value, unit).replace(" °", "°")


def _limit_sentence(
    limit: str, following: tuple[Following, ...], saturated: float, oscillating: float, cut: bool
) -> str:
    angles = [f for f in following if f.unit == "rad"] or list(following)
    worst = max(angles, key=lambda f: abs(f.metrics.largest_error))
    rest = quantity(worst.without_lag, worst.unit)
    if limit == "stroke":
        return (
            "The limit is the stroke: what was cut off the motion is missing, the rest is followed."
        )
    if limit == "stability":
        return (
            f"The limit is the loop's stability: it oscillates on its own at {oscillating:.1f} Hz. "
            "Lower its gain, or damp it by the acceleration (acceleration_gain)."
        )
    if limit == "flow":
        return (
            f"The limit is the flow: a valve is fully open {100.0 * saturated:.1f} % of the time. "
            f"Without the lag the largest error would be {rest}."
        )
    if limit == "bandwidth":
        used = "beside the stroke, which cut the motion, it" if cut else "it"
        return (
            f"The limit: {used} is the loop's bandwidth and its dead band, not the flow. Without "
            f"its lag the largest error would be {rest}."
        )
    return "Nothing limits the attitude: its error stays within what Table 2.1 allows."


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
