"""The simplified plant through python-control, against published numbers and the core itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sms
from sms import _core
from test_cli_mechanism import run

control = pytest.importorskip("control", reason="needs the extra sms[control]")
from sms.design import (  # noqa: E402
    MEAN_PRESSURE,
    bode,
    closed_loop,
    designs,
    open_loop,
    platform_state_space,
    readings,
    root_locus,
    transfer_function,
)


def test_the_printed_gains_follow_from_their_own_reading_only() -> None:
    found = {design.name: design for design in designs(readings()[2])}
    misprinted = found["Šitum, with the misprint of eq. 8.9"]
    assert misprinted.gains == pytest.approx((15.8031, 1.3393, 0.1123), abs=1e-3)
    assert found["specification based"].gains == pytest.approx((3.9128, -0.4780, 0.0666), abs=1e-3)
    # Bandwidths of Table E.1, and what SPEC's independent trials gave for the rise times.
    assert misprinted.bandwidth == pytest.approx(1.2513, abs=5e-3)
    assert found["specification based"].bandwidth == pytest.approx(1.0001, abs=2e-3)
    assert misprinted.rise_time == pytest.approx(0.277, abs=2e-3)
    assert found["specification based"].rise_time == pytest.approx(0.342, abs=2e-3)
    other = designs(readings()[1])[1]
    assert other.position != pytest.approx(15.8031, abs=1.0)


def test_poles_are_where_the_design_puts_them() -> None:
    for plant in readings():
        situm, *_ = designs(plant)
        assert np.array(situm.poles) == pytest.approx(-0.75 * plant.natural_frequency, rel=1e-4)
        assert situm.stable and 0.0 <= situm.overshoot < 1e-3


def test_control_and_the_core_agree() -> None:
    design = designs(readings()[0])[0]
    frequency = np.geomspace(0.1, 10.0, 20)
    plant = design.plant
    model = plant.velocity_gain, plant.natural_frequency, plant.damping_ratio
    loop = _core.closed_loop(*model, *design.gains)
    amplitude, phase = _core.frequency_response(*loop, frequency)
    ours = bode(closed_loop(design), frequency)
    assert ours[0] == pytest.approx(amplitude) and ours[1] == pytest.approx(phase)
    # The feedback's loop closes to the same denominator.
    poles = np.sort_complex(control.feedback(open_loop(design), 1).poles())
    assert poles == pytest.approx(np.sort_complex(np.array(design.poles)), abs=1e-2)
    assert root_locus(design, [1.0])[0].sum() == pytest.approx(sum(design.poles), rel=1e-6)


def test_p_control_of_2_at_1_hz() -> None:
    plant = replace(readings()[2], velocity_gain=0.85)
    loop = control.feedback(2.0 * transfer_function(plant), 1)
    amplitude, phase = bode(loop, [0.01, 1.0])
    # SPEC: -11.1 dB, -77 deg for the published -11 dB, -80 deg.
    assert 20.0 * np.log10(amplitude[1]) == pytest.approx(-11.1, abs=1.0)
    assert np.degrees(phase[1]) == pytest.approx(-77.0, abs=8.0)


def test_the_platform_s_modes_are_the_core_s() -> None:
    system = platform_state_space(damping=0.0)
    found = np.sort(np.abs(system.poles()))[::2] / (2.0 * np.pi)
    stiffness = float(_core.air_spring(sms.Params(), MEAN_PRESSURE))
    modes = sms.eigenfrequencies((0.0, 0.0, 0.5), stiffness)
    assert found == pytest.approx(np.sort(modes.eigenfrequency), rel=1e-9)
    assert found == pytest.approx([1.97, 2.01, 2.92], abs=0.01)  # SPEC, section 2
    assert system.output_labels == ["roll", "pitch", "height"]
    assert system.ninputs == 3 and np.real(platform_state_space().poles()).max() < 0.0


def test_the_command_writes_a_page(tmp_path: Path) -> None:
    printed = run("design", cwd=tmp_path).stdout
    assert "as printed in Table E.1" in printed and "not stable" in printed
    assert "Root locus" in (tmp_path / "design/design.html").read_text(encoding="utf-8")
