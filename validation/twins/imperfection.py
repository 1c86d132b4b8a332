"""How a machine differs from what any rig file can declare of it: drawn for each trial, at a level in percent.

What is hidden in a trial is one thing; this is what no model has, and what nobody is asked to name:

- Flow: the conductance of each metering edge (charge and discharge, of either port) is off by a smooth random function
  of the opening, charge and discharge each with the level as RMS over the openings that runs use. A core that knows one
  smooth error of charge and one of discharge does not have these four.
- The valve's tables are read by Steffen's curve, as the core does, or straight between rows: the source does not say
  which, and where the valve begins to open the two differ by more than all else here.
- Friction: so is the sliding friction, over the signed speed.
- Leaks: what flows over the ratio of pressures has a critical ratio from 0 to 0.5 and an exponent from 0.5, a turbulent
  restriction, to 1, a laminar gap (ISO 6358-1:2013, whose index stands outside the bracket). The core has other laws.
- Sensors are not quite linear: a bow along the span over which they were calibrated, a tenth of the level of that span
  to either side of its best straight line. Data sheets of position transducers and pressure transmitters say 0.1 to 0.5
  percent for that ("independent linearity"); at a level of 1 to 4 percent it is 0.1 to 0.4 percent here. The line
  itself is right: a gain or a zero that is off is an effect of the catalogue, and to name it would be no wrong name.
  For the same reason there is no bow where a reading stays at one value (supply pressure, temperature of a tank).
- A controller holds its command, for a millisecond or for as long as the logger's step. In the first case the log has
  every tenth, fifth or second command, and the rig file says nothing, for nothing that could be said is true of what is
  between two samples; in the second it says `hold = "previous"`.
- The converter rounds to the nearest step, or down.

At level 0 nothing is drawn: the command runs straight from one record sample to the next. Shapes, signs, log rate,
rounding and how tables are read are a seed's; the level only scales what has a size, so that two levels of a seed can
be compared.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from validation.twins.air import Array
from validation.twins.instruments import SPANS, sort_of
from validation.twins.maps import Maps, of_axes, off_by

TERMS = 24
"""Sines that make a smooth random function; the more, the nearer it is to a Gaussian process."""
OPENING = (0.5, 2.5, 0.5)
"""V from the centre between which runs use the valve, and the length over which its error changes."""
SPEED = (0.0, 0.3, 0.1)
"""m/s, the same for the speed of a piston."""
BOW = 0.1
"""Of the level, as a share of the span: a sensor's independent linearity."""
CRITICAL_RATIO = (0.0, 0.5)
LEAK_EXPONENT = (0.5, 1.0)
"""From a turbulent restriction to a laminar gap."""
FASTEST_CONTROL = 1e-3
"""s"""
LARGEST = 10.0
"""Percent: beyond it a map is another machine's."""


@dataclass(frozen=True)
class SmoothFunction:
    """A sum of sines with random wave numbers: a Gaussian process with squared exponential covariance, about."""

    size: float
    wave_numbers: tuple[float, ...]  # rad by unit of the argument
    phases: tuple[float, ...]

    def __call__(self, x: Array) -> Array:
        """Of the same shape."""
        waves = np.sin(np.multiply.outer(x, self.wave_numbers) + np.array(self.phases))
        return np.asarray(self.size * waves.sum(axis=-1), dtype=np.float64)


def draw_smooth(
    level: float, between: tuple[float, float, float], rng: np.random.Generator
) -> SmoothFunction:
    """With `level` as RMS over low <= |x| <= high; between = (low, high, length)."""
    unscaled = SmoothFunction(
        1.0,
        tuple(rng.standard_normal(TERMS) / between[2]),
        tuple(rng.uniform(0.0, 2.0 * np.pi, TERMS)),
    )
    rms = rms_over(unscaled, between)
    return SmoothFunction(level / rms, unscaled.wave_numbers, unscaled.phases)


def rms_over(function: SmoothFunction, between: tuple[float, float, float]) -> float:
    """RMS over low <= |x| <= high."""
    away = np.linspace(*between[:2], 401)
    return float(np.sqrt(np.mean(function(np.concatenate([-away, away])) ** 2)))


@dataclass(frozen=True)
class Hat:
    """On one side of 0, or both: a size at one of some ascending |x|, linear to zero at its neighbours, constant beyond
    the ends."""

    size: float
    number: int
    places: tuple[float, ...]
    sides: tuple[float, ...]  # 1, -1

    def __call__(self, x: Array) -> Array:
        """Of the same shape."""
        heights = np.where(np.arange(len(self.places)) == self.number, self.size, 0.0)
        return np.where(
            np.isin(np.sign(x), self.sides), np.interp(np.abs(x), self.places, heights), 0.0
        )


@dataclass(frozen=True)
class MapErrors:
    """Relative errors of one axis."""

    charge: SmoothFunction | Hat  # over the opening, V from the centre, signed
    discharge: SmoothFunction | Hat
    friction: SmoothFunction  # over the speed, m/s, signed
    straight: bool = False  # the valve's tables are read straight between rows

    @property
    def maps(self) -> Maps:
        """The maps with these errors."""
        return off_by(self.charge, self.discharge, self.friction, self.straight)


NOTHING = SmoothFunction(0.0, (0.0,), (0.0,))


@dataclass(frozen=True)
class Imperfection:
    """Of one machine and its instruments."""

    level: float  # a share, not percent
    axes: tuple[MapErrors, ...]
    bows: Mapping[
        str, float
    ]  # by signal: deviation from the best straight line, of the span, with its sign
    log_step: float  # s
    control_period: float  # s, for which the controller holds its command
    rounds_down: bool
    leak_critical_ratio: float = 0.0
    leak_exponent: float = 0.0  # 0: leaks flow as the source has it

    @property
    def maps(self) -> Maps:
        """Of all axes."""
        each = [axis.maps for axis in self.axes]
        return each[0] if len(each) == 1 else of_axes(each)

    @property
    def sealed(self) -> dict[str, Any]:
        """For the truth's file."""
        return asdict(self)


def draw_imperfection(
    percent: float,
    axes: int,
    signals: Sequence[str],
    log_steps: Sequence[float],
    seed: np.random.SeedSequence,
) -> Imperfection:
    """A machine of so many axes whose instruments read `signals`, every draw from a stream of its own."""
    for_maps, for_bows, for_logger, for_tables, for_leaks = (
        np.random.default_rng(s) for s in seed.spawn(5)
    )
    level = 0.01 * percent
    straight = bool(for_tables.integers(2))
    errors = tuple(
        MapErrors(
            draw_smooth(level, OPENING, for_maps),
            draw_smooth(level, OPENING, for_maps),
            draw_smooth(level, SPEED, for_maps),
            straight,
        )
        for _ in range(axes)
    )
    log_step = float(for_logger.choice(np.asarray(log_steps)))
    bent = [s for s in signals if sort_of(s) in SPANS]
    signs = for_bows.choice([-1.0, 1.0], len(bent))
    return Imperfection(
        level,
        errors,
        {s: float(sign) * BOW * level for s, sign in zip(bent, signs, strict=True)},
        log_step,
        (FASTEST_CONTROL, log_step)[int(for_logger.integers(2))],
        bool(for_logger.integers(2)),
        leak_critical_ratio=float(for_leaks.uniform(*CRITICAL_RATIO)),
        leak_exponent=float(for_leaks.uniform(*LEAK_EXPONENT)),
    )


def map_modes(known: Mapping[float, float], axes: int, alike: bool = False) -> list[Imperfection]:
    """What the valves of one machine can be off by together, at each of the openings of which it is said how well the
    flow is known: each of four edges by itself, since they are ground one by one, or those of both ports alike."""
    sides = [(1.0, -1.0)] if alike else [(1.0,), (-1.0,)]
    places = tuple(known)
    hats = [Hat(size, n, places, s) for s in sides for n, size in enumerate(known.values())]
    errors = [MapErrors(one, NOTHING, NOTHING) for one in hats]
    errors += [MapErrors(NOTHING, one, NOTHING) for one in hats]
    return [Imperfection(max(known.values()), (e,) * axes, {}, 0.0, 0.0, False) for e in errors]


def bowed(signal: str, reading: Array, bow: float) -> Array:
    """What a sensor reads whose characteristic bows by `bow` of its span to either side of a straight line.

    The bow is the second Chebyshev polynomial: of all parabolas the one that a straight line fits best.
    """
    low, high = SPANS[sort_of(signal)]
    place = 2.0 * (reading - low) / (high - low) - 1.0
    return np.asarray(reading + bow * (high - low) * (1.0 - 2.0 * place**2), dtype=np.float64)
