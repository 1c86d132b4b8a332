"""Arrays of poses as the core wants them, one a row, and the error that names the row at fault."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sms import _core
from sms._core import NotANumberError, Params
from sms.arrays import Array

Number = TypeVar("Number", np.float64, np.int32)


@dataclass(frozen=True)
class Rows:
    """Inputs broadcast against each other and flattened: `shape` poses, one a row."""

    parts: tuple[Array, ...]  #: one an input, (n,) of numbers or (n, width) of vectors
    shape: tuple[int, ...]  #: of what was given, without the axis of a vector
    columns: tuple[tuple[str, str], ...]  #: name and unit, over all parts
    place: int  #: so many columns, the first, say where the mechanism is

    def shaped(self, values: NDArray[Number], *axes: int) -> NDArray[Number]:
        """The core's rows in the shape of the inputs, each row an array of shape `axes`."""
        return without_axes(values.reshape(self.shape + axes))

    def column(self, values: Array, index: int) -> Array:
        """One column of the core's rows in the shape of the inputs."""
        return without_axes(values[:, index].reshape(self.shape))

    @property
    def table(self) -> Array:
        """All parts side by side, (n, columns)."""
        return np.column_stack(self.parts)

    def check(
        self, status: NDArray[np.int32], allowed: Callable[[Params], str], params: Params
    ) -> None:
        """Raise the exception of the first status that is not ok; its sentence ends in `allowed`.

        Raises: NotANumberError, OutOfRangeError, OutOfWorkspaceError, NotConvergedError.
        """
        if not status.any():
            return
        row = int(np.flatnonzero(status)[0])
        numbers = self._row(row)
        self._check_finite_row(row, numbers)
        code = int(status[row])
        values = ", ".join(
            quantity(name, unit, value)
            for (name, unit), value in zip(self.columns[: self.place], numbers, strict=False)
        )
        _core.raise_status(
            code, f"{self._where(row)}{values}: {_core.status_string(code)}; {allowed(params)}"
        )

    def check_finite(self) -> None:
        """Raise NotANumberError for the first row that has a NaN or an infinity in it."""
        bad = np.flatnonzero(~np.isfinite(self.table).all(axis=1))
        if bad.size:
            self._check_finite_row(int(bad[0]), self._row(int(bad[0])))

    def _check_finite_row(self, row: int, numbers: Array) -> None:
        bad = np.flatnonzero(~np.isfinite(numbers))
        if bad.size:
            name, unit = self.columns[bad[0]]
            number = quantity(name, unit, float(numbers[bad[0]]))
            raise NotANumberError(f"{self._where(row)}{number}: it must be a finite number")

    def _row(self, row: int) -> Array:
        return np.concatenate([np.atleast_1d(part[row]) for part in self.parts])

    def _where(self, row: int) -> str:
        if not self.shape:
            return ""
        index = np.unravel_index(row, self.shape)
        return f"row {int(index[0]) if len(index) == 1 else tuple(int(i) for i in index)}: "


def without_axes(values: NDArray[Number]) -> NDArray[Number]:
    """The array, or a numpy number where it has no axes: that prints and formats as a number."""
    return values if values.ndim else values[()]


def quantity(name: str, unit: str, value: float) -> str:
    """A number for an error's text: "roll = 0.7 rad (40.1°)"."""
    degrees = f" ({math.degrees(value):.4g}°)" if unit == "rad" and math.isfinite(value) else ""
    return f"{name} = {value:.6g} {unit}{degrees}"


def scalars(**inputs: tuple[str, ArrayLike]) -> Rows:
    """Name, unit and values of each input; shapes broadcast."""
    arrays = [_numbers(name, values) for name, (_, values) in inputs.items()]
    shape = _common_shape(list(inputs), [array.shape for array in arrays])
    parts = tuple(np.broadcast_to(array, shape).reshape(-1) for array in arrays)
    columns = tuple((name, unit) for name, (unit, _) in inputs.items())
    return Rows(parts, shape, columns, place=len(columns))


def vectors(**inputs: tuple[Sequence[tuple[str, str]], ArrayLike]) -> Rows:
    """Name, columns (name and unit of each) and values of each input.

    The last axis of the values goes over the columns; the others broadcast.
    """
    arrays = []
    for name, (columns, values) in inputs.items():
        array = _numbers(name, values)
        if array.ndim == 0 or array.shape[-1] != len(columns):
            raise ValueError(
                f"{name} has shape {array.shape}; its last axis must hold these {len(columns)}: "
                f"{', '.join(column for column, _ in columns)}"
            )
        arrays.append(array)
    shape = _common_shape(list(inputs), [array.shape[:-1] for array in arrays])
    widths = [array.shape[-1] for array in arrays]
    parts = tuple(
        np.broadcast_to(array, (*shape, width)).reshape(-1, width)
        for array, width in zip(arrays, widths, strict=True)
    )
    columns = tuple(column for columns, _ in inputs.values() for column in columns)
    return Rows(parts, shape, columns, place=widths[0])


def _numbers(name: str, values: ArrayLike) -> Array:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} is not an array of numbers: {values!r}") from None


def _common_shape(names: list[str], shapes: list[tuple[int, ...]]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in zip(names, shapes, strict=True))
        raise ValueError(f"these shapes do not broadcast: {listed}") from None
