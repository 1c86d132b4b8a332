"""The flow identification against the independent simulator: errors, and how often intervals hold."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom
from sms.identification.flow_problem import COMPONENT

from validation.trials.identify_flow import CASES, cover
from validation.twins.flow_test import Charging, Component, simulate

SEED = 11


def holds(share: float, repeats: int) -> bool:
    """Whether a share can come from intervals that hold in 90 to 98 percent, but for one draw in 1000."""
    count = round(share * repeats)
    return bool(
        binom.ppf(0.0005, repeats, 0.90)
        <= count
        <= max(binom.ppf(0.9995, repeats, 0.98), repeats - 1)
        or count == repeats
    )


def test_intervals_hold_the_truth_in_a_small_trial() -> None:
    print(f"seed {SEED}")
    result = cover((1.0e-3, True, 486e3), 16, SEED)
    assert all(holds(share, 16) for share in result.covered.values()), result
    assert result.error[COMPONENT[0]] < 0.01
    assert result.error[COMPONENT[1]] < 0.03


@pytest.mark.full
@pytest.mark.parametrize("case", CASES)
def test_intervals_hold_the_truth_in_200_repeats(case: tuple[float, bool, float]) -> None:
    print(f"seed {SEED}")
    result = cover(case, 200, SEED)
    assert all(holds(share, 200) for share in result.covered.values()), result
    if result.identifiable[COMPONENT[1]] > 0.95:
        assert result.error[COMPONENT[0]] < 0.01
        assert result.error[COMPONENT[1]] < 0.03


def test_the_simulator_knows_the_choked_discharge_in_closed_form() -> None:
    """Isothermal, choked all the way: p = p_0 exp(-t / T)."""
    component = Component(conductance=1e-8, ratio=0.9, index=1.0)
    test = Charging(
        component, False, 486e3, ambient=1e3, opening=0.0, spool_frequency=1e4, duration=5.0
    )
    time, pressure = simulate(test)
    rate = 288.0 * 293.0 * 1e-8 * 1.185 * np.sqrt(293.15 / 293.0) / 5e-3
    assert pressure[1:] == pytest.approx(486e3 * np.exp(-rate * time[1:]), rel=1e-4)
