"""A stretch of one column of a record file, and its noise in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.errors import InputError, did_you_mean
from sms.identification.noise import Noise, Spectrum
from sms.io.table_files import open_table
from sms.io.units import array_to_si, split_column_name


def stretch(
    file: Path,
    signal: str | None,
    begin: float | None,
    end: float | None,
    columns: Mapping[str, str] | None = None,
    dbc: Path | None = None,
) -> tuple[str, str, Array, Array]:
    """(name, unit, time in s (n,), values (n,)) of a column between two times; columns and dbc as `open_table`.

    InputError.
    """
    table = open_table(file, columns, dbc)
    plain = [split_column_name(name)[0] for name in table.names]
    if "time" not in plain:
        raise InputError(f"{file}: there is no column 'time'; {did_you_mean('time', plain)}")
    if signal is None:
        others = [name for name in plain if name != "time"]
        if not others:
            raise InputError(f"{file}: there is no column beside 'time'; nothing to describe")
        signal = others[0]
    wanted = split_column_name(signal)[0]
    if wanted not in plain:
        raise InputError(f"{file}: there is no column '{wanted}'; {did_you_mean(wanted, plain)}")
    clock, column = plain.index("time"), plain.index(wanted)
    time = _numbers(table.numbers(clock)[0], table.names[clock], file)
    values = table.numbers(column)[0]
    rows = np.ones(time.size, dtype=np.bool_)
    if begin is not None:
        rows &= time >= begin
    if end is not None:
        rows &= time <= end
    return wanted, split_column_name(table.names[column])[1] or "1", time[rows], values[rows]


def _numbers(values: Array, name: str, file: Path) -> Array:
    return array_to_si(values, split_column_name(name)[1] or "s", "s", f"{file}, column '{name}'")


def noise_sentences(n: Noise, unit: str) -> list[str]:
    """For a person."""
    said = [
        f"{n.samples} samples at {n.rate:.4g} Hz, mean {n.mean:.6g} {unit}, trend {n.trend:.3g} {unit}/s (taken off)",
        f"standard deviation {n.sd:.4g} {unit}; after the alpha-beta filter {n.filtered_sd:.4g} {unit}",
        f"skewness {n.skewness:+.3f}, kurtosis {n.kurtosis:+.3f} (0 for a normal distribution): "
        + ("may be normal" if n.normal_p > 0.05 else "not normal")
        + f" (p = {n.normal_p:.2g})",
        f"correlation from sample to sample {n.correlation:+.3f}: "
        + ("white" if n.white else "coloured"),
        f"floor of the spectrum above a quarter of the rate: {n.floor:.1f} dB ({unit}²/Hz)",
    ]
    if n.resolution > 0.0:
        said.append(f"readings step by {n.resolution:.3g} {unit}")
    return said


def noise_dict(n: Noise) -> dict[str, Any]:
    """For programs."""
    out: dict[str, Any] = {}
    for field in fields(n):
        value = getattr(n, field.name)
        out[field.name] = (
            {"frequency_Hz": value.frequency, "density": value.density}
            if isinstance(value, Spectrum)
            else value
        )
    return out | {"white": n.white}
