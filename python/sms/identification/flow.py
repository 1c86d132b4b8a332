"""`sms identify flow`: C, b and m of a component from charges and discharges of a tank.

Each record is one fit of the core's flow test (libsms/include/sms/flow_test.hpp): conductance,
critical ratio and subsonic index, with initial pressure, moment of opening and the outside
pressure beside them (flow_problem.py), so that their errors are part of the answer; how well each
is known stands in flow_known.py. The classic law is fitted to the same record for comparison.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from sms import OutOfRangeError, _core
from sms.arrays import Array
from sms.callbacks import Progress
from sms.identification.estimate import Estimate, Free, estimate, with_start
from sms.identification.flow_known import Contribution, Known, budget_of, known_of
from sms.identification.flow_problem import (
    COMPONENT,
    Declared,
    bounds_of_component,
    declared_params,
    felt_of,
    problem_of,
    seen_rows,
    series_of,
    start_of,
    surroundings_of,
    weight_of,
)
from sms.identification.flow_record import FlowRecord, Look, look_at
from sms.identification.profile import Profile, profile

STARTS = ((0.35, 1.2), (0.45, 1.8), (0.1, 0.7))
"""(b, m) from which a fit starts: the cost has a valley along which they replace each other."""


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
        return _not_fitted(record, look, (), heat)
    try:
        base = start_of(record, look, machine or declared_params(declared))
    except OutOfRangeError as beyond:
        return _not_fitted(record, look, (_no_transient(str(beyond)),), heat)
    starts = [
        with_start(base, component_critical_ratio=b, component_subsonic_index=m) for b, m in STARTS
    ]
    surroundings = surroundings_of(record, look, declared, heat)
    problem = problem_of(record, look, "iso", heat)
    weight, series = weight_of(record, look, heat), series_of(record, heat)
    counted = seen_rows(problem, base, look)
    free = felt_of(problem, starts, [*bounds_of_component(), *surroundings])
    found = estimate(problem, starts, free, weight, counted, huber, series)
    fitted = [f.name for f in free]
    profiles = {n: profile(found, n) for n in COMPONENT if with_profiles and n in fitted}
    budget = budget_of(found, declared, heat)
    spread = float(np.sqrt(sum(c.uncertainty**2 for c in budget[1:])))
    mae = _mae(found, record, look)
    told = bool(budget) and np.isfinite(spread + budget[0].uncertainty)
    # A model that leaves more than the pressure moves explains nothing.
    if not told or mae > np.median(np.abs(record.pressure - record.pressure[0])):
        why = f"C cannot be told from readings from {_span_of(record)}"
        return _not_fitted(record, look, (*found.warnings, _no_transient(why)), heat)
    known = {name: known_of(found, name, profiles.get(name), spread) for name in COMPONENT}
    classic = _classic(record, look, base, surroundings, weight, counted, heat, huber)
    return FlowFit(
        record, look, found, known, profiles, budget, classic,
        mae, _mae(classic, record, look) if classic else np.nan, heat,
    )  # fmt: skip


def _no_transient(why: str) -> str:
    return (
        f"it is no charge or discharge of this tank ({why}); check the units of time and pressure"
    )


def _span_of(record: FlowRecord) -> str:
    low, high = 1e-3 * record.pressure.min(), 1e-3 * record.pressure.max()
    return f"{low:.4g} up to {high:.4g} kPa within {record.time[-1] - record.time[0]:.4g} s"


def _not_fitted(record: FlowRecord, look: Look, faults: tuple[str, ...], heat: str) -> FlowFit:
    look = replace(look, faults=(*look.faults, *faults))
    return FlowFit(record, look, None, {}, {}, (), None, np.nan, np.nan, heat)


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
    base = start_of(record, look, machine)
    base = with_start(base, component_critical_ratio=ratio, component_subsonic_index=index)
    problem = problem_of(record, look, "iso", heat)
    free = [*bounds_of_component(), *surroundings_of(record, look, declared, heat)]
    weight, counted = weight_of(record, look, heat), seen_rows(problem, base, look)
    return estimate(problem, [base], free, weight, counted, series=series_of(record, heat))


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
    problem = problem_of(record, look, "classic", heat)
    return estimate(problem, [start], free, weight, counted, huber, series_of(record, heat))


def _mae(found: Estimate, record: FlowRecord, look: Look) -> float:
    rows = record.time >= look.opening
    return float(np.mean(np.abs(found.residual[: record.time.size][rows])))
