"""A made-up diagnosis of a cylinder with an O-ring, for the tests of the page and the console."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from typing import Any, get_args

import numpy as np
from sms.diagnosis.remainder import Remainder
from sms.diagnosis.result import (
    Candidate,
    Cause,
    Diagnosis,
    Finding,
    Gain,
    Member,
    NextExperiment,
    NotTestable,
    ParameterValue,
    Related,
    Series,
    Verdict,
)

VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
AREA = 0.25 * math.pi * 0.025**2  # m^2


def cylinder_series(record: str, role: str, gauge_pressure: float, rows: int = 900) -> Series:
    """Strokes at constant pressure: force gain 0.9 percent, friction 3.2 N and 0.75 N per bar."""
    random = np.random.default_rng(1)
    time = 0.01 * np.arange(rows, dtype=np.float64)
    phase = (time / 5.0) % 1.0
    extension = 0.002 + 0.036 * (1.0 - np.abs(2.0 * phase - 1.0))
    direction = np.where(phase < 0.5, 1.0, -1.0)
    pressure = gauge_pressure + random.normal(0.0, 300.0, rows)
    friction = 3.2 + 7.5e-6 * pressure
    extended = 1.009 * AREA * pressure - direction * friction
    used = np.abs(np.gradient(extension, time)) > 0.01
    return Series(
        record=record,
        role=role,
        signal="rod_force",
        unit="N",
        time=time,
        measured=extended + random.normal(0.0, 0.3, rows),
        baseline=AREA * pressure - 6.0 * direction,
        extended=extended,
        used=used,
        inputs={
            "extension [m]": extension,
            "velocity [m/s]": 0.0144 * direction,
            "chamber_pressure_lower [Pa]": pressure + 101325.0,
            "direction": direction,
        },
    )


def value(name: str, number: float, error: float, unit: str, old: float = 0.0) -> ParameterValue:
    return ParameterValue(name, number, error, unit, old)


FORCE_GAIN = value("sensor_gain_rod_force", 0.0087, 0.0003, "1")
PRESSURE_GAIN = value("sensor_gain_chamber_pressure_lower", -0.0086, 0.0003, "1")
BORE = value("bore_diameter", 0.025108, 3.9e-6, "m", 0.025)
FRICTION = value("pressure_friction", 7.5e-6, 1.4e-7, "N/Pa")
ROLES = {"1 bar": "identify", "5 bar": "identify", "3 bar": "validate", "7 bar": "validate"}

CLASS = Cause(
    effect="sensor_gain",
    signal="rod_force",
    kind="missing term",
    block="sensors",
    title="gain error of the load cell",
    explanation="The load cell reads too much in proportion to the force.",
    members=("sensor_gain rod_force", "sensor_gain chamber_pressure_lower", "bore_diameter"),
    alternatives=(
        Member("sensor_gain", "chamber_pressure_lower", "gauge gain", (PRESSURE_GAIN,), 0.9998),
        Member(
            "bore_diameter", None, "bore diameter differs from the declared value", (BORE,), 0.97
        ),
    ),
    parameters=(FORCE_GAIN,),
    p_value=2e-9,
    consistency={"1 bar": 0.0149, "5 bar": 0.0085, "3 bar": 0.0148, "7 bar": 0.0088},
    separated_by="Hang a known weight on the load cell.",
    support=0.99,
)
SINGLE = Cause(
    effect="pressure_dependent_friction",
    signal=None,
    kind="missing term",
    block="force",
    title="pressure-dependent seal friction",
    explanation="The chamber pressure presses the lip of the seal on the bore.",
    members=("pressure_dependent_friction",),
    alternatives=(),
    parameters=(FRICTION,),
    p_value=1e-12,
    consistency={"1 bar": 8.6e-6, "5 bar": 7.3e-6, "3 bar": 7.9e-6, "7 bar": 7.6e-6},
    separated_by="",
    support=1.0,
)
SHIFT = replace(
    SINGLE, effect="bore_diameter", kind="shifted parameter", title="bore", parameters=(BORE,)
)
CAUSES: dict[str, tuple[Cause, ...]] = {
    "cause": (SHIFT,),
    "class": (CLASS,),
    "combination": (CLASS, SINGLE),
}


def candidates() -> tuple[Candidate, ...]:
    return (
        Candidate(
            1, "sensor_gain", "rod_force", (FORCE_GAIN,), 1e-8, 0.62, 0.51, 0.7, True, "best"
        ),
        Candidate(1, "bore_diameter", None, (BORE,), 1e-8, 0.62, 0.51, 0.7, True, "alike"),
        Candidate(1, "sensor_offset", "rod_force", (), 0.3, -3.0, -4.0, -2.0, False, "worse"),
        Candidate(
            2, "pressure_dependent_friction", None, (FRICTION,), 0.0, 0.7, 0.6, 0.8, True, ""
        ),
        Candidate(2, "direction_dependent_friction", None, (), 0.2, 0.0, -0.1, 0.1, False, "none"),
    )


def diagnosis(verdict: Verdict) -> Diagnosis:
    fault = Finding("error", "5 bar.csv", 412, "rod_force", "stuck at 3.2 N", "mend the cable")
    warning = Finding("warning", "3 bar.csv", None, None, "a gap of 2.7 s", "look at the logger")
    broken = verdict == "data-fault"
    pressures = {"1 bar": 1e5, "5 bar": 5e5, "3 bar": 3e5, "7 bar": 7e5}
    gain = tuple(
        Gain(name, "rod_force", "N", before, after, 0.3, 1 - after / before, 0.4, 0.8)
        for name, before, after in (("3 bar", 2.9, 1.1), ("7 bar", 4.0, 1.3))
    )
    return Diagnosis(
        rig="cylinder_o_ring.toml",
        title="Printed cylinder, O-ring seal",
        verdict=verdict,
        sentence="The simulated rod force is wrong by 3.5 N.",
        conclusion=("Check the load cell.", "The seal rubs more under pressure."),
        causes=CAUSES.get(verdict, ()),
        candidates=() if broken else candidates(),
        not_testable=(
            NotTestable("viscous_friction", None, "the speeds span 12 to 17 mm/s only"),
            NotTestable("sensor_gain", "chamber_pressure_upper", "not measured"),
        ),
        gain=() if broken else gain,
        remainder=None
        if broken
        else Remainder(
            1.2, "N", 0.1, 0.75, {"extension": 0.4, "direction": 0.0, "does not repeat": 0.6}
        ),
        noise_floor={} if broken else {"sample": 0.12, "stroke": 0.3},
        baseline=(value("coulomb_force", 6.0, 0.4, "N", 5.0),),
        next_experiment=None
        if broken
        else NextExperiment("hang a weight", "tells the rivals apart", ("sensor_gain rod_force",)),
        related=(
            Related("a.toml", "Cylinder, O-ring seal", "", (FORCE_GAIN, FRICTION)),
            Related("b.toml", "Cylinder, KDN seal", "seal", (FORCE_GAIN,)),
        ),
        findings=(warning, fault) if broken else (warning,),
        records=ROLES,
        seed=7,
        versions={"sms": "0.1.0"},
        series=()
        if broken
        else tuple(cylinder_series(n, role, pressures[n]) for n, role in ROLES.items()),
    )


def emptied(d: Diagnosis) -> Diagnosis:
    """Nothing but the verdict."""
    return replace(
        d, title="", sentence="", conclusion=(), causes=(), candidates=(), not_testable=(), gain=(),
        remainder=None, noise_floor={}, baseline=(), next_experiment=None, related=(), findings=(),
        records={}, versions={}, series=(),
    )  # fmt: skip


def without_numbers(item: Any) -> Any:
    """The same with NaN for every floating-point number, however deep."""
    if isinstance(item, float):
        return math.nan
    if isinstance(item, np.ndarray):
        return np.full_like(item, np.nan) if item.dtype == np.float64 else item
    if isinstance(item, tuple):
        return tuple(without_numbers(part) for part in item)
    if isinstance(item, dict):
        return {key: without_numbers(part) for key, part in item.items()}
    if is_dataclass(item) and not isinstance(item, type):
        parts = {f.name: without_numbers(getattr(item, f.name)) for f in fields(item)}
        return type(item)(**parts)
    return item
