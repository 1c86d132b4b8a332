"""What a survey of the workspace says, in words for a person and as plain values for a program."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sms.arrays import Array
from sms.workspace_survey import ACCELERATION, DEGREE, Box, Fit, Survey, Worst


def findings(survey: Survey) -> list[str]:
    """What an engineer has to know before he asks the machine for a motion, a sentence each."""
    return [
        *(_fit_sentence(fit) for fit in survey.fits),
        _alone_sentence(survey),
        _singularity_sentence(survey.worst_of_all),
        _joint_sentence(survey.worst_of_all),
        _payload_sentence(survey),
    ]


def degrees(angle: float, decimals: int = 1) -> str:
    """An angle for a person: "9.7°"."""
    return f"{angle / DEGREE:.{decimals}f}°"


def box_words(box: Box) -> str:
    return f"±{box.roll / DEGREE:g}° roll with ±{box.pitch / DEGREE:g}° pitch"


def _fit_sentence(fit: Fit) -> str:
    what = f"{box_words(fit.box)} ({fit.box.name}, Table 2.1)"
    if math.isnan(fit.fits_from):
        return (
            f"{what} fits at no height: at the best one, {fit.best_height:.3f} m, "
            f"{-1e3 * fit.best_margin:.1f} mm of stroke are missing in its worst corner."
        )
    return (
        f"{what} fits from {fit.fits_from:.3f} to {fit.fits_to:.3f} m of height only; at the best "
        f"one, {fit.best_height:.3f} m, {1e3 * fit.best_margin:.1f} mm of stroke are left."
    )


def _alone_sentence(survey: Survey) -> str:
    parts = []
    for axis in ("roll", "pitch"):
        limit = survey.either_way(axis)
        best = int(np.argmax(limit))
        parts.append(f"{axis} ±{degrees(limit[best])} at {survey.heights[best]:.2f} m")
    return f"Each axis alone, the other level, reaches furthest with {' and '.join(parts)}."


def _singularity_sentence(worst: Worst) -> str:
    rods, links = float(worst.panhard_condition), float(worst.link_condition)
    return (
        "No singularity is near anywhere within the stroke: the condition number of the Panhard "
        f"rods' constraint stays below {_up(rods)}, that of all six links below "
        f"{_up(links)}."
    )


def _up(value: float) -> str:
    """Two decimals, rounded up."""
    return f"{math.ceil(100.0 * value) / 100.0:.2f}"


def _joint_sentence(worst: Worst) -> str:
    def most(values: Array) -> str:
        return degrees(float(values))

    return (
        f"From rest the joints turn by up to {most(worst.base_actuator)} (actuator at the base), "
        f"{most(worst.platform_actuator)} (actuator at the platform), {most(worst.base_panhard)} "
        f"(rod at the base) and {most(worst.platform_panhard)} (rod at the platform)."
    )


def _payload_sentence(survey: Survey) -> str:
    supply = 1e-3 * (survey.params.supply_pressure - survey.params.ambient_pressure)
    holding = float(survey.worst_of_all.holding_share)
    accelerating = float(survey.worst_of_all.accelerating_share)
    verdict = "enough for" if accelerating < 1.0 else "NOT ENOUGH for"
    return (
        f"At {supply:.0f} kPa of supply above ambient an actuator pushes with {survey.push:.0f} N "
        f"and pulls with {survey.pull:.0f} N, {verdict} the payload of "
        f"{survey.params.payload_mass:.0f} kg: in the worst pose holding takes {holding:.0%} of "
        f"that, with {degrees(ACCELERATION)}/s² of roll and pitch at once {accelerating:.0%}, "
        "friction not counted."
    )


def to_dict(survey: Survey) -> dict[str, Any]:
    """For programs: SI units in the keys, NaN as None."""
    roll, pitch = survey.alone("roll"), survey.alone("pitch")
    worst = survey.worst
    columns = {
        "height_m": survey.heights,
        "roll_min_rad": roll[0],
        "roll_max_rad": roll[1],
        "pitch_min_rad": pitch[0],
        "pitch_max_rad": pitch[1],
        "base_actuator_angle_rad": worst.base_actuator,
        "base_panhard_angle_rad": worst.base_panhard,
        "platform_actuator_angle_rad": worst.platform_actuator,
        "platform_panhard_angle_rad": worst.platform_panhard,
        "panhard_condition": worst.panhard_condition,
        "link_condition": worst.link_condition,
        "holding_force_share": worst.holding_share,
        "accelerating_force_share": worst.accelerating_share,
    }
    return {
        "findings": findings(survey),
        "boxes": [
            {
                "name": fit.box.name,
                "roll_rad": fit.box.roll,
                "pitch_rad": fit.box.pitch,
                "fits": math.isfinite(fit.fits_from),
                "fits_from_m": _number(fit.fits_from),
                "fits_to_m": _number(fit.fits_to),
                "best_height_m": _number(fit.best_height),
                "best_margin_m": _number(fit.best_margin),
            }
            for fit in survey.fits
        ],
        "by_height": {name: [_number(v) for v in values] for name, values in columns.items()},
        "force_push_N": survey.push,
        "force_pull_N": survey.pull,
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
