"""What a cause means to whoever uses the machine: rise time, bandwidth and error of following, without it and with it.

Both models follow the same set-points under the same controller, a position loop in proportion to the error. Nothing is
measured here: it is what either model predicts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import radians

import numpy as np

from sms import _core, simulation
from sms.arrays import Array
from sms.comparison.metrics import frequency_response
from sms.diagnosis.result import InUse
from sms.io.rig import Rig

PERIOD = 1e-3
"""s, of the controller."""
LOOP_GAIN = 10.0
"""V/m."""
REST, LENGTH = 0.5, 3.0
"""s: before a step, and of the run."""
STEP = 0.04
"""m"""
TILT = radians(3.0)
HEIGHT = 0.5
"""m: of the platform, about mid-stroke."""
SWEEP, SLOWEST, FASTEST = 16.0, 0.2, 4.0
"""s, Hz, Hz"""
CALM = 1.0
"""Hz: up to here the error of following is told; beyond it the loop is what fails."""
SEGMENT = 4.0
"""s, of the spectra: their resolution is its inverse."""
HALF_POWER = 0.5**0.5

Follow = Callable[[Array], Array]
"""From a set-point (n,), zero at the beginning, to what the machine does, (n,)."""


def in_use(rig: Rig, baseline: _core.Params, extended: _core.Params) -> tuple[InUse, ...]:
    """The quantities of this kind of rig, by either model; none where a model does not get through its run."""
    if rig.kind not in _FOLLOW:
        return ()
    follow, size, unit, name = _FOLLOW[rig.kind]
    try:
        old, new = (_quantities(follow(rig, p), size) for p in (baseline, extended))
    except _core.StatusError:
        return ()
    named = (
        (f"rise time of the {name}", "s"),
        (f"bandwidth of the {name}", "Hz"),
        (f"error of the {name}, following below {CALM:g} Hz", unit),
    )
    return tuple(InUse(n, u, a, b) for (n, u), a, b in zip(named, old, new, strict=True))


def _quantities(follow: Follow, size: float) -> tuple[float, float, float]:
    """Rise time, s; bandwidth, Hz; root mean square of the error in the calm part of a sweep."""
    time = np.arange(0.0, LENGTH, PERIOD)
    answer = follow(np.where(time < REST, 0.0, size))
    setpoint = _sweep(0.25 * size)
    followed = follow(setpoint)
    calm = slice(round(SWEEP * (CALM - SLOWEST) / (FASTEST - SLOWEST) / PERIOD))
    return (
        rise_time(time, answer - answer[0], size),
        bandwidth(setpoint, followed),
        float(np.sqrt(np.mean((setpoint - followed)[calm] ** 2))),
    )


def rise_time(time: Array, answer: Array, size: float) -> float:
    """s from 10 to 90 percent of a step; NaN if it does not get there."""
    ends = []
    for share in (0.1, 0.9):
        over = answer >= share * size
        if not over.any():
            return float("nan")
        k = int(np.argmax(over))
        ends.append(float(np.interp(share * size, answer[k - 1 : k + 1], time[k - 1 : k + 1])))
    return ends[1] - ends[0]


def bandwidth(setpoint: Array, answer: Array) -> float:
    """Hz at which the answer has fallen by 3 dB; the fastest that was asked for if it has not."""
    found = frequency_response(setpoint, answer, PERIOD, round(SEGMENT / PERIOD))
    asked = (found.frequency > 2.0 * SLOWEST) & (found.frequency <= FASTEST)
    frequency, gain = found.frequency[asked], found.gain[asked]
    fallen = gain < HALF_POWER
    if not fallen.any():
        return FASTEST
    k = max(int(np.argmax(fallen)), 1)
    return float(np.interp(-HALF_POWER, -gain[k - 1 : k + 1], frequency[k - 1 : k + 1]))


def _sweep(size: float) -> Array:
    """From slow to fast, the frequency in proportion to the time."""
    time = np.arange(0.0, SWEEP, PERIOD)
    rate = (FASTEST - SLOWEST) / SWEEP
    return np.asarray(size * np.sin(2.0 * np.pi * (SLOWEST * time + 0.5 * rate * time**2)))


# ---- kinds -------------------------------------------------------------------------------------


def _bench(rig: Rig, params: _core.Params) -> Follow:
    machine = params.copy()
    machine["proportional_gain"] = LOOP_GAIN
    middle = 0.5 * float(params["stroke"])

    def follow(setpoint: Array) -> Array:
        run = simulation.simulate_bench(
            middle + setpoint,
            controller="pid",
            params=machine,
            valve_law=rig.model.valve,
            friction_law=rig.model.friction,
            chamber_law=rig.model.chambers,
            tolerance=1e-5,
        )
        return np.asarray(run["extension"] - middle)

    return follow


def _platform(rig: Rig, params: _core.Params) -> Follow:
    assert isinstance(params, _core.LegParams)
    machine = params.copy()
    machine["proportional_gain"] = LOOP_GAIN

    def follow(setpoint: Array) -> Array:
        level = np.zeros(len(setpoint))
        run = simulation.simulate_platform(
            simulation.extensions_of(setpoint, level, HEIGHT + level, params=machine.legs[0]),
            controller="pid",
            pose=(0.0, 0.0, HEIGHT),
            params=machine.legs,
            valve_law=rig.model.valve,
            friction_law=rig.model.friction,
            chamber_law=rig.model.chambers,
            tolerance=1e-3,
        )
        return np.asarray(run["roll"])

    return follow


_FOLLOW: Mapping[str, tuple[Callable[[Rig, _core.Params], Follow], float, str, str]] = {
    "bench": (_bench, STEP, "m", "position"),
    "platform": (_platform, TILT, "rad", "attitude"),
}
"""Kind -> its runs, the size of a step, its unit, and what it is called."""
