"""What the method asks of a kind of rig that is simulated against its records; rigs/kinds.py lists them.

The method itself knows no plant. It holds a problem (a simulation that leaves errors, window by window, in units of
the noise), turns its parameters, and reads what a kind says about its signals. A plant of one's own needs no more.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from sms import _core
from sms.arrays import Array
from sms.estimation.least_squares import Free, Solution, fit_windows
from sms.estimation.problem import Problem, WindowProblem
from sms.estimation.run import Run, make_run
from sms.io.records import Record
from sms.io.rig import Rig
from sms.io.signals import SIGNAL_UNITS


@dataclass(frozen=True)
class Experiment:
    """One run of a kind's menu of safe experiments."""

    title: str
    how: str
    simulated: Callable[[Rig, _core.Params, Sequence[str]], Run | None]
    """The record that it would give with these parameters and measured signals; None where it would not be safe."""


@dataclass(frozen=True)
class Equations:
    """A kind's equations, each fed with measured signals (localisation/equation_error.py)."""

    units: Callable[[Sequence[str]], dict[str, str]]
    """From the outputs that are measured: equation -> unit of its error, in the order of a sample's rows."""
    derivatives: Mapping[str, int]
    """Signal that is fed -> how many of its derivatives are needed."""
    make: Callable[[Rig, Run, Mapping[str, Array]], Problem]
    """From a rig, a record and its smoothed signals (n, 1 + derivatives): model less measured, sample by sample."""


@dataclass(frozen=True)
class Kind:
    """A kind of rig."""

    outputs: tuple[str, ...]
    """The signals that are predicted, in the order of the problem's rows."""
    hidden: Mapping[str, str]
    """Hidden inputs of the equations -> unit, in the order of the problem's columns."""
    make_problem: Callable[[Rig, Sequence[Run], Sequence[str], Mapping[str, float]], WindowProblem]
    """From a rig, its records, the outputs that all of them have, and the noise of a sample of each."""
    derived: Callable[[Run], dict[str, Array]]
    """"velocity [m/s]" -> (n,): what an error may follow beside the signals themselves, time aside."""
    shown: tuple[str, ...]
    """The signals over which the report draws errors, beside the derived ones."""
    menu: tuple[Experiment, ...]
    """Experiments of which the next is chosen."""
    units: Mapping[str, str] = field(default_factory=lambda: SIGNAL_UNITS)
    """Of every signal."""
    equations: Equations | None = None
    """None: the plant is known as a simulation only."""
    switched: bool = False
    """Recorded commands drive valves, and when they jumped between two samples is not known."""
    read_directly: Mapping[str, str] = field(default_factory=dict)
    """Block of the catalogue -> the signal that its equation gives without any other: an error of the flows or forces
    does not reach it."""
    computed: Mapping[str, float] = field(default_factory=dict)
    """Outputs that a computer makes of the others' readings -> noise of a sample that is not declared, SI. They are no
    readings, and hardly have a noise: less than what is declared, or this, is not practically significant."""
    whitened: bool = True
    """Residuals are in units of the noise of a sample; else in the unit of the signal, and their noise is what differs
    between repeats."""
    make_run: Callable[[Rig, Record], Run] = make_run
    """From a record to what the problem takes."""
    solve: Callable[[Problem, _core.Params, list[Free]], Solution] = fit_windows
    """Least squares over the free parameters, from initial ones."""
    whole: Callable[[Run], Run] | None = None
    """A run with all its samples compared, where windows leave some out; None where they do not."""
    short: float = 0.025
    """s: what differs over this time is noise; what lasts longer a model could explain."""
    practically_significant: tuple[float, float] = (0.15, 0.3)
    """From where an error is practically significant, as a share of the noise floor's mean square: over all outputs,
    and of the one that is worst off. Two good models of one machine differ by so much: the form in which friction
    rises from rest, the flow through a valve that is nearly closed, noise that lasts. Healthy machines of the trials
    leave 0.05 to 0.14, and 0.07 to 0.25."""
