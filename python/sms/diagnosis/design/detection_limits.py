"""Detection limits: the smallest size of each effect that an experiment would show, or that a record can.

An effect counts as detectable from three standard errors on (selection/identifiability.py). Its standard error is that
of a best estimate from one record alone, with the noise as declared and white: the sensitivity to the effect in units
of the noise, less what the initial state of every window can imitate, and less what the nuisance parameters can undo
within what is declared known about them (estimation/nuisance.py). A shift of a number that is declared with an
uncertainty counts from the end of that: within it, it is no error of the model. The kind's menu is simulated with the
parameters as declared; a record is taken as it is.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sms.arrays import Array
from sms.callbacks import Progress
from sms.diagnosis.effects.catalogue import Effect, effects_of
from sms.diagnosis.effects.sensitivity import sensitivity_columns
from sms.diagnosis.hypothesis import Data, baseline_hypothesis
from sms.diagnosis.selection.excitation import missing_excitation
from sms.diagnosis.thresholds import DETECTION
from sms.errors import InputError
from sms.estimation.kind import Kind
from sms.estimation.noise import noise_of
from sms.estimation.nuisance import nuisance_at, project
from sms.estimation.run import Run, make_run
from sms.estimation.windows import Runs
from sms.io.check import check_record, raise_if_unreadable
from sms.io.records import load_record
from sms.io.rig import DataLayout, Rig, load_rig
from sms.io.signal_sources import SignalSource
from sms.io.signals import SIGNALS, of_legs, without_leg
from sms.io.thinning import thinned
from sms.parameters import common_parameter
from sms.rigs.kinds import KINDS, kind_of
from sms.rigs.threads import one_thread_for_matrices
from sms.units_display import display_unit, significant


@dataclass(frozen=True)
class Limit:
    """Of one effect in one experiment: the size, in the unit of its parameter, or why it is not seen."""

    size: float | None
    reason: str = ""
    declared: float = 0.0
    """Of that size: the declared uncertainty of the number that the effect shifts."""


@dataclass(frozen=True)
class Row:
    """Of one effect."""

    effect: Effect
    unit: str
    limits: tuple[Limit, ...]

    @property
    def best(self) -> float | None:
        """The smallest of all experiments."""
        return min((x.size for x in self.limits if x.size is not None), default=None)

    @property
    def shown(self) -> tuple[str, list[str]]:
        """The unit in which the row is read, and each size in it; "-" for none."""
        unit = display_unit(self.unit, self.best or 0.0, self.effect.parameters[0])
        sizes = (None if x.size is None else unit.scale(x.size) for x in self.limits)
        return unit.label, ["-" if s is None else _short(s) for s in sizes]


def _short(size: float) -> str:
    """Two digits: "0.0048", "2.1e-4"."""
    return significant(size, 2) if size >= 1e-3 else f"{size:.1e}".replace("e-0", "e-")


@dataclass(frozen=True)
class Limits:
    """Effects by experiments."""

    title: str
    experiments: tuple[str, ...]
    """Titles; a record by its name."""
    noise: dict[str, float]
    """Signal -> standard deviation of one sample, SI."""
    rows: tuple[Row, ...]


def detection_limits(rig: Rig | str | Path, progress: Progress = lambda text, done: None) -> Limits:
    """The limits of all effects of a rig: a rig file, or "bench", "platform" or "tank" as published.

    InputError for a kind of rig that is not simulated, or records that cannot be read.
    """
    if not isinstance(rig, Rig):
        rig = _named(str(rig))
    if rig.kind not in KINDS:
        raise InputError(
            f"{rig.path}: a {rig.kind} has no menu of experiments that could be simulated; "
            f"what has: {', '.join(KINDS)}"
        )
    kind = kind_of(rig)
    records = []
    for source in rig.records:
        record = thinned(load_record(rig, source))
        raise_if_unreadable(record, check_record(rig, record))
        records.append(make_run(rig, record))
    noise = noise_of(rig, kind, records)
    channels = tuple(
        s
        for s in kind.outputs
        if (all(s in r.signals for r in records) if records else s in rig.signals)
    )
    effects = [e for e in effects_of(rig) if not e.not_measured(channels)]
    every = len(records) + len(kind.menu)
    titles: list[str] = []
    columns: list[list[Limit]] = []
    for number, run in enumerate(records):
        progress(run.name, number / every)
        titles.append(run.name)
        columns.append(limits_of(rig, kind, [run], noise, effects))
    for number, experiment in enumerate(kind.menu, len(records)):
        progress(experiment.title, number / every)
        titles.append(experiment.title)
        proposed = experiment.simulated(rig, rig.start(), channels)
        columns.append(
            [Limit(None, "a piston would leave its stroke")] * len(effects)
            if proposed is None
            else limits_of(rig, kind, [proposed], noise, effects)
        )
    rows = tuple(
        Row(effect, rig.table[effect.parameters[0]].unit, tuple(c[k] for c in columns))
        for k, effect in enumerate(effects)
    )
    return Limits(rig.title, tuple(titles), {s: noise[s] for s in channels}, rows)


def _named(rig: str) -> Rig:
    if rig in KINDS:
        return published_rig(rig)
    if not Path(rig).suffix and not Path(rig).exists():
        raise InputError(
            f"{rig}: neither a rig file (rig.toml) nor a published machine; those are {', '.join(KINDS)}"
        )
    return load_rig(rig)


def published_rig(kind: str) -> Rig:
    """A rig without records: parameters as published, sensors as on the source's bench."""
    legs = kind == "platform"
    noise = {s: SIGNALS[without_leg(s)].noise for s in KINDS[kind].outputs}
    commands = of_legs("valve_command") if legs else ("valve_command",)
    sources = {s: SignalSource(s, s, noise=size) for s, size in noise.items() if size > 0.0}
    sources |= {s: SignalSource(s, s) for s in commands}
    return Rig(
        path=Path(kind),
        kind=kind,
        title=f"{kind}, parameters as published",
        notes="",
        layout=DataLayout("comma", None),
        skip_first=0,
        speed_above=None,
        signals=sources,
        parameters={},
        records=(),
    )


@one_thread_for_matrices()
def limits_of(
    rig: Rig, kind: Kind, records: Sequence[Run], noise: dict[str, float], effects: Sequence[Effect]
) -> list[Limit]:
    """Of these effects in one record, or in several together."""
    runs = Runs(rig, tuple(records), noise, kind)
    baseline = baseline_hypothesis(Data(rig, runs, runs), effects)
    residual, nuisance = nuisance_at(
        runs.problem, baseline.start, list(baseline.free), baseline.known, baseline.joint
    )
    raw = sensitivity_columns(runs.problem, baseline.start, residual, effects, rig.table)
    usable = np.all(np.isfinite(raw), axis=0)
    reduced = project(nuisance, np.where(usable, raw, 0.0), [e.parameters[0] for e in effects])
    stroke = rig.declared("stroke").value
    return [
        _limit(effect, rig, runs, stroke, raw[:, k], reduced[:, k], baseline.known)
        for k, effect in enumerate(effects)
    ]


def _limit(
    effect: Effect,
    rig: Rig,
    runs: Runs,
    stroke: float,
    raw: Array,
    reduced: Array,
    known: Mapping[str, float],
) -> Limit:
    if all(rig.declared(n).fit for n in effect.parameters):
        return Limit(None, "fitted anyway")
    if not np.all(np.isfinite(raw)):
        return Limit(None, "with it the simulation breaks down")
    if not np.any(raw):
        return Limit(None, "no trace in these signals")
    if effect.needs and (reason := missing_excitation(effect.needs, runs, stroke)):
        return Limit(None, reason)
    size = float(np.linalg.norm(reduced))
    if size < 1e-6 * float(np.linalg.norm(raw)):
        return Limit(None, "undone by parameters that may move")
    declared = known.get(effect.parameters[0], 0.0)
    limit = declared + DETECTION / size
    low, high = effect.plausible_range(rig.declared(common_parameter(effect.parameters[0])).value)
    if effect.kind != "missing":  # a shift is seen beyond its declared value
        value = rig.declared(effect.parameters[0]).value
        low, high = low - value, high - value
    if limit > max(abs(low), abs(high)):
        return Limit(None, "seen only beyond what is plausible")
    return Limit(limit, declared=declared)


def as_csv(found: Limits) -> str:
    """One row an effect and experiment: effect, parameter, unit, experiment, size (SI; empty: not seen), reason."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(("effect", "parameter", "unit", "experiment", "size", "reason"))
    for row in found.rows:
        for title, limit in zip(found.experiments, row.limits, strict=True):
            size = "" if limit.size is None else f"{limit.size:.6g}"
            rows.writerow(
                (row.effect.key, row.effect.parameters[0], row.unit, title, size, limit.reason)
            )
    return text.getvalue()
