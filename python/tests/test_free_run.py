"""The error of a simulation over a whole record, beside that over windows."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sms.rigs.bench
from plant_support import EVERY, LEAK, NOISE, fitted_baseline, write_bench
from rich.console import Console
from sms import Params, _core, simulate_bench
from sms.diagnosis import Diagnosis
from sms.diagnosis.free_run import free_runs
from sms.diagnosis.hypothesis import Fitted
from sms.diagnosis.result import FreeRun, as_json
from sms.diagnosis.wording_simulated import free_run_in_words, worst_free_runs
from sms.estimation.least_squares import changed
from sms.report.console import print_diagnosis
from sms.report.diagnosis import report_html

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
RANGE = {"extension": 0.4, "chamber_pressure_lower": 5e5, "chamber_pressure_upper": 5e5}


def with_values(fitted: Fitted, **values: float) -> Fitted:
    params = changed(fitted.params, list(values), np.array(list(values.values())))
    return replace(fitted, fit=replace(fitted.fit, params=params))


def test_it_is_the_error_of_one_simulation_from_beginning_to_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Held against sms.simulate_bench with the same start, a command that is held, and the rms worked out anew."""
    monkeypatch.setattr(sms.rigs.bench, "LONGEST_STEP_ELSEWHERE", sms.rigs.bench.LONGEST_STEP)
    truth = {"piston_leakage": LEAK}
    path = write_bench(tmp_path, 2, truth)
    held = path.read_text().replace(
        '"valve_command"\n', '{ column = "valve_command", hold = "previous" }\n'
    )
    path.write_text(held)
    baseline, data = fitted_baseline(path)
    at = with_values(baseline, **truth)
    runs = free_runs(baseline, at, data)
    assert [(r.record, r.role) for r in runs[::3]] == [("run2", "validate"), ("run3", "validate")]
    run = data.validate.motions[0]
    whole = replace(data.validate, motions=(replace(run, window=1e9),)).simulation
    assert isinstance(whole, _core.BenchProblem) and len(whole.windows) == 1
    for fitted, which in ((baseline, "baseline_rms"), (at, "extended_rms")):
        assert isinstance(fitted.params, Params)
        whole.evaluate(fitted.params)
        w = whole.windows[0]
        command = np.repeat(run.signals["valve_command"][w.first : w.first + w.samples], EVERY)
        state = whole.state(fitted.params, 0)
        simulated = simulate_bench(
            command, params=fitted.params, state=state, step=1e-3, stiff=True
        )
        for found in runs[:3]:
            measured = run.signals[found.signal][w.first : w.first + w.samples]
            off = simulated.reading(found.signal)[::EVERY] - measured
            rms = float(np.sqrt(np.mean(off**2)))
            assert getattr(found, which) == pytest.approx(
                rms, rel=1e-3, abs=1e-6 * RANGE[found.signal]
            )


def test_clipped_readings_of_a_record_that_is_shorter_than_others_are_left_out(
    tmp_path: Path,
) -> None:
    baseline, data = fitted_baseline(write_bench(tmp_path, 2, {}))
    first, second = data.validate.motions
    samples = len(first.time) - 40
    signals = {name: values[:samples].copy() for name, values in first.signals.items()}
    clipped = np.arange(samples) >= samples - 20
    signals["chamber_pressure_lower"][clipped] += 1e5
    shorter = replace(first, time=first.time[:samples], signals=signals)
    said = replace(shorter, clipped={"chamber_pressure_lower": clipped})
    plain, without = (
        free_runs(
            baseline,
            baseline,
            replace(data, validate=replace(data.validate, motions=(run, second))),
        )[1]
        for run in (shorter, said)
    )
    assert plain.signal == without.signal == "chamber_pressure_lower"
    assert without.baseline_rms < 2.0 * NOISE["chamber_pressure_lower"] < plain.baseline_rms


def test_over_a_whole_record_an_error_grows_and_the_right_model_has_the_noise_only(
    leaking_bench: Diagnosis,
) -> None:
    answer = leaking_bench
    assert answer.verdict in ("cause", "class")
    runs, windows = answer.free_run, {(g.record, g.signal): g for g in answer.gain}
    assert {(r.record, r.signal) for r in runs} == set(windows)
    for run in runs:
        assert run.unit == windows[run.record, run.signal].unit
        assert run.extended_rms < 2.0 * NOISE[run.signal]
        assert (run.baseline_note, run.extended_note) == ("", "")
        if run.signal == "extension":
            assert run.baseline_rms > 1.3 * windows[run.record, run.signal].baseline_rms
    said = json.loads(as_json(answer))["free_run"]
    assert [(r["record"], r["signal"]) for r in said] == [(r.record, r.signal) for r in runs]
    assert said[0]["baseline_rms"] == pytest.approx(runs[0].baseline_rms)
    before, after = free_run_in_words(worst_free_runs(runs)[0])
    console = Console(width=300)
    with console.capture() as text:
        print_diagnosis(answer, console)
    for page in (text.get(), report_html(answer)):
        assert "RMS error of a free run over the whole record" in page
        assert before in page and after in page


def test_where_a_run_leaves_the_stroke_it_says_so(tmp_path: Path) -> None:
    baseline, data = fitted_baseline(write_bench(tmp_path, 2, {}))
    away = with_values(baseline, valve_centre=4.2)
    runs = [r for r in free_runs(baseline, away, data) if r.signal == "extension"]
    for run in runs:
        assert run.baseline_note == ""
        assert run.extended_note.startswith("leaves the stroke at ")
        assert math.isfinite(run.extended_rms) and run.extended_rms > 0.02
        assert f"({run.extended_note})" in free_run_in_words(run)[1]


def test_where_a_run_diverges_there_is_no_number() -> None:
    gone = FreeRun("r", "extension", "m", math.nan, 2e-3, "diverges at 1.02 s", "")
    near = FreeRun("s", "extension", "m", 5e-3, 2e-3, "", "leaves the stroke at 3.00 s")
    assert free_run_in_words(gone)[0] == "diverges at 1.02 s"
    assert free_run_in_words(gone)[1].startswith("2")
    assert worst_free_runs([near, gone]) == [gone]
    assert free_run_in_words(near)[1].endswith(" mm (leaves the stroke at 3.00 s)")
    both = replace(gone, extended_rms=math.nan, extended_note="diverges at 1.10 s")
    assert free_run_in_words(both) == ("diverges at 1.02 s", "diverges at 1.10 s")
