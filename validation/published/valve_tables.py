"""How well are the source's tables of the valve known?

    python -m validation.published.valve_tables

Tables 5.1 and 5.2 are one valve at two supplies. ISO 6358 has C, b and m that no supply changes, so each is a
measurement of the same flow, and half the variance of their difference is that of one of them. And the source does not
say how a table is read between its rows: straight lines give another flow than the core's curve (interpolate.hpp), most
of all where the valve begins to open. Both together, at the knots of the core's map error (map_error.hpp), are what
`flow_map_*` in params.def declare.

Compared are flows at the pressure ratios of a piston that moves: a chamber at 0.5 to 0.8 of its supply, vented at 0.2
to 0.5. What is common to all openings is the mass flow gain's.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from sms import _core
from sms.arrays import Array
from sms.parameters import PARAMETERS

KNOTS = np.array([0.6, 0.75, 0.95, 1.25, 1.8, 3.0])
"""V, of flow_map_* (valve.hpp)."""
OPENINGS = np.linspace(0.56, 3.2, 400)
"""V, from the first row on."""
AT_KNOTS = np.column_stack([np.interp(OPENINGS, KNOTS, row) for row in np.eye(len(KNOTS))])
"""(openings, knots): weights of the values at the knots."""
CHARGED, VENTED = (0.5, 0.6, 0.7, 0.8), (0.2, 0.3, 0.4, 0.5)
"""Ratios of the downstream to the upstream pressure."""
UPSTREAM = 6e5
"""Pa absolute; what is compared are quotients of flows, which it does not change."""
PARAMS = _core.Params()
Component = tuple[Array, Array, Array]
"""C, b, m over OPENINGS."""


def flow(component: Component, ratio: float) -> Array:
    """kg/s, from UPSTREAM to this share of it."""
    temperature = PARAMS.reference_temperature
    return np.asarray(
        _core.iso_mass_flow(PARAMS, *component, UPSTREAM, ratio * UPSTREAM, temperature)
    )


def between(first: Component, second: Component, ratios: Sequence[float]) -> Array:
    """(knots,): logarithm of the one's flow over that of the other."""
    logarithm = np.mean([np.log(flow(first, r) / flow(second, r)) for r in ratios], axis=0)
    return np.asarray(np.linalg.lstsq(AT_KNOTS, logarithm, rcond=None)[0])


def spread(charged: bool) -> Array:
    """(knots,): Table 5.1's flow over that of 5.2, logarithm, less what all openings share."""
    read = _core.charge_flow if charged else _core.discharge_flow
    first, second = (read(PARAMS, OPENINGS, law) for law in ("iso_0_2_mpa", "iso_0_4_mpa"))
    found = between(first, second, CHARGED if charged else VENTED)
    return np.asarray(found - np.mean(AT_KNOTS @ found))


def reading(charged: bool) -> Array:
    """(knots,): flow by Table 5.2 read straight between rows over that by the core's curve, logarithm."""
    read, column = (_core.charge_flow, "charge") if charged else (_core.discharge_flow, "discharge")
    table = _core.valve_table("iso_0_4_mpa")
    c, b, m = (np.interp(OPENINGS, table["opening"], table[f"{column}_{n}"]) for n in "Cbm")
    curve = read(PARAMS, OPENINGS, "iso_0_4_mpa")
    return between((c, b, m), curve, CHARGED if charged else VENTED)


def half_widths() -> Array:
    """(knots,): standard deviation of one table's flow, and of how it is read."""
    tables, readings = (
        np.mean([law(charged) ** 2 for charged in (True, False)], axis=0)
        for law in (spread, reading)
    )
    return np.asarray(np.sqrt(tables / 2.0 + readings))


def main() -> None:
    print("           5.1 over 5.2         straight over curve")
    print("opening   charged    vented    charged    vented    together   declared")
    declared = [PARAMETERS[f"flow_map_feed_lower_{k + 1}"].uncertainty for k in range(len(KNOTS))]
    columns = [spread(True), spread(False), reading(True), reading(False), half_widths(), declared]
    for opening, row in zip(KNOTS, np.array(columns).T, strict=True):
        print(f"{opening:5.2f} V" + "".join(f"{100.0 * x:8.1f} %" for x in row))


if __name__ == "__main__":
    main()
