"""The scenario files of the published experiments, run with parameters changed."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from importlib.resources import as_file, files
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.scenario import Record, command_of, run_scenario, scenario_from
from sms.scenario.plant import INTERRUPTED


def run(
    name: str,
    parameters: Mapping[str, float] | None = None,
    **changes: Mapping[str, Any],
) -> Record:
    """The scenario `name` of this package, simulated.

    Args:
        name: of the file in scenarios/, without its ending.
        parameters: other than those of the file, SI.
        changes: keys of its tables, as `excitation={"frequency": "0.3 Hz"}`.

    A run that the integrator cannot finish is returned as far as it came; Ctrl-C ends it.
    """
    with as_file(files("sms.validation").joinpath("scenarios", f"{name}.toml")) as path:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        for table, keys in changes.items():
            tables[table] = {**tables.get(table, {}), **keys}
        scenario = scenario_from(tables, path, parameters)
        record = run_scenario(scenario, command_of(scenario))
    if record.ended == INTERRUPTED:
        raise KeyboardInterrupt
    return record


def sample(record: Record, time: float) -> int:
    """Row of the record at a time, s."""
    return int(np.searchsorted(record.time, time))


def crossing(time: Array, values: Array, level: float) -> float:
    """When `values` first exceed `level`, interpolated; NaN when they never do."""
    above = values > level
    if not above.any():
        return math.nan
    row = int(np.argmax(above))
    if row == 0:
        return float(time[0])
    share = (level - values[row - 1]) / (values[row] - values[row - 1])
    return float(time[row - 1] + share * (time[row] - time[row - 1]))


def response_at(source: Array, answer: Array, period: float, low: float, high: float) -> complex:
    """`answer` over `source` between two frequencies (Hz), from one transform of the whole record.

    The source's way (section 7.3.6, no windows), summed over the band instead of one noisy bin.
    """
    frequency = np.fft.rfftfreq(source.size, period)
    band = (frequency >= low) & (frequency <= high)
    x, y = (np.fft.rfft(values - values.mean())[band] for values in (source, answer))
    return complex(np.vdot(x, y) / np.vdot(x, x))
