"""How fast an actuator can move: its steady speed at a valve command, against a load.

At a steady speed both chambers' pressures stand still and the forces balance. The flows, the
pressures' rates and the forces are the core's (valve.hpp, chamber.hpp, friction.hpp); here only
their zero is looked for. Valid while the piston is away from its ends and the supply holds.
"""

from __future__ import annotations

from dataclasses import dataclass

from scipy.optimize import brentq

from sms import _core
from sms._core import Params

_HIGHEST_SPEED = 5.0  # m/s, beyond what any pneumatic cylinder does
_VACUUM = 1.0  # Pa
_MOST = 100.0  # times the supply pressure: more than any load holds against


@dataclass(frozen=True, slots=True)
class SteadyMotion:
    """An actuator at a steady speed."""

    velocity: float  #: m/s, positive out
    chamber_pressure_lower: float  #: Pa
    chamber_pressure_upper: float  #: Pa
    mass_flow: float  #: drawn from the supply, kg/s


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """What the valve's flow allows against the load, fully open."""

    up: float  #: m/s, extending
    down: float  #: m/s, retracting, positive
    load: float  #: N that the actuator carries


def steady_motion(
    command: float, load: float, law: str = "iso_0_4_mpa", *, params: Params | None = None
) -> SteadyMotion:
    """Speed and pressures at a valve command (V) while the actuator carries `load` (N).

    At mid-stroke; at a steady speed the place does not matter. ValueError when the load alone runs
    the piston (beyond what the pressures can hold) or the valve is closed.
    """
    params = params or Params()

    def pressures(velocity: float) -> tuple[float, float]:
        return (
            _standing(params, command, velocity, "lower", law),
            _standing(params, command, velocity, "upper", law),
        )

    def surplus(velocity: float) -> float:
        lower, upper = pressures(velocity)
        return _rod_force(params, velocity, lower, upper) - load

    outward = command > params.valve_centre
    ends = (1e-6, _HIGHEST_SPEED) if outward else (-_HIGHEST_SPEED, -1e-6)
    if surplus(ends[0]) * surplus(ends[1]) > 0.0:
        raise ValueError(
            f"at {command:g} V and {load:.0f} N there is no steady speed: the valve is closed or "
            "the load is more than the pressure can move"
        )
    velocity = float(brentq(surplus, *ends, xtol=1e-9))
    lower, upper = pressures(velocity)
    flow = _flows(params, command, lower, upper, law)
    return SteadyMotion(velocity, lower, upper, flow[0] + flow[2])


def speed_limits(
    load: float, law: str = "iso_0_4_mpa", *, params: Params | None = None
) -> SpeedLimits:
    """The steady speeds at both ends of the valve's command, 0 and 10 V. ValueError as above."""
    params = params or Params()
    span = 5.0
    up = steady_motion(params.valve_centre + span, load, law, params=params).velocity
    down = -steady_motion(params.valve_centre - span, load, law, params=params).velocity
    return SpeedLimits(up=up, down=down, load=load)


def _flows(
    params: Params, command: float, lower: float, upper: float, law: str
) -> tuple[float, float, float, float]:
    ambient = params.ambient_pressure
    flows = _core.valve_mass_flow(
        params, command, params.supply_pressure, lower, upper, ambient, law
    )
    return tuple(float(flow) for flow in flows)  # type: ignore[return-value]


def _standing(params: Params, command: float, velocity: float, chamber: str, law: str) -> float:
    """The pressure at which one chamber's stands still; each chamber's flows feel only its own."""
    lower_one = chamber == "lower"
    x = 0.5 * params.stroke

    def rate(pressure: float) -> float:
        into, out, into_upper, out_upper = _flows(params, command, pressure, pressure, law)
        inflow, outflow = (into, out) if lower_one else (into_upper, out_upper)
        return float(
            _core.chamber_pressure_rate(params, chamber, pressure, x, velocity, inflow, outflow)
        )

    high = _MOST * params.supply_pressure
    if rate(_VACUUM) <= 0.0:
        return _VACUUM
    if rate(high) > 0.0:  # the piston compresses faster than a choked port lets out
        return high
    return float(brentq(rate, _VACUUM, high, xtol=1e-3, rtol=1e-12))


def _rod_force(params: Params, velocity: float, lower: float, upper: float) -> float:
    """What the rod gives its load at a steady speed, N."""
    return float(_core.rod_force(params, 0.5 * params.stroke, velocity, 0.0, lower, upper))
