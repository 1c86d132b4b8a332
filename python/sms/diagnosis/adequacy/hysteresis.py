"""Whether the valve remembers: a cause's size beside a play between command and spool.

A spool that sticks follows the command at a distance, on the side that it comes from. While every opening starts from
the centre that is hardly another thing than a wider dead band; but a dead band has one width both ways, and this one
opens late and closes late. A law of the catalogue knows no past. So the commands of the records are led through a play,
and the cause is asked for its size beside what that changes: a right one keeps it, one that stood in for the play
loses it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from sms.arrays import Array
from sms.diagnosis.adequacy.subset_estimates import (
    Estimate,
    beside,
    column_of,
    inflation_of,
    linear,
)
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted_with_slopes
from sms.diagnosis.thresholds import APART, APART_BY, LEAST_PLAY, PLAY
from sms.estimation.run import Run
from sms.estimation.windows import Runs


@dataclass(frozen=True)
class Hysteresis:
    """A cause that has hardly its size any more where the valve may have a play."""

    effect: Effect
    alone: float
    beside: Estimate
    play: Estimate
    """V to either side."""


def hysteresis(fitted: Fitted, effect: Effect, data: Data) -> Hysteresis | None:
    """The play that takes a cause's size, by ten standard errors and a fifth of it; None where there is none that is
    practically significant, or where the cause grows beside it."""
    gram, rows = np.zeros((3, 3)), 0
    for runs, at in ((data.identify, fitted), (data.validate, refitted_with_slopes(fitted, data))):
        played = _sensitivity(runs, at, effect)
        if played is None:
            return None
        both = np.column_stack([column_of(runs, at, effect), played])
        gram += beside(at, effect).gram(both)
        rows += len(both)
    found = linear(gram, rows)
    if found is None:
        return None
    (step, play), covariance = found
    error, play_error = np.sqrt(inflation_of(data) * np.diag(covariance))
    alone = fitted.params[effect.parameters[0]]
    shift = alone - data.rig.declared(effect.parameters[0]).value
    lost = -float(step) if shift > 0.0 else float(step)
    there = play > max(APART * play_error, LEAST_PLAY)
    if not there or lost < max(APART * error, APART_BY * abs(shift)):
        return None
    return Hysteresis(
        effect, alone, (float(alone + step), float(error)), (float(play), float(play_error))
    )


def _sensitivity(runs: Runs, at: Fitted, effect: Effect) -> Array | None:
    """(rows,): change of the residual per volt of play; None where no recorded command opens the valve."""
    leg = effect.parameters[0].partition(":")[2]
    names = [n for n in runs.motions[0].signals if n.startswith("valve_command") and leg in n]
    if any(
        n in runs.channels for n in names
    ):  # the controller is simulated, and its output compared
        return None
    if not names:
        return None
    motions = tuple(_with_play(run, names) for run in runs.motions)
    changed = replace(runs, motions=motions).problem.errors(at.params)
    return np.asarray((changed - runs.problem.errors(at.params)) / PLAY)


def _with_play(run: Run, names: list[str]) -> Run:
    return replace(run, signals=run.signals | {n: after_play(run.signals[n], PLAY) for n in names})


def after_play(command: Array, play: float) -> Array:
    """(n,): what follows a command (n,) and is pulled along where that is `play` away."""
    out, seat = np.empty_like(command), float(command[0])
    for k, driven in enumerate(command):
        seat = min(max(seat, driven - play), driven + play)
        out[k] = seat
    return out
