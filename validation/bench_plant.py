"""The platform on its pneumatics in closed loop, timed beside an independent simulation by numba.

Roll of 0.1 rad at 0.3 Hz, the published controller (P = 2 with dead-band compensation, 1 kHz), the
default tolerance. The peer's steps are as large as they may be for the core's accuracy, both
measured against the core at a tolerance of 1e-9.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import sms
from sms.rows import Array
from sms.simulation import PLATFORM_TOLERANCE, extensions_of, simulate_platform

from validation.simulators.numba_platform import NumbaPlatform
from validation.timing import Goal, Row, fastest, row

PERIODS = 1000  # of 1 ms
VARIANTS = 1000
NEAR = 1e-3  # m, of peer and core at most: beyond it they are not one plant
COUNTED = ("derivative of the platform", "closed-loop platform")  # by callgrind


def rolling() -> Array:
    """Setpoints of the extensions, m, (PERIODS, 3)."""
    angle = 0.1 * np.sin(2.0 * np.pi * 0.3 * 1e-3 * np.arange(PERIODS))
    return extensions_of(angle, 0.0 * angle, 0.5)


def core_path(setpoint: Array, tolerance: float) -> Array:
    """Extensions that the core finds, m, (n, 3)."""
    return simulate_platform(setpoint, tolerance=tolerance).legs("extension")


def plant_rows(compiled: Mapping[str, float]) -> Iterator[Row]:
    """The closed loop beside numba, one evaluation, many variants; `compiled` in ns."""
    milliseconds = compiled["closed-loop platform"] * PERIODS * 1e-6
    goal = Goal(at_most=5.0, ratio_at_least=5.0)
    yield row("closed-loop platform, 1 s at 1 kHz", milliseconds, "ms", numba_peer(), goal)
    evaluation = compiled["derivative of the platform"]
    yield row("derivative of the platform", evaluation, "ns")
    yield variants_row()


def numba_peer() -> tuple[str, float]:
    """Name and ms of the peer for the same second, as accurate as the core at its default tolerance."""
    setpoint = rolling()
    exact = core_path(setpoint, 1e-9)
    wanted = float(np.abs(core_path(setpoint, PLATFORM_TOLERANCE) - exact).max())
    run = simulate_platform(setpoint[:1])
    peer = NumbaPlatform(run.rows[0, :36].copy())
    for steps in (1, 2, 4, 8, 16, 32):
        error = float(np.abs(peer.run(setpoint, steps) - exact).max())
        if not error < NEAR:
            raise AssertionError(f"core and numba peer differ by {error:.1e} m")
        if error <= wanted or steps == 32:
            seconds = fastest(lambda n=steps: peer.run(setpoint, n), rounds=8)  # type: ignore[misc]
            name = f"numba, RK4, {steps} steps a period, {error:.0e} m (core {wanted:.0e} m)"
            return name, seconds * 1e3
    raise AssertionError("unreachable")


def variants_row() -> Row:
    """1,000 platforms with other payloads for a second: one thread of Python, then two."""
    setpoint = rolling()
    variants = []
    for mass in np.linspace(0.0, 100.0, VARIANTS):
        p = sms.Params()
        p.payload_mass = float(mass)
        variants.append(p)

    def one(p: sms.Params) -> float:
        return float(simulate_platform(setpoint, params=p)["roll"][-1])

    def all_of_them(threads: int) -> float:
        with ThreadPoolExecutor(threads) as pool:
            return fastest(lambda: list(pool.map(one, variants)), rounds=2)

    alone, together = all_of_them(1), all_of_them(2)
    name = f"{VARIANTS} variants of 1 s, two threads"
    return row(name, together, "s", ("one thread", alone), Goal(ratio_at_least=1.9))
