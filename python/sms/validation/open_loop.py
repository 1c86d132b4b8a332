"""The 18 open-loop runs (section 7.3.4).

The measured records are not published, only how well the simulation met them: eq. 7.2 for the
pressures of one run, and travels that differ by 14 % (section 9.1.4). Eq. 7.2 takes the mean out
and divides by both signals' sizes. To see what it can tell, each run is repeated with a twin whose
mass-flow gain is such that it travels as much further as the measured platform did.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq
from scipy.signal import detrend

from sms._core import Params
from sms.arrays import Array
from sms.comparison import compare_signals, normalised_cross_correlation, rising_flanks
from sms.scenario import Record
from sms.validation.figures import FIGURES, Row
from sms.validation.runs import run, sample

FREQUENCIES = 0.3, 0.5, 0.8  # Hz
AMPLITUDES = 0.7, 0.8, 0.9  # V
PATTERNS = {"heave": (1.0, 1.0, 1.0), "roll": (0.0, 1.0, -1.0)}
_BEGIN = 0.73  # s
_AMPLITUDE_RATIO = 0.86  # simulated over measured, section 9.1.4
_TWIN_GAINS = 1.5, 3.0
_LEADING = 1  # actuator 2
_FLANK = (
    0.0,
    0.85,
)  # periods after the command's change of sign: the flank, not the bounce before it


def excited(pattern: str, amplitude: float, frequency: float, gain: float | None = None) -> Record:
    """One of the 18 runs."""
    volts = [f"{share * amplitude} V" for share in PATTERNS[pattern]]
    parameters = None if gain is None else {"mass_flow_gain": gain}
    excitation = {"amplitude": volts, "frequency": f"{frequency} Hz"}
    return run(f"open_loop_{pattern}", parameters, excitation=excitation)


def rise_time(record: Record, frequency: float) -> float:
    """Median 10 to 90 % rise time of actuator 2 in the open loop, s; a slow drift does not matter."""
    period = 1.0 / frequency
    found = []
    for turn in np.arange(1.0, (record.time[-1] - _BEGIN) * frequency - 1.0):
        rows = (sample(record, _BEGIN + (turn + shift) * period) for shift in _FLANK)
        part = slice(*rows)
        flanks = rising_flanks(record.time[part], record.extension[part, _LEADING])
        found += list(flanks[:1, 1])
    return float(np.median(found)) if found else math.nan


def runs() -> list[Row]:
    """All 18, and their twins."""
    gain = _twin_gain()
    pairs = {
        (pattern, amplitude, frequency): (
            excited(pattern, amplitude, frequency, gain),
            excited(pattern, amplitude, frequency),
        )
        for pattern in PATTERNS
        for amplitude in AMPLITUDES
        for frequency in FREQUENCIES
    }
    shown = "roll", 0.9, 0.5
    twin = (
        f"the twin has a mass-flow gain of {gain:.2f} instead of {Params().mass_flow_gain:g}, so that "
        "its travel differs as published"
    )
    correlations = {key: _correlations(*pair) for key, pair in pairs.items()}
    ratios = {key: _amplitude_ratio(*pair) for key, pair in pairs.items()}
    worst = min(correlations, key=lambda key: min(correlations[key]))
    farthest = max(ratios, key=lambda key: abs(math.log(ratios[key])))
    unknown = "the frequency of the printed run is not stated"
    return [
        FIGURES["open_loop_rise_slow"].row(rise_time(pairs["roll", 0.9, 0.3][1], 0.3), unknown),
        FIGURES["open_loop_rise"].row(rise_time(pairs[shown][1], 0.5), unknown),
        FIGURES["open_loop_correlation_lower"].row(correlations[shown][0], twin),
        FIGURES["open_loop_correlation_upper"].row(correlations[shown][1], twin),
        FIGURES["open_loop_all"].row(min(correlations[worst]), f"{_words(worst)}; {twin}"),
        FIGURES["open_loop_all_amplitude"].row(ratios[farthest], f"{_words(farthest)}; {twin}"),
    ]


def _twin_gain() -> float:
    """The mass-flow gain with which the roll at 0.5 Hz travels as much further as the measured one."""
    own = excited("roll", 0.9, 0.5)

    def surplus(gain: float) -> float:
        return _amplitude_ratio(excited("roll", 0.9, 0.5, gain), own) - _AMPLITUDE_RATIO

    return float(brentq(surplus, *_TWIN_GAINS, xtol=1e-3))


def _part(record: Record, values: Array) -> Array:
    return np.asarray(values[sample(record, _BEGIN) :, _LEADING])


def _correlations(measured: Record, simulated: Record) -> tuple[float, float]:
    """Of the lower and the upper pressure of actuator 2, in the open loop."""
    lower, upper = (
        normalised_cross_correlation(
            _part(measured, getattr(measured, name)), _part(simulated, getattr(simulated, name))
        )
        for name in ("chamber_pressure_lower", "chamber_pressure_upper")
    )
    return lower, upper


def _amplitude_ratio(measured: Record, simulated: Record) -> float:
    time = measured.time[sample(measured, _BEGIN) :]
    one, other = (detrend(_part(run, run.extension)) for run in (measured, simulated))
    return compare_signals(time, one, other).amplitude_ratio


def _words(key: tuple[str, float, float]) -> str:
    pattern, amplitude, frequency = key
    return f"{pattern}, {amplitude} V, {frequency} Hz"
