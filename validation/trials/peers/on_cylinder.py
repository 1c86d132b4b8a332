"""A trial on the virtual cylinder: the diagnosis, the best AIC, and the question for the peers."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from sms.diagnosis import diagnose
from sms.diagnosis.effects.catalogue import catalogue
from sms.diagnosis.fitting import fit, residual_of
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.pipeline import read_and_check
from sms.diagnosis.preparation import make_data
from sms.diagnosis.result import Diagnosis
from sms.diagnosis.selection.identifiability import identifiable
from sms.estimation.windows import Runs
from sms.io.rig import load_rig

from validation.trials.cylinder import some_effect
from validation.trials.peers.candidates import best_by_aic
from validation.trials.peers.exchange import Array, Part, Question
from validation.trials.peers.scoring import Said
from validation.twins.cylinder import effects
from validation.twins.cylinder.draw import draw, open_truth

INPUTS = ("extension [m]", "velocity [m/s]", "direction", "chamber_pressure_lower [Pa]")
NAMES = ("extension", "velocity", "direction", "pressure")
MEANING = {
    "1": ("direction_dependent_friction", "sensor_offset:rod_force", "sensor_offset:chamber_pressure_lower"),
    "pressure": ("sensor_gain:rod_force", "sensor_gain:chamber_pressure_lower"),
    "direction*pressure": ("pressure_dependent_friction",),
    "direction*extension": ("position_dependent_friction",),
}  # fmt: skip
"""What a reader of a sparse model would take its terms for; the others have no name."""
FITTED_ANYWAY = ("direction", "velocity")
"""Terms of the baseline itself: a remainder of them names nothing."""


def hidden_for(seed: int, sort: str) -> str:
    if sort == "healthy":
        return effects.NONE.key
    if sort == "catalogue":
        return some_effect(seed)
    outside = [e.key for e in effects.OUT_OF_CATALOGUE]
    return outside[int(np.random.default_rng([seed, 7]).integers(len(outside)))]


def ask(seed: int, sort: str, multiple: float) -> tuple[list[Said], Question]:
    """Draw, diagnose, compare; the truth is opened at the end."""
    trial = f"{sort}-{seed}"
    with tempfile.TemporaryDirectory() as folder:
        records, sealed = Path(folder) / "records", Path(folder) / "sealed" / "truth.json"
        sealed.parent.mkdir()
        draw(seed, records, sealed, hidden_for(seed, sort), multiple)
        answer = diagnose(records / "rig.toml", seed=seed)
        rig = load_rig(records / "rig.toml")
        read, _ = read_and_check(rig)
        data = make_data(rig, read)
        truth = open_truth(sealed, records)
    hidden = truth["effect"] if truth["signal"] is None else f"{truth['effect']}:{truth['signal']}"
    baseline = fit(baseline_hypothesis(data, catalogue()), data.identify)
    able, _ = identifiable(baseline, data, catalogue())
    said = [
        said_by_diagnosis(answer, trial, sort, hidden),
        best_by_aic(baseline, data, able, trial, sort, hidden),
    ]
    return said, question_of(baseline, data)


def said_by_diagnosis(answer: Diagnosis, trial: str, sort: str, hidden: str) -> Said:
    """The product's verdict in the table's words."""
    named = tuple(
        tuple(
            dict.fromkeys(
                e if s is None else f"{e}:{s}"
                for e, s in ((c.effect, c.signal), *((a.effect, a.signal) for a in c.alternatives))
            )
        )
        for c in answer.causes
    )
    after = np.mean([(g.extended_rms / _noise(g.baseline_rms)) ** 2 for g in answer.gain])
    gain = 1.0 - float(np.sqrt(after)) if answer.causes else 0.0
    return Said("sms diagnose", trial, sort, hidden, named, answer.verdict != "no-evidence", gain)


def _noise(value: float) -> float:
    return max(value, 1e-300)


def question_of(baseline: Fitted, data: Data) -> Question:
    """Residuals of the baseline, in units of their standard deviation on the identify records."""
    scale = float(np.std(baseline.fit.residual))

    def part(runs: Runs, residual: Array) -> Part:
        inputs = np.column_stack([runs.inputs[name] for name in INPUTS])
        series = runs.record.astype(np.int64)
        return Part(-residual / scale, inputs, series, np.zeros(len(residual), dtype=np.int64))

    return Question(
        NAMES,
        part(data.identify, baseline.fit.residual),
        part(data.validate, residual_of(data.validate, baseline.params)),
    )


def named_by_terms(terms: list[str]) -> tuple[tuple[str, ...], ...]:
    """The findings behind a sparse model's terms; a term without a meaning is a finding without a name."""
    found = [MEANING.get(t, ()) for t in terms if t not in FITTED_ANYWAY]
    return tuple(dict.fromkeys(found))
