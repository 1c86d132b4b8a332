"""Table 2.1: what is asked, and one line of what a machine gives. SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from sms._core import Params
from sms.motion.speed import SpeedLimits
from sms.workspace_survey import BOXES, DEGREE

REQUIRED, SPECIFIED = BOXES  #: of the movement range
RATES = {"roll": (5.35 * DEGREE, 6.0 * DEGREE), "pitch": (3.53 * DEGREE, 4.0 * DEGREE)}
ACCELERATIONS = {"roll": (5.1 * DEGREE, 6.2 * DEGREE), "pitch": (6.2 * DEGREE, 6.2 * DEGREE)}
LOADS = (260.0, 280.0)  #: kg
BANDWIDTHS = (0.5, 1.0)  #: Hz
ACCURACY = 0.5 * DEGREE
SEA_STATE = 2.5  #: up to which Table 2.1 asks for all of it


@dataclass(frozen=True)
class Row:
    """One line of the table. A larger `computed` is better unless `smaller_is_better`."""

    criterion: str
    axis: str
    required: float
    specified: float
    computed: float
    unit: str  #: SI
    limit: str  #: the part that limits it: stroke, flow, force, bandwidth
    remark: str
    smaller_is_better: bool = False

    def margin(self, asked: float) -> float:
        """How much more (or less error) there is than asked for, relative; negative: too little."""
        gain = (asked - self.computed) if self.smaller_is_better else (self.computed - asked)
        return gain / asked

    def meets(self, asked: float) -> bool:
        """Whether it is enough."""
        return self.margin(asked) >= 0.0


@dataclass(frozen=True)
class Compliance:
    """The whole table of one machine."""

    params: Params
    height: float  #: at which the box of the specification fits best, m
    speed: SpeedLimits  #: of an actuator, against the worst loads of that box
    rows: tuple[Row, ...]

    def to_dict(self) -> dict[str, Any]:
        """For programs, SI units."""
        return {
            "source": "Table 2.1",
            "height_m": self.height,
            "speed_up_m_per_s": self.speed.up,
            "speed_down_m_per_s": self.speed.down,
            "rows": [
                {
                    "criterion": row.criterion,
                    "axis": row.axis,
                    "unit": row.unit,
                    "required": row.required,
                    "specified": row.specified,
                    "computed": row.computed if math.isfinite(row.computed) else None,
                    "margin_required": _finite(row.margin(row.required)),
                    "margin_specified": _finite(row.margin(row.specified)),
                    "meets_required": row.meets(row.required),
                    "meets_specified": row.meets(row.specified),
                    "limit": row.limit,
                    "remark": row.remark,
                }
                for row in self.rows
            ],
        }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
