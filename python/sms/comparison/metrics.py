"""How alike two signals are, in numbers that do not hide what others do.

Every ratio is simulated over measured, and a positive lag means that the simulation is late. The
source's metric, the normalised cross-correlation at lag 0 of the signals without their trends
(eq. 7.2), is blind to gain: a simulation of half the amplitude scores 1. So it never stands alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.signal import coherence as coherence_of
from scipy.signal import correlate, csd, detrend, welch

from sms.arrays import Array

_SWING = 0.4  # of the whole range: a smaller turn is no flank
_LONGEST_LAG = 0.25  # of the record
_EQUAL_PEAKS = 0.1  # of what two signals are not alike at their best lag; peaks within are as good
_NOTHING = 1e-12  # of a signal's power: what is left of it by rounding
_EXCITED = 1e-5  # of the largest power density of the source; below it a ratio means nothing
_SEGMENTS = 8  # of the record, for a frequency response; they overlap by half


@dataclass(frozen=True)
class Metrics:
    """One signal, simulated against measured. Differences in the signal's unit."""

    samples: int
    mean_absolute_error: float
    rms_error: float
    largest_error: float
    largest_error_at: float  #: s
    offset: float  #: mean of simulated less measured
    amplitude_ratio: float  #: standard deviation, simulated over measured
    rise_time_measured: float  #: 10 to 90 % of the first rising flank, s; NaN without one
    rise_time_simulated: float  #: of the flank of the simulation nearest to that one, s
    rise_time_ratio: float  #: of these two, simulated over measured
    rise_time_ratio_median: float  #: over all rising flanks so paired
    correlation: float  #: eq. 7.2 at lag 0; blind to gain
    lag: float  #: at which the correlation is largest, s; positive: the simulation is late
    correlation_at_lag: float


@dataclass(frozen=True)
class FrequencyResponse:
    """One signal over another, by Welch's method; (k,) each."""

    frequency: Array  #: Hz
    gain: Array  #: amplitude ratio
    phase: Array  #: rad
    coherence: Array  #: 0 to 1; near 0 the gain means nothing


def compare_signals(time: Array, measured: Array, simulated: Array) -> Metrics:
    """All metrics of two signals at the same, evenly spaced times (n,). ValueError below 8 samples."""
    if time.size < 8 or not (time.size == measured.size == simulated.size):
        raise ValueError("measured and simulated have to share their times, 8 samples at least")
    step = float(time[1] - time[0])
    error = simulated - measured
    worst = int(np.argmax(np.abs(error)))
    deviation = float(np.std(measured))
    rise = _paired_rises(rising_flanks(time, measured), rising_flanks(time, simulated))
    lag, best = _lag(measured, simulated, step)
    return Metrics(
        samples=int(time.size),
        mean_absolute_error=float(np.mean(np.abs(error))),
        rms_error=float(np.sqrt(np.mean(error**2))),
        largest_error=float(error[worst]),
        largest_error_at=float(time[worst]),
        offset=float(np.mean(error)),
        amplitude_ratio=float(np.std(simulated)) / deviation if deviation > 0.0 else math.nan,
        rise_time_measured=float(rise[0, 0]),
        rise_time_simulated=float(rise[0, 1]),
        rise_time_ratio=float(rise[0, 1] / rise[0, 0]),
        rise_time_ratio_median=float(np.median(rise[:, 1] / rise[:, 0])),
        correlation=normalised_cross_correlation(measured, simulated),
        lag=lag,
        correlation_at_lag=best,
    )


def normalised_cross_correlation(x: Array, y: Array) -> float:
    """Eq. 7.2 at lag 0 of both signals without their linear trends; NaN for a constant one.

    1 is alike but for gain and offset, 0 unlike, -1 opposite.
    """
    x, y = detrend(x), detrend(y)
    size = math.sqrt(float(x @ x) * float(y @ y))
    return float(x @ y) / size if size > 0.0 else math.nan


def rising_flanks(time: Array, signal: Array) -> Array:
    """When each rising flank passes half its height, and its rise time from 10 to 90 %, s, (k, 2).

    A flank spans at least 40 % of the signal's range. One that the record cuts off at either end
    counts only when there is no other.
    """
    turns = pairwise(_turning_points(signal))
    flanks = [(low, high) for low, high in turns if signal[high] > signal[low]]
    whole = [(low, high) for low, high in flanks if low > 0 and high < signal.size - 1]
    found = [_rise(time[a : b + 1], signal[a : b + 1]) for a, b in whole or flanks]
    return np.array(found).reshape(-1, 2)


def frequency_response(
    source: Array, answer: Array, period: float, segment: int | None = None
) -> FrequencyResponse:
    """`answer` over `source`, sampled every `period` s: cross spectrum over power spectrum.

    Welch's method with Hann windows, eight half-overlapping segments unless `segment` (samples)
    says otherwise. Where the source has no power, gain and coherence are 0.
    """
    length = segment or min(source.size, max(8, 2 * source.size // (_SEGMENTS + 1)))
    rate = 1.0 / period
    frequency, cross = csd(source, answer, rate, nperseg=length)
    _, power = welch(source, rate, nperseg=length)
    excited = power > _EXCITED * power.max()
    with np.errstate(divide="ignore", invalid="ignore"):  # of what has no power
        _, coherence = coherence_of(source, answer, rate, nperseg=length)
        ratio = np.where(excited, cross / power, 0.0)[1:]
    return FrequencyResponse(
        frequency=np.asarray(frequency)[1:],
        gain=np.abs(ratio),
        phase=np.unwrap(np.angle(ratio)),
        coherence=np.where(excited, np.nan_to_num(coherence), 0.0)[1:],
    )


def _turning_points(signal: Array) -> list[int]:
    """Where the signal turns by more than the swing, ends included; low and high in turn.

    The foot of a flank is the last sample of a rest before it, its head the first of one after.
    """
    swing = _SWING * float(np.ptp(signal))
    if swing <= 0.0:
        return []
    turns: list[int] = []
    low = high = 0
    direction = 0  # not known yet
    for i, value in enumerate(signal):
        low = i if value <= signal[low] else low
        high = i if value > signal[high] else high
        if direction <= 0 and value - signal[low] > swing:
            turns.append(low)
            direction, high = 1, i
        elif direction >= 0 and signal[high] - value > swing:
            turns.append(high)
            direction, low = -1, i
        if direction > 0:
            low = i  # the next foot is not before the head
        elif direction < 0:
            high = i
    turns.append(high if direction > 0 else low)
    return turns


def _rise(time: Array, flank: Array) -> tuple[float, float]:
    base, top = float(flank[0]), float(flank[-1])
    low, middle, high = (
        _first_crossing(time, flank, base + share * (top - base)) for share in (0.1, 0.5, 0.9)
    )
    return middle, high - low


def _paired_rises(measured: Array, simulated: Array) -> Array:
    """Rise times of each measured flank and of the simulated one nearest in time, (k, 2)."""
    if not (measured.size and simulated.size):
        return np.full((1, 2), math.nan)
    nearest = np.abs(measured[:, :1] - simulated[:, 0]).argmin(axis=1)
    return np.column_stack([measured[:, 1], simulated[nearest, 1]])


def _first_crossing(time: Array, flank: Array, level: float) -> float:
    row = int(np.argmax(flank >= level))
    if row == 0:
        return float(time[0])
    share = (level - flank[row - 1]) / (flank[row] - flank[row - 1])
    return float(time[row - 1] + share * (time[row] - time[row - 1]))


def _lag(measured: Array, simulated: Array, step: float) -> tuple[float, float]:
    """The lag of the largest correlation, refined by a parabola, and the correlation there.

    Of peaks that are as good as equal, as those of a periodic signal are, the nearest to 0.
    """
    most = max(1, int(_LONGEST_LAG * measured.size))
    near = _correlation_by_lag(measured, simulated, most)
    if not np.any(np.isfinite(near)):
        return math.nan, math.nan
    near = np.where(np.isfinite(near), near, -1.0)
    padded = np.concatenate(([-1.0], near, [-1.0]))
    peaks = np.flatnonzero((near >= padded[:-2]) & (near >= padded[2:]))
    shift, height = np.transpose([_vertex(near, int(peak)) for peak in peaks])
    highest = float(height.max())
    equal = height >= highest - _EQUAL_PEAKS * (1.0 - highest) - _EQUAL_PEAKS / 100.0
    lags = (peaks + shift - most)[equal]
    nearest = int(np.argmin(np.abs(lags)))
    return float(lags[nearest]) * step, min(float(height[equal][nearest]), 1.0)


def _vertex(values: Array, peak: int) -> tuple[float, float]:
    """How far from a peak's sample the parabola through it and its neighbours is highest, and how high."""
    here = float(values[peak])
    if not 0 < peak < values.size - 1:
        return 0.0, here
    left, right = float(values[peak - 1]), float(values[peak + 1])
    bend = left - 2.0 * here + right
    shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
    return shift, here - 0.25 * (left - right) * shift


def _correlation_by_lag(x: Array, y: Array, most: int) -> Array:
    """(2 most + 1,): eq. 7.2 of x and of y that is k samples late, k = -most .. most, over their overlap.

    Line and mean are those of the overlap too. Padded with zeros instead, signals that rest at their ends would be
    most alike where no end is lost, at lag 0.
    """
    n = x.size
    x, y = x - np.mean(x), y - np.mean(y)  # so that sums lose no digits
    lag = np.arange(-most, most + 1)
    first, last = np.maximum(-lag, 0), n - np.maximum(lag, 0)  # of x; those of y are `lag` later
    count = (last - first).astype(float)
    centre, spread = 0.5 * (first + last - 1), count * (count**2 - 1.0) / 12.0

    def moments(values: Array, late: NDArray[np.int64]) -> tuple[Array, Array, Array]:
        """Sum, sum of squares, and sum of products with the time from the middle of the overlap."""
        total, square, product = (
            np.concatenate(([0.0], np.cumsum(v)))
            for v in (values, values**2, values * np.arange(n))
        )
        a, b = first + late, last + late
        plain = total[b] - total[a]
        return plain, square[b] - square[a], product[b] - product[a] - (centre + late) * plain

    (sum_x, square_x, slope_x), (sum_y, square_y, slope_y) = moments(x, 0 * lag), moments(y, lag)
    both = correlate(y, x, "full")[n - 1 - most : n + most]
    left_x = square_x - sum_x**2 / count - slope_x**2 / spread
    left_y = square_y - sum_y**2 / count - slope_y**2 / spread
    shared = both - sum_x * sum_y / count - slope_x * slope_y / spread
    known = (left_x > _NOTHING * square_x.max()) & (left_y > _NOTHING * square_y.max())
    return np.where(known, shared / np.sqrt(np.where(known, left_x * left_y, 1.0)), np.nan)
