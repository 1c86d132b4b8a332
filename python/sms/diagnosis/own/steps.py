"""How a plant goes from one sample to the next where it brings its own step: CasADi's, or that of an FMU."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from sms.arrays import Array


class Steps(Protocol):
    """Both functions of a model and its step, for n plants at once; arrays as integrate.py has them."""

    @property
    def adaptive(self) -> bool:
        """Whether a step keeps its own error small; else it is as long as the integration's."""
        ...

    @property
    def by_state(self) -> bool:
        """Whether it has derivatives by the state."""
        ...

    @property
    def by_parameters(self) -> bool:
        """Whether it has derivatives by the parameters too."""
        ...

    def derivative(self, p: Any, x: Array, u: Array) -> Array:
        """(states, n)"""
        ...

    def output(self, p: Any, x: Array, u: Array) -> Array:
        """(outputs, n)"""
        ...

    def numbers(self, p: Any, n: int) -> Array:
        """(parameters, n): values by name as one array."""
        ...

    def advance(
        self, p: Array, x: Array, u: tuple[Array, Array], push: tuple[Array, Array], h: Array
    ) -> Array:
        """(states, n) after h (n,) s; u and push, at its beginning and its end, go straight from one to the other."""
        ...

    def step_slopes(
        self, p: Array, x: Array, u: tuple[Array, Array], h: Array, by_parameters: bool
    ) -> list[Array]:
        """The same and its derivatives: by state (n, states, states), and if wanted by parameters (n, states, all)."""
        ...

    def output_slopes(self, p: Array, x: Array, u: Array, by_parameters: bool) -> list[Array]:
        """Outputs (outputs, n) and their derivatives, in the same way."""
        ...


def runge_kutta(rate: Callable[[float, Array], Array], x: Array, h: Array) -> Array:
    """(states, n) after h (n,) s, by the fourth order; rate of (part of the step, state)."""
    k1 = rate(0.0, x)
    k2 = rate(0.5, x + 0.5 * h * k1)
    k3 = rate(0.5, x + 0.5 * h * k2)
    k4 = rate(1.0, x + h * k3)
    return x + (h / 6.0) * (k1 + 2.0 * (k2 + k3) + k4)
