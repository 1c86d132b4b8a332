"""What the mechanism, the valve's flow and the supply's force give: range, rate, acceleration, load."""

from __future__ import annotations

import math

import numpy as np

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.cylinder import friction
from sms.dynamics import holding_force, inverse_dynamics
from sms.kinematics import height_range, jacobian
from sms.motion.speed import SpeedLimits, speed_limits
from sms.requirements.table import ACCELERATIONS, BANDWIDTHS, LOADS, RATES, REQUIRED, SPECIFIED, Row
from sms.workspace import reach, rectangle_margin
from sms.workspace_survey import DEGREE, Box

_HEIGHTS = 81
_GRID = 5  # poses an axis of the box
_HALVINGS = 40
_HEAVIEST = 2000.0  # kg, where the search for the largest payload ends


def best_height(params: Params, box: Box) -> float:
    """The height (m) at which a box leaves most stroke."""
    heights = np.linspace(*height_range(params), 20 * _HEIGHTS)[1:-1]
    margin = rectangle_margin(heights, box.roll, box.pitch, params=params)
    return float(heights[int(np.argmax(margin))])


# ---- range: the stroke ----


def range_rows(params: Params) -> list[Row]:
    heights = np.linspace(*height_range(params), _HEIGHTS)[1:-1]
    rows = []
    asked = {
        "roll": (REQUIRED.roll, SPECIFIED.roll, 0.0),
        "pitch": (REQUIRED.pitch, SPECIFIED.pitch, 0.5 * math.pi),
    }
    for axis, (required, specified, direction) in asked.items():
        both = [reach(heights, direction + turn, params=params) for turn in (0.0, math.pi)]
        angle = np.minimum(*both)
        best = int(np.argmax(angle))
        remark = f"the other axis level, at a height of {heights[best]:.3f} m"
        largest = float(angle[best])
        rows.append(Row("range", axis, required, specified, largest, "rad", "stroke", remark))
    return [*rows, _together(params, REQUIRED), _together(params, SPECIFIED)]


def _together(params: Params, box: Box) -> Row:
    """How much of a box fits, both angles at once, at its best height; as the roll's angle."""
    heights = np.linspace(*height_range(params), 20 * _HEIGHTS)[1:-1]

    def margin(factor: float) -> Array:
        sides = factor * box.roll, factor * box.pitch
        return rectangle_margin(heights, *sides, params=params)

    low, high = 0.0, 2.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if margin(middle).max() >= 0.0 else (low, middle)
    height = heights[int(np.argmax(margin(low)))]
    missing = float(margin(1.0).max())
    left = f"{1e3 * missing:.1f} mm of stroke are left"
    if missing < 0.0:
        left = f"{-1e3 * missing:.1f} mm of stroke are missing for all of it"
    remark = (
        f"with ±{low * box.pitch / DEGREE:.1f}° of pitch at the same time, as the {box.name} ±"
        f"{box.roll / DEGREE:g}° with ±{box.pitch / DEGREE:g}° have it, at {height:.3f} m; {left}"
    )
    axis = f"roll with pitch, {box.name}"
    return Row("range", axis, box.roll, box.roll, low * box.roll, "rad", "stroke", remark)


# ---- rate: the flow ----


def speeds_in(params: Params, q: Array, law: str) -> SpeedLimits:
    """Up against the largest share of the weight in the box, down with the smallest to help."""
    loads = holding_force(q, params=params)
    heavy, light = float(loads.max()), float(loads.min())
    return SpeedLimits(
        up=speed_limits(heavy, law, params=params).up,
        down=speed_limits(light, law, params=params).down,
        load=heavy,
    )


def rate_rows(params: Params, q: Array, speed: SpeedLimits) -> list[Row]:
    rows = []
    per_rate = jacobian(q, params=params)
    for column, (axis, (required, specified)) in enumerate(RATES.items()):
        fastest = _largest(per_rate[..., column], speed.up, speed.down)
        remark = (
            f"in the worst pose of ±{SPECIFIED.roll / DEGREE:g}°, where the actuators move at "
            f"{speed.up:.2f} m/s up and {speed.down:.2f} m/s down with the valve fully open"
        )
        rows.append(Row("rate", axis, required, specified, fastest, "rad/s", "flow", remark))
    return rows


def _largest(slope: Array, positive: float | Array, negative: float | Array) -> float:
    """The largest factor, either way, that keeps -negative <= factor slope <= positive everywhere."""
    with np.errstate(divide="ignore"):
        forward = np.where(slope > 0.0, positive / slope, -negative / slope)
        backward = np.where(slope > 0.0, negative / slope, -positive / slope)
    return float(min(np.abs(forward).min(), np.abs(backward).min()))


# ---- acceleration and load: the force ----


def acceleration_rows(params: Params, q: Array) -> list[Row]:
    rest = holding_force(q, params=params)
    push, pull = _core.force_range(params)
    resistance = _friction_at(params, q)
    rows = []
    for column, (axis, (required, specified)) in enumerate(ACCELERATIONS.items()):
        unit = np.zeros(3)
        unit[column] = 1.0
        slope = inverse_dynamics(q, (0.0, 0.0, 0.0), unit, params=params) - rest
        largest = _largest(slope, push - resistance - rest, pull - resistance + rest)
        remark = (
            f"in the worst pose of ±{SPECIFIED.roll / DEGREE:g}°, with {push:.0f} N of push less "
            f"{resistance:.0f} N of friction at the specified rates"
        )
        rows.append(
            Row("acceleration", axis, required, specified, largest, "rad/s^2", "force", remark)
        )
    return rows


def _friction_at(params: Params, q: Array) -> float:
    """The friction of the fastest actuator at the specified rates of roll and pitch together, N."""
    rate = np.array([RATES["roll"][1], RATES["pitch"][1]])
    per_rate = np.abs(jacobian(q, params=params)[..., :2])
    return float(friction((per_rate @ rate).max(), params=params))


def load_row(params: Params, q: Array) -> Row:
    """The largest payload held in the worst pose with the specified accelerations and friction."""
    acceleration = [ACCELERATIONS[axis][1] for axis in ("roll", "pitch")]
    signs = [(i, j) for i in (-1.0, 1.0) for j in (-1.0, 1.0)]
    push, pull = _core.force_range(params)
    resistance = _friction_at(params, q)

    def holds(payload: float) -> bool:
        loaded = params.copy()
        loaded.payload_mass = payload
        for i, j in signs:
            qddot = (i * acceleration[0], j * acceleration[1], 0.0)
            force = inverse_dynamics(q, (0.0, 0.0, 0.0), qddot, params=loaded)
            if force.max() + resistance > push or -force.min() + resistance > pull:
                return False
        return True

    low, high = 0.0, _HEAVIEST
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    remark = (
        f"held and accelerated as specified in the worst pose of ±{SPECIFIED.roll / DEGREE:g}°, at "
        f"{1e-3 * (params.supply_pressure - params.ambient_pressure):.0f} kPa above ambient"
    )
    return Row("load", "payload", *LOADS, low, "kg", "force", remark)


# ---- bandwidth: the flow at full range ----


def flow_bandwidth_row(params: Params, height: float, speed: SpeedLimits) -> Row:
    """The frequency up to which the flow allows a sine of the specified range."""
    per_rate = jacobian((0.0, 0.0, height), params=params)[:, 0]
    fastest = _largest(per_rate, speed.up, speed.down)
    frequency = fastest / (2.0 * math.pi * SPECIFIED.roll)
    remark = (
        f"a sine of ±{SPECIFIED.roll / DEGREE:g}° of roll; beyond it the valve, fully open, does not "
        "pass enough air"
    )
    return Row("bandwidth", "roll, full range", *BANDWIDTHS, frequency, "Hz", "flow", remark)


def poses_of(box: Box, height: float) -> Array:
    """A grid over a box at a height, (n, 3)."""
    sides = [np.linspace(-1.0, 1.0, _GRID)] * 2
    share = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    return np.column_stack(
        [share[:, 0] * box.roll, share[:, 1] * box.pitch, np.full(len(share), height)]
    )
