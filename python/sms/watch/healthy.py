"""The machine when it is well: its numbers, and how its scores scatter.

First the model is fitted, as to the reference records of a diagnosis (diagnosis/reference.py): numbers, how nearly
they are known, and the discrepancy that is left. Then every healthy segment is scored there. Of the effects' scores
goes what the parameters that may move can imitate,

    U = -(score_e - A score_n),   A = M_en (M_nn + P / n)^-1

M is the mean information of a segment, P what is known of the parameters (a joint covariance from the healthy
records, and a change from day to day), n the segments of a minute. An effect of size b adds K b to U, K = M_ee - A
M_ne of the very segments; white innovations scatter by V = M_ee - 2 A M_ne + A M_nn A'. A machine that the model
fits roughly is not white: its U / K has a mean b_H, and U - b_H K a variance c V, with c the largest over blocks of
one to eight segments, 5 to 40 s. Where a block of eight explains it, the variance is known only as well as so many
blocks tell (`Baseline.freedom`).

The energies of signals and equations are taken as further tests with K = V = 1 a segment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sms.arrays import Array, Index
from sms.callbacks import Progress
from sms.diagnosis.effects.catalogue import Effect, effects_of
from sms.diagnosis.fitting import weights_of
from sms.diagnosis.hypothesis import Data, Hypothesis, baseline_hypothesis
from sms.diagnosis.reference import from_reference
from sms.diagnosis.selection.candidates import room_of
from sms.diagnosis.thresholds import DETECTION
from sms.errors import InputError
from sms.estimation.block_statistics import covariance_from
from sms.estimation.noise import noise_of
from sms.estimation.nuisance import Nuisance
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.rigs.kinds import kind_of
from sms.watch.innovations import Innovations, Scores, as_watched, run_of
from sms.watch.segments import SEGMENT, Segment

BLOCKS = (1, 2, 4, 8)
"""Segments in a row over which scatter is measured: of a signal that wanders for a minute it would still be too
small, and of longer blocks ten minutes hold too few."""
LEAST = 24
"""Healthy segments at least: three of the longest blocks. Two minutes."""
FIT_LENGTH = 60.0
"""s of healthy rows that the model is fitted to, evenly chosen. Run time: a fit is as long as a minute of it."""
MINUTE = round(60.0 / SEGMENT)
"""Segments within which an effect is to be seen."""


@dataclass(frozen=True)
class Test:
    """What is looked at."""

    name: str
    effect: Effect | None
    """None: an energy."""
    low: bool
    high: bool
    """Whether the size may fall, and rise."""
    unit: str = ""
    room: tuple[float, float] = (-np.inf, np.inf)
    """By how much the size may plausibly change."""
    of: str = ""
    """"signal" or "equation" of an energy."""


@dataclass(frozen=True, eq=False)
class Sums:
    """Of one segment: what the tests go by, t = effects, then energies."""

    begin: float
    end: float
    shift: Array
    """(t,): U"""
    response: Array
    """(t,): K"""
    variance: Array
    """(t,): V"""


@dataclass(frozen=True, eq=False)
class Baseline:
    """The healthy machine as segments are judged against it. Arrays (t,)."""

    innovations: Innovations
    tests: Sequence[Test]
    kept: Index
    """(m,) places of the effects among those of the innovations."""
    imitated: Array
    """(m, k): A"""
    mean: Array
    """b_H"""
    mean_variance: Array
    """Of b_H for white innovations: V / K^2 of all healthy segments."""
    inflation: Array
    """c"""
    freedom: Array
    """Blocks that told c, less one."""
    segments: int
    begin: float
    end: float
    not_watched: Sequence[str] = ()
    """Effects that these rows cannot show, each with why."""

    def sums(self, scores: Scores) -> Sums:
        """What the tests go by."""
        k = len(self.innovations.names)
        return _sums(scores, k, self.kept, self.imitated)

    def error(self, response: Array, variance: Array) -> Array:
        """(t,): standard error of a size from segments with these sums of K and V, that of b_H included."""
        with np.errstate(divide="ignore", invalid="ignore"):
            own = variance / response**2
        return np.asarray(np.sqrt(self.inflation * (own + self.mean_variance)))


def _sums(scores: Scores, k: int, kept: Index, imitated: Array) -> Sums:
    place = k + kept
    score_e, score_n = scores.score[place], scores.score[:k]
    m_ee = scores.information[np.ix_(place, place)]
    m_en = scores.information[np.ix_(place, np.arange(k))]
    m_nn = scores.information[:k, :k]
    undone = np.sum(imitated * m_en, axis=1)
    response = np.diag(m_ee) - undone
    variance = response - undone + np.einsum("ik,kl,il->i", imitated, m_nn, imitated)
    known = np.isfinite(scores.energy).astype(np.float64)
    return Sums(
        scores.begin,
        scores.end,
        np.concatenate([imitated @ score_n - score_e, np.nan_to_num(scores.energy)]),
        np.concatenate([response, known]),
        np.concatenate([np.maximum(variance, 0.0), known]),
    )


# ---- learning ------------------------------------------------------------------------------------


def learn(
    rig: Rig, segments: Sequence[Segment], progress: Progress = lambda text, done: None
) -> Baseline:
    """The baseline of a machine that was well in all of these segments.

    InputError for too few of them, or a rig of a kind that has no windows.
    """
    kind = kind_of(rig)
    if not kind.whitened:
        raise InputError(
            f"{rig.path}: a {rig.kind} is compared stroke by stroke, after a record is complete; "
            "sms watch is for bench, platform and tank"
        )
    if len(segments) < LEAST:
        raise InputError(
            f"{len(segments) * SEGMENT:g} s of the healthy machine say too little of how its readings scatter; "
            f"{LEAST * SEGMENT:g} s at least, ten minutes are good: give a longer --learn"
        )
    progress("fitting the model to the healthy machine", 0.0)
    runs = [run_of(rig, kind, s) for s in segments]
    rig = _holding(rig, runs[0])
    watched = as_watched(rig)
    noise = noise_of(rig, kind, runs)
    effects = [e for e in effects_of(rig) if not e.not_measured(runs[0].signals)]
    chosen = _evenly(runs, round(FIT_LENGTH / SEGMENT))
    together = Runs(watched, chosen, noise, kind)
    data = Data(watched, together, together, reference=together)
    machine, data = from_reference(baseline_hypothesis(data, effects), data)
    assert data.healthy is not None
    innovations = Innovations(
        rig,
        kind,
        noise,
        effects,
        machine.start,
        tuple(machine.free),
        data.healthy.identify.tau,
        together.channels,
    )
    scores = []
    for number, segment in enumerate(segments):
        progress("learning how its readings scatter", 0.4 + 0.6 * number / len(segments))
        found = innovations.of_segment(segment)
        if found is not None:
            scores.append(found)
    return baseline_of(innovations, machine, scores)


def _holding(rig: Rig, run: Run) -> Rig:
    """The rig with what its commands do between samples said, that no segment is taken otherwise than the first."""
    signals = {
        n: replace(s, hold=run.hold) if n.startswith("valve_command") else s
        for n, s in rig.signals.items()
    }
    return replace(rig, signals=signals)


def _evenly(runs: Sequence[Run], count: int) -> tuple[Run, ...]:
    places = np.unique(np.linspace(0, len(runs) - 1, min(count, len(runs))).round().astype(int))
    return tuple(runs[k] for k in places)


def baseline_of(
    innovations: Innovations, machine: Hypothesis, scores: Sequence[Scores]
) -> Baseline:
    """From the scores of healthy segments. InputError where too few can be compared."""
    if len(scores) < LEAST:
        raise InputError(
            f"of the healthy machine only {len(scores)} segments can be compared, {LEAST} are needed: in the others "
            "a reading sits at the end of its range; choose a sensor of another range, or a longer --learn"
        )
    mean = np.mean([s.information for s in scores], axis=0)
    imitated = imitated_by(machine, innovations.effects, mean)
    every = np.arange(len(innovations.effects), dtype=np.int64)
    k = len(innovations.names)
    whole = [_sums(s, k, every, imitated) for s in scores]
    tests, kept, reasons = _tests(innovations, mean, whole)
    of_effects = np.array(kept, dtype=np.int64)
    sums = [_sums(s, k, of_effects, imitated[of_effects]) for s in scores]
    shift, response, variance = (
        np.array([getattr(s, name) for s in sums]) for name in ("shift", "response", "variance")
    )
    total = response.sum(axis=0)
    told = total > 0.0
    total = np.where(told, total, np.inf)
    b = shift.sum(axis=0) / total
    inflation, freedom = scatter(shift - b * response, variance)
    return Baseline(
        innovations,
        tests,
        of_effects,
        imitated[of_effects],
        b,
        variance.sum(axis=0) / total**2,
        np.where(told, inflation, np.inf),
        freedom,
        len(scores),
        scores[0].begin,
        scores[-1].end,
        reasons,
    )


def imitated_by(machine: Hypothesis, effects: Sequence[Effect], mean: Array) -> Array:
    """(effects, k): A of each effect, its own parameter kept out of those that may move. mean: information (k + m,
    k + m) of a segment."""
    names = list(machine.free)
    k = len(names)
    off = Nuisance(names, np.zeros((0, k)), weights_of(machine, names), np.zeros(k))
    out = np.zeros((len(effects), k))
    for row, effect in enumerate(effects):
        own = [n for n in effect.parameters if n in names]
        others = np.array([i for i, n in enumerate(names) if n not in own], dtype=np.int64)
        pull = off.without(*own).pull
        known = mean[np.ix_(others, others)] + pull.T @ pull / MINUTE
        out[row, others] = mean[k + row, others] @ covariance_from(known)
    return out


def scatter(deviation: Array, variance: Array) -> tuple[Array, Array]:
    """By how much deviations (segments, t) scatter more than white ones of this variance (segments, t), and the
    freedom with which that is known: the largest over blocks of BLOCKS segments. Never below 1 of what has a
    variance of its own.
    """
    best, freedom = np.zeros(deviation.shape[1]), np.ones(deviation.shape[1])
    for length in BLOCKS:
        blocks = len(deviation) // length
        if blocks < 3:
            break
        first = len(deviation) - blocks * length
        by_block = (
            v[first:].reshape(blocks, length, -1).sum(axis=1) for v in (deviation, variance)
        )
        sums, own = by_block
        found = np.sum(sums**2, axis=0) / np.maximum(own.sum(axis=0), 1e-300)
        found *= blocks / (blocks - 1)
        larger = found > best
        best = np.where(larger, found, best)
        freedom = np.where(larger, blocks - 1.0, freedom)
    return np.maximum(best, 1e-12), freedom


def _tests(
    innovations: Innovations, mean: Array, sums: Sequence[Sums]
) -> tuple[list[Test], list[int], list[str]]:
    """What is looked at; which effects these are; why others are not."""
    rig, params, k = innovations.rig, innovations.params, len(innovations.names)
    raw = np.diag(mean)[k:]
    response = np.mean([s.response for s in sums], axis=0)
    variance = np.mean([s.variance for s in sums], axis=0)
    tests, kept, reasons = [], [], []
    for row, effect in enumerate(innovations.effects):
        name = effect.parameters[0]
        low, high = room_of(effect, params, rig)
        if raw[row] <= 0.0:
            reasons.append(f"{effect.key}: no trace in these signals")
        elif response[row] <= 1e-6 * raw[row]:
            reasons.append(f"{effect.key}: undone by parameters that may move")
        elif DETECTION * np.sqrt(variance[row] / MINUTE) > max(-low, high) * response[row]:
            reasons.append(f"{effect.key}: seen within a minute only beyond what is plausible")
        else:
            kept.append(row)
            unit = rig.table[name].unit
            tests.append(Test(effect.key, effect, low < 0.0, high > 0.0, unit, (low, high)))
    energies = [(c, "signal") for c in innovations.channels]
    energies += [(e, "equation") for e in innovations.kind.hidden]
    tests += [Test(name, None, False, True, of=of) for name, of in energies]
    return tests, kept, reasons
