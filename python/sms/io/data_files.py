"""Where the files that a rig file names are found: its records, and what lies beside it."""

from __future__ import annotations

import os
from pathlib import Path

from sms.errors import InputError, nearest
from sms.io.schema import DataTable
from sms.io.toml_tables import place


def beside(path: Path, name: str, where: str, what: str) -> Path:
    """The file that the rig file `path` names, relative to its own folder; what: "rig file", "DBC file"."""
    file = (path.parent / _named(name, path, where)).resolve()
    if not _is_file(file):
        near = nearest(file.name, (f.name for f in path.parent.glob(f"*{file.suffix or '.*'}")))
        remedy = f"did you mean '{near}'?" if near else f"name a {what} beside the rig file"
        raise InputError(f"{path}, {where}: there is no {what} {file}; {remedy}")
    return file


def _named(name: str, path: Path, where: str) -> Path:
    """A file's or folder's name in the rig file `path`, "~" expanded; InputError for what no path can be."""
    try:
        if "\0" in name:
            raise ValueError
        return Path(name).expanduser()
    except (ValueError, RuntimeError):
        raise InputError(f"{path}, {where}: {name[:60]!r} cannot be a path; check it") from None


def _is_file(file: Path) -> bool:
    """Whether there is such a file; a name that the file system refuses is none."""
    try:
        return file.is_file()
    except OSError:
        return False


def find_files(names: list[str], data: DataTable, path: Path) -> list[Path]:
    """The record files, all under one place: $SMS_DATA, beside the rig file, ../shared/data.

    The first place that has every file is taken. InputError lists the places looked at.
    """
    folder = _named(data.folder or "", path, "[data] folder")
    for number, name in enumerate(names):
        _named(name, path, place("records", number, "file"))
    places = [place_ / folder for place_ in search_places(path)] if not folder.is_absolute() else []
    for where in places or [folder]:
        if (files := files_in(where, names)) is not None:
            return files
    raise InputError(_nowhere(names, places or [folder], data, path))


def files_in(folder: Path, names: list[str]) -> list[Path] | None:
    """The named files in one folder, or None when one is missing."""
    files = [_on_disk(folder / Path(name).expanduser()) for name in names]
    found = [file for file in files if file is not None]
    return found if len(found) == len(names) else None


def _on_disk(file: Path) -> Path | None:
    """The file, or the same one packed or unpacked ("run.csv.gz" for "run.csv" and back)."""
    file = file.resolve()
    if not file.name:
        return None
    twin = file.with_suffix("") if file.suffix == ".gz" else file.with_name(file.name + ".gz")
    return next((candidate for candidate in (file, twin) if _is_file(candidate)), None)


def search_places(path: Path) -> list[Path]:
    """Where a relative data path of the rig file `path` is looked up, in this order."""
    named = os.environ.get("SMS_DATA")
    places = [Path(named).expanduser()] if named else []
    return [*places, path.parent, Path("../shared/data")]


def _nowhere(names: list[str], places: list[Path], data: DataTable, path: Path) -> str:
    """The sentence for records that are not on disk: which, the places looked at, the remedy."""

    def missing_in(folder: Path) -> list[str]:
        return [name for name in names if _on_disk(folder / name) is None]

    best = min(places, key=lambda folder: len(missing_in(folder)))
    missing = missing_in(best)
    if len(missing) < len(names) or (data.folder and best.is_dir()):
        near = nearest(missing[0], (file.name for file in best.iterdir()))
        hint = f"did you mean '{near}'?" if near else "check the name, or put the file there"
        where = place("records", names.index(missing[0]), "file")
        return f"{path}, {where}: there is no file '{missing[0]}' in {best.resolve()}; {hint}"
    what = f"the data folder '{data.folder}'" if data.folder else f"the record '{missing[0]}'"
    looked = ", ".join(str(folder.resolve()) for folder in places)
    obtain = f"it can be had from {data.obtain}" if data.obtain else "put it into one of these"
    return (
        f"{path}: {what} is nowhere (looked in: {looked}); {obtain}, "
        "or set SMS_DATA to the folder that holds it"
    )
