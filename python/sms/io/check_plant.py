"""The data check of records that a simulation is held against: tank, bench, platform."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.io.clipping import clipped_of
from sms.io.plausible import extension_range
from sms.io.records import Finding, Record
from sms.io.rig import Rig
from sms.io.signals import SIGNALS, without_leg
from sms.io.unit_slips import rates_nearby, stretched_remedy, unit_of_time

JITTER = 0.02  #: of the median step; time is taken as even, loggers round their stamps
LONGEST_STEP = (
    0.1  #: s between two samples, from where a valve and a piston move unseen between them
)
SHORTEST = 2.0  #: s of record, the least that shows a motion beside its start
DEAD_SHARE = 0.2  #: a channel that stands still for this share of a record while others move
CLIPPED_SHARE = 0.2  #: a channel at its extreme for this share of a record says nothing there
MOVES = 0.02  #: of what a run usually sweeps: what counts as a change
OPENS = (
    0.7  #: V from the centre; a command that goes so far both ways feeds and vents what it drives
)
ENDS = {"extension", "valve_command", "setpoint", "tank_pressure", "tank_temperature"}
"""Signals that may rest at an extreme: end stops, a command that is held, a tank that is full."""


def _sweep(name: str) -> float:
    """What a run usually sweeps of a signal, SI; 0 where it may stand still, as time does not."""
    return SIGNALS[without_leg(name)].sweep if name != "time" else 0.0


def even_time(rig: Rig, record: Record) -> Iterator[Finding]:
    """A simulation steps through the record at one rate."""
    step = np.diff(record.signals["time"])
    if step.size == 0 or np.any(step <= 0.0):
        return
    median = float(np.median(step))
    if median > LONGEST_STEP:
        yield record.finding(
            "error",
            None,
            "time",
            f"one sample in {median:.4g} s: what moves between two samples cannot be told; needed: one in "
            f"{LONGEST_STEP:g} s",
            unit_of_time(rig, median),
        )
        return
    off = np.abs(step / median - 1.0)
    if np.max(off) > 0.5 or np.median(off) > JITTER:
        worst = int(np.argmax(off))
        yield record.finding(
            "error",
            worst + 1,
            "time",
            f"the steps of time are uneven ({step[worst]:.4g} s here, {median:.4g} s in the middle)",
            "resample the record to one rate, or split it where samples were lost",
        )
        return
    even = float(np.mean(step))
    if nearby := rates_nearby(1.0 / even):
        usual = min(nearby, key=lambda rate: abs(np.log(rate * even)))
        yield record.finding(
            "warning",
            None,
            "time",
            f"one sample in {1e3 * even:.4g} ms, {1.0 / even:.4g} Hz, is a rate that no logger has: the axis of time "
            f"may be stretched, from {usual:g} Hz",
            stretched_remedy(rig, 1.0 / (even * usual)),
        )


def long_enough(rig: Rig, record: Record) -> Iterator[Finding]:
    time = record.signals["time"]
    length = float(time[-1] - time[0]) if time.size else 0.0
    if length < SHORTEST:
        yield record.finding(
            "error",
            None,
            None,
            f"too short: {length:.3g} s of record, needed: {SHORTEST:g} s",
            "record a longer run",
        )


def dead_channels(rig: Rig, record: Record) -> Iterator[Finding]:
    """A channel that holds one value exactly while its neighbours move."""
    moving = {
        name: _changes(record.signals[name], _sweep(name))
        for name in record.signals
        if _sweep(name)
    }
    for name, values in record.signals.items():
        if not _sweep(name) or without_leg(name) == "valve_command":
            continue
        others = [m for other, m in moving.items() if other != name]
        start, length = _longest_constant(values)
        if length < DEAD_SHARE * values.size or not others:
            continue
        most = max(float(np.mean(m[start : start + length])) for m in others)
        at_end = without_leg(name) in ENDS and not _is_centre(values, start)
        if most > 0.5 and not at_end:
            yield record.finding(
                "error",
                start,
                name,
                f"holds one value for {100 * length / values.size:.0f} % of the record while the "
                "other signals move",
                "the sensor or its cable is dead there; repair it, or leave this record out",
            )


def clipped_channels(rig: Rig, record: Record) -> Iterator[Finding]:
    """A channel that sits at the end of its range: nothing is judged there, and something must be left."""
    at_end = clipped_of(rig, record.signals)
    enough = not at_end or _whole_seconds(record, np.any(list(at_end.values()), axis=0)) >= SHORTEST
    for name, where in at_end.items():
        yield record.finding(
            "warning" if enough else "error",
            int(np.argmax(where)),
            name,
            f"sits at the end of its range for {100 * np.mean(where):.2g} % of the record",
            "these samples are compared with nothing; if it is no end, look at its resolution and noise"
            if enough
            else "the sensor or its amplifier is saturated; choose another range",
        )
    for name, values in record.signals.items():
        if not _sweep(name) or without_leg(name) in ENDS or name in at_end:
            continue
        if np.all(np.isnan(values)):  # which is said already
            continue
        for extreme, word in ((np.nanmax(values), "largest"), (np.nanmin(values), "smallest")):
            share = float(np.mean(values == extreme))
            if share > CLIPPED_SHARE and np.ptp(values) != 0.0:
                yield record.finding(
                    "error",
                    int(np.argmax(values == extreme)),
                    name,
                    f"sits at its {word} value for {100 * share:.0f} % of the record",
                    "the sensor or its amplifier is saturated; choose another range",
                )


def _whole_seconds(record: Record, clipped: NDArray[np.bool_]) -> int:
    """How many seconds of a record hold no such sample."""
    time = record.signals["time"]
    _, second = np.unique(np.floor(time - time[0]), return_inverse=True)
    return int(np.sum(np.bincount(second, clipped)[:-1] == 0))


def driven_channels_that_hardly_move(rig: Rig, record: Record) -> Iterator[Finding]:
    """What a valve feeds and vents has to answer."""
    centre = rig.declared("valve_centre").value
    for name, values in record.signals.items():
        stem = without_leg(name)
        if not _sweep(name) or stem == "valve_command":
            continue
        drive = "valve_command" + name[len(stem) :]
        if drive not in record.signals:  # of a controller that is simulated
            continue
        command = record.signals[drive] - centre
        if min(float(command.max()), -float(command.min())) < OPENS:
            continue
        if np.all(np.isnan(values)):  # which is said already
            continue
        low, high = np.nanquantile(values, [0.05, 0.95])
        if high - low < MOVES * _sweep(name):
            yield record.finding(
                "error",
                None,
                name,
                f"hardly moves, although the command opens the valve by {OPENS:g} V and more both ways",
                "the sensor or its cable is dead, or what it measures is blocked; leave this record out",
            )


def plausible_extensions(rig: Rig, record: Record) -> Iterator[Finding]:
    for name in record.signals:
        if without_leg(name) == "extension":
            yield from extension_range(rig, record, name)


def _changes(values: Array, usual: float) -> NDArray[np.bool_]:
    """Where a signal moves by more than MOVES of its usual sweep within a fiftieth of the record."""
    window = max(values.size // 50, 1)
    span = np.zeros(values.size, dtype=np.bool_)
    span[window:] = np.abs(values[window:] - values[:-window]) > MOVES * usual
    return span


def _longest_constant(values: Array) -> tuple[int, int]:
    """Start and length of the longest stretch of one value."""
    edges = np.flatnonzero(np.concatenate(([True], values[1:] != values[:-1])))
    lengths = np.diff(np.append(edges, values.size))
    longest = int(np.argmax(lengths))
    return int(edges[longest]), int(lengths[longest])


def _is_centre(values: Array, at: int) -> bool:
    """Whether the value at one sample is neither the largest nor the smallest of the record."""
    return bool(np.nanmin(values) < values[at] < np.nanmax(values))
