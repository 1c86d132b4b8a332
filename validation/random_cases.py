"""Random cases that can be repeated: one seed a run, printed by every test that draws from it."""

from __future__ import annotations

import os
import secrets

import numpy as np

SEED = int(os.environ.get("SMS_TEST_SEED") or secrets.randbits(32))
"""SMS_TEST_SEED of the environment repeats a run; without it each run draws afresh."""


def draw(name: str) -> np.random.Generator:
    """A generator for the test `name`, from this run's seed."""
    print(f"{name}: SMS_TEST_SEED={SEED}")
    return np.random.default_rng(SEED)
