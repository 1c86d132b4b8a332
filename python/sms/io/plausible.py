"""Whether the numbers of a record can be what the rig file says they are: range, unit, sign.

A wrong unit or a gauge reading taken as absolute is best found here: later it would look like a
property of the machine.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, pi

import numpy as np

from sms.io.records import Finding, Record, Severity
from sms.io.rig import Rig
from sms.io.signals import SIGNALS, is_pressure, without_leg
from sms.io.unit_slips import LENGTHS, largest_unit, unit_of_pressure
from sms.io.unit_slips import remedy as unit_remedy

OVERSHOOT_NOTE, OVERSHOOT_WARNING, OVERSHOOT_ERROR = 0.01, 0.25, 1.0  #: shares of the stroke
NO_AIR = 0.05  #: of ambient: no chamber of a working machine stays below it
ABSURD = 1e6  #: times the usual range, beyond it: more than any slip of a unit
FORCE_RATIO = 5.0  #: how much better another reading must explain the force to be suggested


def pressure_range(rig: Rig, record: Record) -> Iterator[Finding]:
    """No pressure is below vacuum, and a chamber is seldom far below ambient."""
    ambient = rig.declared("ambient_pressure").value
    for signal in filter(is_pressure, record.signals):
        gauge = signal in record.gauge
        absolute = record.used(signal) + (ambient if gauge else 0.0)
        if absolute.size == 0 or np.all(np.isnan(absolute)):
            continue
        lowest = int(np.nanargmin(absolute))
        reading = "gauge" if gauge else "absolute"
        if absolute[lowest] < 0.0:
            severity: Severity = "error"
            message = f"{absolute[lowest]:.0f} Pa absolute is below vacuum (taken as {reading})"
        elif absolute[lowest] < 0.5 * ambient:
            severity = "warning"
            message = (
                f"{absolute[lowest]:.0f} Pa absolute is far below ambient, {ambient:.0f} Pa "
                f"(taken as {reading})"
            )
        else:
            continue
        remedy = "check the unit and the sensor's zero"
        if not gauge:
            remedy += ", or write gauge = true if the sensor reads against ambient"
        if np.nanmedian(absolute) < NO_AIR * ambient:
            severity, unit = "error", unit_of_pressure(rig, record, signal)
            remedy = remedy if unit is None else unit_remedy(rig, signal, unit)
        yield record.finding(severity, lowest + record.skipped, signal, message, remedy)


def usual_range(rig: Rig, record: Record) -> Iterator[Finding]:
    """What no sensor of this kind usually reads (signals.def). The extension is held against the stroke instead, and a
    pressure below vacuum is an error already."""
    for signal in record.signals:
        stem = without_leg(signal)
        if stem in ("time", "extension"):
            continue
        usual = SIGNALS[stem]
        values = record.used(signal)
        if signal in record.gauge:
            values = values + rig.declared("ambient_pressure").value
        low = -inf if is_pressure(signal) else usual.low
        beyond = np.fmax(values - usual.high, low - values)
        if not np.any(beyond > 0.0):
            continue
        worst = int(np.nanargmax(beyond))
        yield record.finding(
            "error" if beyond[worst] > ABSURD * (usual.high - usual.low) else "warning",
            worst + record.skipped,
            signal,
            f"{values[worst]:.4g} {usual.unit} lies outside what such a sensor usually reads, {usual.low:g} to "
            f"{usual.high:g} {usual.unit}",
            "check its unit, scale and offset",
        )


def extension_range(rig: Rig, record: Record, signal: str = "extension") -> Iterator[Finding]:
    """The extension must lie within 0 to stroke, but for a zero that was set by hand."""
    stroke = rig.declared("stroke").value
    extension = record.used(signal)
    if extension.size == 0 or np.all(np.isnan(extension)):
        return
    beyond = np.fmax(-extension, extension - stroke)
    worst = int(np.nanargmax(beyond))
    share = float(beyond[worst]) / stroke
    if share <= OVERSHOOT_NOTE:
        return
    severity: Severity = "note"
    if share > OVERSHOOT_WARNING:
        severity = "error" if share > OVERSHOOT_ERROR else "warning"
    origin = "" if "stroke" in rig.parameters else ", the default"
    ends = float(np.nanmin(extension)), float(np.nanmax(extension))
    beyond_by = OVERSHOOT_NOTE * stroke
    unit = largest_unit(
        rig,
        signal,
        LENGTHS,
        lambda f: -beyond_by <= f * ends[0] and f * ends[1] <= stroke + beyond_by,
    )
    yield record.finding(
        severity,
        worst + record.skipped,
        signal,
        f"{1e3 * extension[worst]:.1f} mm lies outside 0 to {1e3 * stroke:g} mm (the stroke"
        f"{origin}) by {100 * share:.0f} %",
        "check its zero (offset), its unit, and the stroke in [parameters]"
        if unit is None or share <= OVERSHOOT_ERROR
        else unit_remedy(rig, signal, unit),
    )


def force_against_pressure(rig: Rig, record: Record) -> Iterator[Finding]:
    """Whether the rod force fits the lower chamber's pressure at all: sign, and gauge or absolute.

    Only area times pressure, to see a wrong reading; the model's force balance is in the core. It
    takes a known bore and an upper chamber open to ambient.
    """
    if "bore_diameter" not in rig.parameters or "chamber_pressure_upper" in record.signals:
        return
    area = 0.25 * pi * rig.declared("bore_diameter").value ** 2
    ambient_force = area * rig.declared("ambient_pressure").value
    gauge = "chamber_pressure_lower" in record.gauge
    push = area * record.used("chamber_pressure_lower")
    force = record.used("rod_force")
    if not np.any(np.isfinite(push) & np.isfinite(force)):
        return
    taken, other = (push, push - ambient_force) if gauge else (push - ambient_force, push)
    error_taken, error_other, error_sign = (
        float(np.nanmedian(np.abs(force - guess))) for guess in (taken, other, -taken)
    )
    if error_taken > FORCE_RATIO * error_sign:
        yield record.finding(
            "warning",
            None,
            "rod_force",
            "the force has the sign opposite to the pressure's push on the piston",
            "it is positive when the rod pushes on the load cell; write scale = -1 if it is not",
        )
    elif error_taken > FORCE_RATIO * error_other:
        now, better = ("gauge", "absolute") if gauge else ("absolute", "gauge")
        yield record.finding(
            "warning",
            None,
            "chamber_pressure_lower",
            f"taken as {now} it misses the rod force by {error_taken:.3g} N, taken as {better} by "
            f"{error_other:.3g} N",
            f"check whether gauge = {'false' if gauge else 'true'} is right",
        )
