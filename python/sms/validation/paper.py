"""What the source computes on paper: dead-band compensation, simplified plant, its controllers."""

from __future__ import annotations

import math

import numpy as np
from scipy.signal import step

from sms import _core
from sms._core import Params
from sms.validation.figures import FIGURES, Row
from sms.validation.runs import crossing

# The plant behind the printed gains: not the one printed beside them (SPEC, appendix E).
_FREQUENCY, _GAIN, _MASS = 26.221, 0.7, 106.0  # rad/s, m/s per V, kg
_PRINTED_FREQUENCY, _PRINTED_GAIN = 15.139, 0.85
_SITUM_RATIO = 1.5
_SPECIFIED_RATIO = 21.3891 / _FREQUENCY  # the printed corner over the frequency that fits
_CHAPTER_GAIN = 0.85  # m/s per V, section 8.1
_SUM_PRESSURE, _MEAN_PRESSURE = 667e3, 333.5e3  # Pa


def dead_band() -> list[Row]:
    """Eq. 7.6 and 7.7 with b = 0.8 V, c = 100 1/V."""
    params = Params()
    return [
        FIGURES["dead_band_a"].row(_core.dead_band_coefficient(params)),
        FIGURES["dead_band_peak"].row(float(_core.dead_band_gain(params, 0.0))),
    ]


def appendix_e() -> list[Row]:
    """The gains of Table E.1 from eq. 8.8 to 8.10 and 8.13 to 8.15."""
    plant = _GAIN, _FREQUENCY, _damping(_FREQUENCY)
    situm = _core.gains_situm(*plant, _SITUM_RATIO, True)
    specified = _core.gains_specification_based(*plant, _SPECIFIED_RATIO)
    names = "position", "velocity", "acceleration"
    read = f"with w_s = {_FREQUENCY} rad/s and C_0 = {_GAIN}, not the values printed beside them"
    rows = []
    for name, value in zip(names, situm, strict=True):
        remark = f"{read}; eq. 8.9 as printed" if name == "velocity" else read
        rows.append(FIGURES[f"situm_{name}"].row(value, remark))
    for name, value in zip(names, specified, strict=True):
        remark = f"{read}; ratio {_SPECIFIED_RATIO:.4f}"
        rows.append(FIGURES[f"specified_{name}"].row(value, remark))
    printed = _PRINTED_GAIN, _PRINTED_FREQUENCY, _damping(_PRINTED_FREQUENCY)
    own = _core.gains_situm(*printed, _SITUM_RATIO, True)[0]
    remark = f"with w_s = {_PRINTED_FREQUENCY} rad/s and C_0 = {_PRINTED_GAIN} as printed"
    return [*rows, FIGURES["situm_as_printed"].row(own, remark)]


def simplified_plant() -> list[Row]:
    """Table D.1, and the loop closed by P = 2 at 1 Hz."""
    params = Params()
    printed = _core.simplified_plant(params, _SUM_PRESSURE, _MASS)[0]
    mean = _core.simplified_plant(params, _MEAN_PRESSURE, _MASS)[0]
    loop = _core.closed_loop(_CHAPTER_GAIN, _FREQUENCY, _damping(_FREQUENCY), 2.0)
    gain, phase = (float(np.ravel(v)[0]) for v in _core.frequency_response(*loop, np.array([1.0])))
    sum_not_mean = "the printed mean pressure, 667 kPa, is the sum of 281 and 386"
    return [
        FIGURES["natural_frequency"].row(printed, sum_not_mean),
        FIGURES["natural_frequency_mean"].row(mean, sum_not_mean),
        FIGURES["simplified_gain"].row(20.0 * math.log10(gain)),
        FIGURES["simplified_phase"].row(math.degrees(phase)),
    ]


def linear_steps() -> list[Row]:
    """Step responses of the simplified plant under the printed gains."""
    plant = _GAIN, _FREQUENCY, _damping(_FREQUENCY)
    rows = []
    for name, gains in (
        ("situm", (15.8031, 1.3393, 0.1123)),
        ("specified", (3.9128, -0.478, 0.0666)),
    ):
        square, linear, constant = _core.closed_loop(*plant, *gains)
        system = np.array([constant]), np.array([1.0, square, linear, constant])
        time, value = step(system, T=np.linspace(0.0, 3.0, 6001))
        rise = crossing(time, value, 0.9) - crossing(time, value, 0.1)
        remark = "printed gains on the plant they belong to"
        rows.append(FIGURES[f"linear_rise_{name}"].row(rise, remark))
        overshoot = max(float(value.max()) - 1.0, 0.0)
        rows.append(FIGURES[f"linear_overshoot_{name}"].row(overshoot, remark))
    return rows


def _damping(frequency: float) -> float:
    """zeta of eq. 8.3 with the published viscous friction."""
    return Params().viscous_friction / (2.0 * _MASS * frequency)
