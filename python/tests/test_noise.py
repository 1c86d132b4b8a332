"""`sms noise`: moments against numpy's definitions, white against coloured, bad stretches named."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from sms.identification.noise import noise_of
from sms.io import InputError
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command

SEED = 3


def test_moments_are_the_source_s_and_the_floor_is_the_variance_over_the_band() -> None:
    rng = np.random.default_rng(SEED)
    time = np.arange(20_000) / 100.0
    values = 4e5 + 3.0 * time + 323.2 * rng.standard_normal(time.size)
    n = noise_of(time, values)
    left = values - np.polyval(np.polyfit(time, values, 1), time)
    centred = left - left.mean()
    assert n.kurtosis == pytest.approx(
        np.mean(centred**4) / np.mean(centred**2) ** 2 - 3.0
    )  # eq. 5.13
    assert n.skewness == pytest.approx(np.mean(centred**3) / np.mean(centred**2) ** 1.5)
    assert n.sd == pytest.approx(323.2, rel=0.02)
    assert n.trend == pytest.approx(3.0, abs=0.2)
    assert n.white
    assert n.floor == pytest.approx(10 * np.log10(323.2**2 / 50.0), abs=0.3)
    assert n.normal_p > 1e-3
    # The source's filter (0.25, 0.02) left 131.4 Pa of 323.2 Pa.
    assert n.filtered_sd == pytest.approx(131.4, rel=0.05)


def test_coloured_and_skewed_noise_is_called_so() -> None:
    rng = np.random.default_rng(SEED)
    time = np.arange(5000) / 1000.0
    smooth = np.convolve(rng.standard_normal(5004), np.ones(5) / 5, "valid")
    assert not noise_of(time, smooth).white
    assert noise_of(time, rng.exponential(1.0, 5000)).skewness == pytest.approx(2.0, abs=0.4)


@pytest.mark.parametrize(
    ("time", "values", "said"),
    [
        (np.arange(10.0), np.arange(10.0), "too few"),
        (np.arange(100.0) ** 2, np.arange(100.0), "uneven"),
        (np.arange(100.0), np.ones(100), "does not change"),
        (np.arange(100.0), np.full(100, np.nan), "not numbers"),
    ],
)
def test_a_stretch_that_says_nothing_is_refused(
    time: np.ndarray, values: np.ndarray, said: str
) -> None:
    with pytest.raises(InputError, match=said):
        noise_of(time, values)


def test_the_command_describes_a_stretch(tmp_path: Path) -> None:
    rng = np.random.default_rng(SEED)
    time = np.arange(3000) / 100.0
    table = np.column_stack((time, 2e5 + 300.0 * rng.standard_normal(3000)))
    header = "time [s],tank_pressure [Pa]"
    np.savetxt(tmp_path / "run.csv", table, delimiter=",", header=header, comments="")
    result = command("noise", "run.csv", "--from", "5", "--to", "25", "--json", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    answer = json.loads(result.stdout)
    assert answer["signal"] == "tank_pressure"
    assert answer["samples"] == 2001
    assert answer["white"]
    assert 'id="spectrum"' in (tmp_path / "noise" / "noise.html").read_text()
    refused(command("noise", "run.csv", "--signal", "tank_presure", cwd=tmp_path), "tank_pressure")
