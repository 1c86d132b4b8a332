"""MATLAB's .mat files: vectors, structures, Simulink's "structure with time", timeseries and Simulink.SimulationData.

Files up to version 7 are scipy's; version 7.3 (which is HDF5) and objects are read by mat-io (the extra sms[logs]).
What has times of its own (a structure with time, a timeseries) becomes a group of signals (time_base.py); all else is
vectors.
"""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
from numpy.typing import NDArray

from sms.errors import InputError
from sms.io.table import Table
from sms.io.time_base import Group, named, on_one_time, raise_if_too_many, vectors

DEEPEST = 12
"""Structures within structures: a log has a few."""


def read_matlab(file: Path, columns: Sequence[str] | None) -> Table:
    """Everything that is a signal; `columns` names those of the one matrix of the file."""
    found = _Found()
    for name, variable in _variables(file).items():
        if not name.startswith("__"):
            found.take(name, variable)
    raise_if_too_many(file, found.numbers)
    if columns is not None:
        fitting = [a for a in found.arrays.values() if a.ndim == 2 and a.shape[1] == len(columns)]
        if len(fitting) != 1:
            raise InputError(
                f"{file}: {len(fitting)} matrices with {len(columns)} columns, one is needed for "
                "the names in [data] columns"
            )
        return vectors(file, {name: fitting[0][:, i] for i, name in enumerate(columns)})
    if found.groups:
        return on_one_time(file, found.groups)
    return vectors(file, {n: a.ravel() for n, a in found.arrays.items() if 1 in a.shape})


def _variables(file: Path) -> Mapping[str, Any]:
    try:
        found = scipy.io.loadmat(str(file), struct_as_record=True)
    except NotImplementedError:  # version 7.3
        return _by_mat_io(file)
    except Exception as problem:  # scipy answers a broken file with errors of many kinds
        raise InputError(f"{file}: not a readable .mat file ({problem}); save it again") from None
    opaque = scipy.io.matlab.MatlabOpaque
    if any(isinstance(v, opaque) or n == "__function_workspace__" for n, v in found.items()):
        return _by_mat_io(file)
    return found


def _by_mat_io(file: Path) -> Mapping[str, Any]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            matio = importlib.import_module("matio")
    except ImportError:
        raise InputError(
            f"{file}: MATLAB 7.3 files, timeseries and other objects need one more package; pip install "
            '"sms[logs]", or save plain vectors with  save -v7'
        ) from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return dict(matio.load_from_mat(str(file)))
    except Exception as problem:  # errors of h5py and of its own
        raise InputError(f"{file}: not a readable .mat file ({problem}); save it again") from None


# ---- what is in it -------------------------------------------------------------------------------


@dataclass
class _Found:
    """What the variables of a file hold."""

    arrays: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    groups: list[Group] = field(default_factory=list)

    @property
    def numbers(self) -> int:
        of_groups = sum(len(g.time) * (1 + len(g.signals)) for g in self.groups)
        return of_groups + sum(a.size for a in self.arrays.values())

    def take(self, name: str, value: Any, depth: int = 0) -> None:
        """A variable, a field "log.time" or an element "log(2)", and what is in it."""
        if depth > DEEPEST:
            return
        if (fields := _fields(value)) is not None:
            self._take_structure(name, fields, depth)
            return
        array = np.asarray(value)
        if array.dtype.kind == "O" or array.dtype.names is not None:
            for number, element in enumerate(array.ravel(), start=1):
                self.take(name if array.size == 1 else f"{name}({number})", element, depth + 1)
        elif array.dtype.kind in "fiu" and array.ndim <= 2 and array.size > 1:
            self.arrays[name] = array if array.ndim == 2 else array[:, None]

    def _take_structure(self, name: str, fields: Mapping[str, Any], depth: int) -> None:
        time = _time_of(fields)
        if time is not None and "signals" in fields:  # a structure with time
            signals: dict[str, NDArray[np.generic]] = {}
            for number, of_one in enumerate(np.asarray(fields["signals"]).ravel(), start=1):
                parts = _fields(of_one) or {}
                label = _text(parts.get("label")) or f"{name}.signals({number})"
                signals |= _columns(label, parts.get("values"), len(time))
            self.groups.append(Group(name, time, signals))
            return
        data = next((fields[k] for k in ("Data_", "Data") if k in fields), None)
        if time is not None and data is not None:  # a timeseries
            unit = _text((_fields(fields.get("DataInfo")) or {}).get("Units"))
            label = _text(fields.get("Name")) or name
            self.groups.append(Group(name, time, _columns(named(label, unit), data, len(time))))
            return
        for part, content in fields.items():
            self.take(f"{name}.{part}", content, depth + 1)


def _fields(value: Any) -> dict[str, Any] | None:
    """Of a single structure, or of an object its properties; None for anything else."""
    properties = getattr(value, "properties", None)
    if isinstance(properties, Mapping):
        return dict(properties)
    if isinstance(value, Mapping):
        return dict(value)
    names = getattr(getattr(value, "dtype", None), "names", None)
    if names is None:
        return None
    if isinstance(value, np.ndarray):
        if value.size != 1:
            return None
        value = value.ravel()[0]
    return dict(zip(names, value, strict=True))


def _time_of(fields: Mapping[str, Any]) -> NDArray[np.float64] | None:
    """(samples,) s of a structure with time or a timeseries, whose even times may be said in two numbers."""
    for key in ("time", "Time", "Time_"):
        values = np.asarray(fields.get(key, []))
        if values.dtype.kind in "fiu" and values.size > 1 and values.size == max(values.shape):
            return np.array(values.ravel(), dtype=np.float64)
    told = _fields(fields.get("TimeInfo"))
    if told is None:
        return None
    numbers = [
        np.asarray(next((told[k] for k in keys if k in told), [])).ravel()
        for keys in (("Start", "Start_"), ("Increment", "Increment_"), ("Length", "Length_"))
    ]
    if any(n.size != 1 or n.dtype.kind not in "fiu" for n in numbers):
        return None
    start, step, length = (float(n[0]) for n in numbers)
    if not (np.isfinite(start) and step > 0.0 and 1 < length < 1e9):
        return None
    return np.array(start + step * np.arange(int(length)), dtype=np.float64)


def _columns(name: str, values: Any, samples: int) -> dict[str, NDArray[np.generic]]:
    """Signals (samples,) of one array, whichever way round its samples lie."""
    array = np.squeeze(np.asarray(values))
    if array.dtype.kind not in "fiub" or array.ndim not in (1, 2) or samples not in array.shape:
        return {}
    if array.ndim == 1:
        return {name: array}
    array = array if array.shape[0] == samples else array.T
    return {f"{name}({k + 1})": array[:, k] for k in range(array.shape[1])}


def _text(value: Any) -> str:
    array = np.asarray("" if value is None else value)
    while array.dtype.kind == "O" and array.size == 1:
        array = np.asarray(array.ravel()[0])
    return str(array.ravel()[0]).strip() if array.dtype.kind in "US" and array.size else ""
