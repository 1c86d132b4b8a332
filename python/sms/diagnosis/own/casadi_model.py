"""Equations written with CasADi: exact derivatives of the simulation, and stiff plants by CasADi's integrators.

    def derivative(p, x, u):            p.name, x[i], u[j]: expressions of CasADi; one expression a state comes back
        return [(u[0] - x[0]) / p.time_constant]

    model = own.Model.from_casadi(states=..., derivative=derivative, output=output, integrator="cvodes", ...)

The step from sample to sample is one function of CasADi, evaluated for all windows at once; its Jacobians by state and
parameters are CasADi's, chained over the samples. With the integrator "rk" it is the Runge-Kutta step of integrate.py,
and the derivatives are exact for it; "cvodes", "idas" and "collocation" keep their own errors small and take stiff
plants, each step at the price of a call. CasADi (the extra sms[casadi]) is loaded when a model is made.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from io import StringIO
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.errors import InputError

INTEGRATORS = ("rk", "cvodes", "idas", "collocation")
TOLERANCE = 1e-8
"""Of cvodes and idas, relative and absolute: far below a noise, so that derivatives are smooth."""


class Symbols:
    """Parameters as expressions, by name: `p.mass`, `p["mass"]`."""

    def __init__(self, **expressions: Any) -> None:
        self.__dict__.update(expressions)

    def __getitem__(self, name: str) -> Any:
        return self.__dict__[name]

    def __getattr__(self, name: str) -> Any:
        """Only reached for a name that is not there."""
        raise AttributeError(f"the model has no parameter '{name}'")


def _casadi() -> Any:
    try:
        return importlib.import_module("casadi")
    except ImportError:
        raise InputError('CasADi is not installed; pip install "sms[casadi]"') from None


@dataclass(frozen=True, eq=False)
class Equations:
    """Both functions of a model, its step and their Jacobians; arrays as integrate.py has them."""

    parameters: tuple[str, ...]
    integrator: str
    _derivative: Any
    _output: Any
    _step: Any
    _mapped: dict[tuple[str, int], Any] = field(default_factory=dict)
    by_state: bool = True
    by_parameters: bool = True

    @property
    def adaptive(self) -> bool:
        """Whether a step keeps its own error small; else it is as long as the integration's."""
        return self.integrator != "rk"

    # ---- as the functions of a model, (p, x, u) -> (rows, n) -----------------------------------------

    def derivative(self, p: Any, x: Array, u: Array) -> Array:
        """(states, n)"""
        return self._call("derivative", x, u, self.numbers(p, x.shape[1]))[0]

    def output(self, p: Any, x: Array, u: Array) -> Array:
        """(outputs, n)"""
        return self._call("output", x, u, self.numbers(p, x.shape[1]))[0]

    def numbers(self, p: Any, n: int) -> Array:
        """(parameters, n): values by name as one array."""
        out = np.empty((len(self.parameters), n))
        for k, name in enumerate(self.parameters):
            out[k] = p[name]
        return out

    # ---- steps and slopes ----------------------------------------------------------------------------

    def advance(
        self, p: Array, x: Array, u: tuple[Array, Array], push: tuple[Array, Array], h: Array
    ) -> Array:
        """(states, n) after h (n,) s; u and push, at its beginning and its end, go straight from one to the other."""
        return self._call("step", x, *u, *push, p, h[None])[0]

    def step_slopes(
        self, p: Array, x: Array, u: tuple[Array, Array], h: Array, by_parameters: bool
    ) -> list[Array]:
        """The same and its derivatives: by state (n, states, states), and if wanted by parameters (n, states, all)."""
        none = np.zeros_like(x)
        which = "step by all" if by_parameters else "step by state"
        return self._split(self._call(which, x, *u, none, none, p, h[None]), x.shape[1])

    def output_slopes(self, p: Array, x: Array, u: Array, by_parameters: bool) -> list[Array]:
        """Outputs (outputs, n) and their derivatives, in the same way."""
        which = "output by all" if by_parameters else "output by state"
        return self._split(self._call(which, x, u, p), x.shape[1])

    def _split(self, found: list[Array], n: int) -> list[Array]:
        slopes = [m.reshape(len(m), n, -1).transpose(1, 0, 2) for m in found[1:]]
        return [found[0], *slopes]

    def _call(self, which: str, *arrays: Array) -> list[Array]:
        n = arrays[0].shape[1]
        if (which, n) not in self._mapped:
            self._mapped[which, n] = _Mapped.of(self._function(which), n)
        found = self._mapped[which, n](arrays)
        if found is not None:
            return list(found)
        if n == 1:  # an integrator that cannot go on: a run that diverges
            return [np.full(size, np.nan) for size in self._mapped[which, 1].sizes]
        halves = [
            self._call(which, *(a[:, part] for a in arrays))
            for part in (slice(None, n // 2), slice(n // 2, None))
        ]
        return [np.hstack(of_output) for of_output in zip(*halves, strict=True)]

    def _function(self, which: str) -> Any:
        plain = {"derivative": self._derivative, "output": self._output, "step": self._step}
        name, _, by = which.partition(" by ")
        if not by:
            return plain[name]
        if (which, 0) not in self._mapped:
            wanted = ["out", "jac:out:x"] + (["jac:out:p"] if by == "all" else [])
            function = plain[name]
            self._mapped[which, 0] = function.factory("slopes", function.name_in(), wanted)
        return self._mapped[which, 0]


@dataclass(frozen=True, eq=False)
class _Mapped:
    """A function of CasADi for n of its arguments at once, called through memory that stays."""

    given: list[Array]
    found: list[Array]
    sizes: list[tuple[int, int]]
    buffer: Any
    evaluate: Callable[[], None]

    @classmethod
    def of(cls, function: Any, n: int) -> _Mapped:
        ca = _casadi()
        arguments = [ca.MX.sym(f"a{k}", *function.size_in(k)) for k in range(function.n_in())]
        results = function(*arguments)
        results = results if isinstance(results, tuple | list) else (results,)
        mapped = ca.Function("dense", arguments, [ca.densify(r) for r in results]).map(n)
        buffer, evaluate = mapped.buffer()
        given = [np.zeros(mapped.nnz_in(k)) for k in range(mapped.n_in())]
        found = [np.zeros(mapped.nnz_out(k)) for k in range(mapped.n_out())]
        for k, memory in enumerate(given):
            buffer.set_arg(k, memoryview(memory.data))
        for k, memory in enumerate(found):
            buffer.set_res(k, memoryview(memory.data))
        sizes = [mapped.size_out(k) for k in range(mapped.n_out())]
        return cls(given, found, sizes, buffer, evaluate)

    def __call__(self, arrays: Sequence[Array]) -> list[Array] | None:
        """One array (rows, n * columns) each; None where an integrator failed."""
        for memory, values in zip(self.given, arrays, strict=True):
            memory[:] = values.T.ravel()
        try:
            with (
                redirect_stderr(StringIO()),
                redirect_stdout(StringIO()),
            ):  # it prints all arguments
                self.evaluate()
        except RuntimeError:
            return None
        if self.buffer.ret():
            return None
        return [
            m.reshape(columns, rows).T.copy()
            for m, (rows, columns) in zip(self.found, self.sizes, strict=True)
        ]


def equations_of(
    names: Sequence[str],
    states: int,
    inputs: int,
    derivative: Callable[[Any, Any, Any], Any],
    output: Callable[[Any, Any, Any], Any],
    integrator: str,
    title: str,
) -> Equations:
    """From functions of expressions. InputError where CasADi is not there, or does not take what they return."""
    if integrator not in INTEGRATORS:
        raise InputError(
            f"{title}: there is no integrator '{integrator}'; choose one of {', '.join(INTEGRATORS)}"
        )
    ca = _casadi()
    x, u = ca.SX.sym("x", states), ca.SX.sym("u", inputs)
    p = ca.SX.sym("p", len(names))
    symbols = Symbols(**{n: p[k] for k, n in enumerate(names)})
    given = (symbols, [x[i] for i in range(states)], [u[j] for j in range(inputs)])
    made = []
    for what, function in (("derivative", derivative), ("output", output)):
        try:
            made.append(ca.vertcat(*function(*given)))
        except (TypeError, NotImplementedError, RuntimeError) as error:
            raise InputError(
                f"{title}: {what} cannot be made of CasADi's expressions: {str(error).splitlines()[0]}; use casadi's "
                "functions in it (casadi.sqrt, casadi.fmax, casadi.if_else)"
            ) from None
    rate, read = (
        ca.Function(name, [x, u, p], [expression], ["x", "u", "p"], ["out"])
        for name, expression in zip(("derivative", "output"), made, strict=True)
    )
    if rate.size1_out(0) != states:
        raise InputError(
            f"{title}: derivative returns {rate.size1_out(0)} expressions; needed are {states}, in the order of states"
        )
    return Equations(tuple(names), integrator, rate, read, _step(ca, rate, integrator))


def _step(ca: Any, rate: Any, integrator: str) -> Any:
    states, inputs, parameters = (rate.size1_in(k) for k in range(3))
    kind = ca.SX if integrator == "rk" else ca.MX
    arguments = ["x", "u0", "u1", "w0", "w1", "p", "h"]
    sizes = (states, inputs, inputs, states, states, parameters, 1)
    x, u0, u1, w0, w1, p, h = symbols = [
        kind.sym(n, size) for n, size in zip(arguments, sizes, strict=True)
    ]
    if integrator == "rk":

        def slope(part: float, at: Any) -> Any:
            return rate(at, u0 + part * (u1 - u0), p) + w0 + part * (w1 - w0)

        k1 = slope(0.0, x)
        k2 = slope(0.5, x + 0.5 * h * k1)
        k3 = slope(0.5, x + 0.5 * h * k2)
        k4 = slope(1.0, x + h * k3)
        after = x + (h / 6.0) * (k1 + 2.0 * (k2 + k3) + k4)
    else:
        s, t = [ca.SX.sym(n, k) for n, k in zip(arguments, sizes, strict=True)], ca.SX.sym("t")
        ode = s[6] * (rate(s[0], s[1] + t * (s[2] - s[1]), s[5]) + s[3] + t * (s[4] - s[3]))
        dae = {"x": s[0], "t": t, "p": ca.vertcat(*s[1:]), "ode": ode}
        options: dict[str, Any] = {"show_eval_warnings": False}
        if integrator != "collocation":
            options |= {"abstol": TOLERANCE, "reltol": TOLERANCE, "disable_internal_warnings": True}
        solver = ca.integrator("step", integrator, dae, 0.0, 1.0, options)
        after = solver(x0=x, p=ca.vertcat(u0, u1, w0, w1, p, h))["xf"]
    return ca.Function("step", symbols, [after], arguments, ["out"])
