"""The plan of a sweep: which parameters take which values, every variant decided before any runs.

Parameters on a grid are combined with each other; those with a distribution are drawn anew for
each variant, `samples` times a point of the grid. The same file gives the same variants.
"""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field
from scipy.stats import norm, qmc

from sms.arrays import Array
from sms.errors import InputError
from sms.io.toml_tables import Table, TextOrNumber
from sms.io.units import interval_to_si
from sms.parameters import PARAMETERS
from sms.scenario.load import known_parameter, parameter_value, scenario_from
from sms.scenario.tables import checked, read_toml

MOST = 1_000_000  # variants


class SweepTable(Table):
    """[sweep]: what is run, and how often."""

    scenario: str
    samples: int = Field(default=1, ge=1)
    seed: int = Field(default=1, ge=0)
    draw: Literal["random", "latin_hypercube"] = "latin_hypercube"


class VaryTable(Table):
    """One entry of [vary]: a grid, a uniform or a normal distribution."""

    grid: list[TextOrNumber] | None = Field(default=None, min_length=1)
    lower: TextOrNumber | None = None
    upper: TextOrNumber | None = None
    mean: TextOrNumber | None = None
    deviation: TextOrNumber | None = None


class SweepFile(Table):
    """The whole sweep file."""

    sweep: SweepTable
    vary: dict[str, VaryTable] = Field(min_length=1)


@dataclass(frozen=True)
class Sweep:
    """All variants of a sweep."""

    path: Path
    scenario: Path
    tables: Mapping[str, Any]  #: of the scenario file
    names: tuple[str, ...]  #: of the varied parameters
    values: Array  #: (n, names), SI

    def settings(self, variant: int) -> dict[str, float]:
        """The varied parameters of one variant, SI."""
        return {name: float(v) for name, v in zip(self.names, self.values[variant], strict=True)}

    @property
    def digest(self) -> str:
        """Of all that decides the results, to tell one sweep from another."""
        text = json.dumps([self.tables, self.names, self.values.tolist()], default=str)
        return hashlib.sha256(text.encode()).hexdigest()[:16]


def load_sweep(path: Path) -> Sweep:
    """Read and check a sweep file and its scenario. InputError names key, value and what is allowed."""
    file = checked(SweepFile, read_toml(path, "sweep"), path)
    scenario = (path.parent / Path(file.sweep.scenario).expanduser()).resolve()
    tables = read_toml(scenario, "scenario")
    grids: dict[str, list[float]] = {}
    drawn: dict[str, VaryTable] = {}
    for name, entry in file.vary.items():
        where = f"{path}, [vary.{name}]"
        if name not in PARAMETERS:
            raise InputError(f"{where}: there is no such parameter; {known_parameter(name)}")
        if entry.grid is not None:
            if entry.model_dump(exclude_none=True).keys() != {"grid"}:
                raise InputError(f"{where}: a grid and a distribution exclude each other; keep one")
            grids[name] = [parameter_value(name, value, f"{where} grid") for value in entry.grid]
        else:
            drawn[name] = entry
    nodes = list(itertools.product(*grids.values()))  # one, of nothing, where there is no grid
    points = np.array(nodes, dtype=np.float64).reshape(len(nodes), len(grids))
    samples = file.sweep.samples if drawn else 1
    if len(points) * samples > MOST:
        raise InputError(f"{path}: {len(points) * samples} variants; {MOST} are allowed at most")
    shares = _shares(file.sweep, len(points) * samples, len(drawn))
    columns = [np.repeat(column, samples) for column in points.T]
    for share, (name, entry) in zip(shares.T, drawn.items(), strict=True):
        columns.append(_quantile(share, name, entry, f"{path}, [vary.{name}]"))
    names = (*grids, *drawn)
    sweep = Sweep(path, scenario, tables, names, np.column_stack(columns))
    # what is wrong for all is said at once
    scenario_from(tables, scenario, sweep.settings(0))
    return sweep


def _shares(table: SweepTable, count: int, width: int) -> Array:
    """Numbers between 0 and 1, (count, width)."""
    random = np.random.default_rng(table.seed)
    if not width:
        return np.empty((count, 0))
    if table.draw == "random":
        return random.random((count, width))
    return np.asarray(qmc.LatinHypercube(width, rng=random).random(count))


def _quantile(share: Array, name: str, entry: VaryTable, where: str) -> Array:
    """Values of a distribution at shares; a normal one is cut off at the parameter's bounds."""
    given = set(entry.model_dump(exclude_none=True))
    parameter = PARAMETERS[name]
    if given == {"lower", "upper"}:
        low, high = (
            parameter_value(name, value, f"{where} {key}")
            for key, value in (("lower", entry.lower), ("upper", entry.upper))
            if value is not None
        )
        if not low < high:
            raise InputError(f"{where}: lower, {low:g}, must be below upper, {high:g}")
        return low + share * (high - low)
    if given in ({"mean", "deviation"}, {"deviation"}) and entry.deviation is not None:
        mean = parameter.default
        if entry.mean is not None:
            mean = parameter_value(name, entry.mean, f"{where} mean")
        deviation = interval_to_si(entry.deviation, parameter.unit, f"{where} deviation")
        if not deviation > 0.0:
            raise InputError(f"{where} deviation: {deviation:g} is given; it must be above 0")
        low, high = (
            float(norm.cdf(end, mean, deviation)) for end in (parameter.lower, parameter.upper)
        )
        return np.asarray(norm.ppf(low + share * (high - low), mean, deviation))
    raise InputError(
        f"{where}: give grid, or lower and upper (uniform), or mean and deviation (normal)"
        + (f"; given are {', '.join(sorted(given))}" if given else "")
    )
