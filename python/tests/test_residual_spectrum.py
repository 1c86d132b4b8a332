"""What is wrong in each signal, and what a cause means in use: against signals and systems that are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from report_support import diagnosis
from scipy.signal import lfilter
from sms.diagnosis.design import closed_loop_performance
from sms.diagnosis.design.detection_limits import published_rig
from sms.diagnosis.localisation.residual_spectrum import _below
from sms.diagnosis.remainder import Symptom
from sms.diagnosis.result import InUse
from sms.report.diagnosis import report_html

SLOW = Symptom("extension", "m", 1.2e-4, 7e-5, True, "ends", 5.0, 6.0, 0.44, 4.0)


def first_order(corner: float) -> closed_loop_performance.Follow:
    """A lag of first order with this corner, Hz."""
    a = float(np.exp(-2.0 * np.pi * corner * closed_loop_performance.PERIOD))
    return lambda setpoint: np.asarray(lfilter([1.0 - a], [1.0, -a], setpoint))


@pytest.mark.parametrize("corner", [0.7, 1.3, 2.4])
def test_rise_time_and_bandwidth_of_a_first_order_lag(corner: float) -> None:
    rise, band, error = closed_loop_performance._quantities(first_order(corner), 0.04)
    assert rise == pytest.approx(np.log(9.0) / (2.0 * np.pi * corner), rel=0.01)
    assert band == pytest.approx(corner, rel=0.1)
    assert 0.0 < error < 0.01


def test_what_does_not_get_there_has_no_rise_time() -> None:
    time = np.arange(0.0, 1.0, 0.1)
    assert np.isnan(closed_loop_performance.rise_time(time, 0.8 * time, 1.0))


@pytest.mark.parametrize("kind", ["bench", "platform"])
def test_a_machine_that_is_the_same_does_the_same_and_a_slow_spool_is_seen(kind: str) -> None:
    rig = published_rig(kind)
    slow = rig.start().copy()
    slow["valve_frequency"] = 8.0
    alike = closed_loop_performance.in_use(rig, rig.start(), rig.start())
    assert [q.baseline for q in alike] == [q.extended for q in alike]
    assert any(
        abs(q.extended / q.baseline - 1.0) > 0.03
        for q in closed_loop_performance.in_use(rig, rig.start(), slow)
    )
    assert closed_loop_performance.in_use(published_rig("tank"), rig.start(), slow) == ()


def test_the_frequencies_of_an_error_are_told_beside_white_noise() -> None:
    rng, step = np.random.default_rng(1), 0.005
    time = np.arange(0.0, 1.0, step)
    wave = [np.sin(2.0 * np.pi * 6.0 * time + p) + 0.5 * rng.normal(size=200) for p in range(12)]
    assert 6.0 <= _below(wave, step) <= 8.0


def test_the_page_tells_what_is_wrong_and_what_it_means_in_use() -> None:
    quiet = replace(SLOW, signal="supply_pressure", unit="Pa", rms=281.0, noise=270.0, speaks=False)
    use = InUse("bandwidth of the position", "Hz", 2.0, 2.5)
    page = report_html(replace(diagnosis("cause"), symptoms=(quiet, SLOW), in_use=(use,)))
    told = page[page.index('id="symptoms"') : page.index('id="causes"')]
    assert "5 to 6 s" in told and "below 4 Hz" in told and "44" in told
    assert told.index("Extension") < told.index("Supply pressure")
    assert "within the noise" in told
    assert "2.00 Hz" in page and "2.50 Hz" in page and "+25" in page
