"""What is done to arguments that are right: other numbers, shapes, orders, types and names, and objects that lie."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from validation.fuzz.arguments import ADDRESSES, Values
from validation.fuzz.mutations import Random, pick
from validation.fuzz.signatures import Function

ODD_NUMBERS = (
    np.nan, np.inf, -np.inf, 1e308, -1e308, 5e-324, 1e-300, -1e-9, 0.0, -0.0, -1.0, 1e-9, 1e9, 1e18, 3e38, 1e39,
    2.0**31,
)  # fmt: skip
ODD_COUNTS = (-1, 0, 1, 2, 7, 255, 256, 65536, 10**6, 2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**63 - 1, 2**63, 2**64,
              10**30, -(2**31), -(2**31) - 1, -(2**63), -(2**63) - 1)  # fmt: skip
ODD_WORDS = ("", "?", "iso", "lugre", "pid", "energy", "stroke", "coulomb_force:2", "coulomb_force:9", ":", "a\x00b",
             "\x00", "ünïcødé", "\udcff", "x" * 5000, "extension\x00", "Extension", "%s%n")  # fmt: skip
ODD_THINGS: tuple[Any, ...] = (None, "text", b"bytes", 1.5, -1, 1j, [], {}, (), ..., print, float)
ODD_TYPES = ("f4", "f2", "i8", "u1", "?", "O", "c16", ">f8", "U5", "S3", "M8[s]", "g", "V8")


class OddError(Exception):
    """Of an argument, not of the module: it has to come through as it is."""


class Raises:
    """Whatever is asked of it, it raises."""

    def _raise(self, *_: object) -> Any:
        raise OddError("this argument answers nothing it is asked")

    __float__ = __index__ = __bool__ = __str__ = _raise
    __len__ = __getitem__ = __iter__ = __array__ = _raise


class SaysMore(list[Any]):
    """A sequence with fewer members than it says."""

    def __len__(self) -> int:
        return super().__len__() + 3


class Shrinks(list[Any]):
    """A sequence that loses a member whenever one is read."""

    def __getitem__(self, place: Any) -> Any:
        value = super().__getitem__(place)
        self.pop()
        return value

    def __iter__(self) -> Iterator[Any]:
        while self:
            yield self.pop()


def spoil(function: Function, values: Values, random: Random) -> None:
    """One or two of the values, or one too few or too many."""
    if random.uniform() < 0.02 and values:
        del values[pick(tuple(values), random)]
        return
    if random.uniform() < 0.02:
        values["no_such_argument"] = 1.0
        return
    for _ in range(1 + int(random.uniform() < 0.25)):
        names = [name for name in values if name not in ADDRESSES]
        if names:
            name = pick(names, random)
            values[name] = spoilt(values[name], random, values)


def spoilt(value: Any, random: Random, others: Values) -> Any:
    """Another value in the place of one that is right."""
    if random.uniform() < 0.12:
        return pick((*ODD_THINGS, object(), Raises(), np.zeros(3)), random)
    match value:
        case np.ndarray():
            return _array(value, random, others)
        case bool():
            return pick((0, 1, 2, None, "yes", np.True_, np.nan), random)
        case int():
            return pick((*ODD_COUNTS, np.int64(-1), np.uint64(2**64 - 1), 1.0, 1.5, np.nan), random)
        case float():
            return pick((*ODD_NUMBERS, "1", 10**400, np.float32(1.0), np.array([1.0])), random)
        case str():
            return pick((*ODD_WORDS, value + " ", value.upper(), value.encode()), random)
        case bytes():
            return pick((b"", value[:-1], value + b"\x00", 64 * b"x", b"\xff" * 8, "text"), random)
        case list() | tuple():
            return _sequence(list(value), random, others)
        case dict():
            return _mapping(dict(value), random)
    cls: Any = type(value)
    with suppress(Exception):
        if random.integers(3) == 0:
            value.__init__()  # once more, which leaves it as it was, or new
            return value
        return pick((cls.__new__, lambda same: same), random)(cls)
    return None


def _sequence(value: list[Any], random: Random, others: Values) -> Any:
    how = int(random.integers(8))
    if how < 3 and value:
        k = int(random.integers(len(value)))
        value[k] = spoilt(value[k], random, others)
        return value
    same = value[:1]
    return pick((value[:-1], value + same, [], 200 * same, SaysMore(value), Shrinks(value), tuple(value), iter(value),
                 np.array(value, dtype=object)), random)  # fmt: skip


def _mapping(value: dict[Any, Any], random: Random) -> Any:
    key = pick(tuple(value) or ("x",), random)
    how = int(random.integers(5))
    if how == 0:
        value.pop(key, None)
    elif how == 1:
        value[pick((*ODD_WORDS, 3, None, b"x"), random)] = 1.0
    elif how == 2:
        return pick(({}, [], list(value.items()), None), random)
    else:
        value[key] = pick((*ODD_NUMBERS, None, "x", Raises(), 10**400), random)
    return value


def _array(value: NDArray[Any], random: Random, others: Values) -> Any:
    if value.size > 10**6:  # is spoilt already
        return value
    how = int(random.integers(6))
    if how < 2 and value.size:
        value = value.copy()
        flat = value.reshape(-1)
        flat[int(random.integers(flat.size)) if how == 0 else slice(None)] = pick(
            ODD_NUMBERS, random
        )
        return value
    if how == 2:
        return _typed(value, random)
    if how == 3:
        return _laid_out(value, random)
    arrays = [v for v in others.values() if isinstance(v, np.ndarray)]
    rows = np.atleast_1d(value)
    return pick((
        value[None], value[..., None], rows.reshape(-1), rows[:-1], np.concatenate([rows, rows[-1:]]), value.T,
        rows[..., :0], rows[:0], np.zeros(0), np.zeros((0, 0)), np.zeros((3, 0)), rows[..., :-1],
        np.zeros((1,) * (40 if np.__version__ >= "2" else 32)), value.tolist(), np.float64(0.3), [value, value],
        np.broadcast_to(0.0, (2**40,)), np.broadcast_to(0.2, (2**37, *value.shape[1:])), pick(arrays or [None], random),
        memoryview(value.tobytes()), np.ma.masked_array(value, True),
    ), random)  # fmt: skip


def _typed(value: NDArray[Any], random: Random) -> Any:
    name = pick(ODD_TYPES, random)
    with suppress(TypeError, ValueError), np.errstate(all="ignore"):
        return value.astype(name)
    return np.zeros(value.shape, name)


def _laid_out(value: NDArray[Any], random: Random) -> NDArray[Any]:
    """The same numbers, elsewhere in memory."""
    if value.ndim == 0:
        return value
    wide = np.repeat(value, 2, axis=0)
    unaligned = np.frombuffer(b"\x00" + value.tobytes(), "u1")[1:].view("f8").reshape(value.shape)
    read_only = value.copy()
    read_only.flags.writeable = False
    return pick((value[::-1], value[..., ::-1], np.asfortranarray(value), wide[::2], unaligned, read_only,
                 np.broadcast_to(value[:1], value.shape)), random)  # fmt: skip
