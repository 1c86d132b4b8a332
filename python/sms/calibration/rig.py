"""A rig file of kind "poses": measured poses with their noise, and the tolerances of the drawing."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from sms.arrays import Array
from sms.errors import InputError, did_you_mean
from sms.io.units import array_to_si, split_column_name, to_si

CHANNELS = {"roll": "rad", "pitch": "rad", "height": "m", "yaw": "rad", "x": "m", "y": "m"}
"""What may be measured of a pose, with its unit, in the order of the core."""
EXTENSIONS = ("extension_1", "extension_2", "extension_3")
TOLERANCES = {
    "joint": ("m", 5e-3),
    "length": ("m", 5e-3),
    "sensor_gain": ("1", 5e-3),
    "extension_zero": ("m", 1e-3),
    "attitude_zero": ("rad", 2e-3),
}
"""Half widths of what the drawing says, two standard deviations: unit and default."""
LEAST_POSES = 6
KEPT_ASIDE = 5
"""Every so many poses one is a validation pose, where no file of them is named."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses as read: extension (n, 3) m; pose (n, 6) rad and m, NaN where not measured; row (n,) of the file."""

    extension: Array
    pose: Array
    row: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.extension)

    def taken(self, which: NDArray[np.bool_]) -> Poses:
        return Poses(self.extension[which], self.pose[which], self.row[which])


@dataclass(frozen=True, eq=False)
class PosesRig:
    """What a calibration is made from, SI."""

    title: str
    path: Path
    files: tuple[Path, ...]
    fitted: Poses
    validation: Poses
    extension_noise: Array  #: (3,) standard deviations
    pose_noise: Array  #: (6,)
    tolerances: Mapping[str, float]  #: half widths, by the names of TOLERANCES


def load_poses(path: Path) -> PosesRig:
    """Read the rig file and its poses. InputError with file, key and remedy for what cannot be used."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as problem:
        raise InputError(f"{path}: cannot be read ({problem.strerror}); name a rig file") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as problem:
        raise InputError(f"{path}: not TOML ({problem}); correct that line") from None
    _known(content, ("rig", "noise", "tolerances"), f"{path}")
    rig = _table(content, "rig", path)
    _known(rig, ("name", "kind", "poses", "validation"), f"{path}, [rig]")
    if rig.get("kind") != "poses":
        raise InputError(
            f"{path}, [rig] kind: '{rig.get('kind')}' holds no poses; sms calibrate geometry reads kind 'poses'"
        )
    if "poses" not in rig:
        raise InputError(
            f'{path}, [rig]: the file of the poses is missing; write poses = "poses.csv"'
        )
    file = path.parent / str(rig["poses"])
    poses = _read(file)
    files = [path, file]
    if "validation" in rig:
        other = path.parent / str(rig["validation"])
        fitted, kept = poses, _read(other)
        files.append(other)
    else:
        aside = np.arange(len(poses)) % KEPT_ASIDE == KEPT_ASIDE - 1
        fitted, kept = poses.taken(~aside), poses.taken(aside)
    if len(fitted) < LEAST_POSES:
        raise InputError(
            f"{file}: {len(fitted)} poses to fit; measure at least {LEAST_POSES}, better 30"
        )
    noise = _table(content, "noise", path)
    _known(noise, ("extension", *CHANNELS), f"{path}, [noise]")
    pose_noise = np.ones(6)
    both = np.vstack([fitted.pose, kept.pose])
    for k, (channel, unit) in enumerate(CHANNELS.items()):
        if np.isfinite(both[:, k]).any():
            pose_noise[k] = _positive(noise, channel, unit, f"{path}, [noise]")
    extension = _positive(noise, "extension", "m", f"{path}, [noise]")
    declared = content.get("tolerances", {})
    _known(declared, tuple(TOLERANCES), f"{path}, [tolerances]")
    tolerances = {
        name: _positive(declared, name, unit, f"{path}, [tolerances]")
        if name in declared
        else default
        for name, (unit, default) in TOLERANCES.items()
    }
    title = str(rig.get("name", path.stem))
    return PosesRig(
        title, path, tuple(files), fitted, kept, np.full(3, extension), pose_noise, tolerances
    )


def _read(file: Path) -> Poses:
    try:
        cells = pd.read_csv(file, comment="#")
    except OSError as problem:
        raise InputError(
            f"{file}: cannot be read ({problem.strerror}); correct the name in [rig]"
        ) from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as problem:
        raise InputError(f"{file}: no table of poses ({problem})") from None
    units = dict.fromkeys(EXTENSIONS, "m") | CHANNELS
    columns: dict[str, Array] = {}
    for header in map(str, cells.columns):
        name, unit = split_column_name(header)
        if name not in units:
            raise InputError(f"{file}: column '{header}' is not known; {did_you_mean(name, units)}")
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
    for name in EXTENSIONS:
        if name not in columns or not np.isfinite(columns[name]).all():
            raise InputError(
                f"{file}: {name} is missing in a pose; every pose needs all three extensions"
            )
    absent = np.full(len(cells), np.nan)
    pose = np.column_stack([columns.get(name, absent) for name in CHANNELS])
    empty = np.flatnonzero(~np.isfinite(pose).any(axis=1))
    if empty.size:
        raise InputError(
            f"{file}: pose {empty[0] + 1} has no roll, pitch, height, yaw, x or y; delete it"
        )
    extension = np.column_stack([columns[name] for name in EXTENSIONS])
    return Poses(extension, pose, np.arange(1, len(cells) + 1))


_USUAL = {"m": "mm", "rad": "deg"}


def _table(content: Mapping[str, Any], name: str, path: Path) -> Mapping[str, Any]:
    table = content.get(name)
    if not isinstance(table, dict):
        raise InputError(
            f"{path}: the table [{name}] is missing; docs/calibration.md shows a whole file"
        )
    return table


def _known(table: Any, names: tuple[str, ...], where: str) -> None:
    if not isinstance(table, dict):
        raise InputError(f"{where}: not a table; docs/calibration.md shows a whole file")
    for name in table:
        if name not in names:
            raise InputError(f"{where}: '{name}' is not known; {did_you_mean(name, names)}")


def _positive(table: Mapping[str, Any], name: str, unit: str, where: str) -> float:
    if name not in table:
        raise InputError(f"{where}: {name} is missing; declare its standard deviation")
    value = to_si(table[name], unit, f"{where} {name}")
    if not 0.0 < value < np.inf:
        raise InputError(f"{where} {name}: {table[name]} is not above zero")
    return value
