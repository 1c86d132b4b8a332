"""Two files of records: the signals they share, on common times, in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.comparison.metrics import FrequencyResponse, Metrics, compare_signals, frequency_response
from sms.errors import InputError, did_you_mean
from sms.io.table import Table
from sms.io.table_files import open_table
from sms.io.units import array_to_si, si_unit_of, split_column_name

WARNING = (
    "The correlation (eq. 7.2) is blind to gain and offset: a simulation of half the amplitude "
    "scores 1. Read it beside the amplitude ratio and the errors."
)


@dataclass(frozen=True)
class Signal:
    """One signal of both files on common times."""

    name: str
    unit: str  #: SI
    measured: Array  #: (n,)
    simulated: Array  #: (n,)
    metrics: Metrics
    response: FrequencyResponse  #: simulated over measured
    response_measured: FrequencyResponse | None  #: measured over the input
    response_simulated: FrequencyResponse | None  #: simulated over the input


@dataclass(frozen=True)
class Comparison:
    """What `sms compare` found."""

    measured: Path
    simulated: Path
    time: Array  #: (n,) s
    shift: float  #: s added to the simulation's times
    input: str | None
    signals: tuple[Signal, ...]
    left_out: tuple[str, ...]  #: signals in one file only

    def to_dict(self) -> dict[str, Any]:
        """For programs: SI units, NaN as None; every ratio is simulated over measured."""
        return {
            "measured": str(self.measured),
            "simulated": str(self.simulated),
            "first_time_s": float(self.time[0]),
            "last_time_s": float(self.time[-1]),
            "shift_s": self.shift,
            "ratios": "simulated over measured; a positive lag means the simulation is late",
            "warning": WARNING,
            "input": self.input,
            "signals": {s.name: _signal_dict(s) for s in self.signals},
            "left_out": list(self.left_out),
        }


def compare_files(
    measured: Path,
    simulated: Path,
    names: Sequence[str] = (),
    input_name: str | None = None,
    shift: float = 0.0,
    align: bool = False,
    renamed: Mapping[str, str] | None = None,
    columns: Mapping[str, str] | None = None,
    dbc: Path | None = None,
) -> Comparison:
    """Compare the signals that two records share.

    Args:
        measured: CSV and its relatives, .mat or Parquet; columns "name [unit]", one of them time.
        simulated: the same; its units may differ.
        names: signals to compare; by default all in both.
        input_name: the signal that excites both, for a frequency response of each over it.
        shift: s added to the simulation's times.
        align: shift the simulation by the lag of the first signal as well.
        renamed: measured name to simulated name, where they differ.
        columns: signal to column of the measured record, where that calls it otherwise.
        dbc: definition of the bus of a measured CAN log.

    The simulation is interpolated linearly to the measured times, evened out, where both overlap.
    Raises: InputError.
    """
    renamed = dict(renamed or {})
    one, other = _read(measured, columns, dbc), _read(simulated)
    for name, partner in renamed.items():
        if partner not in other:
            raise InputError(f"{simulated}: no column '{partner}'; {did_you_mean(partner, other)}")
        other[name] = other.pop(partner)
    chosen = _chosen(one, other, names, measured, simulated)
    if input_name is not None and input_name not in one:
        raise InputError(f"{measured}: no column '{input_name}'; {did_you_mean(input_name, one)}")
    time, values = _common(one, other, chosen, shift, measured, simulated)
    if align:
        first = compare_signals(time, *values[chosen[0]])
        shift -= first.lag if math.isfinite(first.lag) else 0.0
        time, values = _common(one, other, chosen, shift, measured, simulated)
    drive = None
    if input_name is not None:
        drive = np.interp(time, one["time"][0], one[input_name][0])
    signals = tuple(
        _compared(name, one[name][1], time, *values[name], drive)
        for name in chosen
        if name != input_name
    )
    left = sorted((set(one) ^ set(other)) - {"time"})
    return Comparison(measured, simulated, time, shift, input_name, signals, tuple(left))


def _compared(
    name: str, unit: str, time: Array, measured: Array, simulated: Array, drive: Array | None
) -> Signal:
    step = float(time[1] - time[0])
    return Signal(
        name=name,
        unit=unit,
        measured=measured,
        simulated=simulated,
        metrics=compare_signals(time, measured, simulated),
        response=frequency_response(measured, simulated, step),
        response_measured=None if drive is None else frequency_response(drive, measured, step),
        response_simulated=None if drive is None else frequency_response(drive, simulated, step),
    )


def _read(
    file: Path, columns_of_user: Mapping[str, str] | None = None, dbc: Path | None = None
) -> dict[str, tuple[Array, str]]:
    """Every column of numbers: name without unit, values in SI, SI unit."""
    table = open_table(file, columns_of_user, dbc)
    columns: dict[str, tuple[Array, str]] = {}
    for index, full in enumerate(table.names):
        name, unit = split_column_name(full)
        values, bad = table.numbers(index)
        if len(bad) == values.size:
            continue
        if bad:
            row, text = bad[0]
            raise InputError(
                f"{file}, line {int(table.lines[row])}, {name}: '{text}' is not a number; repair it"
            )
        key = name.lower().replace(" ", "_")
        si = si_unit_of(unit or "1", f"{file}, column '{full}'")
        columns[key] = array_to_si(values, unit or "1", si, f"{file}, column '{full}'"), si
    _check_time(columns, table)
    return columns


def _check_time(columns: Mapping[str, tuple[Array, str]], table: Table) -> None:
    if "time" not in columns:
        raise InputError(f"{table.file}: there is no column 'time [s]'; {', '.join(columns)} are")
    time = columns["time"][0]
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        line = int(table.lines[int(back[0]) + 1])
        raise InputError(f"{table.file}, line {line}, time: it must rise from line to line")


def _chosen(
    one: Mapping[str, tuple[Array, str]],
    other: Mapping[str, tuple[Array, str]],
    names: Sequence[str],
    measured: Path,
    simulated: Path,
) -> list[str]:
    for name in names:
        for known, file in ((one, measured), (other, simulated)):
            if name not in known:
                raise InputError(f"{file}: no column '{name}'; {did_you_mean(name, known)}")
    chosen = list(names) or [name for name in one if name in other and name != "time"]
    if not chosen:
        raise InputError(
            f"{measured} and {simulated} share no signal; name them alike, or pair them with "
            "--pair MEASURED=SIMULATED"
        )
    for name in chosen:
        if one[name][1] != other[name][1]:
            raise InputError(
                f"'{name}' is in {one[name][1]} in {measured}, in {other[name][1]} in {simulated}: "
                "not the same quantity"
            )
    return chosen


def _common(
    one: Mapping[str, tuple[Array, str]],
    other: Mapping[str, tuple[Array, str]],
    names: Sequence[str],
    shift: float,
    measured: Path,
    simulated: Path,
) -> tuple[Array, dict[str, tuple[Array, Array]]]:
    """Even times of the measurement within both, and the signals there."""
    mine, yours = one["time"][0], other["time"][0] + shift
    first, last = max(mine[0], yours[0]), min(mine[-1], yours[-1])
    step = float(np.median(np.diff(mine))) if mine.size > 1 else math.inf
    count = math.floor((last - first) / step + 1e-6) + 1 if last > first else 0
    if count < 8:
        raise InputError(
            f"{measured} ({mine[0]:g} to {mine[-1]:g} s) and {simulated} ({yours[0]:g} to "
            f"{yours[-1]:g} s) overlap in less than 8 samples; shift one with --shift"
        )
    time: Array = first + step * np.arange(float(count))
    return time, {
        name: (np.interp(time, mine, one[name][0]), np.interp(time, yours, other[name][0]))
        for name in names
    }


def _signal_dict(signal: Signal) -> dict[str, Any]:
    responses = {
        "simulated_over_measured": signal.response,
        "measured_over_input": signal.response_measured,
        "simulated_over_input": signal.response_simulated,
    }
    return {
        "unit": signal.unit,
        **{key: _number(value) for key, value in asdict(signal.metrics).items()},
        "frequency_response": {
            name: {
                "frequency_Hz": _numbers(response.frequency),
                "gain": _numbers(response.gain),
                "phase_rad": _numbers(response.phase),
                "coherence": _numbers(response.coherence),
            }
            for name, response in responses.items()
            if response is not None
        },
    }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _numbers(values: Array) -> list[float | None]:
    return [_number(float(value)) for value in values]
