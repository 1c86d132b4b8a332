"""What is published, and the row that a computed figure makes of it."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.resources import files

from sms.arrays import Array
from sms.io.json_files import json_text


@dataclass(frozen=True)
class Figure:
    """One published figure and the band within which a computed one agrees."""

    key: str
    experiment: str
    quantity: str
    unit: str
    source: str  #: section, figure or table
    why: str  #: the reason for the band
    published: float | None = None  #: None where the source has words only
    words: str = ""
    low: float = -math.inf
    high: float = math.inf

    def row(self, computed: float, remark: str = "") -> Row:
        """The row with a computed value; one that is not a number does not agree."""
        band = f"agrees {_band(self.low, self.high)} ({self.why})"
        said = f'published: "{self.words}"' if self.words else ""
        text = "; ".join(part for part in (remark, said, band, self.source) if part)
        value = float(computed)
        agrees = self.low <= value <= self.high
        return Row(self.experiment, self.quantity, self.published, value, self.unit, agrees, text)


@dataclass(frozen=True)
class Row:
    """Published against computed, SI units, angles of a phase in degrees."""

    experiment: str
    quantity: str
    published: float | None
    computed: float
    unit: str
    agrees: bool
    remark: str

    @property
    def difference(self) -> float | None:
        """Computed less published."""
        return None if self.published is None else self.computed - self.published

    def to_dict(self) -> dict[str, object]:
        """For programs; what could not be computed is None."""
        return {
            "experiment": self.experiment,
            "quantity": self.quantity,
            "published": self.published,
            "computed": self.computed if math.isfinite(self.computed) else None,
            "unit": self.unit,
            "agrees": self.agrees,
            "remark": self.remark,
        }


def rows_to_json(rows: Iterable[Row]) -> str:
    """A JSON file with an object a row."""
    return json_text("validation", {"rows": [row.to_dict() for row in rows]})


def _band(low: float, high: float) -> str:
    if math.isinf(low):
        return f"up to {high:.7g}"
    if math.isinf(high):
        return f"from {low:.7g}"
    return f"from {low:.7g} to {high:.7g}"


def _loaded() -> dict[str, Figure]:
    text = files("sms.validation").joinpath("published.toml").read_text(encoding="utf-8")
    return {key: Figure(key=key, **entry) for key, entry in tomllib.loads(text).items()}


FIGURES = _loaded()


def peak_to_peak(values: Array) -> float:
    """Largest less smallest."""
    return float(values.max() - values.min())
