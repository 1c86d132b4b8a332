"""A prediction-error fit of the bench: many parameters together, from windows with free initial states.

What can be fitted is asked first, from the records' own information (their Jacobian at the start, in units of the
declared noise): a parameter to which the residual is insensitive is left where it is declared, and so is one that would
not be known better than before. After the fit the same is asked with the residual that is really there. What is known
within limits beside the machine, pressures, temperature, the spool's lag, is fitted within these limits as a
rectangle's standard deviation, so that their doubt is part of every error.

Errors: least squares with the residual's own colour, one memory a signal (estimation/coloured_noise.py); where the
records, each taken alone, scatter by more than that, all errors grow by the Birge ratio, sqrt(chi-square / degrees of
freedom), as is usual for means of measurements that disagree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.callbacks import Progress
from sms.identification.bench_gain import ChannelGain, gains
from sms.identification.bench_records import BenchRecords
from sms.identification.bench_scatter import birge_ratio, record_by_record
from sms.identification.bench_told import EFFECT, choose, size_of, untold_of
from sms.identification.estimate import Estimate, Free, estimate, with_start
from sms.io.rig import Rig
from sms.parameters import PARAMETERS

TOLERANCE = 1e-6  #: relative, of the cost; the initial states are found to no more
ROUGHLY = 1e-3  #: the same for a fit on the way there
FIRST = ("valve_centre", "mass_flow_gain", "coulomb_force", "viscous_friction")
"""What moves a prediction most: fitted alone before the others join."""
REACH = 2.0
"""Times its declared half width: how far a parameter that is known within limits may move."""
SURROUNDINGS = (
    "supply_pressure",
    "ambient_pressure",
    "air_temperature",
    "valve_frequency",
    "valve_damping_ratio",
    "stiction_velocity",
    "stiction_shape",
)
"""Known within limits, and fitted within them."""


@dataclass(frozen=True)
class Told:
    """One parameter that was fitted."""

    name: str
    value: float
    error: float
    """Standard error with the residual's colour and the scatter of runs; nan at a bound."""
    before: float
    """As declared."""
    known_to: float
    """Half width within which it was known; 0: unknown."""
    runs: tuple[tuple[float, float], ...]
    """(value, standard error) of each record taken alone, in their order; nan where it cannot tell."""
    told: bool
    """Whether the records know it better than the rig file did."""

    @property
    def scatter(self) -> float:
        """Standard deviation over the records that tell it; nan with fewer than two."""
        values = [v for v, _ in self.runs if np.isfinite(v)]
        return float(np.std(values, ddof=1)) if len(values) > 1 else np.nan


@dataclass(frozen=True)
class BenchFit:
    """What the records say of the wanted parameters."""

    records: BenchRecords
    found: Estimate
    wanted: tuple[Told, ...]
    surroundings: tuple[Told, ...]
    """Known within limits: where they ended."""
    left_out: tuple[tuple[str, str], ...]
    """(parameter, why these records cannot tell it)"""
    birge: float
    """How much more the records scatter than their errors say; 1 when they do not."""
    gain: tuple[ChannelGain, ...]
    """On the records not used for the fit."""

    def value(self, name: str) -> Told:
        """One of the fitted parameters."""
        return next(t for t in (*self.wanted, *self.surroundings) if t.name == name)


def start_params(rig: Rig) -> _core.Params:
    """Every parameter as declared."""
    return _core.Params(**{name: rig.declared(name).value for name in PARAMETERS})


def fit_bench(
    records: BenchRecords,
    wanted: Sequence[str],
    huber: float = 0.0,
    starts: int = 1,
    progress: Progress = lambda text, done: None,
) -> BenchFit:
    """Fit `wanted` and what surrounds it.

    Args:
        records: of the bench.
        wanted: parameters to identify, in the order in which they are told.
        huber: readings further off than this many standard deviations count with their distance; 0: all squared.
        starts: how many starting points; the first as declared, the others drawn within what is declared.
        progress: told what is going on, and the share done.
    """
    rig, runs = records.rig, records.identify
    weight = records.counted.astype(np.float64)
    if not weight.any():
        weight[:] = 1.0  # everything clips somewhere: better than nothing, and it is said
    names = [n for n in wanted if not _held(rig, n)]
    beside = _surroundings(rig, wanted)
    start = start_params(rig)
    progress("looking what these records can show", 0.02)
    names, left_out = choose(runs, weight, start, names, beside, rig)
    progress("near the records", 0.1)
    first = _first(records.problem, weight, start, names, huber)
    others = [
        _first(records.problem, weight, other, names, huber)
        for other in _other_starts(rig, start, names, starts - 1)
    ]
    for attempt in range(3):
        progress(f"fitting {len(names)} parameters", 0.2 + 0.2 * attempt)
        found = _estimate(records, weight, [first, *others], names, beside, huber)
        untold = untold_of(found, names, rig)
        if untold is None:
            break
        name, why = untold
        left_out.append((name, why))
        names.remove(name)
        # What is known within limits starts, and is pulled to, where it is declared.
        first = with_start(start, **{n: found.params[n] for n in names})
        others = []
    progress("record by record", 0.85)
    alone = {n: record_by_record(found, runs, weight, n, rig) for n in names}
    birge = birge_ratio(found, alone)
    progress("judging on the other records", 0.92)
    return BenchFit(
        records,
        found,
        tuple(_told(found, n, rig, alone[n], birge) for n in names),
        tuple(_told(found, f.name, rig, (), 1.0) for f in found.free if f.name not in names),
        tuple(left_out),
        birge,
        gains(records.validate, start, found.params),
    )


def _held(rig: Rig, name: str) -> bool:
    """A parameter that the rig file states without any doubt stays."""
    known = rig.parameters.get(name)
    return known is not None and not known.fit and known.uncertainty == 0.0


def _surroundings(rig: Rig, wanted: Sequence[str]) -> list[Free]:
    """Everything known within limits: free twice as far, pulled as by their rectangle."""
    names = dict.fromkeys(
        [*SURROUNDINGS, *(n for n, d in rig.parameters.items() if d.uncertainty > 0.0)]
    )
    free = []
    for name in names:
        declared, bounds = rig.declared(name), PARAMETERS[name]
        if name in wanted or declared.uncertainty == 0.0:
            continue
        reach = REACH * declared.uncertainty
        free.append(
            Free(
                name,
                max(bounds.lower, declared.value - reach),
                min(bounds.upper, declared.value + reach),
                declared.uncertainty / np.sqrt(3.0),
            )
        )
    return free


# ---- fits ----------------------------------------------------------------------------------------------------


def _first(
    problem: _core.BenchProblem,
    weight: Array,
    start: _core.Params,
    names: Sequence[str],
    huber: float,
) -> _core.Params:
    """Near the records: by what moves a prediction most, then by everything that is wanted."""
    for stage in ([n for n in FIRST if n in names], names):
        if stage:
            free = [Free.of(n) for n in stage]
            start = estimate(problem, [start], free, weight, huber=huber, tolerance=ROUGHLY).params
    return start


def _other_starts(
    rig: Rig, start: _core.Params, names: Sequence[str], count: int
) -> list[_core.Params]:
    """Drawn within what is declared; of what is unknown within a third of its value."""
    rng = np.random.default_rng(1)
    out = []
    for _ in range(count):
        params = start.copy()
        for name in names:
            bounds = PARAMETERS[name]
            reach = rig.declared(name).uncertainty or abs(start[name]) / 3.0
            value = start[name] + reach * rng.uniform(-1.0, 1.0)
            params[name] = float(np.clip(value, bounds.lower, bounds.upper))
        out.append(params)
    return out


def _estimate(
    records: BenchRecords,
    weight: Array,
    starts: Sequence[_core.Params],
    names: Sequence[str],
    beside: Sequence[Free],
    huber: float,
) -> Estimate:
    problem = records.problem
    return estimate(
        problem,
        starts,
        [*(Free.of(n) for n in names), *beside],
        weight,
        weight > 0.0,
        huber,
        records.series,
        states=5 * len(problem.windows),
        tolerance=TOLERANCE,
        last_steps=2,
    )


def _told(
    found: Estimate, name: str, rig: Rig, alone: Sequence[tuple[float, float]], birge: float
) -> Told:
    declared, value = rig.declared(name), found.params[name]
    error = birge * found.sd(name)
    size = size_of(rig, name, value)
    told = bool(error < size) if np.isfinite(size) else bool(abs(value) > EFFECT * error)
    return Told(name, value, error, declared.value, declared.uncertainty, tuple(alone), told)
