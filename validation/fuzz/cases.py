"""One spoilt input, drawn by a seed and a number: the files in a folder, and the command to run there."""

from __future__ import annotations

import gzip
import shutil
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from validation.fuzz.inputs import BASES, Base
from validation.fuzz.mutated_tables import TABLES, as_matlab, as_parquet
from validation.fuzz.mutated_text import spoil_json, spoil_log, spoil_toml, spoil_words
from validation.fuzz.mutations import Mutation, Random, pick, spoil_bytes, spoil_packing

WEIGHTS = np.array([base.weight for base in BASES])


@dataclass(frozen=True)
class Case:
    """What a number stands for."""

    base: Base
    command: tuple[str, ...]
    spoilt: str  #: what was done, in words


def base_of(seed: int, number: int) -> tuple[Base, Random]:
    """Which input is spoilt, and the generator that says how."""
    random = np.random.default_rng([seed, number])
    return BASES[int(random.choice(len(BASES), p=WEIGHTS / WEIGHTS.sum()))], random


def make(seed: int, number: int, root: Path, folder: Path) -> Case:
    """Copy an input of `root` into `folder`, and spoil it there, once to three times."""
    base, random = base_of(seed, number)
    shutil.copytree(root / base.folder, folder)
    command, done = base.command, []
    if random.uniform() < base.words:
        for _ in range(1 + int(random.integers(2))):
            command = spoil_words(command, random)
        done.append("words")
    files = sorted({f for pattern in base.spoils for f in folder.glob(pattern)})
    while files and (not done or random.uniform() < 0.25):
        toml = [f for f in files if f.suffix == ".toml"]
        among = toml if toml and random.integers(3) == 0 else files
        file = among[int(random.integers(len(among)))]
        if not file.exists():  # it has another name by now
            break
        how, new = spoil(file, folder, random)
        done.append(f"{how} of {file.name}")
        if random.uniform() < 0.05:
            new = _renamed(new, random)
        if new.name != file.name:
            _rename(file.name, new.name, folder)
            command = tuple(new.name if word == file.name else word for word in command)
    return Case(base, command, ", ".join(done))


def spoil(file: Path, folder: Path, random: Random) -> tuple[str, Path]:
    """What was done to a file, and the file, which may have another ending now."""
    content = file.read_bytes()
    packed = file.suffix == ".gz"
    if packed:
        content = _unpacked(content)
    how: Mutation = spoil_bytes
    if file.suffix in (".toml", ".dbc"):
        how = spoil_toml if random.uniform() < 0.9 else spoil_bytes
    elif file.suffix == ".json":
        how = spoil_json if random.uniform() < 0.9 else spoil_bytes
    elif file.stem == "run" or file.suffix == ".asc":
        how = spoil_log if random.uniform() < 0.7 else spoil_bytes
    else:
        other = random.uniform()
        if other < 0.12 and (new := _in_format(file, content, random)) is not None:
            return f"{new.suffix}", new
        how = pick(TABLES, random)
    spoilt = how(content, random)
    if packed:
        spoilt = (
            spoil_packing(spoilt, random)
            if random.integers(3) == 0
            else gzip.compress(spoilt, 1, mtime=0)
        )
    file.write_bytes(spoilt)
    return how.__name__, file


def _unpacked(content: bytes) -> bytes:
    """What a packed file holds; as it is, where an earlier mutation spoilt the packing."""
    try:
        return gzip.decompress(content)
    except (OSError, EOFError, zlib.error):
        return content


def _in_format(file: Path, content: bytes, random: Random) -> Path | None:
    """A record that is text as Parquet or .mat, packed text, or as what only says so; None: it cannot be read."""
    ending = str(random.choice([".parquet", ".mat", ".csv.gz", ".blf", ".xlsx", ".mf4"]))
    new = file.with_name(file.name.removesuffix(".gz").removesuffix(".csv") + ending)
    makers = {
        ".parquet": as_parquet,
        ".mat": as_matlab,
        ".csv.gz": spoil_packing,
    }
    try:
        new.write_bytes(makers.get(ending, spoil_bytes)(content, random))
    except Exception:  # spoilt before, so that it is no table
        return None
    return new


def _renamed(file: Path, random: Random) -> Path:
    """The same file under a name that is odd."""
    names = ("[red]", "ünï", "a b", "\udcff", "-x", "%s", "'", "日本", "..x", "{0}")
    return file.rename(file.with_name(pick(names, random) + file.suffix))


def _rename(old: str, new: str, folder: Path) -> None:
    for toml in folder.glob("*.toml"):
        text = toml.read_bytes().replace(old.encode(), new.encode("utf-8", "surrogateescape"))
        toml.write_bytes(text)
