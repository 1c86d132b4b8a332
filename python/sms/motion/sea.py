"""Deck motion for those without a record: a seaway by its spectrum, and a ship's answer to it.

The seaway is a JONSWAP spectrum (Hasselmann and others, 1973) in Goda's form, which has the given
significant height H and peak frequency f_p whatever the peakedness g:

    S(f) = b H^2 f_p^4 f^-5 exp(-5/4 (f/f_p)^-4) g^r,    r = exp(-(f/f_p - 1)^2 / (2 s^2))

with s = 0.07 below f_p and 0.09 above, and b so that the integral is H^2 / 16. In deep water the
slope of a wave of amplitude a is a (2 pi f)^2 / g_0. The deck answers it as a second-order system
in roll and in pitch each, and heave follows the wave as one does:

    angle / slope = c / (1 - (f/f_n)^2 + 2 i z f/f_n),    heave / wave = the same with c = 1

This is a stand-in with the right rhythm, not a seakeeping calculation: no heading, no coupling, no
hull form. The natural periods come from Table 2.1 (rate over range: 9.4 s of roll, 7.1 s of pitch);
c and z are assumed for a frigate of 120 m. In state 2.5 this deck rolls by some 1.6 deg in ten
minutes, in state 4 by 8; Table 2.1 has 8 deg for state 2.5, from two voyages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from sms._core import Params
from sms.arrays import Array
from sms.errors import InputError
from sms.motion.deck import DeckMotion

Complex = NDArray[np.complex128]
PEAKEDNESS = 3.3  #: of JONSWAP, the mean of the campaign


@dataclass(frozen=True, slots=True)
class SeaState:
    """A seaway: the middle of the state's range, and its most frequent peak period."""

    height: float  #: significant, m
    period: float  #: of the peak, s


SEA_STATES: dict[int, SeaState] = {
    0: SeaState(0.0, 5.0),
    1: SeaState(0.05, 5.0),
    2: SeaState(0.30, 6.3),
    3: SeaState(0.88, 7.5),
    4: SeaState(1.88, 8.8),
}
"""Heights: the middle of each range of the WMO code of sea states. Periods: assumed, open ocean."""


@dataclass(frozen=True, slots=True)
class Response:
    """How a deck answers in one axis: f_n, z and c of the module's text."""

    period: float  #: natural, s
    damping_ratio: float
    share: float  #: of the wave's slope that the hull feels


@dataclass(frozen=True, slots=True)
class Ship:
    """The deck's answer in its three axes."""

    roll: Response = Response(9.4, 0.10, 0.7)
    pitch: Response = Response(7.1, 0.35, 0.35)
    heave: Response = Response(7.1, 0.35, 1.0)


def jonswap(frequency: Array, height: float, period: float) -> Array:
    """Spectrum of the waves' elevation, m^2/Hz, over frequencies (Hz) above 0."""
    ratio = np.asarray(frequency, dtype=np.float64) * period
    return np.asarray(height**2 / 16.0 * period * _shape(ratio) / _shape_integral())


def synthetic_deck_motion(
    state: float,
    duration: float,
    seed: int,
    period: float = 0.05,
    ship: Ship | None = None,
    params: Params | None = None,
) -> DeckMotion:
    """A deck motion in a sea state 0 to 4 (between whole ones by interpolation).

    Args:
        state: 0 calm, 4 moderate; 2.5 is what Table 2.1 asks for.
        duration: s.
        seed: of the random phases; the same seed gives the same motion.
        period: sampling, s.
        ship: its response.
        params: for gravity only.

    A sum of sines, one a bin of 1 / duration, with random phase and Rayleigh-distributed amplitude.
    Roll comes from the beam's part of the sea, pitch and heave from the other part, which is drawn
    on its own. Raises: InputError.
    """
    if not 0.0 <= state <= max(SEA_STATES):
        raise InputError(f"sea state {state:g}: 0 to {max(SEA_STATES)} is allowed")
    if not (math.isfinite(duration) and 8.0 * period <= duration):
        raise InputError(f"duration {duration:g} s: at least {8.0 * period:g} s is needed")
    ship = ship or Ship()
    gravity = (params or Params()).gravity
    sea = _between(state)
    count = math.floor(duration / period + 1e-6) + 1
    frequency: Array = np.fft.rfftfreq(count, period)[1:].astype(np.float64)
    time: Array = period * np.arange(float(count))
    random = np.random.default_rng(seed)
    amplitude = np.sqrt(jonswap(frequency, sea.height, sea.period) * frequency[0])
    slope = (2.0 * math.pi * frequency) ** 2 / gravity

    def drawn() -> Complex:
        parts = random.standard_normal((2, frequency.size))
        return np.asarray(amplitude * (parts[0] + 1j * parts[1]))

    def in_time(parts: Complex) -> Array:
        return np.asarray(np.fft.irfft(0.5 * count * np.concatenate([[0.0], parts]), count))

    beam, ahead = drawn(), drawn()
    return DeckMotion(
        time=time,
        roll=in_time(1j * beam * slope * response(frequency, ship.roll)),
        pitch=in_time(1j * ahead * slope * response(frequency, ship.pitch)),
        heave=in_time(ahead * response(frequency, ship.heave)),
        origin=f"synthetic, sea state {state:g}, seed {seed}",
        done=(
            f"JONSWAP, significant height {sea.height:.2f} m, peak period {sea.period:.1f} s; "
            f"roll {ship.roll.period:g} s, pitch {ship.pitch.period:g} s natural period",
        ),
    )


def response(frequency: Array, axis: Response) -> Complex:
    """The response amplitude operator of one axis, complex, over frequencies in Hz."""
    ratio = np.asarray(frequency, dtype=np.float64) * axis.period
    return np.asarray(axis.share / (1.0 - ratio**2 + 2j * axis.damping_ratio * ratio))


def _between(state: float) -> SeaState:
    known = sorted(SEA_STATES)
    return SeaState(
        float(np.interp(state, known, [SEA_STATES[k].height for k in known])),
        float(np.interp(state, known, [SEA_STATES[k].period for k in known])),
    )


def _shape(ratio: Array) -> Array:
    """The spectrum over f / f_p, but for its size."""
    width = np.where(ratio <= 1.0, 0.07, 0.09)
    peak = PEAKEDNESS ** np.exp(-((ratio - 1.0) ** 2) / (2.0 * width**2))
    return np.asarray(ratio**-5.0 * np.exp(-1.25 * ratio**-4.0) * peak)


@cache
def _shape_integral() -> float:
    ratio = np.linspace(0.2, 20.0, 20001)
    return float(np.trapezoid(_shape(ratio), ratio))
