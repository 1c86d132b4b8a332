"""Simulated runs of one actuator on the bench, of the platform and of the flow test's tank.

The plants are in libsms/include/sms: actuator.hpp, bench.hpp, platform.hpp, tank.hpp; the sampled loop around
them in simulate.hpp, its integrator in integrate_adaptive.hpp. A run is a table: one row a control
period, taken when the controller takes its sample.

    run = sms.simulate_bench(5.0 + 0.5 * np.sign(np.sin(t)), controller="open_loop")
    run["extension"], run["chamber_pressure_lower"]          # the truth, (n,) each, SI
    run.reading("extension")                                 # what its sensor says, and what a record holds

Same input, same result, to the bit, on every run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from sms import _core
from sms._core import Channel, LegParams, Params
from sms.arrays import Array
from sms.dynamics import mass_model_number
from sms.kinematics import inverse_kinematics
from sms.views import Shown

Simulation = _core.BenchSimulation | _core.PlatformSimulation | _core.TankSimulation
Progress = Callable[[float], None]
"""Called with the part of the run that is done, 0 to 1, every 0.25 s of simulated time."""

VALVE_LAWS = ("iso_0_4_mpa", "iso_0_2_mpa", "classic")
FRICTION_LAWS = ("acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre")
CHAMBER_LAWS = ("polytropic", "energy")
_NOT_CONVERGED = 4  # SMS_NOT_CONVERGED of sms.h
MEAN_PRESSURE = 333e3
"""Pa absolute, mean of both chambers where a run begins: what SPEC measures near mid-stroke."""
BENCH_TOLERANCE = 1e-6
PLATFORM_TOLERANCE = 1e-4
"""Error estimate of one step over the range of each state (integrate_adaptive.hpp). What it gives over 10 s, under all
laws: the bench's extension (section 7.2's sine) and the platform's pose (under its controller at 1 kHz) within 1e-6 of
their range; velocities and pressures within 1e-5.
"""


@dataclass(frozen=True, slots=True)
class Run(Shown):
    """A simulated run; `run["extension"]` is a column, (n,)."""

    time: Array  #: s, (n,)
    columns: tuple[str, ...]  #: names, as in a record
    rows: Array  #: (n, columns), SI
    evaluations: int  #: of the plant's derivative
    steps: int  #: of the integrator

    def __getitem__(self, column: str) -> Array:
        """One column, (n,); KeyError that names what there is."""
        if column not in self.columns:
            raise KeyError(f"{column!r} is not in this run; there is {', '.join(self.columns)}")
        values: Array = self.rows[:, self.columns.index(column)]
        return values

    def reading(self, signal: str) -> Array:
        """What the sensor of a signal says, as its logger has it, (n,): signal as in a record, "extension_2"."""
        return self[f"reading_{signal}"]

    def legs(self, column: str) -> Array:
        """The columns `column`_1 to _3 of the platform side by side, (n, 3)."""
        return np.column_stack([self[f"{column}_{leg}"] for leg in (1, 2, 3)])


class SimulationStoppedError(_core.StatusError):
    """A run that could not go on; `run` is what was computed before.

    `converged`: False where the integrator's step would have had to be too small; otherwise the
    plant itself has an end there, which the message names.
    """

    def __init__(self, message: str, run: Run, converged: bool) -> None:
        super().__init__(message)
        self.run = run
        self.converged = converged


class SimulationInterruptedError(KeyboardInterrupt):
    """Ctrl-C while a run was under way; `run` is what was computed before."""

    def __init__(self, run: Run) -> None:
        super().__init__()
        self.run = run


def simulate_bench(
    command: ArrayLike,
    *,
    controller: str = "open_loop",
    compensated: bool = True,
    electronics: bool = False,
    extension: float | None = None,
    load_force: ArrayLike = 0.0,
    mean_pressure: float = MEAN_PRESSURE,
    noise: ArrayLike = 0.0,
    valve_law: str = "iso_0_4_mpa",
    friction_law: str = "acceleration_dependent",
    chamber_law: str = "polytropic",
    params: Params | None = None,
    controller_params: Params | None = None,
    tolerance: float = BENCH_TOLERANCE,
    step: float = 0.0,
    stiff: bool = False,
    state: ArrayLike | None = None,
    channels: Mapping[str, Channel] | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Run:
    """One actuator on the bench, from rest.

    Args:
        command: one a control period (params.control_period, 1 ms), (n,): the setpoint of the
            extension in m, or in an open loop the voltage at the valve in V.
        controller: "open_loop", "pid" (eq. 7.4) or "state_feedback" (Figure 8.3).
        compensated: the controller's output steps over the valve's dead band (eq. 7.5).
        electronics: anti-alias filter, 12-bit converter, pulse width and its filter (section 7.3.3);
            otherwise the controller sees what the sensor says and the valve its command.
        extension: where the run begins, m; mid-stroke, or in a closed loop the first setpoint.
        load_force: on the rod, N, against extension, (n,) or one number.
        mean_pressure: of both chambers at the beginning, Pa absolute.
        noise: of the measured extension, m, (n,) or one number; draw it with a seed.
        valve_law: "iso_0_4_mpa", "iso_0_2_mpa" (the tables' supply) or "classic".
        friction_law: "acceleration_dependent" (eq. 6.5), "two_branch" (6.2), "stribeck" (6.1),
            "dahl" or "lugre".
        chamber_law: "polytropic" (eq. 4.30) or "energy" (temperature a state, heat of the wall).
        params: of the plant.
        controller_params: of the controller and its electronics; those of the plant by default.
        tolerance: error estimate of one integrator step, relative; not used with `step`.
        step: s; if positive, fixed Runge-Kutta steps of at most this size.
        stiff: the fixed steps are those of integrate_stiff.hpp, which estimation takes.
        state: where the run begins instead, the first columns of another run's row.
        channels: by signal, what its logger makes of the reading: noise, range, rounding.
        seed: of that noise.
        progress: told how far the run is.

    The errors of the sensors are parameters of the plant (sensor_gain_extension, backlash, ...): the controller gets
    what the position sensor says, `run.reading` gives what the loggers have.

    Raises: SimulationStoppedError, with what was computed; NotANumberError, OutOfRangeError.
    """
    plant = params if params is not None else Params()
    own = controller_params if controller_params is not None else plant
    setpoint = _columns("command", command, 1)
    begin = extension
    if begin is None:
        closed = controller != "open_loop" and setpoint.size
        begin = float(setpoint[0, 0]) if closed else 0.5 * float(plant["stroke"])
    load = np.broadcast_to(_columns("load_force", load_force, 1), setpoint.shape)
    simulation = _core.BenchSimulation(
        params=plant, controller=own, valve_law=valve_law, friction_law=friction_law,
        chamber_law=chamber_law, control=controller, compensated=compensated,
        electronics=electronics, extension=begin,
        load_force=float(load[0, 0]) if load.size else 0.0, mean_pressure=mean_pressure,
        tolerance=tolerance, step=step, stiff=stiff, state=_state(state),
    )  # fmt: skip
    logged = _Logged(channels or {}, seed)
    return _run(simulation, setpoint, noise, load, float(own["control_period"]), logged, progress)


def simulate_platform(
    command: ArrayLike,
    *,
    controller: str = "pid",
    compensated: bool = True,
    electronics: bool = False,
    pose: Sequence[float] = (0.0, 0.0, 0.5),
    wrench: ArrayLike = 0.0,
    mean_pressure: float = MEAN_PRESSURE,
    noise: ArrayLike = 0.0,
    valve_law: str = "iso_0_4_mpa",
    friction_law: str = "acceleration_dependent",
    chamber_law: str = "polytropic",
    masses: str = "corrected",
    params: Params | Sequence[Params] | None = None,
    controller_params: Params | None = None,
    tolerance: float = PLATFORM_TOLERANCE,
    step: float = 0.0,
    stiff: bool = False,
    state: ArrayLike | None = None,
    channels: Mapping[str, Channel] | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Run:
    """The platform on its three actuators, from rest; see `simulate_bench` for what is the same.

    Args:
        command: one row a control period, (n, 3): setpoints of the extensions in m (of attitudes:
            `extensions_of`), or in an open loop the voltages at the valves in V.
        pose: (roll, pitch, height) where the run begins, rad, rad, m.
        wrench: on the platform from outside, force in N and moment about the reference point in
            N m, world axes, (n, 6), (6,) or one number.
        noise: of the measured extensions, m, (n, 3), (3,) or one number.
        masses: reading of the mass table, see `sms.dynamics`.
        params: of the plant, or one for each actuator (also as LegParams); the mechanism is made from the first.

    Raises: SimulationStoppedError, with what was computed; NotANumberError, OutOfRangeError,
        OutOfWorkspaceError for a pose that is none.
    """
    plants = _one_each(params)
    own = controller_params if controller_params is not None else plants[0]
    setpoint = _columns("command", command, 3)
    simulation = _core.PlatformSimulation(
        params=plants, controller=own, valve_law=valve_law, friction_law=friction_law,
        chamber_law=chamber_law, masses=mass_model_number(masses), control=controller,
        compensated=compensated, electronics=electronics, q=tuple(float(x) for x in pose),
        mean_pressure=mean_pressure, tolerance=tolerance, step=step, stiff=stiff,
        state=_state(state),
    )  # fmt: skip
    load = np.broadcast_to(_columns("wrench", wrench, 6), (len(setpoint), 6))
    logged = _Logged(channels or {}, seed)
    return _run(simulation, setpoint, noise, load, float(own["control_period"]), logged, progress)


def simulate_tank(
    command: ArrayLike,
    *,
    valve_law: str = "iso_0_4_mpa",
    chamber_law: str = "polytropic",
    params: Params | None = None,
    tolerance: float = BENCH_TOLERANCE,
    step: float = 0.0,
    stiff: bool = False,
    state: ArrayLike | None = None,
    channels: Mapping[str, Channel] | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Run:
    """The tank of the flow test behind one port of the valve, closed before; it begins at
    params.tank_initial_pressure.

    Args:
        command: V at the valve, one a control period, (n,); above params.valve_centre the supply
            charges the tank, below it the tank empties to ambient.
        valve_law: "iso_0_4_mpa", "iso_0_2_mpa" (the tables' supply) or "classic".
        chamber_law: "polytropic" (eq. 5.5) or "energy" (temperature a state, heat of the wall).
        params: of valve and tank.
        tolerance: error estimate of one integrator step, relative; not used with `step`.
        step: s; if positive, fixed Runge-Kutta steps of at most this size.
        stiff, state, channels, seed: as in `simulate_bench`.
        progress: called with the part that is done.

    Columns: tank_pressure, tank_temperature, mass_flow (into the tank), supply_pressure,
    valve_command, spool_voltage, spool_rate. Equations: tank.hpp. Raises: as `simulate_bench`.
    """
    params = params or Params()
    volts = _columns("command", command, 1)
    simulation = _core.TankSimulation(
        params=params,
        valve_law=valve_law,
        chamber_law=chamber_law,
        pressure=params.tank_initial_pressure,
        tolerance=tolerance,
        step=step,
        stiff=stiff,
        state=_state(state),
    )
    nothing = np.zeros((len(volts), 1))
    logged = _Logged(channels or {}, seed)
    return _run(simulation, volts, 0.0, nothing, params.control_period, logged, progress)


def extensions_of(
    roll: ArrayLike, pitch: ArrayLike, height: ArrayLike, *, params: Params | None = None
) -> Array:
    """Setpoints of the three extensions for an attitude, m, (..., 3): the inverse kinematics."""
    return inverse_kinematics(roll, pitch, height, params=params).extension


def _one_each(params: Params | Sequence[Params] | None) -> list[Params]:
    if isinstance(params, LegParams):
        return params.legs
    if params is None or isinstance(params, Params):
        return [params if params is not None else Params()] * 3
    if len(params) != 3:
        raise ValueError(
            f"params: one for each of the three actuators is needed, not {len(params)}"
        )
    return list(params)


def _columns(name: str, values: ArrayLike, width: int) -> Array:
    """As (n, width); a single number or row stands for every period."""
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 0:
        array = np.full((1, width), float(array))
    elif array.ndim == 1:
        array = array[:, None] if width == 1 else array[None, :]
    if array.ndim != 2 or array.shape[1] != width:
        wanted = "(n,)" if width == 1 else f"(n, {width})"
        raise ValueError(f"{name} has shape {np.shape(values)}; {wanted} is needed")
    return array


@dataclass(frozen=True, slots=True)
class _Logged:
    """How the readings of a run are recorded."""

    channels: Mapping[str, Channel]
    seed: int

    def rows(self, simulation: Simulation, rows: Array) -> Array:
        """The rows of a run as its loggers have them."""
        names = [name.removeprefix("reading_") for name in simulation.readings]
        unknown = sorted(set(self.channels) - set(names))
        if unknown:
            raise ValueError(
                f"there is no reading of {', '.join(unknown)}; there is {', '.join(names)}"
            )
        channels = [self.channels.get(name, Channel()) for name in names]
        draws = np.random.default_rng(self.seed).standard_normal((len(rows), len(names)))
        recorded: Array = simulation.record(rows, channels, draws)
        return recorded


def _state(state: ArrayLike | None) -> Array | None:
    return None if state is None else np.asarray(state, dtype=np.float64)


def _run(
    simulation: Simulation,
    setpoint: Array,
    noise: ArrayLike,
    load: Array,
    period: float,
    logged: _Logged,
    progress: Progress | None,
) -> Run:
    n, legs = setpoint.shape
    own_noise = np.broadcast_to(_columns("noise", noise, legs), (n, legs))
    rows = np.empty((n, len(simulation.columns)))
    done = status = 0
    interrupted = False
    try:
        for block in _blocks(n, max(1, round(0.25 / period))):
            part, status, count = simulation.advance(setpoint[block], own_noise[block], load[block])
            rows[done : done + count] = part[:count]
            done += count
            if status:
                break
            if progress is not None:
                progress(done / n)
    except KeyboardInterrupt:
        interrupted = True
    run = Run(
        period * np.arange(done, dtype=np.float64),
        tuple(simulation.columns),
        logged.rows(simulation, rows[:done]),
        simulation.evaluations,
        simulation.steps,
    )
    if interrupted:
        raise SimulationInterruptedError(run)
    if status:
        raise SimulationStoppedError(
            f"the run stops at {simulation.time:.6g} s of {n * period:.6g} s: "
            f"{simulation.why(status)}",
            run,
            converged=status != _NOT_CONVERGED,
        )
    return run


def _blocks(n: int, size: int) -> Iterator[slice]:
    for begin in range(0, n, size):
        yield slice(begin, min(begin + size, n))
