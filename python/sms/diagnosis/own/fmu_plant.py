"""An FMU as the functions of a model: by its rates (model exchange), or by its steps (co-simulation).

Model exchange has the Runge-Kutta step of every own model, with derivatives by the state where the FMU has directional
derivatives. Co-simulation brings its own integrator: the states are its start values, and every step from sample to
sample begins with them anew; an input is held at its mean over the step, and a hidden input is added after it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.diagnosis.own.fmu_calls import Fmu, Names, Pool, in_sets, native_calls
from sms.diagnosis.own.steps import runge_kutta
from sms.errors import InputError

LATER = (0.73, 41.9)
"""s, at which rates are asked for beside those at 0: no period has both."""
SHORT = 1e-4
"""s: of the step by which co-simulation is asked for a rate."""


class _ByName:
    """Parameters by name as one array."""

    by_parameters = False

    def __init__(self, fmu: Fmu, names: Names, called: tuple[str, ...]) -> None:
        self._fmu, self._names, self._called = fmu, names, called
        self._parameters = fmu.references(names.parameters, "parameter")
        self._last: tuple[Array, list[tuple[Array, Index]]] | None = None

    def numbers(self, p: Any, n: int) -> Array:
        """(parameters, n)"""
        out = np.empty((len(self._called), n))
        for k, name in enumerate(self._called):
            out[k] = p[name]
        return out

    def _sets(self, p: Any, n: int) -> list[tuple[Array, Index]]:
        """As `in_sets`; a simulation asks with the same values at every step."""
        numbers = p if isinstance(p, np.ndarray) else self.numbers(p, n)
        if not self._called:
            numbers = np.zeros((1, n))
        if self._last is None or not np.array_equal(self._last[0], numbers):
            self._last = numbers.copy(), in_sets(numbers)
        return self._last[1]

    def _of_values(self, values: Array) -> dict[int, float]:
        return dict(zip(self._parameters, values.tolist(), strict=False))


class Exchange(_ByName):
    """Model exchange."""

    adaptive = False

    def __init__(self, fmu: Fmu, names: Names, called: tuple[str, ...]) -> None:
        super().__init__(fmu, names, called)
        self.by_state = fmu.directional
        self._timeless = False
        self._pool = Pool(fmu.most_instances, self._configured)

    def _configured(
        self, old: tuple[Any, _core.FmuCalls | None] | None, values: Array
    ) -> tuple[Any, _core.FmuCalls | None]:
        instance = self._fmu.instance() if old is None else old[0]
        try:
            self._fmu.initialised(instance, self._of_values(values))
        except InputError:
            raise
        except Exception:  # values that the FMU refuses: a simulation that cannot go on
            return self._fmu.instance(), None
        calls = native_calls(self._fmu, instance, self._names)
        if not self._timeless:
            self._refuse_time(instance, calls)
            self._timeless = True
        return instance, calls

    def _refuse_time(self, instance: Any, calls: _core.FmuCalls) -> None:
        """InputError for rates or outputs that follow time itself: a window begins anywhere in a record."""
        x, u = (
            np.array([[float(self._fmu.variables[n].start or 0.0) for n in names]])
            for names in (self._names.states, self._names.inputs)
        )
        found = []
        for time in (0.0, *LATER, 0.0):
            instance.setTime(time)
            found.append(np.hstack([calls.rates(x, u), calls.readings(x, u)]))
        if any(not np.array_equal(found[0], other, equal_nan=True) for other in found):
            raise InputError(
                f"{self._fmu.file}: {self._fmu.description.modelName} follows time itself, and a window begins "
                "anywhere in a record; export it with what follows time as an input, and record that"
            )

    def derivative(self, p: Any, x: Array, u: Array) -> Array:
        """(states, n)"""
        return self._each(p, x, u, len(x), _core.FmuCalls.rates)

    def output(self, p: Any, x: Array, u: Array) -> Array:
        """(outputs, n)"""
        return self._each(p, x, u, len(self._names.outputs), _core.FmuCalls.readings)

    def advance(
        self, p: Array, x: Array, u: tuple[Array, Array], push: tuple[Array, Array], h: Array
    ) -> Array:
        """(states, n)"""

        def rate(part: float, at: Array) -> Array:
            pushed = push[0] + part * (push[1] - push[0])
            return self.derivative(p, at, u[0] + part * (u[1] - u[0])) + pushed

        return runge_kutta(rate, x, h)

    def step_slopes(
        self, p: Array, x: Array, u: tuple[Array, Array], h: Array, by_parameters: bool
    ) -> list[Array]:
        """The step, and by the chain rule its derivatives by the state (n, states, states)."""
        states, n = x.shape
        step, one = h[:, None, None], np.tile(np.eye(states), (n, 1, 1))

        def at(part: float, place: Array) -> tuple[Array, Array]:
            inputs = u[0] + part * (u[1] - u[0])
            flat = self._each(p, place, inputs, states * states, _core.FmuCalls.rate_slopes)
            by_state = flat.T.reshape(n, states, states).transpose(0, 2, 1)
            return self.derivative(p, place, inputs), by_state

        k1, a1 = at(0.0, x)
        k2, a2 = at(0.5, x + 0.5 * h * k1)
        k3, a3 = at(0.5, x + 0.5 * h * k2)
        k4, a4 = at(1.0, x + h * k3)
        d1 = a1
        d2 = a2 @ (one + 0.5 * step * d1)
        d3 = a3 @ (one + 0.5 * step * d2)
        d4 = a4 @ (one + step * d3)
        after = x + (h / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return [after, one + (step / 6.0) * (d1 + 2.0 * d2 + 2.0 * d3 + d4)]

    def output_slopes(self, p: Array, x: Array, u: Array, by_parameters: bool) -> list[Array]:
        """Outputs (outputs, n), and their derivatives by the state (n, outputs, states)."""
        outputs, (states, n) = len(self._names.outputs), x.shape
        flat = self._each(p, x, u, states * outputs, _core.FmuCalls.reading_slopes)
        return [self.output(p, x, u), flat.T.reshape(n, states, outputs).transpose(0, 2, 1)]

    def _each(
        self,
        p: Any,
        x: Array,
        u: Array,
        rows: int,
        function: Callable[[_core.FmuCalls, Array, Array], Array],
    ) -> Array:
        out = np.full((rows, x.shape[1]), np.nan)
        for values, which in self._sets(p, x.shape[1]):
            calls = self._pool(values)[1]
            if calls is not None:
                out[:, which] = function(calls, x[:, which].T, u[:, which].T).T
        return out


class Slave(_ByName):
    """Co-simulation."""

    adaptive = True
    by_state = False

    def __init__(self, fmu: Fmu, names: Names, called: tuple[str, ...]) -> None:
        super().__init__(fmu, names, called)
        self._states = fmu.references(names.states, "state")
        self._inputs = fmu.references(names.inputs, "input")
        self._outputs = fmu.references(names.outputs, "output")
        for name in names.states:
            if fmu.variable(name, "state").initial not in ("exact", "approx"):
                raise InputError(
                    f"{fmu.file}: the state '{name}' has no start value that may be set (initial = exact or approx); "
                    "export the model for model exchange, or make it settable"
                )
        self._instance = fmu.instance()
        self._checked = False

    def _check_step(self, values: Array, x: Array, u: Array, h: float) -> None:
        """InputError for an FMU that moves in longer steps of its own: begun anew at every sample, it would not."""
        d = self._fmu.description
        declared = d.defaultExperiment.stepSize if d.defaultExperiment is not None else None
        own = float(self._fmu.part.fixedInternalStepSize or declared or 0.0)
        self._checked = True
        if own <= h * (1.0 + 1e-9):
            return
        after = []
        for length in (h, own):
            self._begun(values, x, u).doStep(0.0, length)
            after.append(self._read(self._states))
        if after[0] == x.tolist() != after[1]:
            raise InputError(
                f"{self._fmu.file}: it moves in steps of {own:g} s, and the samples are {h:g} s apart; export it for "
                "model exchange, or thin the records to its step"
            )

    def _begun(self, values: Array, x: Array, u: Array) -> Any:
        start = dict(zip((*self._states, *self._inputs), (*x.tolist(), *u.tolist()), strict=True))
        self._fmu.initialised(self._instance, self._of_values(values) | start)
        return self._instance

    def _read(self, references: list[int]) -> list[float]:
        read = self._instance.getReal if self._fmu.version == "2" else self._instance.getFloat64
        return [float(v) for v in read(references)]

    def _each(self, p: Any, x: Array, u: Array, rows: int, h: Array | None) -> Array:
        """(rows, n): outputs where h is None, else states after h (n,) s."""
        out = np.full((rows, x.shape[1]), np.nan)
        for values, which in self._sets(p, x.shape[1]):
            for k in which:
                try:
                    if h is not None and not self._checked and h[k] > SHORT:
                        self._check_step(values, x[:, k], u[:, k], float(h[k]))
                    begun = self._begun(values, x[:, k], u[:, k])
                    if h is None:
                        out[:, k] = self._read(self._outputs)
                    else:
                        begun.doStep(0.0, float(h[k]))
                        out[:, k] = self._read(self._states)
                except InputError:
                    raise
                except Exception:  # a state it cannot go on from: it is made anew
                    self._instance = self._fmu.instance()
        return out

    def derivative(self, p: Any, x: Array, u: Array) -> Array:
        """(states, n), by a short step."""
        h = np.full(x.shape[1], SHORT)
        return (self._each(p, x, u, len(x), h) - x) / SHORT

    def output(self, p: Any, x: Array, u: Array) -> Array:
        """(outputs, n)"""
        return self._each(p, x, u, len(self._outputs), None)

    def advance(
        self, p: Array, x: Array, u: tuple[Array, Array], push: tuple[Array, Array], h: Array
    ) -> Array:
        """(states, n)"""
        after = self._each(p, x, 0.5 * (u[0] + u[1]), len(x), h)
        return after + 0.5 * h * (push[0] + push[1])

    def step_slopes(
        self, p: Array, x: Array, u: tuple[Array, Array], h: Array, by_parameters: bool
    ) -> list[Array]:
        """It has none; what asks for them looks at `by_state` first."""
        raise NotImplementedError

    def output_slopes(self, p: Array, x: Array, u: Array, by_parameters: bool) -> list[Array]:
        """It has none either."""
        raise NotImplementedError
