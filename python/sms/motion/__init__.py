"""Motions for the platform: deck-motion records, synthetic seas, test excitations, and their limits.

The road of a record: `read_deck_motion`, `froude_scaled`, `band_limited`, `resampled`, `fitted`.
"""

from sms.motion.deck import (
    DeckMotion,
    band_limited,
    faded,
    froude_scaled,
    part,
    read_deck_motion,
    resampled,
)
from sms.motion.excitation import aprbs, chirp, sine, steps
from sms.motion.feasible import Cut, Feasible, fitted
from sms.motion.limits import Demand, Limits, demand_of, limits_of
from sms.motion.sea import SEA_STATES, SeaState, Ship, jonswap, synthetic_deck_motion
from sms.motion.speed import SpeedLimits, SteadyMotion, speed_limits, steady_motion

__all__ = [
    "SEA_STATES",
    "Cut",
    "DeckMotion",
    "Demand",
    "Feasible",
    "Limits",
    "SeaState",
    "Ship",
    "SpeedLimits",
    "SteadyMotion",
    "aprbs",
    "band_limited",
    "chirp",
    "demand_of",
    "faded",
    "fitted",
    "froude_scaled",
    "jonswap",
    "limits_of",
    "part",
    "read_deck_motion",
    "resampled",
    "sine",
    "speed_limits",
    "steady_motion",
    "steps",
    "synthetic_deck_motion",
]
