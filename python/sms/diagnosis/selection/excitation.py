"""What a motion must contain before an effect can be seen in it, as the catalogue's `needs` name it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sms.arrays import Array
from sms.diagnosis.thresholds import (
    FAST_COMMAND,
    FAST_MOTION,
    LEAST_ACCELERATION,
    PRESSURE_LEVELS,
    SMALL_OPENING,
    SPEED_RATIO,
    TRAVEL_SHARE,
)
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.signals import without_leg
from sms.rigs.cylinder import motions_of


def _range(values: Array) -> tuple[float, float]:
    low, high = np.quantile(values, [0.05, 0.95])
    return float(low), float(high)


def levels(data: Runs, stroke: float) -> str:
    pressures = [
        float(np.mean(m.signals["chamber_pressure_lower"][m.used])) for m in motions_of(data)
    ]
    if max(pressures) >= PRESSURE_LEVELS * min(pressures):
        return ""
    return (
        f"the identify records are all at one pressure ({min(pressures) / 1e5:.2f} to "
        f"{max(pressures) / 1e5:.2f} bar); needed are levels {PRESSURE_LEVELS:g} times apart"
    )


def both_directions(data: Runs, stroke: float) -> str:
    direction = data.inputs["direction"]
    share = float(np.mean(direction > 0))
    return "" if 0.1 < share < 0.9 else "the rod moves one way only; needed are both directions"


def travel(data: Runs, stroke: float) -> str:
    low, high = _range(data.inputs["extension [m]"])
    if high - low >= TRAVEL_SHARE * stroke:
        return ""
    return (
        f"the rod moves over {1e3 * (high - low):.1f} mm of {1e3 * stroke:.0f} mm only; needed is a "
        "quarter of the stroke"
    )


def speeds(data: Runs, stroke: float) -> str:
    ranges = [_range(np.abs(m.velocity[m.used])) for m in motions_of(data)]
    low, high = max(ranges, key=lambda r: r[1] / r[0])
    if high >= SPEED_RATIO * low:
        return ""
    return (
        f"the speeds of a record span {1e3 * low:.1f} to {1e3 * high:.1f} mm/s at most, a factor of "
        f"{high / low:.1f}; a decade is needed to tell a slope from a constant force"
    )


def break_away(data: Runs, stroke: float) -> str:
    slowest = float(np.min(np.abs(data.inputs["velocity [m/s]"])))
    if slowest < 1e-3:
        return ""
    return f"no sample below {1e3 * slowest:.1f} mm/s is compared: the start from rest is not in the data"


def fast(data: Runs, stroke: float) -> str:
    fastest = float(np.max(np.abs(data.inputs["velocity [m/s]"])))
    return (
        ""
        if fastest >= FAST_MOTION
        else (
            f"the fastest sample moves at {1e3 * fastest:.1f} mm/s; needed are {1e3 * FAST_MOTION:.0f} mm/s"
        )
    )


def accelerations(data: Runs, stroke: float) -> str:
    values = np.concatenate([m.acceleration[m.used] for m in motions_of(data)])
    largest = float(np.quantile(np.abs(values), 0.99))
    if largest >= LEAST_ACCELERATION:
        return ""
    return (
        f"the rod hardly accelerates ({largest:.2f} m/s^2 at most); needed are "
        f"{LEAST_ACCELERATION:g} m/s^2"
    )


def motion_forces(data: Runs, stroke: float) -> str:
    if not speeds(data, stroke) and not accelerations(data, stroke):
        return ""
    return (
        "the motion is an input of this rig's force balance: an error of its sensor shows only in forces that "
        "follow speed and acceleration, and these records are too slow and even for that"
    )


CHECKS: dict[str, Callable[[Runs, float], str]] = {
    check.__name__: check
    for check in (
        levels,
        both_directions,
        travel,
        speeds,
        break_away,
        fast,
        accelerations,
        motion_forces,
    )
}


# ---- records that a simulation is held against ------------------------------------------------------------


def motion(data: Runs, stroke: float) -> str:
    moved = max(
        float(np.ptp(values))
        for m in data.motions
        for n, values in m.signals.items()
        if n == "tank_pressure" or without_leg(n) == "extension"
    )
    return "" if moved > 0.0 else "nothing moves in the identify records"


def _extensions(data: Runs) -> list[tuple[Run, str]]:
    """Every piston's position in every run."""
    return [(m, n) for m in data.motions for n in m.signals if without_leg(n) == "extension"]


def _velocities(data: Runs) -> list[Array]:
    return [m.rate(n) for m, n in _extensions(data)]


def _commands(data: Runs) -> list[tuple[Run, Array]]:
    return [
        (m, m.signals[n]) for m in data.motions for n in m.signals if n.startswith("valve_command")
    ]


def small_openings(data: Runs, stroke: float) -> str:
    centre = data.rig.declared("valve_centre").value
    share = [float(np.mean(np.abs(c - centre) < SMALL_OPENING)) for _, c in _commands(data)]
    if not share or max(share) > 0.05:  # a command that was not recorded may have been anything
        return ""
    return f"the command is hardly ever within {SMALL_OPENING:g} V of the valve's centre, where a dead band is felt"


def fast_commands(data: Runs, stroke: float) -> str:
    changes = [float(np.max(np.abs(np.diff(c))) / m.step) for m, c in _commands(data)]
    fastest = max(changes, default=np.inf)
    if fastest > FAST_COMMAND:
        return ""
    return f"the command changes by {fastest:.2g} V/s at most; needed are {FAST_COMMAND:g} V/s"


def reversals(data: Runs, stroke: float) -> str:
    share = float(np.mean(np.concatenate(_velocities(data)) > 0.0))
    return "" if 0.05 < share < 0.95 else "the rod moves one way only; needed are reversals"


def long_travel(data: Runs, stroke: float) -> str:
    span = max(float(np.ptp(m.signals[n])) for m, n in _extensions(data))
    if span >= TRAVEL_SHARE * stroke:
        return ""
    return f"the rod moves over {1e3 * span:.1f} mm of {1e3 * stroke:.0f} mm only; needed is a quarter of the stroke"


def fast_motion(data: Runs, stroke: float) -> str:
    fastest = float(np.quantile(np.abs(np.concatenate(_velocities(data))), 0.999))
    if fastest >= FAST_MOTION:
        return ""
    return f"the rod moves at {1e3 * fastest:.0f} mm/s at most; needed are {1e3 * FAST_MOTION:.0f} mm/s"


def accelerated(data: Runs, stroke: float) -> str:
    largest = max(
        float(np.quantile(np.abs(np.gradient(m.rate(n), m.step)), 0.99))
        for m, n in _extensions(data)
    )
    if largest >= LEAST_ACCELERATION:
        return ""
    return f"the rod hardly accelerates ({largest:.2f} m/s^2 at most); needed are {LEAST_ACCELERATION:g} m/s^2"


def ends(data: Runs, stroke: float) -> str:
    cushion = data.rig.declared("cushion_length").value
    nearest = min(
        min(float(m.signals[n].min()), stroke - float(m.signals[n].max()))
        for m, n in _extensions(data)
    )
    if nearest < 0.8 * cushion:
        return ""
    return (
        f"the piston stays {1e3 * nearest:.0f} mm from either end, where a cushion of {1e3 * cushion:.0f} mm is "
        "not felt"
    )


def closed_loop(data: Runs, stroke: float) -> str:
    if data.rig.control.loop == "closed" and data.rig.control.controller == "simulated":
        return ""
    return "the valve's command is taken from the records, so the controller is not part of the simulation"


RUN_CHECKS: dict[str, Callable[[Runs, float], str]] = {
    "motion": motion,
    "small_openings": small_openings,
    "fast_commands": fast_commands,
    "reversals": reversals,
    "travel": long_travel,
    "fast": fast_motion,
    "accelerations": accelerated,
    "ends": ends,
    "closed_loop": closed_loop,
}


def missing_excitation(needs: tuple[str, ...], data: Runs, stroke: float) -> str:
    """Why the records cannot show what needs this excitation; empty if they can."""
    if data.whitened:
        return next((reason for n in needs if (reason := RUN_CHECKS[n](data, stroke))), "")
    return next((reason for name in needs if (reason := CHECKS[name](data, stroke))), "")
