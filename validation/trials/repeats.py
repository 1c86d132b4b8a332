"""Trials of an identification: one machine after another is drawn, by seeds that follow each other, and judged.

A trial says what one repeat is and what table all of them make.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from statistics import NormalDist
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

R = TypeVar("R")
LEVEL = NormalDist().inv_cdf(0.975)
"""Standard errors on either side of an estimate: its 95 percent interval."""


def parser_of(module: str) -> argparse.ArgumentParser:
    """What every trial is asked."""
    parser = argparse.ArgumentParser(prog=f"python -m {module}")
    parser.add_argument("--repeats", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the first repeat")
    return parser


def seeds_of(options: argparse.Namespace) -> range:
    """The seeds that were asked for."""
    return range(options.seed, options.seed + options.repeats)


def report(
    repeats: Iterable[R], options: argparse.Namespace, table: Callable[[Sequence[R]], list[str]]
) -> None:
    """Count the repeats as they come, then print their table."""
    done: list[R] = []
    for found in repeats:
        done.append(found)
        print(f"\r{len(done)} of {options.repeats}", end="", flush=True)
    print(f"\r{len(done)} repeats from seed {options.seed}\n")
    print("\n".join(table(done)))


def holds(told: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,): whether the interval holds the truth, of rows (n, 3) of truth, estimate and standard error."""
    return np.asarray(np.abs(told[:, 1] - told[:, 0]) <= LEVEL * told[:, 2])


def rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))
