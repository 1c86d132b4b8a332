"""One record of a flow test as the core's problem: where a fit starts, what is free beside C, b and m, what counts.

Initial pressure, moment of opening and the outside pressure are fitted with the component, so that their doubt is part
of every error. A sensor that saturates is a floor or a ceiling of the model (flow_record.py).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.arrays import Array
from sms.identification.estimate import Free, with_start
from sms.identification.flow_record import FlowRecord, Look, reading_noise, smooth_supply
from sms.io.declarations import Declaration
from sms.parameters import PARAMETERS

COMPONENT = ("component_conductance", "component_critical_ratio", "component_subsonic_index")
SYMBOL = dict(zip(COMPONENT, ("C", "b", "m"), strict=True))
SUPPLY_DOUBT = 2e3  #: Pa, by which two pressure sensors of this kind may disagree

Declared = Callable[[str], Declaration]


def declared_params(declared: Declared) -> _core.Params:
    """Every parameter as declared."""
    return _core.Params(**{name: declared(name).value for name in PARAMETERS})


def start_of(record: FlowRecord, look: Look, machine: _core.Params) -> _core.Params:
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


def bounds_of_component() -> list[Free]:
    """C, b and m, within what a component can have."""
    return [
        Free.of("component_conductance"),
        Free("component_critical_ratio", 0.0, 0.9),
        Free("component_subsonic_index", 0.1, 30.0),
    ]


def felt_of(
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


def surroundings_of(record: FlowRecord, look: Look, declared: Declared, heat: str) -> list[Free]:
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
        if temperature_of(record, heat) is not None:
            wanted += ["thermocouple_time_constant"]
    free += [Free.of(name) for name in wanted if declared(name).fit]
    return free


def _within(name: str, declared: Declared, value: float) -> Free:
    """A parameter declared within limits: free ten times as far, held by them as a rectangle's sd."""
    limits = max(declared(name).uncertainty, 1.0)
    return Free(name, value - 10.0 * limits, value + 10.0 * limits, limits / np.sqrt(3.0))


def temperature_of(record: FlowRecord, heat: str) -> Array | None:
    """(n,) K, what is fitted of the thermocouple; None where it is not recorded, or the model holds it constant."""
    return record.temperature if heat == "energy" else None


def problem_of(record: FlowRecord, look: Look, law: str, heat: str) -> _core.TankProblem:
    """Rows: the pressures, then the temperatures where they are fitted."""
    nothing = np.empty(0)
    supply, temperature = record.supply, temperature_of(record, heat)
    return _core.TankProblem(
        time=record.time,
        pressure=record.pressure,
        charge=look.charge,
        temperature=nothing if temperature is None else temperature,
        supply=nothing if supply is None else smooth_supply(record.time, supply),
        law=law,
        heat=heat,
    )


def weight_of(record: FlowRecord, look: Look, heat: str) -> Array:
    """(rows,): one over the noise, which for sparse readings is no less than a thousandth of the way."""
    noise = record.noise or max(look.noise, 1e-4 * float(np.ptp(record.pressure)))
    weight = np.full(record.pressure.size, 1.0 / noise)
    temperature = temperature_of(record, heat)
    if temperature is None:
        return weight
    least = max(1e-4 * float(np.ptp(temperature)), 1e-3)
    noise = record.temperature_noise or max(reading_noise(temperature), least)
    return np.concatenate([weight, np.full(temperature.size, 1.0 / noise)])


def series_of(record: FlowRecord, heat: str) -> tuple[NDArray[np.intp], ...]:
    """The rows of each sensor, which has a noise of its own."""
    rows = np.arange(record.pressure.size)
    return (rows,) if temperature_of(record, heat) is None else (rows, rows.size + rows)


def seen_rows(problem: _core.TankProblem, params: _core.Params, look: Look) -> NDArray[np.bool_]:
    """(rows,): rows in which the sensor follows the tank."""
    residual, _ = problem.evaluate(params)
    seen = np.ones(residual.size, dtype=np.bool_)
    if look.floor is not None or look.ceiling is not None:
        open_ended = with_start(params, tank_pressure_floor=0.0, tank_pressure_ceiling=1e9)
        free, _ = problem.evaluate(open_ended)
        seen = np.abs(free - residual) < 1.0
    return seen if int(seen.sum()) > 20 else np.ones(residual.size, dtype=np.bool_)
