"""Spoils records of virtual machines as a day at the bench does: clocks, cables, ranges, and a rig file that is wrong.

Each function changes the files of one folder of records in place. What they make has one honest answer: the verdict
data-fault, or a cause that says what is wrong; never another cause.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from validation.twins.draw import draw

Array = NDArray[np.float64]


def healthy(kind: str, seed: int, folder: Path) -> Path:
    """Records of a machine with nothing wrong."""
    draw(kind, seed, folder, folder.with_suffix(".truth"), "none")
    return folder


def contradict(
    kind: str, seed: int, folder: Path, effect: str, record: int, multiple: float
) -> None:
    """One record is of another machine: the same but for one effect."""
    other = folder.with_name(folder.name + "_other")
    draw(kind, seed, other, other.with_suffix(".truth"), effect, multiple)
    name = records(folder)[record].name
    shutil.copy(other / name, folder / name)


def records(folder: Path) -> list[Path]:
    return sorted(folder.glob("*.csv"))


def spoil(folder: Path, signal: str, how: Callable[[int, Array, Array], Array]) -> None:
    """Replace a signal in every record by how(number of the record, time, values)."""
    for number, path in enumerate(records(folder)):
        head, *rows = path.read_text().splitlines()
        column = [name.partition(" [")[0] for name in head.split(",")].index(signal)
        table = np.array([[float(cell) for cell in row.split(",")] for row in rows])
        table[:, column] = how(number, table[:, 0], table[:, column])
        lines = [",".join(f"{value:.8g}" for value in row) for row in table]
        path.write_text("\n".join([head, *lines]) + "\n")


def late_clock(folder: Path, signal: str, late: Sequence[float]) -> None:
    """A logger of its own, `late` s behind in each record."""
    spoil(folder, signal, lambda i, time, values: np.interp(time - late[i], time, values))


def dead(folder: Path, signal: str, noise: float) -> None:
    """A sensor without its cable: one value, and what the amplifier adds."""
    random = np.random.default_rng(1)
    spoil(
        folder,
        signal,
        lambda i, time, values: np.median(values) + random.normal(0.0, noise, values.size),
    )


def saturated(folder: Path, signal: str) -> None:
    """A range that ends at the median of what there is to measure."""
    spoil(folder, signal, lambda i, time, values: np.minimum(values, np.median(values)))


def declare(folder: Path, parameter: str, factor: float) -> None:
    """The rig file says `factor` times what was meant."""
    path = folder / "rig.toml"
    text = path.read_text()
    found = re.search(rf'^({parameter} = {{ value = "?)([-+.0-9e]+)', text, re.MULTILINE)
    if found is None:
        raise ValueError(f"{path} does not declare {parameter}")
    wrong = f"{found[1]}{factor * float(found[2]):g}"
    path.write_text(text.replace(found[0], wrong))


def leg_as_bench(seed: int, leg: int, folder: Path) -> Path:
    """Records of one leg under a platform, and the rig file of a bench with nothing on its rod."""
    platform = healthy("platform", seed, folder.with_name(folder.name + "_platform"))
    folder = healthy("bench", seed, folder)
    text = (folder / "rig.toml").read_text()
    head = text.partition("[[records]]")[0]
    for old in records(folder):
        old.unlink()
    entries = []
    for path in records(platform):
        role = path.stem.partition("_")[0]
        names, *rows = path.read_text().splitlines()
        keep = {
            k: name.replace(f"_{leg} [", " [")
            for k, name in enumerate(names.split(","))
            if name.partition(" [")[0] in ("time", "supply_pressure") or f"_{leg} [" in name
        }
        cells = [[row.split(",")[k] for k in keep] for row in rows]
        lines = [",".join(keep.values()), *(",".join(row) for row in cells)]
        (folder / path.name).write_text("\n".join(lines) + "\n")
        entries.append(f'[[records]]\nfile = "{path.name}"\nrole = "{role}"\n')
    (folder / "rig.toml").write_text(head + "\n".join(entries))
    return folder
