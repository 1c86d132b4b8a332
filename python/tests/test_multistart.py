"""A cause that is far from where the model stands: found by a fit where its linear step speaks of chance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sms.diagnosis.effects.catalogue import catalogue
from sms.diagnosis.selection.multistart import chance, may_be_elsewhere, much_is_left

from validation.random_cases import draw


@dataclass
class _Fit:
    residual: NDArray[np.float64]


@dataclass
class _Fitted:
    """What is asked of a fit here: its residual."""

    fit: _Fit


@dataclass
class _Windows:
    """Twenty windows of one channel whose noise is one."""

    block = np.repeat(np.arange(20), 50)
    channel = np.zeros(1000, dtype=np.int64)

    def floor(self, residual: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.ones(1)


def fitted(residual: NDArray[np.float64]) -> Any:
    return _Fitted(_Fit(residual))


def test_chance_is_small_where_nearly_every_window_has_less_however_unlike_they_are() -> None:
    random, runs = draw("afar"), _Windows()
    after = random.normal(size=1000)
    size = 10.0 ** random.uniform(0.0, 3.0, size=20)[runs.block]
    before = after * np.sqrt(1.0 + size)
    assert chance(fitted(before), fitted(after), runs, 40) < 1e-3  # type: ignore[arg-type]
    assert chance(fitted(before), fitted(before), runs, 40) == 1.0  # type: ignore[arg-type]
    assert chance(fitted(after), fitted(before), runs, 40) == 1.0  # type: ignore[arg-type]


def test_chance_names_nothing_from_windows_that_differ_by_noise() -> None:
    random, runs = draw("afar noise"), _Windows()
    alarms = sum(
        chance(fitted(random.normal(size=1000)), fitted(random.normal(size=1000)), runs, 1) < 0.01  # type: ignore[arg-type]
        for _ in range(100)
    )
    assert alarms <= 8  # one is expected; nine or more come once in a million runs


def test_the_way_is_long_where_a_large_error_is_left_by_all_that_was_fitted() -> None:
    runs: Any = _Windows()
    large, half, small = (fitted(np.full(1000, np.sqrt(1.0 + e))) for e in (4.0, 1.5, 0.4))
    assert much_is_left(large, [], runs)
    assert much_is_left(large, [fitted(np.full(1000, 2.0))], runs)
    assert not much_is_left(large, [fitted(np.full(1000, 2.0)), half], runs)
    assert not much_is_left(small, [], runs)


def test_what_promises_most_may_be_elsewhere_and_so_may_heat() -> None:
    effects = catalogue("bench")
    promise = np.zeros(len(effects))
    promise[[3, 7, 9]] = [1.0, 3.0, 2.0]
    found = may_be_elsewhere(effects, promise)
    assert found[:3] == [7, 9, 3]
    assert {effects[k].id for k in found[3:]} == {"heat_transfer"}
