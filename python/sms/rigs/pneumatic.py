"""What the pneumatic kinds have in common as problems of the core: laws, windows, the controller that is simulated."""

from __future__ import annotations

import os
from typing import TypedDict

import numpy as np

from sms.arrays import Array
from sms.io.rig import Rig

WINDOW = 1.0
"""s: length of a window."""
NOTHING: Array = np.empty(0)
"""A signal that was not recorded."""


class InWindows(TypedDict):
    """How an actuator is simulated, window by window."""

    friction: str
    valve: str
    chambers: str
    window: float
    longest_step: float
    threads: int


SPOOL_STEP = 2.0
"""Radians of the spool's natural frequency in a step of the integration. Numerics: with more, the explicit part of the
method is unstable, and the spool runs to its stops."""


def step_for(rig: Rig, longest_step: float) -> float:
    """s: a step of the integration, for the fastest spool that the rig file allows."""
    spool = rig.declared("valve_frequency")
    return min(longest_step, SPOOL_STEP / (2.0 * np.pi * (spool.value + spool.uncertainty)))


def in_windows(rig: Rig, longest_step: float) -> InWindows:
    """The laws of the rig file; longest_step, s, of the integration; threads as SMS_THREADS says."""
    return {
        "friction": rig.model.friction,
        "valve": rig.model.valve,
        "chambers": rig.model.chambers,
        "window": WINDOW,
        "longest_step": step_for(rig, longest_step),
        "threads": int(os.environ.get("SMS_THREADS", "2")),
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
