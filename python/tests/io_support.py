"""Small rigs and records for the tests of reading, in a folder of their own."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sms.io import write_record

Array = NDArray[np.float64]

BORE_AREA = 4.9087385212340517e-4  # m^2, pi / 4 * (25 mm)^2
AMBIENT = 101325.0  # Pa

PARAMETERS = """
[parameters]
bore_diameter = { value = "25 mm", uncertainty = "0.02 mm" }   # measured with a gauge
stroke = "40 mm"
ambient_pressure = "101325 Pa"
coulomb_force = { fit = true, value = "5 N" }
"""
RECORDS = """
[[records]]
file = "one.csv"
role = "identify"

[[records]]
file = "two.csv"
role = "validate"
"""
PLAIN_RIG = '[rig]\nkind = "cylinder"\n' + PARAMETERS + RECORDS


def healthy_signals(samples: int = 1200, gauge_pressure: float = 3e5) -> dict[str, Array]:
    """A cylinder moved in and out at 100 Hz, with noise: SI units, absolute pressure."""
    random = np.random.default_rng(1)
    time = 0.01 * np.arange(samples)
    phase = (time / 4.0) % 1.0
    extension = 0.005 + 0.03 * (1.0 - np.abs(2.0 * phase - 1.0))
    direction = np.where(phase < 0.5, 1.0, -1.0)
    pressure = AMBIENT + gauge_pressure + random.normal(0.0, 500.0, samples)
    force = BORE_AREA * (pressure - AMBIENT) - 5.0 * direction
    return {
        "time": time,
        "extension": extension + random.normal(0.0, 1e-6, samples),
        "chamber_pressure_lower": pressure,
        "rod_force": force + random.normal(0.0, 0.3, samples),
    }


def write_rig(
    folder: Path, text: str = PLAIN_RIG, signals: Mapping[str, Array] | None = None
) -> Path:
    """Write rig.toml with the records one.csv (given signals) and two.csv (healthy); its path."""
    write_record(folder / "one.csv", signals if signals is not None else healthy_signals())
    write_record(folder / "two.csv", healthy_signals(gauge_pressure=5e5))
    path = folder / "rig.toml"
    path.write_text(text, encoding="utf-8")
    return path
