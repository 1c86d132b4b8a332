"""Where an equation is wrong, as a region of its signals, and the short law that is missing there.

After Wang, "Where Is My Physics Wrong? Localized and Identifiable Discovery of Model Discrepancy" (LISDD,
arXiv 2606.23215, 2026), built from its abstract: a residual-energy statistic flags regions, a holdout over all short
laws of a library chooses what is missing in each, an F-test on samples that took no part says whether it is there, and
a false-discovery rate is kept over the regions. Left out is its first step, the physics fitted anew on regions without
an error: what comes here is the residual of a baseline that is fitted to all records.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lstsq
from scipy.stats import chi2, f

from validation.trials.peers.exchange import Array, Averages, Equation

REGIONS = 4
"""Of a signal, each with as many samples as the others."""
FEWEST = 24
"""Samples of a region, of which a third fits, a third chooses and a third tests."""
FALSE_DISCOVERIES = 0.05
LONGEST_LAW = 2
"""Terms."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Region:
    """Where one signal lies between two values."""

    signal: int
    low: float
    high: float

    def holds(self, inputs: Array) -> Mask:
        return np.asarray(
            (inputs[:, self.signal] >= self.low) & (inputs[:, self.signal] < self.high)
        )


@dataclass(frozen=True)
class Law:
    """What is missing in one region: the numbers of some terms of the library."""

    region: Region
    terms: list[int]
    numbers: Array
    p_value: float


def regime_local(equation: Equation) -> list[Array]:
    """What the equation lacks in each validate record: zero but in the regions where a law was found and confirmed."""
    inputs = np.vstack([p.inputs for p in equation.identify])
    missing = np.concatenate([p.missing for p in equation.identify])
    noise = np.concatenate([_deviations(p) for p in equation.identify])
    centre, spread = inputs.mean(axis=0), np.maximum(inputs.std(axis=0), 1e-12)

    def library(of: Array) -> Array:
        x = (of - centre) / spread
        squares = [x[:, i] * x[:, k] for i in range(x.shape[1]) for k in range(i, x.shape[1])]
        return np.column_stack([np.ones(len(x)), x, *squares])

    columns, weighed = library(inputs) / noise[:, None], missing / noise
    regions, left, found = list(_regions(inputs)), np.ones(len(weighed), dtype=bool), []
    while (law := _surest(regions, inputs, left, columns, weighed)) is not None:
        found.append(law)
        left &= ~law.region.holds(inputs)
    return [_terms(found, p, library(p.inputs)) for p in equation.validate]


def _deviations(part: Averages) -> Array:
    return np.asarray(np.sqrt(np.sum(part.factor**2, axis=1)))


def _regions(inputs: Array) -> Iterator[Region]:
    for signal in range(inputs.shape[1]):
        edges = np.quantile(inputs[:, signal], np.linspace(0.0, 1.0, REGIONS + 1))
        edges[0], edges[-1] = -np.inf, np.inf
        for low, high in pairwise(edges):
            if low < high:
                yield Region(signal, float(low), float(high))


def _surest(
    regions: Sequence[Region], inputs: Array, left: Mask, columns: Array, weighed: Array
) -> Law | None:
    """Of the regions whose residual energy is more than noise makes, the law that the F-test confirms best."""
    large = [(r, m) for r in regions if np.sum(m := left & r.holds(inputs)) >= FEWEST]
    energy = [float(chi2.sf(np.sum(weighed[m] ** 2), np.sum(m))) for _, m in large]
    flagged = [one for one, there in zip(large, _discoveries(energy), strict=True) if there]
    laws = [law for r, m in flagged if (law := _law(r, m, columns, weighed)) is not None]
    kept = _discoveries([law.p_value for law in laws])
    confirmed = [law for law, there in zip(laws, kept, strict=True) if there]
    return min(confirmed, key=lambda law: law.p_value, default=None)


def _law(region: Region, inside: Mask, columns: Array, weighed: Array) -> Law | None:
    """Of every third sample the law of at most LONGEST_LAW terms, chosen on the next of each, tested on the last."""
    (a, at), (b, bt), (c, ct) = ((columns[k], weighed[k]) for k in _thirds(inside))
    chosen: list[int] = []
    least = float(np.sum(bt**2))
    for length in range(1, LONGEST_LAW + 1):
        for terms in map(list, combinations(range(columns.shape[1]), length)):
            left = float(np.sum((bt - b[:, terms] @ lstsq(a[:, terms], at)[0]) ** 2))
            if left < least:
                chosen, least = terms, left
    if not chosen:
        return None
    left, degrees = _left(c[:, chosen], ct), len(ct) - len(chosen)
    statistic = (float(np.sum(ct**2)) - left) / len(chosen) / max(left / degrees, 1e-300)
    numbers = lstsq(np.vstack([a, b])[:, chosen], np.concatenate([at, bt]))[0]
    return Law(region, chosen, np.asarray(numbers), float(f.sf(statistic, len(chosen), degrees)))


def _thirds(inside: Mask) -> list[NDArray[np.int64]]:
    return [np.flatnonzero(inside)[k::3] for k in range(3)]


def _left(a: Array, b: Array) -> float:
    return float(np.sum((b - a @ lstsq(a, b)[0]) ** 2))


def _discoveries(p_values: Sequence[float]) -> list[bool]:
    """Benjamini and Hochberg (1995)."""
    ordered = np.sort(p_values)
    allowed = FALSE_DISCOVERIES * np.arange(1, len(ordered) + 1) / max(len(ordered), 1)
    within = np.flatnonzero(ordered <= allowed)
    bound = ordered[within[-1]] if len(within) else -1.0
    return [p <= bound for p in p_values]


def _terms(laws: Sequence[Law], part: Averages, library: Array) -> Array:
    """Each sample after the first law whose region it is in."""
    term = np.zeros(len(part.missing))
    free = np.ones(len(term), dtype=bool)
    for law in laws:
        here = free & law.region.holds(part.inputs)
        term[here] = library[here][:, law.terms] @ law.numbers
        free &= ~here
    return term
