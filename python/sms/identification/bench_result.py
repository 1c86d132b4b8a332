"""The answer of a fit of the bench: its sentences, its JSON, and what it declares to a rig file."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from sms.identification.actuator import BenchResult
from sms.identification.bench_fit import BenchFit, Told
from sms.io.declarations import Declaration
from sms.io.signals import SIGNAL_UNITS
from sms.parameters import PARAMETERS
from sms.units_display import format_estimate, format_interval, format_quantity, words

COVERAGE = 2.0
"""Standard errors that become the declared uncertainty, about 95 percent."""


def sentences(result: BenchResult) -> list[str]:
    """What a reader should know first."""
    fit = result.fit
    asked = [t for t in fit.wanted if t.name in result.asked]
    said = [_of_the_fit(fit)]
    if known := [t for t in asked if t.told]:
        said.append("Identified: " + "; ".join(told_words(t) for t in known) + ".")
    if unsure := [t for t in asked if not t.told]:
        said.append(
            "Fitted but not identifiable (no more accurate than declared, uncertain by half of its value or more, "
            "or at a bound): " + "; ".join(told_words(t) for t in unsure) + "."
        )
    said += [
        f"Not identifiable from these records: {words(n)}; {why}."
        for n, why in fit.left_out
        if n in result.asked
    ]
    if fit.gain:
        said.append(_gain_words(fit))
    else:
        said.append(
            "No record to validate with: whether the fit holds on other runs is not known; give one the role "
            "'validate'."
        )
    if len(fit.records.identify.motions) < 2:
        said.append("One record only: how far the actuator differs from run to run cannot be seen.")
    elif fit.birge > 1.0:
        said.append(
            f"The records, each taken alone, scatter {fit.birge:.2g} times as much as their errors say; "
            "all errors are larger by that."
        )
    return [
        *said,
        *(f"{note[:1].upper()}{note[1:]}." for note in fit.records.notes),
        *warnings(fit),
    ]


def warnings(fit: BenchFit) -> list[str]:
    """What the fit itself warns of; bounds of what is only known within limits are no news."""
    surround = {t.name for t in fit.surroundings}
    return [
        f"{text}." for text in fit.found.warnings if not any(text.startswith(n) for n in surround)
    ]


def _of_the_fit(fit: BenchFit) -> str:
    runs = fit.records.identify
    windows = len(runs.problem.windows)
    used = int(fit.records.counted.mean() * windows + 0.5)
    of = f"{used} of {windows}" if used != windows else f"{windows}"
    return (
        f"{len(runs.motions)} records in {of} windows of a second; residuals of "
        f"{fit.found.scale:.2f} times the declared noise, {len(fit.wanted)} parameters together."
    )


def _gain_words(fit: BenchFit) -> str:
    """Per signal, over the records together."""
    parts = []
    for channel in dict.fromkeys(g.channel for g in fit.gain):
        own = [g for g in fit.gain if g.channel == channel]
        before, after = (
            math.sqrt(sum(getattr(g, key) ** 2 for g in own) / len(own))
            for key in ("before", "after")
        )
        unit = SIGNAL_UNITS[channel]
        parts.append(
            f"{words(channel)} {format_quantity(before, unit)} as declared, "
            f"{format_quantity(after, unit)} as identified"
        )
    return "Left on the records that were not used: " + "; ".join(parts) + "."


def told_words(t: Told) -> str:
    """ "moving mass 3.65 ± 0.04 kg" """
    return f"{words(t.name)} {format_estimate(t.value, t.error, PARAMETERS[t.name].unit, t.name)}"


def declarations(result: BenchResult) -> dict[str, Declaration]:
    """What was identified, as a rig file declares it. Sensor errors are not the machine's."""
    return {
        t.name: Declaration(t.value, COVERAGE * t.error)
        for t in result.fit.wanted
        if t.told and t.name in result.asked and not t.name.startswith("sensor_")
    }


def to_dict(result: BenchResult) -> dict[str, Any]:
    """Everything, for programs; SI units."""
    fit = result.fit
    found = fit.found
    return {
                "rig": result.rig,
        "title": result.title,
        "subject": result.subject,
        "sentences": sentences(result),
        "findings": [str(f) for f in fit.records.findings],
        "parameters": list(_told_dicts(fit.wanted)),
        "known_within_limits": list(_told_dicts(fit.surroundings)),
        "not_told": [{"name": n, "why": why} for n, why in fit.left_out],
        "covariance": {
            "names": [f.name for f in found.free],
            "values": fit.birge**2 * found.covariance,
        },
        "residual_over_noise": found.scale,
        "birge_ratio": fit.birge,
        "samples_as_one": {
            channel: colour.samples_as_one
            for channel, colour in zip(fit.records.identify.channels, found.colours, strict=True)
        },
        "condition": found.condition,
        "starts": found.starts,
        "minima": found.minima,
        "iterations": found.iterations,
        "gain": [
            {
                "record": g.record, "signal": g.channel, "rms_declared": g.before, "rms_identified": g.after,
                "noise": g.noise, "gain": g.gain, "gain_95": list(g.interval),
            }
            for g in fit.gain
        ],
        "warnings": warnings(fit),
    }  # fmt: skip


def _told_dicts(told: Iterable[Told]) -> Iterable[dict[str, Any]]:
    for t in told:
        yield {
            "name": t.name, "unit": PARAMETERS[t.name].unit, "value": t.value, "standard_error": t.error,
            "declared": t.before, "declared_uncertainty": t.known_to, "told": t.told, "scatter": t.scatter,
            "runs": [{"value": v, "standard_error": e} for v, e in t.runs],
        }  # fmt: skip


def gain_cell(gain: float, low: float, high: float) -> str:
    """ "66 % (53 to 75 %)" """
    return f"{100.0 * gain:.0f} % ({format_interval(low, high)})"
