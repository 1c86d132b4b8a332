"""A plant as its owner writes it: states, inputs, outputs, parameters, one derivative, and the effects it may miss.

    def derivative(p, x, u):            x[i], u[j]: arrays; p.name: a number or an array; returns one array a state
        upper, lower = x
        out = p.outlet_upper * np.sqrt(2.0 * GRAVITY * np.maximum(upper, 0.0))
        ...

Many windows and many parameter values are simulated at once: everything handed in is an array over them, or a number,
and everything must be computed by numpy functions that work element by element (`np.where`, not `if`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from inspect import Parameter as Argument
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.diagnosis.own.casadi_model import equations_of
from sms.diagnosis.own.steps import Steps
from sms.errors import InputError, did_you_mean

Numbers = float | NDArray[np.float64]


class Values:
    """Parameter values by name: `p.mass`, `p["mass"]`. Each a number or an array over what is simulated at once."""

    def __init__(self, **values: Numbers) -> None:
        self.__dict__.update(values)

    def __getitem__(self, name: str) -> Any:
        return self.__dict__[name]

    def __setitem__(self, name: str, value: Numbers) -> None:
        self.__dict__[name] = value

    def __getattr__(self, name: str) -> Any:
        """KeyError's text for a person: only reached for a name that is not there."""
        raise AttributeError(f"the model has no parameter '{name}'")

    def __iter__(self) -> Iterator[str]:
        return iter(self.__dict__)

    def copy(self) -> Values:
        return Values(**self.__dict__)


Equation = Callable[[Values, Array, Array], Sequence[Array] | Array]
"""Of (parameters, state (states, n), input (inputs, n)) to one array (n,) for each state, or for each output."""
Guess = Callable[..., Mapping[str, Array]]
"""To rough values of the states, (samples,) each, of (parameters, time, outputs, inputs): time (samples,) in s from the
record's beginning, the others by name. Or of one record's signals alone."""


@dataclass(frozen=True)
class State:
    """One number of the plant's state."""

    name: str
    unit: str
    scale: float
    """A change of it that matters, in its unit: the size by which it is known at the start of a window."""
    equation: str = ""
    """What its derivative says, in words: "balance of the upper tank". Empty where it is only a definition (the rate of
    a position is the velocity) and nothing can be missing."""
    start: float = 0.0
    """Where the search for its value begins, if no output has its name and no guess is given."""


@dataclass(frozen=True)
class Input:
    """A recorded signal that drives the plant. It is linear between samples, or held."""

    name: str
    unit: str
    held: bool = False
    delay: str = ""
    """Parameter by which it acts later than it is recorded: a dead time, s, never below zero. As much of a record as
    its upper bound is compared with nothing, since what acted then was not recorded."""


@dataclass(frozen=True)
class Output:
    """A recorded signal that the plant predicts."""

    name: str
    unit: str
    noise: float | None = None
    """Standard deviation of one sample; from how neighbouring samples differ if it is not known."""
    range: tuple[float, float] | None = None
    """What the sensor can read: samples at either end or beyond are compared with nothing."""


@dataclass(frozen=True)
class Parameter:
    """A number of the model, between two bounds, with what is known of it."""

    name: str
    unit: str
    lower: float
    value: float
    upper: float
    uncertainty: float = 0.0
    """Half width within which it may move unasked."""
    fit: bool = False
    """Unknown: fitted within its bounds, `value` is the start."""


@dataclass(frozen=True)
class Effect:
    """Something that may be wrong: a term that is neutral at its parameter's value, or a declared number gone off."""

    id: str
    parameter: str
    title: str
    """In words, as it goes on after "The simulation misses": "a leak of the upper tank"."""
    cause: str
    """What happens there, in a sentence."""
    plausible: tuple[float, float] | None = None
    """Values of the parameter that can be believed; its bounds if left out."""
    equation: str = ""
    """The equation in which it acts, as a state names it, or "reading of <output>"."""
    separated_by: str = "A measurement of the quantity itself."
    """What would tell it from effects that look alike."""
    step: float | None = None
    """For a term without slope at its neutral value: the size at which its sensitivity is taken."""


@dataclass(frozen=True)
class Model:
    """A plant that a diagnosis can be asked about. InputError, when made, for what cannot be."""

    states: Sequence[State]
    inputs: Sequence[Input]
    outputs: Sequence[Output]
    parameters: Sequence[Parameter]
    derivative: Equation
    output: Equation
    effects: Sequence[Effect]
    title: str = "own model"
    longest_step: float | None = None
    """s: of the integration (Runge-Kutta, fourth order); a sample's length if that is shorter. None: a sample's length,
    halved until that moves no estimate by more than its standard error."""
    guess: Guess | None = None
    jump: Equation | None = None
    """What happens at once: of (parameters, state, input) to the state thereafter, asked after every step of the
    integration (np.where: a level at the rim stays there, an integrator is reset)."""
    exact: Steps | None = field(default=None, repr=False)
    """Of a model from CasADi or an FMU: both functions, the step of the integration, and what derivatives it has."""

    @classmethod
    def from_casadi(
        cls,
        *,
        states: Sequence[State],
        inputs: Sequence[Input],
        outputs: Sequence[Output],
        parameters: Sequence[Parameter],
        derivative: Callable[[Any, Any, Any], Any],
        output: Callable[[Any, Any, Any], Any],
        effects: Sequence[Effect],
        title: str = "own model",
        longest_step: float | None = None,
        guess: Guess | None = None,
        integrator: str = "rk",
    ) -> Model:
        """A model whose functions are written with CasADi's expressions: with exact derivatives (casadi_model.py).

        integrator: "rk", the step of every own model; "cvodes", "idas" or "collocation" for stiff plants. InputError
        where CasADi is not installed (the extra sms[casadi]).
        """
        names = [p.name for p in parameters]
        made = equations_of(names, len(states), len(inputs), derivative, output, integrator, title)
        if made.adaptive:
            longest_step = np.inf
        return cls(
            states=states,
            inputs=inputs,
            outputs=outputs,
            parameters=parameters,
            derivative=made.derivative,
            output=made.output,
            effects=effects,
            title=title,
            longest_step=longest_step,
            guess=guess,
            exact=made,
        )

    def __post_init__(self) -> None:
        self._check_names()
        self._check_signals()
        for p in self.parameters:
            if not p.lower <= p.value <= p.upper or not p.lower < p.upper:
                raise InputError(
                    f"{self.title}, parameter {p.name}: {p.value:g} does not lie between {p.lower:g} and {p.upper:g}; "
                    "check its bounds"
                )
            if p.uncertainty < 0.0:
                raise InputError(
                    f"{self.title}, parameter {p.name}: an uncertainty is not negative; write its half width"
                )
        known = [p.name for p in self.parameters]
        for effect in self.effects:
            if effect.parameter not in known:
                raise InputError(
                    f"{self.title}, effect {effect.id}: there is no parameter '{effect.parameter}'; "
                    f"{did_you_mean(effect.parameter, known)}"
                )
        for state in self.states:
            if not state.scale > 0.0:
                raise InputError(
                    f"{self.title}, state {state.name}: scale must be positive; write a change of it that matters"
                )
        self._check_equations()

    def _check_names(self) -> None:
        for what, names in (
            ("states", [s.name for s in self.states]),
            ("outputs", [s.name for s in self.outputs]),
            ("parameters", [p.name for p in self.parameters]),
            ("effects", [e.id for e in self.effects]),
        ):
            if not names:
                raise InputError(f"{self.title}: a model needs {what}; add at least one")
            twice = sorted({n for n in names if names.count(n) > 1})
            if twice:
                raise InputError(f"{self.title}, {what}: '{twice[0]}' is there twice; rename one")

    def _check_signals(self) -> None:
        known = [p.name for p in self.parameters]
        for signal in self.inputs:
            if not signal.delay:
                continue
            where = f"{self.title}, input {signal.name}, delay"
            if signal.delay not in known:
                raise InputError(
                    f"{where}: there is no parameter '{signal.delay}'; {did_you_mean(signal.delay, known)}"
                )
            if self.parameter(signal.delay).lower < 0.0:
                raise InputError(
                    f"{where}: {signal.delay} may be negative; no input acts before it is there, so set its lower "
                    "bound to 0"
                )
        for output in self.outputs:
            if output.range is not None and not output.range[0] < output.range[1]:
                raise InputError(
                    f"{self.title}, output {output.name}: range is from {output.range[0]:g} to {output.range[1]:g}; "
                    "write the lowest reading first"
                )

        if self.exact is not None and (
            self.jump is not None
            or self.derivative != self.exact.derivative
            or self.output != self.exact.output
        ):
            raise InputError(
                f"{self.title}: a model from CasADi or an FMU has no jump and no other derivative or output than its "
                "own; make it anew, or write it with numpy"
            )

    def _check_equations(self) -> None:
        """The functions are called once, for two things at a time."""
        state = np.array([[s.start, s.start + s.scale] for s in self.states])
        inputs = np.zeros((len(self.inputs), 2))
        functions = [
            ("derivative", self.derivative, len(self.states)),
            ("output", self.output, len(self.outputs)),
        ]
        if self.jump is not None:
            functions.append(("jump", self.jump, len(self.states)))
        for what, function, wanted in functions:
            found = function(self.values(), state, inputs)
            if len(found) != wanted:
                raise InputError(
                    f"{self.title}: {what} returns {len(found)} arrays; needed are {wanted}, in the order of "
                    f"{'outputs' if what == 'output' else 'states'}"
                )
            for part in found:
                if np.shape(part) not in ((2,), ()):
                    raise InputError(
                        f"{self.title}: {what} returns an array of shape {np.shape(part)} for two states at a time; "
                        "compute element by element with numpy, so that (n,) goes in and (n,) comes out"
                    )

    def values(self) -> Values:
        """The declared values."""
        return Values(**{p.name: p.value for p in self.parameters})

    def parameter(self, name: str) -> Parameter:
        return next(p for p in self.parameters if p.name == name)

    def with_values(self, values: Mapping[str, float]) -> Model:
        """The model with other declared values: all else stays. InputError for a name that it does not have."""
        known = [p.name for p in self.parameters]
        for name in values:
            if name not in known:
                raise InputError(
                    f"{self.title}: there is no parameter '{name}'; {did_you_mean(name, known)}"
                )
        changed = [
            replace(p, value=float(values[p.name])) if p.name in values else p
            for p in self.parameters
        ]
        return replace(self, parameters=changed)

    def guessed(self, time: Array, signals: Mapping[str, Array]) -> dict[str, Array]:
        """Rough values (samples,) of states by its own `guess`; time (samples,) in s."""
        if self.guess is None:
            return {}
        if _takes_four(self.guess):
            outputs, inputs = (
                {s.name: signals[s.name] for s in part if s.name in signals}
                for part in (self.outputs, self.inputs)
            )
            found = self.guess(self.values(), time - time[0], outputs, inputs)
        else:
            found = self.guess(signals)
        return {n: np.asarray(v, dtype=np.float64) for n, v in found.items()}

    @property
    def signals(self) -> list[Input | Output]:
        """What is recorded, time aside."""
        return [*self.inputs, *self.outputs]

    @property
    def equations(self) -> dict[str, int]:
        """Equation in which a term may be missing -> number of its state."""
        return {s.equation: i for i, s in enumerate(self.states) if s.equation}


def _takes_four(function: Guess) -> bool:
    """Whether a guess is asked with parameters, time, outputs and inputs; else with the signals alone."""
    places = (Argument.POSITIONAL_ONLY, Argument.POSITIONAL_OR_KEYWORD)
    asked = signature(function).parameters.values()
    return sum(a.kind in places for a in asked) >= 4 or any(
        a.kind is Argument.VAR_POSITIONAL for a in asked
    )
