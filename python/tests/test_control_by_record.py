"""Records in open and in closed loop in one rig file: each is simulated as in a rig file of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from plant_support import write_bench, write_platform
from sms import _core
from sms.diagnosis import diagnose
from sms.diagnosis.preparation import make_data
from sms.diagnosis.wording import of_command
from sms.estimation.windows import Runs
from sms.io import InputError, load_rig
from sms.io.records import load_record
from sms.rigs.mixed_loops import Mixed

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
KNOTS = 5
TAKEN = 'control = { controller = "recorded" }\n'


def with_control(path: Path, said: dict[str, str]) -> Path:
    """Another rig file beside it, with a line for some of its records."""
    text = path.read_text()
    for record, line in said.items():
        old = f'file = "{record}.csv"\n'
        assert old in text
        text = text.replace(old, old + line)
    mixed = path.with_name("mixed.toml")
    mixed.write_text(text)
    return mixed


def runs_of(path: Path) -> list[Runs]:
    rig = load_rig(path)
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    return [data.identify, data.validate]


def hold_against_separate_files(path: Path, taken: list[str], free: list[str]) -> None:
    """Residuals and derivatives of each record: in a mixed file, and in one where all are simulated or none."""
    mixed = runs_of(with_control(path, dict.fromkeys(taken, TAKEN)))
    simulated = runs_of(path)
    plain = path.with_name("plain.toml")
    text = path.read_text().replace('controller = "simulated"', 'controller = "recorded"')
    plain.write_text(text)
    recorded = runs_of(plain)
    for number, runs in enumerate(mixed):
        params = runs.rig.start()
        residual, slopes = runs.problem.evaluate(params, free)
        hidden = runs.problem.hidden(params, KNOTS)
        errors = runs.problem.errors(params)
        assert len(residual) == runs.problem.rows == len(runs.channel)
        for r, run in enumerate(runs.motions):
            alone = (recorded if run.name in taken else simulated)[number]
            own = (alone.record == r).nonzero()[0]
            there, there_slopes = alone.problem.evaluate(params, free)
            there_hidden = alone.problem.hidden(params, KNOTS)
            there_errors = alone.problem.errors(params)
            here = np.flatnonzero(runs.record == r)
            computed = ~np.isin(runs.channel[here], range(len(alone.channels)))
            assert computed.any() == (run.name in taken)
            assert not np.any(residual[here[computed]]) and not np.any(slopes[here[computed]])
            here = here[~computed]
            assert residual[here] == pytest.approx(there[own], rel=1e-9, abs=1e-9)
            assert errors[here] == pytest.approx(there_errors[own], rel=1e-9, abs=1e-9)
            assert np.array_equal(runs.sample[here], alone.sample[own])
            scale = np.abs(there_slopes[own]).max(axis=0) + 1e-300
            assert np.allclose(slopes[here] / scale, there_slopes[own] / scale, atol=1e-9)
            known = there_hidden.shape[1]
            assert np.allclose(hidden[here][:, :known], there_hidden[own], rtol=1e-9, atol=1e-9)
            assert not np.any(hidden[here][:, known:])


def test_a_bench_in_both_loops_is_as_in_two_rig_files(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 5, {"proportional_gain": 9.0}, in_loop=True)
    hold_against_separate_files(path, ["run1", "run2"], ["proportional_gain", "moving_mass"])


def test_a_platform_in_both_loops_is_as_in_two_rig_files(tmp_path: Path) -> None:
    path = write_platform(tmp_path, 5, {}, 1.6, in_loop=True)
    hold_against_separate_files(path, ["run1"], ["proportional_gain", "payload_mass"])


def test_one_window_of_a_mixed_file_is_that_window(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 5, {}, in_loop=True)
    identify, _ = runs_of(with_control(path, {"run1": TAKEN}))
    assert isinstance(identify.simulation, Mixed)
    windows = identify.problem.windows
    last = len(windows) - 1
    assert (windows[0].record, windows[last].record) == (0, 1)
    (alone,) = identify.excerpt([last]).problem.windows
    assert abs(alone.samples - windows[last].samples) <= 1


@pytest.mark.full
def test_a_gain_is_found_from_the_closed_loop_while_open_loops_stand_beside(tmp_path: Path) -> None:
    gain = 9.6
    path = write_bench(tmp_path, 3, {"proportional_gain": gain}, in_loop=True)
    path = with_control(path, {"run0": 'control = { loop = "open" }\n', "run3": TAKEN})
    for record in ("run0", "run3"):  # which need no set-point
        file = tmp_path / f"{record}.csv"
        pd.read_csv(file).drop(columns="setpoint [m]").to_csv(file, index=False)
    answer = diagnose(path)
    assert answer.verdict == "cause"
    (cause,) = answer.causes
    assert (cause.effect, cause.signal) == ("controller_mismatch", "proportional_gain")
    found = cause.parameters[0]
    assert found.value == pytest.approx(gain, abs=max(4.0 * found.standard_error, 0.01 * gain))
    compared = {(g.record, g.signal) for g in answer.gain}
    assert ("run2", "valve_command") in compared and ("run3", "valve_command") not in compared
    assert ("run3", "extension") in compared
    assert "In run0, run3 the valve's command is taken from the record" in answer.command


def test_what_a_record_says_of_its_loop(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 1, {}, in_loop=True)
    rig = load_rig(with_control(path, {"run0": 'control = { loop = "open" }\n'}))
    assert rig.control.controller == "simulated"
    loops = [(r.control.loop, r.control.controller) for r in rig.records]
    assert loops == [("open", "recorded"), *[("closed", "simulated")] * 3]
    none = load_rig(with_control(path, dict.fromkeys(("run0", "run1", "run2", "run3"), TAKEN)))
    assert none.control.controller == "recorded"
    assert "taken from the records" in of_command(none)
    path.write_text(path.read_text().replace('controller = "simulated"\n', ""))
    some = load_rig(with_control(path, {"run3": 'control = { controller = "simulated" }\n'}))
    assert some.control.controller == "simulated"
    assert [r.control.controller for r in some.records] == [*["recorded"] * 3, "simulated"]


@pytest.mark.parametrize(("line", "sentence"), [
    ('control = { controller = "recorde" }\n', r"control, controller: 'recorde'.*did you mean 'recorded'"),
    ('control = { controler = "recorded" }\n', r"control: the key 'controler'.*did you mean 'controller'"),
    ('control = { loop = "open", controller = "simulated" }\n', r"number 1, control: in an open loop"),
    ('control = "open"\n', r"number 1, control: must be a table"),
])  # fmt: skip
def test_a_mistake_is_said_with_its_record(tmp_path: Path, line: str, sentence: str) -> None:
    path = write_bench(tmp_path, 1, {}, in_loop=True)
    with pytest.raises(InputError, match=sentence):
        load_rig(with_control(path, {"run0": line}))


def test_signals_that_a_record_needs_are_asked_for(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 1, {}, in_loop=True, command=False)
    with pytest.raises(InputError, match="'valve_command' is needed but not listed"):
        load_rig(with_control(path, {"run0": TAKEN}))
    path = with_control(write_bench(tmp_path, 1, {}, in_loop=True), {"run0": TAKEN})
    file = tmp_path / "run1.csv"
    pd.read_csv(file).drop(columns="setpoint [m]").to_csv(file, index=False)
    rig = load_rig(path)
    with pytest.raises(InputError, match=r"run1.csv: there is no column for the signal 'setpoint'"):
        load_record(rig, rig.records[1])


def test_a_period_that_does_not_fit_the_records_step_is_said(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 1, {}, in_loop=True)
    text = path.read_text().replace("[parameters]\n", '[parameters]\ncontrol_period = "7.3 ms"\n')
    path.write_text(text)
    rig = load_rig(path)
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    with pytest.raises(InputError, match="one has to be a whole multiple of the other"):
        _ = data.identify.problem
