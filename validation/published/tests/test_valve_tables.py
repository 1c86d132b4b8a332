"""What is declared of the valve's map against what the source's two tables say of it."""

from __future__ import annotations

import re

import pytest
from sms.parameters import PARAMETERS

from validation.published.valve_tables import KNOTS, half_widths


def test_the_valves_map_is_declared_as_uncertain_as_the_source_leaves_it() -> None:
    """By its two tables and two ways of reading them, where that is not less than 3 %."""
    edges = ("feed_lower", "vent_lower", "feed_upper", "vent_upper")
    for knot, told in enumerate(half_widths(), 1):
        declared = {PARAMETERS[f"flow_map_{edge}_{knot}"].uncertainty for edge in edges}
        assert len(declared) == 1
        assert declared.pop() == pytest.approx(max(told, 0.03), rel=0.15)
    openings = [
        re.search(r"opening of ([\d.]+) V", PARAMETERS[f"flow_map_feed_lower_{k}"].doc)
        for k in range(1, 7)
    ]
    assert [float(o[1]) for o in openings if o] == KNOTS.tolist()
