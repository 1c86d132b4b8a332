"""Half an hour of traffic: faster than real time, in a process that does not grow."""

from __future__ import annotations

import pytest

from validation.link.traffic import GROWTH_GOAL, replay_hours


@pytest.mark.full
def test_traffic_does_not_pile_up() -> None:
    traffic = replay_hours(0.5)
    print(traffic)
    assert traffic.frames > 1_000_000
    assert traffic.speed > 1.0
    assert traffic.growth < GROWTH_GOAL
