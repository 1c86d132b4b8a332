"""The whole table of one machine."""

from __future__ import annotations

from collections.abc import Callable

from sms._core import Params
from sms.requirements.loop import plant_rows
from sms.requirements.mechanism import (
    acceleration_rows,
    best_height,
    flow_bandwidth_row,
    load_row,
    poses_of,
    range_rows,
    rate_rows,
    speeds_in,
)
from sms.requirements.table import SPECIFIED, Compliance


def compliance(
    params: Params | None = None,
    controller: str = "state_feedback",
    law: str = "iso_0_4_mpa",
    progress: Callable[[str, float], None] | None = None,
) -> Compliance:
    """The table; seconds, most of them for accuracy and bandwidth, which need the plant.

    The controller's gains are those of the parameters.

    Raises: ValueError when the supply cannot lift the platform.
    """
    params = params or Params()
    tell = progress or (lambda text, share: None)
    tell("mechanism", 0.0)
    height = best_height(params, SPECIFIED)
    q = poses_of(SPECIFIED, height)
    speed = speeds_in(params, q, law)
    rows = [
        *range_rows(params),
        *rate_rows(params, q, speed),
        *acceleration_rows(params, q),
        load_row(params, q),
        flow_bandwidth_row(params, height, speed),
        *plant_rows(params, controller, height, law, tell),
    ]
    return Compliance(params.copy(), height, speed, tuple(rows))
