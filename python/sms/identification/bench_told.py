"""What the records of a bench can tell of a parameter, and what is worth telling.

A parameter is asked about in units of what is known of it already, or of a share of its value. Before a fit the
records' own information answers, white declared noise taken for granted; after it, the covariance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.estimation.windows import Runs
from sms.identification.estimate import Estimate, Free
from sms.io.rig import Rig
from sms.parameters import PARAMETERS
from sms.units_display import format_quantity, words

USUAL = {"valve_centre": 0.05, "dead_band_change": 0.05, "command_delay": 2e-3}
"""Standard errors up to which these are worth knowing, V and s."""
EFFECT = (
    3.0  #: standard errors at which a parameter that is zero on a healthy machine counts as told
)
WORTH = 0.5  #: half width of a 95 percent interval over the value, up to which a number is worth printing
WHY_UNFELT: Mapping[str, str] = {
    "inflow_heat_ratio": "the valve's tables were computed with one; only their product counts, and that is the "
    "mass-flow gain's",
    "outflow_heat_ratio": "the valve's tables were computed with one; only their product counts, and that is the "
    "mass-flow gain's",
    "stribeck_acceleration_factor": "stiction equals Coulomb friction at the start",
    "stiction_force": "without an acceleration factor there is no Stribeck term",
}
"""Why no record of this kind is sensitive to a parameter at its start."""


def size_of(rig: Rig, name: str, value: float) -> float:
    """What a standard error is held against: what is known already, or a share of the value.

    inf for a parameter whose neutral value is zero and whose usual size nobody has said.
    """
    known = rig.declared(name).uncertainty or np.inf
    if name in USUAL:
        return min(known, USUAL[name])
    if PARAMETERS[name].default == 0.0:
        return float(known)
    return min(known, WORTH * abs(value) / 1.96)


def choose(
    runs: Runs,
    weight: Array,
    start: _core.Params,
    names: Sequence[str],
    beside: list[Free],
    rig: Rig,
) -> tuple[list[str], list[tuple[str, str]]]:
    """Drop what the records are insensitive to, then, worst first, what would not be known better.

    In declared noise, at the start. Insensitive: a change by its whole size changes chi-square by less than one.

    What surrounds is left out of `beside` in place where the records are insensitive to it.
    """
    every = [*names, *(f.name for f in beside)]
    _, jacobian = runs.problem.evaluate(start, every)
    jacobian = jacobian * weight[:, None]
    usual = [abs(start[n]) or USUAL.get(n) or rig.declared(n).uncertainty or np.inf for n in every]
    norm = np.linalg.norm(jacobian, axis=0)
    felt = {n: bool(x > 0.0 and x * u > 1.0) for n, x, u in zip(every, norm, usual, strict=True)}
    beside[:] = [f for f in beside if felt[f.name]]
    kept = [n for n in names if felt[n]]
    left_out = [
        (n, WHY_UNFELT.get(n, "these records are insensitive to it")) for n in names if not felt[n]
    ]
    column = {n: jacobian[:, i] for i, n in enumerate(every)}
    while kept:
        order = [*kept, *(f.name for f in beside)]
        error, correlation = _expected([column[n] for n in order], beside, len(kept))
        shares = [error[i] / max(size_of(rig, n, start[n]), 1e-300) for i, n in enumerate(kept)]
        worst = int(np.argmax(shares))
        if shares[worst] < 2.0:
            break
        left_out.append(
            (kept[worst], _why(rig, kept[worst], error[worst], correlation[worst], order))
        )
        del kept[worst]
    return kept, left_out


def _expected(columns: Sequence[Array], beside: Sequence[Free], own: int) -> tuple[Array, Array]:
    """(own,) standard errors by the information of white declared noise, (own, all) correlations."""
    j = np.column_stack(columns)
    length = np.linalg.norm(j, axis=0)
    j = j / length
    prior = np.array([0.0] * own + [1.0 / f.known_to**2 for f in beside])
    covariance = np.linalg.pinv(j.T @ j + np.diag(prior / length**2), rcond=1e-13, hermitian=True)
    sd = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    return np.asarray((sd / length)[:own]), np.asarray((covariance / np.outer(sd, sd))[:own])


def _why(rig: Rig, name: str, error: float, correlation: Array, order: Sequence[str]) -> str:
    """Why a parameter that the records are sensitive to is not identifiable."""
    unit = PARAMETERS[name].unit
    other = np.abs(correlation).copy()
    other[list(order).index(name)] = 0.0
    twin = order[int(np.argmax(other))]
    known = rig.declared(name).uncertainty
    before = (
        f", declared within {format_quantity(known, unit, name)} already" if known > 0.0 else ""
    )
    repeats = f"; it is correlated with {words(twin)}" if other.max() > 0.9 else ""
    return f"these records determine it only within {format_quantity(1.96 * error, unit, name)}{before}{repeats}"


def untold_of(found: Estimate, names: Sequence[str], rig: Rig) -> tuple[str, str] | None:
    """The worst of the fitted that the records do not tell, if its error passes three times what is worth a number."""
    order = [f.name for f in found.free]
    shares = [
        found.sd(n) / max(size_of(rig, n, found.params[n]), 1e-300)
        if np.isfinite(found.sd(n))
        else 0.0
        for n in names
    ]
    if not shares or max(shares) < 3.0:
        return None
    name = names[int(np.argmax(shares))]
    row = np.nan_to_num(found.correlation[found.index(name)])
    return name, _why(rig, name, found.sd(name), row, order)
