"""What one record of a flow test shows before anything is fitted: direction, opening, ends, faults.

Nothing is cut out. A sensor that saturates becomes its floor or its ceiling in the model; what a
record cannot tell is said, with what it still can.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from sms.arrays import Array

FULL = 0.98  #: of the way to equal pressures: from there on the whole subsonic branch was seen
MOVES = 8.0  #: times the noise that a pressure must change by to say anything
CLIPPED = 10  #: samples in a row at exactly the largest or the smallest reading
SUPPLY_WINDOW = 0.25  #: s, over which a measured supply pressure is averaged


@dataclass(frozen=True)
class FlowRecord:
    """One charge or discharge as measured. Arrays (n,), SI, pressures absolute."""

    name: str
    time: Array
    pressure: Array
    supply: Array | None
    """Measured before the component; None: not measured."""
    temperature: Array | None
    spool: float | None
    """m, where the spool was held; None: not said."""
    supply_pressure: float
    """Declared, Pa."""
    ambient_pressure: float
    """Declared, Pa."""
    noise: float | None = None
    """Declared standard deviation of one pressure reading, Pa."""
    temperature_noise: float | None = None
    """Declared standard deviation of one temperature reading, K."""


@dataclass(frozen=True)
class Look:
    """What the record shows."""

    charge: bool
    noise: float
    """Pa, standard deviation of one reading."""
    initial: float
    """Pa, before the opening."""
    opening: float
    """s, on the record's clock."""
    waits: bool
    """The record begins before the opening, so that both it and the initial pressure show."""
    floor: float | None
    """Pa, where the readings end although the tank goes on emptying."""
    ceiling: float | None
    final: float
    """Pa, at the end."""
    reached: float
    """Lower over higher pressure at the end: 1 when the tank is full or empty."""
    faults: tuple[str, ...]
    """Why nothing can be fitted; empty: it can."""
    notes: tuple[str, ...]
    """What this record prevents, and what it still shows."""


def look_at(record: FlowRecord) -> Look:
    """Read direction, opening, noise and saturation off a record."""
    p, t = record.pressure, record.time
    noise = record.noise or reading_noise(p)
    few = max(min(p.size // 10, 50), 1)
    first, final = float(np.median(p[:few])), float(np.median(p[-few:]))
    change = final - first
    faults, notes = [], []
    if p.size < 8:
        faults.append(f"{p.size} samples are too few for a transient")
    if abs(change) <= MOVES * noise:
        faults.append(
            f"the pressure does not move ({abs(change):.0f} Pa of change, {noise:.0f} Pa of noise): "
            "the valve stayed closed, or the sensor is not connected; nothing can be identified"
        )
    charge = change > 0.0
    opening, waits = find_opening(t, p, change, noise)
    before = p[t < opening]
    initial = float(np.mean(before)) if waits else float(p[0])
    outside = record.supply_pressure if charge else record.ambient_pressure
    if charge and record.supply is not None:
        outside = float(np.mean(record.supply[-few:]))
    floor, ceiling = None, None
    if not faults and not charge and _rests(p, noise) and final > 1.02 * outside + 3.0 * noise:
        floor = final
        notes.append(
            f"the readings rest at {1e-3 * (final - outside):.1f} kPa above ambient although the tank "
            f"goes on emptying: taken as the sensor's floor; pressure ratios above "
            f"{outside / final:.2f} were not seen, so b and m rest on those below"
        )
    largest = float(p.max())
    if _run_of(p, largest) >= CLIPPED and noise > 0.0 and (not charge or largest < 0.97 * outside):
        ceiling = largest
        notes.append(
            f"the readings are clipped at {1e-3 * largest:.1f} kPa: the model clips there too; what "
            "lies above was not seen"
        )
    reached = min(final, outside) / max(final, outside)
    if not faults and floor is None and ceiling is None and reached < FULL:
        what = f"{'charge' if charge else 'discharge'} ends at a pressure ratio of {reached:.2f}"
        if reached < 0.5:
            notes.append(
                f"the {what}: hardly any subsonic flow was seen; C can be identified, b and m cannot; "
                "record until the pressures are equal"
            )
        else:
            notes.append(
                f"the {what}: the end of the subsonic branch was not seen; b and m are uncertain, "
                "C can be identified; record until the pressures are equal"
            )
    if record.spool is None:
        notes.append(
            "its spool position is not said (conditions = { spool_position = ... }): no place in the "
            "valve map and no discharge coefficient; C, b and m can be identified"
        )
    return Look(
        charge, noise, initial, opening, waits, floor, ceiling, final, reached,
        tuple(faults), tuple(notes),
    )  # fmt: skip


def reading_noise(values: Array) -> float:
    """Standard deviation of the noise of a well sampled signal, from its second differences."""
    if values.size < 4:
        return 0.0
    second = np.diff(values, 2)
    second = second[second != 0.0]  # where a sensor is clipped it shows no noise
    if second.size < 4:
        return 0.0
    return float(1.4826 * np.median(np.abs(second - np.median(second))) / np.sqrt(6.0))


def find_opening(time: Array, pressure: Array, change: float, noise: float) -> tuple[float, bool]:
    """(when the pressure begins to move, whether the record holds at least three samples before)."""
    first = float(np.mean(pressure[:3]))
    threshold = max(4.0 * noise, 0.01 * abs(change))
    way = np.sign(change) * (pressure - first)
    moved = np.flatnonzero((way > threshold) & (np.append(way[1:], way[-1]) > threshold))
    if moved.size == 0 or moved[0] < 3:
        return float(time[0]), False
    at = int(moved[0])
    later = int(np.argmax(way > 2.0 * threshold + 0.05 * abs(change)))
    slope = (way[later] - way[at]) / (time[later] - time[at]) if later > at else np.inf
    opening = float(time[at] - way[at] / slope) if slope > 0.0 else float(time[at])
    return (opening, True) if opening > time[2] else (float(time[0]), False)


def smooth_supply(time: Array, supply: Array) -> Array:
    """The measured supply pressure without its noise, (n,)."""
    window = max(round(SUPPLY_WINDOW / float(np.median(np.diff(time)))), 1)
    return np.asarray(uniform_filter1d(supply, window, mode="nearest"))


def _rests(pressure: Array, noise: float) -> bool:
    """Whether the last tenth of a record does not go on from the tenth before it."""
    tenth = max(pressure.size // 10, 2)
    last, before = pressure[-tenth:], pressure[-2 * tenth : -tenth]
    drift = abs(float(np.mean(last) - np.mean(before)))
    return bool(drift < 4.0 * noise / np.sqrt(tenth) + 1e-4 * float(np.ptp(pressure)))


def _run_of(values: Array, extreme: float) -> int:
    """Longest run of readings that are exactly `extreme`."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], (values == extreme).astype(int), [0]))))
    return int(np.max(edges[1::2] - edges[::2], initial=0))
