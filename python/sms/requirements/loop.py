"""What the loop gives: accuracy in a sea and at full range, and its bandwidth, by the whole plant."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from sms._core import Params
from sms.arrays import Array
from sms.motion.deck import faded, resampled
from sms.motion.excitation import sine
from sms.motion.sea import synthetic_deck_motion
from sms.requirements.table import ACCURACY, BANDWIDTHS, RATES, SEA_STATE, SPECIFIED, Row
from sms.simulation import extensions_of, simulate_platform
from sms.workspace_survey import DEGREE

_SEA_SECONDS = 60.0
_SMALL = 1.0 * DEGREE
_FREQUENCIES = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0)  # Hz
_TOLERANCE = 1e-5  # of the integrator
_OSCILLATES = 3.0  # times the commanded rates, RMS
_PERIODS = 4  # of a sine, the last two count


def plant_rows(
    params: Params,
    controller: str,
    height: float,
    law: str,
    progress: Callable[[str, float], None] | None = None,
) -> list[Row]:
    """Accuracy in a sea and at the specified range and rate, and the loop's bandwidth, by the plant."""
    tell = progress or (lambda text, share: None)
    tell("accuracy in sea state 2.5", 0.1)
    error, at, oscillates = _error_in_a_sea(params, controller, height, law)
    tell("accuracy at the specified range and rate", 0.4)
    fast = RATES["roll"][1] / (2.0 * math.pi * SPECIFIED.roll)
    swing = _error_of_a_sine(params, controller, height, law, SPECIFIED.roll, fast)
    tell("bandwidth", 0.6)
    frequency = 0.0 if oscillates else _loop_bandwidth(params, controller, height, law)
    limit = "stability" if oscillates else "bandwidth"
    gains = f"{controller.replace('_', ' ')} with its gains of the parameters"
    return [
        Row(
            "accuracy", "roll and pitch", ACCURACY, ACCURACY, error, "rad",
            limit if error > ACCURACY else "dead band",
            f"largest error in {_SEA_SECONDS:.0f} s of synthetic sea state {SEA_STATE:g} (seed 1), at "
            f"{at:.0f} s, under {gains}",
            smaller_is_better=True,
        ),
        Row(
            "accuracy", "roll, full range", ACCURACY, ACCURACY, swing, "rad", limit,
            f"largest error of a sine of ±{SPECIFIED.roll / DEGREE:g}° of roll at "
            f"{RATES['roll'][1] / DEGREE:g}°/s ({fast:.3f} Hz), under {gains}",
            smaller_is_better=True,
        ),
        Row(
            "bandwidth", "roll, small", *BANDWIDTHS, frequency, "Hz", limit,
            f"none: the loop oscillates on its own, under {gains}"
            if oscillates
            else f"-3 dB or 90° of lag, whichever comes first, of ±{_SMALL / DEGREE:g}° of roll under "
            f"{gains}; looked for up to {_FREQUENCIES[-1]:g} Hz",
        ),
    ]  # fmt: skip


def _followed(params: Params, controller: str, pose: Array, law: str) -> Array:
    """The poses (n, 3) that the plant reaches when it is sent `pose`, one row a control period."""
    command = extensions_of(*pose.T, params=params)
    start = tuple(float(value) for value in pose[0])
    run = simulate_platform(
        command,
        controller=controller,
        pose=start,
        valve_law=law,
        params=params,
        tolerance=_TOLERANCE,
    )
    return np.column_stack([run["roll"], run["pitch"], run["height"]])


def _error_in_a_sea(
    params: Params, controller: str, height: float, law: str
) -> tuple[float, float, bool]:
    """Largest error of roll and pitch (rad), when (s), and whether the loop oscillates on its own."""
    motion = faded(synthetic_deck_motion(SEA_STATE, _SEA_SECONDS, 1, params=params), 5.0)
    motion = resampled(motion, params.control_period)
    rest = np.full(motion.time.size, height)
    asked = np.column_stack([motion.roll, motion.pitch, rest])
    reached = _followed(params, controller, asked, law)
    error = np.abs(reached - asked)[:, :2].max(axis=1)
    row = int(np.argmax(error))
    rates = [np.std(np.diff(angles[:, :2], axis=0)) for angles in (reached, asked)]
    return float(error[row]), float(motion.time[row]), bool(rates[0] > _OSCILLATES * rates[1])


def _error_of_a_sine(
    params: Params, controller: str, height: float, law: str, amplitude: float, frequency: float
) -> float:
    """Largest error of roll and pitch, after the first period, rad."""
    asked, reached = _rolled(params, controller, height, law, amplitude, frequency)
    error = np.abs(reached - asked)[:, :2]
    return float(error[len(error) // _PERIODS :].max())


def _rolled(
    params: Params, controller: str, height: float, law: str, amplitude: float, frequency: float
) -> tuple[Array, Array]:
    """Poses commanded and reached, (n, 3), over some periods of a sine of roll."""
    count = round(_PERIODS / frequency / params.control_period)
    time = params.control_period * np.arange(float(count))
    roll = sine(time, amplitude, frequency)
    asked = np.column_stack([roll, np.zeros(count), np.full(count, height)])
    return asked, _followed(params, controller, asked, law)


def _loop_bandwidth(params: Params, controller: str, height: float, law: str) -> float:
    """Where the first harmonic of the roll has fallen by 3 dB or lags by 90 degrees, Hz."""
    before: tuple[float, float] | None = None
    for frequency in _FREQUENCIES:
        here = _worth(_harmonic(params, controller, height, law, frequency))
        if here < 0.0:
            if before is None:
                return 0.0
            share = before[1] / (before[1] - here)
            return before[0] + share * (frequency - before[0])
        before = frequency, here
    return _FREQUENCIES[-1]


def _worth(ratio: complex) -> float:
    """Above 0 while the loop follows: gain above -3 dB, lag below 90 degrees."""
    return min(
        abs(ratio) / math.sqrt(0.5) - 1.0,
        1.0 + math.atan2(ratio.imag, ratio.real) / (0.5 * math.pi),
    )


def _harmonic(
    params: Params, controller: str, height: float, law: str, frequency: float
) -> complex:
    """First harmonic of the roll reached over that commanded."""
    asked, reached = _rolled(params, controller, height, law, _SMALL, frequency)
    late = slice(len(asked) // 2, None)
    time = params.control_period * np.arange(float(len(asked)))
    turn = np.exp(-2j * math.pi * frequency * time)[late]
    return complex((reached[late, 0] @ turn) / (asked[late, 0] @ turn))
