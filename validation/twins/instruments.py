"""From the true signals to what a logger writes: lag, clock, gain, noise, converter steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.signal import lfilter

from validation.twins.air import Array


@dataclass(frozen=True)
class Channel:
    """Noise (standard deviations) and converter step of one kind of signal, in its unit."""

    unit: str
    white: float
    coloured: float
    correlation_time: float  # s, of the coloured part
    step: float

    @property
    def deviation(self) -> float:
        """Standard deviation of one sample, all causes together."""
        return float(np.sqrt(self.white**2 + self.coloured**2 + self.step**2 / 12.0))

    def louder(self, factor: float) -> Channel:
        """The same channel with `factor` times the noise; the converter stays."""
        return Channel(
            self.unit,
            factor * self.white,
            factor * self.coloured,
            self.correlation_time,
            self.step,
        )


CHANNELS: Mapping[str, Channel] = {
    "extension": Channel("m", 60e-6, 20e-6, 0.05, 0.45 / 4096),
    "chamber_pressure_lower": Channel("Pa", 250.0, 100.0, 0.05, 1e6 / 4096),
    "chamber_pressure_upper": Channel("Pa", 250.0, 100.0, 0.05, 1e6 / 4096),
    "supply_pressure": Channel("Pa", 250.0, 100.0, 0.05, 1e6 / 4096),
    "tank_pressure": Channel("Pa", 250.0, 100.0, 0.05, 1e6 / 4096),
    "tank_temperature": Channel("K", 0.10, 0.05, 0.2, 0.02),
    "roll": Channel("rad", 150e-6, 50e-6, 0.1, 20e-6),
    "pitch": Channel("rad", 150e-6, 50e-6, 0.1, 20e-6),
    "valve_command": Channel("V", 0.0, 0.0, 1.0, 10.0 / 65536),
}
"""By signal without its number: "extension" stands for "extension_2" too. 12-bit converters over
450 mm and 10 bar; the pressure noise is the source's (262 Pa, section 6.1)."""


SPANS: Mapping[str, tuple[float, float]] = {
    "extension": (0.0, 0.4),
    "chamber_pressure_lower": (86e3, 486e3),
    "chamber_pressure_upper": (86e3, 486e3),
    "tank_pressure": (86e3, 486e3),
    "roll": (-0.1, 0.1),
    "pitch": (-0.1, 0.1),
}
"""Between which readings each kind of sensor was calibrated: the stroke, ambient and supply, the platform's tilt. What
reads one value all the time (a supply, a temperature) is calibrated there."""


def channel_of(signal: str, channels: Mapping[str, Channel] = CHANNELS) -> Channel:
    """The channel of "extension", "extension_2", ..."""
    return channels[sort_of(signal)]


def sort_of(signal: str) -> str:
    """A signal without its number: "extension" of "extension_2"."""
    return signal if signal in CHANNELS else signal.rpartition("_")[0]


@dataclass(frozen=True)
class SensorError:
    """reading = (1 + gain) lagged(truth(t - skew)) + offset."""

    gain: float = 0.0
    offset: float = 0.0
    lag: float = 0.0  # s, first order
    skew: float = 0.0  # s, how late the logger's clock makes it


@dataclass(frozen=True)
class Errors:
    """What is wrong with each signal; a signal that is not listed is read truly."""

    of: Mapping[str, SensorError] = field(default_factory=dict)

    def __getitem__(self, signal: str) -> SensorError:
        return self.of.get(signal, SensorError())


def disturbed(truth: Array, fine_step: float, every: int, error: SensorError) -> Array:
    """What a sensor without noise gives at the samples, from the truth at `fine_step` [s]."""
    signal = truth
    if error.lag > 0.0:
        # First order, exact for an input that runs straight between the points.
        r = np.exp(-fine_step / error.lag)
        fall = (1.0 - r) * error.lag / fine_step
        # y[n] = r y[n-1] + (1 - fall) x[n] + (fall - r) x[n-1], and at rest before the record.
        at_rest = np.array([r * truth[0] + (fall - r) * truth[0]])
        weights = ([1.0 - fall, fall - r], [1.0, -r])
        signal = np.asarray(lfilter(*weights, signal, zi=at_rest)[0], dtype=np.float64)
    if error.skew != 0.0:
        time = fine_step * np.arange(truth.size)
        signal = np.interp(time - error.skew, time, signal)
    return (1.0 + error.gain) * signal[::every] + error.offset


def noise(channel: Channel, count: int, step: float, rng: np.random.Generator) -> Array:
    """White and coloured noise of one record, sampled every `step` seconds, (count,)."""
    keep = np.exp(-step / channel.correlation_time)
    shocks = np.sqrt(1.0 - keep**2) * rng.standard_normal(count)
    shocks[0] /= np.sqrt(1.0 - keep**2)
    coloured = np.asarray(lfilter([1.0], [1.0, -keep], shocks))
    return channel.white * rng.standard_normal(count) + channel.coloured * coloured


def converted(channel: Channel, signal: Array, rounds_down: bool = False) -> Array:
    """Rounded to the converter's nearest step, or down."""
    steps = signal / channel.step
    whole = np.floor(steps) if rounds_down else np.round(steps)
    return np.asarray(whole * channel.step, dtype=np.float64)


def played(signal: Array, width: float) -> Array:
    """What follows a signal through a play of `width`: it moves when it is pushed."""
    if width <= 0.0:
        return signal
    follower = np.empty_like(signal)
    at = float(signal[0])
    for i, value in enumerate(signal.tolist()):
        at = min(max(at, value - 0.5 * width), value + 0.5 * width)
        follower[i] = at
    return follower
