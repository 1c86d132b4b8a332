"""One call of the compiled module, drawn by a seed and a number, with arguments that are right or were before."""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable
from contextlib import suppress
from types import ModuleType
from typing import Any

import numpy as np

from validation.fuzz.arguments import LARGE, Arguments, Values, called
from validation.fuzz.mutations import Random
from validation.fuzz.signatures import Function
from validation.fuzz.spoilt_arguments import OddError, spoil

RETURNED = "returned"
REFUSALS = (
    ValueError,
    TypeError,
    IndexError,
    KeyError,
    OverflowError,
    MemoryError,
    RuntimeError,
    OddError,
)
SAYS_NOTHING = (
    "map::at",
    "vector::",
    "basic_string",
    "std::exception",
    "Unable to cast Python instance",
    "invalid map<",
)


class NotMadeError(Exception):
    """The module refused what the case needs before its call: the object, or one of its arguments."""


class Case:
    """A call: a function, and all that is drawn for it."""

    def __init__(self, core: ModuleType, functions: list[Function], seed: int, number: int) -> None:
        self.function = functions[number % len(functions)]
        self.core, self.random = core, np.random.default_rng([seed, number])
        self.arguments = Arguments(core, functions, self.random)
        self.spoils = self.random.uniform() > 0.3
        if self.spoils:
            self.arguments.spoil = lambda of, values: spoil(of, values, self.random)

    def run(self, begin: Callable[[str], None]) -> str:
        """RETURNED, or what the call raises. begin: told what is called, before it is."""
        function, random = self.function, self.random
        large = "->" in function.doc and function.kind == "call" and random.uniform() < 0.01
        owner: Any = self.core
        try:
            if function.owner is not None and function.kind != "make":
                owner = self.arguments.instance(function.owner)
            values = self.arguments.of(function, LARGE if large else None)
        except REFUSALS as wrong:
            raise NotMadeError(f"{type(wrong).__name__}: {wrong}") from wrong
        if function.kind in ("read", "write"):
            begin(f"{function.label} of {type(owner).__name__}")
            _touch(owner) if function.kind == "read" else _write(owner, function, random)
            return RETURNED
        if self.spoils:
            spoil(function, values, random)
        thing = getattr(owner, function.owner or "" if function.kind == "make" else function.name)
        begin(_described(function, values))
        how = random.uniform()
        beside: list[threading.Thread] = []
        if how < 0.04:  # as two threads of a program may
            beside.append(threading.Thread(target=_quietly, args=(thing, function, values)))
        elif how < 0.08:
            beside.append(threading.Thread(target=_overwrite, args=(values,)))
        for thread in beside:
            thread.start()
        try:
            result = called(thing, function, values)
            if how > 0.9:
                result = called(thing, function, values)
        finally:
            for thread in beside:
                thread.join()
        del owner, thing, values, self.arguments  # a result must not need what it came from
        gc.collect(0)
        _touch(result)
        return RETURNED


def _quietly(thing: Any, function: Function, values: Values) -> None:
    with suppress(Exception):
        _touch(called(thing, function, values))


def _overwrite(values: Values) -> None:
    """Arrays that change while they are in use."""
    arrays = [
        v
        for v in values.values()
        if isinstance(v, np.ndarray) and v.flags.writeable and v.dtype == float
    ]
    for number in (np.nan, 1e308, 0.0) * 5:
        for array in arrays:
            array[...] = number


def _touch(value: Any, depth: int = 0) -> None:
    """Reads all of it."""
    if isinstance(value, np.ndarray):
        with np.errstate(all="ignore"):
            value.sum()
    elif isinstance(value, list | tuple):
        for one in value[:20]:
            _touch(one, depth + 1)
    elif type(value).__module__ == "sms._core" and depth < 4:
        repr(value)
        for name, member in ((n, m) for c in type(value).__mro__ for n, m in vars(c).items()):
            if isinstance(member, property):
                _touch(getattr(value, name), depth + 1)


def _write(owner: Any, function: Function, random: Random) -> None:
    """A few of its attributes."""
    for name in random.choice(function.attributes, 3):
        values: Values = {"value": getattr(owner, str(name))}
        if random.integers(3):
            spoil(function, values, random)
        setattr(owner, str(name), values.get("value"))


def _described(function: Function, values: Values) -> str:
    """The call in words: arrays by shape, type and first numbers."""

    def short(value: Any) -> str:
        if isinstance(value, np.ndarray):
            first = (
                ", ".join(str(v)[:9] for v in value.ravel()[:3])
                if 0 < value.size < 10**6
                else "..."
            )
            return f"array{value.shape}:{value.dtype.str}[{first}]"
        if isinstance(value, list | tuple) and type(value) in (list, tuple):
            return "[" + ", ".join(map(short, value[:4])) + (", ...]" if len(value) > 4 else "]")
        try:
            return ascii(value)[:90]
        except Exception:
            return type(value).__name__

    return f"{function.label}({', '.join(f'{n}={short(v)}' for n, v in values.items())})"[:1500]


def judge(wrong: BaseException) -> tuple[str, bool]:
    """The name of what was raised, and whether that is a failure: of another kind, or without a text that says much."""
    name, text = type(wrong).__name__, str(wrong)
    if isinstance(wrong, NotMadeError):
        return "not made", False
    if not isinstance(wrong, REFUSALS) or isinstance(wrong, RecursionError):
        return name, True
    empty = len(text.split()) < 2 and not isinstance(wrong, MemoryError)
    return name, empty or any(nothing in text for nothing in SAYS_NOTHING)
