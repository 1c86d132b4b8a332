"""Free runs over whole records: what a simulation that is never set right again is worth.

Windows of a second say which equation is wrong; a user simulates for longer. So each record that was not fitted is
simulated from its beginning to its end as one window, from the initial state that fits it best, with every fitted value
held. Under a platform, masses and weights are evaluated along the measured path, as in the windows.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sms.arrays import Array
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.result import FreeRun
from sms.diagnosis.thresholds import INSIDE
from sms.estimation.divergence import LARGEST
from sms.estimation.windows import Runs
from sms.io.signals import without_leg

WHOLE = 1e9
"""s: a window longer than any record."""


def free_runs(baseline: Fitted, extended: Fitted, data: Data) -> tuple[FreeRun, ...]:
    """Of the records of the roles validate and test, signal by signal; none of a rig that is not simulated."""
    parts = [part for part in (data.validate, data.test) if part is not None and part.whitened]
    return tuple(run for part in parts for run in _of_role(part, baseline, extended))


def _of_role(part: Runs, baseline: Fitted, extended: Fitted) -> list[FreeRun]:
    motions = tuple(replace(run, window=WHOLE) for run in part.motions)
    whole = replace(part, motions=motions, complete=True)
    errors = [whole.problem.errors(fitted.params) for fitted in (baseline, extended)]
    found = []
    for number, run in enumerate(motions):
        notes = _note(whole, number, errors[0]), _note(whole, number, errors[1])
        for c, channel in enumerate(whole.channels):
            if whole.compares(run, channel):
                scale = whole.noise[channel]
                before, after = (scale * _rms(whole, number, c, e) for e in errors)
                unit = whole.kind.units[channel]
                found.append(FreeRun(run.name, channel, unit, before, after, *notes, run.role))
    return found


def _rms(whole: Runs, record: int, channel: int, errors: Array) -> float:
    """In units of the noise, clipped readings left out; NaN where the run diverges."""
    rows = (whole.record == record) & (whole.channel == channel)
    if _diverges(errors[whole.record == record]).any():
        return float("nan")
    clipped = whole.motions[record].clipped.get(whole.channels[channel])
    if clipped is not None:
        rows[rows] = ~clipped[whole.sample[rows]]
    return float(np.sqrt(np.mean(errors[rows] ** 2))) if rows.any() else float("nan")


def _diverges(errors: Array) -> Array:
    return np.asarray(~(np.abs(errors) < LARGEST))


def _note(whole: Runs, record: int, errors: Array) -> str:
    """Where a run diverges or leaves the stroke, as a clause; empty where it does neither."""
    rows, run = np.flatnonzero(whole.record == record), whole.motions[record]
    time = run.time[whole.sample[rows]] - run.time[0]
    if (gone := _diverges(errors[rows])).any():
        return f"diverges at {time[int(np.argmax(gone))]:.2f} s"
    if whole.rig.kind == "own":  # what a plant of one's own calls an extension has no stroke
        return ""
    stroke = whole.rig.declared("stroke").value
    leaves = np.inf
    for c, channel in enumerate(whole.channels):
        if without_leg(channel) != "extension":
            continue
        own, noise = whole.channel[rows] == c, whole.noise[channel]
        read = run.signals[channel][whole.sample[rows]][own]
        if min(read.min(), stroke - read.max()) < INSIDE * noise:
            continue
        simulated = read + noise * errors[rows][own]
        if (beyond := (simulated < 0.0) | (simulated > stroke)).any():
            leaves = min(leaves, float(time[own][int(np.argmax(beyond))]))
    return f"leaves the stroke at {leaves:.2f} s" if np.isfinite(leaves) else ""
