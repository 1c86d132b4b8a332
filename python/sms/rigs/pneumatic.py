"""What the pneumatic kinds have in common as problems of the core: laws, windows, the controller that is simulated."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict

import numpy as np

from sms import simulation
from sms.arrays import Array
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.io.signals import without_leg
from sms.rigs.threads import threads

WINDOW = 1.0
"""s: length of a window."""
NOTHING: Array = np.empty(0)
"""A signal that was not recorded."""
READ_DIRECTLY = {"supply": "supply_pressure"}
"""Kind.read_directly where a valve feeds the rig: nothing else reaches the sensor of the supply but by its line."""


class InWindows(TypedDict):
    """How an actuator is simulated, window by window."""

    friction: str
    valve: str
    chambers: str
    window: float
    longest_step: float
    threads: int


def in_windows(rig: Rig, longest_step: float, runs: Sequence[Run]) -> InWindows:
    """The laws of the rig file; longest_step, s, of the integration; threads as SMS_THREADS says."""
    return {
        "friction": rig.model.friction,
        "valve": rig.model.valve,
        "chambers": rig.model.chambers,
        "window": max(run.window or WINDOW for run in runs),
        "longest_step": longest_step,
        "threads": threads(),
    }


class Controller(TypedDict):
    """What of a simulated controller is no parameter."""

    law: str
    compensated: bool
    electronics: bool


def controller_of(rig: Rig) -> Controller:
    """The controller as the rig file's [control] has it."""
    return {
        "law": rig.control.law,
        "compensated": rig.control.compensated,
        "electronics": rig.control.electronics,
    }


def record_of_simulation(
    run: simulation.Run, signals: Sequence[str], every: int
) -> dict[str, Array]:
    """What a record would hold of a simulated run, a sample every so many control periods: the commands, and what the
    sensors say of the rest."""

    def column(signal: str) -> Array:
        return run[signal] if without_leg(signal) == "valve_command" else run.reading(signal)

    return {signal: np.ascontiguousarray(column(signal)[::every]) for signal in signals}
