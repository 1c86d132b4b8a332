"""The platform on its pneumatics in closed loop, beside simulations by numba and by CasADi.

Roll of 0.1 rad at 0.3 Hz, the published controller (P = 2 with dead-band compensation, 1 kHz), the
default tolerance. The peers have the same equations written a second and a third time. Their steps
are as large as they may be for the core's accuracy, all measured against the core at a tolerance
of 1e-9.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np
import sms
from sms.arrays import Array
from sms.simulation import PLATFORM_TOLERANCE, extensions_of, simulate_platform

from validation.reference.plants.actuator import P_LOWER, P_UPPER, SPOOL, SPOOL_RATE
from validation.reference.plants.flow import valve_map
from validation.reference.plants.numbers import numbers_of
from validation.reference.plants.platform import SCALE, mechanism_from
from validation.speed.other_simulators import ask, python_with
from validation.speed.simulators.numba_platform import NumbaPlatform, control_of
from validation.speed.timing import Goal, Row, fastest, row

if TYPE_CHECKING:
    from validation.speed.simulators.with_casadi import CasadiResult

SECONDS = 4  # more than one period of the roll: every kind of kink is in it
VARIANTS = 1000
NEAR = 1e-3  # m, of peer and core at most: beyond it they are not one plant
COUNTED = ("derivative of the platform", "closed-loop platform")  # by callgrind


def rolling(seconds: int) -> Array:
    """Setpoints of the extensions, one a millisecond, m, (n, 3)."""
    angle = 0.1 * np.sin(2.0 * np.pi * 0.3 * 1e-3 * np.arange(1000 * seconds))
    return extensions_of(angle, 0.0 * angle, 0.5)


def core_path(setpoint: Array, tolerance: float) -> Array:
    """Extensions that the core finds, m, (n, 3)."""
    return simulate_platform(setpoint, tolerance=tolerance).legs("extension")


def plant_rows(compiled: Mapping[str, float], install: bool) -> Iterator[Row]:
    """The closed loop beside its peers, one evaluation, many variants.

    Args:
        compiled: what libsms/bench measured, ns.
        install: install CasADi where it is missing.
    """
    milliseconds = compiled["closed-loop platform"] * 1000 * 1e-6
    name, setpoint = f"closed-loop platform, 1 s at 1 kHz, of {SECONDS}", rolling(SECONDS)
    exact = core_path(setpoint, 1e-9)
    wanted = float(np.abs(core_path(setpoint, PLATFORM_TOLERANCE) - exact).max())
    numba = numba_peer(setpoint, exact, wanted)
    yield row(name, milliseconds, "ms", numba, Goal(at_most=2.0, ratio_at_least=5.0))
    casadi = casadi_peer(setpoint, exact, wanted, install)
    yield row(name, milliseconds, "ms", casadi, Goal(at_most=2.0, ratio_at_least=20.0))
    evaluation = compiled["derivative of the platform"]
    yield row("derivative of the platform", evaluation, "ns")
    yield variants_row()


def numba_peer(setpoint: Array, exact: Array, wanted: float) -> tuple[str, float]:
    """Name and ms of the peer for the same second, as near to `exact` as the core is (m)."""
    run = simulate_platform(setpoint[:1])
    peer = NumbaPlatform(run.rows[0, :36].copy())
    for steps in (1, 2, 4, 8, 16, 32):
        error = float(np.abs(peer.run(setpoint, steps) - exact).max())
        if not error < NEAR:
            raise AssertionError(f"core and numba peer differ by {error:.1e} m")
        if error <= wanted or steps == 32:
            seconds = fastest(lambda n=steps: peer.run(setpoint, n), rounds=4)  # type: ignore[misc]
            name = f"numba, RK4, {steps} steps a period, {error:.0e} m (core {wanted:.0e} m)"
            return name, seconds / SECONDS * 1e3
    raise AssertionError("unreachable")


def casadi_peer(
    setpoint: Array, exact: Array, wanted: float, install: bool
) -> tuple[str, float | None]:
    """The same of CasADi and CVODES; no number where CasADi is not installed."""
    python = python_with("casadi", install)
    if python is None:
        return "casadi is not installed: --peers", None
    p, start = sms.Params(), simulate_platform(setpoint[:1]).rows[0]
    air = [
        6 + 10 * leg + state for leg in range(3) for state in (P_LOWER, P_UPPER, SPOOL, SPOOL_RATE)
    ]
    states = [*range(6), *air]
    mechanism = mechanism_from(p)._asdict()
    task = {
        "numbers": numbers_of(p)._asdict(),
        "mechanism": {name: np.asarray(value).tolist() for name, value in mechanism.items()},
        "valve": valve_map("iso_0_4_mpa").tolist(),
        "control": list(control_of(p)),
        "start": start[states].tolist(),
        "scale": SCALE[states].tolist(),
        "setpoint": setpoint.tolist(),
        "exact": exact.tolist(),
        "wanted": wanted,
    }
    result: CasadiResult = ask(python, "casadi", task)
    if not result["error"] < NEAR:
        raise AssertionError(f"core and CasADi peer differ by {result['error']:.1e} m")
    name = f"{result['software']}, tolerance {result['tolerance']:g}, {result['error']:.0e} m"
    return name, result["milliseconds"] / SECONDS


def variants_row() -> Row:
    """1,000 platforms with other payloads for a second: one thread of Python, then two."""
    setpoint = rolling(1)
    variants = []
    for mass in np.linspace(0.0, 100.0, VARIANTS):
        p = sms.Params()
        p.payload_mass = float(mass)
        variants.append(p)

    def one(p: sms.Params) -> float:
        return float(simulate_platform(setpoint, params=p)["roll"][-1])

    def all_of_them(threads: int) -> float:
        with ThreadPoolExecutor(threads) as pool:
            return fastest(lambda: list(pool.map(one, variants)), rounds=1)

    alone, together = (
        min(times)
        for times in zip(*[(all_of_them(1), all_of_them(2)) for _ in range(3)], strict=True)
    )
    name = f"{VARIANTS} variants of 1 s, two threads"
    return row(name, together, "s", ("one thread", alone), Goal(at_most=2.0, ratio_at_least=1.9))
