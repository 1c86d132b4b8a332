"""The comparison's numbers against signals whose answers are known."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import lfilter
from sms.comparison import (
    compare_files,
    compare_signals,
    frequency_response,
    normalised_cross_correlation,
    rising_flanks,
)
from sms.io import InputError, write_table
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command
from test_cli_mechanism import run

TIME: NDArray[np.float64] = 0.01 * np.arange(4000.0)


def wave(amplitude: float = 1.0, delay: float = 0.0) -> NDArray[np.float64]:
    return amplitude * np.sin(2.0 * np.pi * 0.5 * (TIME - delay))


def test_the_correlation_is_blind_to_gain_and_the_ratio_is_not() -> None:
    found = compare_signals(TIME, wave(), 3.0 + wave(0.5))
    assert found.correlation == pytest.approx(1.0, abs=1e-12)
    assert found.amplitude_ratio == pytest.approx(0.5, abs=1e-9)
    assert found.offset == pytest.approx(3.0, abs=1e-9)
    assert found.rms_error == pytest.approx(np.sqrt(9.0 + 0.125), rel=1e-3)


def test_identical_signals_have_no_error() -> None:
    found = compare_signals(TIME, wave(), wave())
    assert (found.mean_absolute_error, found.rms_error) == (0.0, 0.0) and abs(found.lag) < 1e-12
    assert found.rise_time_ratio == 1.0


def test_a_late_simulation_has_a_positive_lag() -> None:
    assert compare_signals(TIME, wave(), wave(delay=0.123)).lag == pytest.approx(0.123, abs=2e-3)
    assert compare_signals(TIME, wave(delay=0.123), wave()).lag == pytest.approx(-0.123, abs=2e-3)


def test_the_lag_of_a_motion_that_begins_and_ends_at_rest() -> None:
    """Up to mid-stroke, a while of waves, and down again: the ends that do not move have no say in the lag."""

    def motion(delay: float) -> NDArray[np.float64]:
        time = TIME - delay
        faded = np.interp(time, [2.0, 7.0, 33.0, 38.0], [0.0, 1.0, 1.0, 0.0])
        return faded * (0.2 + 0.02 * np.sin(0.9 * time) + 0.01 * np.sin(1.7 * time + 1.0))

    for delay in (0.3, -0.3, 1.0, 0.0):
        found = compare_signals(TIME, motion(0.0), 0.9 * motion(delay) + 0.01)
        assert found.lag == pytest.approx(delay, abs=1e-3)
        assert found.correlation_at_lag == pytest.approx(1.0, abs=1e-5)


def test_of_the_peaks_of_a_periodic_signal_the_nearest_is_its_lag() -> None:
    noise = np.random.default_rng(6).normal(0.0, 0.2, (2, TIME.size))
    for period in (0.07, 0.5, 2.03):
        x, y = (np.sin(2.0 * np.pi * (TIME - d) / period) for d in (0.0, 0.3 * period))
        assert compare_signals(TIME, x, y).lag == pytest.approx(0.3 * period, abs=2e-3)
        noisy = compare_signals(TIME, x + noise[0], y + noise[1])
        assert noisy.lag == pytest.approx(0.3 * period, abs=0.05 * period)


def test_the_correlation_at_the_lag_is_eq_7_2_of_the_overlap() -> None:
    x, y = np.random.default_rng(8).normal(size=(2, 300)).cumsum(axis=1)
    found = compare_signals(0.1 * np.arange(300.0), x, y)
    late = round(found.lag / 0.1)
    overlap = (x[: 300 - late], y[late:]) if late >= 0 else (x[-late:], y[:late])
    expected = normalised_cross_correlation(*overlap)
    assert found.correlation_at_lag == pytest.approx(expected, abs=2e-3)


def test_the_rise_time_ratio_is_simulated_over_measured() -> None:
    def rise(time_constant: float) -> NDArray[np.float64]:
        return np.where(TIME > 1.0, 1.0 - np.exp(-(TIME - 1.0) / time_constant), 0.0)

    assert rising_flanks(TIME, rise(0.3))[0, 1] == pytest.approx(0.3 * np.log(9.0), abs=1e-3)
    found = compare_signals(TIME, rise(0.4), rise(0.34))
    assert found.rise_time_ratio == pytest.approx(0.85, abs=1e-3)
    assert np.isnan(compare_signals(TIME, np.ones(TIME.size), rise(0.3)).rise_time_ratio)


def test_eq_7_2_by_its_own_definition() -> None:
    random = np.random.default_rng(4)
    x, y = random.normal(size=(2, 500)).cumsum(axis=1)
    line = np.polynomial.Polynomial
    index = np.arange(500.0)
    a, b = (v - line.fit(index, v, 1)(index) for v in (x, y))
    expected = np.sum(a * b) / np.sqrt(np.sum(a**2) * np.sum(b**2))
    assert normalised_cross_correlation(x, y) == pytest.approx(expected, abs=1e-12)


def test_the_frequency_response_of_a_known_filter() -> None:
    source = np.random.default_rng(5).normal(size=40000)
    answer = np.asarray(lfilter([0.1], [1.0, -0.9], source))
    found = frequency_response(source, answer, 0.01, 1000)
    exact = 0.1 / (1.0 - 0.9 * np.exp(-2j * np.pi * found.frequency * 0.01))
    inside = (found.frequency > 0.5) & (found.frequency < 30.0)
    assert found.gain[inside] == pytest.approx(np.abs(exact)[inside], rel=0.1)
    assert found.phase[inside] == pytest.approx(np.unwrap(np.angle(exact))[inside], abs=0.1)
    assert found.coherence[inside].min() > 0.95


def records(folder: Path) -> tuple[Path, Path]:
    measured, simulated = folder / "measured.csv", folder / "simulated.csv"
    write_table(
        measured,
        {"time [ms]": 1e3 * TIME, "extension_1 [mm]": 200.0 + 100.0 * wave(), "u [V]": wave()},
    )
    write_table(
        simulated,
        {
            "time [s]": TIME[::2],
            "extension_1 [m]": 0.2 + 0.08 * wave(delay=0.1)[::2],
            "v [V]": TIME[::2],
        },
    )
    return measured, simulated


def test_files_with_other_units_and_steps(tmp_path: Path) -> None:
    found = compare_files(*records(tmp_path))
    (signal,) = found.signals
    assert signal.unit == "m" and signal.metrics.amplitude_ratio == pytest.approx(0.8, abs=1e-3)
    assert found.left_out == ("u", "v")
    aligned = compare_files(*records(tmp_path), align=True)
    assert abs(aligned.signals[0].metrics.lag) < 1e-3 and aligned.shift == pytest.approx(
        -0.1, abs=2e-3
    )


def test_the_command_writes_a_page_and_the_same_numbers_as_json(tmp_path: Path) -> None:
    files = [str(file) for file in records(tmp_path)]
    printed = json.loads(run("compare", *files, "--input", "u", "--json", cwd=tmp_path).stdout)
    assert printed == json.loads((tmp_path / "comparison/comparison.json").read_text())
    assert printed["signals"]["extension_1"]["amplitude_ratio"] == pytest.approx(0.8, abs=1e-3)
    assert "simulated over measured" in printed["ratios"]
    assert "simulated_over_input" in printed["signals"]["extension_1"]["frequency_response"]
    page = (tmp_path / "comparison/comparison.html").read_text()
    assert "blind to gain" in page


def test_files_that_share_nothing(tmp_path: Path) -> None:
    measured, simulated = records(tmp_path)
    with pytest.raises(InputError, match="no column 'extension_2'"):
        compare_files(measured, simulated, ["extension_2"])
    with pytest.raises(InputError, match="overlap in less than 8 samples"):
        compare_files(measured, simulated, shift=1e4)
    head, row, *_ = measured.read_text().splitlines()
    measured.write_text(f"{head}\n{row}\n")
    with (
        warnings.catch_warnings(action="error"),
        pytest.raises(InputError, match="overlap in less than 8 samples"),
    ):
        compare_files(measured, simulated)
    write_table(tmp_path / "other.csv", {"time [s]": TIME, "force [N]": TIME})
    refused(command("compare", str(measured), "other.csv", cwd=tmp_path), "share no signal")
    assert not (tmp_path / "comparison").exists()
