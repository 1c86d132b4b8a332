"""The findings as numbers: sizes with standard errors, reduction of the error on validation records, residual."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sms.arrays import Array, Index
from sms.diagnosis.fitting import residual_of
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import refitted, refitted_on
from sms.diagnosis.result import Candidate, Cause, Gain, Member, ParameterValue, Series
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.outcome import Round
from sms.estimation.block_statistics import interval, resampled, weighted_ms
from sms.estimation.kind import Kind
from sms.estimation.run import Run
from sms.estimation.windows import Runs


def value_of(fitted: Fitted, name: str, old: float, error: float | None = None) -> ParameterValue:
    """A parameter as fitted, with the error of the fit if no other is given."""
    if error is None:
        error = fitted.standard_error(name) if name in fitted.hypothesis.free else 0.0
    unit = fitted.hypothesis.table[name].unit
    return ParameterValue(name, fitted.params[name], error, unit, old)


def cause_from(
    members: Sequence[Trial],
    found: Callable[[Trial], tuple[ParameterValue, ...]],
    consistency: dict[str, float],
) -> Cause:
    """One class of trials as a cause, the first standing for it; `found` gives the size of each."""
    first = members[0]
    return Cause(
        effect=first.effect.id,
        signal=first.effect.signal,
        kind="missing term" if first.effect.kind == "missing" else "shifted parameter",
        block=first.effect.block,
        title=first.effect.title,
        explanation=first.effect.cause,
        members=tuple(dict.fromkeys(m.effect.id for m in members)),
        alternatives=tuple(
            Member(
                m.effect.id,
                m.effect.signal,
                m.effect.title,
                found(m),
                first.similarity[m.effect.key],
            )
            for m in members[1:]
        ),
        parameters=found(first),
        p_value=first.p_value,
        consistency=consistency,
        separated_by=" ".join(dict.fromkeys(m.effect.separated_by for m in members))
        if len(members) > 1
        else "",
        support=sum(m.support for m in members),
        share=first.share[0],
        share_low=first.share[1],
        share_high=first.share[2],
        cross_validated=first.cross_validated,
    )


def gains(
    baseline: Fitted, extended: Fitted, data: Data, floor: Array, rng: np.random.Generator
) -> tuple[Gain, ...]:
    """What the extension is worth on each record it has not seen, and each signal, in the signal's unit.

    floor (channels,): mean square of what no model of the state explains, in the residual's unit.
    """
    out: list[Gain] = []
    for runs in (data.validate, data.test):
        if runs is not None:
            held = tuple(residual_of(runs, f.params) for f in (baseline, extended))
            moved = held
            if runs.whitened:
                moved = tuple(_refitted(f, data, runs).fit.residual for f in (baseline, extended))
            out += gains_on(runs, held, moved, floor, rng)
    return tuple(out)


@dataclass(frozen=True)
class Where:
    """Which record and signal a gain is of."""

    record: str
    signal: str
    unit: str
    role: str


def gain_of(
    where: Where,
    before: Array,
    after: Array,
    block: Index,
    counts: Array,
    floor: float,
    scale: float = 1.0,
    refitted: tuple[float, float] | None = None,
) -> Gain:
    """From squared errors (rows,) of one record and signal, and resamples of its blocks; `scale` gives the unit.

    refitted: mean squares without and with the extension, refitted; the same as the others if left out.
    """
    change = 1.0 - np.sqrt(
        weighted_ms(after, block, counts) / np.maximum(weighted_ms(before, block, counts), 1e-300)
    )
    rms_b, rms_e = float(np.sqrt(np.mean(before))), float(np.sqrt(np.mean(after)))
    again = (rms_b, rms_e) if refitted is None else np.sqrt(refitted)
    return Gain(
        where.record,
        where.signal,
        where.unit,
        rms_b * scale,
        rms_e * scale,
        floor * scale,
        1.0 - rms_e / rms_b,
        *interval(change),
        where.role,
        *(scale * float(rms) for rms in again),
    )


def gains_on(
    runs: Runs,
    held: Sequence[Array],
    refitted: Sequence[Array],
    floor: Array,
    rng: np.random.Generator,
) -> Iterator[Gain]:
    """From residuals (rows,) without and with an extension, the fitted values held, and refitted."""
    before, after = held
    counts = resampled(runs.record, runs.block, rng)
    for number, run in enumerate(runs.motions):
        for c, channel in enumerate(runs.channels):
            if not runs.compares(run, channel):
                continue
            rows = (runs.record == number) & (runs.channel == c)
            where = Where(run.name, channel, runs.kind.units[channel], run.role)
            own = counts[:, np.unique(runs.block[rows])]
            block = np.unique(runs.block[rows], return_inverse=True)[1]
            lowest, noise = float(np.sqrt(floor[c])), runs.noise[channel]
            squares = before[rows] ** 2, after[rows] ** 2
            again = float(np.mean(refitted[0][rows] ** 2)), float(np.mean(refitted[1][rows] ** 2))
            yield gain_of(where, *squares, block, own, lowest, noise, again)


def series_of(baseline: Fitted, final: Fitted, data: Data) -> tuple[Series, ...]:
    """Measured and predicted curves of all records: identify, validate, test."""
    parts = [part for part in (data.identify, data.validate, data.test) if part is not None]
    return tuple(s for part in parts for s in _series(part, baseline, final))


def _series(part: Runs, baseline: Fitted, final: Fitted) -> list[Series]:
    """Measured and predicted curves of one role, window by window from the best initial states."""
    whole = part.whole
    base, extended = (whole.problem.errors(fitted.params) for fitted in (baseline, final))
    out = []
    for number, run in enumerate(part.motions):
        for c, channel in enumerate(part.channels):
            if not part.compares(run, channel):
                continue
            rows = (whole.record == number) & (whole.channel == c)
            places = whole.sample[rows]
            measured = run.signals[channel]
            curves = measured.copy(), measured.copy()
            for curve, errors in zip(curves, (base, extended), strict=True):
                curve[places] += errors[rows] * part.noise[channel]
            used = np.zeros(len(run.time), dtype=np.bool_)
            used[part.sample[(part.record == number) & (part.channel == c)]] = True
            out.append(
                Series(
                    run.name,
                    run.role,
                    channel,
                    part.kind.units[channel],
                    run.time,
                    measured,
                    *curves,
                    used,
                    _along(part.kind, run),
                )
            )
    return out


def _refitted(fitted: Fitted, data: Data, runs: Runs) -> Fitted:
    return refitted(fitted, data) if runs is data.validate else refitted_on(fitted, runs)


def _along(kind: Kind, run: Run) -> dict[str, Array]:
    """(n,) each: what the report draws errors over."""
    found = {f"{n} [{kind.units[n]}]": run.signals[n] for n in kind.shown if n in run.signals}
    return found | kind.derived(run) | {"time [s]": run.time - run.time[0]}


def candidates_of(rounds: Sequence[Round]) -> tuple[Candidate, ...]:
    """Every effect that was tried, round by round."""
    return tuple(_candidate(t, n, r) for n, r in enumerate(rounds, 1) for t in r.trials)


def _candidate(trial: Trial, number: int, its_round: Round) -> Candidate:
    reason, best = trial.reason, trial in its_round.members
    if trial.accepted:
        reason = (
            "the best explanation of this round, or not to be told from it"
            if best
            else "explains less than the best of this round; tried again in the next"
        )
    start = trial.fitted.hypothesis.start
    values = tuple(value_of(trial.fitted, n, start[n]) for n in trial.effect.parameters)
    return Candidate(
        number,
        trial.effect.id,
        trial.effect.signal,
        values,
        trial.p_value,
        trial.gain,
        *trial.gain_interval,
        best,
        reason,
    )
