"""What a segment says of every parameter and effect: scores and their information, and what is left of each signal.

A segment is held against the model as a record is in a diagnosis (estimation/windows.py): windows of a second from
the initial states that fit them best, residuals in units of the noise, whitened with the discrepancy that the
healthy machine leaves. With J the sensitivities of these innovations e to the numbers that may move and to the
effects, less what the initial states can imitate,

    score        J'e          one number each
    information  J'J

are sums over windows, so those of any stretch of time are sums over its segments. All that comes later needs no more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.effects.sensitivity import sensitivity_columns
from sms.estimation.discrepancy import KNOTS, Discrepancy
from sms.estimation.kind import Kind
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.records import Record
from sms.io.rig import RecordSource, Rig
from sms.watch.segments import Segment

NAME = "watched"
LEAST_ENERGY = 1e-6
"""Of the healthy mean square of white innovations: a reading that repeats to the digit leaves nothing. Numerics."""


@dataclass(frozen=True, eq=False)
class Scores:
    """Of one segment. k parameters that may move, then m effects."""

    begin: float
    end: float
    score: Array
    """(k + m,)"""
    information: Array
    """(k + m, k + m)"""
    energy: Array
    """(signals + equations,): logarithm of the mean square of each signal's innovations, and of the unknown input of
    each equation that would explain them, over what noise would make of it; NaN of what these rows cannot tell."""


def run_of(rig: Rig, kind: Kind, segment: Segment) -> Run:
    """A segment as the rig's problem takes it."""
    of_sensors = frozenset(s for s, source in rig.signals.items() if source.gauge)
    n = len(segment.signals["time"])
    record = Record(
        NAME,
        "identify",
        rig.path,
        dict(segment.signals),
        of_sensors & segment.signals.keys(),
        (),
        np.arange(n, dtype=np.int64),
    )
    return kind.make_run(as_watched(rig), record)


def as_watched(rig: Rig) -> Rig:
    """The rig with one record, what comes in now."""
    return replace(rig, records=(RecordSource(NAME, rig.path, "identify", control=rig.control),))


@dataclass(frozen=True)
class Innovations:
    """A model whose numbers are those of the healthy machine."""

    rig: Rig
    kind: Kind
    noise: dict[str, float]
    effects: Sequence[Effect]
    params: _core.Params
    names: Sequence[str]
    """Of the parameters that may move."""
    tau: Array
    """(equations,): standard deviations of the discrepancy (estimation/discrepancy.py)."""
    channels: Sequence[str] = field(default=())

    def of_segment(self, segment: Segment) -> Scores | None:
        """None where no window of it can be compared: every one has readings at the end of a sensor's range."""
        found = self.of_run(run_of(self.rig, self.kind, segment))
        return None if found is None else replace(found, begin=segment.begin, end=segment.end)

    def of_run(self, run: Run) -> Scores | None:
        """The same of a run."""
        runs = Runs(as_watched(self.rig), (run,), self.noise, self.kind)
        problem = runs.problem
        if problem.rows == 0:
            return None
        smooth = [e.parameters[0] for e in self.effects if e.step is None]
        wanted = list(dict.fromkeys([*self.names, *smooth]))
        residual, jacobian = problem.evaluate(self.params, wanted)
        columns = np.empty((problem.rows, len(self.names) + len(self.effects)))
        columns[:, : len(self.names)] = jacobian[:, [wanted.index(n) for n in self.names]]
        stepped = [e for e in self.effects if e.step is not None]
        by_step = iter(
            sensitivity_columns(problem, self.params, residual, stepped, self.rig.table).T
        )
        for k, effect in enumerate(self.effects, len(self.names)):
            columns[:, k] = (
                jacobian[:, wanted.index(effect.parameters[0])]
                if effect.step is None
                else next(by_step)
            )
        columns[~np.isfinite(columns)] = 0.0
        discrepancy = runs.discrepancy_of(self.params, self.tau)
        white = discrepancy.whitener.whiten
        residual, columns = white(residual), white(columns)
        return Scores(
            float(run.time[0]),
            float(run.time[-1]),
            columns.T @ residual,
            columns.T @ columns,
            np.concatenate(
                [
                    _of_signals(residual, runs, self.channels),
                    _of_equations(residual, discrepancy, len(self.kind.hidden)),
                ]
            ),
        )


def _of_signals(white: Array, runs: Runs, channels: Sequence[str]) -> Array:
    """(signals,)"""
    out = np.full(len(channels), np.nan)
    for k, name in enumerate(channels):
        if name in runs.channels:
            own = white[runs.channel == runs.channels.index(name)]
            out[k] = np.log(max(float(np.mean(own**2)), LEAST_ENERGY))
    return out


def _of_equations(white: Array, discrepancy: Discrepancy, equations: int) -> Array:
    """(equations,): the score of each equation's input at every knot, in units of what noise makes of it."""
    inputs = discrepancy.whitener.whiten(discrepancy.inputs[:, : equations * KNOTS])
    squares, of_noise = np.zeros(equations * KNOTS), np.zeros(equations * KNOTS)
    for rows in discrepancy.rows:
        squares += (inputs[rows].T @ white[rows]) ** 2
        of_noise += np.sum(inputs[rows] ** 2, axis=0)
    by_equation = (v.reshape(equations, KNOTS).sum(axis=1) for v in (squares, of_noise))
    energy, expected = by_equation
    out = np.full(equations, np.nan)
    felt = expected > 0.0
    out[felt] = np.log(np.maximum(energy[felt] / expected[felt], LEAST_ENERGY))
    return out
