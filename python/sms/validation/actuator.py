"""One actuator: the sine of section 7.2, the chambers at rest, velocity per volt."""

from __future__ import annotations

import itertools

import numpy as np
from scipy.optimize import brentq

from sms import _core
from sms._core import Params
from sms.cylinder import rod_force
from sms.dynamics import holding_force
from sms.kinematics import forward_kinematics
from sms.motion.speed import steady_motion
from sms.scenario import Record
from sms.validation.figures import FIGURES, Row, peak_to_peak
from sms.validation.runs import run, sample

FREQUENCY = 0.328  # Hz
_SETTLED = 2  # periods that are not looked at
_SEEN = 1e-3  # m, motion that can be told from rest
_OFFSETS = -0.1, 0.1  # V, between which the one without drift lies


def sine() -> list[Row]:
    """The bench under 0.54 V at 0.328 Hz with jumps of 0.5 V."""
    record = run("bench_sine")
    halved = run("bench_sine", excitation={"amplitude": "0.27 V"})
    drift = _drift(record)
    offset = float(brentq(lambda volts: _drift(_shifted(volts)), *_OFFSETS, xtol=1e-3))
    published = _shifted(0.165)
    at_stop = published.extension.max() > 0.999 * Params().stroke
    remark = (
        f"centre at 5 V; with 0.165 V {'the piston ends at the stop' if at_stop else 'it drifts'}"
    )
    return [
        FIGURES["bench_travel"].row(
            travel(record), f"mass-flow gain 1.5; drift {1e3 * drift:.1f} mm a period"
        ),
        FIGURES["bench_travel_peak_to_peak"].row(travel(halved), "mass-flow gain 1.5"),
        FIGURES["bench_delay"].row(_delay(record), "no seal is modelled"),
        FIGURES["bench_offset"].row(offset, remark),
    ]


def travel(record: Record) -> float:
    """Median travel of a period, m."""
    x = record.extension[:, 0]
    period = 1.0 / FREQUENCY
    count = int(record.time[-1] / period)
    edges = [sample(record, period * k) for k in range(_SETTLED, count + 1)]
    return float(np.median([peak_to_peak(x[a:b]) for a, b in itertools.pairwise(edges)]))


def _shifted(volts: float) -> Record:
    return run("bench_sine", excitation={"offset": f"{volts!r} V"})


def _drift(record: Record) -> float:
    """m a period, between the third and the last whole one."""
    period = 1.0 / FREQUENCY
    last = int(record.time[-1] / period)
    means = [
        record.extension[sample(record, period * k) : sample(record, period * (k + 1)), 0].mean()
        for k in (_SETTLED, last - 1)
    ]
    return float(means[1] - means[0]) / (last - 1 - _SETTLED)


def _delay(record: Record) -> float:
    """Mean time from a change of the command's sign to a millimetre of motion the new way, s."""
    x = record.extension[:, 0]
    half = 0.5 / FREQUENCY
    delays = []
    for k in range(2 * _SETTLED, int(record.time[-1] / half)):
        begin, end = sample(record, half * k), sample(record, half * (k + 1))
        direction = 1.0 if k % 2 == 0 else -1.0
        way = direction * x[begin:end]
        turn = int(np.argmin(way))  # it runs on until there
        moved = np.flatnonzero(way[turn:] - way[turn] > _SEEN)
        if moved.size:
            delays.append(record.time[begin + turn + int(moved[0])] - record.time[begin])
    return float(np.mean(delays))


def at_rest() -> list[Row]:
    """Level at mid-stroke, the valves closed: how the printed mean splits under the weight."""
    record = run("bench_sine", start={"load_force": f"{share_of_weight()!r} N"})
    lower, upper = (
        float(values[0, 0])
        for values in (record.chamber_pressure_lower, record.chamber_pressure_upper)
    )
    printed = 386e3, 281e3
    remark = "the mean of both is an input, 333 kPa as printed"
    force, carried = (
        float(rod_force(0.0, pressure_lower=a, pressure_upper=b))
        for a, b in ((lower, upper), printed)
    )
    return [
        FIGURES["rest_lower"].row(lower, remark),
        FIGURES["rest_upper"].row(upper, remark),
        FIGURES["rest_force"].row(force, f"the printed pressures carry {carried:.0f} N"),
    ]


def speeds() -> list[Row]:
    """Steady speed under the load, over the controller's voltage."""
    params = Params()
    load = share_of_weight()
    rows = []
    for key, volts in (("speed_open", 5.0), ("speed_small", 0.5)):
        command = float(_core.valve_command(params, volts))
        below = float(_core.valve_command(params, -volts))
        up = steady_motion(command, load, params=params).velocity / volts
        down = -steady_motion(below, load, params=params).velocity / volts
        remark = f"{command:.2f} V at the valve; {down:.3f} downwards"
        rows.append(FIGURES[key].row(up, remark))
    return rows


def share_of_weight() -> float:
    """What one actuator carries, level at mid-stroke, N."""
    height = float(forward_kinematics([0.5 * Params().stroke] * 3).height)
    return float(holding_force([0.0, 0.0, height]).mean())
