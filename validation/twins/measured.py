"""What a virtual rig is asked for, and what it gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from validation.twins.air import Array
from validation.twins.clock import Clock
from validation.twins.declared import Declared
from validation.twins.truth import Truth


@dataclass(frozen=True)
class Measured:
    """One run without noise, at the samples."""

    commands: Mapping[str, Array]  # as put out
    setpoints: Mapping[str, Array]
    signals: Mapping[str, Array]  # as the sensors give them
    states: Array  # (n, states), where `window` may start


class VirtualRig(Protocol):
    """Bench, platform or tank."""

    @property
    def kind(self) -> str:
        """The rig file's."""

    @property
    def title(self) -> str:
        """The rig file's."""

    @property
    def declared(self) -> tuple[Declared, ...]:
        """What its owner knows."""

    @property
    def signals(self) -> tuple[str, ...]:
        """What is measured."""

    @property
    def commands(self) -> tuple[str, ...]:
        """What drives it."""

    @property
    def axes(self) -> int:
        """Valves, each with its cylinder."""

    @property
    def clock(self) -> Clock:
        """How a run is cut into commands and steps."""

    @property
    def sample_step(self) -> float:
        """s between two rows of a record."""

    @property
    def log_steps(self) -> tuple[float, ...]:
        """s, that the logger of a controlled rig may have."""

    @property
    def duration(self) -> float:
        """Of a run, s."""

    @property
    def window_states(self) -> tuple[int, ...]:
        """What is unknown at the start of a stretch of a record."""

    @property
    def state_steps(self) -> tuple[float, ...]:
        """Small changes of these."""

    def plan(self, excited_by: str, rng: np.random.Generator) -> Any:
        """A run."""

    def following(self, setpoint: Array, gains: Array) -> Any:
        """A run along a given set-point, one a period of the clock, by a controller with these numbers."""

    def measure(self, truth: Truth, plan: Any, reading_noise: Mapping[str, Array]) -> Measured:
        """One run without noise; what noise a position loop sees is given, one a period of the clock."""

    def window(
        self, truth: Truth, commands: Mapping[str, Array], start: Array, time: float
    ) -> Mapping[str, Array]:
        """The signals of a stretch from a given state under recorded commands."""


def every(step: float, of: float) -> int:
    """How many steps make one of `of` seconds."""
    return round(of / step)


def sample_times(duration: float, step: float) -> Array:
    """Times of all samples, s."""
    return np.asarray(step * np.arange(round(duration / step) + 1), dtype=np.float64)
