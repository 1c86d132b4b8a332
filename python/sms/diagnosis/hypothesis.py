"""A model at one moment: which parameters may move and how far, and its fit to records.

The baseline frees what the rig file declares as unknown, and what it declares with an uncertainty within that. Each
cause that was found adds its parameters.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.estimation.block_statistics import covariance_of, project_off
from sms.estimation.least_squares import Free, Solution, changed
from sms.estimation.nuisance import Nuisance, pulls
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.parameters import PARAMETERS, Parameter

FLOW_MAP = tuple(n for n in PARAMETERS if n.startswith("flow_map_"))
ALWAYS_UNCERTAIN = ("stiction_shape", *FLOW_MAP)
"""Parameters that a simulation may move although no rig file mentions them: their uncertainty is that of params.def."""
REFIT_STEPS = 3
"""Of least squares on records that were not fitted: what is known moves little there. Run time."""
SAME_MACHINE = 0.1
"""Of what is declared: by how much a number may differ between a day when the machine was well and today. Judgement."""
WIDE = 3.0
"""Half widths that a map may be off somewhere: what is declared of a map is that of most of its values."""


@dataclass(frozen=True)
class Hypothesis:
    """Which parameters may move, and how far: name -> (lower, upper). `start` has every other one.

    A parameter in `known` (name -> declared uncertainty) is pulled to its declared value as by one sample.
    """

    start: _core.Params
    free: dict[str, tuple[float, float]]
    known: dict[str, float]
    causes: tuple[Effect, ...] = ()
    table: Mapping[str, Parameter] = field(default_factory=lambda: PARAMETERS, repr=False)
    """Bounds and units of every parameter."""
    sample: float = 1.0
    """Standard deviation of a residual: 1 where they are in units of the noise, else that of the declared model."""

    @property
    def with_exact_maps(self) -> Hypothesis:
        """The valve's tables taken as they are."""
        free = {n: bounds for n, bounds in self.free.items() if n not in FLOW_MAP}
        return replace(self, free=free, known={n: u for n, u in self.known.items() if n in free})

    def with_effect(self, effect: Effect) -> Hypothesis:
        """The effect's parameters freed within their bounds."""
        wide = {
            name: (self.table[name].lower, self.table[name].upper) for name in effect.parameters
        }
        known = {name: u for name, u in self.known.items() if name not in wide}
        return replace(self, free=self.free | wide, known=known, causes=(*self.causes, effect))


@dataclass(frozen=True)
class Fitted:
    """A hypothesis fitted to the identify records."""

    hypothesis: Hypothesis
    fit: Solution
    covariance: Array
    """(free, free), robust to correlation within blocks; zero rows for a parameter at its bound."""
    columns: dict[str, Array] = field(default_factory=dict, repr=False, compare=False)
    """Effect -> (rows,) change of the residual with it, as far as they have been worked out (visible.raw_columns)."""

    @property
    def params(self) -> _core.Params:
        return self.fit.params

    def standard_error(self, name: str) -> float:
        k = list(self.hypothesis.free).index(name)
        return float(np.sqrt(max(self.covariance[k, k], 0.0)))

    @property
    def movable(self) -> list[str]:
        """Free parameters that are not held by a bound."""
        return [
            n for n, held in zip(self.hypothesis.free, self.fit.at_bound, strict=True) if not held
        ]


@dataclass(frozen=True)
class Data:
    """The records of a rig, by role."""

    rig: Rig
    identify: Runs
    validate: Runs
    test: Runs | None = None
    """Records on which gains are reported and nothing is decided."""
    reference: Runs | None = None
    """Records of the same machine when it was known to be well."""
    unseen_of: dict[int, tuple[Fitted, Fitted]] = field(default_factory=dict, repr=False)
    """What `unseen` has worked out already."""


# ---- fits ----------------------------------------------------------------------------------------


def baseline_hypothesis(data: Data, effects: Sequence[Effect]) -> Hypothesis:
    """Parameters as declared; free are those to be fitted, and those that have a declared uncertainty.

    A free parameter that leaves no trace in the identify records stays where it is.
    """
    rig = data.rig
    start = rig.start()
    names = [n for n, d in rig.parameters.items() if d.fit]
    known = [n for e in effects for n in e.parameters if n not in names]
    if (
        data.identify.whitened
    ):  # a simulation feels every parameter, not only those that are effects
        known += [n for n, d in rig.parameters.items() if d.uncertainty > 0.0 and not d.fit]
        known += [n for n in ALWAYS_UNCERTAIN if n in rig.table and n not in rig.parameters]
    free: dict[str, tuple[float, float]] = {}
    uncertain: dict[str, float] = {}
    for name in dict.fromkeys(names + known):
        declared, bounds = rig.declared(name), rig.table[name]
        if declared.fit:
            free[name] = (bounds.lower, bounds.upper)
        elif declared.uncertainty > 0.0:
            uncertain[name] = declared.uncertainty
            room = declared.uncertainty * (WIDE if name in FLOW_MAP else 1.0)
            free[name] = (
                max(bounds.lower, declared.value - room),
                min(bounds.upper, declared.value + room),
            )
    residual, jacobian = data.identify.problem.evaluate(start, list(free))
    seen = np.linalg.norm(jacobian, axis=0) > 0.0
    movable = {n: b for n, b, s in zip(free, free.values(), seen, strict=True) if s}
    sample = 1.0 if data.identify.whitened else float(np.sqrt(np.mean(residual**2)))
    return Hypothesis(start, movable, uncertain, table=rig.table, sample=sample)


def from_reference(hypothesis: Hypothesis, data: Data) -> tuple[Hypothesis, Fitted]:
    """What records of the healthy machine tell of it: where its numbers lie, and how much nearer than was declared.

    The others are then asked what has changed. A number is known to two standard errors, at best to a tenth of what was
    declared: a machine is not quite the same from day to day.
    """
    assert data.reference is not None
    h, healthy = hypothesis, fit(hypothesis, data.reference)
    start, free, known = h.start.copy(), dict(h.free), dict(h.known)
    for name in [n for n in h.free if n in h.known]:
        start[name] = healthy.params[name]
        width = max(2.0 * healthy.standard_error(name), SAME_MACHINE * h.known[name])
        known[name] = min(width, h.known[name])
        room = WIDE * known[name]
        bounds = h.table[name]
        free[name] = (max(bounds.lower, start[name] - room), min(bounds.upper, start[name] + room))
    return replace(h, start=start, free=free, known=known), healthy


def fit(
    hypothesis: Hypothesis,
    runs: Runs,
    initial: _core.Params | None = None,
    most_steps: int | None = None,
) -> Fitted:
    """Least squares over the hypothesis' free parameters, with a covariance that is robust to blocks."""
    free = free_of(hypothesis)
    found = runs.fit(initial or hypothesis.start, free, most_steps)
    covariance = _covariance(found, free, runs)
    held = np.array(found.at_bound, dtype=bool)
    covariance[held, :] = covariance[:, held] = 0.0
    return Fitted(hypothesis, found, covariance)


def free_of(hypothesis: Hypothesis) -> list[Free]:
    """The free parameters, each pulled to what is declared."""
    h = hypothesis
    return [
        Free(n, low, high, h.sample / h.known[n] if n in h.known else 0.0, h.start[n])
        for n, (low, high) in h.free.items()
    ]


def _covariance(found: Solution, free: list[Free], runs: Runs) -> Array:
    """(free, free). Without a declared noise the blocks alone say how sure an estimate is."""
    covariance = np.zeros((len(free), len(free)))
    if not runs.whitened:
        moved = np.flatnonzero(~np.array(found.at_bound, dtype=bool))
        if len(moved):
            covariance[np.ix_(moved, moved)] = covariance_of(
                found.jacobian[:, moved], found.residual, runs.block
            )
        return covariance
    pull = np.array([f.pull for f in free])
    bread = np.linalg.pinv(found.jacobian.T @ found.jacobian + np.diag(pull**2), hermitian=True)
    noise = max(float(np.mean(found.residual**2)), 1e-12)
    robust = covariance_of(found.jacobian, found.residual, runs.block) if free else bread
    # With more parameters than windows the robust one has too low a rank: the larger of the two variances holds.
    inflate = np.sqrt(np.maximum(np.diag(robust) / np.maximum(np.diag(noise * bread), 1e-300), 1.0))
    inflate = np.minimum(inflate, 10.0)
    return np.asarray(noise * bread * np.outer(inflate, inflate))


def residual_of(runs: Runs, params: _core.Params) -> Array:
    residual, _ = runs.problem.evaluate(params)
    return np.asarray(residual)


def unseen(fitted: Fitted, data: Data) -> Array:
    """(rows,) residuals on the validate records; what was found on the identify records stays."""
    return residual_on(fitted, data, data.validate)


def residual_on(fitted: Fitted, data: Data, runs: Runs) -> Array:
    """(rows,) residuals on the validate or test records.

    Where a simulation is held against them, the known parameters may move within their declared uncertainty on these
    records too (another day, another temperature).
    """
    if not runs.whitened:
        return residual_of(runs, fitted.params)
    at = refitted(fitted, data) if runs is data.validate else refitted_on(fitted, runs)
    return at.fit.residual


def refitted(fitted: Fitted, data: Data) -> Fitted:
    """The model on the validate records, its causes held."""
    if id(fitted) not in data.unseen_of:
        data.unseen_of[id(fitted)] = (fitted, refitted_on(fitted, data.validate))
    return data.unseen_of[id(fitted)][1]


def refitted_on(fitted: Fitted, runs: Runs) -> Fitted:
    """The model on other records: what is known may move there too, its causes are held."""
    h = fitted.hypothesis
    held = {n for cause in h.causes for n in cause.parameters}
    free = {n: bounds for n, bounds in h.free.items() if n not in held}
    start = changed(h.start, list(held), np.array([fitted.params[n] for n in held]))
    known = {n: u for n, u in h.known.items() if n not in held}
    return fit(replace(h, start=start, free=free, known=known), runs, fitted.params, REFIT_STEPS)


def sensitivities(fitted: Fitted, runs: Runs, names: list[str]) -> Array:
    """(rows, names): how the residual changes with each parameter, beyond what the free ones can undo."""
    nuisance = [n for n in fitted.movable if n not in names]
    _, jacobian = runs.problem.evaluate(fitted.params, nuisance + names)
    return project_off(jacobian[:, len(nuisance) :], jacobian[:, : len(nuisance)])


def nuisance_of(fitted: Fitted) -> Nuisance:
    """The free parameters that are not held by a bound, at the solution."""
    h = fitted.hypothesis
    movable = fitted.movable
    place = [list(h.free).index(n) for n in movable]
    return Nuisance(
        movable,
        fitted.fit.jacobian[:, place],
        h.sample * pulls(movable, h.known),
        np.array([fitted.params[n] - h.start[n] for n in movable]),
    )
