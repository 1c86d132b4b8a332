"""Which experiment would have told the causes of the source's symptom apart (symptom.py).

Every cause of the smaller travel, at the size that makes 81 mm of 87, is put through other inputs. What two of them
differ by in a reading, over what that reading can be told by, is how well the experiment tells them apart; an
experiment is as good as it is for the two causes that it tells worst.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from validation.published.symptom import (
    CAUSES,
    DURATION,
    LOOP_GAIN,
    Cause,
    command,
    healthy_bench,
    size_for,
)
from validation.twins import bench
from validation.twins.air import Array
from validation.twins.truth import Truth

INPUTS = ((0.54, 0.328), (0.15, 0.15), (0.54, 0.1), (1.2, 0.328), (0.54, 1.5), (1.2, 1.5))
"""V over the dead band's step, and Hz: the published sine, a small, a slow, a large, a fast, a large and fast one."""
SETTLED = 6.0
"""s after which is read."""
TOLD_BY = {"travel": 0.5e-3, "pressure difference": 2e3, "pressure sum": 2e3}
"""What one reading of a record can be trusted to, m and Pa: repeatability, not noise."""


@dataclass(frozen=True)
class Experiment:
    """One or two inputs, with what is read from them."""

    inputs: tuple[tuple[float, float], ...]
    signals: tuple[str, ...]
    values: dict[str, Array]
    """Cause -> its readings, each over what it can be trusted to."""

    @property
    def worst(self) -> tuple[str, str, float]:
        """The two causes that are nearest, and how far apart they are."""
        pairs = [
            (a, b, float(np.linalg.norm(self.values[a] - self.values[b])))
            for a, b in combinations(self.values, 2)
        ]
        return min(pairs, key=lambda pair: pair[2])


def readings(truth: Truth, amplitude: float, frequency: float) -> dict[str, float]:
    """Of a settled run: the travel, the swing of the two pressures' difference, and the mean of their sum."""
    feedforward = command(amplitude, frequency)
    plan = bench.Plan(feedforward, np.full(feedforward.size, 0.2), LOOP_GAIN, 0.15)
    state: Array = bench.simulate(truth.machine, plan).state[:: bench.FINE]
    periods = np.floor((DURATION - SETTLED) * frequency) / frequency
    settled = state[-round(periods / bench.SAMPLE_STEP) :]
    lower, upper = settled[:, 2], settled[:, 3]
    return {
        "travel": float(np.ptp(settled[:, 0])),
        "pressure difference": float(np.ptp(lower - upper)),
        "pressure sum": float(np.mean(lower + upper)),
    }


def experiments(causes: Sequence[Cause] = CAUSES) -> list[Experiment]:
    """The published sine with its travel alone, then every input and every pair of inputs with all readings, the best
    first. Causes that cannot make 81 mm are left out."""
    healthy = healthy_bench()
    shrunk = {}
    for cause in causes:
        size = None if cause.fixed is not None else size_for(cause, healthy)
        if size is not None:
            shrunk[cause.name] = healthy.having(**dict.fromkeys(cause.numbers, size))
    found = {
        (name, sine): readings(truth, *sine) for name, truth in shrunk.items() for sine in INPUTS
    }

    def experiment(inputs: tuple[tuple[float, float], ...], signals: tuple[str, ...]) -> Experiment:
        values = {
            name: np.array([found[name, sine][s] / TOLD_BY[s] for sine in inputs for s in signals])
            for name in shrunk
        }
        return Experiment(inputs, signals, values)

    every = tuple(TOLD_BY)
    menu = [experiment((sine,), every) for sine in INPUTS]
    menu += [experiment(pair, every) for pair in combinations(INPUTS, 2)]
    return [
        experiment(INPUTS[:1], ("travel",)),
        *sorted(menu, key=lambda e: -e.worst[2]),
    ]
