"""The flow test's fits, timed against the source's own method (section 5.3.3).

The source's: Nelder and Mead over b, C and m, the tank integrated by Runge and Kutta's method at
10 ms, the sum of absolute errors minimised; opening and initial pressure read off the record. It is
written here with scipy, its equation compiled by numba, as fast as one would. Both fit the same
records, and the sum that the source minimises is compared for both.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter, thread_time
from typing import Any

import numpy as np
import scipy.optimize
from numpy.typing import NDArray
from sms.identification.flow import fit_start
from sms.identification.flow_problem import declared_params
from sms.identification.flow_record import FlowRecord, Look, look_at

from validation.speed.timing import Goal, Row, row
from validation.trials.identify_flow import declared
from validation.twins.flow_test import delayed, matrix, read, sensor_of, simulate

Array = NDArray[np.float64]
Objective = Callable[..., float]

MACHINE = declared_params(declared)
EACH = 8
"""Of the 112 records the source's method is run on every so many."""
ROUNDS = 3


def records(seed: int = 1) -> list[FlowRecord]:
    """The whole matrix, read off the independent simulator."""
    rng = np.random.default_rng(seed)
    out = []
    for spool, ideal in matrix():
        test = delayed(ideal, rng)
        time, pressure = simulate(test)
        reading = read(pressure, sensor_of(test), rng)
        out.append(FlowRecord("", time, reading, None, None, spool, test.supply, test.ambient))
    return out


def compiled_objective() -> Objective | None:
    """Sum of absolute errors over one record by Runge and Kutta at the sampling step; None without numba."""
    try:
        njit: Any = importlib.import_module("numba").njit
    except ImportError:
        return None

    def rate(p: float, outside: float, charge: bool, c: float, b: float, m: float) -> float:
        high, low = (outside, p) if charge else (p, outside)
        ratio = low / high
        if ratio >= 1.0:
            return 0.0
        flow = high * c * 1.185 * np.sqrt(293.15 / 293.0)
        if ratio > b:
            x = (min(ratio, 0.999) - b) / (1.0 - b)
            flow *= np.sqrt(1.0 - x**m)
            if ratio > 0.999:
                flow *= 1000.0 * (1.0 - ratio)
        return float((1.4 if charge else -1.0) * 288.0 * 293.0 * flow / 5e-3)

    fast: Objective = njit(rate)

    def objective(
        x: Array, measured: Array, p0: float, outside: float, charge: bool, floor: float, h: float
    ) -> float:
        c, b, m = x[0] * 1e-8, x[1], x[2]
        if b < 0.0 or b > 0.528 or c < 1e-10 or c > 1e-7 or m < 0.01 or m > 3.0:
            return 1e12
        p, total = p0, 0.0
        for i in range(measured.size):
            total += abs(max(p, floor) - measured[i])
            k1 = fast(p, outside, charge, c, b, m)
            k2 = fast(p + 0.5 * h * k1, outside, charge, c, b, m)
            k3 = fast(p + 0.5 * h * k2, outside, charge, c, b, m)
            k4 = fast(p + h * k3, outside, charge, c, b, m)
            p += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return total

    compiled: Objective = njit(objective)
    return compiled


def nelder_mead(objective: Objective, record: FlowRecord, look: Look, c_start: float) -> float:
    """The source's fit; its sum of absolute errors from the opening on, Pa."""
    after = record.pressure[record.time >= look.opening]
    outside = record.supply_pressure if look.charge else record.ambient_pressure
    step = float(record.time[1] - record.time[0])
    arguments = (after, look.initial, outside, look.charge, look.floor or 0.0, step)
    start = np.array([1e8 * c_start, 0.3, 1.0])
    options = {"maxiter": 600, "maxfev": 600, "xatol": 1e-4, "fatol": 1e-4}  # fminsearch's own
    found = scipy.optimize.minimize(  # type: ignore[call-overload]
        objective, start, args=arguments, method="Nelder-Mead", options=options
    )
    return float(found.fun)


def ours(record: FlowRecord) -> tuple[float, float]:
    """(sum of absolute errors from the opening on, Pa; where C starts)."""
    look = look_at(record)
    found = fit_start(record, look, declared, MACHINE)
    rows = record.time >= look.opening
    c_start = found.start.component_conductance
    return float(np.sum(np.abs(found.residual[rows]))), c_start


def seconds_of(
    work: Callable[[FlowRecord], object], on: Sequence[FlowRecord], workers: int
) -> float:
    """Wall clock of the fastest of ROUNDS passes."""
    best = float("inf")
    with ThreadPoolExecutor(workers) as pool:
        for _ in range(ROUNDS):
            begin = perf_counter()
            list(pool.map(work, on))
            best = min(best, perf_counter() - begin)
    return best


def measurements() -> Iterator[Row]:
    """Whole matrix; one fit beside the source's; and the objective each reaches."""
    everything = records()
    yield row(
        "flow: 112 fits of the test matrix, two cores", seconds_of(ours, everything, 2), "s",
        goal=Goal(at_most=2.0),
    )  # fmt: skip
    some = everything[::EACH] + everything[1::EACH]
    objective = compiled_objective()
    mine, one = [], float("inf")
    for _ in range(ROUNDS):
        begin = thread_time()
        mine = [ours(record) for record in some]
        one = min(one, (thread_time() - begin) / len(some))
    peer_time, ratio = None, None
    if objective is not None:
        nelder_mead(objective, some[0], look_at(some[0]), mine[0][1])  # compiles
        begin = thread_time()
        sums = [
            nelder_mead(objective, record, look_at(record), c_start)
            for record, (_, c_start) in zip(some, mine, strict=True)
        ]
        peer_time = 1e3 * (thread_time() - begin) / len(some)
        ratio = float(np.mean([theirs / own for theirs, (own, _) in zip(sums, mine, strict=True)]))
    yield row(
        "flow: one fit, CPU time of one core", 1e3 * one, "ms", ("Nelder-Mead, RK4 10 ms (scipy, numba)", peer_time),
        Goal(ratio_at_least=20.0),
    )  # fmt: skip
    yield row(
        "flow: sum of absolute errors left, against the peer's", 1.0, "1",
        ("Nelder-Mead, RK4 10 ms (scipy, numba)", ratio), Goal(ratio_at_least=1.0),
    )  # fmt: skip
