"""An own model in the words of the method, from what the model declares.

That is what the method asks of a rig (io/rig.py), of a kind of rig (estimation/kind.py) and of its catalogue.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import cast

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects import catalogue
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.own.model import Effect, Model, State, Values
from sms.diagnosis.own.records import Record, clipped
from sms.diagnosis.own.shooting import ShootingProblem, Stretch
from sms.estimation.kind import Kind
from sms.estimation.noise import sample_noise
from sms.estimation.problem import WindowProblem
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.declarations import Declaration
from sms.io.rig import DataLayout, Rig
from sms.parameters import Parameter


@dataclass(frozen=True)
class OwnRig(Rig):
    """The model's parameters as a rig file would declare them."""

    rows: Mapping[str, Parameter] = field(default_factory=dict)
    model_of_owner: Model | None = None

    def declared(self, name: str) -> Declaration:
        return self.parameters[name]

    @property
    def table(self) -> Mapping[str, Parameter]:
        return self.rows

    def start(self) -> _core.Params:
        assert self.model_of_owner is not None
        return cast(
            _core.Params, self.model_of_owner.values()
        )  # by name, and copied, is all it takes


def rig_of(model: Model) -> OwnRig:
    """Its parameters, as a rig file would declare them."""
    return OwnRig(
        path=Path(model.title),
        kind="own",
        title=model.title,
        notes="",
        layout=DataLayout("comma", None),
        skip_first=0,
        speed_above=None,
        signals={},
        parameters={p.name: Declaration(p.value, p.uncertainty, p.fit) for p in model.parameters},
        records=(),
        rows={
            p.name: Parameter(p.name, p.unit, p.lower, p.value, p.upper, p.uncertainty, "own", "")
            for p in model.parameters
        },
        model_of_owner=model,
    )


def kind_of(
    model: Model, window: float, noise: Mapping[str, float], at: Values | None = None
) -> Kind:
    """window: s, of the windows that judgements count. at: with these values, the states that are not measured are
    signals too, from the initial states that fit each window best.
    """
    unit_of = {s.equation: f"{s.unit}/s" for s in model.states if s.equation}
    signals = {s.name: s.unit for s in model.signals}

    def make_problem(
        rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
    ) -> WindowProblem:
        return cast(WindowProblem, problem_of(model, runs, noise, window))

    @cache
    def states_of(run: Run) -> dict[str, Array]:
        unmeasured = [] if at is None else _unmeasured(model)
        if at is None or not unmeasured:
            return {}
        problem = problem_of(model, [run], noise, window)
        _, states = problem.states(at)
        out = np.repeat(states[:1, :, 0], len(run.time), axis=0)
        for k, w in enumerate(problem.windows):
            out[w.first : w.first + w.samples] = states[: w.samples, :, k]
        place = {s.name: i for i, s in enumerate(model.states)}
        return {f"{s.name} [{s.unit}]": out[:, place[s.name]] for s in unmeasured}

    return Kind(
        outputs=tuple(o.name for o in model.outputs),
        hidden={equation: unit_of[equation] for equation in model.equations},
        make_problem=make_problem,
        derived=states_of,
        shown=tuple(signals),
        menu=(),
        units=signals | {"time": "s"},
        short=0.0,
        # Wider than that of machines whose simulations were held against others.
        practically_significant=(0.3, 0.6),
    )


def problem_of(
    model: Model, runs: Sequence[Run], noise: Mapping[str, float], window: float
) -> ShootingProblem:
    """The records as a problem, in units of the noise of each output."""
    stretches = [_stretch_of(model, run) for run in runs]
    return ShootingProblem(
        model, stretches, np.array([noise[o.name] for o in model.outputs]), window
    )


def run_of(model: Model, record: Record) -> Run:
    """A record, evenly sampled."""
    signals = {s.name: np.asarray(record.signals[s.name], dtype=np.float64) for s in model.signals}
    shifts = {n: v - model.parameter(n).value for n, v in record.conditions.items()}
    time = np.asarray(record.signals["time"], dtype=np.float64)
    at_end = clipped(model, record)
    return Run(record.name, record.role, time, signals, frozenset(), shifts, clipped=at_end)


def noise_of(model: Model, runs: Sequence[Run]) -> dict[str, float]:
    """Of one sample of each output: as declared, else from how neighbours differ."""
    return {
        o.name: max(o.noise or float(np.median([_noise_in(r, o.name) for r in runs])), 1e-300)
        for o in model.outputs
    }


def _noise_in(run: Run, output: str) -> float:
    at_end = run.clipped.get(output, np.zeros(len(run.time), dtype=bool))
    read = run.signals[output][~at_end]
    return sample_noise(read) if len(read) > 3 else 0.0


def _stretch_of(model: Model, run: Run) -> Stretch:
    def columns(names: Sequence[str]) -> Array:
        return np.stack([run.signals[n] for n in names], axis=1) if names else np.empty((n_all, 0))

    n_all = len(run.time)
    none = np.zeros(n_all, dtype=bool)
    at_end = [run.clipped.get(o.name, none) for o in model.outputs]
    start = {s.name: np.full(n_all, s.start) for s in model.states}
    start |= {s.name: run.signals[s.name] for s in model.states if s.name in run.signals}
    start |= model.guessed(run.time, run.signals)
    return Stretch(
        run.step,
        columns([i.name for i in model.inputs]),
        columns([o.name for o in model.outputs]),
        np.stack([start[s.name] for s in model.states], axis=1),
        run.conditions,
        run.window,
        np.stack(at_end, axis=1) if run.clipped else None,
    )


def with_states(data: Data, model: Model, window: float, at: Values) -> Data:
    """The records with the states that are not measured, as the model has them with these values.

    An error may follow them as it may follow a signal.
    """
    if not _unmeasured(model):
        return data
    kind = kind_of(model, window, data.identify.noise, at)

    def told(runs: Runs | None) -> Runs | None:
        return None if runs is None else replace(runs, kind=kind)

    identify, validate = replace(data.identify, kind=kind), replace(data.validate, kind=kind)
    return replace(data, identify=identify, validate=validate, test=told(data.test))


def values_of(fitted: Fitted) -> Values:
    """Its parameters: those of a plant of one's own, whatever the method calls them."""
    return cast(Values, fitted.params)


def _unmeasured(model: Model) -> list[State]:
    known = {s.name for s in model.signals}
    return [s for s in model.states if s.name not in known]


def effect_of(model: Model, effect: Effect) -> catalogue.Effect:
    """An effect as the catalogue has them."""
    p = model.parameter(effect.parameter)
    low, high = effect.plausible or (p.lower, p.upper)
    shifted = p.uncertainty > 0.0 or p.value != 0.0
    return catalogue.Effect(
        id=effect.id,
        signal=None,
        kind="shifted" if shifted else "missing",
        parameters=(effect.parameter,),
        block=effect.equation or "model",
        title=effect.title,
        cause=effect.cause,
        needs=(),
        plausible=(low - p.value, high - p.value) if shifted else (low, high),
        separated_by=effect.separated_by,
        step=effect.step,
        absolute=True,
    )
