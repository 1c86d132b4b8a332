"""What a calibration says: sentences, calibration.json and geometry.toml."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import tomlkit

from sms.calibration.fit import COVERAGE, Calibrated, Found
from sms.calibration.proposal import Proposal


def sentences(c: Calibrated, proposals: Sequence[Proposal]) -> list[str]:
    """The result in plain words."""
    told = [f for f in c.found if f.measured]
    held = len(c.found) - len(told)
    said = [
        f"{len(c.rig.fitted)} poses fitted in {c.iterations} steps"
        + ("" if c.converged else "; the search did not converge, so do not use the result"),
        f"{len(told)} of {len(c.found)} parameters are measured by these poses; {held} stay as well known as the "
        "drawing says, alone; what they do together is known better than each",
    ]
    if len(c.rig.validation) and np.isfinite(c.validation.attitude[0]):
        before, after = np.degrees(c.validation.attitude)
        said.append(
            f"attitude on {len(c.rig.validation)} validation poses: {before:.3f} deg off before, {after:.3f} deg after "
            "(root mean square, with the noise of the inclinometer)"
        )
    if len(c.rig.validation) and np.isfinite(c.validation.distance[0]):
        before, after = 1e3 * np.array(c.validation.distance)
        said.append(
            f"distances on {len(c.rig.validation)} validation poses: {before:.2f} mm off before, {after:.2f} mm after "
            "(root mean square, with their noise)"
        )
    if not len(c.rig.validation):
        said.append(
            "there are no validation poses: nothing says how well the result holds elsewhere"
        )
    said += [f"not told by these poses: {k.words}" for k in c.combinations if not k.told]
    said += [
        f"pose {o.row} does not fit: {o.deviations:.1f} standard deviations off" for o in c.outliers
    ]
    if proposals:
        degrees = [
            f"{np.degrees(p.q[0]):.1f}/{np.degrees(p.q[1]):.1f} deg, {p.q[2]:.3f} m"
            for p in proposals
        ]
        said.append(f"measure next (roll/pitch, height): {'; '.join(degrees)}")
    return said


def to_dict(c: Calibrated, proposals: Sequence[Proposal]) -> dict[str, Any]:
    """calibration.json, SI."""
    before, after = c.validation.attitude
    return {
        "title": c.rig.title,
        "poses": len(c.rig.fitted),
        "converged": c.converged,
        "iterations": c.iterations,
        "parameters": [
            {
                "name": f.unknown.name,
                "unit": f.unknown.unit,
                "nominal": f.nominal,
                "value": f.value,
                "standard_deviation": f.deviation,
                "interval_95": list(f.interval),
                "tolerance": f.unknown.tolerance,
                "measured": f.measured,
            }
            for f in c.found
        ],
        "covariance": c.covariance.tolist(),
        "combinations": [
            {"words": k.words, "told": k.told, "information": k.information} for k in c.combinations
        ],
        "outliers": [
            {
                "pose": o.row,
                "standard_deviations": o.deviations,
                "error": dict(zip(c.rig.channels, o.error.tolist(), strict=True)),
            }
            for o in c.outliers
        ],
        "validation": {
            "poses": len(c.rig.validation),
            "attitude_rms_before": before,
            "attitude_rms_after": after,
            "distance_rms_before": c.validation.distance[0],
            "distance_rms_after": c.validation.distance[1],
        },
        "measure_next": [
            {
                "roll": p.q[0],
                "pitch": p.q[1],
                "height": p.q[2],
                "extension": p.extension.tolist(),
                "shrinks_to": p.gain,
            }
            for p in proposals
        ],
    }


def geometry_file(c: Calibrated, said: Sequence[str]) -> str:
    """geometry.toml: each parameter as a rig file declares it, with half the width of its 95 % interval."""
    document = tomlkit.document()
    for sentence in ("Calibrated by sms calibrate geometry.", *said):
        document.add(tomlkit.comment(sentence))
    parameters = tomlkit.table()
    for f in c.found:
        parameters.add(f.unknown.name, _declared(f))
    document.add("parameters", parameters)
    return tomlkit.dumps(document)


def _declared(f: Found) -> Any:
    unit = "" if f.unknown.unit == "1" else f" {f.unknown.unit}"
    row = tomlkit.inline_table()
    row.add("value", f"{f.value:.9g}{unit}" if unit else float(f"{f.value:.9g}"))
    half = COVERAGE * f.deviation
    row.add("uncertainty", f"{half:.3g}{unit}" if unit else float(f"{half:.3g}"))
    row.comment("measured" if f.measured else "drawing, within its tolerance")
    return row
