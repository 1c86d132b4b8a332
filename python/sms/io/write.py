"""Writing: files that are there whole or not at all, records as CSV, and the extended rig file."""

from __future__ import annotations

import gzip
import importlib
import io
import os
import secrets
import tempfile
import warnings
from collections.abc import Mapping, MutableMapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tomlkit
from numpy.typing import ArrayLike
from tomlkit.items import InlineTable

from sms.errors import InputError, did_you_mean
from sms.io.data_files import files_in
from sms.io.declarations import Declaration, check_bounds, least_uncertainty
from sms.io.rig import interpret
from sms.io.schema import parse_rig_text, read_rig_text
from sms.io.signals import column_name
from sms.io.units import from_si, interval_from_si, split_column_name, split_quantity
from sms.parameters import Parameter


def check_output_folder(out: Path) -> None:
    """InputError, before any work, if nothing can be written into the folder."""
    existing = next(p for p in (out, *out.absolute().parents) if p.exists())
    if not existing.is_dir():
        raise InputError(f"{existing}: this is a file, not a folder; choose another --out")
    if not os.access(existing, os.W_OK):
        raise InputError(f"{existing}: cannot be written to; choose another --out")


def write_bytes_atomically(path: Path, content: bytes) -> None:
    """Write a file so that a reader sees the old one or the new one, never a part.

    The new one is written beside it and then takes its name. What is no file (/dev/stdout, a pipe) is written to and
    stays. InputError when that cannot be done.
    """
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}.tmp")
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            path.write_bytes(content)
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with temporary.open("xb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as problem:
        raise InputError(
            f"{path}: cannot be written ({problem.strerror}); choose another output folder"
        ) from None


def write_text_atomically(path: Path, text: str) -> None:
    """As `write_bytes_atomically`, for text in UTF-8; a byte of a file's name that is none becomes its code."""
    write_bytes_atomically(path, text.encode("utf-8", "backslashreplace"))


def write_table(path: Path, columns: Mapping[str, ArrayLike]) -> None:
    """Write columns (samples,) named "name [unit]": .mat, .parquet, else CSV; gzip when the name ends with .gz."""
    if path.suffix in (".mat", ".parquet"):
        (write_matlab if path.suffix == ".mat" else write_parquet)(path, columns)
        return
    text = pd.DataFrame({name: np.asarray(c) for name, c in columns.items()}).to_csv(index=False)
    content = text.encode("utf-8")
    if path.suffix == ".gz":
        content = gzip.compress(content, mtime=0)  # without the time: equal tables, equal files
    write_bytes_atomically(path, content)


def write_parquet(path: Path, columns: Mapping[str, ArrayLike]) -> None:
    """The same as Parquet."""
    buffer = io.BytesIO()
    frame = pd.DataFrame({name: np.asarray(c) for name, c in columns.items()})
    frame.to_parquet(buffer, index=False)
    write_bytes_atomically(path, buffer.getvalue())


def write_matlab(path: Path, columns: Mapping[str, ArrayLike]) -> None:
    """The same as MATLAB 7.3: `run`, a structure with time, as Simulink's From Workspace block takes it and as
    `matlab_files.py` reads it. InputError without the extra sms[logs], or a column of times."""
    arrays = {name: np.asarray(c, dtype=np.float64)[:, None] for name, c in columns.items()}
    time = next((n for n in arrays if split_column_name(n)[0] == "time"), None)
    if time is None:
        raise InputError(f"{path}: a structure with time needs a column time; write .csv")
    signals = np.zeros(
        (1, len(arrays) - 1), dtype=[("values", "O"), ("label", "O"), ("dimensions", "O")]
    )
    for k, name in enumerate(n for n in arrays if n != time):
        signals[0, k] = arrays[name], np.array([name]), np.array([[1.0]])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            matio = importlib.import_module("matio")
    except ImportError:
        raise InputError(
            f'{path}: MATLAB files need one more package; pip install "sms[logs]", or write .csv'
        ) from None
    with tempfile.TemporaryDirectory() as folder:
        there = Path(folder) / "run.mat"
        matio.save_to_mat(
            str(there), {"run": {"time": arrays[time], "signals": signals}}, version="v7.3"
        )
        write_bytes_atomically(path, there.read_bytes())


def write_record(path: Path, signals: Mapping[str, ArrayLike]) -> None:
    """Write signals in SI units (pressures absolute) under the project's own column names."""
    write_table(path, {column_name(signal): values for signal, values in signals.items()})


def write_extended_rig(
    original_path: Path,
    out_path: Path,
    parameter_updates: Mapping[str, Declaration],
    header_comment: str,
) -> None:
    """Write the rig file again with parameters (SI) set or changed, all else as its author left it.

    Comments and order stay; a value keeps the unit it was written in. `header_comment` goes to the
    top. A data folder beside the original is still found from the new place. The result is checked
    by the same reader before it replaces anything.
    """
    text = read_rig_text(original_path)
    rig = interpret(parse_rig_text(text, original_path), original_path)
    document = tomlkit.parse(text)
    if "parameters" not in document:
        document.add(tomlkit.nl())
        document.add("parameters", tomlkit.table())
    table: Any = document["parameters"]
    for name, declaration in parameter_updates.items():
        where = f"{out_path}, [parameters] {name}"
        if name not in rig.table:
            raise InputError(
                f"{where}: there is no such parameter; {did_you_mean(name, rig.table)}"
            )
        _set_parameter(table, rig.table[name], declaration, where)
    _keep_data_reachable(document, original_path, out_path)
    _keep_neighbours_reachable(document, original_path, out_path)
    header = "".join(f"# {line}".rstrip() + "\n" for line in header_comment.splitlines())
    extended = f"{header}\n{tomlkit.dumps(document)}"
    again = interpret(parse_rig_text(extended, out_path), out_path)
    if [record.file for record in again.records] != [record.file for record in rig.records]:
        raise InputError(
            f"{out_path}: other records would be found from here than from {original_path}; "
            "write it into another folder"
        )
    write_text_atomically(out_path, extended)


def _set_parameter(table: Any, parameter: Parameter, declaration: Declaration, where: str) -> None:
    """Set one entry of [parameters], in place where there is one."""
    name = parameter.name
    check_bounds(parameter, declaration.value, where)
    old = table.get(name)
    entry = old if isinstance(old, Mapping) else {"value": old}
    unit = "" if parameter.unit == "1" else parameter.unit
    for key in ("value", "uncertainty"):  # the unit the author wrote, the value's before the other
        if entry.get(key) is not None:
            unit = split_quantity(_plain(entry[key]), parameter.unit, where)[1]
            break
    # A standard error may be wider than the range, which says as much as a half width, or narrower than what is read.
    half_width = min(declaration.uncertainty, parameter.upper - parameter.lower)
    if half_width > 0.0:
        rounding = 1.0 + 1e-9
        half_width = max(half_width, rounding * least_uncertainty(parameter))
    new: dict[str, object] = {
        "value": _written(from_si(declaration.value, unit, parameter.unit, where)),
        "uncertainty": _written(interval_from_si(half_width, unit, parameter.unit, where)),
    }
    if declaration.fit:
        new["fit"] = True
    if isinstance(old, MutableMapping) and not isinstance(
        old, InlineTable
    ):  # [parameters.name], or dotted
        for key in [key for key in old if key not in new]:
            del old[key]
        old.update(new)
    else:
        pairs = ", ".join(
            f"{key} = {tomlkit.item(value).as_string()}" for key, value in new.items()
        )
        table[name] = tomlkit.value(f"{{ {pairs} }}")


def _plain(value: Any) -> Any:
    """A tomlkit item as the Python value in it."""
    return value.unwrap() if hasattr(value, "unwrap") else value


def _written(text: str) -> str | float:
    """A quantity as it stands in TOML: a dimensionless one is a number without quotes."""
    try:
        return float(text)
    except ValueError:
        return text


def _keep_data_reachable(document: Any, original_path: Path, out_path: Path) -> None:
    """Point [data] folder from the new place to data that lies beside the original.

    Data found under $SMS_DATA or ../shared/data is found from anywhere, and stays as written.
    """
    data = document.get("data", {})
    folder = Path(_plain(data.get("folder", ""))).expanduser()
    beside = (original_path.parent / folder).resolve()
    names = [str(_plain(record["file"])) for record in document["records"]]
    if folder.is_absolute() or files_in(beside, names) is None:
        return
    from_new_place = Path(os.path.relpath(beside, out_path.parent.resolve())).as_posix()
    if from_new_place == folder.as_posix():
        return
    if "data" not in document:
        document.add("data", tomlkit.table())
    document["data"]["folder"] = from_new_place


def _keep_neighbours_reachable(document: Any, original_path: Path, out_path: Path) -> None:
    """Point what names a file beside the original to it from the new place: geometry, DBC, effects, related rigs."""
    named = [("rig", "geometry"), ("data", "dbc"), ("effects", "file")]
    tables = [(document.get(table, {}), key) for table, key in named]
    for table, key in tables + [(table, "file") for table in document.get("related", [])]:
        if key in table and not (file := Path(_plain(table[key])).expanduser()).is_absolute():
            table[key] = _from_new_place(file, original_path, out_path)


def _from_new_place(file: Path, original_path: Path, out_path: Path) -> str:
    there = (original_path.parent / file).resolve()
    return Path(os.path.relpath(there, out_path.parent.resolve())).as_posix()
