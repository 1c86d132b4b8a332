"""The data check: what is wrong with the records, said before anything is concluded from them.

Every check runs, so that one pass shows everything; nothing is repaired or dropped in silence.
An error means that the record cannot be used, a warning that it is used but should be looked at.
The limits below separate what a healthy rig shows from what a person would want to know.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from math import inf

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.errors import InputError
from sms.io import check_plant
from sms.io.plausible import (
    extension_range,
    force_against_pressure,
    pressure_range,
    usual_range,
)
from sms.io.records import Finding, Record, Severity
from sms.io.rig import Rig
from sms.io.schema import ModelTable
from sms.io.signals import is_pressure
from sms.io.unit_slips import unit_of_time

GAP = 5.0  #: times the median step of time
STEP_RANGE = (1e-6, 1.0)  #: s; a median step outside it is more likely a wrong unit of time
STUCK_SAMPLES, STUCK_SHARE = 50, 0.1  #: constant for so many samples, and this share of a record
TRAVEL_SHARE = 0.1  #: share of the range of extension that counts as motion, also for a stroke
SATURATED_RUN, SATURATED_SHARE = 10, 0.01  #: samples in a row at the extreme; share of a record
LEVELS = 20  #: a channel with fewer distinct values is coarse: it touches its extremes anyway
MOVING_SAMPLES, STROKES = 100, 2  #: the least that a fit can be judged on
SPEED_WINDOW = 5  #: samples either side of the rough speed used for counting only

_ORDER: dict[Severity, int] = {"error": 0, "warning": 1, "note": 2}


def check_record(rig: Rig, record: Record) -> tuple[Finding, ...]:
    """Everything found in one record, errors first; includes what was found while reading it."""
    checks = {"cylinder": _OF_CYLINDER, "flow_test": _OF_FLOW_TEST}.get(rig.kind, _OF_PLANT)
    findings = [*record.findings, *(f for check in checks for f in check(rig, record))]
    # What stands in one line comes before what is true of the whole: it is often the cause of it.
    return tuple(sorted(findings, key=lambda f: (_ORDER[f.severity], f.line or inf)))


def check_rig(rig: Rig) -> tuple[Finding, ...]:
    """Whether the rig has records to fit on and others to judge on; warnings of what its rig file says in vain."""
    findings = list(_without_effect(rig))
    for role, purpose in (("identify", "to fit on"), ("validate", "to judge on")):
        if all(record.role != role for record in rig.records):
            count = "only one record" if len(rig.records) == 1 else f"{len(rig.records)} records"
            findings.append(
                Finding(
                    "error",
                    rig.path,
                    None,
                    None,
                    f"{count} in [[records]] and none has the role '{role}', so there is nothing "
                    f"{purpose}",
                    f"add a record, or give one the role '{role}'",
                )
            )
    return tuple(findings)


def _without_effect(rig: Rig) -> Iterator[Finding]:
    """What is declared of the model or of a sensor, and has no effect on a rig of this kind."""
    of_friction = {"friction", "friction_map_uncertainty"}
    unused = {"cylinder": set(ModelTable.model_fields), "tank": of_friction}.get(rig.kind, set())
    for key in sorted(unused & rig.model.model_fields_set):
        message = f"[model] {key} has no effect on a {rig.kind}"
        yield Finding("warning", rig.path, None, None, message, "leave it out")
    if rig.kind == "cylinder":
        for name, source in rig.signals.items():
            if source.noise is not None:
                message = "its noise has no effect on a cylinder, whose noise is what differs from stroke to stroke"
                yield Finding("warning", rig.path, None, name, message, "leave it out")


def raise_if_unusable(findings: Sequence[Finding]) -> None:
    """Raise the first error among `findings` as an InputError that counts the others."""
    errors = [finding for finding in findings if finding.severity == "error"]
    if errors:
        more = f" (and {len(errors) - 1} more errors in the data)" if len(errors) > 1 else ""
        raise InputError(f"{errors[0]}{more}")


def raise_if_unreadable(record: Record, findings: Sequence[Finding]) -> None:
    """The same of what makes a file no record: cells that are no numbers, a clock that cannot be, too few samples."""
    raise_if_unusable([f for f in findings if f in record.findings or f.signal in ("time", None)])


def _time_order(rig: Rig, record: Record) -> Iterator[Finding]:
    """Time must run forward from sample to sample."""
    time = record.signals["time"]
    step = np.diff(time)
    for wrong, what in ((step < 0.0, "time runs backwards"), (step == 0.0, "time stands still")):
        remedy = "remove the line, or split the file where the clock was restarted"
        for places, severity, said in _apart(record, np.flatnonzero(wrong) + 1, "error", remedy):
            first = int(places[0])
            more = f" (and {places.size - 1} times more)" if places.size > 1 else ""
            message = f"{what}, {time[first]:g} s after {time[first - 1]:g} s{more}"
            yield record.finding(severity, first, "time", message, said)


def _apart(
    record: Record, places: NDArray[np.intp], severity: Severity, remedy: str
) -> Iterator[tuple[NDArray[np.intp], Severity, str]]:
    """Split places into those that are used and those within skip_first, which are only noted."""
    skipped = places < record.skipped
    if not np.all(skipped):
        yield places[~skipped], severity, remedy
    if np.any(skipped):
        yield places[skipped], "note", "not used, because it lies within skip_first"


def _time_steps(rig: Rig, record: Record) -> Iterator[Finding]:
    """Gaps, and a step that makes the unit of time doubtful."""
    time = record.signals["time"]
    step = np.diff(time)
    forward = step[step > 0.0]
    if forward.size == 0:
        return
    median = float(np.median(forward))
    if not STEP_RANGE[0] <= median <= STEP_RANGE[1]:
        yield record.finding(
            "warning",
            None,
            "time",
            f"the median step is {median:g} s, unlikely for a measurement",
            unit_of_time(rig, median),
        )
    gaps = np.flatnonzero(step > GAP * median) + 1
    remedy = "the samples on both sides are used; see whether something was lost"
    for places, severity, said in _apart(record, gaps, "warning", remedy):
        longest = int(places[np.argmax(step[places - 1])])
        what = "a gap" if places.size == 1 else f"{places.size} gaps, the longest one"
        message = (
            f"{what} of {step[longest - 1]:.3g} s just before this line "
            f"(median step {median:.3g} s)"
        )
        yield record.finding(severity, longest, "time", message, said)


def _range(values: Array) -> float:
    """Largest less smallest number; 0 when there is none."""
    return float(np.ptp(values[np.isfinite(values)])) if np.any(np.isfinite(values)) else 0.0


def _runs(values: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Start and length of every stretch of equal values; NaN is equal to nothing."""
    edges = np.flatnonzero(np.concatenate(([True], values[1:] != values[:-1])))
    return edges, np.diff(np.append(edges, values.size))


def _stuck(rig: Rig, record: Record) -> Iterator[Finding]:
    """A force or pressure that stays exactly constant over a long part while the rod moves."""
    extension = record.used("extension")
    motion = TRAVEL_SHARE * _range(extension)
    if motion == 0.0:
        return
    for signal in record.signals:
        if signal in ("time", "extension"):
            continue
        values = record.used(signal)
        starts, lengths = _runs(values)
        longest = int(np.argmax(lengths))
        start, length = int(starts[longest]), int(lengths[longest])
        if length < max(STUCK_SAMPLES, STUCK_SHARE * values.size):
            continue
        if _range(extension[start : start + length]) > motion:
            # A regulator with a coarse converter can hold a pressure; no seal holds a force.
            yield record.finding(
                "warning" if is_pressure(signal) else "error",
                start + record.skipped,
                signal,
                f"constant for {length} samples ({100 * length / values.size:.0f} % of the record) "
                "although the extension changes",
                "check the sensor and its cable, or leave this part out",
            )


def _saturated(rig: Rig, record: Record) -> Iterator[Finding]:
    """A channel that sits at its own largest or smallest value for many samples in a row."""
    for signal in record.signals:
        values = record.used(signal)
        if signal == "time" or np.unique(values[np.isfinite(values)]).size < LEVELS:
            continue
        starts, lengths = _runs(values)
        for extreme, name in ((np.nanmax(values), "largest"), (np.nanmin(values), "smallest")):
            at_extreme = values[starts] == extreme
            count = int(lengths[at_extreme].sum())
            longest = int(lengths[at_extreme].max())
            if longest < SATURATED_RUN or count < SATURATED_SHARE * values.size:
                continue
            start = starts[at_extreme & (lengths == longest)][0]
            end_stop = signal == "extension"
            yield record.finding(
                "note" if end_stop else "warning",
                int(start) + record.skipped,
                signal,
                f"sits at its {name} value for {count} samples, {longest} in a row",
                "an end stop does this; if it is none, check the sensor's range"
                if end_stop
                else "the sensor or its amplifier may be saturated; check its range",
            )


def _moving_samples(rig: Rig, time: Array, extension: Array) -> int:
    """How many samples move, by a rough speed over a window: for counting, not for comparing."""
    window = 2 * SPEED_WINDOW
    if time.size <= window:
        return 0
    change = np.abs(extension[window:] - extension[:-window])
    if rig.speed_above is None:
        return int(np.sum(change > 1e-3 * _range(extension)))
    return int(np.sum(change > rig.speed_above * (time[window:] - time[:-window])))


def _count_strokes(extension: Array) -> int:
    """Runs in one direction; a turn counts when it goes back by a tenth of the whole range."""
    least = TRAVEL_SHARE * _range(extension)
    if least == 0.0:
        return 0
    values: list[float] = extension[np.isfinite(extension)].tolist()
    strokes, direction, turning_point = 0, 0, values[0]
    for value in values:
        if direction and (value - turning_point) * direction >= 0.0:
            turning_point = value
        elif abs(value - turning_point) >= least:
            direction = 1 if value > turning_point else -1
            turning_point = value
            strokes += 1
    return strokes


def _too_short(rig: Rig, record: Record) -> Iterator[Finding]:
    """Too few samples in motion or too few strokes to tell friction from anything else."""
    extension = record.used("extension")
    moving = _moving_samples(rig, record.used("time"), extension)
    if moving < MOVING_SAMPLES:
        above = "" if rig.speed_above is None else f" faster than {1e3 * rig.speed_above:g} mm/s"
        yield record.finding(
            "error",
            None,
            None,
            f"too short: moving samples{above} seen: {moving}, needed: {MOVING_SAMPLES}",
            "record more strokes, or check speed_above, skip_first and the unit of extension",
        )
    strokes = _count_strokes(extension)
    if strokes < STROKES:
        yield record.finding(
            "error",
            None,
            None,
            f"too short: strokes seen: {strokes}, needed: {STROKES} (one each way)",
            "record the rod moving both ways",
        )


_Check = Callable[[Rig, Record], Iterable[Finding]]
_OF_CYLINDER: tuple[_Check, ...] = (
    _time_order,
    _time_steps,
    _stuck,
    _saturated,
    _too_short,
    pressure_range,
    usual_range,
    extension_range,
    force_against_pressure,
)
_OF_FLOW_TEST: tuple[_Check, ...] = (
    _time_order,
    _time_steps,
    pressure_range,
    usual_range,
)
"""What a record of a tank prevents is said by the identification (flow_record.py)."""
_OF_PLANT: tuple[_Check, ...] = (
    _time_order,
    _time_steps,
    check_plant.even_time,
    check_plant.long_enough,
    check_plant.dead_channels,
    check_plant.clipped_channels,
    check_plant.driven_channels_that_hardly_move,
    pressure_range,
    usual_range,
    check_plant.plausible_extensions,
)
"""Of a rig whose records a simulation is held against."""
