"""How well are the source's tables of the valve known? By how much the two differ.

    python -m validation.published.valve_tables

Tables 5.1 and 5.2 are one valve at two supplies. ISO 6358 has C, b and m that no supply changes, so each is a
measurement of the same flow, and half the variance of their difference is that of one of them. Compared are flows at
the pressure ratios of a piston that moves: a chamber at 0.5 to 0.8 of its supply, vented at 0.2 to 0.5. What is common
to all openings is the mass flow gain's; what is left, at the knots of the core's map error (map_error.hpp), is what
`flow_map_*` in params.def declare.
"""

from __future__ import annotations

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


def main() -> None:
    print("opening    charged    vented    one table    declared")
    charged, vented = 100.0 * differences()
    declared = [PARAMETERS[f"flow_map_feed_lower_{k + 1}"].uncertainty for k in range(len(KNOTS))]
    for row in zip(KNOTS, charged, vented, 100.0 * half_widths(), declared, strict=True):
        opening, charge, vent, one, said = row
        print(f"{opening:5.2f} V {charge:9.1f} % {vent:7.1f} % {one:10.1f} % {100.0 * said:9.0f} %")


if __name__ == "__main__":
    main()
