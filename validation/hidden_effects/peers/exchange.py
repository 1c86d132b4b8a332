"""What goes to the peers' environment and what comes back: one .npz a trial, one JSON for all answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """One role's samples of a trial, records and channels in a row."""

    residual: Array
    """(n,) of the fitted baseline, predicted less measured, over the noise's standard deviation."""
    inputs: Array
    """(n, k): what the residual may depend on."""
    series: NDArray[np.int64]
    """(n,) samples with the same number follow each other in time, evenly."""
    channel: NDArray[np.int64]
    """(n,) which reading."""


@dataclass(frozen=True)
class Question:
    """A trial as the peers see it: no truth, no catalogue."""

    names: tuple[str, ...]
    """Of the inputs: "extension", "velocity", "direction", ..."""
    identify: Part
    validate: Part

    def save(self, path: Path) -> None:
        arrays = {
            f"{role}_{name}": value
            for role, part in (("identify", self.identify), ("validate", self.validate))
            for name, value in vars(part).items()
        }
        np.savez(path, names=np.array(self.names), **arrays)


def load(path: Path) -> Question:
    with np.load(path) as found:
        parts = [
            Part(*(found[f"{role}_{n}"] for n in ("residual", "inputs", "series", "channel")))
            for role in ("identify", "validate")
        ]
        return Question(tuple(map(str, found["names"])), parts[0], parts[1])


@dataclass(frozen=True)
class Answer:
    """What a method says of one trial."""

    terms: Sequence[str]
    """Names of what it holds for present; empty if it names nothing."""
    alarm: bool
    """Whether it says that the model is wrong."""
    gain: float | None = None
    """1 - RMS error with its correction / without, on the validate records; None if it corrects nothing."""
