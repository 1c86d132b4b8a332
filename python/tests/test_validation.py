"""The published experiments: what measures them, the light ones, and (full) all of them by band."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms.arrays import Array
from sms.cli import main
from sms.motion.excitation import sine
from sms.report.validation import validation_html
from sms.scenario import Record
from sms.validation import EXPERIMENTS, FIGURES, Row, rows_to_json, validate
from sms.validation.open_loop import rise_time
from sms.validation.runs import crossing, response_at, run
from sms.validation.steps import step_of

from validation.random_cases import draw

KEYS = ["experiment", "quantity", "published", "computed", "unit", "agrees", "remark"]
LIGHT = "round trip", "dead band", "simplified plant", "appendix E", "velocity per volt"


@pytest.fixture
def random() -> np.random.Generator:
    return draw("validation")


@pytest.fixture(scope="module")
def light() -> list[Row]:
    return validate(LIGHT)


def record_of(time: Array, extension: Array) -> Record:
    """A record in which only time and extension matter, alike on three legs."""
    legs = np.repeat(extension[:, None], 3, axis=1)
    return Record(time, legs, "m", legs, legs, legs, legs, legs, legs, None, None, float(time[-1]))


# ---- figures and rows ----


def test_every_figure_says_where_it_stands_and_why_its_band() -> None:
    for figure in FIGURES.values():
        assert figure.source and figure.why, figure.key
        assert figure.low < figure.high, figure.key
        assert math.isfinite(figure.low) or math.isfinite(figure.high), figure.key
        assert (figure.published is not None) != bool(figure.words), figure.key


def test_row_agrees_within_its_band_and_never_without_a_number() -> None:
    figure = replace(FIGURES["heave_gain"], low=-12.0, high=-10.0, published=-11.0)
    assert figure.row(-12.0).agrees and figure.row(-10.0).agrees
    assert not figure.row(-12.001).agrees and not figure.row(-9.999).agrees
    assert not figure.row(math.nan).agrees
    assert figure.row(-12.5).difference == pytest.approx(-1.5)


def test_json_has_exactly_the_keys_and_no_nan() -> None:
    rows = [FIGURES["heave_gain"].row(-14.0, "why"), FIGURES["proportional_safe"].row(math.nan)]
    loaded = json.loads(rows_to_json(rows), parse_constant=pytest.fail)["rows"]
    assert [list(row) for row in loaded] == [KEYS, KEYS]
    assert loaded[0]["computed"] == -14.0 and loaded[0]["published"] == -11.0
    assert loaded[1]["computed"] is None and loaded[1]["published"] is None
    assert "why" in loaded[0]["remark"] and "agrees from -12 to -10" in loaded[0]["remark"]


def test_page_escapes_and_shows_every_row() -> None:
    rows = [FIGURES["heave_gain"].row(-14.06, "a < b"), FIGURES["dead_band_a"].row(0.8402)]
    page = validation_html(rows)
    assert "a &lt; b" in page and "a < b" not in page
    assert "-14.06 dB" in page and "-3.06 dB" in page
    assert "1 of 2 published figures" in page


# ---- measuring ----


def test_crossing_is_interpolated() -> None:
    time = np.arange(5.0)
    assert crossing(time, np.array([0.0, 0.0, 1.0, 2.0, 2.0]), 0.5) == pytest.approx(1.5)
    assert math.isnan(crossing(time, np.zeros(5), 0.5))


def test_response_of_a_delayed_smaller_copy(random: np.random.Generator) -> None:
    period, delay, ratio = 1e-2, 7, random.uniform(0.1, 2.0)
    x = np.sin(2.0 * np.pi * 0.5 * period * np.arange(4000))  # whole periods
    value = response_at(x, ratio * np.roll(x, delay), period, 0.45, 0.55)
    assert abs(value) == pytest.approx(ratio, rel=1e-9)
    assert np.angle(value) == pytest.approx(-2.0 * np.pi * 0.5 * delay * period, abs=1e-9)


def test_step_of_a_first_order_lag_with_a_ripple(random: np.random.Generator) -> None:
    tau, ripple = random.uniform(0.05, 0.2), random.uniform(1e-4, 1e-3)
    time: Array = 1e-3 * np.arange(6001.0)
    late = np.maximum(time - 3.0, 0.0)
    x = 0.1 + 0.2 * (1.0 - np.exp(-late / tau)) + ripple * np.sin(40.0 * time) * (late > 1.9)
    step = step_of(record_of(time, x), 3.0, 0.1, 0.3)
    assert step.rise == pytest.approx(math.log(9.0) * tau, abs=2e-3)
    assert step.motion == pytest.approx(2.0 * ripple, rel=0.05)
    assert step.error < 1e-4


def test_rise_time_of_a_sine_that_drifts() -> None:
    time: Array = 1e-3 * np.arange(10731.0)
    x = 0.2 - 0.04 * np.cos(2.0 * np.pi * 0.5 * (time - 0.73)) - 0.002 * time
    exact = (math.acos(-0.8) - math.acos(0.8)) / (2.0 * math.pi * 0.5)  # without the drift
    assert rise_time(record_of(time, x), 0.5) == pytest.approx(exact, rel=0.02)


def test_sine_jumps_with_its_sign() -> None:
    time = np.array([0.0, 0.25, 0.75])
    assert sine(time, 0.5, 1.0, jump=0.3) == pytest.approx([0.0, 0.8, -0.8])
    assert sine(time, 0.5, 1.0, offset=5.0) == pytest.approx([5.0, 5.5, 4.5])


# ---- experiments ----


def test_figures_on_paper_agree_with_the_known_readings(light: list[Row]) -> None:
    differing = {row.quantity for row in light if not row.agrees}
    assert differing == {
        "K_p after Situm, from the parameters printed beside it",
        "natural frequency from the mean of both chambers, 333.5 kPa",
        "at 5 V, upwards under the load",
        "at 0.5 V, upwards under the load",
    }


def test_velocity_per_volt_is_what_independent_trials_gave(light: list[Row]) -> None:
    fast, slow = (row.computed for row in light if row.experiment == "velocity per volt")
    assert 0.10 < fast < 0.12  # SPEC: 0.106
    assert 0.37 < slow < 0.44  # SPEC: 0.40


def test_bench_sine_is_what_independent_trials_gave() -> None:
    travel, _, delay, offset = (row.computed for row in validate(["bench sine"]))
    assert 0.12 < travel < 0.15  # SPEC: 136 mm at a mass-flow gain of 1.5
    assert 0.15 < delay < 0.22  # SPEC: 191 to 215 ms
    assert -0.02 < offset < 0.0  # SPEC: -0.008 V


def test_a_changed_parameter_reaches_the_run() -> None:
    slow = run("bench_sine", {"mass_flow_gain": 0.5}, scenario={"duration": "4 s"})
    fast = run("bench_sine", scenario={"duration": "4 s"})
    assert np.ptp(slow.extension) < 0.6 * np.ptp(fast.extension)


def test_command_writes_page_and_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out, rows = tmp_path / "page", tmp_path / "rows.json"
    words = ["sms", "validate", "--only", "dead band", "--out", str(out), "--json", str(rows)]
    monkeypatch.setattr("sys.argv", words)
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 0
    assert [list(row) for row in json.loads(rows.read_text())["rows"]] == [KEYS, KEYS]
    assert "gain at zero" in (out / "validation.html").read_text()


def test_command_names_the_experiment_that_was_meant(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr("sys.argv", ["sms", "validate", "--only", "bench", "--out", str(tmp_path)])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    assert "--only bench" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.full
def test_all_experiments_fill_every_row_and_are_what_independent_trials_gave() -> None:
    rows = validate()
    by_quantity = {(row.experiment, row.quantity): row.computed for row in rows}
    used = {(figure.experiment, figure.quantity) for figure in FIGURES.values()}
    assert used <= set(by_quantity)
    assert all(math.isfinite(value) for value in by_quantity.values())
    assert len({row.experiment for row in rows}) >= len(EXPERIMENTS) - 3

    def computed(key: str) -> float:
        return by_quantity[FIGURES[key].experiment, FIGURES[key].quantity]

    assert -16.0 < computed("heave_gain") < -13.0  # SPEC: -14.9 dB
    assert -100.0 < computed("heave_phase") < -85.0  # SPEC: -93 deg
    assert 0.05 < computed("feedback_motion") < 0.15  # SPEC: 73 to 104 mm
    assert 45.0 <= computed("proportional_unstable") <= 55.0  # SPEC: 40 stable, 50 not
    assert 0.5 < computed("open_loop_rise_slow") < 0.75  # SPEC: 0.63 s
    assert computed("tank_ratio") < 0.5
    assert computed("linear_rise_situm") == pytest.approx(0.277, abs=0.003)
    assert computed("linear_rise_specified") == pytest.approx(0.342, abs=0.003)
