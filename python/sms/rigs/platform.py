"""The kind "platform": three actuators under one mechanism, each with its command, extension and chamber pressures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import cast

import numpy as np

from sms import _core, simulation
from sms.arrays import Array
from sms.estimation.kind import Equations, Experiment, Kind
from sms.estimation.problem import Problem, WindowProblem
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.io.signals import LEGS, of_legs
from sms.rigs.pneumatic import NOTHING, READ_DIRECTLY, in_windows, record_of_simulation

LONGEST_STEP = 2.5e-3
"""s: of the integration. Under the platform a piston carries a hundred kilograms, and stops gently."""
HIDDEN = {
    **{f"force of leg {leg}": "N" for leg in LEGS},
    **{f"flow of the lower chamber of leg {leg}": "kg/s" for leg in LEGS},
    **{f"flow of the upper chamber of leg {leg}": "kg/s" for leg in LEGS},
}
OUTPUTS = (
    *of_legs("extension", "chamber_pressure_lower", "chamber_pressure_upper"),
    "supply_pressure",
    "roll",
    "pitch",
)
NOT_OF_LEGS: Array = np.empty((0, 3))
"""A signal that was recorded of no leg."""


def make_problem(
    rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
) -> WindowProblem:
    """The records as the core's problem."""
    problem = _core.PlatformProblem(
        records=[record_of(run, channels, command=columns(run, "valve_command")) for run in runs],
        noise={s: noise[s] for s in OUTPUTS},
        **in_windows(rig, LONGEST_STEP, runs),
    )
    # Its parameters are LegParams, which are Params with more names.
    return cast(WindowProblem, problem)


def columns(run: Run, signal: str) -> Array:
    """A signal of each leg, (n, 3)."""
    return np.column_stack([run.signals[name] for name in of_legs(signal)])


def compared(run: Run, signal: str) -> Array:
    """The same, NaN where a reading is clipped."""
    return np.column_stack([run.compared(name) for name in of_legs(signal)])


def record_of(
    run: Run, channels: Sequence[str], *, command: Array, setpoint: Array = NOT_OF_LEGS
) -> _core.PlatformRecord:
    """One run as the core takes it; command and setpoint (n, 3), or empty."""
    has_supply, both = "supply_pressure" in channels, "roll" in channels
    return _core.PlatformRecord(
        step=run.step,
        command=command,
        setpoint=setpoint,
        extension=columns(run, "extension"),
        pressure_lower=compared(run, "chamber_pressure_lower"),
        pressure_upper=compared(run, "chamber_pressure_upper"),
        supply_pressure=run.compared("supply_pressure") if has_supply else NOTHING,
        roll=run.compared("roll") if both else NOTHING,
        pitch=run.compared("pitch") if both else NOTHING,
        conditions=run.conditions,
        hold=run.hold,
    )


# ---- equations fed with measured signals ---------------------------------------------------------


def equation_units(channels: Sequence[str]) -> dict[str, str]:
    """The equations of each leg, and the reservoir's and the pose's where they are read."""
    units = dict(HIDDEN)
    if "supply_pressure" in channels:
        units["reading of supply_pressure"] = "Pa"
    if "roll" in channels:
        units |= {"reading of roll": "rad", "reading of pitch": "rad"}
    return units


def make_equations(rig: Rig, run: Run, measured: Mapping[str, Array]) -> Problem:
    """The core's equations of one record."""

    def legs(signals: Mapping[str, Array], name: str) -> list[Array]:
        return [signals[signal] for signal in of_legs(name)]

    none = np.empty((0, 0))
    equations = _core.PlatformEquations(
        step=run.step,
        command=legs(run.signals, "valve_command"),
        extension=legs(measured, "extension"),
        pressure_lower=legs(measured, "chamber_pressure_lower"),
        pressure_upper=legs(measured, "chamber_pressure_upper"),
        supply_pressure=measured.get("supply_pressure", none),
        roll=measured.get("roll", none),
        pitch=measured.get("pitch", none),
        conditions=run.conditions,
        friction=rig.model.friction,
        valve=rig.model.valve,
        chambers=rig.model.chambers,
    )
    return cast(Problem, equations)  # as above


EQUATIONS = Equations(
    units=equation_units,
    derivatives={
        **dict.fromkeys(of_legs("extension"), 2),
        **dict.fromkeys(of_legs("chamber_pressure_lower", "chamber_pressure_upper"), 1),
        **dict.fromkeys(("supply_pressure", "roll", "pitch"), 0),
    },
    make=make_equations,
)


def derived(run: Run) -> dict[str, Array]:
    """The rods' motion."""
    rates = {leg: run.rate(f"extension_{leg}") for leg in LEGS}
    found = {f"velocity_{leg} [m/s]": rate for leg, rate in rates.items()}
    return found | {f"direction_{leg}": np.sign(rate) for leg, rate in rates.items()}


# ---- experiments ---------------------------------------------------------------------------------

LENGTH = 8.0
"""s"""
STEP = 0.005
"""s, of the proposed record."""
MARGIN = 0.02
"""m of the stroke kept free at either end."""
LOOP_GAIN = 10.0
"""V/m: a slow position loop keeps the pistons where they shall be."""
HEIGHT = 0.5
"""m, about mid-stroke."""
TOLERANCE = 1e-3
"""Of the integrator: a plan needs no more."""

Waveform = Callable[[Array], Array]
"""Of time (n,): roll, pitch, rad, and heave, m, (n, 3)."""


def _multisine(time: Array) -> Array:
    shape = np.zeros((len(time), 3))
    for axis, size in enumerate((0.02, 0.02, 0.012)):
        for f in (0.25, 0.5, 1.0, 1.75, 2.75):
            shape[:, axis] += size * np.sin(2.0 * np.pi * f * time + f * f + 2.0 * axis)
    return shape


def _slow_heave(time: Array) -> Array:
    heave = 0.1 * (2.0 * np.abs((time / LENGTH + 0.25) % 1.0 - 0.5) - 0.5) * 2.0
    return np.column_stack([np.zeros((len(time), 2)), heave])


def _holds(time: Array) -> Array:
    poses = np.array([[0.0, 0.0, -0.06], [0.06, 0.0, 0.04], [0.0, 0.06, 0.0], [-0.05, -0.05, 0.02]])
    return np.asarray(poses[np.minimum((time / 2.0).astype(int), 3)])


def _one_leg(time: Array) -> Array:
    """Roll alone: legs 2 and 3 move, leg 1, on the roll axis, holds."""
    return np.column_stack(
        [0.06 * np.sin(2.0 * np.pi * 0.5 * time), np.zeros((len(time), 2))],
    )


def _sweep(time: Array) -> Array:
    phase = 2.0 * np.pi * (0.5 * time + 0.5 * time**2)
    heave = 0.04 / (1.0 + time) * np.sin(phase)
    return np.column_stack([heave, 0.5 * heave, heave])


def simulated(
    rig: Rig,
    params: _core.Params,
    channels: Sequence[str],
    *,
    waveform: Waveform,
    supply_change: float = 0.0,
) -> Run | None:
    """The record of a run through poses; None if a piston would leave the stroke less the margin.

    In the loop of the rig's own controllers where those are simulated, else in slow ones.
    """
    assert isinstance(params, _core.LegParams)
    own = rig.control.controller == "simulated"
    period, stroke = float(params["control_period"]) if own else 1e-3, float(params["stroke"])
    time = np.arange(0.0, LENGTH, period)
    machine = params.copy()
    machine["supply_pressure"] = machine["supply_pressure"] + supply_change
    if not own:
        machine["proportional_gain"] = LOOP_GAIN
    pose = waveform(time)
    try:
        setpoint = simulation.extensions_of(
            pose[:, 0], pose[:, 1], HEIGHT + pose[:, 2], params=machine.legs[0]
        )
        run = simulation.simulate_platform(
            setpoint,
            controller=rig.control.law if own else "pid",
            compensated=rig.control.compensated if own else True,
            electronics=rig.control.electronics and own,
            pose=(pose[0, 0], pose[0, 1], HEIGHT + pose[0, 2]),
            params=machine.legs,
            valve_law=rig.model.valve,
            friction_law=rig.model.friction,
            chamber_law=rig.model.chambers,
            tolerance=TOLERANCE,
        )
    except _core.StatusError:
        return None
    extension = run.legs("extension")
    if not (extension.min() > MARGIN and extension.max() < stroke - MARGIN):
        return None
    every = max(1, round(STEP / period))
    optional = ("supply_pressure", "roll", "pitch")
    names = (*of_legs("valve_command"), *(s for s in OUTPUTS if s not in optional or s in channels))
    signals = record_of_simulation(run, names, every)
    if own:
        wanted = zip(of_legs("setpoint"), setpoint[::every].T, strict=True)
        signals |= {name: np.ascontiguousarray(values) for name, values in wanted}
    conditions = {"supply_pressure": supply_change} if supply_change != 0.0 else {}
    return Run("proposed", "identify", time[::every], signals, frozenset(), conditions)


MENU = (
    Experiment(
        "A multisine of 0.25 to 2.75 Hz in roll, pitch and heave",
        "random phases, 8 s",
        partial(simulated, waveform=_multisine),
    ),
    Experiment(
        "A slow triangle in heave over 0.2 m",
        "level, 8 s",
        partial(simulated, waveform=_slow_heave),
    ),
    Experiment(
        "Fast moves with holds in four poses",
        "two seconds each",
        partial(simulated, waveform=_holds),
    ),
    Experiment(
        "Roll alone, 3.4 degrees at 0.5 Hz",
        "leg 1 holds, legs 2 and 3 move",
        partial(simulated, waveform=_one_leg),
    ),
    Experiment(
        "A sweep from 0.5 to 8 Hz, falling in amplitude",
        "8 s",
        partial(simulated, waveform=_sweep),
    ),
    Experiment(
        "The multisine at 100 kPa less supply",
        "read the gauge",
        partial(simulated, waveform=_multisine, supply_change=-1e5),
    ),
)

PLATFORM = Kind(
    outputs=OUTPUTS,
    hidden=HIDDEN,
    make_problem=make_problem,
    derived=derived,
    shown=(*of_legs("extension", "valve_command"),),
    menu=MENU,
    equations=EQUATIONS,
    switched=True,
    read_directly=READ_DIRECTLY,
)
