"""What a diagnosis says: the contents of diagnosis.json, and the curves behind it."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array
from sms.diagnosis.remainder import FedEquations, Hidden, Remainder, Shape, Symptom, Unexplained
from sms.io.json_files import json_text
from sms.io.records import in_words
from sms.views import Shown

Verdict = Literal["no-evidence", "cause", "class", "combination", "unknown", "data-fault"]


@dataclass(frozen=True)
class ParameterValue:
    """One parameter as the data has it."""

    name: str
    value: float
    standard_error: float
    unit: str
    old_value: float


@dataclass(frozen=True)
class Member:
    """One explanation among those of a class that these signals cannot tell apart."""

    effect: str
    signal: str | None
    title: str
    parameters: tuple[ParameterValue, ...]
    similarity: float
    """Cosine between this member's and the class's first member's sensitivity in the data, 0..1."""


@dataclass(frozen=True)
class Cause:
    """A named cause. With more than one member it is a class: the data fits each of them."""

    effect: str
    signal: str | None
    kind: Literal["missing term", "shifted parameter"]
    block: str
    title: str
    explanation: str
    members: tuple[str, ...]
    alternatives: tuple[Member, ...]
    parameters: tuple[ParameterValue, ...]
    p_value: float
    consistency: dict[str, float]
    """Record name -> the parameter refitted on this record alone (SI)."""
    separated_by: str
    """The measurement that would tell the members apart, empty for a single cause."""
    support: float
    """Share of 999 resamples of the windows or strokes in which the choice of its round falls on it, 0..1."""
    share: float = 0.0
    """Part of the baseline's mean squared error beyond the noise, on validation records, that it takes, 0..1."""
    share_low: float = 0.0
    share_high: float = 0.0
    """95 percent interval of the share, over resampled windows."""
    cross_validated: bool = False
    """Whether the validation records are insensitive to it: judged by cross-validation within the identify records."""


@dataclass(frozen=True)
class Candidate:
    """One effect that was tried, in one round of the search."""

    round: int
    effect: str
    signal: str | None
    parameters: tuple[ParameterValue, ...]
    p_value: float
    """Of the data on the identify records, if the effect were absent; corrected for the number tried."""
    gain: float
    """Share of the mean squared error on the validate records that it removes."""
    gain_low: float
    gain_high: float
    """95 percent interval of gain, over resampled strokes."""
    accepted: bool
    reason: str


@dataclass(frozen=True)
class NotTestable:
    """An effect about which these records say nothing."""

    effect: str
    signal: str | None
    reason: str


@dataclass(frozen=True)
class StillHidden:
    """An effect that was not found, and the size from which these records would show it."""

    effect: str
    signal: str | None
    title: str
    parameter: str
    size: float
    """Shift of the parameter, in its unit."""
    unit: str
    plausible: float
    """The largest plausible shift."""
    estimate: float | None = None
    """The shift by which these records would be fitted best, to first order; None where it is fitted anyway."""
    standard_error: float | None = None


@dataclass(frozen=True)
class Gain:
    """What the extension is worth on one record it has not seen. In the unit of the signal."""

    record: str
    signal: str
    unit: str
    baseline_rms: float
    extended_rms: float
    noise_floor: float
    reduction: float
    """1 - extended_rms / baseline_rms, with its 95 percent interval over resampled strokes."""
    reduction_low: float
    reduction_high: float
    role: str = "validate"
    """Of the record: "validate", on which causes were judged, or "test", which took no part in any choice."""
    baseline_refitted_rms: float = math.nan
    """As `baseline_rms` and `extended_rms`, but for what is declared uncertain and was fitted again to this record."""
    extended_refitted_rms: float = math.nan


@dataclass(frozen=True)
class FreeRun:
    """Error of a simulation over one whole record, from the initial state that fits it best. In the signal's unit."""

    record: str
    signal: str
    unit: str
    baseline_rms: float
    """NaN where the run diverges."""
    extended_rms: float
    baseline_note: str
    """"leaves the stroke at 3.20 s", "diverges at 1.02 s"; empty where it does neither."""
    extended_note: str
    role: str = "validate"


@dataclass(frozen=True)
class InUse:
    """One quantity of the machine in use, as either model predicts it. SI."""

    name: str
    unit: str
    baseline: float
    extended: float


@dataclass(frozen=True)
class Empirical:
    """The curve of a missing term carried along by the simulation: it predicts better, and explains nothing."""

    shape: Shape
    """Fitted on the identify records."""
    gain: tuple[Gain, ...]
    """What it is worth on records that it has not seen; `extended` is the simulation with the curve."""


@dataclass(frozen=True)
class Finding:
    """Something the data check has to say about a file."""

    severity: str
    file: str
    line: int | None
    signal: str | None
    message: str
    remedy: str

    def __str__(self) -> str:
        return in_words(self.file, self.line, self.signal, self.message, self.remedy)


@dataclass(frozen=True)
class Undetermined:
    """Free parameters of the baseline that these records do not tell apart: they may move together without a trace."""

    parameters: tuple[str, ...]
    known: str
    """What is known of them: "resistance x compliance"; empty where that is nothing or has no short name."""
    sentence: str


@dataclass(frozen=True)
class NextExperiment:
    title: str
    purpose: str
    separates: tuple[str, ...]


@dataclass(frozen=True)
class Related:
    """The same model on another rig of the same bench, all its records fitted together."""

    rig: str
    title: str
    differs: str
    """What is different there, in a word: "seal", "repeat"; empty for the diagnosed rig itself."""
    parameters: tuple[ParameterValue, ...]


@dataclass(frozen=True)
class Series:
    """The curves of one record, for the report. Arrays (n,), SI; comparison holds on the rows `used`."""

    record: str
    role: str
    signal: str
    unit: str
    time: Array
    measured: Array
    baseline: Array
    extended: Array
    used: NDArray[np.bool_]
    inputs: dict[str, Array]
    """Signals against which the residual is drawn: "extension [m]", "velocity [m/s]", "direction", ..."""


@dataclass(frozen=True)
class Diagnosis(Shown):
    """The whole answer."""

    rig: str
    title: str
    findings: tuple[Finding, ...]
    records: dict[str, str]
    """Record name -> role."""
    seed: int
    versions: dict[str, str] = field(default_factory=dict)
    inputs: dict[str, str] = field(default_factory=dict)
    """File name -> SHA-256 of its content, of every file that was read; empty for a model in Python."""
    kind: str = ""
    """Of the rig: "bench", "tank", ...; empty for a model in Python, as are the next three."""
    measured: str = ""
    """When its records were measured, ISO 8601; without a zone UTC is meant."""
    measured_from: str = ""
    """"stated", or "modification of the records"."""
    declared: dict[str, Any] = field(default_factory=dict)
    """What the rig file declares, SI: "model", "control", "signals", "parameters"."""
    notes: str = ""
    """Remarks of the rig file."""
    command: str = ""
    """Where the valve's command comes from, record or simulated controller, in plain words; empty without a valve."""
    verdict: Verdict = "no-evidence"
    sentence: str = ""
    """The verdict in plain words."""
    conclusion: tuple[str, ...] = ()
    """What an engineer would conclude, a sentence each."""
    causes: tuple[Cause, ...] = ()
    candidates: tuple[Candidate, ...] = ()
    not_testable: tuple[NotTestable, ...] = ()
    still_hidden: tuple[StillHidden, ...] = ()
    """With the verdict no-evidence, for rigs that are simulated: what these records would not show."""
    symptoms: tuple[Symptom, ...] = ()
    """What is wrong in each signal, for rigs that are simulated."""
    gain: tuple[Gain, ...] = ()
    free_run: tuple[FreeRun, ...] = ()
    """The same over whole records, for rigs that are simulated."""
    in_use: tuple[InUse, ...] = ()
    """What the causes mean to whoever uses the machine; empty without a cause."""
    remainder: Remainder | Unexplained | None = None
    hidden: Hidden | None = None
    """Where the baseline's error comes from, for rigs that are simulated."""
    fed: FedEquations | None = None
    """The same, each equation fed with measured signals."""
    hidden_left: Hidden | None = None
    """The same of what the extended model leaves."""
    empirical: Empirical | None = None
    """On request: the curve of what is not explained as a term of the simulation."""
    noise_floor: dict[str, float] = field(default_factory=dict)
    """"sample" and "stroke": rms of what differs from sample to sample and from stroke to stroke, N."""
    baseline: tuple[ParameterValue, ...] = ()
    refitted: tuple[ParameterValue, ...] = ()
    """Beside the causes: what is declared uncertain or unknown, as fitted together with them; empty without a cause."""
    undetermined: tuple[Undetermined, ...] = ()
    """For a plant of one's own: what is free and cannot be known from these records; not among `baseline`."""
    next_experiment: NextExperiment | None = None
    related: tuple[Related, ...] = ()
    series: tuple[Series, ...] = field(default=(), repr=False)

    def to_dict(self) -> dict[str, Any]:
        """The contents of diagnosis.json: everything but the curves."""
        return asdict(replace(self, series=()), dict_factory=_without_series)


def _without_series(items: list[tuple[str, Any]]) -> dict[str, Any]:
    return {name: value for name, value in items if name not in ("series", "curves")}


def as_json(diagnosis: Diagnosis) -> str:
    """The text of diagnosis.json."""
    return json_text("diagnosis", diagnosis.to_dict())
