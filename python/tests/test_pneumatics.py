"""Pneumatics, friction laws and controllers from Python: shapes, bad input, the choice of a law."""

from __future__ import annotations

import numpy as np
import pytest
from sms import _core


def test_arrays_broadcast_and_several_results_have_one_shape() -> None:
    voltage = np.linspace(0.0, 10.0, 11)[:, None]
    lower = np.linspace(1e5, 4e5, 4)
    flows = _core.valve_mass_flow(_core.Params(), voltage, 486e3, lower, 3e5, 86e3)
    assert len(flows) == 4
    assert all(flow.shape == (11, 4) for flow in flows)
    one = _core.valve_mass_flow(_core.Params(), 7.0, 486e3, 2e5, 3e5, 86e3)
    assert one[0] == flows[0][7, 1] > 0.0
    empty = _core.valve_mass_flow(_core.Params(), np.empty(0), 486e3, 2e5, 3e5, 86e3)
    assert all(flow.shape == (0,) for flow in empty)


def test_shapes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="shape"):
        _core.force_balance(_core.Params(), 0.2, np.zeros(3), 1e5, 1e5, 4.0, np.zeros(2))
    with pytest.raises(ValueError, match=r"error has to be a record, an array of shape \(n,\)"):
        _core.pid(_core.Params(), np.zeros((3, 2)))
    with pytest.raises(ValueError, match="records of one length"):
        _core.state_feedback(_core.Params(), np.zeros(3), np.zeros(4))


def test_the_law_is_chosen_by_name_and_a_wrong_name_is_answered_with_the_right_ones() -> None:
    params = _core.Params()
    laws = ("iso_0_4_mpa", "iso_0_2_mpa", "classic")
    flows = [_core.valve_mass_flow(params, 7.0, 486e3, 2e5, 3e5, 86e3, law)[0] for law in laws]
    assert len({float(flow) for flow in flows}) == 3
    with pytest.raises(ValueError, match="law = 'iso' is none of 'iso_0_4_mpa', 'iso_0_2_mpa', 'c"):
        _core.valve_mass_flow(params, 7.0, 486e3, 2e5, 3e5, 86e3, "iso")
    for ask in (_core.valve_table, lambda law: _core.charge_flow(params, 1.0, law)):
        with pytest.raises(ValueError, match="law = 'classic' is none of 'iso_0_4_mpa', 'iso_0_2"):
            ask("classic")
    with pytest.raises(ValueError, match="chamber = 'left' is none of 'lower', 'upper'"):
        _core.chamber_volume(params, "left", 0.1)


def test_the_table_is_the_published_one() -> None:
    table = _core.valve_table("iso_0_4_mpa")
    assert all(column.shape == (28,) for column in table.values())
    row = np.argmin(np.abs(table["spool"] - 1.0e-3))
    assert table["charge_C"][row] == 2.2397e-8
    assert table["discharge_m"][row] == 1.10078
    assert table["opening"][row] == pytest.approx(2.502, abs=1e-12)


def test_a_force_balance_for_every_law() -> None:
    for law in ("acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre"):
        acceleration, friction, rate = _core.force_balance(
            _core.Params(), 0.2, 0.1, 386e3, 281e3, 3.639, [150.0, -80.0], 1e-4, law
        )
        assert np.allclose(3.639 * acceleration + friction, [150.0, -80.0], rtol=1e-12)
        assert np.all((rate != 0.0) == (law in ("dahl", "lugre")))
