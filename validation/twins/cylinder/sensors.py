"""From the true motion to what a logger writes: averaging, noise, converter, time stamps.

Every channel is averaged over the same 10 ms, then disturbed, then rounded to the converter's
step. The rod force carries white noise and a coloured part (first-order autoregression, an
Ornstein-Uhlenbeck process in continuous time, so that it is exact at uneven time steps). The
laser that measures the extension loses its spot now and then and jumps for one sample. The
logger's clock ticks in whole milliseconds, mostly 10, sometimes 11, seldom more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from validation.twins.cylinder.motion import OUTPUT_STEP, Array, Motion

AVERAGED_POINTS = 5
"""Points of the simulated motion in one averaging window (10 ms)."""

_STEPS_MS = np.array([10, 11, 12, 13, 14, 15, 16, 17])
_STEP_SHARE = np.array([0.860, 0.110, 0.010, 0.005, 0.004, 0.004, 0.005, 0.002])


@dataclass(frozen=True)
class Sensors:
    """Noise (standard deviations) and converter steps."""

    force_white: float = 0.1  # N
    force_coloured: float = 0.2  # N
    force_correlation_time: float = 0.1  # s
    force_step: float = 0.0153  # N
    pressure_noise: float = 200.0  # Pa
    pressure_step: float = 200.0  # Pa
    extension_noise: float = 10e-6  # m
    extension_step: float = 4.4e-6  # m
    spike_rate: float = 0.2  # 1/s, lost laser spots
    spike_size: float = 0.3e-3  # m, largest jump


@dataclass(frozen=True)
class SensorErrors:
    """reading = (1 + gain) true + offset; all zero means that the sensors tell the truth.

    The pressure sensor reads against ambient, so its gain acts on the gauge pressure.
    """

    rod_force_gain: float = 0.0
    rod_force_offset: float = 0.0  # N
    chamber_pressure_lower_gain: float = 0.0
    chamber_pressure_lower_offset: float = 0.0  # Pa


@dataclass(frozen=True)
class Samples:
    """True averaged values at the sampling instants; all arrays have shape (n,)."""

    stamp: Array  # s, what the logger writes
    time: Array  # s, when the sample was really taken
    extension: Array  # m
    velocity: Array  # m/s
    acceleration: Array  # m/s2
    gauge_pressure: Array  # Pa
    rod_force: Array  # N


@dataclass(frozen=True)
class Reading:
    """What the record file holds; all arrays have shape (n,)."""

    time: Array  # s
    extension: Array  # m
    gauge_pressure: Array  # Pa
    rod_force: Array  # N


def time_stamps(duration: float, rng: np.random.Generator) -> tuple[Array, Array]:
    """Logger stamps in whole milliseconds and the true instants [s] within `duration` [s]."""
    count = int(duration / 0.010)
    steps = rng.choice(_STEPS_MS, size=count, p=_STEP_SHARE)
    stamp = np.concatenate(([0], np.cumsum(steps))).astype(np.float64) * 1e-3
    time = stamp + rng.uniform(0.0, 1e-3, size=stamp.size)
    inside = time < duration - 2.0 * OUTPUT_STEP
    return stamp[inside], time[inside]


def sample(motion: Motion, stamp: Array, time: Array) -> Samples:
    """Average the true motion over the window that ends at each instant."""

    def at_instants(signal: Array) -> Array:
        half = AVERAGED_POINTS // 2
        mean = uniform_filter1d(signal, AVERAGED_POINTS, mode="nearest", origin=half)
        return np.asarray(np.interp(time, motion.time, mean), dtype=np.float64)

    return Samples(
        stamp,
        time,
        at_instants(motion.extension),
        at_instants(motion.velocity),
        at_instants(motion.acceleration),
        at_instants(motion.gauge_pressure),
        at_instants(motion.rod_force),
    )


def coloured_noise(time: Array, rms: float, tau: float, rng: np.random.Generator) -> Array:
    """Stationary Ornstein-Uhlenbeck noise at uneven instants, shape (n,)."""
    memory = np.exp(-np.diff(time) / tau)
    shock = rng.standard_normal(time.size)
    values = [float(shock[0])]
    fresh = (np.sqrt(1.0 - memory**2) * shock[1:]).tolist()
    for keep, new in zip(memory.tolist(), fresh, strict=True):
        values.append(keep * values[-1] + new)
    return rms * np.array(values)


def read(
    samples: Samples, sensors: Sensors, errors: SensorErrors, rng: np.random.Generator
) -> Reading:
    """One noisy record. The same generator state gives the same noise whatever the errors."""
    n = samples.time.size
    white = sensors.force_white * rng.standard_normal(n)
    colour = coloured_noise(
        samples.time, sensors.force_coloured, sensors.force_correlation_time, rng
    )
    pressure_noise = sensors.pressure_noise * rng.standard_normal(n)
    laser = sensors.extension_noise * rng.standard_normal(n)
    lost = rng.uniform(size=n) < sensors.spike_rate * float(np.mean(np.diff(samples.time)))
    laser += np.where(lost, sensors.spike_size * rng.uniform(-1.0, 1.0, size=n), 0.0)

    force = (1.0 + errors.rod_force_gain) * samples.rod_force + errors.rod_force_offset
    pressure = (
        1.0 + errors.chamber_pressure_lower_gain
    ) * samples.gauge_pressure + errors.chamber_pressure_lower_offset
    return Reading(
        samples.stamp,
        _convert(samples.extension + laser, sensors.extension_step),
        _convert(pressure + pressure_noise, sensors.pressure_step),
        _convert(force + white + colour, sensors.force_step),
    )


def _convert(signal: Array, step: float) -> Array:
    """Round to the converter's step."""
    return np.asarray(np.round(signal / step) * step, dtype=np.float64)
