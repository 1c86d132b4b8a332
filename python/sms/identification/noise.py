"""The noise of one measured signal: moments, spectrum, and whether it is white (section 5.3.1).

A stretch at rest is taken out of the record, its trend removed, and what is left described: standard
deviation, skewness, kurtosis less 3 (eq. 5.13, zero for a normal distribution), and the power
spectral density by Welch's method. White noise has no correlation from sample to sample and a flat
spectrum; its floor is what an alpha-beta filter (signal.hpp) is chosen against.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.signal
import scipy.stats

from sms import _core
from sms.arrays import Array
from sms.errors import InputError

SHORTEST = 64
"""Samples below which a spectrum says nothing."""
EVEN = 0.05
"""Of the median step: how far a step of time may be off."""


@dataclass(frozen=True)
class Spectrum:
    """Power spectral density over frequency, both (bins,)."""

    frequency: Array  #: Hz
    density: Array  #: unit^2 / Hz

    @property
    def decibel(self) -> Array:
        """dB against one unit^2 per hertz."""
        return np.asarray(10.0 * np.log10(np.maximum(self.density, 1e-300)))


@dataclass(frozen=True)
class Noise:
    """What is left of a signal when its trend is taken off. In the signal's unit."""

    samples: int
    rate: float  #: Hz
    mean: float  #: of the signal itself
    trend: float  #: per second
    sd: float
    skewness: float
    kurtosis: float  #: less 3
    normal_p: float
    """Chance of a skewness and a kurtosis so far from a normal distribution's (D'Agostino, Pearson)."""
    correlation: float
    """From one sample to the next; white noise keeps within 2 / sqrt(samples)."""
    resolution: float
    """Smallest step between two readings; 0 where readings do not repeat."""
    floor: float
    """Density of the upper half of the spectrum, dB."""
    spectrum: Spectrum
    filtered: Spectrum
    """After the alpha-beta filter."""
    filtered_sd: float

    @property
    def white(self) -> bool:
        """Whether neighbouring samples are uncorrelated, at about the 5 percent level."""
        return bool(abs(self.correlation) < 2.0 / np.sqrt(self.samples))


def noise_of(time: Array, values: Array, alpha: float = 0.25, beta: float = 0.02) -> Noise:
    """Describe a stretch at rest.

    Args:
        time: s, (n,), even steps.
        values: the signal, (n,).
        alpha, beta: of the filter whose spectrum is drawn beside; the source's for pressures.

    Raises: InputError for a stretch that is too short, uneven or constant.
    """
    n = values.size
    if n < SHORTEST:
        raise InputError(
            f"{n} samples are too few for a spectrum; {SHORTEST} are needed: widen --from, --to"
        )
    if not np.all(np.isfinite(values)):
        raise InputError(
            "the stretch holds cells that are not numbers; choose another with --from, --to"
        )
    step = np.diff(time)
    dt = float(np.median(step))
    if not dt > 0.0 or np.median(np.abs(step / dt - 1.0)) > EVEN:
        raise InputError(
            "the steps of time are uneven; a spectrum needs one rate: resample the record"
        )
    if np.ptp(values) == 0.0:
        raise InputError(
            "the signal does not change in this stretch: there is no noise to describe"
        )
    left = scipy.signal.detrend(values, type="linear")
    slope = float(np.polyfit(time - time[0], values, 1)[0])
    smooth, _ = _core.alpha_beta(values, dt, alpha, beta, float(values[0]))
    settled = scipy.signal.detrend(smooth[min(n // 10, round(5.0 / beta)) :], type="linear")
    spectrum = _spectrum(left, 1.0 / dt)
    upper = spectrum.density[spectrum.frequency > 0.25 / dt]
    gaps = np.unique(np.abs(np.diff(np.unique(values))))
    repeats = np.unique(values).size < 0.5 * n
    return Noise(
        samples=n,
        rate=1.0 / dt,
        mean=float(values.mean()),
        trend=slope,
        sd=float(left.std(ddof=2)),
        skewness=float(scipy.stats.skew(left)),
        kurtosis=float(scipy.stats.kurtosis(left)),
        normal_p=float(scipy.stats.normaltest(left).pvalue),
        correlation=float(left[1:] @ left[:-1] / (left @ left)),
        resolution=float(gaps[gaps > 0.0].min()) if repeats and gaps.size else 0.0,
        floor=float(10.0 * np.log10(np.mean(upper))),
        spectrum=spectrum,
        filtered=_spectrum(settled, 1.0 / dt),
        filtered_sd=float(settled.std()),
    )


def _spectrum(values: Array, rate: float) -> Spectrum:
    segment = max(min(values.size // 4, 1024), SHORTEST // 2)
    frequency, density = scipy.signal.welch(values, rate, nperseg=segment)
    return Spectrum(np.asarray(frequency)[1:], np.asarray(density)[1:])
