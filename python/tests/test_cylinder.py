"""Forces of one cylinder from Python: defaults, broadcasting, errors."""

from __future__ import annotations

import numpy as np
import pytest
import sms
from sms import _core


def test_friction_of_the_source_at_rest_of_everything_else() -> None:
    params = sms.Params()
    assert sms.friction(0.1) == pytest.approx(38.0 + 530.0 * 0.1, abs=1e-12)
    assert sms.friction(-0.1) == -sms.friction(0.1)
    assert sms.friction(0.0) == 0.0
    ambient = params.ambient_pressure
    core = _core.friction(params, 0.5 * params.stroke, 0.1, 0.4, ambient, ambient)
    assert sms.friction(0.1, 0.4) == float(core)


def test_defaults_are_mid_stroke_and_ambient_pressure() -> None:
    params = sms.Params(position_friction=2.0, pressure_friction=1e-4)
    middle, ambient = 0.5 * params.stroke, params.ambient_pressure
    plain = sms.friction(0.1, params=params)
    assert plain == sms.friction(0.1, 0.0, middle, ambient, ambient, params)
    assert plain != sms.friction(0.1, extension=0.0, params=params)
    assert plain != sms.friction(0.1, pressure_lower=4e5, params=params)


def test_rod_force_is_pressure_less_friction_less_inertia() -> None:
    params = sms.Params()
    area = 0.25 * np.pi * params.bore_diameter**2
    push = sms.rod_force(0.1, 0.5, pressure_lower=4e5)
    friction = sms.friction(0.1, 0.5, pressure_lower=4e5)
    expected = (4e5 - params.ambient_pressure) * area - friction - params.moving_mass * 0.5
    assert push == pytest.approx(expected, rel=1e-12)


def test_inputs_broadcast() -> None:
    force = sms.friction(np.linspace(-0.2, 0.2, 5)[:, None], [0.0, 0.3, 1.0])
    assert force.shape == (5, 3)
    assert force[4, 1] == sms.friction(0.2, 0.3)
    assert np.ndim(sms.friction(0.2)) == 0


def test_a_number_that_is_none_is_named() -> None:
    with pytest.raises(sms.NotANumberError, match=r"^row 2: velocity = nan m/s: it must be"):
        sms.friction([0.1, 0.2, np.nan])
    with pytest.raises(sms.NotANumberError, match=r"^pressure_lower = inf Pa"):
        sms.rod_force(0.1, pressure_lower=np.inf)
    with pytest.raises(ValueError, match=r"velocity \(2,\), acceleration \(3,\)"):
        sms.friction([0.1, 0.2], [0.0, 0.0, 0.0])
