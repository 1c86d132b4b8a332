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
from sms.estimation.block_statistics import (
    covariance_from,
    covariance_of,
    leveraged_covariance,
    project_off,
)
from sms.estimation.discrepancy import Discrepancy
from sms.estimation.jump_times import with_jump_times
from sms.estimation.least_squares import (
    MOST_STEPS,
    Free,
    Solution,
    WindowFit,
    counted_rows,
)
from sms.estimation.nuisance import Joint, Nuisance, pulls
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.parameters import (
    GEOMETRY,
    LINEARITY,
    MAPS,
    PARAMETERS,
    SENSORS,
    SPECIMENS,
    Parameter,
    common_parameter,
)

ALWAYS_UNCERTAIN = ("stiction_shape", "end_stop_stiffness", "end_stop_damping", *MAPS, *SENSORS)
"""Parameters that a simulation may move although no rig file mentions them: their uncertainty is that of params.def."""
TURNS, SETTLED = 2, 0.2
"""Of parameters and discrepancy, each for the other; and the change of the logarithm of tau that ends it. Run time."""
CURVES = (*MAPS, *LINEARITY)
WIDE = 3.0
"""Half widths that a curve may be off somewhere: what is declared of a map or a sensor's line is that of most of it,
and a bow is not the form of every such error."""


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
    joint: Joint | None = None
    """How the errors of what is in `known` go together; None: independent."""
    sample: float = 1.0
    """Standard deviation of a residual: 1 where they are in units of the noise, else that of the declared model."""
    inflation: float = 1.0
    """How many times larger the variance of an estimate is than residuals as they are counted have it."""

    @property
    def with_exact_maps(self) -> Hypothesis:
        """The valve's tables and the friction curve taken as they are."""
        free = {n: bounds for n, bounds in self.free.items() if common_parameter(n) not in MAPS}
        return replace(self, free=free, known={n: u for n, u in self.known.items() if n in free})

    def with_effect(
        self, effect: Effect, plausible: tuple[float, float] | None = None
    ) -> Hypothesis:
        """The effect's parameters freed within their bounds, its first one within what is plausible if given.

        The first one is its size; of the others it is known what is declared of them (the critical ratio of a leak),
        else that their bounds hold all such machines but one in twenty: records that are insensitive to one leave it
        where it is.
        """
        wide = {
            name: (self.table[name].lower, self.table[name].upper) for name in effect.parameters
        }
        if plausible is not None:
            low, high = wide[effect.parameters[0]]
            wide[effect.parameters[0]] = max(low, plausible[0]), min(high, plausible[1])
        known = {name: u for name, u in self.known.items() if name not in wide}
        for name in effect.parameters[1:]:
            low, high = wide[name]
            known[name] = self.known.get(name, self.table[name].uncertainty) or (high - low) / 4.0
        return replace(self, free=self.free | wide, known=known, causes=(*self.causes, effect))


@dataclass(frozen=True)
class Fitted:
    """A hypothesis fitted to the identify records."""

    hypothesis: Hypothesis
    fit: Solution
    covariance: Array
    """(free, free), robust to correlation within blocks; zero rows for a parameter at its bound."""
    discrepancy: Discrepancy | None = field(default=None, repr=False, compare=False)
    """With whose covariance it was fitted; None: noise alone."""
    columns: dict[str, Array] = field(default_factory=dict, repr=False, compare=False)
    """Effect -> (rows,) change of the residual with it, as far as they have been worked out (visible.raw_columns)."""

    @property
    def params(self) -> _core.Params:
        return self.fit.params

    @property
    def slopes(self) -> dict[str, Array]:
        """Of each free parameter (rows,): how the residual changes with it; none of a model that has forgotten them."""
        if not len(self.fit.jacobian):
            return {}
        return dict(zip(self.hypothesis.free, self.fit.jacobian.T, strict=True))

    def whiten(self, values: Array) -> Array:
        """Residuals or sensitivities (rows, ...) of the records it was fitted to, as independent as noise."""
        return values if self.discrepancy is None else self.discrepancy.whitener.whiten(values)

    def standard_error(self, name: str, held: Sequence[str] = ()) -> float:
        """Of a free parameter; held: were these others known."""
        free = list(self.hypothesis.free)
        k, others = free.index(name), [free.index(n) for n in held]
        between = self.covariance[k, others]
        known = self.covariance[np.ix_(others, others)]
        variance = self.covariance[k, k] - between @ np.linalg.pinv(known, hermitian=True) @ between
        return float(np.sqrt(max(variance, 0.0)))

    @property
    def movable(self) -> list[str]:
        """Free parameters that are not held by a bound."""
        return [
            n for n, held in zip(self.hypothesis.free, self.fit.at_bound, strict=True) if not held
        ]


@dataclass(frozen=True)
class Healthy:
    """What the model of a machine leaves when it is well, as reference records tell. Arrays (channels,)."""

    identify: Discrepancy
    """On the records that are fitted."""
    validate: Discrepancy
    level: Array
    """Mean square of a residual, in units of the noise and of that discrepancy."""
    plain: Array
    """The same in units of the noise alone."""
    spread: Array
    """By how much that of one record is above the level, as a share of it."""
    inflation: float
    """How many times larger the variance of an estimate is by the scatter of blocks than by such residuals."""


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
    unseen_of: dict[int, tuple[Fitted, Array]] = field(default_factory=dict, repr=False)
    """What `unseen` has worked out already."""
    refitted_of: dict[int, tuple[Fitted, Fitted]] = field(default_factory=dict, repr=False)
    """What `refitted` has worked out already."""
    healthy: Healthy | None = None
    """What the model of the healthy machine leaves anyway; None without reference records."""

    @property
    def as_declared(self) -> Data:
        """The same without what reference records told."""
        return replace(self, healthy=None, unseen_of={}, refitted_of={})

    def timed(self, params: _core.Params) -> Data:
        """The same with recorded commands that jump when the readings of a machine with these parameters say."""
        identify, validate = (with_jump_times(r, params) for r in (self.identify, self.validate))
        test = None if self.test is None else with_jump_times(self.test, params)
        return replace(
            self, identify=identify, validate=validate, test=test, unseen_of={}, refitted_of={}
        )

    def allowed(self, runs: Runs) -> Discrepancy | None:
        """The healthy machine's own discrepancy on the records of a role; None where none told."""
        if self.healthy is None:
            return None
        return self.healthy.identify if runs is self.identify else self.healthy.validate


# ---- fits ----------------------------------------------------------------------------------------


def baseline_hypothesis(data: Data, effects: Sequence[Effect]) -> Hypothesis:
    """Parameters as declared; free are those to be fitted, and those that have a declared uncertainty.

    A free parameter that leaves no trace in the identify records stays where it is.
    """
    rig = data.rig
    start = rig.start()
    names = [n for n, d in rig.parameters.items() if d.fit]
    of_effects = [n for e in effects for n in e.parameters if n not in names]
    # Of a cylinder the noise is not declared, and what its sensors are calibrated to neither. Where joints are moves
    # on request only: each is a run of the mechanism for every sample.
    held = GEOMETRY if data.identify.whitened else SENSORS
    known = [n for n in of_effects if n in rig.parameters or common_parameter(n) not in held]
    if (
        data.identify.whitened
    ):  # a simulation depends on every parameter, not only on those of effects
        known += [n for n, d in rig.parameters.items() if d.uncertainty > 0.0 and not d.fit]
        known += [n for n in rig.table if common_parameter(n) in ALWAYS_UNCERTAIN]
    free: dict[str, tuple[float, float]] = {}
    uncertain: dict[str, float] = {}
    for name in dict.fromkeys(names + known):
        declared, bounds = rig.declared(name), rig.table[name]
        if declared.fit:
            free[name] = (bounds.lower, bounds.upper)
        elif declared.uncertainty > 0.0:
            uncertain[name] = declared.uncertainty
            room = declared.uncertainty * (WIDE if common_parameter(name) in CURVES else 1.0)
            free[name] = (
                max(bounds.lower, declared.value - room),
                min(bounds.upper, declared.value + room),
            )
    residual, jacobian = data.identify.problem.evaluate(start, list(free))
    seen = np.linalg.norm(jacobian, axis=0) > 0.0
    movable = {n: b for n, b, s in zip(free, free.values(), seen, strict=True) if s}
    sample = 1.0 if data.identify.whitened else float(np.sqrt(np.mean(residual**2)))
    return Hypothesis(start, movable, uncertain, table=rig.table, sample=sample)


def fit(
    hypothesis: Hypothesis,
    runs: Runs,
    initial: _core.Params | None = None,
    most_steps: int = MOST_STEPS,
    nearby: Mapping[str, Array] | None = None,
    discrepancy: Discrepancy | None = None,
    roughly: bool = False,
    stated: bool = False,
) -> Fitted:
    """Least squares over the hypothesis' free parameters, with a covariance that is robust to blocks.

    most_steps: Jacobians that are worked out at most. nearby: parameter -> (rows,) change of the residual with it near
    the initial ones. roughly: of what two specimens of a type differ by, those serve to the end. stated: its values are
    (fit_windows).
    """
    free = free_of(hypothesis)
    names = [f.name for f in free]
    slopes = {n: column for n, column in (nearby or {}).items() if n in names}
    kept = {n for n in slopes if roughly and common_parameter(n) in SPECIMENS}
    pull = weights_of(hypothesis, names)
    start = initial or hypothesis.start
    found = runs.fit(start, free, pull, most_steps, slopes, kept, discrepancy, stated)
    fitted = Fitted(hypothesis, found, np.empty((0, 0)), discrepancy)
    covariance = _covariance(fitted, pull, runs)
    held = np.array(found.at_bound, dtype=bool)
    covariance[held, :] = covariance[:, held] = 0.0
    return replace(fitted, covariance=covariance)


def fit_with_discrepancy(
    hypothesis: Hypothesis,
    runs: Runs,
    initial: _core.Params | None = None,
    alike: bool = False,
) -> Fitted:
    """Generalised least squares: parameters and the size of what no parameter explains, in turn (discrepancy.py).

    alike: that size is one for all windows, as it has to be to hold on other records.
    """
    start = initial or hypothesis.start
    now = runs.discrepancy(start, residual_of(runs, start), alike)
    return settled(fit(hypothesis, runs, start, discrepancy=now, stated=True), runs)


def settled(fitted: Fitted, runs: Runs) -> Fitted:
    """The same hypothesis with the discrepancy that it leaves itself, and fitted again with that."""
    for _ in range(TURNS):
        before = fitted.discrepancy
        if before is None:
            return fitted
        counted = np.unique(runs.window[counted_rows(fitted.fit)])
        now = before.fitted_to(fitted.fit.residual, counted)
        felt = before.tau > 0.0
        if np.all(np.abs(np.log(now.tau[felt] / before.tau[felt])) < SETTLED):
            break
        fitted = fit(
            fitted.hypothesis,
            runs,
            fitted.params,
            nearby=fitted.slopes,
            discrepancy=now,
            stated=True,
        )
    return fitted


def free_of(hypothesis: Hypothesis) -> list[Free]:
    """The free parameters, each pulled to what is declared."""
    h = hypothesis
    return [
        Free(n, low, high, h.sample / h.known[n] if n in h.known else 0.0, h.start[n])
        for n, (low, high) in h.free.items()
    ]


def weights_of(hypothesis: Hypothesis, names: list[str]) -> Array:
    """(names, names): rows that pull parameters to what is declared, beside residuals as they are counted."""
    h = hypothesis
    return h.sample * float(np.sqrt(h.inflation)) * pulls(names, h.known, h.joint)


def cost_of_departure(fitted: Fitted) -> float:
    """How far the values are from what is declared, as chi-square."""
    return departure(fitted.hypothesis, fitted.params)


def departure(h: Hypothesis, params: _core.Params) -> float:
    """The same of other values than the fitted ones."""
    names = list(h.free)
    off = np.array([params[n] - h.start[n] for n in names])
    return float(np.sum((weights_of(h, names) @ off) ** 2))


def _covariance(fitted: Fitted, pull: Array, runs: Runs) -> Array:
    """(free, free), by the scatter of blocks; by the noise where it is declared and says more, since few blocks hardly
    tell their scatter."""
    found, covariance = fitted.fit, np.zeros((pull.shape[1], pull.shape[1]))
    # Where a bound holds a parameter its sensitivities are left in the residual: it had no part in the fit.
    moved = np.flatnonzero(~np.array(found.at_bound, dtype=bool))
    weight = fitted.hypothesis.sample**2 * fitted.hypothesis.inflation
    known = pull[:, moved].T @ pull[:, moved] / weight
    if not runs.whitened:
        if len(moved):
            covariance[np.ix_(moved, moved)] = covariance_of(
                found.jacobian[:, moved], found.residual, runs.block, known, weight
            )
        return covariance
    rows = counted_rows(fitted.fit)
    jacobian, residual = fitted.whiten(found.jacobian)[rows], fitted.whiten(found.residual)[rows]
    block = runs.block[rows]
    bread = covariance_from(jacobian.T @ jacobian + pull.T @ pull)
    noise = max(float(np.mean(residual**2)), 1e-12) * fitted.hypothesis.inflation
    by_noise = np.diag(noise * bread)
    robust = leveraged_covariance(jacobian[:, moved], residual, block, known, weight)
    by_blocks = np.zeros(len(by_noise))
    by_blocks[moved] = np.diag(robust)
    inflate = np.sqrt(np.maximum(by_blocks / np.maximum(by_noise, 1e-300), 1.0))
    return np.asarray(noise * bread * np.outer(inflate, inflate))


def without_sensitivities(fitted: Fitted) -> Fitted:
    """The same model for whoever asks for its values: a round of the search holds dozens of them."""
    if not isinstance(fitted.fit, WindowFit) or not (len(fitted.fit.jacobian) or fitted.columns):
        return fitted
    none = np.empty((0, len(fitted.hypothesis.free)))
    return replace(fitted, fit=replace(fitted.fit, jacobian=none), columns={})


def with_sensitivities(fitted: Fitted, runs: Runs) -> Fitted:
    """The same model on its records with all sensitivities, worked out there if it has forgotten them."""
    if not isinstance(fitted.fit, WindowFit) or len(fitted.fit.jacobian):
        return fitted
    residual, jacobian = runs.problem.evaluate(fitted.params, list(fitted.hypothesis.free))
    return replace(
        fitted, fit=replace(fitted.fit, residual=residual, jacobian=jacobian), columns={}
    )


def residual_of(runs: Runs, params: _core.Params) -> Array:
    residual, _ = runs.problem.evaluate(params)
    return np.asarray(residual)


def sensitivities(fitted: Fitted, runs: Runs, names: list[str]) -> Array:
    """(rows, names): how the residual changes with each parameter, beyond what the free ones can undo."""
    nuisance = [n for n in fitted.movable if n not in names]
    _, jacobian = runs.problem.evaluate(fitted.params, nuisance + names)
    return project_off(jacobian[:, len(nuisance) :], jacobian[:, : len(nuisance)])


def nuisance_of(fitted: Fitted, white: bool = False, held: bool = False) -> Nuisance:
    """The free parameters that are not held by a bound, at the solution; their sensitivities whitened if asked for.

    held: those too that are held by one.
    """
    h = fitted.hypothesis
    movable = list(h.free) if held else fitted.movable
    slopes = fitted.fit.jacobian[:, [list(h.free).index(n) for n in movable]].astype(np.float64)
    return Nuisance(
        movable,
        fitted.whiten(slopes) if white else slopes,
        weights_of(h, movable),
        np.array([fitted.params[n] - h.start[n] for n in movable]),
    )
