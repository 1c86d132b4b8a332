"""How well one record tells C, b and m: interval, verdict, and the budget of C.

The budget follows the GUM (JCGM 100), as the amendments of ISO 6358-1 and -2 ask: the fit's own error, and what is only
known within limits (tank volume, temperature, pressures, gas) as rectangular distributions, carried by the fit's exact
sensitivities.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms.identification.estimate import Estimate, sensitivity
from sms.identification.flow_problem import COMPONENT, SYMBOL, Declared, bounds_of_component
from sms.identification.profile import Profile
from sms.parameters import PARAMETERS
from sms.units_display import display_unit

USEFUL = {"component_critical_ratio": 0.1, "component_subsonic_index": 0.5}
"""Half width of the 95 percent interval up to which a number is worth printing."""
BUDGET = (
    "tank_volume",
    "air_temperature",
    "wall_temperature",
    "heat_transfer_coefficient",
    "tank_wall_area",
    "supply_pressure",
    "ambient_pressure",
    "sensor_gain_tank_pressure",
    "sensor_offset_tank_pressure",
    "gas_constant",
    "reference_density",
    "inflow_heat_ratio",
    "outflow_heat_ratio",
    "heat_capacity_ratio",
    "opening_duration",
)
"""Parameters that are only known within limits and would shift the fit."""


@dataclass(frozen=True)
class Known:
    """One of C, b, m: its value, interval and whether the record tells it."""

    name: str
    value: float
    sd: float
    """From the fit alone."""
    lower: float
    upper: float
    closed: bool
    """The data hold it on both sides."""
    identifiable: bool
    """Closed, and narrow enough to be worth a number."""

    @property
    def verdict(self) -> str:
        """For a person: the interval, or that there is none worth a number."""
        symbol = SYMBOL[self.name]
        if self.name == COMPONENT[0]:
            unit = display_unit(PARAMETERS[self.name].unit)
            c, low, high = (unit.scale(v) for v in (self.value, self.lower, self.upper))
            return f"C = {c:.4g} {unit.label}, 95 %: {low:.4g} to {high:.4g}"
        if self.identifiable:
            return f"{symbol} = {self.value:.3g}, 95 %: {self.lower:.3g} to {self.upper:.3g}"
        side = "" if self.closed else ", where its bounds are"
        return f"{symbol} not identifiable: any value from {self.lower:.2g} to {self.upper:.2g} fits{side}"


@dataclass(frozen=True)
class Contribution:
    """One line of the uncertainty budget of C."""

    name: str
    limits: float
    """Half width within which it is known, its unit; nan for the fit itself."""
    uncertainty: float
    """Standard uncertainty it gives to C, m^3/(s Pa)."""


def known_of(found: Estimate, name: str, curve: Profile | None, limits: float) -> Known:
    """`limits`: standard uncertainty of C beside the fit, which widens its interval."""
    value = found.params[name]
    if name not in [f.name for f in found.free]:
        bounds = next(f for f in bounds_of_component() if f.name == name)
        return Known(name, value, np.nan, bounds.lower, bounds.upper, False, False)
    sd = found.sd(name)
    lower, upper = value - 1.96 * sd, value + 1.96 * sd
    closed = bool(np.isfinite(sd))
    if curve is not None:
        lower, upper, closed = curve.lower, curve.upper, curve.closed
    if name == COMPONENT[0]:
        wider = 1.96 * limits
        lower, upper = (
            value - np.hypot(value - lower, wider),
            value + np.hypot(upper - value, wider),
        )
        return Known(name, value, sd, float(lower), float(upper), closed, closed)
    useful = USEFUL[name] * (1.0 if name == COMPONENT[1] else max(value, 1e-9))
    identifiable = bool(closed and 0.5 * (upper - lower) <= useful)
    return Known(name, value, sd, lower, upper, closed, identifiable)


def budget_of(found: Estimate, declared: Declared, heat: str) -> tuple[Contribution, ...]:
    """The fit itself, then what is known within limits only, the largest first."""
    fitted = {f.name for f in found.free}
    names = [n for n in BUDGET if n not in fitted and declared(n).uncertainty > 0.0]
    if heat == "polytropic":  # its limits are those of a model that does not use them
        names = [n for n in names if n not in ("wall_temperature", "heat_transfer_coefficient")]
    shift = sensitivity(found, names)[found.index("component_conductance")]
    limits = np.array([declared(n).uncertainty for n in names])
    lines = [
        Contribution(name, float(limit), float(abs(s) * limit / np.sqrt(3.0)))
        for name, limit, s in zip(names, limits, shift, strict=True)
        if s != 0.0
    ]
    lines.sort(key=lambda line: -line.uncertainty)
    return (Contribution("fit", np.nan, found.sd("component_conductance")), *lines)
