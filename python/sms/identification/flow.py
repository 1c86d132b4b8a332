"""`sms identify flow`: C, b and m of a component from charges and discharges of a tank.

Each record is one fit of the core's flow test (libsms/include/sms/flow_test.hpp): conductance,
critical ratio and subsonic index, with initial pressure, moment of opening and the outside
pressure beside them, so that their errors are part of the answer. The classic law is fitted to the
same record for comparison. The budget follows the GUM (JCGM 100), as the amendments of ISO 6358-1
and -2 ask: the fit's own error, and what is only known within limits (tank volume, temperature,
pressures, gas) as rectangular distributions, carried by the fit's exact sensitivities.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.diagnosis.result import Array
from sms.identification.estimate import (
    Estimate,
    Free,
    Profile,
    estimate,
    profile,
    sensitivity,
    with_start,
)
from sms.identification.flow_record import FlowRecord, Look, look_at, smooth_supply
from sms.io.rig import Declaration
from sms.parameters import PARAMETERS

COMPONENT = ("component_conductance", "component_critical_ratio", "component_subsonic_index")
SYMBOL = dict(zip(COMPONENT, ("C", "b", "m"), strict=True))
STARTS = ((0.35, 1.2), (0.45, 1.8), (0.1, 0.7))
"""(b, m) from which a fit starts: the cost has a valley along which they replace each other."""
USEFUL = {"component_critical_ratio": 0.1, "component_subsonic_index": 0.5}
"""Half width of the 95 percent interval up to which a number is worth printing."""
BUDGET = (
    "tank_volume",
    "air_temperature",
    "wall_temperature",
    "heat_transfer_coefficient",
    "tank_wall_area",
    "supply_pressure",
    "ambient_pressure",
    "sensor_gain_tank_pressure",
    "sensor_offset_tank_pressure",
    "gas_constant",
    "reference_density",
    "inflow_heat_ratio",
    "outflow_heat_ratio",
    "heat_capacity_ratio",
    "opening_duration",
)
"""Parameters that are only known within limits and would shift the fit."""
SUPPLY_DOUBT = 2e3  #: Pa, by which two pressure sensors of this kind may disagree

Declared = Callable[[str], Declaration]
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Known:
    """One of C, b, m: its value, interval and whether the record tells it."""

    name: str
    value: float
    sd: float
    """From the fit alone."""
    lower: float
    upper: float
    closed: bool
    """The data hold it on both sides."""
    identifiable: bool
    """Closed, and narrow enough to be worth a number."""

    @property
    def verdict(self) -> str:
        """For a person: the interval, or that there is none worth a number."""
        symbol = SYMBOL[self.name]
        if self.identifiable:
            return f"{symbol} = {self.value:.3g}, 95 %: {self.lower:.3g} to {self.upper:.3g}"
        side = "" if self.closed else ", where its bounds are"
        return f"{symbol} not identifiable: any value from {self.lower:.2g} to {self.upper:.2g} fits{side}"


@dataclass(frozen=True)
class Contribution:
    """One line of the uncertainty budget of C."""

    name: str
    limits: float
    """Half width within which it is known, its unit; nan for the fit itself."""
    uncertainty: float
    """Standard uncertainty it gives to C, m^3/(s Pa)."""


@dataclass(frozen=True)
class FlowFit:
    """What one record says of the component."""

    record: FlowRecord
    look: Look
    found: Estimate | None
    """None: the record is faulty, see look.faults."""
    known: Mapping[str, Known]
    """C, b, m by the name of their parameter."""
    profiles: Mapping[str, Profile]
    budget: tuple[Contribution, ...]
    classic: Estimate | None
    """The classic law on the same record; None where the spool's area is not known or zero."""
    mae: float
    """Pa, mean |simulated - measured| from the opening on (eq. 5.16), ISO law."""
    mae_classic: float
    heat: str

    @property
    def combined(self) -> float:
        """Standard uncertainty of C, all contributions together, m^3/(s Pa)."""
        return float(np.sqrt(sum(c.uncertainty**2 for c in self.budget))) if self.budget else np.nan

    @property
    def direction(self) -> str:
        """charge or discharge"""
        return "charge" if self.look.charge else "discharge"

    @property
    def notes(self) -> tuple[str, ...]:
        """Everything to be said of this record, faults first."""
        return self.look.faults + self.look.notes + (self.found.warnings if self.found else ())


def declared_params(declared: Declared) -> _core.Params:
    """Every parameter as declared."""
    return _core.Params(**{name: declared(name).value for name in PARAMETERS})


def fit_record(
    record: FlowRecord,
    declared: Declared,
    heat: str = "polytropic",
    huber: float = 0.0,
    with_profiles: bool = True,
    machine: _core.Params | None = None,
) -> FlowFit:
    """Fit one record by both laws.

    Args:
        record: as measured.
        declared: what is known of a parameter.
        heat: "polytropic", as the source's tables, or "energy": the full energy equation.
        huber: in units of the noise; 0: least squares.
        with_profiles: profile likelihoods; without them the intervals are 1.96 sd.
        machine: declared_params(declared), where many records share it.
    """
    look = look_at(record)
    if look.faults:
        return FlowFit(record, look, None, {}, {}, (), None, np.nan, np.nan, heat)
    base = _start(record, look, machine or declared_params(declared))
    starts = [
        with_start(base, component_critical_ratio=b, component_subsonic_index=m) for b, m in STARTS
    ]
    surroundings = _surroundings(record, look, declared, heat)
    problem = _problem(record, look, "iso", heat)
    weight = _weight(record, look)
    counted = _seen(problem, base, look)
    free = _felt(problem, starts, _free(surroundings))
    found = estimate(problem, starts, free, weight, counted, huber)
    fitted = [f.name for f in free]
    profiles = {n: profile(found, n) for n in COMPONENT if with_profiles and n in fitted}
    budget = _budget(found, declared, heat)
    spread = float(np.sqrt(sum(c.uncertainty**2 for c in budget[1:])))
    known = {name: _known(found, name, profiles.get(name), spread) for name in COMPONENT}
    classic = _classic(record, look, base, surroundings, weight, counted, heat, huber)
    return FlowFit(
        record, look, found, known, profiles, budget, classic,
        _mae(found, record, look), _mae(classic, record, look) if classic else np.nan, heat,
    )  # fmt: skip


def fit_records(
    records: Sequence[FlowRecord],
    declared: Declared,
    heat: str = "polytropic",
    huber: float = 0.0,
    with_profiles: bool = True,
    progress: Progress = lambda text, done: None,
    workers: int | None = None,
) -> tuple[FlowFit, ...]:
    """Fit every record, on all cores: the core works without Python's lock."""
    one = partial(
        fit_record,
        declared=declared,
        heat=heat,
        huber=huber,
        with_profiles=with_profiles,
        machine=declared_params(declared),
    )
    fits = []
    with ThreadPoolExecutor(workers) as pool:
        for done, fit in enumerate(pool.map(one, records), 1):
            progress(f"fitted {fit.record.name}", done / len(records))
            fits.append(fit)
    return tuple(fits)


def fit_start(
    record: FlowRecord,
    look: Look,
    declared: Declared,
    machine: _core.Params,
    heat: str = "polytropic",
) -> Estimate:
    """The ISO law from its first start alone: what one fit costs."""
    ratio, index = STARTS[0]
    base = _start(record, look, machine)
    base = with_start(base, component_critical_ratio=ratio, component_subsonic_index=index)
    problem = _problem(record, look, "iso", heat)
    free = _free(_surroundings(record, look, declared, heat))
    return estimate(problem, [base], free, _weight(record, look), _seen(problem, base, look))


# ---- one fit -------------------------------------------------------------------------------------------


def _start(record: FlowRecord, look: Look, machine: _core.Params) -> _core.Params:
    """Parameters as declared, with what the record itself shows: pressures, opening, slope."""
    params = machine.copy()
    params.supply_pressure = record.supply_pressure
    params.ambient_pressure = record.ambient_pressure
    params.tank_initial_pressure = look.initial
    params.opening_time = look.opening
    if not look.waits:
        params.opening_duration = 0.0
    if record.spool is not None:
        params.spool_position = record.spool
    if look.floor is not None:
        params.tank_pressure_floor = look.floor
    if look.ceiling is not None:
        params.tank_pressure_ceiling = look.ceiling
    slope = _steepest(record, look)
    ratio = params.inflow_heat_ratio if look.charge else params.outflow_heat_ratio
    upstream = params.supply_pressure if look.charge else look.initial
    mass_flow = params.tank_volume * slope / (ratio * params.gas_constant * params.air_temperature)
    params.component_conductance = mass_flow / (upstream * params.reference_density)
    return params


def _free(surroundings: Sequence[Free]) -> list[Free]:
    """C, b and m, and what is fitted beside them."""
    return [
        Free.of("component_conductance"),
        Free("component_critical_ratio", 0.0, 0.9),
        Free("component_subsonic_index", 0.1, 30.0),
        *surroundings,
    ]


def _felt(
    problem: _core.TankProblem, starts: Sequence[_core.Params], free: Sequence[Free]
) -> list[Free]:
    """What the record feels at every start; b and m leave no trace where all flow is choked."""
    names = [f.name for f in free]
    columns = [problem.evaluate(start, names)[1] for start in starts]
    norms = np.min([np.linalg.norm(c, axis=0) for c in columns], axis=0)
    return [f for f, norm in zip(free, norms, strict=True) if norm > 0.0]


def _steepest(record: FlowRecord, look: Look) -> float:
    """Pa/s, over the first fifth of the way: the flow is choked there, or near it."""
    way = np.abs(record.pressure - look.initial)
    share = 0.2 * abs(look.final - look.initial)
    at = int(np.argmax(way >= share))
    return share / max(float(record.time[at]) - look.opening, 1e-3 * float(np.ptp(record.time)))


def _surroundings(record: FlowRecord, look: Look, declared: Declared, heat: str) -> list[Free]:
    """What is fitted beside the component: the tank's start, the outside, what the rig file leaves open."""
    free = [Free.of("tank_initial_pressure")]
    if look.waits:
        free.append(Free.of("opening_time"))
    if look.charge and record.supply is None:
        free.append(_within("supply_pressure", declared, record.supply_pressure))
    elif look.charge:
        free.append(Free("sensor_offset_tank_pressure", -2e4, 2e4, SUPPLY_DOUBT))
    if look.floor is not None:
        free.append(Free.of("tank_pressure_floor"))
    wanted = ["tank_line_resistance"]
    if heat == "energy":
        wanted += ["heat_transfer_coefficient"]
        if record.temperature is not None:
            wanted += ["thermocouple_time_constant"]
    free += [Free.of(name) for name in wanted if declared(name).fit]
    return free


def _within(name: str, declared: Declared, value: float) -> Free:
    """A parameter declared within limits: free ten times as far, held by them as a rectangle's sd."""
    limits = max(declared(name).uncertainty, 1.0)
    return Free(name, value - 10.0 * limits, value + 10.0 * limits, limits / np.sqrt(3.0))


def _problem(record: FlowRecord, look: Look, law: str, heat: str) -> _core.TankProblem:
    nothing = np.empty(0)
    supply = record.supply
    return _core.TankProblem(
        time=record.time,
        pressure=record.pressure,
        charge=look.charge,
        temperature=nothing
        if record.temperature is None or heat != "energy"
        else record.temperature,
        supply=nothing if supply is None else smooth_supply(record.time, supply),
        law=law,
        heat=heat,
    )


def _weight(record: FlowRecord, look: Look) -> Array:
    """(rows,): one over the noise, which for sparse readings is no less than a thousandth of the way."""
    noise = record.noise or max(look.noise, 1e-4 * float(np.ptp(record.pressure)))
    return np.full(record.pressure.size, 1.0 / noise)


def _seen(problem: _core.TankProblem, params: _core.Params, look: Look) -> NDArray[np.bool_]:
    """(rows,): rows in which the sensor follows the tank."""
    residual, _ = problem.evaluate(params)
    seen = np.ones(residual.size, dtype=np.bool_)
    if look.floor is not None or look.ceiling is not None:
        open_ended = with_start(params, tank_pressure_floor=0.0, tank_pressure_ceiling=1e9)
        free, _ = problem.evaluate(open_ended)
        seen = np.abs(free - residual) < 1.0
    return seen if int(seen.sum()) > 20 else np.ones(residual.size, dtype=np.bool_)


def _classic(
    record: FlowRecord,
    look: Look,
    base: _core.Params,
    surroundings: Sequence[Free],
    weight: Array,
    counted: NDArray[np.bool_],
    heat: str,
    huber: float,
) -> Estimate | None:
    """The same record by the classic law, its discharge coefficient free."""
    if record.spool is None:
        return None
    area = float(_core.orifice_area(base, record.spool))
    if area <= 0.0:
        return None
    unit = float(_core.sonic_conductance(with_start(base, discharge_coefficient=1.0), area))
    coefficient = float(np.clip(base.component_conductance / unit, 0.02, 0.99))
    start = with_start(base, discharge_coefficient=coefficient)
    free = [Free.of("discharge_coefficient"), *surroundings]
    return estimate(_problem(record, look, "classic", heat), [start], free, weight, counted, huber)


def _known(found: Estimate, name: str, curve: Profile | None, limits: float) -> Known:
    """`limits`: standard uncertainty of C beside the fit, which widens its interval."""
    value = found.params[name]
    if name not in [f.name for f in found.free]:
        bounds = next(f for f in _free(()) if f.name == name)
        return Known(name, value, np.nan, bounds.lower, bounds.upper, False, False)
    sd = found.sd(name)
    lower, upper = value - 1.96 * sd, value + 1.96 * sd
    closed = bool(np.isfinite(sd))
    if curve is not None:
        lower, upper, closed = curve.lower, curve.upper, curve.closed
    if name == COMPONENT[0]:
        wider = 1.96 * limits
        lower, upper = (
            value - np.hypot(value - lower, wider),
            value + np.hypot(upper - value, wider),
        )
        return Known(name, value, sd, float(lower), float(upper), closed, closed)
    useful = USEFUL[name] * (1.0 if name == COMPONENT[1] else max(value, 1e-9))
    identifiable = bool(closed and 0.5 * (upper - lower) <= useful)
    return Known(name, value, sd, lower, upper, closed, identifiable)


def _budget(found: Estimate, declared: Declared, heat: str) -> tuple[Contribution, ...]:
    """The fit itself, then what is known within limits only, the largest first."""
    fitted = {f.name for f in found.free}
    names = [n for n in BUDGET if n not in fitted and declared(n).uncertainty > 0.0]
    if heat == "polytropic":  # its limits are those of a model that does not use them
        names = [n for n in names if n not in ("wall_temperature", "heat_transfer_coefficient")]
    shift = sensitivity(found, names)[found.index("component_conductance")]
    limits = np.array([declared(n).uncertainty for n in names])
    lines = [
        Contribution(name, float(limit), float(abs(s) * limit / np.sqrt(3.0)))
        for name, limit, s in zip(names, limits, shift, strict=True)
        if s != 0.0
    ]
    lines.sort(key=lambda line: -line.uncertainty)
    return (Contribution("fit", np.nan, found.sd("component_conductance")), *lines)


def _mae(found: Estimate, record: FlowRecord, look: Look) -> float:
    rows = record.time >= look.opening
    return float(np.mean(np.abs(found.residual[: record.time.size][rows])))
