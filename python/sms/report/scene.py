"""The platform in 3-D over a stretch of a run, as plain data that scene.js animates."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.scenario.record import Record

LONGEST = 60.0  #: s that are animated
_PERIOD = 0.1  # s between frames
_PAYLOAD = 0.42, 0.42, 1.0  # half width, half length, height of the box that stands for it, m


def scene_of(run: Record, params: Params) -> dict[str, Any] | None:
    """Frames of the most interesting minute (where the tilt is largest); None on the bench.

    The poses are the run's, the points carried along with them the core's.
    """
    if run.pose is None or run.time.size < 2:
        return None
    rows = _rows(run)
    at_rest = np.vstack([_points(params, "platform_joint"), _payload(params)])
    carried = _core.carried_points(params, np.ascontiguousarray(run.pose[rows]), at_rest)
    points = carried.reshape(len(rows), -1, 3)
    base = _points(params, "base_joint")
    rest = _points(params, "platform_joint")[:3] - base[:3]
    pressure = 1e-5 * run.chamber_pressure_lower[rows]
    return {
        "period": float(np.median(np.diff(run.time[rows]))) if len(rows) > 1 else _PERIOD,
        "base": _rounded(base),
        "cylinder": [0.97 * float(np.linalg.norm(leg)) for leg in rest],
        "low": round(1e-5 * params.ambient_pressure, 2),
        "high": round(1e-5 * params.supply_pressure, 2),
        "frames": [
            {
                "time": round(float(run.time[row]), 3),
                "joints": _rounded(points[i, :6]),
                "payload": _rounded(points[i, 6:]),
                "pressure": [round(float(p), 3) for p in pressure[i]],
            }
            for i, row in enumerate(rows)
        ],
    }


def _rows(run: Record) -> Array:
    """Samples of the frames: all of a short run, else the minute around the largest tilt."""
    assert run.pose is not None
    first, last = 0.0, float(run.time[-1])
    if last > LONGEST:
        worst = float(run.time[int(np.argmax(np.hypot(run.pose[:, 0], run.pose[:, 1])))])
        first = min(max(worst - 0.5 * LONGEST, 0.0), last - LONGEST)
        last = first + LONGEST
    wanted = np.arange(first, last + 1e-9, _PERIOD)
    return np.unique(np.searchsorted(run.time, wanted).clip(0, run.time.size - 1))


def _points(params: Params, name: str) -> Array:
    return np.array(
        [[params[f"{name}_{number}_{axis}"] for axis in "xyz"] for number in range(1, 7)]
    )


def _payload(params: Params) -> Array:
    """A box around the payload's centre of gravity, standing on the platform's joints."""
    x, y, z = (params[f"payload_cog_{axis}"] for axis in "xyz")
    wide, long, high = _PAYLOAD
    corners = [(-wide, -long), (wide, -long), (wide, long), (-wide, long)]
    ends = (z + 0.5 * high, z - 0.5 * high)
    return np.array([[x + i, y + j, end] for end in ends for i, j in corners])


def _rounded(points: Array) -> list[list[float]]:
    return [[round(float(v), 4) for v in point] for point in points]
