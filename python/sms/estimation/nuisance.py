"""Nuisance parameters: what is known within limits may move, and what that can undo of an effect.

What is declared of them counts as so many more measurements: one a parameter, of its standard deviation, where they
are known independently; as many of their combinations, where records of the healthy machine told how their errors go
together (`Joint`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from sms import _core
from sms.arrays import Array
from sms.estimation.problem import Problem

RANK = 1e-9
"""Of a column's length: what others cannot do of it, below which it is one of them. Numerics."""
ROUNDED = 1e-14
"""The same of the square of a length that is a difference of squares. Numerics: a hundred roundings."""


@dataclass(frozen=True)
class Joint:
    """Errors of parameters that go together, as records tell them: combinations may be known far better than each."""

    names: tuple[str, ...]
    covariance: Array
    """(names, names), SI."""


@dataclass(frozen=True)
class Nuisance:
    """The free parameters: their Jacobian (rows, k), and how strongly they are pulled to what is declared."""

    names: list[str]
    jacobian: Array
    pull: Array
    """(r, k): rows W of the weighted departure W (value - declared); 0 where nothing is declared."""
    off: Array
    """(k,) value less declared value."""

    @property
    def departure(self) -> Array:
        """(r,): how far the values are from what is declared, in its standard deviations."""
        return np.asarray(self.pull @ self.off)

    def without(self, *names: str) -> Nuisance:
        """The others; what is declared of them is what it is whatever the omitted ones are."""
        keep = np.array([n not in names for n in self.names], dtype=np.bool_)
        return Nuisance(
            [n for n, k in zip(self.names, keep, strict=True) if k],
            self.jacobian[:, keep],
            _marginal(self.pull, keep),
            self.off[keep],
        )

    def with_declared(self, rows: Array) -> Array:
        """Rows (n,) or (n, m) with zeros for what is declared below."""
        below: Array = np.zeros((len(self.pull), *rows.shape[1:]))
        out: Array = np.concatenate([rows, below])
        return out

    @property
    def _stacked(self) -> Array:
        """(n + r, k): the Jacobian and what is declared, columns of length 1."""
        stacked = np.vstack([self.jacobian, self.pull])
        return np.asarray(stacked / np.maximum(np.linalg.norm(stacked, axis=0), 1e-300))

    def basis(self) -> Array:
        """(n + r, rank): an orthonormal basis of what the free parameters can do."""
        q, r = np.linalg.qr(self._stacked)
        return np.asarray(q[:, np.abs(np.diag(r)) > RANK])


def pulls(names: Sequence[str], known: Mapping[str, float], joint: Joint | None = None) -> Array:
    """(names, names): rows W so that |W (value - declared)|^2 is what a departure from what is declared costs.

    known: name -> declared standard deviation; `joint` has the covariance of those whose errors go together.
    """
    pulled = [i for i, n in enumerate(names) if n in known]
    covariance = np.diag([known[names[i]] ** 2 for i in pulled])
    if joint is not None:
        here = [k for k, i in enumerate(pulled) if names[i] in joint.names]
        there = [joint.names.index(names[pulled[k]]) for k in here]
        covariance[np.ix_(here, here)] = joint.covariance[np.ix_(there, there)]
    out = np.zeros((len(names), len(names)))
    out[np.ix_(pulled, pulled)] = _inverse_root(covariance)
    return out


def _inverse_root(covariance: Array) -> Array:
    """Lower triangle W with W'W the inverse of a covariance."""
    deviation = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(deviation, deviation)
    root = np.linalg.cholesky(correlation)
    return np.asarray(solve_triangular(root, np.diag(1.0 / deviation), lower=True))


def _marginal(pull: Array, keep: NDArray[np.bool_]) -> Array:
    """(r, kept): rows of the kept parameters where the others may be anything."""
    others = pull[:, ~keep]
    others = others / np.maximum(np.linalg.norm(others, axis=0), 1e-300)  # each has its own unit
    return np.asarray(pull[:, keep] - others @ (np.linalg.pinv(others) @ pull[:, keep]))


def nuisance_at(
    problem: Problem,
    params: _core.Params,
    names: Sequence[str],
    known: Mapping[str, float],
    joint: Joint | None = None,
) -> tuple[Array, Nuisance]:
    """The residual (rows,), and these parameters as they may move from where they are, which counts as declared."""
    residual, jacobian = problem.evaluate(params, names)
    nuisance = Nuisance(
        list(names), np.asarray(jacobian), pulls(names, known, joint), np.zeros(len(names))
    )
    return np.asarray(residual), nuisance


def project(nuisance: Nuisance, columns: Array, names: Sequence[str]) -> Array:
    """(rows + known, m): what of columns (rows, m) the free parameters cannot do; its own is no rival."""
    q, r = np.linalg.qr(nuisance._stacked)
    alone = np.abs(np.diag(r)) > RANK
    own = [i for i, name in enumerate(names) if name in nuisance.names]
    out = nuisance.with_declared(columns)
    if alone.all():
        done = q[: len(columns)].T @ columns
        _but_its_own(nuisance, q[len(columns) :], r, names, own, done, out)
        out -= q @ done
        return out
    basis = q[:, alone]
    out -= basis @ (basis[: len(columns)].T @ columns)
    for i in own:
        others = nuisance.without(names[i]).basis()
        full = nuisance.with_declared(columns[:, i])
        out[:, i] = full - others @ (others.T @ full)
    return out


def _but_its_own(
    nuisance: Nuisance,
    declared: Array,
    r: Array,
    names: Sequence[str],
    own: Sequence[int],
    done: Array,
    out: Array,
) -> None:
    """Takes from `done` (k, m), which is what all parameters can do of each column as combinations of the columns of
    Q, what its own parameter alone can; and from `out` what is declared of that one.

    declared: the rows of Q below the Jacobian. The stacked matrix is Q R. What one parameter can do and the others
    cannot is along Q w, with w the solution of R' w = e, of length 1. The others may do what is declared of the one,
    too (Nuisance.without): the part of that row d that they cannot do otherwise is d + Q g, which is orthogonal to all
    that they can, so that what it takes of a column c is along (c'd + c'Q g) = (Q'c)'g, since c is zero there.
    """
    for i in own:
        k = nuisance.names.index(names[i])
        unit = np.zeros(len(nuisance.names))
        unit[k] = 1.0
        w = solve_triangular(r, unit, trans="T")
        w /= np.linalg.norm(w)
        column = done[:, i].copy()
        done[:, i] -= w * float(w @ column)
        length = float(np.linalg.norm(nuisance.pull[:, k]))
        if length == 0.0:
            continue
        d = nuisance.pull[:, k] / length
        shares = declared.T @ d
        g = w * float(w @ shares) - shares
        below = declared @ g
        size = float((d + below) @ (d + below) + g @ g - below @ below)
        if size > ROUNDED:
            taken = float(g @ column) / size
            done[:, i] += taken * g
            out[-len(d) :, i] -= taken * d
