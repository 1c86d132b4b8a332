"""A model on the records that it was not fitted to.

How well its values predict is asked with all of them held (`unseen`); whether its form is right, with what is known
free to move there too (`refitted`): another day, another temperature.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from sms.arrays import Array
from sms.diagnosis.fitting import fit, residual_of, with_sensitivities, without_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.estimation.discrepancy import Discrepancy
from sms.estimation.least_squares import WindowFit, changed
from sms.estimation.windows import Runs

REFIT_STEPS, REFIT_NEAR = 3, 1
"""Jacobians of least squares on records that were not fitted: what is known moves little there; and with those of a
model nearby to begin with. Run time."""


def unseen(fitted: Fitted, data: Data) -> Array:
    """(rows,) residuals on the validate records, every value that was fitted to the identify records held."""
    if id(fitted) not in data.unseen_of:
        data.unseen_of[id(fitted)] = (fitted, residual_of(data.validate, fitted.params))
    return data.unseen_of[id(fitted)][1]


def refitted(fitted: Fitted, data: Data) -> Fitted:
    """The model on the validate records, its causes held. Only the first one, from which all others begin, keeps its
    sensitivities: a round compares dozens of models.
    """
    if id(fitted) not in data.refitted_of:
        before = next((at for _, at in data.refitted_of.values()), None)
        at = refitted_on(fitted, data.validate, before, data.allowed(data.validate))
        data.refitted_of[id(fitted)] = (
            fitted,
            at if before is None else without_sensitivities(at),
        )
    return data.refitted_of[id(fitted)][1]


def refitted_with_slopes(fitted: Fitted, data: Data) -> Fitted:
    """The same with all sensitivities, worked out there."""
    forgotten = without_sensitivities(refitted(fitted, data))  # those of others may have served it
    return with_sensitivities(forgotten, data.validate)


def looked_at_again(fitted: Fitted, data: Data) -> Fitted:
    """The same model with the initial states that other models have found since, where they fit its windows better.

    A window may have several: a piston sticks or slides. What the search alone gains is no merit of a model.
    """
    again = _with_better_starts(fitted, data.identify)
    validated = refitted(fitted, data)
    data.refitted_of[id(again)] = again, _with_better_starts(validated, data.validate)
    return again


def _with_better_starts(fitted: Fitted, runs: Runs) -> Fitted:
    fit = fitted.fit
    residual, jacobian = runs.problem.evaluate(fit.params, list(fitted.hypothesis.free))
    if not isinstance(fit, WindowFit) or not residual @ residual < fit.residual @ fit.residual:
        return fitted
    return replace(fitted, fit=replace(fit, residual=residual, jacobian=jacobian))


def refitted_on(
    fitted: Fitted, runs: Runs, near: Fitted | None = None, allowed: Discrepancy | None = None
) -> Fitted:
    """The model on other records: what is known may move there too (another day, another temperature), its causes are
    held. Whether its form is right is another question than how well its values predict (`unseen`).

    near: another model on the same records, whose sensitivities to what is known will do to begin with. allowed: the
    healthy machine's discrepancy on them.
    """
    h = fitted.hypothesis
    held = {n for cause in h.causes for n in cause.parameters}
    free = {n: bounds for n, bounds in h.free.items() if n not in held}
    start = changed(h.start, list(held), np.array([fitted.params[n] for n in held]))
    known = {n: u for n, u in h.known.items() if n not in held}
    moved = replace(h, start=start, free=free, known=known)
    slopes = {} if near is None else near.slopes
    if fitted.discrepancy is not None and allowed is None:
        allowed = runs.discrepancy(fitted.params, residual_of(runs, fitted.params))
        return fit(moved, runs, fitted.params, REFIT_STEPS, slopes, allowed)
    steps = REFIT_STEPS if near is None else REFIT_NEAR
    return fit(moved, runs, fitted.params, steps, slopes, allowed, roughly=True)
