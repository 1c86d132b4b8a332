"""What of a residual repeats from stroke to stroke, what drifts, and what does neither.

Strokes over the same ground in the same direction are measurements of the same thing. What differs between them no
model of the state could explain: it is the noise floor. What they share, a better model could take, in space; what
follows a line from stroke to stroke, in time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array, Index


@dataclass(frozen=True)
class Repeatability:
    """A residual split by strokes over the same ground. Mean squares, in the residual's unit squared."""

    sample: float
    """What differs from sample to sample."""
    stroke: float
    """What does not repeat from stroke to stroke, sample noise included: no model of state explains it."""
    repeats: float
    """What repeats in every stroke at the same spot: a better model could take it."""
    repeats_p_value: float
    """Chance of so much repetition if strokes had random signs."""
    drift: float
    """What follows a straight line over the strokes of a record: warming up, wear, a sensor that wanders."""
    drift_p_value: float
    """Chance of so much drift if the strokes came in random order."""

    @property
    def systematic(self) -> float:
        """What a better model could take, in space or in time."""
        return self.repeats + self.drift


@dataclass(frozen=True)
class Ground:
    """Which samples of different strokes were taken at the same place: record, direction and spot of the stroke."""

    cell: Index
    """(n,): one stroke at one place."""
    place: Index
    """(cells,)"""
    stroke: Index
    """(cells,)"""

    @staticmethod
    def of(
        record: Index, stroke: Index, extension: Array, direction: Array, spots: int = 24
    ) -> Ground:
        edges = np.quantile(extension, np.linspace(0.0, 1.0, spots + 1))
        spot = np.clip(np.searchsorted(edges, extension, side="right") - 1, 0, spots - 1)
        place = (record * 2 + (direction > 0)) * spots + spot
        strokes = int(stroke.max()) + 1
        cell_id, cell = np.unique(place * strokes + stroke, return_inverse=True)
        return Ground(
            cell, np.unique(cell_id // strokes, return_inverse=True)[1], cell_id % strokes
        )

    def cell_mean(self, residual: Array) -> Array:
        return np.asarray(np.bincount(self.cell, residual) / np.bincount(self.cell))

    def place_mean(self, cell_mean: Array) -> Array:
        return np.asarray(np.bincount(self.place, cell_mean) / np.bincount(self.place))

    def without_repeats(self, residual: Array) -> Array:
        """The residual (n,) less what repeats at its place."""
        return np.asarray(
            residual - self.place_mean(self.cell_mean(residual))[self.place][self.cell]
        )


def repeatability(
    residual: Array,
    record: Index,
    stroke: Index,
    extension: Array,
    direction: Array,
    rng: np.random.Generator,
    draws: int = 999,
) -> Repeatability:
    """Split a residual (n,) into what repeats over the strokes at one place, what drifts, and what does neither."""
    ground = Ground.of(record, stroke, extension, direction)
    size = np.bincount(ground.cell).astype(float)
    strokes_there = np.bincount(ground.place).astype(float)
    mean = ground.cell_mean(residual)
    place_mean = ground.place_mean(mean)
    within = float(np.sum((residual - mean[ground.cell]) ** 2) / max(len(residual) - len(size), 1))
    spread = np.bincount(ground.place, (mean - place_mean[ground.place]) ** 2)
    between = spread / np.maximum(
        strokes_there - 1.0, 1.0
    )  # of a cell's mean, from stroke to stroke
    share = np.where(strokes_there > 1, np.bincount(ground.place, size), 0.0)
    share = share / max(share.sum(), 1e-300)
    irreproducible = float(np.sum(share * between)) + within * (1.0 - 1.0 / max(size.mean(), 1.0))
    repeats = float(np.sum(share * (place_mean**2 - between / strokes_there)))

    signs = rng.choice([-1.0, 1.0], size=(draws, int(stroke.max()) + 1))
    statistic = float(np.sum(share * place_mean**2))
    larger = sum(
        float(np.sum(share * ground.place_mean(mean * sign[ground.stroke]) ** 2)) >= statistic
        for sign in signs
    )
    return Repeatability(
        sample_noise(residual, stroke),
        irreproducible,
        max(repeats, 0.0),
        (1.0 + larger) / (1.0 + draws),
        *drift(residual, record, stroke, direction, rng, draws),
    )


def drift(
    residual: Array,
    record: Index,
    stroke: Index,
    direction: Array,
    rng: np.random.Generator,
    draws: int = 999,
) -> tuple[float, float]:
    """Mean square of the straight lines through the stroke means of each record and direction, and its chance."""
    strokes = int(stroke.max()) + 1
    size = np.bincount(stroke, minlength=strokes).astype(float)
    mean = np.bincount(stroke, residual, strokes) / size
    first = np.unique(stroke, return_index=True)[1]
    side = record[first] * 2 + (direction[first] > 0)
    groups = [np.flatnonzero(side == s) for s in np.unique(side)]
    groups = [g for g in groups if len(g) >= 4]
    if not groups:
        return 0.0, 1.0

    def line(order: Callable[[Index], Index]) -> tuple[float, float]:
        """Mean square along the lines, and what chance alone would put there."""
        along = chance = 0.0
        for g in groups:
            k = np.arange(len(g)) - 0.5 * (len(g) - 1)
            m = mean[order(g)] - mean[g].mean()
            fitted = float(k @ m) ** 2 / float(k @ k)
            weight = float(size[g].mean() / size.sum())
            along += weight * fitted
            chance += weight * (float(m @ m) - fitted) / (len(g) - 2)
        return along, chance

    along, chance = line(lambda g: g)
    larger = sum(line(rng.permutation)[0] >= along for _ in range(draws))
    return max(along - chance, 0.0), (1.0 + larger) / (1.0 + draws)


def sample_noise(residual: Array, stroke: Index) -> float:
    """Mean square of what differs from one sample to the next, by differences within strokes (robust)."""
    difference = np.diff(residual)[np.diff(stroke) == 0]
    if len(difference) == 0:
        return 0.0
    return float((np.median(np.abs(difference)) / 0.6745) ** 2 / 2.0)


def arrangement(
    residual: Array, record: Index, direction: Array, split: Repeatability
) -> dict[str, float]:
    """Where a residual (n,) sits, as shares of its mean square that add up to one.

    "record": a constant in each record, that is at each pressure level; "direction": of opposite sign in the two
    directions of a record; "extension": repeats along the stroke beyond these; "time": drifts over the strokes of a
    record; "does not repeat": the rest.
    """
    total = float(np.mean(residual**2))
    if total == 0.0:
        return {}
    side = record * 2 + (direction > 0)
    records = np.bincount(record, residual) / np.maximum(np.bincount(record), 1)
    sides = np.bincount(side, residual) / np.maximum(np.bincount(side), 1)
    level = float(np.mean(records[record] ** 2))
    both = float(np.mean(sides[side] ** 2))
    repeats = min(max(split.repeats, both), total)
    drifts = min(split.drift, total - repeats)
    shares = {
        "record": level,
        "direction": both - level,
        "extension": repeats - both,
        "time": drifts,
        "does not repeat": total - repeats - drifts,
    }
    return {name: max(share, 0.0) / total for name, share in shares.items()}
