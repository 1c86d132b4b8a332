"""Every effect of the catalogue is an effect of the simulated machine: switched on, it changes what a sensor says."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import Params, _core, extensions_of, simulate_bench, simulate_platform, simulate_tank
from sms.diagnosis.effects.catalogue import Effect, catalogue
from sms.io.signals import KINDS
from sms.parameters import common_parameter
from sms.simulation import Run, SimulationStoppedError

Array = NDArray[np.float64]
Machine = Params | _core.LegParams

PERIOD = 1e-3
LOW = 0.315
"""m, height of a platform whose actuators are nearly retracted: within reach of their end cushions."""
SET_BY_A_CONTROLLER = ("valve_command", "setpoint", "rod_force", "spool_position")


def on(effect: Effect, machine: Machine) -> Machine:
    """The machine with the effect, well within what is plausible."""
    changed = machine.copy()
    for name in effect.parameters[:1]:
        low, high = effect.plausible_range(float(machine[common_parameter(name)]))
        changed[name] = low + 0.3 * (high - low)
        assert changed[name] != machine[name], name
    return changed


def signals(kind: str) -> tuple[str, ...]:
    """What is measured on a rig of this kind, but for what drives it."""
    return tuple(
        s for s in KINDS[kind].signals if s != "time" and not s.startswith(SET_BY_A_CONTROLLER)
    )


def laws(effect: Effect) -> tuple[str, str]:
    """The laws of chambers and controller under which the effect stands, and can be seen."""
    controller = effect.controller
    warm = "energy" if effect.signal == "tank_temperature" else "polytropic"
    return effect.chambers or warm, controller if controller == "state_feedback" else "pid"


def wanted(amplitude: float, length: float) -> Array:
    """A set-point about zero, with both slow and fast reversals, m."""
    time = np.arange(0.0, length, PERIOD)
    return np.asarray(
        amplitude * (0.8 * np.sin(8.0 * time) + 0.2 * np.sign(np.sin(5.0 * time)) * (time > 0.1))
    )


def bench(machine: Machine, chambers: str, controller: str) -> Run:
    return simulate_bench(
        0.05 + wanted(0.2, 1.5),  # begins in an end cushion
        extension=0.02,
        controller=controller,
        params=machine,
        chamber_law=chambers,
        tolerance=1e-5,
    )


def platform(machine: Machine, chambers: str, controller: str) -> Run:
    assert isinstance(machine, _core.LegParams)
    wave = wanted(0.02, 0.4)
    return simulate_platform(
        extensions_of(wave, -wave, LOW - wave),
        pose=(0.0, 0.0, LOW),
        controller=controller,
        params=machine.legs,
        chamber_law=chambers,
        tolerance=1e-3,
    )


def tank(machine: Machine, chambers: str, controller: str) -> Run:
    del controller
    time = np.arange(0.0, 1.5, PERIOD)
    volts = 5.0 + 1.6 * np.sign(np.sin(5.0 * time)) * (time > 0.1)
    return simulate_tank(volts, params=machine, chamber_law=chambers)


RUNS = {"bench": bench, "platform": platform, "tank": tank}


def machine_of(kind: str) -> Machine:
    """With a controller that has all its gains, and a supply whose line is felt: a tank alone does not tell a larger
    flow of warmer air from a smaller one of colder."""
    params = Params(
        proportional_gain=20.0,
        integral_gain=5.0,
        derivative_gain=0.05,
        supply_line_resistance=1e6,
        tank_initial_pressure=2e5,
    )
    return _core.LegParams(params) if kind == "platform" else params


def run(kind: str, machine: Machine, chambers: str, controller: str) -> Run:
    """As far as it comes: a machine with a large effect may run into its ends."""
    try:
        return RUNS[kind](machine, chambers, controller)
    except SimulationStoppedError as stopped:
        return stopped.run


@cache
def healthy(kind: str, chambers: str, controller: str) -> Run:
    return run(kind, machine_of(kind), chambers, controller)


def changes(kind: str, one: Run, other: Run) -> dict[str, float]:
    """The largest change of each reading."""
    n = min(len(one.time), len(other.time))
    assert n > 100
    return {
        s: float(np.max(np.abs(one.reading(s)[:n] - other.reading(s)[:n]))) for s in signals(kind)
    }


CASES = [(kind, effect) for kind in RUNS for effect in catalogue(kind)]


@pytest.mark.parametrize(("kind", "effect"), CASES, ids=[f"{k}-{e.key}" for k, e in CASES])
def test_every_effect_changes_a_simulated_reading(kind: str, effect: Effect) -> None:
    chambers, controller = laws(effect)
    base = healthy(kind, chambers, controller)
    found = changes(kind, base, run(kind, on(effect, machine_of(kind)), chambers, controller))
    assert max(found.values()) > 0.0


def test_the_same_machine_twice_changes_nothing() -> None:
    """Nothing but an effect makes those changes."""
    for kind in RUNS:
        chambers, controller = "polytropic", "pid"
        again = run(kind, machine_of(kind), chambers, controller)
        assert max(changes(kind, healthy(kind, chambers, controller), again).values()) == 0.0
