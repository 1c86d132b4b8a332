"""A pneumatic cylinder pushed in and out against regulated pressure: an independent simulator.

It stands for the rig on which the real cylinder was measured and is written from the laws of
mechanics alone; it does not import, call or copy the core. What differs on purpose:

- friction is a bristle that bends before it slides (LuGre: Canudas de Wit, Olsson, Astrom,
  Lischinsky, IEEE Trans. Automatic Control 40, 1995), not a curve over the speed;
- the rod is moved by a spindle through a load cell of finite stiffness, so that its motion is an
  outcome and not a given;
- the pressure is held by a relieving regulator with a dead band: it sags while the piston
  leaves and rises while it returns;
- the equations are integrated by LSODA (variable order, variable step).

Signs: extension and velocity are positive outwards; ``rod_force`` is the force with which the
rod pushes on the load cell. Single-acting: the upper chamber and the rod's face see ambient
pressure, so the rod's area drops out of the balance. SI units, pressures against ambient
("gauge") unless the name says otherwise.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field
from math import copysign, cos, exp, pi, sin

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import odeint

Array = NDArray[np.float64]
State = tuple[float, float, float, float]
"""Extension [m], velocity [m/s], deflection of the bristle [m], gauge pressure [Pa]."""

OUTPUT_STEP = 2e-3
"""Spacing of the simulated motion [s]; the sensors average over several of these points."""


@dataclass(frozen=True)
class Cylinder:
    """Everything the motion depends on, as it truly is."""

    bore_diameter: float = 25e-3  # m
    stroke: float = 40e-3  # m
    moving_mass: float = 0.3  # kg
    ambient_pressure: float = 101.3e3  # Pa absolute
    coulomb_force: float = 6.0  # N
    stiction_force: float = 8.0  # N, force at which the bristle lets go
    stribeck_velocity: float = 0.5e-3  # m/s, far below the speed of any stroke
    viscous_friction: float = 15.0  # N s/m
    bristle_stiffness: float = 4e6  # N/m
    bristle_damping: float = 200.0  # N s/m
    cell_stiffness: float = 1e6  # N/m, load cell with its mounting
    cell_damping: float = 200.0  # N s/m
    line_volume: float = 1e-4  # m3, hose and dead volume on the pressurised side
    gas_exponent: float = 1.2  # between isothermal and adiabatic
    regulator_dead_band: float = 3e3  # Pa, half width
    regulator_conductance: float = 1.5e-3  # m3/s, (pressure x volume flow) per Pa outside the band

    @property
    def piston_area(self) -> float:
        """Area on which the pressure acts [m2]."""
        return 0.25 * pi * self.bore_diameter**2


@dataclass(frozen=True)
class ExtraFriction:
    """What is hidden in the friction; all zero means that nothing is.

    The first three are in the diagnosis' catalogue, the others are not.
    """

    pressure_dependent_friction: float = 0.0  # N/Pa, times (p_a + p_b - 2 p_amb)
    direction_dependent_friction: float = 0.0  # N, more while extending, less while retracting
    position_dependent_friction: float = 0.0  # 1/m, slope of the Coulomb force over extension
    bore_scratch: float = 0.0  # N, height of a friction bump at one spot
    scratch_centre: float = 14e-3  # m
    scratch_width: float = 1.5e-3  # m, standard deviation of the bell
    position_ripple: float = 0.0  # N, amplitude of a periodic friction over extension
    ripple_length: float = 6e-3  # m
    ripple_phase: float = 0.0  # rad
    friction_drift: float = 0.0  # N, at the start of each record, dying out as it runs in
    drift_time: float = 20.0  # s


@dataclass(frozen=True)
class StrokePlan:
    """Motion of the spindle: to and fro between two switches at speeds that vary a little."""

    speeds_out: tuple[float, ...]  # m/s, one a stroke
    speeds_in: tuple[float, ...]  # m/s, positive numbers
    start: float = 2.5e-3  # m, where it rests first and where it turns
    end: float = 36e-3  # m
    rest: float = 0.5  # s, before the first and after the last stroke
    turning_time: float = 0.3  # s, from one speed to the next
    ripple: float = 0.03  # share of the speed, once a turn of the spindle
    lead: float = 3e-3  # m, one turn of the spindle


@dataclass(frozen=True)
class Motion:
    """The true course of one record, every `OUTPUT_STEP`; all arrays have shape (n,)."""

    time: Array  # s
    extension: Array  # m
    velocity: Array  # m/s
    acceleration: Array  # m/s2
    gauge_pressure: Array  # Pa
    friction: Array  # N
    rod_force: Array  # N


@dataclass
class _Profile:
    """Spindle position from pieces of constant speed joined by smooth turns."""

    plan: StrokePlan
    starts: list[float] = field(default_factory=list)
    pieces: list[tuple[float, float, float, float]] = field(default_factory=list)
    time: float = 0.0
    position: float = 0.0

    def __post_init__(self) -> None:
        plan = self.plan
        self.position = plan.start
        self._piece(plan.rest, 0.0, 0.0)
        before = 0.0
        for out, back in zip(plan.speeds_out, plan.speeds_in, strict=True):
            for speed, target in ((out, plan.end), (-back, plan.start)):
                self._piece(plan.turning_time, before, speed)
                self._piece((target - self.position) / speed, speed, speed)
                before = speed
        self._piece(plan.turning_time, before, 0.0)
        self._piece(plan.rest, 0.0, 0.0)

    def _piece(self, duration: float, first: float, last: float) -> None:
        if duration <= 0.0:
            raise ValueError(
                f"the strokes leave no room for a piece of motion ({duration:.3g} s); "
                "choose a longer stroke, lower speeds or a shorter turning time"
            )
        self.starts.append(self.time)
        self.pieces.append((self.position, first, last, duration))
        self.time += duration
        self.position += 0.5 * (first + last) * duration

    def __call__(self, time: float) -> tuple[float, float]:
        """Spindle position [m] and speed [m/s]."""
        i = max(bisect_right(self.starts, time) - 1, 0)
        position, first, last, duration = self.pieces[i]
        u = min(time - self.starts[i], duration) / duration
        blend = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
        area = u**4 * (2.5 - 3.0 * u + u * u)
        s = position + duration * (first * u + (last - first) * area)
        v = first + (last - first) * blend
        turn = 2.0 * pi / self.plan.lead
        return (
            s + self.plan.ripple / turn * sin(turn * s),
            v * (1.0 + self.plan.ripple * cos(turn * s)),
        )


def sliding_force(cylinder: Cylinder, extra: ExtraFriction, time: float, state: State) -> float:
    """Coulomb force [N] of a steady slide, with whatever is hidden in it; stays positive."""
    extension, velocity, _, gauge_pressure = state
    force = cylinder.coulomb_force * (
        1.0 + extra.position_dependent_friction * (extension - 0.5 * cylinder.stroke)
    )
    force += extra.pressure_dependent_friction * gauge_pressure
    force += copysign(1.0, velocity) * extra.direction_dependent_friction
    if extra.bore_scratch != 0.0:
        distance = (extension - extra.scratch_centre) / extra.scratch_width
        force += extra.bore_scratch * exp(-0.5 * distance * distance)
    if extra.position_ripple != 0.0:
        angle = 2.0 * pi * extension / extra.ripple_length + extra.ripple_phase
        force += extra.position_ripple * sin(angle)
    if extra.friction_drift != 0.0:
        force += extra.friction_drift * exp(-time / extra.drift_time)
    return max(force, 0.05 * cylinder.coulomb_force)


def _bristle(
    cylinder: Cylinder, extra: ExtraFriction, time: float, state: State
) -> tuple[float, float]:
    """Rate of the bristle's deflection [m/s] and the friction force [N]."""
    _, v, z, _ = state
    level = sliding_force(cylinder, extra, time, state)
    ratio = v / cylinder.stribeck_velocity
    if abs(ratio) < 6.0:
        excess = cylinder.stiction_force / cylinder.coulomb_force - 1.0
        level *= 1.0 + excess * exp(-ratio * ratio)
    rate = v - abs(v) * z * cylinder.bristle_stiffness / level
    force = (
        cylinder.bristle_stiffness * z
        + cylinder.bristle_damping * rate
        + cylinder.viscous_friction * v
    )
    return rate, force


def _regulator_flow(cylinder: Cylinder, error: float) -> float:
    """What the regulator lets in (positive) or relieves, as pressure x volume flow [Pa m3/s]."""
    outside = max(abs(error) - cylinder.regulator_dead_band, 0.0)
    return copysign(cylinder.regulator_conductance * outside, error)


def _equations(
    cylinder: Cylinder, extra: ExtraFriction, profile: _Profile, set_pressure: float
) -> Callable[[Array, float], tuple[float, float, float, float]]:
    """Right-hand side for the state (cell deflection, velocity, bristle, gauge pressure)."""
    area = cylinder.piston_area

    def rates(state: Array, time: float) -> tuple[float, float, float, float]:
        deflection, v, z, p = state.tolist()
        spindle, spindle_speed = profile(time)
        x = spindle + deflection
        bristle_rate, friction = _bristle(cylinder, extra, time, (x, v, z, p))
        slip = v - spindle_speed
        cell = cylinder.cell_stiffness * deflection + cylinder.cell_damping * slip
        acceleration = (p * area - friction - cell) / cylinder.moving_mass
        volume = cylinder.line_volume + area * x
        inflow = _regulator_flow(cylinder, set_pressure - p)
        squeeze = (p + cylinder.ambient_pressure) * area * v
        pressure_rate = cylinder.gas_exponent / volume * (inflow - squeeze)
        return slip, acceleration, bristle_rate, pressure_rate

    return rates


def simulate(
    cylinder: Cylinder,
    plan: StrokePlan,
    set_pressure: float,
    extra: ExtraFriction | None = None,
    bristle_at_rest: float = 0.0,
) -> Motion:
    """Move the rod through `plan` with the regulator at `set_pressure` [Pa, gauge].

    `bristle_at_rest` (-1 to 1) says how far the seal is bent when the record starts, as a share
    of the Coulomb force. Raises `RuntimeError` when the integrator gives up.
    """
    extra = extra if extra is not None else ExtraFriction()
    profile = _Profile(plan)
    time = np.arange(0.0, profile.time, OUTPUT_STEP)
    bend = bristle_at_rest * cylinder.coulomb_force / cylinder.bristle_stiffness
    force = set_pressure * cylinder.piston_area - cylinder.bristle_stiffness * bend
    start = np.array([force / cylinder.cell_stiffness, 0.0, bend, set_pressure])
    solution, report = odeint(
        _equations(cylinder, extra, profile, set_pressure),
        start,
        time,
        rtol=1e-5,
        atol=1e-9,
        hmax=0.05,
        mxstep=5000,
        full_output=True,
    )
    if "successful" not in str(report["message"]):
        raise RuntimeError(f"the twin's equations were not solved: {report['message']}")
    return _observe(cylinder, extra, profile, time, solution)


def _observe(
    cylinder: Cylinder, extra: ExtraFriction, profile: _Profile, time: Array, solution: Array
) -> Motion:
    """All quantities of the record from the integrated state, shape (n, 4)."""
    spindle = np.array([profile(t) for t in time.tolist()])
    deflection, v, z, p = solution.T
    x = spindle[:, 0] + deflection
    states = zip(x.tolist(), v.tolist(), z.tolist(), p.tolist(), strict=True)
    rows = zip(time.tolist(), states, strict=True)
    friction = np.array([_bristle(cylinder, extra, t, state)[1] for t, state in rows])
    force = cylinder.cell_stiffness * deflection + cylinder.cell_damping * (v - spindle[:, 1])
    acceleration = (p * cylinder.piston_area - friction - force) / cylinder.moving_mass
    return Motion(time, x, v, acceleration, p, friction, force)
