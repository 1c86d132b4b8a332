"""Deck motion: how a ship's deck moves, read from any record, and made ready for the platform.

`read_deck_motion` reads columns in any unit. `froude_scaled`, `resampled`, `band_limited`, `part`
and `faded` each give a new motion and add a sentence to what was done to it. SI units inside; roll
and pitch in rad about x and y, heave in m upwards.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

from sms.arrays import Array
from sms.errors import InputError, did_you_mean
from sms.io.table import Table
from sms.io.table_files import read_table
from sms.io.units import array_to_si, split_column_name

Delimiter = Literal["comma", "semicolon", "tab", "whitespace"]
COLUMN_UNITS: Mapping[str, str] = {"time": "s", "roll": "rad", "pitch": "rad", "heave": "m"}
AXES = ("roll", "pitch", "heave")
_ORDER = 4  # of the Butterworth filter, which runs forwards and backwards
SLOWEST = 1e-6  # of the sampling rate: below it the filter's poles are one to rounding
_ACROSS = 4.0  # samples a period at the band's upper edge, at least


@dataclass(frozen=True)
class DeckMotion:
    """Attitude and heave of a deck over time; one array (n,) each."""

    time: Array  #: s, rising evenly from 0
    roll: Array  #: rad
    pitch: Array  #: rad
    heave: Array  #: m, upwards, about the mean
    origin: str  #: where it comes from
    done: tuple[str, ...] = ()  #: what was done to it, a sentence each

    @property
    def period(self) -> float:
        """Between samples, s."""
        return float(self.time[1] - self.time[0])

    @property
    def duration(self) -> float:
        """s"""
        return float(self.time[-1])

    def axis(self, name: str) -> Array:
        """Roll, pitch or heave by its name, (n,)."""
        return {"roll": self.roll, "pitch": self.pitch, "heave": self.heave}[name]

    def rates(self, order: int = 1) -> Array:
        """First or second derivative of (roll, pitch, heave), (n, 3), by central differences."""
        values = np.column_stack([self.roll, self.pitch, self.heave])
        for _ in range(order):
            values = np.gradient(values, self.period, axis=0)
        return values


def read_deck_motion(
    file: Path,
    columns: Mapping[str, str],
    units: Mapping[str, str] | None = None,
    delimiter: Delimiter = "comma",
    where: str = "[deck_motion]",
) -> DeckMotion:
    """Read a record (CSV and its relatives, .mat, Parquet) as a deck motion.

    Args:
        file: the record.
        columns: column of time, and of roll, pitch and heave as far as they are there; an axis
            that is not named stays at rest. With or without the unit in brackets.
        units: unit of a column whose name does not say it.
        delimiter: of a text file.
        where: what an error names, the table of the scenario.

    Uneven times are evened out by linear interpolation at the median step. Raises: InputError for
    a missing column, a unit that does not fit, a cell that is no number, time that runs backwards.
    """
    units = units or {}
    _check_axes(columns, where)
    table = read_table(file, delimiter, None)
    signals = {name: _signal(table, name, column, units, where) for name, column in columns.items()}
    time = signals.pop("time")
    _check_time(table, time)
    time = time - time[0]
    step = float(np.median(np.diff(time)))
    done = [f"read {', '.join(signals)} from {file.name}: {time.size} samples, {time[-1]:.1f} s"]
    if np.ptp(np.diff(time)) > 0.02 * step:
        done.append(f"uneven time steps were evened out to {1e3 * step:.3g} ms, linearly between")
    even = step * np.arange(math.floor(time[-1] / step + 1e-6) + 1)
    rest = np.zeros(even.size)
    axes = {
        name: np.interp(even, time, signals[name]) if name in signals else rest for name in AXES
    }
    return DeckMotion(even, axes["roll"], axes["pitch"], axes["heave"], file.name, tuple(done))


def froude_scaled(motion: DeckMotion, scale: float) -> DeckMotion:
    """The same motion of a ship `scale` times as long: lengths times scale, times sqrt(scale).

    Angles stay. Froude's law holds where gravity and inertia rule; roll damping by viscosity does
    not follow it, so a small model rolls somewhat less than the ship would.
    """
    if not (math.isfinite(scale) and scale > 0.0):
        raise InputError(f"scale = {scale:g}: the ratio of lengths must be above 0, such as 40")
    done = (
        f"Froude-scaled by {scale:g}: lengths times {scale:g}, times times {math.sqrt(scale):.3f}"
    )
    return replace(
        motion,
        time=motion.time * math.sqrt(scale),
        heave=motion.heave * scale,
        done=(*motion.done, done),
    )


def part(motion: DeckMotion, first: float, last: float) -> DeckMotion:
    """The seconds from first to last, counted from 0 again."""
    if not 0.0 <= first < last:
        raise InputError(f"from {first:g} s to {last:g} s: the part must have a length")
    inside = (motion.time >= first) & (motion.time <= last)
    if np.count_nonzero(inside) < 8:
        raise InputError(
            f"from {first:g} s to {last:g} s: less than 8 samples of {motion.origin}, which lasts "
            f"{motion.duration:.1f} s"
        )
    return replace(
        motion,
        time=motion.time[inside] - motion.time[inside][0],
        roll=motion.roll[inside],
        pitch=motion.pitch[inside],
        heave=motion.heave[inside],
        done=(*motion.done, f"taken from {first:g} s to {min(last, motion.duration):g} s"),
    )


def band_limited(motion: DeckMotion, low: float, high: float) -> DeckMotion:
    """What lies between two frequencies (Hz); low = 0 keeps the mean, high = inf keeps all above.

    A Butterworth filter of order 4 run forwards and backwards: no phase, half the amplitude left
    at an edge. The platform has no place for a mean heave: it is taken off in any case.
    """
    rate = 1.0 / motion.period
    if not (math.isfinite(low) and 0.0 <= low < high):
        raise InputError(f"band {low:g} to {high:g} Hz: its ends must rise from 0 or more")
    if 0.0 < (lowest := low or high) < SLOWEST * rate:
        raise InputError(
            f"band {low:g} to {high:g} Hz: {lowest:g} Hz is too low for a filter at a sampling rate of {rate:g} Hz; "
            f"from {SLOWEST * rate:g} Hz is allowed, or 0"
        )
    steps = []
    edges: list[float] = []
    if low > 0.0:
        edges.append(low)
    if high < 0.5 * rate * (1.0 - 1e-9):
        edges.append(high)
        steps.append(f"low-pass at {high:g} Hz")
    if low > 0.0:
        steps.append(f"high-pass at {low:g} Hz")
    heave = motion.heave - motion.heave.mean()
    axes = [motion.roll, motion.pitch, heave]
    if edges:
        if len(edges) == 2:
            sos = butter(_ORDER, edges, "bandpass", output="sos", fs=rate)
        else:
            kind: Literal["highpass", "lowpass"] = "highpass" if low > 0.0 else "lowpass"
            sos = butter(_ORDER, edges[0], kind, output="sos", fs=rate)
        pad = min(motion.time.size - 1, int(3.0 * rate / edges[0]))
        axes = [sosfiltfilt(sos, axis, padlen=pad) for axis in axes]
    done = " and ".join(steps) or "no band limit"
    return replace(
        motion, roll=axes[0], pitch=axes[1], heave=axes[2], done=(*motion.done, f"{done}, no lag")
    )


def resampled(motion: DeckMotion, period: float) -> DeckMotion:
    """At another sampling period (s), by cubic splines; band-limit first when it gets longer."""
    if not (math.isfinite(period) and 0.0 < period <= motion.duration / 4.0):
        raise InputError(
            f"sampling period {period:g} s: above 0 and at most a quarter of the motion's "
            f"{motion.duration:.1f} s is allowed"
        )
    time: Array = period * np.arange(math.floor(motion.duration / period + 1e-6) + 1.0)
    spline = CubicSpline(motion.time, np.column_stack([motion.axis(name) for name in AXES]))
    roll, pitch, heave = np.asarray(spline(time)).T
    return replace(motion, time=time, roll=roll, pitch=pitch, heave=heave)


def faded(motion: DeckMotion, duration: float) -> DeckMotion:
    """Led from rest at its start and to rest at its end, over `duration` s, by half a cosine."""
    if not (math.isfinite(duration) and 0.0 <= duration <= 0.5 * motion.duration):
        raise InputError(
            f"fade over {duration:g} s: 0 to half of the motion's {motion.duration:.1f} s is allowed"
        )
    if duration == 0.0:
        return motion
    from_ends = np.minimum(motion.time, motion.duration - motion.time)
    share = 0.5 - 0.5 * np.cos(math.pi * (np.minimum(from_ends, duration) / duration))
    return replace(
        motion,
        roll=share * motion.roll,
        pitch=share * motion.pitch,
        heave=share * motion.heave,
        done=(*motion.done, f"led from rest and back to rest over {duration:g} s"),
    )


def sampling_for(band_high: float) -> float:
    """A sampling period (s) at which a motion up to `band_high` Hz is smooth between samples."""
    return 1.0 / (2.0 * _ACROSS * band_high)


def _check_axes(columns: Mapping[str, str], where: str) -> None:
    for name in columns:
        if name not in COLUMN_UNITS:
            raise InputError(
                f"{where}: '{name}' is no axis of a deck; {did_you_mean(name, COLUMN_UNITS)}"
            )
    if "time" not in columns:
        raise InputError(f'{where}: the column of the time is missing; add time = "Time [s]"')
    if not set(columns) & set(AXES):
        raise InputError(f"{where}: none of roll, pitch and heave is named; name one column")


def _signal(table: Table, name: str, column: str, units: Mapping[str, str], where: str) -> Array:
    """One column in SI units."""
    index = _column(table, name, column, where)
    values, bad = table.numbers(index)
    if bad:
        row, text = bad[0]
        what = f"'{text}' is not a number" if text else "the cell is empty"
        more = f" (and {len(bad) - 1} more in this column)" if len(bad) > 1 else ""
        raise InputError(
            f"{table.file}, line {int(table.lines[row])}, {name}: {what}{more}; repair the line"
        )
    unit = units.get(name) or split_column_name(table.names[index])[1]
    if unit is None:
        raise InputError(
            f"{table.file}: the column '{table.names[index]}' for {name} has no unit; write "
            f'{name}_unit = "{COLUMN_UNITS[name]}" in {where}'
        )
    return array_to_si(values, unit, COLUMN_UNITS[name], f"{table.file}, {name}")


def _column(table: Table, name: str, column: str, where: str) -> int:
    plain = [split_column_name(known)[0] for known in table.names]
    for known in (list(table.names), plain):
        if known.count(column) == 1:
            return known.index(column)
    raise InputError(
        f"{where} {name}: {table.file} has no column '{column}'; "
        f"{did_you_mean(split_column_name(column)[0], plain)}"
    )


def _check_time(table: Table, time: Array) -> None:
    if time.size < 8:
        raise InputError(f"{table.file}: {time.size} samples are no motion; 8 are needed at least")
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        row = int(back[0]) + 1
        raise InputError(
            f"{table.file}, line {int(table.lines[row])}, time: {time[row]:g} s after "
            f"{time[row - 1]:g} s; time must rise from line to line"
        )
