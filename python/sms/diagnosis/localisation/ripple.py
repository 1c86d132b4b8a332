"""A period in what is left along the stroke: a lead screw, a gear or a thread leaves its pitch there."""

from __future__ import annotations

import numpy as np
from scipy.signal import find_peaks

from sms.arrays import Array
from sms.diagnosis.remainder import Ripple
from sms.diagnosis.thresholds import AGREEMENT, PERIODS_IN_TRAVEL, PROMINENCE, SHORTEST_PERIOD
from sms.estimation.windows import Runs


def find_ripple(residual: Array, comparison: Runs) -> Ripple | None:
    """The period that the residual (rows,) has along the extension in every record and direction, if there is one."""
    extension, direction = comparison.inputs["extension [m]"], comparison.inputs["direction"]
    low, high = np.quantile(extension, [0.1, 0.9])
    longest = (high - low) / PERIODS_IN_TRAVEL
    if longest <= 2.0 * SHORTEST_PERIOD:
        return None
    frequency = np.arange(1.0 / longest, 1.0 / SHORTEST_PERIOD, 0.2 / (high - low))
    spectra = []
    for number in range(len(comparison.motions)):
        for sign in (-1.0, 1.0):
            rows = (
                (comparison.record == number)
                & (direction == sign)
                & (low < extension)
                & (extension < high)
            )
            if rows.sum() > 200:
                spectra.append(_amplitudes(extension[rows], residual[rows], frequency))
    if len(spectra) < 2:
        return None
    mean = np.mean(spectra, axis=0)
    best = int(np.argmax(mean))
    if mean[best] < PROMINENCE * np.median(mean) or best in (0, len(mean) - 1):
        return None
    near = np.abs(frequency / frequency[best] - 1.0) < AGREEMENT
    for spectrum in spectra:
        peaks, _ = find_peaks(spectrum)
        if len(peaks) == 0 or not near[peaks[np.argmax(spectrum[peaks])]]:
            return None
    return Ripple(float(1.0 / frequency[best]), float(mean[best]))


def _amplitudes(x: Array, y: Array, frequency: Array) -> Array:
    """Amplitude of the sine at each frequency in y(x), a smooth cubic trend taken off before."""
    trend = np.polynomial.Polynomial.fit(x, y, 3)
    wave = np.exp(-2j * np.pi * np.outer(frequency, x))
    return np.asarray(2.0 * np.abs(wave @ (y - trend(x))) / len(x))
