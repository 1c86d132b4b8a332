"""What a motion of the platform is held against: stroke, speed by the valve's flow, force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.dynamics import holding_force
from sms.errors import InputError
from sms.kinematics import inverse_kinematics, inverse_motion
from sms.motion.deck import DeckMotion
from sms.motion.speed import SpeedLimits, speed_limits
from sms.workspace import force_share


@dataclass(frozen=True)
class Limits:
    """What a motion is held against."""

    params: Params
    height: float  #: about which the platform moves, m
    clearance: float  #: kept free at both ends of the stroke, m
    speed: SpeedLimits  #: of an actuator under its share of the weight

    @property
    def stroke(self) -> tuple[float, float]:
        """Extensions that are allowed, m."""
        return self.clearance, self.params.stroke - self.clearance


@dataclass(frozen=True)
class Demand:
    """What a motion asks of the actuators; (n, 3) or (n,)."""

    extension: Array  #: m
    extension_rate: Array  #: m/s
    force_share: Array  #: (n,) of the most loaded actuator, 1 is all the supply pressure gives

    def stroke_excess(self, limits: Limits) -> Array:
        """How far the worst actuator is outside the allowed stroke, m, (n,); negative inside."""
        low, high = limits.stroke
        return np.asarray(np.maximum(low - self.extension, self.extension - high).max(axis=1))

    def speed_share(self, limits: Limits) -> Array:
        """Speed of the fastest actuator over what the flow allows, (n,)."""
        up, down = limits.speed.up, limits.speed.down
        share = np.maximum(self.extension_rate / up, -self.extension_rate / down)
        return np.asarray(share.max(axis=1))


def limits_of(
    params: Params,
    height: float,
    clearance: float | None = None,
    law: str = "iso_0_4_mpa",
    masses: str = "corrected",
) -> Limits:
    """The limits at a height (m); InputError when it leaves no room between the clearances."""
    clearance = params.cushion_length if clearance is None else clearance
    if not 0.0 <= clearance < 0.5 * params.stroke:
        raise InputError(
            f"clearance = {1e3 * clearance:g} mm: 0 to less than half of the stroke, "
            f"{500.0 * params.stroke:g} mm, is allowed"
        )
    level = inverse_kinematics(0.0, 0.0, height, params=params).extension
    low, high = clearance, params.stroke - clearance
    if not (low <= level.min() and level.max() <= high):
        raise InputError(
            f"height = {height:g} m: level, the actuators would be at {1e3 * level.max():.0f} mm; "
            f"{1e3 * low:.0f} to {1e3 * high:.0f} mm is allowed"
        )
    load = float(holding_force((0.0, 0.0, height), masses, params=params).max())
    return Limits(params, height, clearance, _speeds(params, load, law))


def demand_of(motion: DeckMotion, limits: Limits) -> Demand:
    """Extensions, their rates and the forces that a motion asks for.

    Raises: OutOfWorkspaceError where the mechanism has no such pose at all.
    """
    q = poses_of(motion, limits.height)
    return demand_at(q, motion.rates(1), motion.rates(2), limits)


def demand_at(q: Array, qdot: Array, qddot: Array, limits: Limits) -> Demand:
    """The same from poses, rates and accelerations, (n, 3) each."""
    params = limits.params
    return Demand(
        extension=inverse_kinematics(*q.T, params=params).extension,
        extension_rate=inverse_motion(q, qdot, qddot, params=params).extension_rate,
        force_share=force_share(q, qddot, params=params),
    )


def poses_of(motion: DeckMotion, height: float) -> Array:
    """(roll, pitch, height), (n, 3), of a motion about a height (m)."""
    return np.column_stack([motion.roll, motion.pitch, height + motion.heave])


def narrowed(limits: Limits) -> Params:
    """A machine whose whole stroke is what is left between the clearances."""
    narrow = limits.params.copy()
    for number in (1, 2, 3):
        narrow[f"actuator_length_offset_{number}"] += limits.clearance
    narrow.stroke = limits.params.stroke - 2.0 * limits.clearance
    return narrow


def level_heights(limits: Limits) -> tuple[float, float]:
    """Heights (m) that level allows between the clearances, with a little tilt to spare."""
    ends = np.array([[end] * 3 for end in limits.stroke])
    pose, _, _, _ = _core.forward_kinematics(limits.params, ends)
    return float(pose[0, 2]) + 1e-6, float(pose[1, 2]) - 1e-6


def _speeds(params: Params, load: float, law: str) -> SpeedLimits:
    try:
        return speed_limits(load, law, params=params)
    except ValueError:
        raise InputError(
            f"supply_pressure = {1e-3 * params.supply_pressure:g} kPa (absolute): it cannot lift "
            f"the platform, which takes {load:.0f} N an actuator; raise it or lower payload_mass"
        ) from None
