"""Which effects a residual in units of the noise speaks for: the footprints of all of them, and a test of each.

A footprint is the change of the residual with an effect, less what the free parameters can undo within what is
declared known about them. Its score is summed over windows. Noise is declared here, so the scatter of a score is
known two ways: from the noise, and from the windows after the effect has been taken out. The larger holds. (Scatter
taken before would count a strong effect as its own noise.) The largest statistic of all effects is held against its
distribution under random signs of whole windows, as in statistics.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.diagnosis.catalogue import Effect
from sms.diagnosis.gauss_newton import changed
from sms.diagnosis.kind import Problem
from sms.diagnosis.result import Array
from sms.diagnosis.statistics import Index, sum_by
from sms.parameters import Parameter


@dataclass(frozen=True)
class Screen:
    """The tests of m effects at one point. Arrays (m,) and footprints (rows + known, m)."""

    footprint: Array
    statistic: Array
    """Estimate over its standard error."""
    p_value: Array
    """Chance of so large a statistic anywhere among the m, without any effect; 1 for a sign that cannot be."""
    estimate: Array
    """Linear estimate of the effect's size, as a shift of its parameter."""
    error: Array
    """Its standard error."""
    gain: Array
    """Chi-square that the linear estimate takes away."""

    def promise(self, lower: Array, upper: Array) -> Array:
        """(m,): the gain where the shifts stay within (m,) bounds: an estimate beyond all reason promises little."""
        step = np.clip(self.estimate, lower, upper)
        size = np.sum(self.footprint**2, axis=0)
        within = size * step * (2.0 * self.estimate - step)
        return np.asarray(np.where(self.gain > 0.0, np.maximum(within, 0.0), 0.0))

    @cached_property
    def cosine(self) -> Array:
        """(m, m): similarity of footprints, 0..1."""
        unit = self.footprint / np.maximum(np.linalg.norm(self.footprint, axis=0), 1e-300)
        return np.asarray(np.abs(unit.T @ unit))


@dataclass(frozen=True)
class Nuisance:
    """The free parameters: their Jacobian (rows, k), and how strongly each is pulled to what is declared."""

    names: list[str]
    jacobian: Array
    pull: Array
    """(k,) per unit; 0 where nothing is declared."""
    off: Array
    """(k,) value less declared value."""

    def without(self, name: str) -> Nuisance:
        keep = [i for i, n in enumerate(self.names) if n != name]
        return Nuisance(
            [self.names[i] for i in keep], self.jacobian[:, keep], self.pull[keep], self.off[keep]
        )

    def with_declared(self, rows: Array) -> Array:
        """Rows (n,) or (n, m) with zeros for what is declared below."""
        below: Array = np.zeros((len(self.names), *rows.shape[1:]))
        out: Array = np.concatenate([rows, below])
        return out

    def basis(self) -> Array:
        """(n + k, r): an orthonormal basis of what the free parameters can do."""
        stacked = np.vstack([self.jacobian, np.diag(self.pull)])
        stacked = stacked / np.maximum(np.linalg.norm(stacked, axis=0), 1e-300)
        q, r = np.linalg.qr(stacked)
        return np.asarray(q[:, np.abs(np.diag(r)) > 1e-9])


def pulls(names: Sequence[str], known: Mapping[str, float]) -> Array:
    """(names,): how strongly each is pulled to what is declared; known: name -> declared uncertainty."""
    return np.array([1.0 / known[n] if n in known else 0.0 for n in names])


def nuisance_at(
    problem: Problem, params: _core.Params, names: Sequence[str], known: Mapping[str, float]
) -> tuple[Array, Nuisance]:
    """The residual (rows,), and these parameters as they may move from where they are, which counts as declared."""
    residual, jacobian = problem.evaluate(params, names)
    nuisance = Nuisance(
        list(names), np.asarray(jacobian), pulls(names, known), np.zeros(len(names))
    )
    return np.asarray(residual), nuisance


def columns_of(
    problem: Problem,
    params: _core.Params,
    residual: Array,
    effects: Sequence[Effect],
    table: Mapping[str, Parameter],
) -> Array:
    """(rows, m): change of the residual with the first parameter of each effect; by a step where it has no slope."""
    smooth = [e.parameters[0] for e in effects if e.step is None]
    _, jacobian = problem.evaluate(params, smooth)
    columns = np.empty((len(residual), len(effects)))
    place = 0
    for i, effect in enumerate(effects):
        if effect.step is None:
            columns[:, i] = jacobian[:, place]
            place += 1
            continue
        name = effect.parameters[0]
        step = effect.step if params[name] == table[name].default else 0.02 * params[name]
        step = -step if params[name] + step > table[name].upper else step
        there, _ = problem.evaluate(changed(params, [name], np.array([params[name] + step])))
        columns[:, i] = (there - residual) / step
    return columns


def project(nuisance: Nuisance, columns: Array, names: Sequence[str]) -> Array:
    """(rows + known, m): what of columns (rows, m) the free parameters cannot do; its own is no rival."""
    basis = nuisance.basis()
    out = np.zeros((len(columns) + len(nuisance.names), columns.shape[1]))
    for i, name in enumerate(names):
        if name in nuisance.names:
            others = nuisance.without(name)
            q, full = others.basis(), others.with_declared(columns[:, i])
            reduced = full - q @ (q.T @ full)
            keep = [k for k, n in enumerate(nuisance.names) if n != name]
            out[: len(columns), i] = reduced[: len(columns)]
            out[len(columns) + np.array(keep, dtype=np.int64), i] = reduced[len(columns) :]
        else:
            full = nuisance.with_declared(columns[:, i])
            out[:, i] = full - basis @ (basis.T @ full)
    return out


def screen(
    footprint: Array,
    nuisance: Nuisance,
    residual: Array,
    block: Index,
    allowed: NDArray[np.bool_],
    rng: np.random.Generator,
    draws: int = 999,
) -> Screen:
    """Test footprints (rows + known, m). allowed (m, 2): whether the estimate may be negative, and positive."""
    full = np.concatenate([residual, nuisance.pull * nuisance.off])
    blocks = np.concatenate([block, np.full(len(nuisance.names), int(block.max()) + 1)])
    groups = int(blocks.max()) + 1
    size = np.sum(footprint**2, axis=0)
    size[size == 0.0] = np.inf
    scores = sum_by(blocks, footprint * full[:, None], groups)
    total = scores.sum(axis=0)
    estimate = -total / size
    after = scores + estimate * sum_by(blocks, footprint**2, groups)
    scale = max(float(np.mean(residual**2)), 1e-12)
    left = np.maximum(np.sum(full**2) - total**2 / size, 0.0) / len(residual)
    by_noise = np.sqrt(np.minimum(left, scale) * size)
    by_windows = np.sqrt(np.sum(after**2, axis=0) * groups / max(groups - 1, 1))
    scatter = np.maximum(np.maximum(by_noise, by_windows), 1e-300)
    statistic = -total / scatter
    wild = rng.choice([-1.0, 1.0], size=(draws, groups)) @ (after / np.maximum(by_windows, 1e-300))
    largest = np.sort(np.max(np.abs(wild), axis=1, initial=0.0))
    exceed = draws - np.searchsorted(largest, np.abs(statistic) * (1.0 - 1e-12))
    p_value = (1.0 + exceed) / (1.0 + draws)
    right_sign = np.where(statistic < 0.0, allowed[:, 0], allowed[:, 1])
    return Screen(
        footprint,
        statistic,
        np.where(right_sign, p_value, 1.0),
        estimate,
        scatter / size,
        np.where(right_sign, total**2 / size, 0.0),
    )
