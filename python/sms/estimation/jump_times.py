"""When the commands of records jumped, which a logger that is slower than the controller does not tell.

The readings tell it. A jump comes up to a sampling period ahead of the sample that shows it, anywhere there as far as
is known before. It is an unknown of each jump beside the random inputs of the equations (discrepancy.py), and its mean,
given what the simulation leaves, is where the simulation has it from then on: from the middle of the period, steps of
Gauss and Newton's, more than one since a piston that a jump makes break away does not answer in proportion. What is
still not known remains a part of the discrepancy, as wide as before: another model may want another time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.estimation.problem import is_commanded
from sms.estimation.windows import Runs

STEPS = 2
"""Of Gauss and Newton. Run time: a third moves nine jumps in ten by less than 0.2 ms, of benches logged at 200 Hz."""


@dataclass(frozen=True)
class Jump:
    """A jump of a command, whose time is not known."""

    window: int
    number: int
    """Of the window's jumps."""
    record: int
    place: tuple[int, int]
    """The sample that shows it, and the command."""


def with_jump_times(runs: Runs, params: _core.Params) -> Runs:
    """The same records, whose commands jump when the readings of a machine with these parameters say."""
    jumps = _jumps_of(runs) if any(runs.jumping) else []
    if not jumps:
        return runs
    ahead = [np.zeros((len(run.time), _commands(runs))) for run in runs.motions]
    for jump in jumps:
        ahead[jump.record][jump.place] = 0.5 * runs.motions[jump.record].step
    for _ in range(STEPS):
        runs = _with(runs, ahead)
        residual, _none = runs.problem.evaluate(params)
        _move(ahead, jumps, runs, params, residual)
    return _with(runs, ahead)


def _jumps_of(runs: Runs) -> list[Jump]:
    simulation = runs.simulation
    if not is_commanded(simulation):
        return []
    samples = simulation.jump_samples()
    shown_in = {(w.record, w.first): s for w, s in zip(simulation.windows, samples, strict=True)}
    of_each = samples.shape[1] // _commands(runs)
    return [
        Jump(k, n, w.record, (int(sample), n // of_each))
        for k, w in enumerate(runs.problem.windows)
        for n, sample in enumerate(shown_in[w.record, w.first])
        if sample >= 0 and runs.jumping[w.record] > 0.0
    ]


def _commands(runs: Runs) -> int:
    return sum(name.startswith("valve_command") for name in runs.motions[0].signals)


def _with(runs: Runs, ahead: Sequence[Array]) -> Runs:
    motions = zip(runs.motions, ahead, strict=True)
    return replace(runs, motions=tuple(replace(run, ahead=a.copy()) for run, a in motions))


def _move(
    ahead: Sequence[Array],
    jumps: Sequence[Jump],
    runs: Runs,
    params: _core.Params,
    residual: Array,
) -> None:
    """One step from the residual (rows,)."""
    discrepancy = runs.discrepancy(params, residual)
    first = int(np.argmax(discrepancy.group == len(discrepancy.tau) - 1))
    at = np.zeros((len(discrepancy.rows), len(discrepancy.group)))
    for jump in jumps:
        middle, deviation = 0.5 * runs.motions[jump.record].step, runs.jumping[jump.record]
        at[jump.window, first + jump.number] = (ahead[jump.record][jump.place] - middle) / deviation
    found = discrepancy.expected(residual, at)
    for jump in jumps:
        step, deviation = runs.motions[jump.record].step, runs.jumping[jump.record]
        time = 0.5 * step + deviation * found[jump.window, first + jump.number]
        # Of a part of the record a period may be another in the last digit.
        ahead[jump.record][jump.place] = np.clip(time, 0.0, (1.0 - 1e-9) * step)
