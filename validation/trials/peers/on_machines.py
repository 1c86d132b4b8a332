"""A blind trial on a virtual machine by every method: the same sealed records, one truth, opened at the end.

The peers get what the diagnosis has before it looks at its catalogue: the fitted baseline, the errors of its readings,
and what each equation lacks when it is fed with measured signals. A term that a peer finds in an equation is carried
along in the simulation to first order, as the diagnosis does with the curve of an unknown.
"""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from sms.diagnosis.adequacy.lack_of_fit import lack_of_fit
from sms.diagnosis.effects.catalogue import Effect, effects_of
from sms.diagnosis.fitting import nuisance_of
from sms.diagnosis.hypothesis import Fitted
from sms.diagnosis.localisation.equation_error import Fed, errors_of
from sms.diagnosis.localisation.signal_functions import belong_together, leg_of
from sms.diagnosis.localisation.unknown_inputs import with_curve, with_terms
from sms.diagnosis.other_records import refitted
from sms.diagnosis.selection.identifiability import identifiable
from sms.diagnosis.simulated import Case
from sms.diagnosis.thresholds import AVERAGE, ENDS
from sms.estimation.run import Run
from sms.estimation.windows import Runs

from validation.trials.answers import answered, key_of
from validation.trials.machines import Task, hide, outcome_of, taken
from validation.trials.peers.candidates import chosen_by_aic, single_causes
from validation.trials.peers.exchange import Array, Averages, Equation, Part, PlantAnswer, Question
from validation.trials.scoring import BLOCKS, Outcome
from validation.twins.draw import open_truth

US = "sms diagnose"
NOT_FOLLOWED = ("time", "setpoint", "supply")
"""Signals that hardly move, or that no term can follow."""


@dataclass(frozen=True)
class Opinion:
    """What one method says of one trial."""

    method: str
    named: list[list[str]]
    """The members of each named cause."""
    alarm: bool
    strength: float
    """What the alarm goes by, in a unit of the method's own."""
    equations: list[str]
    """Where it sees the error: "force", "flow", "supply", "reading"."""
    gain: float | None
    """Part of the excess that it takes on the records it has not seen; None for a method that corrects nothing."""
    seconds: float | None
    """Of processor time, beyond the baseline's fit for those that do not fit it again; None where fits are shared."""


@dataclass(frozen=True)
class Round:
    """One trial by every method."""

    outcome: Outcome
    sits_in: list[str]
    """Equations in which what is hidden sits; none for a reading."""
    opinions: list[Opinion]


AskPeers = Callable[[Question], dict[str, PlantAnswer]]


def play(task: Task, ask: AskPeers) -> Round:
    """Hide, ask everyone, open."""
    with tempfile.TemporaryDirectory() as folder:
        records, sealed = Path(folder) / "records", Path(folder) / "sealed" / "truth.json"
        hide(task, records, sealed)
        answer = answered(records, task.seed)
        opinions = asked(answer.case, ask)
        outcome = outcome_of(task, answer, open_truth(sealed, records))
    return Round(outcome, _sits_in(answer.case, outcome), [ours(answer.case, outcome), *opinions])


def asked(case: Case, ask: AskPeers) -> list[Opinion]:
    """What every other method says of the records of a case."""
    opinions = [*_by_aic(case)]
    question, seconds = question_of(case)
    return [*opinions, *(_of_peer(m, said, case, seconds) for m, said in ask(question).items())]


def ours(case: Case, outcome: Outcome) -> Opinion:
    """What the diagnosis says."""
    by_key = {key_of(e): e for e in effects_of(case.data.rig)}
    equations = [equation_of(by_key[k]) for members in outcome.named for k in members]
    if outcome.block:
        equations = [_equation(outcome.block)]
    gain = _of_curve(case) if case.verdict == "unknown" else outcome.gain
    return Opinion(
        US,
        outcome.named,
        case.verdict != "no-evidence",
        case.before.total,
        list(dict.fromkeys(equations)),
        gain,
        outcome.seconds,
    )


def _of_curve(case: Case) -> float:
    """What the curve of an unknown is worth as an empirical term (sms diagnose --empirical)."""
    runs = case.data.validate
    there = refitted(case.baseline, case.data)
    shape = case.where(np.random.default_rng(1)).shape
    added = with_curve(runs, nuisance_of(there), there.params, shape)
    return _share(case, there.fit.residual + added)


# ---- where an effect sits ------------------------------------------------------------------

_OF_BLOCK = {
    "force": "force",
    "mechanism": "force",
    "valve": "flow",
    "chamber": "flow",
    "supply": "supply",
}
_OF_ID = {"command_delay": "flow", "backlash": "reading", "frame_compliance": "reading"}
"""Where the block of the catalogue is not an equation of the plant."""


def equation_of(effect: Effect) -> str:
    """Of the plant, in which an effect of the catalogue sits."""
    return _OF_ID.get(effect.id) or _OF_BLOCK.get(effect.block, "reading")


def _equation(name: str) -> str:
    """ "flow of the lower chamber" -> "flow"."""
    if "supply" in name:
        return "supply"
    return next((e for e in ("force", "flow") if name.startswith(e)), "reading")


def _sits_in(case: Case, outcome: Outcome) -> list[str]:
    by_key = {key_of(e): e for e in effects_of(case.data.rig)}
    found = []
    for key in outcome.hidden:
        equation = BLOCKS.get(key) or (equation_of(by_key[key]) if key in by_key else "reading")
        # What the supply does wrong is seen in the flows.
        found += ["supply", "flow"] if equation == "supply" else [equation]
    return [e for e in dict.fromkeys(found) if e != "reading"]


# ---- the best of the same candidates -------------------------------------------------------


def _by_aic(case: Case) -> Iterator[Opinion]:
    """Samples counted as they come, and as many as they are worth."""
    data = case.data
    fits = _single_causes(case)
    for method, independent in (("best AIC", True), ("best AIC, effective samples", False)):
        effect, fitted, margin = chosen_by_aic(
            case.baseline, fits, data.identify, independent=independent
        )
        yield Opinion(
            method,
            [[key_of(effect)]] if effect else [],
            effect is not None,
            margin,
            [equation_of(effect)] if effect else [],
            taken(case, lack_of_fit(fitted, data)),
            None,
        )


def _single_causes(case: Case) -> list[tuple[Effect, Fitted]]:
    """The fits of the first round; where there was none, of the effects that promise most by a linear step."""
    if case.outcome.rounds:
        trials = case.outcome.rounds[0].trials
        if fits := [(t.effect, t.fitted) for t in trials if t.fitted is not case.baseline]:
            return fits
    able, _ = identifiable(case.baseline, case.data, effects_of(case.data.rig))
    return single_causes(case.baseline, case.data, able)


# ---- the question --------------------------------------------------------------------------


def question_of(case: Case) -> tuple[Question, float]:
    """What the peers get, and the processor time that it takes to make it beyond the baseline's fit."""
    data, begin, baseline = case.data, time.process_time(), case.baseline
    identify, validate = data.identify, data.validate
    there = refitted(baseline, data)
    names = [n for n in identify.inputs if not n.startswith(NOT_FOLLOWED)]
    found = {
        role: _lacking(runs, fitted)
        for role, runs, fitted in (("identify", identify, baseline), ("validate", validate, there))
    }
    question = Question(
        tuple(names),
        _part(identify, baseline, names),
        _part(validate, there, names),
        tuple(
            Equation(name, tuple(found["identify"][name]), tuple(found["validate"][name]))
            for name in found["identify"]
        ),
    )
    return question, time.process_time() - begin


def _part(runs: Runs, fitted: Fitted, names: Sequence[str]) -> Part:
    inputs: Array = np.column_stack([runs.inputs[name] for name in names])
    series = runs.block * len(runs.channels) + runs.channel
    return Part(-fitted.fit.residual, inputs, series, runs.channel)


def _lacking(runs: Runs, fitted: Fitted) -> dict[str, list[Averages]]:
    """Equation -> what it lacks in each record, beside the signals of its own leg."""
    equations = runs.kind.equations
    assert equations is not None
    fed, left = errors_of(runs, fitted, equations)
    return {
        name: [
            Averages(_inputs(f, name, runs), f.missing(k, left[k][record]), f.factor[k])
            for record, f in enumerate(fed)
        ]
        for k, name in enumerate(equations.units(runs.channels))
    }


def _inputs(fed: Fed, equation: str, runs: Runs) -> Array:
    signals = _signals(fed.run, runs)
    own = [
        n for n in signals if belong_together(equation, n) and (leg_of(n) or not leg_of(equation))
    ]
    return np.asarray(fed.mean @ np.column_stack([signals[n] for n in own or signals]))


def _signals(run: Run, runs: Runs) -> dict[str, Array]:
    every = {n: v for n, v in run.signals.items() if not n.startswith(NOT_FOLLOWED)}
    return every | runs.kind.derived(run)


# ---- the answers ---------------------------------------------------------------------------


def _of_peer(method: str, said: PlantAnswer, case: Case, seconds: float) -> Opinion:
    gain = None
    if method != "whiteness":
        gain = _of_readings(case, said.after) if said.after else _of_terms(case, said.terms)
    equations = [_equation(said.equation)] if said.equation else []
    return Opinion(method, [], said.alarm, said.strength, equations, gain, said.seconds + seconds)


def _share(case: Case, after: Array) -> float:
    """Part of the excess that is taken on the unseen records."""
    runs = case.data.validate
    left = [float(np.mean(after[runs.channel == c] ** 2)) for c in range(len(runs.channels))]
    return _of_readings(case, left)


def _of_readings(case: Case, left: Sequence[float]) -> float:
    before = float(np.mean(case.before.validate))
    after = float(np.mean(np.asarray(left) / case.before.floor - 1.0))
    return 1.0 - max(after, 0.0) / max(before, 1e-9)


def _of_terms(case: Case, terms: dict[str, list[list[float]]]) -> float:
    """The terms carried along in the simulation; one that makes the unseen records worse is left out."""
    runs = case.data.validate
    there = refitted(case.baseline, case.data)
    nuisance = nuisance_of(there)
    best, after = 0.0, there.fit.residual
    for equation, of_records in terms.items():
        values = [
            np.interp(run.time - run.time[0], *_over_time(term))
            for run, term in zip(runs.motions, of_records, strict=True)
        ]
        added = with_terms(runs, nuisance, there.params, {equation: runs.covariate(values)})
        gain = _share(case, after + added)
        if gain > best:
            best, after = gain, after + added
    return best


def _over_time(term: Sequence[float]) -> tuple[Array, Array]:
    """Times and values of averages over a record."""
    time: Array = ENDS + AVERAGE * (0.5 + np.arange(len(term), dtype=np.float64))
    return time, np.asarray(term, dtype=np.float64)


# ---- many ----------------------------------------------------------------------------------


def load(file: Path) -> list[Round]:
    """The trials in a file of JSON lines; a last line that was cut off is left out."""
    found = []
    for line in file.read_text().splitlines() if file.exists() else []:
        try:
            found.append(_round(json.loads(line)))
        except (ValueError, TypeError, KeyError):
            continue
    return found


def _round(content: dict[str, Any]) -> Round:
    opinions = [Opinion(**o) for o in content["opinions"]]
    return Round(Outcome(**content["outcome"]), content["sits_in"], opinions)


def play_all(
    wanted: Sequence[Task], file: Path, ask: AskPeers, each: Callable[[], None]
) -> list[Round]:
    """Every trial that is not in the file yet, each written as it comes. All of them, by seed."""
    have = {
        (r.outcome.seed, r.outcome.sort, r.outcome.multiple, r.outcome.kind): r for r in load(file)
    }
    file.parent.mkdir(parents=True, exist_ok=True)
    rounds = []
    with file.open("a") as log:
        for task in wanted:
            found = have.get((task.seed, task.sort, task.multiple, task.kind))
            if found is None:
                found = play(task, ask)
                log.write(json.dumps(asdict(found)) + "\n")
                log.flush()
            rounds.append(found)
            each()
    return sorted(rounds, key=lambda r: r.outcome.seed)
