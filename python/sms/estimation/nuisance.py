"""Nuisance parameters: what is known within limits may move, and what that can undo of an effect.

How strongly a parameter is pulled to what is declared is one over its uncertainty, so that what is declared counts as
one more measurement.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.estimation.problem import Problem


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
