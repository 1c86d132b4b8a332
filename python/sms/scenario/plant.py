"""The one place where a scenario meets the plant (`sms.simulation`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.scenario.load import Scenario
from sms.scenario.record import POSE, Record
from sms.scenario.sent import Command
from sms.simulation import (
    Run,
    SimulationInterruptedError,
    SimulationStoppedError,
    simulate_bench,
    simulate_platform,
)

INTERRUPTED = "stopped by Ctrl-C"
MISSED = "a step could not meet its tolerance"
_LEGS = ("1", "2", "3")


def run_scenario(
    scenario: Scenario, command: Command, progress: Callable[[float], None] | None = None
) -> Record:
    """Simulate; a run that is stopped by Ctrl-C or by the integrator is kept as far as it came.

    `progress` is told the share that is done. Raises: ValueError for a tank, which `run_tank` runs.
    """
    if scenario.plant == "tank":
        raise ValueError(f"{scenario.path}: a tank has no motion; run_tank simulates it")
    planned = float(command.time[-1])
    try:
        run, ended = _simulated(scenario, command, progress), ""
    except SimulationInterruptedError as stopped:
        run, ended = stopped.run, INTERRUPTED
    except SimulationStoppedError as stopped:
        run, ended = stopped.run, why_it_stopped(scenario, stopped)
    return _record(scenario, command, run, planned, ended)


def why_it_stopped(scenario: Scenario, stopped: SimulationStoppedError) -> str:
    """Why a run ended early, in words."""
    if stopped.converged:
        return str(stopped)
    return f"{MISSED} of {scenario.model.tolerance:g} ({stopped})"


def _simulated(
    scenario: Scenario, command: Command, progress: Callable[[float], None] | None
) -> Run:
    model = scenario.model
    laws: dict[str, Any] = {
        "controller": scenario.controller,
        "compensated": scenario.compensated,
        "electronics": model.electronics,
        "valve_law": model.valve_law,
        "friction_law": model.friction_law,
        "chamber_law": model.chamber_law,
        "params": scenario.params,
        "tolerance": model.tolerance,
        "progress": progress,
    }
    if scenario.plant == "bench":
        load = scenario.load_force
        return simulate_bench(
            command.values[:, 0], extension=scenario.extension, load_force=load, **laws
        )
    pose = (0.0, 0.0, scenario.height) if command.pose is None else tuple(command.pose[0])
    return simulate_platform(command.values, pose=pose, masses=model.masses, **laws)


def _record(scenario: Scenario, command: Command, run: Run, planned: float, ended: str) -> Record:
    count = run.time.size
    legs = ("",) if scenario.plant == "bench" else tuple(f"_{leg}" for leg in _LEGS)

    def each(name: str) -> Array:
        return np.column_stack([run[f"{name}{leg}"] for leg in legs])

    platform = scenario.plant == "platform"
    return Record(
        time=run.time,
        setpoint=command.values[:count],
        unit=command.unit,
        extension=each("extension"),
        velocity=each("velocity"),
        chamber_pressure_lower=each("chamber_pressure_lower"),
        chamber_pressure_upper=each("chamber_pressure_upper"),
        supply_pressure=each("supply_pressure"),
        valve_command=each("valve_command"),
        pose=np.column_stack([run[name] for name, _ in POSE]) if platform else None,
        asked=None if command.pose is None else command.pose[:count],
        planned=planned,
        ended=ended,
    )
