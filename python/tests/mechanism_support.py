"""Poses for the tests of the mechanism, and the reference values that were computed elsewhere."""

from __future__ import annotations

import json
import os
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sms
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = Path(os.environ.get("SMS_SHARED", ROOT.parent / "shared")) / "reference"

with_reference = pytest.mark.skipif(
    not REFERENCE.is_dir(),
    reason=f"there are no reference values in {REFERENCE}; set SMS_SHARED to their parent folder",
)


@cache
def cases(name: str) -> list[dict[str, Any]]:
    """The cases of reference/<name>.json."""
    found: list[dict[str, Any]] = json.loads((REFERENCE / f"{name}.json").read_text())["cases"]
    assert len(found) >= 20
    return found


def column(name: str, *keys: str) -> Array:
    """A number of every case, or several side by side."""
    values = np.array([[case[key] for key in keys] for case in cases(name)], dtype=float)
    return values[:, 0] if len(keys) == 1 else values


def driven(name: str) -> Array:
    """q = (roll, pitch, height) of every case."""
    return column(name, "roll", "pitch", "height")


def random_poses(random: np.random.Generator, count: int) -> Array:
    """q of extensions drawn within the stroke, so that every pose is one the machine can have."""
    stroke = sms.Params().stroke
    pose = sms.forward_kinematics(random.uniform(0.0, stroke, (count, 3)))
    return np.stack([pose.roll, pose.pitch, pose.height], axis=-1)


def difference(found: Array, wanted: Array) -> float:
    """Largest absolute difference; the shapes must agree."""
    assert np.shape(found) == np.shape(wanted)
    return float(np.max(np.abs(found - wanted)))


def relative_difference(found: Array, wanted: Array) -> float:
    """Largest difference against the length of the vector or matrix it belongs to."""
    assert np.shape(found) == np.shape(wanted)
    rows = len(wanted)
    found, wanted = found.reshape(rows, -1), wanted.reshape(rows, -1)
    return float(np.max(np.linalg.norm(found - wanted, axis=1) / np.linalg.norm(wanted, axis=1)))
