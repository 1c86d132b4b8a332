"""A model run over a whole record, from its beginning to its end, never set right again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.diagnosis.own.as_rig import noise_of, problem_of, run_of
from sms.diagnosis.own.model import Model
from sms.diagnosis.own.records import Record, check_record
from sms.errors import InputError, did_you_mean

WHOLE = 1e9
"""s: a window longer than any record."""


@dataclass(frozen=True, eq=False)
class Simulation:
    """One record, simulated. Arrays (samples,), each in its unit of the model."""

    record: str
    time: Array
    """s, as recorded; it begins after the longest dead time of an input."""
    outputs: Mapping[str, Array]
    states: Mapping[str, Array]
    error: Mapping[str, float]
    """Output -> rms of simulated less measured; only outputs that the record has. NaN where the run diverges."""


def simulate(model: Model, record: Record, start: Mapping[str, float] | None = None) -> Simulation:
    """Run a model over a whole record with its declared values, and with the record's conditions.

    start: state -> its value at the beginning; left out: the initial state from which the run fits the record best, for
    which the record needs every output. InputError for a record that does not fit the model.
    """
    recorded = record.signals
    if start is not None:
        names = [s.name for s in model.states]
        for name in start:
            if name not in names:
                raise InputError(
                    f"{model.title}, start: there is no state '{name}'; {did_you_mean(name, names)}"
                )
        if missing := [n for n in names if n not in start]:
            raise InputError(
                f"{model.title}, start: there is no value of '{missing[0]}'; give every state one, or leave start out"
            )
        nothing = np.zeros(np.shape(recorded.get("time", [])))
        given = {o.name: recorded.get(o.name, nothing) for o in model.outputs}
        record = replace(record, signals=dict(recorded) | given)
    check_record(model, record)
    run = replace(run_of(model, record), window=WHOLE)
    noise = noise_of(model, [run])
    if model.longest_step is None and all(o.name in recorded for o in model.outputs):
        model = problem_of(model, [run], noise, WHOLE).with_fine_step()
    problem = problem_of(model, [run], noise, WHOLE)
    at = None if start is None else np.array([[start[s.name]] for s in model.states])
    outputs, states = problem.states(model.values(), at)
    samples = slice(problem.windows[0].first, None)
    there = {o.name: outputs[:, j, 0] for j, o in enumerate(model.outputs)}
    return Simulation(
        record.name,
        run.time[samples],
        there,
        {s.name: states[:, i, 0] for i, s in enumerate(model.states)},
        {
            n: _rms(
                values - run.signals[n][samples],
                run.clipped.get(n, np.zeros(len(run.time), bool))[samples],
            )
            for n, values in there.items()
            if n in recorded
        },
    )


def _rms(error: Array, left_out: NDArray[np.bool_]) -> float:
    kept = error[~left_out]
    return (
        float(np.sqrt(np.mean(kept**2)))
        if kept.size and np.all(np.isfinite(kept))
        else float("nan")
    )
