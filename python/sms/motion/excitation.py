"""Test excitations over time: sine, chirp, steps and an amplitude-modulated random binary signal.

Each takes the times (n,) in s and gives values (n,) in the unit of its amplitude. Sine and chirp
are the core's (eq. 7.3, signal.hpp); a sine is a chirp that stays at one frequency.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.errors import InputError


def sine(
    time: Array, amplitude: float, frequency: float, offset: float = 0.0, jump: float = 0.0
) -> Array:
    """offset + amplitude sin(2 pi frequency t); frequency in Hz.

    `jump` is added with the sine's sign: it steps over a valve's dead band (section 7.2).
    """
    wave = chirp(time, amplitude, frequency, frequency, 1.0)
    return np.asarray(wave + jump * np.sign(wave) + offset)


def chirp(time: Array, amplitude: float, first: float, last: float, duration: float) -> Array:
    """The chirp of eq. 7.3, from `first` to `last` Hz within `duration` s; it goes on beyond."""
    if not duration > 0.0:
        raise InputError(f"chirp over {duration:g} s: its duration must be above 0 s")
    return np.asarray(_core.chirp(time, amplitude, first, last, duration), dtype=np.float64)


def steps(time: Array, values: Sequence[float], hold: float) -> Array:
    """Each value for `hold` s in turn; the last one stays."""
    if not values or not hold > 0.0:
        raise InputError("steps: at least one value and a holding time above 0 s are needed")
    index = np.minimum(np.floor(time / hold + 1e-9).astype(np.int64), len(values) - 1)
    return np.asarray(values, dtype=np.float64)[index]


def aprbs(time: Array, amplitude: float, shortest: float, longest: float, seed: int) -> Array:
    """Random levels within +-amplitude, each held for a random time from shortest to longest (s).

    The amplitude-modulated pseudo-random binary signal of section 7.3: levels and times are drawn
    evenly, the same seed gives the same signal.
    """
    if not 0.0 < shortest <= longest:
        raise InputError(
            f"aprbs held from {shortest:g} to {longest:g} s: these must rise from above 0 s"
        )
    random = np.random.default_rng(seed)
    count = math.ceil(float(time[-1]) / shortest) + 1
    ends = np.cumsum(random.uniform(shortest, longest, count))
    levels = random.uniform(-amplitude, amplitude, count)
    return np.asarray(levels[np.searchsorted(ends, time, side="right")])
