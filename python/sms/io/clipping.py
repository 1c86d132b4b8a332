"""Readings at the end of a sensor's range: the truth lies there or beyond, and no model is judged by them.

The end is declared (range in [signals]), or seen: a reading with noise that repeats to the digit at its own extreme. A
floor or ceiling that [parameters] declares is part of the simulation, and no clipping.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.io.rig import Rig
from sms.io.signal_sources import SignalSource
from sms.io.signals import SIGNALS, without_leg

CLIPPED = 10  #: samples in a row at exactly the largest or the smallest reading
LEVELS = 20  #: a channel with fewer distinct values is coarse: it touches its extremes anyway
LONGER = 2  #: times the longest row of one value elsewhere: so far chance and rounding go
LARGE_SHARE = 0.2  #: of a record, for which no reading rests at its extreme of itself
NOISY = 0.5  #: of the resolution: with more noise than this a reading cannot stand still, at an end stop neither
COMMANDED = ("time", "valve_command", "setpoint")
"""What is sent, and read by no sensor."""
MAY_REST = ("extension", "tank_pressure", "tank_temperature")
"""What may rest at an extreme without a fault: end stops, a tank that is full or empty."""


def clipped_of(rig: Rig, signals: Mapping[str, Array]) -> dict[str, NDArray[np.bool_]]:
    """Signal -> (n,) which of its samples are at the end of its range; only signals that have such samples."""
    found = {name: clipped(rig, name, values) for name, values in signals.items()}
    return {name: at_end for name, at_end in found.items() if at_end.any()}


def clipped(rig: Rig, name: str, values: Array) -> NDArray[np.bool_]:
    """(n,): samples of one signal, as measured, in SI."""
    stem, source = without_leg(name), rig.signals.get(name)
    nothing = np.zeros(values.size, dtype=np.bool_)
    if stem in COMMANDED or source is None:
        return nothing
    if source.range is not None:
        low, high = source.range
        near = 0.5 * source.resolution + 1e-6 * (high - low)
        return np.asarray((values <= low + near) | (values >= high - near))
    if not SIGNALS[stem].sweep or not _stirs(source, stem in MAY_REST):
        return nothing
    stuck = stuck_at_extremes(values, large=LARGE_SHARE)
    return nothing if not stuck.any() else stuck & ~_declared(rig, name, values, source)


def stuck_at_extremes(values: Array, large: float = np.inf) -> NDArray[np.bool_]:
    """(n,): samples at exactly the largest or smallest reading, where CLIPPED or more in a row are.

    A signal that rests there within its noise is no clipping: one that repeats to the digit is, where it does so
    nowhere else for nearly as long, or for a large share of the record.
    """
    out = np.zeros(values.size, dtype=np.bool_)
    if np.unique(values[np.isfinite(values)]).size < LEVELS:
        return out
    edges = np.flatnonzero(np.concatenate(([True], values[1:] != values[:-1])))
    lengths = np.diff(np.append(edges, values.size))
    lowest, highest = np.nanmin(values), np.nanmax(values)
    elsewhere = (values[edges] != lowest) & (values[edges] != highest)
    long = LONGER * np.max(lengths[elsewhere], initial=1)
    for extreme in (lowest, highest):
        here = (values[edges] == extreme) & (lengths >= CLIPPED)
        if np.any(lengths[here] >= long) or np.sum(lengths[here]) > large * values.size:
            out |= values == extreme
    return out


def _stirs(source: SignalSource, surely: bool) -> bool:
    """Whether noise moves the reading from sample to sample; surely: only where it is declared that it does."""
    if source.noise is None:
        return not surely
    return source.noise > 0.0 and source.noise >= NOISY * source.resolution


def _declared(rig: Rig, name: str, values: Array, source: SignalSource) -> NDArray[np.bool_]:
    """(n,): samples at a reading below or above which [parameters] says that this sensor reads nothing."""
    near = 4.0 * (source.noise or 0.0) + source.resolution
    out = np.zeros(values.size, dtype=np.bool_)
    for end in (f"{name}_floor", f"{name}_ceiling"):
        if end in rig.parameters:
            out |= np.abs(values - rig.parameters[end].value) <= near
    return out
