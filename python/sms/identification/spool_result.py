"""The answer of `sms identify spool`: its sentences, its JSON and what it declares to a rig file."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms.identification import bench_result
from sms.identification.bench_result import COVERAGE
from sms.identification.spool import (
    DYNAMIC,
    EQUATION,
    STATIC,
    LawFit,
    PositionFit,
    SpoolResult,
    SpoolTold,
)
from sms.io.declarations import Declaration
from sms.parameters import PARAMETERS
from sms.units_display import format_estimate, words


def sentences(result: SpoolResult) -> list[str]:
    """What a reader should know first; what either kind of record says is named."""
    said = []
    if result.position is not None:
        said += [f"By position: {text}" for text in position_sentences(result.position)]
    if result.pressure is not None:
        said += [f"By pressures: {text}" for text in bench_result.sentences(result.pressure)]
    if result.position is not None and result.pressure is not None:
        said += _compared(result.position, result)
    return [*said, *(f"{note[:1].upper()}{note[1:]}." for note in result.notes)]


def position_sentences(fit: PositionFit) -> list[str]:
    """What the measured position says."""
    best = fit.law(fit.best)
    full = float(np.ptp(np.concatenate([r.position for r in fit.runs])))
    said = [
        "static law: "
        + "; ".join(
            f"{EQUATION[f.law]}, leaves {1e6 * judged(f):.3g} µm, {100.0 * judged(f) / full:.2g} % of the travel seen"
            for f in fit.laws
        )
        + "."
    ]
    centre, error = best.centre
    if np.isfinite(centre):
        said.append(
            f"the spool is at mid-travel at {format_estimate(centre, error, 'V', 'valve_centre')}."
        )
    else:
        said.append("the middle of the travel was not passed: no command at which it is zero.")
    lag = [t for t in best.told if t.name in DYNAMIC]
    if known := [t for t in lag if t.told]:
        said.append("it follows with " + ", ".join(told_words(t) for t in known) + ".")
    said += [f"fitted but not identifiable: {told_words(t)}." for t in lag if not t.told]
    said += [f"not identifiable from these records: {words(n)}; {why}." for n, why in fit.left_out]
    if not any(t.name == "spool_limit" for t in best.told):
        said.append("the end of the travel was not reached: spool limit stays as declared.")
    return [*said, *(f"{note}." for note in fit.notes), *(f"{w}." for w in best.found.warnings)]


def _compared(position: PositionFit, result: SpoolResult) -> list[str]:
    """The spool's own middle against the command at which no air flows."""
    assert result.pressure is not None
    centre, error = position.law(position.best).centre
    told = [t for t in result.pressure.fit.wanted if t.name == "valve_centre" and t.told]
    if not told or not np.isfinite(centre):
        return []
    apart = told[0].value - centre
    doubt = float(np.hypot(error, told[0].error))
    return [
        f"The pneumatic centre lies {format_estimate(apart, doubt, 'V', signed=True)} from the middle of the travel."
    ]


def judged(f: LawFit) -> float:
    """m, on the records not used where there are any."""
    return f.rms_validate if np.isfinite(f.rms_validate) else f.rms_identify


def told_words(t: SpoolTold) -> str:
    """ "valve frequency 64.8 ± 0.3 Hz" """
    return f"{words(t.name)} {format_estimate(t.value, t.error, PARAMETERS[t.name].unit, t.name)}"


def declarations(result: SpoolResult) -> dict[str, Declaration]:
    """What was identified, as a rig file declares it: by position where it was measured, else by pressures."""
    found: dict[str, Declaration] = {}
    if result.pressure is not None:
        found |= bench_result.declarations(result.pressure)
    if result.position is not None:
        told = result.position.law(result.position.best).told
        static = {n for names in STATIC.values() for n in names}
        # Coefficients of a polynomial make sense together only.
        found |= {
            t.name: Declaration(t.value, COVERAGE * t.error)
            for t in told
            if np.isfinite(t.error) and (t.told or t.name in static)
        }
    return found


def to_dict(result: SpoolResult) -> dict[str, Any]:
    """Everything, for programs; SI units."""
    return {
        "rig": result.rig,
        "title": result.title,
        "sentences": sentences(result),
        "findings": [str(f) for f in result.findings],
        "position": None if result.position is None else _position_dict(result.position),
        "pressure": None if result.pressure is None else bench_result.to_dict(result.pressure),
    }


def _position_dict(fit: PositionFit) -> dict[str, Any]:
    return {
        "best": fit.best,
        "laws": [_law_dict(f) for f in fit.laws],
        "not_told": [{"name": n, "why": why} for n, why in fit.left_out],
    }


def _law_dict(f: LawFit) -> dict[str, Any]:
    return {
        "law": f.law,
        "rms_identify": f.rms_identify,
        "rms_validate": f.rms_validate,
        "centre": {"value": f.centre[0], "standard_error": f.centre[1]},
        "parameters": [
            {
                "name": t.name, "unit": PARAMETERS[t.name].unit, "value": t.value, "standard_error": t.error,
                "declared": t.before, "told": t.told,
            }
            for t in f.told
        ],
        "covariance": {"names": [x.name for x in f.found.free], "values": f.found.covariance},
        "condition": f.found.condition,
        "samples_as_one": f.found.colours[0].samples_as_one,
        "warnings": list(f.found.warnings),
    }  # fmt: skip
