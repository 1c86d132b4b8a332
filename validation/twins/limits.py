"""Detection limits: the smallest size of each effect that two records can show at all.

The records are cut into stretches of a second whose initial states are unknown, as a diagnosis
would treat them. A change dy of all signals, divided by their noise, loses in every stretch what
an initial state imitates and, over all stretches, what the machine may be off by: the declared
numbers within their half widths, the valve's map and the pressure sensors within what a core
that is told nothing allows them (declared.py), and maps and sensors as those of MACHINES drawn
machines that are IMPERFECT percent off what can be declared (imperfection.py). With i the
information left,

    i = d'd - d'N (N'N + 1)^-1 N'd,        d, N after the stretches' own projections

and N a column for each of these in units of its standard deviation, the size counts as detectable
where sqrt(i) = SIGMAS (five standard deviations of the best estimate), and where the change that
what is declared leaves is in at least one signal as large as FLOOR of the noise, and as what the
drawn machines leave there: below that a cause drowns in the differences between two descriptions
of one machine. For the information each edge of a valve is off by itself. For these differences
both ports are off alike: free edges would take most of what the drawn machines differ by, and of the floor.
Coloured noise counts as white noise of the same density at low frequency, which is on the safe
side.

    python -m validation.twins limits bench

makes the tables in limits/, which the draws read.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from validation.twins.air import Array
from validation.twins.declared import FLOW_MAP, as_declared, pressure_sensors
from validation.twins.effects import Effect
from validation.twins.imperfection import bowed, draw_imperfection, map_modes
from validation.twins.instruments import Channel, channel_of
from validation.twins.measured import VirtualRig
from validation.twins.truth import Truth

SIGMAS = 5.0
FLOOR = 0.5
IMPERFECT = 2.0
"""Percent: the level up to which trials have to name what they hide."""
MACHINES = 40
"""Drawn for the size of what such machines leave: it is known to about a tenth."""
STRETCH = 1.0
"""s, the length of a stretch."""
FOLDER = Path(__file__).parent / "limits"


@dataclass(frozen=True)
class Stretch:
    """A second of one record."""

    time: float
    commands: Mapping[str, Array]
    start: Array
    signals: Mapping[str, Array]
    basis: Array  # orthonormal, what an initial state imitates


def spread(channel: Channel, step: float) -> float:
    """Standard deviation of white noise that hides a slow change as well as this channel's."""
    white = channel.white**2 + channel.step**2 / 12.0
    return float(np.sqrt(white + channel.coloured**2 * 2.0 * channel.correlation_time / step))


class Limits:
    """Sensitivities of one rig, as declared, on given runs."""

    def __init__(self, rig: VirtualRig, plans: Sequence[Any], every: int = 1) -> None:
        """With `every` > 1 only so many of the stretches stand for all."""
        self.rig = rig
        self.every = every
        self.truth = as_declared(Truth(), rig.declared)
        self.weights = {
            signal: 1.0 / spread(channel_of(signal), rig.sample_step) for signal in rig.signals
        }
        self.stretches = [stretch for plan in plans for stretch in self._cut(plan)]
        widths = {
            **{d.name: d.half_width for d in rig.declared if d.name and d.half_width > 0.0},
            **pressure_sensors(rig.signals),
        }
        self.names = list(widths)
        numbers = [self._scaled(name, 0.2 * half, half) for name, half in widths.items()]
        known = {at: 0.5 * half for at, half in FLOW_MAP.items()}
        self.declared, self.alike = (
            np.column_stack(
                [*numbers, *(self.change(replace(self.truth, imperfection=m)) for m in modes)]
            )
            for modes in (map_modes(known, rig.axes), map_modes(known, rig.axes, alike=True))
        )
        self.drawn = np.column_stack(
            [self.change(self._drawn(seed)) for seed in range(MACHINES)]
        ) / np.sqrt(MACHINES)

    def _cut(self, plan: Any) -> list[Stretch]:
        rig = self.rig
        quiet = dict.fromkeys(rig.signals, np.zeros(round(rig.duration / rig.sample_step) + 1))
        measured = rig.measure(self.truth, plan, quiet)
        length = round(STRETCH / rig.sample_step)
        stretches = []
        for first in range(
            0, round(rig.duration / rig.sample_step) - length + 1, self.every * length
        ):
            commands = {k: v[first : first + length + 1] for k, v in measured.commands.items()}
            start, time = measured.states[first], first * rig.sample_step
            signals = rig.window(self.truth, commands, start, time)
            plain = Stretch(time, commands, start, signals, np.zeros((0, 0)))
            columns = []
            for state, step in zip(rig.window_states, rig.state_steps, strict=True):
                moved = start.copy()
                moved[state] += step
                columns.append(
                    self._difference(plain, rig.window(self.truth, commands, moved, time))
                )
            basis = np.linalg.qr(np.column_stack(columns) / np.linalg.norm(columns, axis=1))[0]
            stretches.append(Stretch(time, commands, start, signals, basis))
        return stretches

    def _drawn(self, seed: int) -> Truth:
        """A machine as declared, but imperfect."""
        rig = self.rig
        off = draw_imperfection(
            IMPERFECT, rig.axes, rig.signals, rig.log_steps, np.random.SeedSequence(seed)
        )
        return replace(self.truth, imperfection=off)

    def _difference(self, stretch: Stretch, signals: Mapping[str, Array]) -> Array:
        return np.concatenate(
            [self.weights[s] * (signals[s] - stretch.signals[s]) for s in self.rig.signals]
        )

    def change(self, truth: Truth) -> Array:
        """Whitened change of all signals against the healthy rig, less the initial states'."""
        bows = {} if truth.imperfection is None else truth.imperfection.bows
        parts = []
        for s in self.stretches:
            signals = self.rig.window(truth, s.commands, s.start, s.time)
            seen = {
                name: bowed(name, v, bows[name]) if name in bows else v
                for name, v in signals.items()
            }
            d = self._difference(s, seen)
            parts.append(d - s.basis @ (s.basis.T @ d))
        return np.concatenate(parts)

    def _scaled(self, name: str, step: float, half: float) -> Array:
        """Change for half a half width: that is the prior's standard deviation."""
        moved = self.truth.having(**{name: self.truth.value(name) + step})
        return self.change(moved) * (0.5 * half / step)

    def left(self, change: Array, effect: Effect) -> tuple[float, float]:
        """sqrt(information) of a change, and its RMS over what it has to exceed, in the signal where that is most."""
        scale = np.sqrt(self.every)  # a stretch stands for so many
        own = [k for k, name in enumerate(self.names) if name in effect.names]
        declared, alike = (scale * np.delete(d, own, axis=1) for d in (self.declared, self.alike))
        change, drawn = scale * change, scale * self.drawn
        share, rest = undone(change, np.hstack([declared, drawn]))
        information = float(rest @ rest + share @ share)
        beside = np.column_stack([change, drawn])
        left = undone(beside, alike)[1] / scale
        by_signal = left.reshape(len(self.stretches), len(self.rig.signals), -1, beside.shape[1])
        squares = np.mean(by_signal**2, axis=(0, 2))  # (signals, columns)
        noise = [self.weights[s] * channel_of(s).deviation for s in self.rig.signals]
        least = np.maximum(FLOOR * np.array(noise), np.sqrt(squares[:, 1:].sum(axis=1)))
        return float(np.sqrt(information)), float(np.max(np.sqrt(squares[:, 0]) / least))

    def seen(self, effect: Effect, size: float) -> float:
        """How many times over an effect of this size is detectable; 1 is its limit."""
        sigmas, share = self.left(
            self.change(effect.hidden_in(self.truth, effect.sense * size)), effect
        )
        return min(sigmas / SIGMAS, share)

    def limit(self, effect: Effect) -> float | None:
        """The detectable size; None when even the largest cannot be seen."""
        size = effect.first_step
        for _ in range(5):
            seen = self.seen(effect, size)
            if not np.isfinite(seen):
                return None
            if 0.8 < seen < 1.25:
                return size / seen
            size = min(size / max(seen, 0.03), effect.largest)
            if size == effect.largest and seen < 1.0 and self.seen(effect, size) < 1.0:
                return None
        return size


def undone(change: Array, nuisances: Array) -> tuple[Array, Array]:
    """How far nuisances of unit variance move for a change (rows,) or changes (rows, m), and the rest of these."""
    normal = nuisances.T @ nuisances + np.eye(nuisances.shape[1])
    share = np.asarray(np.linalg.solve(normal, nuisances.T @ change), dtype=np.float64)
    return share, change - nuisances @ share


def table(
    rig: VirtualRig, effects: Sequence[Effect], names: Sequence[str], seed: int, every: int = 1
) -> Any:
    """Limits of effects on two runs excited by `names`: what a limits/ file holds."""
    rng = np.random.default_rng(seed)
    limits = Limits(rig, [rig.plan(name, rng) for name in names], every)
    rows = {}
    for effect in effects:
        if effect.drawn_from is None:
            found = limits.limit(effect)
            rows[effect.key] = None if found is None else float(f"{found:.3g}")
    return {"excitation": list(names), "limits": rows}


def path_of(kind: str) -> Path:
    """Where the table of a rig is kept."""
    return FOLDER / f"{kind}.json"


def read(kind: str) -> dict[str, dict[str, float | None]]:
    """By excitation pair ("multisine+holds"), the limits by effect key."""
    rows = json.loads(path_of(kind).read_text())
    return {"+".join(row["excitation"]): row["limits"] for row in rows}
