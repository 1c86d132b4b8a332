"""A safe menu of motions for one piston, each a setpoint [m] over time [s] inside the stroke.

A setpoint comes with the command that would roughly follow it: over the valve's dead band at once,
then in proportion to the speed. A slow position loop takes out the drift.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from validation.twins.air import Array

DEAD_BAND = 0.55
"""V from the centre at which the valve begins to pass air."""
SPEED_PER_VOLT = 0.27
"""m/s per V beyond the dead band, about."""
FASTEST = 0.25
"""m/s, the largest speed that is asked for."""


def sine(time: Array, room: float, rng: np.random.Generator) -> Array:
    """One frequency; `room` is the largest amplitude in m, as for all others."""
    frequency = rng.uniform(0.25, 0.6)
    amplitude = min(room * rng.uniform(0.4, 0.7), FASTEST / (2.0 * np.pi * frequency))
    return np.asarray(amplitude * np.sin(2.0 * np.pi * frequency * time))


def multisine(time: Array, room: float, rng: np.random.Generator) -> Array:
    """Seven frequencies from 0.12 to 2.5 Hz with random phases, alike in speed."""
    frequencies = np.geomspace(0.12, 2.5, 7) * rng.uniform(0.95, 1.05, 7)
    phases = rng.uniform(0.0, 2.0 * np.pi, 7)
    wave = np.sin(2.0 * np.pi * frequencies * time[:, None] + phases) / frequencies
    return _within(wave.sum(axis=1), time, room * rng.uniform(0.5, 0.8))


def triangle(time: Array, room: float, rng: np.random.Generator) -> Array:
    """Slow and at constant speed."""
    speed = rng.uniform(0.02, 0.05)
    reach = min(room * 0.6, speed * time[-1] / 5.0)
    phase = np.mod(speed * time / reach + 1.0, 4.0)
    return np.asarray(reach * (np.abs(phase - 2.0) - 1.0) * -1.0)


def chirp(time: Array, room: float, rng: np.random.Generator) -> Array:
    """From 0.1 to 2 Hz, the amplitude falling as the frequency rises."""
    low, high = 0.1, rng.uniform(1.5, 2.2)
    rate = np.log(high / low) / time[-1]
    phase = 2.0 * np.pi * low * (np.exp(rate * time) - 1.0) / rate
    wave = np.sin(phase) / (1.0 + low * np.exp(rate * time) / 0.35)
    return _within(wave, time, room * rng.uniform(0.5, 0.7))


def steps(time: Array, room: float, rng: np.random.Generator) -> Array:
    """To and fro at a different speed each time, without a pause."""
    return _legs(time, room * 0.6, rng, lambda: 0.0)


def holds(time: Array, room: float, rng: np.random.Generator) -> Array:
    """Moves with a long pause after each: what leaks, shows here."""
    return _legs(time, room * 0.7, rng, lambda: float(rng.uniform(0.8, 1.6)))


def ends(time: Array, room: float, rng: np.random.Generator) -> Array:
    """Once to a few millimetres before either end of the stroke, with pauses."""
    period = time[-1] / 2.2
    wave = np.sin(0.5 * np.pi * np.clip(1.25 * np.sin(2.0 * np.pi * time / period), -1.0, 1.0))
    return np.asarray(room * rng.uniform(0.96, 1.0) * wave)


MENU: dict[str, Callable[[Array, float, np.random.Generator], Array]] = {
    "sine": sine,
    "multisine": multisine,
    "triangle": triangle,
    "chirp": chirp,
    "steps": steps,
    "holds": holds,
    "ends": ends,
}


def feedforward(setpoint: Array, step: float) -> Array:
    """V around the centre that roughly follows a setpoint sampled every `step` seconds."""
    speed = np.gradient(setpoint, step)
    over = DEAD_BAND * np.tanh(speed / 4e-3)
    return np.asarray(over + speed / SPEED_PER_VOLT)


def _within(wave: Array, time: Array, reach: float) -> Array:
    """The wave from its start value, as large as reach and speed allow."""
    wave = wave - 0.5 * (wave.max() + wave.min())
    fastest = float(np.max(np.abs(np.gradient(wave, time))))
    return np.asarray(wave * min(reach / float(np.max(np.abs(wave))), FASTEST / fastest))


def _legs(time: Array, reach: float, rng: np.random.Generator, pause: Callable[[], float]) -> Array:
    """Straight legs between random places, with pauses, corners rounded over 40 ms."""
    knots, places = [0.0, 0.3], [0.0, 0.0]
    while knots[-1] < time[-1]:
        place = float(rng.uniform(-reach, reach))
        if abs(place - places[-1]) < 0.3 * reach:
            continue
        duration = abs(place - places[-1]) / float(rng.uniform(0.06, FASTEST))
        rest = pause()
        knots += [knots[-1] + duration, knots[-1] + duration + rest + 1e-3]
        places += [place, place]
    wave = np.interp(time, knots, places)
    width = max(1, round(0.04 / (time[1] - time[0])))
    padded = np.pad(wave, (width, width), mode="edge")
    return np.asarray(np.convolve(padded, np.ones(width) / width, mode="same")[width:-width])
