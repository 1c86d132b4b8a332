"""The answer of `sms identify friction`: its sentences, its JSON and what it declares to a rig file."""

from __future__ import annotations

import math
from typing import Any

from sms.identification.friction import FrictionResult
from sms.identification.friction_fit import EQUATION, LawFit, Told
from sms.io.declarations import Declaration
from sms.parameters import PARAMETERS
from sms.units_display import format_estimate, words


def sentences(result: FrictionResult) -> list[str]:
    """What a reader should know first."""
    best = result.law(result.best)
    judged = "validation" if math.isfinite(best.rms_validate) else "identification"
    low, high = (1e3 * v for v in result.speed)
    said = [
        f"Speeds of {low:.3g} to {high:.3g} mm/s, accelerations of {result.acceleration:.2g} m/s² rms.",
        f"{EQUATION[result.best]} fits the {judged} records best: "
        + "; ".join(f"{EQUATION[f.law]} {_rms_words(f)}" for f in result.laws)
        + ".",
    ]
    shown = [t for t in best.told if t.shown]
    if shown:
        said.append("Identified: " + "; ".join(told_words(t) for t in shown) + ".")
    unsure = [t for t in best.told if not t.shown]
    if unsure:
        said.append(
            "Fitted but not significant (consistent with zero, or at a bound): "
            + "; ".join(told_words(t) for t in unsure)
            + "."
        )
    said += [
        f"Not identifiable from this excitation: {words(n)}; {why}." for n, why in best.left_out
    ]
    said += list(best.found.warnings)
    if len(best.found.free) and all(len(t.runs) < 2 for t in best.told):
        said.append("One run only: how far friction differs from run to run cannot be seen.")
    return said


def told_words(t: Told) -> str:
    """ "Coulomb force 38.1 ± 0.4 N (runs scatter by 1.2 N)" """
    unit = PARAMETERS[t.name].unit
    text = f"{words(t.name)} {format_estimate(t.value, t.error, unit, t.name)}"
    if math.isfinite(t.scatter):
        text += f", runs alone scatter by {t.scatter:.2g}"
    return text


def _rms_words(f: LawFit) -> str:
    if math.isfinite(f.rms_validate):
        return f"{f.rms_validate:.3g} N ({f.rms_identify:.3g} N on what it was fitted to)"
    return f"{f.rms_identify:.3g} N"


def declarations(result: FrictionResult) -> dict[str, Declaration]:
    """What the best law identified, with its 95 percent interval, as a rig file declares it.

    Sensor errors are not the machine's.
    """
    return {
        t.name: Declaration(t.value, t.half_width)
        for t in result.law(result.best).told
        if t.shown and not t.name.startswith("sensor_")
    }


def to_dict(result: FrictionResult) -> dict[str, Any]:
    """Everything, for programs; SI units."""
    return {
        "rig": result.rig,
        "title": result.title,
        "best": result.best,
        "sentences": sentences(result),
        "findings": [str(f) for f in result.findings],
        "speed": list(result.speed),
        "acceleration_rms": result.acceleration,
        "laws": [_law_dict(f) for f in result.laws],
    }


def _law_dict(f: LawFit) -> dict[str, Any]:
    return {
        "law": f.law,
        "equation": EQUATION[f.law],
        "rms_identify": f.rms_identify,
        "rms_validate": f.rms_validate,
        "parameters": [
            {
                "name": t.name, "value": t.value, "standard_error": t.error, "freedom": t.freedom,
                "half_width_95": t.half_width, "shown": t.shown,
                "scatter": t.scatter, "runs": t.runs,
            }
            for t in f.told
        ],
        "not_shown": [{"name": n, "why": why} for n, why in f.left_out],
        "correlation": f.found.correlation,
        "condition": f.found.condition,
        "samples_as_one": f.found.colours[0].samples_as_one,
        "warnings": list(f.found.warnings),
    }  # fmt: skip
