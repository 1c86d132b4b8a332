"""What each record of a fit says alone, and by how much the records disagree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from sms.arrays import Array
from sms.estimation.coloured_noise import coloured_meat
from sms.estimation.windows import Runs
from sms.identification.bench_told import size_of
from sms.identification.estimate import Estimate
from sms.io.rig import Rig

RUN_WORTH = 3.0  #: a run alone counts where its error is within so many of its parameter's size


def record_by_record(
    found: Estimate, runs: Runs, weight: Array, name: str, rig: Rig
) -> list[tuple[float, float]]:
    """(value, standard error) by one step of each record's own least squares from the common solution."""
    i = found.index(name)
    inside = np.flatnonzero(np.isfinite(np.diag(found.covariance)))
    if i not in inside:
        return [(np.nan, np.nan)] * len(runs.motions)
    place = int(np.flatnonzero(inside == i)[0])
    prior = np.array([1.0 / f.known_to**2 if f.known_to else 0.0 for f in found.free])[inside]
    off = np.array([found.params[f.name] - found.start[f.name] for f in found.free])[inside]
    out = []
    for number in range(len(runs.motions)):
        own = (runs.record == number) & (weight > 0.0)
        j, r = found.jacobian[np.ix_(own, inside)], found.residual[own]
        length = np.sqrt(np.sum(j**2, axis=0) + prior)
        if not own.any() or not length[place] > 0.0:
            out.append((np.nan, np.nan))
            continue
        length[length == 0.0] = 1.0
        j = j / length
        bread = np.linalg.pinv(j.T @ j + np.diag(prior / length**2), rcond=1e-12, hermitian=True)
        step = -bread @ (j.T @ r + prior * off / length)
        meat = np.diag(prior / length**2)
        for c, colour in enumerate(found.colours):
            meat = meat + coloured_meat(j[runs.channel[own] == c], colour)
        error = float(np.sqrt((bread @ meat @ bread)[place, place]) / length[place])
        worth = error < RUN_WORTH * max(size_of(rig, name, found.params[name]), 1e-300)
        out.append(
            (found.params[name] + float(step[place] / length[place]), error)
            if worth
            else (np.nan, np.nan)
        )
    return out


def birge_ratio(found: Estimate, alone: Mapping[str, Sequence[tuple[float, float]]]) -> float:
    """sqrt(chi-square / freedom) of the records about the common values, over all parameters; at least 1."""
    chi, freedom = 0.0, 0
    for name, runs in alone.items():
        known = [(v, e) for v, e in runs if np.isfinite(v) and e > 0.0]
        if len(known) > 1:
            chi += float(sum(((v - found.params[name]) / e) ** 2 for v, e in known))
            freedom += len(known) - 1
    return float(np.sqrt(max(chi / freedom, 1.0))) if freedom else 1.0
