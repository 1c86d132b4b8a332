"""Effects tried at finite sizes with all else held: a linear step says nothing of a long way.

On an excerpt of the records: the windows with the largest error, and some evenly over all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sms import _core
from sms.arrays import Array
from sms.diagnosis.adequacy.residual_energy import beyond_healthy, energies, logarithms
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import residual_of
from sms.diagnosis.hypothesis import Data, Fitted, Hypothesis
from sms.diagnosis.selection.candidates import moved, room_of
from sms.diagnosis.thresholds import FINITE_STEPS, REFINED, STEPPED_ON, TRIED_BY_STEP, TWINS
from sms.estimation.least_squares import Free, changed, fit_windows
from sms.estimation.windows import Runs
from sms.parameters import common_parameter


def telling_windows(runs: Runs, residual: Array) -> list[int]:
    """Windows on which finite steps are tried: the worst ones, and as many evenly over all."""
    left = np.log1p(energies(runs, residual)).sum(axis=1)
    worst = np.argsort(-left)[:STEPPED_ON]
    evenly = np.linspace(0, len(left) - 1, min(STEPPED_ON, len(left))).round().astype(int)
    return sorted({int(k) for k in (*worst, *evenly)})


def extended(hypothesis: Hypothesis, effect: Effect, data: Data) -> Hypothesis:
    """With the effect, its size within what is plausible."""
    reference = data.rig.declared(common_parameter(effect.parameters[0])).value
    return hypothesis.with_effect(effect, effect.plausible_range(reference))


@dataclass(frozen=True)
class Step:
    """An effect at the best of the sizes at which it was tried on an excerpt, all else held."""

    gain: float
    """By how much it lowers the logarithms of what is left."""
    params: _core.Params
    change: Array
    """(rows,) of the excerpt's residual."""


def best_steps(
    effects: Sequence[Effect], current: Fitted, data: Data, declared: bool
) -> list[Step]:
    """Of each effect on top of a model, on the windows that tell most.

    declared: from what is declared known, in place of what the model made of it. A change that other numbers have made
    up for is then in plain sight.
    """
    base = _as_declared(current) if declared else current.params
    left = beyond_healthy(data, data.identify, residual_of(data.identify, base))
    excerpt = data.identify.excerpt(telling_windows(data.identify, left))
    excerpt.problem.settle(base)  # else each size looks for its initial states from the readings on
    before = residual_of(excerpt, base)
    tried = [_best_of_ladder(e, base, data, excerpt, before) for e in effects]
    least = REFINED * max((step.gain for step in tried), default=0.0)
    return [
        _refined(step, e, current, base, data, excerpt, before)
        if step.gain > least or len(e.parameters) > 1
        else step
        for step, e in zip(tried, effects, strict=True)
    ]


def _as_declared(current: Fitted) -> _core.Params:
    known = list(current.hypothesis.known)
    return changed(current.params, known, np.array([current.hypothesis.start[n] for n in known]))


def _best_of_ladder(
    effect: Effect, base: _core.Params, data: Data, excerpt: Runs, before: Array
) -> Step:
    """The best of a ladder of sizes. base: what all else is held at, which leaves `before` (rows,) of the excerpt."""
    name = effect.parameters[0]
    here = logarithms(excerpt, before)
    nothing = Step(0.0, base, np.zeros(len(before)))
    # The first of several parameters may help only with another value of the others.
    best = nothing if len(effect.parameters) == 1 else Step(-np.inf, base, nothing.change)
    low, high = room_of(effect, base, data.rig)
    ladders = [[part * end for part in FINITE_STEPS] for end in (low, high) if end != 0.0]
    if low > 0.0 or high < 0.0:  # what is plausible begins away from here
        ladders = [[low], [high]]
    for ladder in ladders:
        for change in ladder:
            params = changed(base, [name], np.array([moved(effect, base, change, data.rig)]))
            residual = residual_of(excerpt, params)
            if not np.all(np.isfinite(residual)):
                continue
            gain = here - logarithms(excerpt, residual)
            if gain > best.gain:
                best = Step(gain, params, residual - before)
            if gain < -len(excerpt.problem.windows):  # worse by far: larger ones are no better
                break
    return nothing if best.params is base else best


def _refined(
    best: Step,
    effect: Effect,
    current: Fitted,
    base: _core.Params,
    data: Data,
    excerpt: Runs,
    before: Array,
) -> Step:
    """Least squares over the effect's own parameters, from the best of the ladder."""
    if best.params is base:
        return best
    nothing = Step(0.0, base, np.zeros(len(best.change)))
    bounds = extended(current.hypothesis, effect, data).free
    free = [Free(n, *bounds[n], 0.0, base[n]) for n in effect.parameters]
    found = fit_windows(excerpt.problem, best.params, free)
    gain = logarithms(excerpt, before) - logarithms(excerpt, found.residual)
    refined = Step(gain, found.params, found.residual - before)
    if all(
        found.params[n] == base[n] for n in effect.parameters
    ):  # a search for the initial states, and no effect
        refined = nothing
    return max(nothing, best, refined, key=lambda step: step.gain)


def chosen_by_step(steps: Sequence[Step]) -> tuple[list[int], list[int]]:
    """Those that help most, each in a direction of its own; and others that do nearly the same as the first of them."""
    helping = [
        k for k in sorted(range(len(steps)), key=lambda k: -steps[k].gain) if steps[k].gain > 0.0
    ]
    change = np.array([step.change for step in steps])
    unit = change / np.maximum(np.linalg.norm(change, axis=1), 1e-300)[:, None]
    alike = unit @ unit.T > TWINS
    first = first_of_each(helping, alike)[:TRIED_BY_STEP]
    return first, [k for k in helping if alike[first[0], k] and k not in first]


def first_of_each(order: Sequence[int], alike: NDArray[np.bool_]) -> list[int]:
    """In that order, without what is alike to one before: several names of one change take one place."""
    first: list[int] = []
    for k in order:
        if not np.any(alike[k, first]):
            first.append(k)
    return first
