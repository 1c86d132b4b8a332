"""ISO 6358 against the classic flow law on tank pressures (section 5.4.1).

The source's records are not published. These are synthetic: a tank charged and vented through the
valve as its tables have it, read by a sensor with noise, at several openings, and then given to
`sms identify flow`, which fits both laws. So the error of the ISO fit is the noise; what is shown is
how far one discharge coefficient and the geometry's area stay behind on the same curves.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.identification.flow import fit_record
from sms.identification.flow_record import FlowRecord
from sms.io.declarations import Declaration
from sms.parameters import PARAMETERS
from sms.validation.figures import FIGURES, Row

_OPENINGS = 0.8, 1.2, 1.8, 2.6, 3.5  # V from the centre
_NOISE = 500.0  # Pa, standard deviation of the sensor
_SEED = 20  # of that noise
_RATE = 100.0  # Hz
_BEFORE, _AFTER = 0.5, 0.3  # s at rest before the opening, and part of the way's time after it
_NEARLY = 0.99  # of the pressure difference


def two_laws() -> list[Row]:
    """Both laws fitted to every record; the mean absolute errors over all of them."""
    random = np.random.default_rng(_SEED)
    records = [record(opening, way, random) for opening in _OPENINGS for way in (True, False)]
    fits = [fit_record(one, _declared, with_profiles=False) for one in records]
    iso, classic = (np.array([getattr(f, name) for f in fits]) for name in ("mae", "mae_classic"))
    remark = (
        f"synthetic: {len(fits)} records of the tables' own flow with {_NOISE:g} Pa of noise, as no "
        "measured one is published"
    )
    return [
        FIGURES["tank_iso"].row(float(iso.mean()), remark),
        FIGURES["tank_ratio"].row(float(iso.mean() / classic.mean()), remark),
    ]


def record(opening: float, charge: bool, random: np.random.Generator) -> FlowRecord:
    """One charge or discharge at a constant opening, V from the centre."""
    params = Params()
    table = _core.charge_flow if charge else _core.discharge_flow
    c, b, m = (float(np.ravel(value)[0]) for value in table(params, opening))
    ends = params.ambient_pressure, params.supply_pressure
    inside, outside = ends if charge else ends[::-1]

    def rate(_: float, p: Array) -> list[float]:
        return [float(_core.tank_pressure_rate(params, c, b, m, float(p[0]), outside))]

    def nearly(_: float, p: Array) -> float:
        return float(abs(p[0] - inside) - _NEARLY * abs(outside - inside))

    nearly.terminal = True  # type: ignore[attr-defined]
    way = solve_ivp(rate, (0.0, 1e3), [inside], events=nearly, rtol=1e-6)
    open_for = (1.0 + _AFTER) * float(way.t[-1])
    time: Array = np.arange(0.0, _BEFORE + open_for, 1.0 / _RATE)
    late = np.maximum(time - _BEFORE, 0.0)
    done = solve_ivp(rate, (0.0, open_for), [inside], t_eval=np.unique(late), rtol=1e-8, atol=1.0)
    true = np.interp(late, done.t, done.y[0])
    pressure = true + random.normal(0.0, _NOISE, time.size)
    return FlowRecord(
        name=f"{'charge' if charge else 'discharge'} at {opening:g} V",
        time=time,
        pressure=pressure,
        supply=None,
        temperature=None,
        spool=float(_core.spool_cubic(params, params.valve_centre + opening)),
        supply_pressure=params.supply_pressure,
        ambient_pressure=params.ambient_pressure,
        noise=_NOISE,
    )


def _declared(name: str) -> Declaration:
    """Nothing but the defaults is known."""
    return Declaration(PARAMETERS[name].default, PARAMETERS[name].uncertainty)
