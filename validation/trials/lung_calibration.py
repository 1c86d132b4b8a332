"""What is known of a test lung and its ventilator before a record is judged: from other records, at known settings.

Each record alone, at its true setting, gives five numbers by multiple shooting: the lung's compliance over the set one,
the resistor's drop at half a litre a second and how much of it is linear, the compliance of the hoses, the zero of the
flow reading; and the error that is left. For the record that is judged, a number is the mean over *others*, its half
width the 95 % prediction interval of one more (Student's t): scatter between records, and that the mean is of few.

- compliance over set compliance, hoses, flow zero: from the other tests of the same day, since they come from how the
  ventilator was calibrated and put together; from all other records where the day has fewer than three others.
- a resistor's drop and its linear share: from all other records with that number, of any day and gas; the scatter is
  pooled over all numbers. A number without another record: from a power law of the drop over the number, with its
  scatter.
- noise: rms of what the model leaves on the others. It is an error of the model as much as of the sensor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares
from scipy.stats import t as student
from sms.arrays import Array
from sms.diagnosis import own
from sms.diagnosis.own.shooting import ShootingProblem, Stretch

from validation.trials.lung_model import (
    CMH2O,
    ML,
    ML_PER_CMH2O,
    WINDOW,
    Known,
    Setting,
    Test,
    model,
)

FEWEST = 3
"""Other tests of a day that make a mean of its own."""
SCALES = {
    "compliance": 10.0 * ML_PER_CMH2O,
    "resistor_drop": 5.0 * CMH2O,
    "linear_share": 0.3,
    "circuit_compliance": ML_PER_CMH2O,
    "flow_zero": 10.0 * ML,
}
"""What is fitted to a record, and a change of it that matters."""


@dataclass(frozen=True)
class Calibration:
    """What one record says of the rig at its true setting. SI."""

    test: str
    day: str
    setting: Setting
    compliance_ratio: float
    """Of the set one."""
    resistor_drop: float
    linear_share: float
    circuit_compliance: float
    flow_zero: float
    rms: float
    """m^3: what is left."""


def calibrate(test: Test) -> Calibration:
    """Fit one record at its true setting."""
    start = {
        "compliance": test.truth.compliance * ML_PER_CMH2O,
        "resistor_drop": 0.5 * test.truth.resistor * CMH2O,
        "linear_share": 0.3,
        "circuit_compliance": 0.5 * ML_PER_CMH2O,
        "flow_zero": 0.0,
    }
    lung = model({name: Known(value, 0.0) for name, value in start.items()}, noise=ML)
    stretches = []
    for record in test.records:
        pressure, volume = record.signals["airway_pressure"], record.signals["volume"]
        guess = np.stack([volume, np.zeros_like(volume)], axis=1)
        step = float(record.signals["time"][1] - record.signals["time"][0])
        stretches.append(Stretch(step, pressure[:, None], volume[:, None], guess, {}))
    problem = ShootingProblem(lung, stretches, np.array([ML]), WINDOW)
    names, scale = list(SCALES), np.array(list(SCALES.values()))
    bounds = [lung.parameter(n) for n in names]
    neutral = {p.name: p.value for p in lung.parameters if p.name not in names}

    def values(x: Array) -> own.Values:
        return own.Values(**(dict(zip(names, x * scale, strict=True)) | neutral))

    def residual(x: Array) -> Array:
        return problem.errors(values(x))

    def slopes(x: Array) -> Array:
        return np.asarray(problem.evaluate(values(x), names)[1] * scale)

    found = least_squares(
        residual,
        np.array([start[n] for n in names]) / scale,
        jac=slopes,
        bounds=(
            np.array([b.lower for b in bounds]) / scale,
            np.array([b.upper for b in bounds]) / scale,
        ),
        xtol=1e-5,
        ftol=1e-5,
    )
    at = dict(zip(names, (float(v) for v in found.x * scale), strict=True))
    ratio = at.pop("compliance") / (test.truth.compliance * ML_PER_CMH2O)
    rms = ML * float(np.sqrt(np.mean(found.fun**2)))
    return Calibration(test.name, test.day, test.truth, ratio, **at, rms=rms)


def known(declared: Setting, judged: Test, calibrations: Sequence[Calibration]) -> dict[str, Known]:
    """What is declared of a lung with this setting, on the day of a record, from all others."""
    others = [c for c in calibrations if c.test != judged.name]
    same_day = [c for c in others if c.day == judged.day]
    day = same_day if len(same_day) >= FEWEST else others
    ratio = _one_more([c.compliance_ratio for c in day])
    compliance = declared.compliance * ML_PER_CMH2O
    drop, share = _resistor(declared.resistor, others)
    return {
        "compliance": Known(compliance * ratio.value, compliance * ratio.half_width),
        "resistor_drop": drop,
        "linear_share": share,
        "circuit_compliance": _one_more([c.circuit_compliance for c in day]),
        "flow_zero": _one_more([c.flow_zero for c in day]),
    }


def noise(judged: Test, calibrations: Sequence[Calibration]) -> float:
    """m^3: rms of what the model leaves on the other records."""
    left = [c.rms for c in calibrations if c.test != judged.name]
    return float(np.sqrt(np.mean(np.square(left))))


def _one_more(values: Sequence[float]) -> Known:
    """Mean, and the half width of the 95 % prediction interval of one more."""
    n = len(values)
    spread = float(np.std(values, ddof=1)) * float(np.sqrt(1.0 + 1.0 / n))
    return Known(float(np.mean(values)), float(student.ppf(0.975, n - 1)) * spread)


def _resistor(number: int, others: Sequence[Calibration]) -> tuple[Known, Known]:
    """Drop and linear share of a resistor."""
    numbers = np.array([c.setting.resistor for c in others])
    log_drop = np.log([c.resistor_drop for c in others])
    share = np.array([c.linear_share for c in others])
    same = numbers == number
    groups = np.unique(numbers)
    if np.any(same):
        design = (numbers[:, None] == groups).astype(float)
        at = (groups == number).astype(float)
    else:
        design = np.stack([np.ones(len(numbers)), np.log(numbers)], axis=1)
        at = np.array([1.0, np.log(number)])
    drop, drop_half = _predicted(design, log_drop, at)
    linear, linear_half = _predicted(design, share, at)
    value = float(np.exp(drop))
    return Known(value, value * float(np.expm1(drop_half))), Known(linear, linear_half)


def _predicted(design: Array, values: ArrayLike, at: Array) -> tuple[float, float]:
    """Ordinary least squares: the prediction of one more observation, and its 95 % half width."""
    y = np.asarray(values)
    coefficients = np.linalg.lstsq(design, y, rcond=None)[0]
    free = len(y) - design.shape[1]
    variance = float(np.sum((y - design @ coefficients) ** 2)) / free
    leverage = float(at @ np.linalg.pinv(design.T @ design) @ at)
    half = float(student.ppf(0.975, free)) * np.sqrt(variance * (1.0 + leverage))
    return float(at @ coefficients), float(half)
