"""The steps that an estimation takes follow every effect of the catalogue: stable, and near those that are far shorter.

The Rosenbrock method of integrate_stiff.hpp stays stable where its approximate Jacobian has what is stiff; a force or a
flow that is left out of it makes a simulation diverge that is right in shorter steps.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import extensions_of, simulate_bench, simulate_platform, simulate_tank
from sms.diagnosis.effects.catalogue import Effect, catalogue
from sms.io.signals import without_leg
from sms.rigs import bench as of_bench
from sms.rigs import platform as of_platform
from sms.rigs import tank as of_tank
from sms.simulation import Run
from test_catalogue_acts import LOW, Machine, laws, machine_of, on, signals

Array = NDArray[np.float64]

PERIOD = 0.005
"""s, of the controllers; steps divide it."""
STEPS = {
    "bench": of_bench.LONGEST_STEP_ELSEWHERE,
    "platform": of_platform.LONGEST_STEP,
    "tank": of_tank.LONGEST_STEP,
}
SHORTER = 20
RANGES = {"extension": 0.4, "roll": 0.4, "pitch": 0.4, "height": 0.4, "tank_temperature": 300.0}
PRESSURES = 5e5
NEAR = 0.05
"""Of the range: a piston that stops in one run and creeps in the other costs less, one that diverges far more."""


def time(length: float) -> Array:
    return np.arange(0.0, length, PERIOD)


def simulated(kind: str, machine: Machine, chambers: str, controller: str, step: float) -> Run:
    if kind == "bench":
        t = time(1.0)
        return simulate_bench(
            0.2 + 0.15 * np.sin(9.0 * t) * (t > 0.1),
            extension=0.2,
            controller=controller,
            params=machine,
            chamber_law=chambers,
            step=step,
            stiff=True,
        )
    if kind == "tank":
        t = time(1.5)
        volts = 5.0 + 1.6 * np.sign(np.sin(5.0 * t)) * (t > 0.1)
        return simulate_tank(volts, params=machine, chamber_law=chambers, step=step, stiff=True)
    wave = 0.05 * np.sin(12.0 * time(0.4))
    return simulate_platform(
        extensions_of(wave, -wave, LOW + 0.1 - wave),
        pose=(0.0, 0.0, LOW + 0.1),
        controller=controller,
        params=machine.legs,
        chamber_law=chambers,
        step=step,
        stiff=True,
    )


CASES = [(kind, effect) for kind in STEPS for effect in catalogue(kind)]


@pytest.mark.parametrize(("kind", "effect"), CASES, ids=[f"{k}-{e.key}" for k, e in CASES])
def test_the_steps_of_an_estimation_follow_every_effect(kind: str, effect: Effect) -> None:
    machine = machine_of(kind)
    machine["control_period"] = PERIOD
    chambers, controller = laws(effect)
    runs = [
        simulated(kind, on(effect, machine), chambers, controller, step)
        for step in (STEPS[kind], STEPS[kind] / SHORTER)
    ]
    assert len(runs[0].time) == len(runs[1].time)
    for name in signals(kind):
        off = np.abs(runs[0].reading(name) - runs[1].reading(name)).max()
        assert off < NEAR * RANGES.get(without_leg(name), PRESSURES), name
