"""The peer that looks for errors region by region: it finds what is planted, where it is planted, and else nothing."""

from __future__ import annotations

import numpy as np
from scipy.stats import binom

from validation.random_cases import draw
from validation.trials.peers.exchange import Array, Averages, Equation
from validation.trials.peers.regime_local import regime_local

SAMPLES = 400
NOISE = 0.3


def equation(rng: np.random.Generator, missing: float) -> Equation:
    """Two signals; where the first is above 1, `missing` times the second is lacking."""

    def part() -> Averages:
        inputs: Array = rng.uniform(-2.0, 2.0, (SAMPLES, 2))
        lacks = np.where(inputs[:, 0] >= 1.0, missing * inputs[:, 1], 0.0)
        return Averages(inputs, lacks + rng.normal(0.0, NOISE, SAMPLES), NOISE * np.eye(SAMPLES))

    return Equation("force", (part(), part()), (part(),))


DRAWS = 20
NEAR, NONE_FAR = 0.94, 0.80
"""Shares of 2,000 draws in which the law is found to within the noise, and in which nothing is found far from it: the
regions' edges are quartiles of samples, and false discoveries are allowed."""


def test_a_law_that_is_missing_in_one_region_is_found_there() -> None:
    """As often as it is found of 2,000 draws; by chance less in one run of a million."""
    rng = draw("a law in one region")
    near = none_far = 0
    for _ in range(DRAWS):
        asked = equation(rng, missing=1.5)
        (found,) = regime_local(asked)
        inputs = asked.validate[0].inputs
        inside, far = inputs[:, 0] > 1.1, inputs[:, 0] < 0.9
        near += np.sqrt(np.mean((found[inside] - 1.5 * inputs[inside, 1]) ** 2)) < NOISE
        none_far += np.mean(found[far] == 0.0) > 0.9
    assert near >= binom.ppf(1e-6, DRAWS, NEAR)
    assert none_far >= binom.ppf(1e-6, DRAWS, NONE_FAR)


def test_noise_alone_has_no_law() -> None:
    rng = draw("noise alone")
    called = sum(
        any(np.any(t) for t in regime_local(equation(rng, missing=0.0))) for _ in range(20)
    )
    assert called <= 4
