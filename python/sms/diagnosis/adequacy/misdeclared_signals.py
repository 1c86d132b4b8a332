"""Signals that the rig file declares wrongly: a gauge pressure as absolute, two columns exchanged, a sign, a clock.

Such a slip moves readings by more than any effect of the machine does, and a fit would make a physical cause of it. But
it is discrete: once it is undone the declared model predicts the records, and nothing need be fitted for that. So every
slip that the signals of a rig allow is undone in turn, and what the declared model then leaves is compared with what it
left before. It is said where that takes most of the squares, and something in nearly every window: a machine's own
effect is not taken away by a change whose size nobody chose.

A stretched axis of time is harder to see, because conductances and volumes make up for it. It is asked for only where
no logger has the rate of the record, and then the rates that loggers have are tried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import energies
from sms.diagnosis.fitting import residual_of
from sms.diagnosis.hypothesis import Data
from sms.diagnosis.result import Finding
from sms.diagnosis.thresholds import LEAST_SHARE, NEARLY_ALL
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.io.signals import is_pressure, label, without_leg
from sms.io.unit_slips import rates_nearby, stretched_remedy

SCREENED = 12
"""Windows in which every slip is tried before the likeliest is tried in all. Run time."""
FOLLOWED = 0.05
"""Of a position's variance within a window: what a model of the same machine leaves at most. Judgement, from data of
another simulator: 0.04 at the most with an effect, 0.1 to 0.5 with the bores of smaller cylinders. It
decides a warning."""

Signals = Mapping[str, Array]


@dataclass(frozen=True)
class Slip:
    """One way in which a rig file may be wrong."""

    signal: str
    looks_like: str
    remedy: str
    undone: Callable[[Run], Run]
    windows: float = NEARLY_ALL
    """Share of the windows that have to be better for it to be believed."""
    turned: tuple[str, ...] = ()
    """The signals whose sign it changes."""


def misdeclared_signals(data: Data, start: _core.Params) -> tuple[Finding, ...]:
    """The slip that explains the records, if there is one; `start` are the declared parameters."""
    windows = len(data.identify.problem.windows)
    few = sorted({round(k) for k in np.linspace(0, windows - 1, min(SCREENED, windows))})
    excerpt = data.identify.excerpt(few)
    agrees = agreement(excerpt, residual_of(excerpt, start))
    slips = [slip for slip in slips_of(data) if not (slip.turned and _along(slip.turned, agrees))]
    if not slips:
        return ()
    before = _left(excerpt, start)
    after = [_left(_undone(excerpt, slip), start) for slip in slips]
    best = min(range(len(slips)), key=lambda k: float(np.mean(np.log1p(after[k]))))
    slip = slips[best]
    if not _believed(before, after[best], slip.windows):
        return ()
    taken = []
    for runs in (data.identify, data.validate):
        here, there = _left(runs, start), _left(_undone(runs, slip), start)
        if not _believed(here, there, slip.windows):
            return ()
        taken.append(1.0 - float(np.mean(there) / np.mean(here)))
    return (
        Finding(
            "error",
            data.rig.path.name,
            None,
            slip.signal,
            f"{slip.looks_like}: with that put right, the declared model leaves {100 * (1 - min(taken)):.2g} % of the "
            "squared error that it leaves now",
            slip.remedy,
        ),
    )


def agreement(runs: Runs, residual: Array) -> dict[str, float]:
    """By channel how far the recorded signal goes the way of the predicted one: the product of what both change within
    a window, summed over all. residual: (rows,), predicted less recorded, over the noise.
    """
    table = residual.reshape(-1, len(runs.channels))
    products = dict.fromkeys(runs.channels, 0.0)
    for w in runs.problem.windows:
        first = w.row // len(runs.channels)
        for k, channel in enumerate(runs.channels):
            signal = runs.motions[w.record].signals[channel][w.first : w.first + w.samples]
            recorded = (signal - signal.mean()) / runs.noise[channel]
            products[channel] += float(recorded @ (recorded + table[first : first + w.samples, k]))
    return products


def _along(turned: Sequence[str], agrees: Mapping[str, float]) -> bool:
    """Whether what these signals move goes the way of the prediction: their own legs' pistons, else every pressure."""
    legs = [signal.removeprefix(without_leg(signal)) for signal in turned]
    pistons = [c for c in (f"extension{leg}" for leg in legs) if c in agrees]
    return sum(agrees[c] for c in pistons or agrees) > 0.0


def _undone(runs: Runs, slip: Slip) -> Runs:
    return replace(runs, motions=tuple(slip.undone(run) for run in runs.motions))


def _left(runs: Runs, start: _core.Params) -> Array:
    """(windows, channels): mean square that the declared model leaves, in units of the noise."""
    return energies(runs, residual_of(runs, start))


def _believed(before: Array, after: Array, windows: float) -> bool:
    """Whether most of the squares go, and in so many windows something; windows are paired by place."""
    place = (np.arange(len(before)) + 0.5) / len(before)
    paired = after[np.minimum((place * len(after)).astype(int), len(after) - 1)]
    better = np.log1p(paired).sum(axis=1) < np.log1p(before).sum(axis=1)
    most = np.mean(after) <= (1.0 - LEAST_SHARE) * np.mean(before)
    return bool(most and np.mean(better) >= windows)


# ---- the rig file of another machine ---------------------------------------------------------------


def of_another_machine(data: Data, start: _core.Params) -> tuple[Finding, ...]:
    """A warning where the declared model predicts most windows worse than their own mean does: every pressure, and of
    the positions, which any model follows for a second, less than nearly all. Effects of the catalogue at sizes that
    were hidden in measurements leave 0.96 of the positions' variance predicted and more."""
    mean, left = [], []
    for runs in (data.identify, data.validate):
        left.append(_left(runs, start))
        for w in runs.problem.windows:
            signals = runs.motions[w.record].signals
            samples = slice(w.first, w.first + w.samples)
            mean.append([np.var(signals[c][samples]) / runs.noise[c] ** 2 for c in runs.channels])
    ratio = np.vstack(left) / np.maximum(np.array(mean), 1.0)
    channels = [without_leg(c) for c in data.identify.channels]
    driven = [
        k for k, c in enumerate(channels) if c.startswith(("chamber_pressure", "tank_pressure"))
    ]
    positions = [k for k, c in enumerate(channels) if c == "extension"]
    worse = bool(driven) and bool(np.all(np.median(ratio[:, driven], axis=0) > 1.0))
    share = [float(np.sum(np.vstack(left)[:, k]) / np.sum(np.array(mean)[:, k])) for k in positions]
    if not worse or (share and max(share) < FOLLOWED):
        return ()
    return (
        Finding(
            "warning",
            data.rig.path.name,
            None,
            None,
            "with the declared values the model predicts these records worse than the mean of each second does",
            "check that rig file and records are of the same machine: bore_diameter, moving_mass, mass_flow_gain, "
            "supply_pressure",
        ),
    )


# ---- the slips -----------------------------------------------------------------------------------


def slips_of(data: Data) -> Iterator[Slip]:
    """Every slip that the signals of these records allow."""
    rig, first = data.rig, data.identify.motions[0]
    every = (*data.identify.motions, *data.validate.motions)
    common = [s for s in first.signals if all(s in run.signals for run in every)]
    yield from _gauge(rig, first, [s for s in common if is_pressure(s)])
    for stem in ("extension", "valve_command"):
        of_stem = [s for s in common if without_leg(s) == stem]
        yield from _reversed(rig, stem, of_stem)
        yield from _exchanged(of_stem)
    yield from _exchanged([s for s in common if without_leg(s) == "chamber_pressure_lower"])
    for lower in (s for s in common if without_leg(s) == "chamber_pressure_lower"):
        upper = lower.replace("lower", "upper")
        if upper in common:
            yield from _exchanged([lower, upper])
    yield from _stretched(rig, first)


def _with(change: Callable[[Signals], dict[str, Array]]) -> Callable[[Run], Run]:
    """A run with some of its signals changed."""
    return lambda run: replace(run, signals={**run.signals, **change(run.signals)})


def _gauge(rig: Rig, run: Run, pressures: list[str]) -> Iterator[Slip]:
    """Gauge pressures declared as absolute, or the reverse: one sensor's, or all."""
    ambient = rig.declared("ambient_pressure").value
    chambers = [s for s in pressures if s.startswith("chamber_pressure")]
    groups = [[s] for s in pressures] + [g for g in (chambers, pressures) if len(g) > 1]
    for group in groups:
        gauge = [s in run.gauge for s in group]
        if len(set(gauge)) > 1:
            continue
        off = -ambient if gauge[0] else ambient
        now, then = ("gauge", "absolute") if gauge[0] else ("absolute", "gauge")
        whose, each = label(group[0]), ""
        if len(group) > 1:
            every = "chamber pressure" if group is chambers else "pressure"
            whose, each = f"every {every}", f", and so of every other {every}"
        yield Slip(
            group[0],
            f"{whose} is declared as {now} and looks like {then}",
            f"{'remove gauge = true from' if gauge[0] else 'write gauge = true in'} [signals] {group[0]}{each}",
            _with(lambda x, group=group, off=off: {s: x[s] + off for s in group}),  # type: ignore[misc]
        )


def _reversed(rig: Rig, stem: str, signals: list[str]) -> Iterator[Slip]:
    """A sign, of one signal or of all: about its own zero, or counted from the other end of its range."""
    other_end = (
        rig.declared("stroke").value
        if stem == "extension"
        else 2.0 * rig.declared("valve_centre").value
    )
    unit = "m" if stem == "extension" else "V"
    for group in [[s] for s in signals] + ([signals] if len(signals) > 1 else []):
        source = rig.signals[group[0]]
        whose = (
            label(group[0])
            if len(group) == 1
            else f"{label(group[0])}, as that of every other leg,"
        )
        for twice, offset in (
            (2.0 * source.offset, source.offset),
            (other_end, other_end - source.offset),
        ):
            yield Slip(
                group[0],
                f"{whose} looks reversed",
                f'write scale = {-source.scale:g}, offset = "{offset:.6g} {unit}" in [signals] {group[0]}',
                _with(lambda x, group=group, twice=twice: {s: twice - x[s] for s in group}),  # type: ignore[misc]
                turned=tuple(group),
            )


def _exchanged(signals: list[str]) -> Iterator[Slip]:
    """Two columns in each other's place."""
    for a, b in combinations(signals, 2):
        yield Slip(
            a,
            f"{label(a)} and {label(b)} look exchanged",
            f"exchange the columns of {a} and {b} in [signals]",
            _with(lambda x, a=a, b=b: {a: x[b], b: x[a]}),  # type: ignore[misc]
        )


def _stretched(rig: Rig, run: Run) -> Iterator[Slip]:
    """A clock that runs fast or slow, where the record has a rate that no logger has."""
    rate = 1.0 / run.step
    for usual in rates_nearby(rate):
        factor = rate / usual
        yield Slip(
            "time",
            f"a sample in {1e3 * run.step:.4g} ms is no logger's rate, and time looks "
            f"{'stretched' if factor < 1.0 else 'squeezed'}, from {usual:g} Hz",
            stretched_remedy(rig, factor),
            lambda r, factor=factor: replace(r, time=r.time * factor),  # type: ignore[misc]
            LEAST_SHARE,
        )
