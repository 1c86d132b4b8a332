"""Equations from a shared library, for plants that are written in C++ or C.

    extern "C" void derivative(int n, const double* parameters, const double* state, const double* input, double* out);

One call computes n plants side by side. Every array is stored quantity by quantity: element k * n + i is number k of
plant i. The library says nothing of how many states there are; the model does.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from sms.arrays import Array
from sms.diagnosis.own.model import Equation, Values
from sms.errors import InputError

_NUMBERS = ctypes.POINTER(ctypes.c_double)


def from_library(
    path: str | os.PathLike[str], function: str, parameters: Sequence[str], rows: int
) -> Equation:
    """A function of a shared library as a model's derivative or output.

    parameters: names, in the order in which the function reads them. rows: states, or outputs, that it writes.
    InputError for a library that cannot be loaded or lacks the function.
    """
    path = Path(path).resolve()
    try:
        found = getattr(ctypes.CDLL(str(path)), function)
    except OSError as error:
        raise InputError(f"{path}: this is no library that can be loaded: {error}") from None
    except AttributeError:
        raise InputError(
            f"{path}: there is no function '{function}' in it; declare it extern \"C\""
        ) from None
    found.argtypes = [ctypes.c_int, *4 * [_NUMBERS]]
    found.restype = None

    def equation(p: Values, x: Array, u: Array) -> Array:
        n = x.shape[1]
        numbers = np.empty((len(parameters), n))
        for k, name in enumerate(parameters):
            numbers[k] = p[name]
        out = np.empty((rows, n))
        arrays = (numbers, np.ascontiguousarray(x), np.ascontiguousarray(u), out)
        found(n, *(a.ctypes.data_as(_NUMBERS) for a in arrays))
        return out

    return equation
