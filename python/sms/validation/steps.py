"""Chapter 8 on the full model: state feedback with three gain sets and loop gains, P control."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.signal import detrend

from sms.arrays import Array
from sms.scenario import Record
from sms.validation.figures import FIGURES, Row, peak_to_peak
from sms.validation.runs import crossing, run, sample

LOOP_GAINS = 0.5, 1.0, 15.0
HOLD = 3.0  #: s, of each level of the scenario
GAINS = "position_gain", "velocity_gain", "acceleration_gain"
DESIGNED = {  # figures of Table E.1's gains on the full model, and those gains
    "situm_unstable": (15.8031, 1.3393, 0.1123),
    "specified_unstable": (3.9128, -0.478, 0.0666),
}
_STEP = 0.2  # m, of the scenario
_WATCHED = 1.0  # s, the end of a step; a slow creep there is no motion
_LEADING = 1  # actuator 2
_LEVELLING = 11.5  # s
_PROPORTIONAL = np.arange(10.0, 81.0, 5.0)  # V/m


@dataclass(frozen=True)
class Step:
    """What became of one step, from 0 to 1."""

    rise: float  #: 10 to 90 %, s; NaN when it does not get there
    overshoot: float  #: 1
    motion: float  #: peak to peak in the last second, less its trend, m
    error: float  #: mean there, m


_ENDED = Step(math.nan, math.nan, math.inf, math.nan)  # of a run that could not be finished


def step_of(record: Record, begin: float, start: float, target: float, lasts: float = HOLD) -> Step:
    """Of actuator 2, after a step of the set point from `start` to `target` (m) at `begin` (s)."""
    rows = slice(sample(record, begin), sample(record, begin + lasts))
    x = record.extension[rows, _LEADING]
    time = record.time[rows] - begin
    share: Array = (x - start) / (target - start)
    late = x[time > lasts - _WATCHED]
    return Step(
        rise=crossing(time, share, 0.9) - crossing(time, share, 0.1),
        overshoot=float(share.max()) - 1.0,
        motion=peak_to_peak(np.asarray(detrend(late))),
        error=abs(float(late.mean()) - target),
    )


def feedback(parameters: Mapping[str, float], hold: float = HOLD) -> tuple[Step, Step]:
    """The steps up and down of the state-feedback scenario, each level held for `hold` s."""
    record = run(
        "step_state_feedback",
        parameters,
        scenario={"duration": f"{3.0 * hold} s"},
        excitation={"hold": f"{hold} s"},
    )
    if not record.complete:
        return _ENDED, _ENDED
    low, high = (float(record.setpoint[sample(record, k * hold), _LEADING]) for k in (0.5, 1.5))
    return (
        step_of(record, hold, low, high, hold),
        step_of(record, 2.0 * hold, high, low, hold),
    )


def state_feedback() -> list[Row]:
    """The gains that the source found, at three loop gains, and without acceleration feedback."""
    low, own, high = (feedback({"loop_gain": gain}) for gain in LOOP_GAINS)
    none = feedback({"acceleration_gain": 0.0})
    read = "steps between -0.1 m and 0.1 m, upwards; differentiators' corner 100 rad/s (assumed)"
    return [
        FIGURES["feedback_rise"].row(own[0].rise, read),
        FIGURES["feedback_overshoot"].row(worst(own, "overshoot"), "the larger of up and down"),
        FIGURES["feedback_motion"].row(worst(own, "motion"), "a limit cycle"),
        FIGURES["feedback_motion_low"].row(worst(low, "motion")),
        FIGURES["feedback_motion_high"].row(worst(high, "motion")),
        FIGURES["feedback_insensitive"].row(high[0].rise / own[0].rise),
        FIGURES["feedback_no_acceleration"].row(worst(none, "motion")),
    ]


def worst(steps: tuple[Step, Step], name: str) -> float:
    """The larger of up and down."""
    return max(float(getattr(step, name)) for step in steps)


def farthest(steps: tuple[Step, Step]) -> float:
    """How far beyond the set point it came, up or down, m."""
    return _STEP * max(worst(steps, "overshoot"), 0.0)


def appendix_e() -> list[Row]:
    """The gains designed on the simplified plant, on the full model."""
    rows = []
    for key, gains in DESIGNED.items():
        named = dict(zip(GAINS, gains, strict=True))
        fast = {**named, "differentiator_corner": 1000.0}
        turned = {**named, "acceleration_gain": -gains[2]}
        own = feedback(named)
        remark = (
            f"differentiators' corner 100 rad/s, {1e3 * worst(own, 'motion'):.0f} mm of motion left; "
            f"at 1000 rad/s {1e3 * worst(feedback(fast), 'motion'):.0f} mm, with the sign of K_a "
            f"turned {1e3 * worst(feedback(turned), 'motion'):.0f} mm"
        )
        rows.append(FIGURES[key].row(farthest(own), remark))
    return rows


def proportional() -> list[Row]:
    """P control without dead-band compensation: what is left at 10, and when it stays in motion."""
    safe = _levelled(10.0)
    limit = next((g for g in _PROPORTIONAL if _levelled(float(g)).motion > 1e-3), math.nan)
    return [
        FIGURES["proportional_safe"].row(safe.motion),
        FIGURES["proportional_error"].row(safe.error),
        FIGURES["proportional_unstable"].row(float(limit), "tried in steps of 5"),
    ]


def _levelled(gain: float) -> Step:
    record = run("step_proportional", {"proportional_gain": gain})
    target = float(record.setpoint[-1, _LEADING])
    return step_of(record, 0.1, float(record.extension[0, _LEADING]), target, _LEVELLING)
