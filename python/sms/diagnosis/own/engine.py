"""An own model in the diagnosis: the same search and the same judgement as for the rigs of this project (simulated.py).

What the method asks of a rig (io/rig.py) and of a kind of rig (estimation/kind.py) is answered here from what the
model declares.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import cast

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.callbacks import Progress
from sms.diagnosis import preparation, simulated, wording
from sms.diagnosis.effects import catalogue
from sms.diagnosis.own.model import Effect, Model
from sms.diagnosis.own.records import Record, check
from sms.diagnosis.own.shooting import ShootingProblem, Stretch
from sms.diagnosis.result import Diagnosis, as_json
from sms.diagnosis.thresholds import FEWEST_WINDOWS
from sms.errors import InputError
from sms.estimation.kind import Kind
from sms.estimation.noise import sample_noise
from sms.estimation.problem import WindowProblem
from sms.estimation.run import Run
from sms.io.json_files import versions
from sms.io.rig import DataLayout, Declaration, Rig
from sms.io.write import write_text_atomically
from sms.parameters import Parameter
from sms.report.diagnosis import report_html
from sms.report.page import write_page


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


def diagnose_model(
    model: Model,
    records: Sequence[Record],
    window: float,
    seed: int = 1,
    progress: Progress = lambda text, done: None,
    empirical: bool = False,
) -> Diagnosis:
    """Find what a model gets wrong on its records, and why: the answer that `diagnose` gives for a rig file.

    window: s, how long it is simulated from one initial state; a few of the plant's own time constants, and a tenth of
    a record or less, since windows are what judgements count. seed and empirical as in `diagnose`. InputError for
    records that do not fit the model.
    """
    if not window > 0.0:
        raise InputError(f"{model.title}: window is {window:g} s; it must be positive")
    faults = check(model, records)
    rig = _rig_of(model)
    blank = Diagnosis(
        rig=model.title,
        title=model.title,
        findings=faults,
        records={r.name: r.role for r in records},
        seed=seed,
        versions=versions(),
    )
    if faults:
        return replace(blank, verdict="data-fault", sentence=wording.data_fault(faults))
    rng = np.random.default_rng(seed)
    runs = [_run_of(model, record) for record in records]
    noise = _noise_of(model, runs)
    model = _problem_of(model, runs, noise, window).with_fine_step()
    data = preparation.split(rig, _kind_of(model, window), runs, noise)
    fewest = min(len(part.problem.windows) for part in (data.identify, data.validate))
    if fewest < FEWEST_WINDOWS:
        raise InputError(
            f"{model.title}: the records of one role make {fewest} windows of {window:g} s; "
            f"{FEWEST_WINDOWS} are the least that can be judged on, so take a shorter window or more records"
        )
    effects = tuple(_effect_of(model, effect) for effect in model.effects)
    case = simulated.investigate(data, effects, rng, progress)
    return simulated.complete(blank, case, rng, progress, empirical)


def write_diagnosis(diagnosis: Diagnosis, out: Path) -> tuple[Path, Path]:
    """report.html and diagnosis.json in the folder `out`, made if need be."""
    out.mkdir(parents=True, exist_ok=True)
    page, data = out / "report.html", out / "diagnosis.json"
    write_page(page, report_html(diagnosis))
    write_text_atomically(data, as_json(diagnosis))
    return page, data


# ---- the model in the method's words ----------------------------------------------------------------


def _rig_of(model: Model) -> OwnRig:
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


def _kind_of(model: Model, window: float) -> Kind:
    unit_of = {s.equation: f"{s.unit}/s" for s in model.states if s.equation}
    signals = {s.name: s.unit for s in model.signals}

    def make_problem(
        rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
    ) -> WindowProblem:
        return cast(WindowProblem, _problem_of(model, runs, noise, window))

    return Kind(
        outputs=tuple(o.name for o in model.outputs),
        hidden={equation: unit_of[equation] for equation in model.equations},
        make_problem=make_problem,
        derived=lambda run: {},
        shown=tuple(signals),
        menu=(),
        units=signals | {"time": "s"},
        short=0.0,
        # Wider than that of machines whose simulations were held against others.
        practically_significant=(0.3, 0.6),
    )


def _problem_of(
    model: Model, runs: Sequence[Run], noise: Mapping[str, float], window: float
) -> ShootingProblem:
    stretches = [_stretch_of(model, run) for run in runs]
    return ShootingProblem(
        model, stretches, np.array([noise[o.name] for o in model.outputs]), window
    )


def _run_of(model: Model, record: Record) -> Run:
    signals = {s.name: np.asarray(record.signals[s.name], dtype=np.float64) for s in model.signals}
    shifts = {n: v - model.parameter(n).value for n, v in record.conditions.items()}
    time = np.asarray(record.signals["time"], dtype=np.float64)
    return Run(record.name, record.role, time, signals, frozenset(), shifts)


def _noise_of(model: Model, runs: Sequence[Run]) -> dict[str, float]:
    """Of one sample of each output: as declared, else from how neighbours differ."""
    return {
        o.name: max(
            o.noise or float(np.median([sample_noise(r.signals[o.name]) for r in runs])), 1e-300
        )
        for o in model.outputs
    }


def _stretch_of(model: Model, run: Run) -> Stretch:
    def columns(names: Sequence[str]) -> Array:
        return np.stack([run.signals[n] for n in names], axis=1) if names else np.empty((n_all, 0))

    n_all = len(run.time)
    guessed = dict(model.guess(run.signals)) if model.guess is not None else {}
    start = {s.name: np.full(n_all, s.start) for s in model.states}
    start |= {s.name: run.signals[s.name] for s in model.states if s.name in run.signals}
    start |= {n: np.asarray(v, dtype=np.float64) for n, v in guessed.items()}
    return Stretch(
        run.step,
        columns([i.name for i in model.inputs]),
        columns([o.name for o in model.outputs]),
        np.stack([start[s.name] for s in model.states], axis=1),
        run.conditions,
    )


def _effect_of(model: Model, effect: Effect) -> catalogue.Effect:
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
