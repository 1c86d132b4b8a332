"""A model at one moment: which parameters may move and how far, and the records by role.

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
from sms.estimation.discrepancy import Discrepancy
from sms.estimation.jump_times import with_jump_times
from sms.estimation.least_squares import Solution
from sms.estimation.nuisance import Joint
from sms.estimation.windows import Runs
from sms.io.rig import Rig
from sms.parameters import (
    GEOMETRY,
    LINEARITY,
    MAPS,
    PARAMETERS,
    SENSORS,
    Parameter,
    common_parameter,
)

ALWAYS_UNCERTAIN = ("stiction_shape", "end_stop_stiffness", "end_stop_damping", *MAPS, *SENSORS)
"""Parameters that a simulation may move although no rig file mentions them: their uncertainty is that of params.def."""
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
