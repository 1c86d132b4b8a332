"""What goes to the peers' environment: one .npz a trial. Answers come back as JSON."""

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
    """(n,) of the fitted baseline, measured less predicted, over the noise's standard deviation."""
    inputs: Array
    """(n, k): what the residual may depend on."""
    series: NDArray[np.int64]
    """(n,) samples with the same number follow each other in time, evenly."""
    channel: NDArray[np.int64]
    """(n,) which reading."""


@dataclass(frozen=True)
class Averages:
    """What one equation lacks in one record, averaged over a tenth of a second each."""

    inputs: Array
    """(m, k): the signals that it may depend on."""
    missing: Array
    """(m,) in the equation's unit."""
    factor: Array
    """(m, m): lower factor of the noise's covariance."""


@dataclass(frozen=True)
class Equation:
    """One equation fed with measured signals."""

    name: str
    identify: tuple[Averages, ...]
    """Of each record."""
    validate: tuple[Averages, ...]


@dataclass(frozen=True)
class Question:
    """A trial as the peers see it: no truth, no catalogue."""

    names: tuple[str, ...]
    """Of the inputs: "extension", "velocity", "direction", ..."""
    identify: Part
    validate: Part
    equations: tuple[Equation, ...] = ()
    """Of a plant that is simulated; none where the residual is that of an equation itself."""

    def save(self, path: Path) -> None:
        arrays = {
            f"{role}_{name}": value
            for role, part in (("identify", self.identify), ("validate", self.validate))
            for name, value in vars(part).items()
        }
        for number, equation in enumerate(self.equations):
            for role in ("identify", "validate"):
                for record, averages in enumerate(getattr(equation, role)):
                    arrays |= {
                        f"{number}_{role}_{record}_{name}": value
                        for name, value in vars(averages).items()
                    }
        equations = np.array([e.name for e in self.equations], dtype=np.str_)
        np.savez(path, names=np.array(self.names), equations=equations, **arrays)


def load(path: Path) -> Question:
    with np.load(path) as found:
        parts = [
            Part(*(found[f"{role}_{n}"] for n in ("residual", "inputs", "series", "channel")))
            for role in ("identify", "validate")
        ]

        def averages(number: int, role: str) -> tuple[Averages, ...]:
            records = [k for k in found.files if k.startswith(f"{number}_{role}_")]
            return tuple(
                Averages(
                    *(
                        found[f"{number}_{role}_{record}_{n}"]
                        for n in ("inputs", "missing", "factor")
                    )
                )
                for record in range(len(records) // 3)
            )

        equations = tuple(
            Equation(str(name), averages(k, "identify"), averages(k, "validate"))
            for k, name in enumerate(found["equations"])
        )
        return Question(tuple(map(str, found["names"])), parts[0], parts[1], equations)


@dataclass(frozen=True)
class Answer:
    """What a method says of one trial."""

    terms: Sequence[str]
    """Names of what it holds for present; empty if it names nothing."""
    alarm: bool
    """Whether it says that the model is wrong."""
    gain: float | None = None
    """1 - RMS error with its correction / without, on the validate records; None if it corrects nothing."""


@dataclass(frozen=True)
class PlantAnswer:
    """The same of a plant that is simulated."""

    alarm: bool
    strength: float
    """What the alarm goes by: the larger, the louder."""
    equation: str
    """Where it sees the error; empty for nowhere."""
    seconds: float
    """Of processor time."""
    terms: dict[str, list[list[float]]]
    """Equation -> its missing term (m,) in each validate record; empty for no correction."""
    after: list[float] | None = None
    """(channels,): mean square left on the validate records, for a correction of the readings themselves."""
