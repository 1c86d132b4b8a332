"""Deck motions: read from a table, held against the workspace, sampled for streaming."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from sms import OutOfWorkspaceError, Params, inverse_kinematics
from sms.arrays import Array
from sms.errors import InputError, did_you_mean
from sms.io.table import Table
from sms.io.table_files import open_table
from sms.io.units import array_to_si, split_column_name

MID_HEIGHT = 0.5  #: m; the platform's height at mid-stroke, where a heave of zero is


_COLUMNS = {"time": "s", "roll": "rad", "pitch": "rad", "heave": "m", "height": "m"}


@dataclass(frozen=True, eq=False)
class PlatformMotion:
    """Roll and pitch, rad, and height, m, over time, s: each (samples,)."""

    time: Array  #: from 0 on
    roll: Array
    pitch: Array
    height: Array

    @property
    def duration(self) -> float:
        """Length of the motion, s."""
        return float(self.time[-1])

    def at(self, time: Array) -> Array:
        """(roll, pitch, height) at given times, (n, 3): cubic between samples, without overshoot.

        Before its begin and after its end a motion stands still.
        """
        inside = np.clip(time, 0.0, self.duration)
        pose = np.stack([self.roll, self.pitch, self.height], axis=-1)
        return np.asarray(PchipInterpolator(self.time, pose)(inside))

    def scaled(self, scale: float, height: float = MID_HEIGHT) -> PlatformMotion:
        """The motion with its excursions from level at a height made larger or smaller."""
        return replace(
            self,
            roll=scale * self.roll,
            pitch=scale * self.pitch,
            height=height + scale * (self.height - height),
        )


def read_motion(
    file: Path, delimiter: str = "comma", columns: Mapping[str, str] | None = None
) -> PlatformMotion:
    """Read a motion: columns time, roll, pitch and heave or height, named "roll [deg]".

    Heave is counted upwards from mid-height, 0.5 m. Columns that lack stand still. columns: what the file calls
    otherwise, signal -> column. InputError for a file, a column or a number that cannot be a motion.
    """
    table = open_table(file, columns, delimiter=delimiter)
    found = {name: _column(table, name) for name in _COLUMNS}
    time = found["time"]
    if time is None:
        raise InputError(f"{file}: there is no column 'time [s]'; add one")
    if time.size < 2 or not np.all(np.diff(time) > 0.0):
        raise InputError(f"{file}: time must grow from line to line; repair the column")
    if found["heave"] is not None and found["height"] is not None:
        raise InputError(f"{file}: there are both heave and height; leave one out")
    if all(found[name] is None for name in ("roll", "pitch", "heave", "height")):
        names = [split_column_name(name)[0] for name in table.names]
        remedy = did_you_mean(names[-1], ("roll", "pitch", "heave", "height"))
        raise InputError(f"{file}: no column is a motion; {remedy}")
    still = np.zeros(time.size)
    heave, height = found["heave"], found["height"]
    if height is None:
        height = MID_HEIGHT + (still if heave is None else heave)
    roll, pitch = found["roll"], found["pitch"]
    return PlatformMotion(
        time - time[0],
        still if roll is None else roll,
        still if pitch is None else pitch,
        height,
    )


def _column(table: Table, wanted: str) -> Array | None:
    for number, name in enumerate(table.names):
        plain, unit = split_column_name(name)
        if plain.lower() != wanted:
            continue
        values, bad = table.numbers(number)
        if bad:
            line, text = int(table.lines[bad[0][0]]), bad[0][1]
            raise InputError(f"{table.file}, line {line}, {wanted}: '{text}' is not a number")
        where = f"{table.file}, column '{name}'"
        if unit is None:
            raise InputError(
                f"{where}: the unit is missing; name it '{wanted} [{_COLUMNS[wanted]}]'"
            )
        return array_to_si(values, unit, _COLUMNS[wanted], where)
    return None


def check_motion(motion: PlatformMotion, params: Params | None = None) -> None:
    """InputError, with the first place and a scale that fits, for a motion beyond the stroke."""
    params = Params() if params is None else params
    worst = _beyond(motion, params)
    if worst is None:
        return
    fits = _largest_scale(motion, params)
    remedy = f"--scale {fits:.2f} fits" if fits > 0.0 else "it fits at no scale: check the heights"
    raise InputError(f"the motion leaves the workspace {worst}; {remedy}")


def _beyond(motion: PlatformMotion, params: Params) -> str | None:
    """Where a motion first leaves the stroke, in words; None when it does not."""
    try:
        found = inverse_kinematics(motion.roll, motion.pitch, motion.height, params=params)
    except OutOfWorkspaceError:
        return "so far that the rods cannot follow"
    outside = (found.extension < 0.0) | (found.extension > params.stroke)
    if not outside.any():
        return None
    sample, leg = (int(i[0]) for i in np.nonzero(outside))
    return (
        f"at {motion.time[sample]:.2f} s: extension {leg + 1} would be "
        f"{found.extension[sample, leg]:.3f} m, the stroke is 0 to {params.stroke:g} m"
    )


def _largest_scale(motion: PlatformMotion, params: Params) -> float:
    """The largest scale, in hundredths and below 1, at which a motion fits; 0 when none does."""
    low, high = 0, 99
    while low < high:
        middle = (low + high + 1) // 2
        if _beyond(motion.scaled(middle / 100.0), params) is None:
            low = middle
        else:
            high = middle - 1
    return low / 100.0
