"""What a motion must contain before an effect can be seen in it, as the catalogue's `needs` name it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sms.diagnosis.prepare import Comparison
from sms.diagnosis.result import Array

LEVELS = 1.5
"""Ratio between the largest and the smallest mean pressure of the records."""
SPEEDS = 10.0
"""Ratio between fast and slow within one record: a decade tells a slope or a Stribeck curve from a constant."""
TRAVEL = 0.25
"""Share of the stroke."""
FAST = 0.2
"""m/s: where the upturn of friction was seen (dissertation, section 6.3)."""
ACCELERATION = 0.5
"""m/s^2: below, inertia of a cylinder's own parts drowns in its friction."""


def _range(values: Array) -> tuple[float, float]:
    low, high = np.quantile(values, [0.05, 0.95])
    return float(low), float(high)


def levels(data: Comparison, stroke: float) -> str:
    pressures = [float(np.mean(m.signals["chamber_pressure_lower"][m.used])) for m in data.motions]
    if max(pressures) >= LEVELS * min(pressures):
        return ""
    return (
        f"the identify records are all at one pressure ({min(pressures) / 1e5:.2f} to "
        f"{max(pressures) / 1e5:.2f} bar); needed are levels {LEVELS:g} times apart"
    )


def both_directions(data: Comparison, stroke: float) -> str:
    direction = data.inputs["direction"]
    share = float(np.mean(direction > 0))
    return "" if 0.1 < share < 0.9 else "the rod moves one way only; needed are both directions"


def travel(data: Comparison, stroke: float) -> str:
    low, high = _range(data.inputs["extension [m]"])
    if high - low >= TRAVEL * stroke:
        return ""
    return (
        f"the rod moves over {1e3 * (high - low):.1f} mm of {1e3 * stroke:.0f} mm only; needed is a "
        "quarter of the stroke"
    )


def speeds(data: Comparison, stroke: float) -> str:
    ranges = [_range(np.abs(m.velocity[m.used])) for m in data.motions]
    low, high = max(ranges, key=lambda r: r[1] / r[0])
    if high >= SPEEDS * low:
        return ""
    return (
        f"the speeds of a record span {1e3 * low:.1f} to {1e3 * high:.1f} mm/s at most, a factor of "
        f"{high / low:.1f}; a decade is needed to tell a slope from a constant force"
    )


def break_away(data: Comparison, stroke: float) -> str:
    slowest = float(np.min(np.abs(data.inputs["velocity [m/s]"])))
    if slowest < 1e-3:
        return ""
    return f"no sample below {1e3 * slowest:.1f} mm/s is compared: the start from rest is not in the data"


def fast(data: Comparison, stroke: float) -> str:
    fastest = float(np.max(np.abs(data.inputs["velocity [m/s]"])))
    return (
        ""
        if fastest >= FAST
        else (
            f"the fastest sample moves at {1e3 * fastest:.1f} mm/s; needed are {1e3 * FAST:.0f} mm/s"
        )
    )


def accelerations(data: Comparison, stroke: float) -> str:
    values = np.concatenate([m.acceleration[m.used] for m in data.motions])
    largest = float(np.quantile(np.abs(values), 0.99))
    if largest >= ACCELERATION:
        return ""
    return (
        f"the rod hardly accelerates ({largest:.2f} m/s^2 at most); needed are "
        f"{ACCELERATION:g} m/s^2"
    )


def motion_forces(data: Comparison, stroke: float) -> str:
    if not speeds(data, stroke) and not accelerations(data, stroke):
        return ""
    return (
        "the motion is an input of this rig's force balance: an error of its sensor shows only in forces that "
        "follow speed and acceleration, and these records are too slow and even for that"
    )


CHECKS: dict[str, Callable[[Comparison, float], str]] = {
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


def missing_excitation(needs: tuple[str, ...], data: Comparison, stroke: float) -> str:
    """Why the records cannot show what needs this excitation; empty if they can."""
    return next((reason for name in needs if (reason := CHECKS[name](data, stroke))), "")
