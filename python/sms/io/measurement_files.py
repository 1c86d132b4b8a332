"""Logs of measurement systems, signal by signal: MDF 3 and 4, TDMS, MCAP, HDF5; each through its library.

What a file is, is seen in its first bytes: an MDF 4 may hold signals or the frames of a bus (can_files.py), and the
usual ending of MDF 3, .dat, is that of tables too. The libraries are the extra sms[logs].
"""

from __future__ import annotations

import importlib
import json
import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sms.errors import InputError
from sms.io.mdf_library import quiet_about_broken_files
from sms.io.table import Table
from sms.io.time_base import Group, named, on_one_time, raise_if_too_many, vectors

_OPENINGS = {
    b"MDF ": "MDF",
    b"UnFinMF ": "MDF",
    b"TDSm": "TDMS",
    b"\x89MCAP": "MCAP",
    b"\x89HDF": "HDF5",
}
_PACKAGE = {"MDF": "asammdf", "TDMS": "nptdms", "MCAP": "mcap", "HDF5": "h5py"}
ENDINGS = (".mf4", ".mdf", ".dat", ".tdms", ".mcap", ".h5", ".hdf5")


def measurement_format(file: Path) -> str | None:
    """ "MDF", "TDMS", "MCAP" or "HDF5" by the first bytes of a file; None for another kind."""
    try:
        with file.open("rb") as opened:
            first = opened.read(16)
    except OSError:
        return None
    return next((name for opening, name in _OPENINGS.items() if first.startswith(opening)), None)


def holds_frames(file: Path) -> bool:
    """Whether an MDF holds frames of a bus; those that cannot be opened are said by who reads frames."""
    try:
        return _holds_frames(file, file.stat().st_mtime_ns)
    except (InputError, OSError):
        return True


@lru_cache(maxsize=64)
def _holds_frames(file: Path, changed: int) -> bool:
    with _library(file, "MDF") as asammdf, asammdf.MDF(file) as log:
        return any(c.name.startswith("CAN_") for g in log.groups for c in g.channels)


def read_measurement(file: Path, form: str) -> Table:
    """All signals of numbers on one time base (time_base.py). InputError for a broken file, or a missing package."""
    with _library(file, form) as library:
        return _READERS[form](file, library)


@contextmanager
def _library(file: Path, form: str) -> Iterator[Any]:
    """The package that reads a format; whatever it raises becomes a sentence."""
    package = _PACKAGE[form]
    try:
        library = importlib.import_module(package)
    except ImportError:
        raise InputError(
            f'{file}: {form} files need one more package; pip install "sms[logs]", or save it as .csv'
        ) from None
    # What it would print stands in the sentence.
    logging.getLogger(package).setLevel(logging.CRITICAL)
    if form == "MDF":
        quiet_about_broken_files()
    try:
        yield library
    except InputError:
        raise
    except Exception as problem:  # each library has errors of its own
        raise InputError(
            f"{file}: not a readable {form} file ({problem}); it may have been cut off, save it again"
        ) from None


# ---- formats ---------------------------------------------------------------------------------------


def _read_mdf(file: Path, asammdf: Any) -> Table:
    groups = []
    with asammdf.MDF(file) as log:
        raise_if_too_many(
            file, sum(g.channel_group.cycles_nr * len(g.channels) for g in log.groups)
        )
        for number, group in enumerate(log.groups):
            signals: dict[str, NDArray[np.generic]] = {}
            time: NDArray[np.generic] = np.empty(0)
            master = log.masters_db.get(number)
            for channel in range(len(group.channels)):
                if channel == master:
                    continue
                read = log.get(group=number, index=channel)
                if read.samples.ndim == 1 and read.samples.dtype.kind in "fiu":
                    signals[named(read.name, read.unit)] = read.samples
                    time = read.timestamps
            name = group.channel_group.acq_name if hasattr(group.channel_group, "acq_name") else ""
            groups.append(Group(name or f"group {number + 1}", time.astype(np.float64), signals))
    return on_one_time(file, groups)


def _read_tdms(file: Path, nptdms: Any) -> Table:
    groups, plain = [], {}
    with nptdms.TdmsFile.open(str(file)) as log:
        channels = [c for g in log.groups() for c in g.channels() if c.dtype.kind in "fiu"]
        raise_if_too_many(file, sum(len(c) for c in channels))
        several = len({c.group_name for c in channels}) > 1
        for channel in channels:
            name = f"{channel.group_name}.{channel.name}" if several else channel.name
            name = named(name, str(channel.properties.get("unit_string", "")))
            if len(channel) > 1 and {"wf_increment", "wf_start_offset"} <= set(channel.properties):
                groups.append(Group(name, np.asarray(channel.time_track()), {name: channel[:]}))
            else:
                plain[name] = channel[:]
    return on_one_time(file, groups) if groups else vectors(file, plain)


def _read_mcap(file: Path, mcap: Any) -> Table:
    reader = importlib.import_module("mcap.reader")
    columns: dict[str, dict[str, list[tuple[float, float]]]] = {}
    numbers, unread = 0, set()
    with file.open("rb") as opened:
        for _, channel, message in reader.make_reader(opened).iter_messages():
            if channel.message_encoding != "json":
                unread.add(channel.message_encoding)
                continue
            topic = columns.setdefault(channel.topic, {})
            for name, value in _numbers_in(json.loads(message.data)):
                topic.setdefault(name, []).append((1e-9 * message.log_time, value))
                numbers += 1
            raise_if_too_many(file, numbers)
    if not columns and unread:
        raise InputError(
            f"{file}: its messages are encoded as {', '.join(sorted(unread))}; JSON is read, so convert it, or "
            "export the topics as .csv"
        )
    start = min((c[0][0] for t in columns.values() for c in t.values()), default=0.0)
    groups = []
    for path, of_topic in columns.items():
        for name, pairs in of_topic.items():
            time, values = np.array(pairs).T
            called = f"{path.strip('/').replace('/', '.')}.{name}"
            groups.append(Group(called, time - start, {called: values}))
    return on_one_time(file, groups)


def _numbers_in(content: Any, name: str = "") -> Iterator[tuple[str, float]]:
    """ "pose.x", 1.0: every number of a message of JSON."""
    if isinstance(content, Mapping):
        for key, value in content.items():
            yield from _numbers_in(value, f"{name}.{key}" if name else str(key))
    elif isinstance(content, list):
        for number, value in enumerate(content, start=1):
            yield from _numbers_in(value, f"{name}({number})")
    elif isinstance(content, int | float) and not isinstance(content, bool):
        yield name or "value", float(content)


def _read_hdf5(file: Path, h5py: Any) -> Table:
    found: dict[str, Any] = {}

    def visit(path: str, item: Any) -> None:
        if not isinstance(item, h5py.Dataset) or item.dtype.kind not in "fiu":
            return
        if item.ndim == 1 or (item.ndim == 2 and 1 in item.shape):
            unit = item.attrs.get("unit", item.attrs.get("units", ""))
            unit = unit.decode() if isinstance(unit, bytes) else str(unit)
            found[named(path.replace("/", "."), unit)] = item

    with h5py.File(file, "r") as log:
        log.visititems(visit)
        raise_if_too_many(file, sum(item.size for item in found.values()))
        return vectors(file, {name: item[()].ravel() for name, item in found.items()})


_READERS: Mapping[str, Callable[[Path, Any], Table]] = MappingProxyType(
    {"MDF": _read_mdf, "TDMS": _read_tdms, "MCAP": _read_mcap, "HDF5": _read_hdf5}
)
