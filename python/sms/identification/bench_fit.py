"""A prediction-error fit of the bench: many parameters together, from windows with free initial states.

What can be fitted is asked first, from the records' own information (their Jacobian at the start, in units of the
declared noise): a parameter that the residual does not feel is left where it is declared, and so is one that would
not be known better than before. After the fit the same is asked with the residual that is really there. What is known
within limits beside the machine, pressures, temperature, the spool's lag, is fitted within these limits as a
rectangle's standard deviation, so that their doubt is part of every error.

Errors: least squares with the residual's own colour, one memory a signal (colour.py); where the records, each taken
alone, scatter by more than that, all errors grow by the Birge ratio, sqrt(chi-square / degrees of freedom), as is
usual for means of measurements that disagree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.diagnosis.result import Array
from sms.diagnosis.runs import Runs
from sms.diagnosis.statistics import interval, resampled, weighted_ms
from sms.identification.bench_records import BenchRecords, whole_windows
from sms.identification.colour import coloured_meat
from sms.identification.estimate import Estimate, Free, estimate, with_start
from sms.io.rig import Rig
from sms.parameters import PARAMETERS
from sms.units_display import format_quantity, words

Progress = Callable[[str, float], None]

TOLERANCE = 1e-6  #: relative, of the cost; the initial states are found to no more
ROUGHLY = 1e-3  #: the same for a fit on the way there
FIRST = ("valve_centre", "mass_flow_gain", "coulomb_force", "viscous_friction")
"""What moves a prediction most: fitted alone before the others join."""
REACH = (
    2.0  #: times its declared half width: how far a parameter that is known within limits may move
)
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
USUAL = {"valve_centre": 0.05, "dead_band_change": 0.05, "command_delay": 2e-3}
"""Standard errors up to which these are worth knowing, V and s."""
EFFECT = (
    3.0  #: standard errors at which a parameter that is zero on a healthy machine counts as told
)
WORTH = 0.5  #: half width of a 95 percent interval over the value, up to which a number is worth printing
RUN_WORTH = 3.0  #: a run alone counts where its error is within so many of its parameter's size
WHY_UNFELT: Mapping[str, str] = {
    "inflow_heat_ratio": "the valve's tables were computed with one; only their product counts, and that is the "
    "mass-flow gain's",
    "outflow_heat_ratio": "the valve's tables were computed with one; only their product counts, and that is the "
    "mass-flow gain's",
    "stribeck_acceleration_factor": "stiction equals Coulomb friction at the start",
    "stiction_force": "without an acceleration factor there is no Stribeck term",
}
"""Why no record of this kind feels a parameter at its start."""


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
class ChannelGain:
    """One signal of one record: root mean square of what is left, SI, before and after."""

    record: str
    channel: str
    before: float
    after: float
    noise: float
    gain: float
    """1 - after / before"""
    interval: tuple[float, float]
    """95 percent, over resampled windows."""


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
    names, left_out = _choose(runs, weight, start, names, beside, rig)
    progress("near the records", 0.1)
    first = _first(runs, weight, start, names, huber)
    others = [
        _first(runs, weight, other, names, huber)
        for other in _other_starts(rig, start, names, starts - 1)
    ]
    for attempt in range(3):
        progress(f"fitting {len(names)} parameters", 0.2 + 0.2 * attempt)
        found = _estimate(records, weight, [first, *others], names, beside, huber)
        untold = _untold(found, names, rig)
        if untold is None:
            break
        name, why = untold
        left_out.append((name, why))
        names.remove(name)
        # What is known within limits starts, and is pulled to, where it is declared.
        first = with_start(start, **{n: found.params[n] for n in names})
        others = []
    progress("record by record", 0.85)
    alone = {n: _alone(found, runs, weight, n, rig) for n in names}
    birge = _birge(found, alone)
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


# ---- what can be told --------------------------------------------------------------------------------------


def _size(rig: Rig, name: str, value: float) -> float:
    """What a standard error is held against: what is known already, or a share of the value.

    inf for a parameter whose neutral value is zero and whose usual size nobody has said.
    """
    known = rig.declared(name).uncertainty or np.inf
    if name in USUAL:
        return min(known, USUAL[name])
    if PARAMETERS[name].default == 0.0:
        return float(known)
    return min(known, WORTH * abs(value) / 1.96)


def _choose(
    runs: Runs,
    weight: Array,
    start: _core.Params,
    names: Sequence[str],
    beside: list[Free],
    rig: Rig,
) -> tuple[list[str], list[tuple[str, str]]]:
    """Drop what is not felt, then, worst first, what would not be known better; in declared noise, at the start.

    Felt: moved by its whole size it changes chi-square by one.

    What surrounds is left out of `beside` in place where it is not felt.
    """
    every = [*names, *(f.name for f in beside)]
    _, jacobian = runs.problem.evaluate(start, every)
    jacobian = jacobian * weight[:, None]
    usual = [abs(start[n]) or USUAL.get(n) or rig.declared(n).uncertainty or np.inf for n in every]
    norm = np.linalg.norm(jacobian, axis=0)
    felt = {n: bool(x > 0.0 and x * u > 1.0) for n, x, u in zip(every, norm, usual, strict=True)}
    beside[:] = [f for f in beside if felt[f.name]]
    kept = [n for n in names if felt[n]]
    left_out = [
        (n, WHY_UNFELT.get(n, "these records do not feel it")) for n in names if not felt[n]
    ]
    column = {n: jacobian[:, i] for i, n in enumerate(every)}
    while kept:
        order = [*kept, *(f.name for f in beside)]
        error, correlation = _expected([column[n] for n in order], beside, len(kept))
        shares = [error[i] / max(_size(rig, n, start[n]), 1e-300) for i, n in enumerate(kept)]
        worst = int(np.argmax(shares))
        if shares[worst] < 2.0:
            break
        left_out.append(
            (kept[worst], _why(rig, kept[worst], error[worst], correlation[worst], order))
        )
        del kept[worst]
    return kept, left_out


def _expected(columns: Sequence[Array], beside: Sequence[Free], own: int) -> tuple[Array, Array]:
    """(own,) standard errors by the information of white declared noise, (own, all) correlations."""
    j = np.column_stack(columns)
    length = np.linalg.norm(j, axis=0)
    j = j / length
    prior = np.array([0.0] * own + [1.0 / f.known_to**2 for f in beside])
    covariance = np.linalg.pinv(j.T @ j + np.diag(prior / length**2), rcond=1e-13, hermitian=True)
    sd = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    return np.asarray((sd / length)[:own]), np.asarray((covariance / np.outer(sd, sd))[:own])


def _why(rig: Rig, name: str, error: float, correlation: Array, order: Sequence[str]) -> str:
    """Why a parameter that is felt is not told."""
    unit = PARAMETERS[name].unit
    other = np.abs(correlation).copy()
    other[list(order).index(name)] = 0.0
    twin = order[int(np.argmax(other))]
    known = rig.declared(name).uncertainty
    before = f", known to {format_quantity(known, unit, name)} already" if known > 0.0 else ""
    repeats = f"; it repeats {words(twin)}" if other.max() > 0.9 else ""
    return f"these records hold it within {format_quantity(1.96 * error, unit, name)} only{before}{repeats}"


def _untold(found: Estimate, names: Sequence[str], rig: Rig) -> tuple[str, str] | None:
    """The worst of the fitted that the records do not tell, if its error passes three times what is worth a number."""
    order = [f.name for f in found.free]
    shares = [
        found.sd(n) / max(_size(rig, n, found.params[n]), 1e-300)
        if np.isfinite(found.sd(n))
        else 0.0
        for n in names
    ]
    if not shares or max(shares) < 3.0:
        return None
    name = names[int(np.argmax(shares))]
    row = np.nan_to_num(found.correlation[found.index(name)])
    return name, _why(rig, name, found.sd(name), row, order)


# ---- fits ----------------------------------------------------------------------------------------------------


def _first(
    runs: Runs, weight: Array, start: _core.Params, names: Sequence[str], huber: float
) -> _core.Params:
    """Near the records: by what moves a prediction most, then by everything that is wanted."""
    for stage in ([n for n in FIRST if n in names], names):
        if stage:
            free = [Free.of(n) for n in stage]
            start = estimate(
                runs.problem, [start], free, weight, huber=huber, tolerance=ROUGHLY
            ).params
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
    problem = records.identify.problem
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
    size = _size(rig, name, value)
    told = bool(error < size) if np.isfinite(size) else bool(abs(value) > EFFECT * error)
    return Told(name, value, error, declared.value, declared.uncertainty, tuple(alone), told)


# ---- record by record --------------------------------------------------------------------------------------------


def _alone(
    found: Estimate, runs: Runs, weight: Array, name: str, rig: Rig
) -> list[tuple[float, float]]:
    """(value, standard error) by one step of each record's own least squares from the common solution."""
    i = found.index(name)
    inside = np.flatnonzero(np.isfinite(np.diag(found.covariance)))
    if i not in inside:
        return [(np.nan, np.nan)] * len(runs.motions)
    place = int(np.flatnonzero(inside == i)[0])
    prior = np.array([1.0 / f.known_to**2 if f.known_to else 0.0 for f in found.free])[inside]
    off = np.array([found.params[f.name] - found.start[f.name] for f in found.free])[inside]
    out = []
    for number in range(len(runs.motions)):
        own = (runs.record == number) & (weight > 0.0)
        j, r = found.jacobian[np.ix_(own, inside)], found.residual[own]
        length = np.sqrt(np.sum(j**2, axis=0) + prior)
        if not own.any() or not length[place] > 0.0:
            out.append((np.nan, np.nan))
            continue
        length[length == 0.0] = 1.0
        j = j / length
        bread = np.linalg.pinv(j.T @ j + np.diag(prior / length**2), rcond=1e-12, hermitian=True)
        step = -bread @ (j.T @ r + prior * off / length)
        meat = np.diag(prior / length**2)
        for c, colour in enumerate(found.colours):
            meat = meat + coloured_meat(j[runs.channel[own] == c], colour)
        error = float(np.sqrt((bread @ meat @ bread)[place, place]) / length[place])
        worth = error < RUN_WORTH * max(_size(rig, name, found.params[name]), 1e-300)
        out.append(
            (found.params[name] + float(step[place] / length[place]), error)
            if worth
            else (np.nan, np.nan)
        )
    return out


def _birge(found: Estimate, alone: Mapping[str, Sequence[tuple[float, float]]]) -> float:
    """sqrt(chi-square / freedom) of the records about the common values, over all parameters; at least 1."""
    chi, freedom = 0.0, 0
    for name, runs in alone.items():
        known = [(v, e) for v, e in runs if np.isfinite(v) and e > 0.0]
        if len(known) > 1:
            chi += float(sum(((v - found.params[name]) / e) ** 2 for v, e in known))
            freedom += len(known) - 1
    return float(np.sqrt(max(chi / freedom, 1.0))) if freedom else 1.0


# ---- on other records ---------------------------------------------------------------------------------------


def gains(runs: Runs | None, before: _core.Params, after: _core.Params) -> tuple[ChannelGain, ...]:
    """What the identified parameters are worth on records that were not used, window by window from free states."""
    if runs is None:
        return ()
    whole = whole_windows(runs)
    squared = [np.square(runs.problem.errors(p)) for p in (before, after)]
    counts = resampled(runs.record, runs.block, np.random.default_rng(1))
    out = []
    for number, run in enumerate(runs.motions):
        for c, channel in enumerate(runs.channels):
            rows = whole & (runs.record == number) & (runs.channel == c)
            rms = [float(np.sqrt(np.mean(s[rows]))) for s in squared]
            share = [weighted_ms(np.where(rows, s, 0.0), runs.block, counts) for s in squared]
            change = 1.0 - np.sqrt(share[1] / np.maximum(share[0], 1e-300))
            noise = runs.noise[channel]
            out.append(
                ChannelGain(
                    run.name, channel, rms[0] * noise, rms[1] * noise, noise,
                    1.0 - rms[1] / max(rms[0], 1e-300), interval(change),
                )
            )  # fmt: skip
    return tuple(out)
