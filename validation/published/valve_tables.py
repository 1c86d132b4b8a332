"""How well are the source's tables of the valve known? By how much the two differ.

    python -m validation.published.valve_tables

Tables 5.1 and 5.2 are one valve at two supplies. ISO 6358 has C, b and m that no supply changes, so each is a
measurement of the same flow, and half the variance of their difference is that of one of them. Compared are flows at
the pressure ratios of a piston that moves: a chamber at 0.5 to 0.8 of its supply, vented at 0.2 to 0.5. What is common
to all openings is the mass flow gain's; what is left, at the knots of the core's map error (map_error.hpp), is what
`flow_map_*` in params.def declare.

The source does not say how a table is read between its rows. Straight lines give another flow than the core's curve
(interpolate.hpp), most of all where the valve begins to open: a second reason to know that flow less well.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from sms import _core
from sms.arrays import Array
from sms.parameters import PARAMETERS

KNOTS = np.array([0.6, 0.75, 0.95, 1.25, 1.8, 3.0])
"""V, of flow_map_* (valve.hpp)."""
OPENINGS = np.linspace(0.56, 3.2, 400)
"""V, from the first row on."""
CHARGED, VENTED = (0.5, 0.6, 0.7, 0.8), (0.2, 0.3, 0.4, 0.5)
"""Ratios of the downstream to the upstream pressure."""
UPSTREAM = 6e5
"""Pa absolute; what is compared are quotients of flows, which it does not change."""


def flow(params: _core.Params, component: tuple[Array, Array, Array], ratio: float) -> Array:
    """kg/s, of a component (C, b, m) from UPSTREAM to this share of it."""
    temperature = params.reference_temperature
    return np.asarray(
        _core.iso_mass_flow(params, *component, UPSTREAM, ratio * UPSTREAM, temperature)
    )


def differences() -> Array:
    """(charged and vented, knots): logarithm of Table 5.1's flow over that of 5.2, less what all openings share."""
    params = _core.Params()
    weight = np.column_stack([np.interp(OPENINGS, KNOTS, row) for row in np.eye(len(KNOTS))])
    rows = []
    for read, ratios in ((_core.charge_flow, CHARGED), (_core.discharge_flow, VENTED)):
        first, second = (read(params, OPENINGS, law) for law in ("iso_0_2_mpa", "iso_0_4_mpa"))
        logarithm = np.mean(
            [np.log(flow(params, first, r) / flow(params, second, r)) for r in ratios], axis=0
        )
        at_knots = np.linalg.lstsq(weight, logarithm, rcond=None)[0]
        rows.append(at_knots - np.mean(logarithm))
    return np.array(rows)


def half_widths() -> Array:
    """(knots,): standard deviation of one table's flow."""
    return np.asarray(np.sqrt(np.mean(differences() ** 2, axis=0) / 2.0))


def readings() -> list[tuple[float, float, float, float]]:
    """(from, to, charged, vented) of each two neighbouring openings of KNOTS: largest difference of a straight reading
    of Table 5.2 from the core's, relative."""
    params, table = _core.Params(), _core.valve_table("iso_0_4_mpa")
    difference = []
    for name, read, ratios in (
        ("charge", _core.charge_flow, CHARGED),
        ("discharge", _core.discharge_flow, VENTED),
    ):
        straight = [np.interp(OPENINGS, table["opening"], table[f"{name}_{n}"]) for n in "Cbm"]
        curve = read(params, OPENINGS, "iso_0_4_mpa")
        here = [
            flow(params, (straight[0], straight[1], straight[2]), r) / flow(params, curve, r) - 1.0
            for r in ratios
        ]
        difference.append(np.max(np.abs(here), axis=0))
    return [
        (low, high, *(float(np.max(d[(low <= OPENINGS) & (high > OPENINGS)])) for d in difference))
        for low, high in pairwise([OPENINGS[0], *KNOTS[1:]])
    ]


def main() -> None:
    print("opening    charged    vented    one table    declared")
    charged, vented = 100.0 * differences()
    declared = [PARAMETERS[f"flow_map_feed_lower_{k + 1}"].uncertainty for k in range(len(KNOTS))]
    for row in zip(KNOTS, charged, vented, 100.0 * half_widths(), declared, strict=True):
        opening, charge, vent, one, said = row
        print(f"{opening:5.2f} V {charge:9.1f} % {vent:7.1f} % {one:10.1f} % {100.0 * said:9.0f} %")
    print("\nread straight between rows: differs by at most")
    for low, high, charge, vent in readings():
        print(f"{low:.2f} to {high:.2f} V {100.0 * charge:5.1f} % {100.0 * vent:7.1f} %")


if __name__ == "__main__":
    main()
