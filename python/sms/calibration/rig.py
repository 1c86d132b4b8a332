"""A rig file of kind "poses": measured poses with their noise, and the tolerances of the drawing."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from sms.arrays import Array
from sms.calibration.schema import NoiseTable, PosesFile, TolerancesTable
from sms.errors import InputError, did_you_mean
from sms.io.table_files import text_of_file
from sms.io.toml_tables import checked, parse_toml, read_text
from sms.io.units import array_to_si, split_column_name, to_si

CHANNELS = {"roll": "rad", "pitch": "rad", "height": "m", "yaw": "rad", "x": "m", "y": "m"}
"""What may be measured of a pose, with its unit, in the order of the core; behind them come distances."""
DISTANCE = "distance_"
"""What a distance's column is called, before its name."""
EXTENSIONS = ("extension_1", "extension_2", "extension_3")
TOLERANCES = {
    "joint": "m",
    "length": "m",
    "sensor_gain": "1",
    "extension_zero": "m",
    "attitude_zero": "rad",
}
"""What the drawing says half widths of, with the unit; defaults are TolerancesTable's."""
LARGEST = {"m": 1e3, "rad": 2.0 * np.pi}
"""What a pose may read at most: far more than any platform has, and squares that are numbers still."""
LEAST_POSES = 6
MOST_POSES = 20_000
"""Half a minute; far more than anybody measures."""
KEPT_ASIDE = 5
"""Every so many poses one is a validation pose, where no file of them is named."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses as read: extension (n, 3) m; pose (n, 6 + distances) rad and m, NaN where not measured; row (n,) of its
    file."""

    extension: Array
    pose: Array
    row: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.extension)

    def taken(self, which: NDArray[np.bool_]) -> Poses:
        return Poses(self.extension[which], self.pose[which], self.row[which])


@dataclass(frozen=True, eq=False)
class Distance:
    """Between a mark on the ground and one on the platform, in world axes with the platform at rest, m."""

    name: str
    ground: Array  #: (3,)
    platform: Array  #: (3,)
    noise: float  #: standard deviation of a reading, and of what is not known of the marks


@dataclass(frozen=True, eq=False)
class PosesRig:
    """What a calibration is made from, SI."""

    title: str
    path: Path
    files: tuple[Path, ...]
    fitted: Poses
    validation: Poses
    extension_noise: Array  #: (3,) standard deviations
    pose_noise: Array  #: (6 + distances,)
    tolerances: Mapping[str, float]  #: half widths, by the names of TOLERANCES
    distances: tuple[Distance, ...] = ()

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the columns of a pose."""
        return (*CHANNELS, *(DISTANCE + d.name for d in self.distances))


def load_poses(path: Path) -> PosesRig:
    """Read the rig file and its poses. InputError with file, key and remedy for what cannot be used."""
    content = parse_toml(read_text(path, "rig file", "[rig] and [noise]"), path)
    kind = content["rig"].get("kind") if isinstance(content.get("rig"), dict) else None
    if isinstance(kind, str) and kind != "poses":
        raise InputError(
            f"{path}, [rig] kind: '{kind}' holds no poses; sms calibrate geometry reads kind 'poses'"
        )
    said = checked(PosesFile, content, path)
    distances = tuple(
        Distance(
            name,
            _point(d.ground, f"{path}, [distances.{name}] ground"),
            _point(d.platform, f"{path}, [distances.{name}] platform"),
            _positive(d.noise, "m", f"{path}, [distances.{name}] noise"),
        )
        for name, d in said.distances.items()
    )
    file = path.parent / said.rig.poses
    poses = _read(file, distances)
    files = [path, file]
    if said.rig.validation is not None:
        other = path.parent / said.rig.validation
        fitted, kept = poses, _read(other, distances)
        files.append(other)
    else:
        aside = np.arange(len(poses)) % KEPT_ASIDE == KEPT_ASIDE - 1
        fitted, kept = poses.taken(~aside), poses.taken(aside)
    if len(fitted) < LEAST_POSES:
        raise InputError(
            f"{file}: {len(fitted)} poses to fit; measure at least {LEAST_POSES}, better 30"
        )
    return PosesRig(
        said.rig.name or path.stem,
        path,
        tuple(files),
        fitted,
        kept,
        np.full(3, _positive(said.noise.extension, "m", f"{path}, [noise] extension")),
        _noise_of(said.noise, np.vstack([fitted.pose, kept.pose]), distances, path),
        {
            name: _positive(getattr(said.tolerances, name), unit, f"{path}, [tolerances] {name}")
            for name, unit in TOLERANCES.items()
        },
        distances,
    )


def _noise_of(said: NoiseTable, read: Array, distances: Sequence[Distance], path: Path) -> Array:
    """(6 + distances,): of what is not read (poses, 6 + distances) it does not matter."""
    noise = np.array([1.0] * len(CHANNELS) + [d.noise for d in distances])
    for k, (channel, unit) in enumerate(CHANNELS.items()):
        declared = getattr(said, channel)
        if not np.isfinite(read[:, k]).any():
            continue
        if declared is None:
            raise InputError(
                f"{path}, [noise]: {channel} is missing; declare its standard deviation"
            )
        noise[k] = _positive(declared, unit, f"{path}, [noise] {channel}")
    return noise


def default_tolerances() -> dict[str, float]:
    """Half widths where a file says nothing else, SI."""
    usual = TolerancesTable()
    return {n: to_si(getattr(usual, n), unit, n) for n, unit in TOLERANCES.items()}


def _point(place: Sequence[str | float], where: str) -> Array:
    return np.array([to_si(value, "m", where) for value in place])


def _positive(said: str | float, unit: str, where: str) -> float:
    value = to_si(said, unit, where)
    if not 0.0 < value < np.inf:
        raise InputError(f"{where}: {said} is not above zero")
    return value


def _read(file: Path, distances: Sequence[Distance]) -> Poses:
    try:
        cells = pd.read_csv(io.StringIO(text_of_file(file)), comment="#")
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as problem:
        raise InputError(f"{file}: no table of poses ({problem})") from None
    channels = CHANNELS | {DISTANCE + d.name: "m" for d in distances}
    units = dict.fromkeys(EXTENSIONS, "m") | channels
    if len(cells) > MOST_POSES:
        raise InputError(
            f"{file}: {len(cells)} poses are more than are calibrated at once ({MOST_POSES}); leave some out"
        )
    columns: dict[str, Array] = {}
    for header in map(str, cells.columns):
        name, unit = split_column_name(header)
        if name not in units:
            declare = f"; declare its marks in [distances.{name.removeprefix(DISTANCE)}]"
            remedy = declare if name.startswith(DISTANCE) else f"; {did_you_mean(name, units)}"
            raise InputError(f"{file}: column '{header}' is not known{remedy}")
        if unit is None:
            raise InputError(
                f"{file}: column '{header}' has no unit; write '{name} [{_USUAL[units[name]]}]'"
            )
        values = pd.to_numeric(cells[header], errors="coerce").to_numpy(dtype=np.float64)
        bad = np.flatnonzero(~np.isfinite(values) & ~cells[header].isna().to_numpy())
        if bad.size:
            raise InputError(
                f"{file}: pose {bad[0] + 1}, column '{header}': not a number; leave it empty"
            )
        columns[name] = array_to_si(values, unit, units[name], f"{file}, column '{header}'")
        most = LARGEST[units[name]]
        beyond = np.flatnonzero(np.abs(columns[name]) > most)
        if beyond.size:
            row = beyond[0]
            raise InputError(
                f"{file}: pose {row + 1}, column '{header}': {values[row]:g} {unit} is more than any platform reads "
                f"({most:.4g} {units[name]}); leave it empty, or check the unit"
            )
    for name in EXTENSIONS:
        if name not in columns or not np.isfinite(columns[name]).all():
            raise InputError(
                f"{file}: {name} is missing in a pose; every pose needs all three extensions"
            )
    absent = np.full(len(cells), np.nan)
    pose = np.column_stack([columns.get(name, absent) for name in channels])
    empty = np.flatnonzero(~np.isfinite(pose).any(axis=1))
    if empty.size:
        raise InputError(
            f"{file}: pose {empty[0] + 1} has no roll, pitch, height, yaw, x, y or distance; delete it"
        )
    extension = np.column_stack([columns[name] for name in EXTENSIONS])
    return Poses(extension, pose, np.arange(1, len(cells) + 1))


_USUAL = {"m": "mm", "rad": "deg"}
