"""Inputs that act later than they are recorded: a dead time, as a parameter like any other.

A delayed input lies between the samples of its record, so it is interpolated there: linearly, which makes its
derivative by the dead time that of the record itself; and a held one by its mean over each step of the integration,
which changes evenly as a jump passes through that step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms.arrays import Array, Index


@dataclass(frozen=True, eq=False)
class Delayed:
    """One input of n simulations."""

    number: int
    """Of the input, in the model's order."""
    parameter: str
    """Its dead time, s."""
    held: bool
    values: Array
    """(samples, records): as recorded, a shorter record with its last value to the end."""
    record: Index
    """(n,)"""
    first: Array
    """(n,): sample of the record at which each simulation begins."""

    @classmethod
    def of(
        cls,
        number: int,
        parameter: str,
        held: bool,
        recorded: list[Array],
        record: Index,
        first: Index,
    ) -> Delayed:
        """From one array (samples,) a record."""
        longest = max(len(r) for r in recorded)
        values = np.stack(
            [np.append(r, np.full(longest - len(r), r[-1])) for r in recorded], axis=1
        )
        return cls(number, parameter, held, values, record, np.asarray(first, dtype=np.float64))

    def copies(self, count: int) -> Delayed:
        """The same simulations, `count` times over."""
        record, first = np.tile(self.record, count), np.tile(self.first, count)
        return Delayed(self.number, self.parameter, self.held, self.values, record, first)

    def at(self, place: Array) -> Array:
        """(n,): what acts; place (n,): samples since each simulation began, less the dead time."""
        place = place + self.first
        k = np.clip(np.floor(place), 0, len(self.values) - 1).astype(np.int64)
        here = self.values[k, self.record]
        if self.held:
            return np.asarray(here)
        beyond = self.values[np.minimum(k + 1, len(self.values) - 1), self.record]
        return np.asarray(here + np.clip(place - k, 0.0, 1.0) * (beyond - here))

    def mean(self, place: Array, width: float) -> Array:
        """(n,): of a held input over `width` samples that begin there."""
        area = self._area(place + width) - self._area(place)
        return np.asarray(area / width)

    def _area(self, place: Array) -> Array:
        place = place + self.first
        k = np.clip(np.floor(place), 0, len(self.values) - 1).astype(np.int64)
        return np.asarray(self._sums[k, self.record] + (place - k) * self.values[k, self.record])

    @property
    def _sums(self) -> Array:
        """(samples, records): of the values before each."""
        if "_of_values" not in self.__dict__:
            zero = np.zeros((1, self.values.shape[1]))
            sums = np.concatenate([zero, np.cumsum(self.values, axis=0)[:-1]])
            object.__setattr__(self, "_of_values", sums)
        return np.asarray(self.__dict__["_of_values"])
