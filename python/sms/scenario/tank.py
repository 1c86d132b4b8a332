"""The flow test as a scenario: a tank that the valve charges from the supply, or empties."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.io.signals import with_units
from sms.scenario.load import Scenario
from sms.scenario.plant import INTERRUPTED, why_it_stopped
from sms.scenario.sent import Command
from sms.simulation import SimulationInterruptedError, SimulationStoppedError, simulate_tank
from sms.units_display import format_quantity

SIGNALS = (
    *with_units("tank_pressure", "tank_temperature"),
    ("mass_flow", "kg/s"),
    *with_units("supply_pressure", "valve_command"),
)
_REACHED = 0.01  # of the way to the supply's or the ambient pressure: as good as there


@dataclass(frozen=True)
class TankRecord:
    """Signals of a run, (n,) each, SI units."""

    time: Array  #: s
    tank_pressure: Array  #: Pa, absolute
    tank_temperature: Array  #: K
    mass_flow: Array  #: kg/s, into the tank
    supply_pressure: Array  #: Pa, at the valve
    valve_command: Array  #: V
    planned: float  #: s, how long it was to be
    ended: str = ""  #: why it ended early, in words; "" when it is complete

    @property
    def complete(self) -> bool:
        """Whether it ran to its end."""
        return not self.ended

    def every(self, step: int) -> TankRecord:
        """Each `step`-th sample."""
        taken = {name: getattr(self, name)[:: max(1, step)] for name, _ in SIGNALS}
        return replace(self, time=self.time[:: max(1, step)], **taken)

    def columns(self) -> dict[str, Array]:
        """ "name [unit]" and values (n,), as they are written and as `sms identify` reads them."""
        signals = {f"{name} [{unit}]": getattr(self, name) for name, unit in SIGNALS}
        return {"time [s]": self.time, **signals}


@dataclass(frozen=True)
class TankFindings:
    """What came out of a flow test."""

    sentences: tuple[str, ...]
    least_pressure: float  #: Pa
    greatest_pressure: float  #: Pa
    greatest_flow: float  #: kg/s, either way
    arrived: float | None  #: s; from when on the pressure is within 1 % of where the valve leads

    def to_dict(self) -> dict[str, Any]:
        """For programs, SI units."""
        return {
            "findings": list(self.sentences),
            "least_pressure_Pa": self.least_pressure,
            "greatest_pressure_Pa": self.greatest_pressure,
            "greatest_flow_kg_per_s": self.greatest_flow,
            "arrived_s": self.arrived,
        }


def run_tank(
    scenario: Scenario, command: Command, progress: Callable[[float], None] | None = None
) -> TankRecord:
    """Simulate; a run that is stopped by Ctrl-C or by the integrator is kept as far as it came."""
    model, ended = scenario.model, ""
    try:
        run = simulate_tank(
            command.values[:, 0],
            valve_law=model.valve_law,
            chamber_law=model.chamber_law,
            params=scenario.params,
            tolerance=model.tolerance,
            progress=progress,
        )
    except SimulationInterruptedError as stopped:
        run, ended = stopped.run, INTERRUPTED
    except SimulationStoppedError as stopped:
        run, ended = stopped.run, why_it_stopped(scenario, stopped)
    signals = {name: run[name] for name, _ in SIGNALS}
    return TankRecord(time=run.time, planned=float(command.time[-1]), ended=ended, **signals)


def tank_findings(scenario: Scenario, record: TankRecord) -> TankFindings:
    """Read a flow test."""
    pressure, flow = record.tank_pressure, record.mass_flow
    first, last = float(pressure[0]), float(pressure[-1])
    leads_to = _end_of(scenario, record)
    arrived = None if leads_to is None else _arrival(record, leads_to)
    largest = int(np.argmax(np.abs(flow)))
    sentences = [
        f"The tank of {1e3 * scenario.params.tank_volume:.3g} l begins at {format_quantity(first, 'Pa')}, "
        f"has {format_quantity(float(pressure.min()), 'Pa')} to "
        f"{format_quantity(float(pressure.max()), 'Pa')}, and ends at {format_quantity(last, 'Pa')} "
        f"after {format_quantity(float(record.time[-1]), 's')}.",
        f"The largest flow is {1e3 * abs(flow[largest]):.3g} g/s, "
        f"{'into' if flow[largest] > 0.0 else 'out of'} the tank, at {record.time[largest]:.2f} s.",
    ]
    if leads_to is not None:
        there = f"within 1 % of the {format_quantity(leads_to, 'Pa')} that the valve leads to"
        sentences.append(
            f"It does not come {there}."
            if arrived is None
            else f"It is {there} from {arrived:.2f} s on."
        )
    if scenario.model.chamber_law == "energy":
        low, high = float(record.tank_temperature.min()), float(record.tank_temperature.max())
        sentences.append(f"The air in it was between {low:.1f} and {high:.1f} K.")
    if not record.complete:
        sentences.insert(
            0,
            f"Partial: {record.ended} after {record.time[-1]:.2f} s of {record.planned:.2f} s; what "
            "was computed until then is kept.",
        )
    return TankFindings(
        tuple(sentences),
        float(pressure.min()),
        float(pressure.max()),
        float(abs(flow).max()),
        arrived,
    )


def _end_of(scenario: Scenario, record: TankRecord) -> float | None:
    """Pa, where the valve's last opening leads; None for a closed valve."""
    opening = float(record.valve_command[-1]) - scenario.params.valve_centre
    if opening == 0.0:
        return None
    return scenario.params.supply_pressure if opening > 0.0 else scenario.params.ambient_pressure


def _arrival(record: TankRecord, leads_to: float) -> float | None:
    """s, from when on the pressure stays near `leads_to`."""
    away = np.flatnonzero(np.abs(record.tank_pressure / leads_to - 1.0) > _REACHED)
    if away.size == 0:
        return 0.0
    last = int(away[-1])
    return float(record.time[last + 1]) if last + 1 < record.time.size else None
