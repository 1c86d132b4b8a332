"""Which unit a column has, where the one that is declared cannot be right.

A unit is proposed only where the readings in it are those of a working machine; the line to write comes with it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from sms.io.records import Record
from sms.io.rig import Rig
from sms.io.signals import SIGNAL_UNITS
from sms.io.units import split_column_name, to_si

USUAL_STEP = (5e-4, 5e-2)
"""s between two samples, of a logger beside a pneumatic machine: 2 kHz to 20 Hz."""

RATES = [m * 10.0**k for k in (0, 1, 2, 3) for m in (1.0, 2.0, 2.5, 4.0, 5.0, 8.0)]
"""Hz, that most loggers have."""
OTHER_RATES = [m * 10.0**k for k in (0, 1, 2, 3) for m in (1.2, 1.25, 1.5, 1.6, 2.4, 3.0, 6.0, 7.5)]
OTHER_RATES += [2.0**k for k in range(1, 11)]
"""Hz, that some have."""
ROUNDED = 2e-3
"""Of a rate: what it may be off by. Stamps are rounded to a millisecond or a part of it; quartz is better."""
STRETCHED = 1.3
"""By how much an axis of time may be stretched, or squeezed: more is another unit."""

TIMES = ("us", "ms", "s", "min")
LENGTHS = ("mm", "cm", "m")
PRESSURES = ("Pa", "hPa", "kPa", "MPa", "bar", "psi")


def declared_unit(rig: Rig, signal: str) -> str:
    """What the rig file has a signal's column in; SI where only the file's own header says it."""
    source = rig.signals[signal]
    return source.unit or split_column_name(source.column)[1] or SIGNAL_UNITS[signal]


def likely_unit(
    rig: Rig, signal: str, units: Sequence[str], fits: Callable[[float], bool]
) -> str | None:
    """The unit in which the readings fit; None if there is none, or several.

    fits: whether readings that are so many times as large are those of a working machine.
    """
    fitting = _fitting(rig, signal, units, fits)
    return fitting[0] if len(fitting) == 1 else None


def largest_unit(
    rig: Rig, signal: str, units: Sequence[str], fits: Callable[[float], bool]
) -> str | None:
    """The same, of several the largest; units: from small to large."""
    return next(reversed(_fitting(rig, signal, units, fits)), None)


def _fitting(
    rig: Rig, signal: str, units: Sequence[str], fits: Callable[[float], bool]
) -> list[str]:
    si, declared = SIGNAL_UNITS[signal], declared_unit(rig, signal)
    now = to_si(f"1 {declared}", si, signal)
    return [u for u in units if u != declared and fits(to_si(f"1 {u}", si, signal) / now)]


def remedy(rig: Rig, signal: str, unit: str) -> str:
    """What to write in [signals]."""
    return (
        f"check the unit of {signal}: the column looks like {unit}; write {signal} = "
        f'{{ column = "{rig.signals[signal].column}", unit = "{unit}" }} in [signals]'
    )


def unit_of_time(rig: Rig, step: float) -> str:
    """What to do about a median step, s, that no logger has."""
    unit = likely_unit(rig, "time", TIMES, lambda f: USUAL_STEP[0] <= step * f <= USUAL_STEP[1])
    return "check the unit of time in [signals]" if unit is None else remedy(rig, "time", unit)


def unit_of_pressure(rig: Rig, record: Record, signal: str) -> str | None:
    """The unit in which the median reading is between half of ambient and 12 bar, or None."""
    ambient = rig.declared("ambient_pressure").value
    middle = float(np.nanmedian(record.used(signal)))
    gauge = ambient if signal in record.gauge else 0.0
    return likely_unit(rig, signal, PRESSURES, lambda f: 0.5 * ambient < f * middle + gauge < 1.2e6)


def rates_nearby(rate: float) -> list[float]:
    """Hz: what a logger may have had whose records seem to have a rate that no logger has; none where one has it."""
    if any(abs(rate - usual) <= ROUNDED * usual for usual in RATES + OTHER_RATES):
        return []
    return [usual for usual in RATES if 1.0 / STRETCHED < usual / rate < STRETCHED]


def stretched_remedy(rig: Rig, factor: float) -> str:
    """What to write where the axis of time has to be so many times as long."""
    scale = rig.signals["time"].scale * factor
    return f"check the clock; if it is that, write scale = {scale:.6g} in [signals] time"
