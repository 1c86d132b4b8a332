"""What a model leaves of the measurements: in which signal and equation, along what, and how much beside causes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Symptom:
    """What is wrong in one signal: the baseline's error within its windows on records that it was not fitted to."""

    signal: str
    unit: str
    rms: float
    noise: float
    """Of that, what no model could explain."""
    speaks: bool
    """Whether it is practically significant."""
    record: str
    begin: float
    end: float
    """s from the beginning of the record: where the error is largest."""
    share: float
    """Of the squared error beyond the noise that lies there, 0..1."""
    below: float
    """Hz below which four fifths of its power lie, the noise's aside."""


@dataclass(frozen=True)
class Shape:
    """A term that is missing in one equation, as a curve over one signal: a picture of what is left."""

    equation: str
    """"force", "flow of the lower chamber", ..., "reading of extension"."""
    signal: str
    """"velocity [m/s]" """
    at: tuple[float, ...]
    value: tuple[float, ...]
    band: tuple[float, ...]
    """Half width of 95 percent, from window to window."""
    unit: str
    share: float
    """Part of the excess that this curve takes."""
    confirmed: float = 1.0
    """Part of the curve that each fitted record confirms of what the others ask for, 0..1: what a model may carry."""


@dataclass(frozen=True)
class Hidden:
    """Where the error comes from: how much of the excess a hidden input in each equation takes."""

    shares: dict[str, tuple[float, float, float]]
    """Equation -> share, and its 95 percent interval over resampled windows. Each alone: they need not add up."""
    along: dict[str, float]
    """"force over velocity [m/s]" -> share."""
    shape: Shape

    @property
    def equation(self) -> str:
        """The equation that takes most."""
        return max(self.shares, key=lambda name: self.shares[name][0])


@dataclass(frozen=True)
class EquationError:
    """What one equation leaves when it is fed with measured signals. In its own unit."""

    equation: str
    """As in Hidden: "force", "flow of the lower chamber", ..., "reading of supply_pressure"."""
    unit: str
    rms: float
    """Beyond what the free parameters can undo."""
    noise: float
    """Of that, what the noise of the signals makes through smoother and equation."""
    times_noise: float
    """Rms of the error over its noise at the time."""
    share: tuple[float, float, float]
    """Of what is not noise in all equations, and its 95 percent interval over resampled seconds."""


@dataclass(frozen=True)
class ErrorCurve:
    """The term that one equation misses in one record. SI; band: half width of 95 percent."""

    equation: str
    unit: str
    record: str
    time: tuple[float, ...]
    missing: tuple[float, ...]
    band: tuple[float, ...]


@dataclass(frozen=True)
class FedEquations:
    """Where the error comes from, the second way: each equation fed with measured signals."""

    smoothing: float
    """s: window of the local cubics that smooth the signals and bring their derivatives."""
    average: float
    """s over which an error is averaged."""
    equations: tuple[EquationError, ...]
    beyond_noise: bool
    """Whether all of them together show more than noise; without it shares say nothing."""
    curves: tuple[ErrorCurve, ...]

    @property
    def equation(self) -> str:
        """The equation with the largest share."""
        return max(self.equations, key=lambda e: e.share[0]).equation


@dataclass(frozen=True)
class Unexplained:
    """What the extended model leaves of a simulated rig's error, beside the causes."""

    rms: dict[str, float]
    """Signal -> rms of the error on records it was not fitted to, in the signal's unit."""
    floor: dict[str, float]
    """Signal -> of that, what is noise: as declared, or what the records show if that is more."""
    tolerated: dict[str, float]
    """Signal -> rms beyond the noise up to which nothing is called wrong."""
    share_of_excess: float
    """Part of the baseline's mean squared error beyond the noise that is left, 0..1."""
    practically_significant: bool
    """Whether it is more than is tolerated."""
    equation: str
    """In which equation most of it sits."""
    along: str
    """Along which signal."""
    curve: Shape | None
    sentence: str


@dataclass(frozen=True)
class Ripple:
    """A periodic force along the stroke, the same period in every record and direction."""

    period: float
    """m"""
    amplitude: float
    """N, mean over records and directions."""


@dataclass(frozen=True)
class Remainder:
    """What is still unexplained on the validate records, and along which signal it is arranged."""

    rms: float
    unit: str
    share_of_excess: float
    """Part of the baseline's reproducible squared error that is left, 0..1."""
    repeats: float
    """Part of the remaining squared error that repeats from stroke to stroke, 0..1."""
    shares: dict[str, float]
    """Where it sits, parts of the squared error that add up to one: "record" (a constant in each record, that is
    at each pressure), "direction" (opposite in the two directions), "extension" (along the stroke), "time" (a drift
    from stroke to stroke), and what "does not repeat"."""
    ripple: Ripple | None = None
