"""Mass flow through a component after ISO 6358, for everything under validation that needs one.

The exponent stands inside the root, as the source's tables use it (eq. 5.8 and 5.9). Near equal pressures the flow is
laminar: a straight line from the pressure ratio `laminar_from` to none at 1.
"""

from __future__ import annotations

from math import sqrt

from validation.reference.compiled import compiled

DENSITY = 1.185
"""kg/m3, of the reference atmosphere (ISO 8778)."""
TEMPERATURE = 293.15
"""K, of the same."""


@compiled
def choked_flow(c: float, p1: float, t1: float, density: float, temperature: float) -> float:
    """kg/s from p1 at t1 however low the pressure beyond; c in m3/(s Pa)."""
    return c * density * sqrt(temperature / t1) * p1


@compiled
def mass_flow(
    component: tuple[float, float, float],
    p1: float,
    t1: float,
    p2: float,
    reference: tuple[float, float],
    laminar_from: float,
) -> float:
    """kg/s through (conductance, critical ratio, subsonic index) from p1 at t1 to a pressure p2 that is not higher.

    reference: density and temperature of the reference atmosphere.
    """
    c, b, m = component
    if p1 <= 0.0:
        return 0.0
    choked = choked_flow(c, p1, t1, reference[0], reference[1])
    ratio = p2 / p1
    if ratio <= b:
        return choked
    r = min(ratio, laminar_from)
    flow = choked * sqrt(1.0 - ((r - b) / (1.0 - b)) ** m)
    return flow if ratio < laminar_from else flow * (1.0 - ratio) / (1.0 - laminar_from)
