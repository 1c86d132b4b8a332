"""The kind "tank": a vessel behind one port of the valve, its pressure measured, perhaps its temperature."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from sms import _core, simulation
from sms.arrays import Array
from sms.estimation.kind import Equations, Experiment, Kind
from sms.estimation.run import Run
from sms.estimation.run import make_run as make_any_run
from sms.io.records import Record
from sms.io.rig import Rig
from sms.rigs.pneumatic import READ_DIRECTLY, record_of_simulation
from sms.rigs.threads import threads

SHORTEST, LONGEST, PER_RECORD = 1.0, 5.0, 5.0
"""s, s, and how many: a window is a fifth of the longest record. A tank's pressure does not drift as a position does,
and the longer a window, the less its initial temperature can imitate a wrong flow."""
TABLES = {2e5: "iso_0_2_mpa", 4e5: "iso_0_4_mpa"}
"""Gauge pressure of the supply, Pa, at which a table of the valve was measured."""
LONGEST_STEP = 2.5e-3
"""s: of the integration. With a twenty-fifth of it readings differ by a hundredth of their noise."""
LONGEST_STEP_ELSEWHERE = 50e-3
"""s: where the command has rested for ten seconds. Readings and detection limits are those with a fifth of it."""
HIDDEN = {"flow of the tank": "kg/s", "supply pressure": "Pa"}
OUTPUTS = ("tank_pressure", "tank_temperature", "supply_pressure")


def make_problem(
    rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
) -> _core.TankPlantProblem:
    """The records as the core's problem."""
    return _core.TankPlantProblem(
        records=[_record(rig, run, channels) for run in runs],
        noise={s: noise[s] for s in OUTPUTS},
        chambers=rig.model.chambers,
        window=max(run.window or SHORTEST for run in runs),
        longest_step=LONGEST_STEP,
        longest_step_elsewhere=LONGEST_STEP_ELSEWHERE,
        threads=threads(),
    )


def make_run(rig: Rig, record: Record) -> Run:
    """A record with its pressures absolute, and the length of its windows."""
    run = make_any_run(rig, record)
    length = float(run.time[-1] - run.time[0])
    return replace(run, window=float(np.clip(length / PER_RECORD, SHORTEST, LONGEST)))


def valve_of(rig: Rig, run: Run) -> str:
    """The law of the valve in one record: as the rig file says, else the table measured at the nearest supply."""
    if "valve" in rig.model.model_fields_set:
        return rig.model.valve
    supply = rig.declared("supply_pressure").value + run.conditions.get("supply_pressure", 0.0)
    gauge = supply - rig.declared("ambient_pressure").value
    return TABLES[min(TABLES, key=lambda p: abs(p - gauge))]


def _record(rig: Rig, run: Run, channels: Sequence[str]) -> _core.TankPlantRecord:
    def measured(signal: str) -> Array:
        return run.compared(signal) if signal in channels else np.empty(0)

    return _core.TankPlantRecord(
        step=run.step,
        command=run.signals["valve_command"],
        pressure=run.compared("tank_pressure"),
        temperature=measured("tank_temperature"),
        supply_pressure=measured("supply_pressure"),
        conditions=run.conditions,
        hold=run.hold,
        valve=valve_of(rig, run),
    )


# ---- equations fed with measured signals ---------------------------------------------------------


def equation_units(channels: Sequence[str]) -> dict[str, str]:
    """The air in the tank, and what thermometer and reservoir add where they are read."""
    units = {"flow of the tank": "kg/s"}
    if "tank_temperature" in channels:
        units["reading of tank_temperature"] = "K"
    if "supply_pressure" in channels:
        units["supply pressure"] = "Pa"
    return units


def make_equations(rig: Rig, run: Run, measured: Mapping[str, Array]) -> _core.TankEquations:
    """The core's equations of one record."""
    none = np.empty((0, 0))
    return _core.TankEquations(
        step=run.step,
        command=run.signals["valve_command"],
        pressure=measured["tank_pressure"],
        temperature=measured.get("tank_temperature", none),
        supply_pressure=measured.get("supply_pressure", none),
        conditions=run.conditions,
        valve=valve_of(rig, run),
        chambers=rig.model.chambers,
    )


EQUATIONS = Equations(
    units=equation_units,
    derivatives={"tank_pressure": 1, "tank_temperature": 0, "supply_pressure": 0},
    make=make_equations,
)


def derived(run: Run) -> dict[str, Array]:
    """How fast the tank fills or empties."""
    rate = run.rate("tank_pressure")
    return {"pressure rate [Pa/s]": rate, "direction": np.sign(rate)}


# ---- experiments ---------------------------------------------------------------------------------

LENGTH = 8.0
"""s"""
STEP = 0.005
"""s, of the proposed record."""
TOLERANCE = 1e-5
"""Of the integrator: a plan needs no more."""

Waveform = Callable[[Array], Array]
"""Of time (n,): command less the valve's centre, V."""


def _levels(times: Sequence[float], volts: Sequence[float]) -> Waveform:
    """A command that runs from level to level in 20 ms at the given times."""

    def wave(time: Array) -> Array:
        at, level, now = [0.0], [0.0], 0.0
        for begin, volt in zip(times, volts, strict=True):
            at += [begin, begin + 0.02]
            level += [now, volt]
            now = volt
        return np.asarray(np.interp(time, at, level))

    return wave


_STROKES = _levels(
    (0.5, 1.5, 2.0, 3.0, 3.5, 5.0, 5.5, 7.0), (1.2, 0.0, -1.2, 0.0, 2.2, 0.0, -2.2, 0.0)
)
_BURSTS = _levels(
    tuple(0.3 + 0.4 * i + d for i in range(19) for d in (0.0, 0.1)),
    tuple(v for i in range(19) for v in (0.8 + 0.1 * i if i < 10 else -0.8 - 0.1 * (i - 10), 0.0)),
)
_SMALL = _levels((0.5, 2.5, 4.5, 6.5), (0.62, -0.62, 0.75, -0.75))
_HOLDS = _levels((0.3, 1.0, 4.5, 4.8), (2.0, 0.0, -2.0, 0.0))
_WIDE = _levels(
    (0.5, 1.0, 2.0, 2.5, 4.0, 4.5, 6.0, 6.5), (4.5, 0.0, -4.5, 0.0, 4.5, 0.0, -4.5, 0.0)
)


def _chatter(time: Array) -> Array:
    return np.asarray(1.6 * np.sin(2.0 * np.pi * (0.5 * time + 0.6 * time**2)))


def simulated(
    rig: Rig,
    params: _core.Params,
    channels: Sequence[str],
    *,
    opening: Waveform,
    supply_change: float = 0.0,
) -> Run | None:
    """The record of a run from little above ambient; a tank stays below its supply whatever the command."""
    period = 1e-3
    changes = {"supply_pressure": supply_change} if supply_change != 0.0 else {}
    planned = Run("proposed", "identify", np.empty(0), {}, frozenset(), changes)
    machine = params.copy()
    machine["supply_pressure"] = machine["supply_pressure"] + supply_change
    machine["tank_initial_pressure"] = machine["ambient_pressure"] + 5e4
    machine["control_period"] = period
    time = np.arange(0.0, LENGTH, period)
    command = machine["valve_centre"] + opening(time)
    try:
        run = simulation.simulate_tank(
            command,
            params=machine,
            valve_law=valve_of(rig, planned),
            chamber_law=rig.model.chambers,
            tolerance=TOLERANCE,
        )
    except _core.StatusError:
        return None
    every = round(STEP / period)
    signals = record_of_simulation(
        run, ("valve_command", *(s for s in OUTPUTS if s in channels)), every
    )
    return replace(planned, time=time[::every], signals=signals)


MENU = (
    Experiment(
        "Fill and vent at two openings, with pauses",
        "1.2 V and 2.2 V from the centre, 8 s",
        partial(simulated, opening=_STROKES),
    ),
    Experiment(
        "Bursts of a tenth of a second at ten openings",
        "0.8 to 1.7 V from the centre, 8 s",
        partial(simulated, opening=_BURSTS),
    ),
    Experiment(
        "Fill and vent with the valve hardly open",
        "0.62 and 0.75 V from the centre, two seconds each",
        partial(simulated, opening=_SMALL),
    ),
    Experiment(
        "Fill, then hold the valve closed; vent, then hold it closed",
        "three seconds each",
        partial(simulated, opening=_HOLDS),
    ),
    Experiment(
        "Fill and vent with the valve wide open",
        "4.5 V from the centre, 8 s",
        partial(simulated, opening=_WIDE),
    ),
    Experiment(
        "A sweep of the command from 0.5 to 10 Hz",
        "1.6 V, 8 s",
        partial(simulated, opening=_chatter),
    ),
    Experiment(
        "Fill and vent at 100 kPa less supply",
        "read the gauge",
        partial(simulated, opening=_STROKES, supply_change=-1e5),
    ),
)

TANK = Kind(
    outputs=OUTPUTS,
    hidden=HIDDEN,
    make_problem=make_problem,
    derived=derived,
    shown=("tank_pressure", "valve_command"),
    menu=MENU,
    equations=EQUATIONS,
    make_run=make_run,
    switched=True,
    read_directly=READ_DIRECTLY,
)
