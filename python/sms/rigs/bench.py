"""The kind "bench": one actuator, its command, extension and chamber pressures measured."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np

from sms import _core, simulation
from sms.arrays import Array
from sms.estimation.kind import Equations, Experiment, Kind
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.rigs.pneumatic import NOTHING, READ_DIRECTLY, in_windows, record_of_simulation

LONGEST_STEP = 1e-3
"""s: of the integration. At 2.5 ms a piston that stops chatters over the kink of its friction; at 1.25 ms hardly."""
LONGEST_STEP_ELSEWHERE = 1.67e-3
"""s: where the piston is well on its way. Detection limits are within 11 % of those with 1 ms everywhere; at 2.5 ms
that of a late command would be two thirds."""
HIDDEN = {
    "force": "N",
    "flow of the lower chamber": "kg/s",
    "flow of the upper chamber": "kg/s",
}
OUTPUTS = ("extension", "chamber_pressure_lower", "chamber_pressure_upper", "supply_pressure")


def make_problem(
    rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
) -> _core.BenchProblem:
    """The records as the core's problem."""
    return _core.BenchProblem(
        records=[record_of(run, channels, command=run.signals["valve_command"]) for run in runs],
        noise={s: noise[s] for s in OUTPUTS},
        longest_step_elsewhere=LONGEST_STEP_ELSEWHERE,
        **in_windows(rig, LONGEST_STEP, runs),
    )


def record_of(
    run: Run, channels: Sequence[str], *, command: Array, setpoint: Array = NOTHING
) -> _core.BenchRecord:
    """One run as the core takes it; command and setpoint (n,), or empty."""
    return _core.BenchRecord(
        step=run.step,
        command=command,
        setpoint=setpoint,
        extension=run.signals["extension"],
        pressure_lower=run.compared("chamber_pressure_lower"),
        pressure_upper=run.compared("chamber_pressure_upper"),
        supply_pressure=run.compared("supply_pressure")
        if "supply_pressure" in channels
        else NOTHING,
        conditions=run.conditions,
        hold=run.hold,
    )


# ---- equations fed with measured signals ---------------------------------------------------------


def equation_units(channels: Sequence[str]) -> dict[str, str]:
    """The equations, and the reservoir's where it is read."""
    supply = {"reading of supply_pressure": "Pa"} if "supply_pressure" in channels else {}
    return dict(HIDDEN) | supply


def make_equations(rig: Rig, run: Run, measured: Mapping[str, Array]) -> _core.BenchEquations:
    """The core's equations of one record."""
    return _core.BenchEquations(
        step=run.step,
        command=run.signals["valve_command"],
        extension=measured["extension"],
        pressure_lower=measured["chamber_pressure_lower"],
        pressure_upper=measured["chamber_pressure_upper"],
        supply_pressure=measured.get("supply_pressure", np.empty((0, 0))),
        conditions=run.conditions,
        friction=rig.model.friction,
        valve=rig.model.valve,
        chambers=rig.model.chambers,
    )


EQUATIONS = Equations(
    units=equation_units,
    derivatives={
        "extension": 2,
        "chamber_pressure_lower": 1,
        "chamber_pressure_upper": 1,
        "supply_pressure": 0,
    },
    make=make_equations,
)


def derived(run: Run) -> dict[str, Array]:
    """The rod's motion."""
    velocity = run.rate("extension")
    return {"velocity [m/s]": velocity, "direction": np.sign(velocity)}


# ---- experiments ---------------------------------------------------------------------------------

LENGTH = 8.0
"""s"""
STEP = 0.005
"""s, of the proposed record."""
MARGIN = 0.02
"""m kept from either end, where the run does not mean to go there."""
LOOP_GAIN = 10.0
"""V/m: a slow position loop keeps the piston inside its stroke."""
TOLERANCE = 1e-5
"""Of the integrator: a plan needs no more."""

Waveform = Callable[[Array, float], Array]
"""Of time (n,) and the stroke: extension, m."""


def _multisine(time: Array, stroke: float) -> Array:
    parts = [np.sin(2.0 * np.pi * f * time + f * f) for f in (0.25, 0.5, 1.0, 1.75, 2.75)]
    return np.asarray(0.5 * stroke + 0.08 * stroke * np.sum(parts, axis=0))


def _slow_triangle(time: Array, stroke: float) -> Array:
    return np.asarray(
        0.5 * stroke + 0.3 * stroke * (2.0 * np.abs((time / 8.0 + 0.25) % 1.0 - 0.5) - 0.5) * 2.0
    )


def _holds(time: Array, stroke: float) -> Array:
    return np.asarray(
        stroke * np.array([0.3, 0.7, 0.5, 0.2])[np.minimum((time / 2.0).astype(int), 3)]
    )


def _small_steps(time: Array, stroke: float) -> Array:
    return np.asarray(0.5 * stroke + 0.03 * stroke * np.sign(np.sin(2.0 * np.pi * 0.7 * time)))


def _sweep(time: Array, stroke: float) -> Array:
    phase = 2.0 * np.pi * (0.5 * time + 0.5 * time**2)
    return np.asarray(0.5 * stroke + 0.15 * stroke / (1.0 + time) * np.sin(phase))


def _ends(time: Array, stroke: float) -> Array:
    return np.asarray(0.5 * stroke * (1.0 - 0.96 * np.cos(2.0 * np.pi * time / 8.0)))


def simulated(
    rig: Rig,
    params: _core.Params,
    channels: Sequence[str],
    *,
    setpoint: Waveform,
    margin: float = MARGIN,
    added_mass: float = 0.0,
    supply_change: float = 0.0,
) -> Run | None:
    """The record of a run along a set-point; None if it would leave the stroke less the margin, m.

    In the loop of the rig's own controller where that is simulated, else in a slow one.
    """
    own = rig.control.controller == "simulated"
    period, stroke = float(params["control_period"]) if own else 1e-3, float(params["stroke"])
    time = np.arange(0.0, LENGTH, period)
    machine = params.copy()
    machine["moving_mass"] = machine["moving_mass"] + added_mass
    machine["supply_pressure"] = machine["supply_pressure"] + supply_change
    if not own:
        machine["proportional_gain"] = LOOP_GAIN
    wanted = setpoint(time, stroke)
    try:
        run = simulation.simulate_bench(
            wanted,
            controller=rig.control.law if own else "pid",
            compensated=rig.control.compensated if own else True,
            electronics=rig.control.electronics and own,
            params=machine,
            valve_law=rig.model.valve,
            friction_law=rig.model.friction,
            chamber_law=rig.model.chambers,
            tolerance=TOLERANCE,
        )
    except _core.StatusError:
        return None
    extension = run["extension"]
    if not (extension.min() > margin and extension.max() < stroke - margin):
        return None
    every = max(1, round(STEP / period))
    names = ("valve_command", *(s for s in OUTPUTS if s != "supply_pressure" or s in channels))
    signals = record_of_simulation(run, names, every)
    if own:
        signals["setpoint"] = np.ascontiguousarray(wanted[::every])
    changes = {"moving_mass": added_mass, "supply_pressure": supply_change}
    conditions = {n: v for n, v in changes.items() if v != 0.0}
    return Run("proposed", "identify", time[::every], signals, frozenset(), conditions)


MENU = (
    Experiment(
        "A multisine of 0.25 to 2.75 Hz about mid-stroke",
        "random phases, 8 s",
        partial(simulated, setpoint=_multisine),
    ),
    Experiment(
        "A slow triangle over 60 per cent of the stroke",
        "both ways, 8 s",
        partial(simulated, setpoint=_slow_triangle),
    ),
    Experiment(
        "Fast moves with holds at four positions",
        "two seconds each",
        partial(simulated, setpoint=_holds),
    ),
    Experiment(
        "Small steps about mid-stroke",
        "3 per cent of the stroke, 0.7 Hz",
        partial(simulated, setpoint=_small_steps),
    ),
    Experiment(
        "A sweep from 0.5 to 8 Hz, falling in amplitude",
        "8 s",
        partial(simulated, setpoint=_sweep),
    ),
    Experiment(
        "A slow approach to both ends",
        "to 2 per cent of the stroke, 8 s",
        partial(simulated, setpoint=_ends, margin=-np.inf),
    ),
    Experiment(
        "The multisine with 20 kg added to the rod",
        "weigh the mass",
        partial(simulated, setpoint=_multisine, added_mass=20.0),
    ),
    Experiment(
        "The multisine at 100 kPa less supply",
        "read the gauge",
        partial(simulated, setpoint=_multisine, supply_change=-1e5),
    ),
)

BENCH = Kind(
    outputs=OUTPUTS,
    hidden=HIDDEN,
    make_problem=make_problem,
    derived=derived,
    shown=("extension", "valve_command"),
    menu=MENU,
    equations=EQUATIONS,
    switched=True,
    read_directly=READ_DIRECTLY,
)
