"""What a column's readings are: unit, gauge or absolute, where the sensor's zero is.

The header's word counts where it has one. Where it has none, a unit is taken if the readings in it are those of a
working machine, and in no other: the ranges are those of signals.def and of the data check.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from sms.draft.assignment import Match
from sms.draft.columns import Column
from sms.draft.given import Given, Question
from sms.draft.header import has_dimension, known_unit
from sms.errors import InputError
from sms.io.plausible import OVERSHOOT_NOTE
from sms.io.signals import SIGNAL_UNITS, SIGNALS, is_pressure, without_leg
from sms.io.units import array_to_si, to_si
from sms.parameters import PARAMETERS

Sure = Literal["sure", "likely", "doubtful"]
_LEVELS: tuple[Sure, ...] = ("sure", "likely", "doubtful")

FASTEST, SLOWEST = 1.5e-4, 0.1  #: s between two samples of a logger beside a pneumatic machine
SWEEP = 0.01, 1.0  #: m, that a run sweeps
HIGHEST = 1.8e5, 1.6e6  #: Pa absolute, of the highest pressure in a run
NEAR_AMBIENT = 0.7, 1.15  #: of 1 bar: the lowest reading of a vented chamber, counted from vacuum
CENTRE = 5.0  #: V, of the valve: a command that counts from it is negative half of the time

_CANDIDATES: Mapping[str, tuple[str, ...]] = {
    "s": ("s", "ms", "us"),
    "m": ("m", "mm"),
    "Pa": ("Pa", "hPa", "kPa", "MPa", "bar", "psi"),
    "V": ("V",),
    "N": ("N", "kN"),
    "K": ("K", "degC"),
    "rad": ("rad", "deg"),
}


@dataclass(frozen=True)
class Interpretation:
    """One entry of [signals], and how it came about."""

    signal: str
    column: Column
    unit: str
    sure: Sure
    why: tuple[str, ...]
    gauge: bool = False
    scale: float | None = None
    offset: str | None = None

    def with_reason(
        self, sure: Sure, why: str, **changes: bool | float | str | None
    ) -> Interpretation:
        """The same, less sure by a further guess."""
        least = max(self.sure, sure, key=_LEVELS.index)
        return replace(self, sure=least, why=(*self.why, why), **changes)  # type: ignore[arg-type]


def interpretations(matches: Mapping[str, Match], given: Given) -> list[Interpretation]:
    """Every entry of [signals]. Question for what the readings do not tell."""
    found = [_with_unit(s, m, matches, given) for s, m in matches.items()]
    gauge = _gauge([f for f in found if is_pressure(f.signal)], given)
    return [_with_zero(gauge.get(f.signal, f), found, given) for f in found]


# ---- units -----------------------------------------------------------------------------------------


def _with_unit(
    signal: str, match: Match, matches: Mapping[str, Match], given: Given
) -> Interpretation:
    column, si = match.column, SIGNAL_UNITS[signal]
    level: Sure = "sure" if match.sure else "doubtful" if match.doubtful else "likely"
    said = given.of("unit", signal)
    if said is not None:
        known = known_unit(said)
        unit = known[0] if known else said
        if not has_dimension(unit, si) and not (unit == "%" and si == "V"):
            raise InputError(f"--unit {signal}={said}: not a unit like '{si}'")
        return Interpretation(signal, column, unit, level, (match.why, f"{unit}: given"))
    if column.header.unit is not None:
        return Interpretation(
            signal, column, column.header.unit, level, (match.why, "unit in the header")
        )
    together = [column]
    if si == "Pa":
        pressures = [m.column for s, m in matches.items() if is_pressure(s)]
        together = [c for c in pressures if c.header.unit is None]
    fitting = [unit for unit in _CANDIDATES[si] if _fits(signal, unit, together)]
    if len(fitting) == 1:
        why = f"{fitting[0]}: the only unit in which its readings are those of such a machine"
        return Interpretation(
            signal, column, fitting[0], "likely" if level == "sure" else level, (match.why, why)
        )
    low, high = np.min(column.readings), np.max(column.readings)
    which = f"can be {' or '.join(fitting)}" if fitting else "fit no usual unit"
    problem = f"the column '{column.name}' for {signal} has no unit, and its readings, {low:g} to {high:g}, {which}"
    example = fitting[0] if fitting else {"m": "mm", "s": "ms", "Pa": "bar"}.get(si, si)
    raise Question(
        "unit", without_leg(signal), problem, example, choices=tuple(fitting or _CANDIDATES[si])
    )


def _fits(signal: str, unit: str, columns: Sequence[Column]) -> bool:
    """Whether readings in a unit are those of a machine that runs."""
    si, column = SIGNAL_UNITS[signal], columns[0]
    factor = to_si(f"1 {unit}", si, signal) - (to_si(f"0 {unit}", si, signal) if si == "K" else 0.0)
    low, high = float(np.min(column.readings)), float(np.max(column.readings))
    if si == "s":
        step = column.step
        return step is not None and FASTEST < factor * step <= SLOWEST
    if si == "m":
        return SWEEP[0] <= factor * (high - low) <= SWEEP[1]
    if si == "Pa":
        top = factor * max(float(np.max(c.readings)) for c in columns)
        return HIGHEST[0] - 1e5 < top < HIGHEST[1] and not (
            top < HIGHEST[0] and _is_absolute(columns, factor)
        )
    if si == "rad":  # a platform tilts by some degrees: half a radian is more than it has
        return 0.02 < factor * max(high, -low) < 0.5
    usual = SIGNALS[without_leg(signal)]
    if si == "K":  # a gas between -50 and 150 degC
        return (
            to_si(f"{low} {unit}", si, signal) > 223.0
            and to_si(f"{high} {unit}", si, signal) < 423.0
        )
    return usual.low <= factor * low and factor * high <= usual.high


def _is_absolute(columns: Sequence[Column], factor: float) -> bool:
    return min(float(np.min(c.readings)) for c in columns) * factor > NEAR_AMBIENT[0] * 1e5


# ---- gauge or absolute -----------------------------------------------------------------------------


def _gauge(pressures: Sequence[Interpretation], given: Given) -> dict[str, Interpretation]:
    """Pressures with what they are counted from. Sensors whose headers say nothing are taken as alike."""
    told = {p.signal: p.column.header.reading or _of_unit(p, given) for p in pressures}
    silent = [p for p in pressures if told[p.signal] is None]
    done = {
        p.signal: p.with_reason(
            "sure", f"{told[p.signal]}, as the header says", gauge=told[p.signal] == "gauge"
        )
        for p in pressures
        if told[p.signal] is not None
    }
    if not silent:
        return done
    lowest = min(float(np.min(_in_si(p))) for p in silent)
    if given.pressures is not None:
        if given.pressures not in ("gauge", "absolute"):
            raise InputError(f"--pressures {given.pressures}: write gauge or absolute")
        level, gauge, why = "sure", given.pressures == "gauge", f"{given.pressures}: given"
    elif lowest < NEAR_AMBIENT[0] * 1e5:
        level, gauge, why = (
            "sure",
            True,
            f"gauge: down to {lowest / 1e5:.2f} bar, absolute it would be a vacuum",
        )
    elif lowest < NEAR_AMBIENT[1] * 1e5:
        level, gauge, why = (
            "likely",
            False,
            f"absolute: down to {lowest / 1e5:.2f} bar, which is ambient",
        )
    else:
        level, gauge, why = "doubtful", False, "absolute: nothing speaks against it"
        if not given.accept:
            problem = (
                f"whether the pressures are gauge or absolute cannot be told: '{silent[0].column.name}' and the like "
                f"never fall below {lowest / 1e5:.2f} bar"
            )
            raise Question("pressures", "", problem, "absolute", "absolute", ("gauge", "absolute"))
    return done | {p.signal: p.with_reason(level, why, gauge=gauge) for p in silent}  # type: ignore[arg-type]


def _of_unit(pressure: Interpretation, given: Given) -> Literal["gauge", "absolute"] | None:
    """What a unit given as "barg" says."""
    known = known_unit(given.of("unit", pressure.signal) or "")
    return known[1] if known else None


# ---- zero and scale --------------------------------------------------------------------------------


def _in_si(of: Interpretation) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return array_to_si(of.column.readings, of.unit, SIGNAL_UNITS[of.signal], of.signal).ravel()


def _with_zero(
    of: Interpretation, all_of: Sequence[Interpretation], given: Given
) -> Interpretation:
    """With scale and offset: as given, or where readings cannot be counted from the signal's own zero."""
    scale, offset = given.of("scale", of.signal), given.of("offset", of.signal)
    if scale is not None:
        try:
            of = of.with_reason("sure", "scale: given", scale=float(scale))
        except ValueError:
            raise InputError(f"--scale {of.signal}={scale}: write a number") from None
    if offset is None and of.signal.startswith("setpoint"):  # counts as the position does
        offset = given.of("offset", of.signal.replace("setpoint", "extension"))
    if offset is not None and of.unit != "%":
        return of.with_reason("sure", "offset: given", offset=offset)
    stem = without_leg(of.signal)
    if stem == "valve_command":
        return _command(of, given, scale, offset)
    if stem in ("extension", "setpoint") and scale is None:
        return _position(of, [o for o in all_of if without_leg(o.signal) == "extension"], given)
    return of


def _command(
    of: Interpretation, given: Given, scale: str | None, offset: str | None
) -> Interpretation:
    """A valve's command counts 0 to 10 V; some count from its centre, or in percent."""
    percent = of.unit == "%"
    readings = of.column.readings if percent else _in_si(of)
    low, high = float(np.min(readings)), float(np.max(readings))
    whole = 100.0 if percent else CENTRE
    centred = low < -0.05 * whole
    if percent:
        share = (CENTRE if centred else 2.0 * CENTRE) / 100.0
        of = replace(of, unit="V", scale=share if scale is None else float(scale))
    if percent and scale is None:
        of = of.with_reason("doubtful", f"100 % taken as {100.0 * share:g} V")
        problem = (
            f"the column '{of.column.name}' counts in percent, of how many volts it does not say"
        )
        _ask(of, given, "scale", f"{share:g}", problem)
    if offset is not None:
        return of.with_reason("sure", "offset: given", offset=offset)
    if not centred or (scale is not None and not percent):
        return of
    reads = f"'{of.column.name}' reads {low:g} to {high:g} {'%' if percent else 'V'}"
    if max(high, -low) > 1.05 * whole:
        raise Question("offset", of.signal, f"{reads}, not 0 to 10 V", '"0 V"')
    of = of.with_reason("doubtful", "counted from the valve's centre", offset=f"{CENTRE:g} V")
    _ask(of, given, "offset", '"5 V"', f"{reads}, as if counted from the valve's centre")
    return of


def _position(of: Interpretation, alike: Sequence[Interpretation], given: Given) -> Interpretation:
    """An extension counts from the end stop; many sensors count from the middle."""
    where = "--parameter stroke"
    said = given.parameter.get("stroke")
    stroke = PARAMETERS["stroke"].default if said is None else to_si(said, "m", where)
    low = min(float(np.min(_in_si(o))) for o in alike)
    high = max(float(np.max(_in_si(o))) for o in alike)
    spare = OVERSHOOT_NOTE * stroke
    if low >= -spare and high <= stroke + spare:
        return of
    middle = 0.5 * stroke
    reads = f"'{of.column.name}' reads {1e3 * low:.4g} to {1e3 * high:.4g} mm"
    of_stroke = f"of a stroke of {1e3 * stroke:g} mm{'' if said else ', the default'}"
    if low < 0.0 and low + middle >= -spare and high + middle <= stroke + spare:
        offset = f"{1e3 * middle:g} mm"
        of = of.with_reason("doubtful", f"its zero is in mid-stroke, {of_stroke}", offset=offset)
        _ask(
            of,
            given,
            "offset",
            f'"{offset}"',
            f"{reads} {of_stroke}, as if counted from its middle",
        )
        return of
    if said is None:
        raise Question(
            "parameter",
            "stroke",
            f"{reads}, which is not within 0 and the stroke's default",
            '"500 mm"',
        )
    raise Question("offset", without_leg(of.signal), f"{reads} {of_stroke}", '"200 mm"')


def _ask(
    of: Interpretation,
    given: Given,
    subject: Literal["scale", "offset"],
    example: str,
    problem: str,
) -> None:
    """A doubtful guess is for a person to accept."""
    if not given.accept:
        raise Question(subject, without_leg(of.signal), problem, example, example.strip('"'))
