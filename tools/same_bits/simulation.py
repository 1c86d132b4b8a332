"""Runs of drawn machines under every law, controller and table of masses."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray
from sms import (
    Params,
    _core,
    extensions_of,
    simulate_bench,
    simulate_platform,
    simulate_tank,
)
from sms.simulation import CHAMBER_LAWS, FRICTION_LAWS, VALVE_LAWS, Run, SimulationStoppedError

Array = NDArray[np.float64]
Case = tuple[str, Callable[[], Array]]


def machine(seed: int, effects: Mapping[str, float] | None = None) -> Params:
    """Every parameter that is not neutral moved by about two percent, within its bounds."""
    random = np.random.default_rng(seed)
    p = Params(proportional_gain=8.0)
    for info in _core.parameter_table():
        value = p[info.name] * (1.0 + 0.02 * random.standard_normal())
        if info.name not in ("control_period", "adc_bits"):
            p[info.name] = float(np.clip(value, info.lower, info.upper))
    for name, value in (effects or {}).items():
        p[name] = value
    return p


def rows_of(run: Callable[[], Run]) -> Array:
    """What was computed, also of a run that stops."""
    try:
        return run().rows
    except SimulationStoppedError as stopped:
        return stopped.run.rows


def platform_run(
    seed: int,
    friction: str = FRICTION_LAWS[0],
    chamber: str = CHAMBER_LAWS[0],
    effects: Mapping[str, float] | None = None,
    seconds: float = 0.3,
) -> Run:
    """Under its controller, every mass table in turn, each leg a machine of its own."""
    legs = [machine(seed, effects)] * 3
    return simulate_platform(
        platform_setpoints(seconds),
        controller="pid",
        electronics=bool(seed % 2),
        params=legs,
        friction_law=friction,
        chamber_law=chamber,
        masses=("corrected", "table", "lumped")[seed % 3] if effects is None else "corrected",
    )


def platform_setpoints(seconds: float) -> Array:
    time = 1e-3 * np.arange(round(seconds / 1e-3))
    return extensions_of(
        0.02 * np.sin(9.0 * time), 0.02 * np.sin(7.0 * time), 0.5 + 0.02 * np.sin(5.0 * time)
    )


def tank_run(params: Params, valve: str = VALVE_LAWS[0], chamber: str = CHAMBER_LAWS[0]) -> Run:
    time = 1e-3 * np.arange(1500)
    return simulate_tank(
        np.where(time < 0.8, 7.0, 3.5), valve_law=valve, chamber_law=chamber, params=params
    )


def simulations() -> Iterator[Case]:
    time = 1e-3 * np.arange(400)
    volts, metres = 5.0 + 0.8 * np.sin(12.0 * time), 0.2 + 0.04 * np.sin(9.0 * time)
    laws = itertools.product(VALVE_LAWS, FRICTION_LAWS, CHAMBER_LAWS)
    for number, (valve, friction, chamber) in enumerate(laws):
        for controller, electronics in (
            ("open_loop", False),
            ("pid", True),
            ("state_feedback", False),
        ):
            yield (
                f"bench {valve} {friction} {chamber} {controller}",
                lambda n=number, v=valve, f=friction, c=chamber, k=controller, e=electronics: (
                    rows_of(
                        lambda: simulate_bench(
                            volts if k == "open_loop" else metres,
                            controller=k,
                            electronics=e,
                            valve_law=v,
                            friction_law=f,
                            chamber_law=c,
                            params=machine(n),
                        )
                    )
                ),
            )
        if valve == VALVE_LAWS[0]:
            yield (
                f"platform {friction} {chamber}",
                lambda n=number, f=friction, c=chamber: platform_run(n, f, c).rows,
            )
    for number, (valve, chamber) in enumerate(itertools.product(VALVE_LAWS, CHAMBER_LAWS)):
        yield (
            f"tank {valve} {chamber}",
            lambda n=number, v=valve, c=chamber: tank_run(machine(n), v, c).rows,
        )
