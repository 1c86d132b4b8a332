"""A plant of one's own: the simulation and its derivatives, the example's verdicts, and what is refused."""

from __future__ import annotations

import json
import runpy
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import _core
from sms.diagnosis import own
from sms.diagnosis.own.integrate import Batch, simulate
from sms.diagnosis.own.shooting import ShootingProblem, Stretch
from sms.io import InputError

from validation.random_cases import draw

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
Array = NDArray[np.float64]
EXAMPLE = Path(__file__).parents[1] / "examples" / "two_tanks.py"
tanks: Any = SimpleNamespace(**runpy.run_path(str(EXAMPLE)))


def lag(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """x' = (gain u - x) / time_constant"""
    return [(p.gain * u[0] - x[0]) / p.time_constant]


LAG = own.Model(
    title="lag",
    states=[own.State("x", "V", scale=1.0, equation="balance")],
    inputs=[own.Input("u", "V")],
    outputs=[own.Output("y", "V", noise=0.01)],
    parameters=[
        own.Parameter("gain", "1", 0.1, 1.0, 10.0, uncertainty=0.02),
        own.Parameter("time_constant", "s", 0.05, 0.5, 5.0, uncertainty=0.02),
        own.Parameter("offset", "V", -1.0, 0.0, 1.0),
    ],
    derivative=lag,
    output=lambda p, x, u: [x[0] + p.offset],
    effects=[own.Effect("offset", "offset", "a zero that is off", "The amplifier drifts.")],
)


def records_of_lag(
    offset: float = 0.0, conditions: Mapping[str, float] | None = None
) -> list[own.Record]:
    """By the exact answer of a lag to a ramp from sample to sample."""
    rng = np.random.default_rng(3)
    out = []
    for number, role in enumerate(("identify", "identify", "validate", "validate")):
        time = 0.05 * np.arange(400)
        u = np.cumsum(rng.normal(0.0, 0.2, time.size))
        gain = (conditions or {}).get("gain", 1.0) if number == 1 else 1.0
        x = np.empty(time.size)
        x[0], decay = u[0], np.exp(-0.05 / 0.5)
        for k in range(time.size - 1):
            slope = gain * (u[k + 1] - u[k]) / 0.05
            x[k + 1] = gain * u[k + 1] - 0.5 * slope + (x[k] - gain * u[k] + 0.5 * slope) * decay
        signals = {"time": time, "u": u, "y": x + offset + rng.normal(0.0, 0.01, time.size)}
        own_conditions = conditions if number == 1 and conditions else {}
        out.append(own.Record(f"run {number}", role, signals, own_conditions))  # type: ignore[arg-type]
    return out


# ---- simulation ----------------------------------------------------------------------------------


def test_the_integrator_is_of_fourth_order_and_takes_inner_steps() -> None:
    """Against the exact decay, for several plants at once."""
    start, step = np.array([[1.0, 2.0, -3.0]]), np.array([0.5, 0.25, 0.125])
    batch = Batch(step, np.zeros((9, 1, 3)), start)
    values = LAG.values()
    exact = start[0] * np.exp(-step * np.arange(9)[:, None] / 0.5)
    errors = []
    for longest in (0.0625, 0.03125):
        found = simulate(replace(LAG, longest_step=longest), values, batch)[:, 0]
        errors.append(np.abs(found - exact).max())
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.3)


def test_the_step_of_the_integration_is_as_short_as_the_noise_asks_for() -> None:
    """A tank that runs empty: a step of a second moves estimates by several standard errors there."""
    records = tanks.measured("leak", 1)
    stretches = [
        Stretch(
            tanks.STEP,
            r.signals["pump_voltage"][:, None],
            np.stack([r.signals["level_upper"], r.signals["level_lower"]], axis=1),
            np.stack([r.signals["level_upper"], r.signals["level_lower"]], axis=1),
            {},
        )
        for r in records[:2]
    ]
    noise, values = np.array([4e-4, 4e-4]), tanks.MODEL.values()

    def predicted(model: own.Model) -> Array:
        return ShootingProblem(model, stretches, noise, 60.0).errors(values)

    found = ShootingProblem(tanks.MODEL, stretches, noise, 60.0).with_fine_step()
    step = found.longest_step
    assert step is not None
    assert step < tanks.STEP
    exact = predicted(replace(tanks.MODEL, longest_step=0.02))
    coarse = predicted(replace(tanks.MODEL, longest_step=tanks.STEP))
    assert np.linalg.norm(predicted(found) - exact) < 1.5
    assert np.linalg.norm(coarse - exact) > 3.0
    easy = problem_of(records_of_lag())
    assert easy.with_fine_step().longest_step == 0.05


def problem_of(records: Sequence[own.Record], model: own.Model = LAG) -> ShootingProblem:
    stretches = [
        Stretch(0.05, r.signals["u"][:, None], r.signals["y"][:, None], r.signals["y"][:, None], {})
        for r in records
    ]
    return ShootingProblem(model, stretches, np.array([0.01]), window=2.0)


def test_residuals_are_noise_and_rows_lie_window_by_window() -> None:
    problem = problem_of(records_of_lag())
    residual, _ = problem.evaluate(LAG.values())
    assert len(problem.windows) == 40
    assert problem.rows == residual.size == 1600
    assert [w.row for w in problem.windows] == [40 * k for k in range(40)]
    assert np.mean(residual**2) == pytest.approx(1.0 - 1.0 / 40.0, abs=0.1)


def test_derivatives_are_those_of_residuals_with_initial_states_free() -> None:
    """A linear plant: the residual's change is the projected derivative, for a change of any size in the offset."""
    problem = problem_of(records_of_lag())
    values = LAG.values()
    names = ["gain", "time_constant", "offset"]
    _, jacobian = problem.evaluate(values, names)
    q = [problem.evaluate(values, names)[1][w.row : w.row + w.rows] for w in problem.windows]
    assert np.allclose(np.vstack(q), jacobian, atol=1e-6 * np.abs(jacobian).max())
    for name, change in (("gain", 0.02), ("offset", 0.5)):
        other = values.copy()
        other[name] += change
        moved = problem.evaluate(other)[0] - problem.evaluate(values)[0]
        column = jacobian[:, names.index(name)] * change
        assert np.linalg.norm(moved - column) < 0.02 * np.linalg.norm(column) + 3.0


def test_a_hidden_input_that_never_changes_is_the_offset_of_the_balance() -> None:
    """Its knots together are a constant added to the derivative, as `gain u` would be with u = time_constant."""
    problem = problem_of(records_of_lag())
    hidden = problem.hidden(LAG.values(), 5)
    assert hidden.shape == (problem.rows, 5)
    constant = hidden.sum(axis=1)
    w = problem.windows[0]
    t = 0.05 * np.arange(w.samples)
    step = 0.5 * (1.0 - np.exp(-t / 0.5)) / 0.01
    start = np.exp(-t / 0.5)
    wanted = step - start * (start @ step) / (start @ start)
    assert np.allclose(constant[: w.rows], wanted, atol=1e-3 * np.abs(wanted).max())


# ---- verdicts --------------------------------------------------------------------------------------


def test_a_plant_without_a_fault_is_left_alone_and_one_with_an_offset_is_not() -> None:
    healthy = own.diagnose_model(LAG, records_of_lag(), window=2.0)
    assert healthy.verdict == "no-evidence"
    ill = own.diagnose_model(LAG, records_of_lag(offset=0.1), window=2.0)
    assert ill.verdict == "cause"
    found = ill.causes[0].parameters[0]
    assert abs(found.value - 0.1) < 3.0 * found.standard_error + 0.01


def test_a_condition_of_one_record_is_no_fault() -> None:
    """The second run had another gain, and the record says so."""
    told = own.diagnose_model(LAG, records_of_lag(conditions={"gain": 2.0}), window=2.0)
    assert told.verdict == "no-evidence"
    untold = [replace(r, conditions={}) for r in records_of_lag(conditions={"gain": 2.0})]
    assert own.diagnose_model(LAG, untold, window=2.0).verdict == "unknown"


@pytest.mark.parametrize(
    "case", [c if c == "leak" else pytest.param(c, marks=pytest.mark.full) for c in tanks.CASES]
)
def test_the_example_says_what_is_wrong_with_its_tanks(case: str, tmp_path: Path) -> None:
    answer = tanks.diagnose(case, 1, empirical=True)
    named = [set(c.members) for c in answer.causes]
    if case == "healthy":
        assert answer.verdict == "no-evidence"
    elif case == "leak":
        assert named == [{"leak_upper"}]
        assert answer.causes[0].effect == "leak_upper"
        found = answer.causes[0].parameters[0]
        assert found.value == pytest.approx(tanks.LEAK, abs=3.0 * found.standard_error)
        assert {g.role for g in answer.gain} == {"validate", "test"}
        assert all(g.reduction > 0.5 for g in answer.gain)
    elif case == "worn_outlet":
        assert named == [{"outlet_lower", "leak_lower"}]
    else:
        assert answer.verdict == "unknown"
        assert answer.hidden is not None
        assert answer.hidden.equation == tanks.UPPER
        assert answer.hidden.shape.signal == "level_upper [m]"
        assert answer.empirical is not None
        assert all(g.reduction > 0.0 for g in answer.empirical.gain)
    page, data = own.write_diagnosis(answer, tmp_path)
    assert json.loads(data.read_text())["verdict"] == answer.verdict
    text = page.read_text()
    assert f'data-verdict="{answer.verdict}"' in text
    assert ('id="empirical"' in text) == (case == "overflow")


@pytest.mark.full
def test_the_curve_of_an_unknown_is_carried_to_a_record_at_rest() -> None:
    """The pump runs evenly and both levels stand still below the rim: no curve over a level is to be seen there."""
    *moving, last = tanks.measured("overflow", 1)
    rng, time = np.random.default_rng(7), last.signals["time"]
    upper = (3.32e-6 * 5.0 / 17.9e-6) ** 2 / (2.0 * 9.81)
    still = {"time": time, "pump_voltage": np.full(time.size, 5.0)}
    for name, level in (("level_upper", upper), ("level_lower", upper * (17.9 / 17.7) ** 2)):
        still[name] = level + rng.normal(0.0, 0.4e-3, time.size)
    records = [*moving, replace(last, signals=still)]
    answer = own.diagnose_model(tanks.MODEL, records, 60.0, 1, empirical=True)
    assert answer.verdict == "unknown"
    assert answer.empirical is not None
    of_rest = [g for g in answer.empirical.gain if g.record == last.name]
    assert {g.signal for g in of_rest} == {"level_upper", "level_lower"}
    assert all(g.extended_rms < 2.0 * 0.4e-3 for g in of_rest)
    assert answer.sentence.count("balance of the upper tank") == 1


def balloon(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """V' = (p - V/C) / R of a balloon behind a resistor."""
    return [(u[0] - x[0] / p.compliance) / p.resistance]


def test_two_causes_are_named_of_which_neither_stands_alone() -> None:
    """Declared with ten times the resistance and less than half the compliance: a breath grows far too slowly for the
    one and ends far too small for the other, so that each alone is fitted to make up for both."""
    rng = draw("two causes")
    true = {"compliance": 0.5, "resistance": 0.5}
    model = own.Model(
        title="balloon",
        states=[own.State("volume", "l", scale=1.0, equation="flow")],
        inputs=[own.Input("pressure", "kPa")],
        outputs=[own.Output("volume", "l", noise=0.005)],
        parameters=[
            own.Parameter("compliance", "l/kPa", 0.02, 0.2, 2.0, uncertainty=0.01),
            own.Parameter("resistance", "kPa s/l", 0.1, 5.0, 10.0, uncertainty=0.1),
            own.Parameter("gain", "1", -0.3, 0.0, 0.3),
            own.Parameter("leak", "l/(s kPa)", 0.0, 0.0, 0.5),
        ],
        derivative=lambda p, x, u: [balloon(p, x, u)[0] - p.leak * x[0] / p.compliance],
        output=lambda p, x, u: [(1.0 + p.gain) * x[0]],
        effects=[
            own.Effect("compliance", "compliance", "another compliance", "Another balloon."),
            own.Effect("resistor", "resistance", "another resistor", "Another resistor."),
            own.Effect("gain", "gain", "a wrong gain", "The sensor has another gain."),
            own.Effect("leak", "leak", "a leak", "The balloon leaks."),
        ],
    )
    truth = model.values()
    for name, value in true.items():
        truth[name] = value
    records = []
    for number, role in enumerate(("identify", "validate")):
        time = 0.02 * np.arange(1500)
        breaths = np.sin(2.0 * np.pi * time / rng.uniform(2.5, 4.0)) > 0.0
        pressure = np.where(breaths, rng.uniform(0.8, 1.2), 0.2)
        batch = Batch(np.array([0.02]), pressure[:, None, None], np.array([[0.1]]))
        volume = simulate(model, truth, batch)[:, 0, 0] + rng.normal(0.0, 0.005, time.size)
        signals = {"time": time, "pressure": pressure, "volume": volume}
        records.append(own.Record(f"run {number}", role, signals))  # type: ignore[arg-type]
    answer = own.diagnose_model(model, records, window=3.0)
    assert answer.verdict == "combination", answer.sentence
    assert sorted(c.members[0] for c in answer.causes) == ["compliance", "resistor"]
    found = {p.name: p for c in answer.causes for p in c.parameters}
    for name, value in true.items():
        assert found[name].value == pytest.approx(value, abs=4.0 * found[name].standard_error)
    assert all(c.share_high <= 1.0 for c in answer.causes)


# ---- in C++ ------------------------------------------------------------------------------------------


@pytest.mark.skipif(shutil.which("c++") is None, reason="no C++ compiler here")
def test_a_derivative_in_cpp_is_the_same_derivative(tmp_path: Path) -> None:
    library = tmp_path / "two_tanks.so"
    source = EXAMPLE.with_suffix(".cpp")
    subprocess.run(
        ["c++", "-O2", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", source, "-o", library],
        check=True,
    )  # fmt: skip
    parameters = [
        "pump_gain",
        "pump_dead_band",
        "outlet_upper",
        "outlet_lower",
        "leak_upper",
        "leak_lower",
    ]
    derivative = own.from_library(library, "derivative", parameters, rows=2)
    rng = np.random.default_rng(8)
    x, u = rng.uniform(0.0, 0.3, (2, 50)), rng.uniform(-1.0, 9.0, (1, 50))
    values = tanks.MODEL.values()
    values["leak_upper"] = rng.uniform(0.0, 1e-6, 50)
    values["pump_dead_band"] = 1.5
    assert np.allclose(derivative(values, x, u), tanks.MODEL.derivative(values, x, u), rtol=1e-12)

    record = records_of_lag()[0].signals["y"]
    levels = np.abs(np.stack([record, record], axis=1)) * 0.02
    stretch = Stretch(1.0, np.abs(record)[:, None], levels, levels, {})
    noise, names = np.array([1e-3, 1e-3]), ["leak_upper", "outlet_lower", "pump_gain"]
    (one, by_one), (other, by_other) = (
        ShootingProblem(replace(tanks.MODEL, derivative=d), [stretch], noise, 40.0).evaluate(
            tanks.MODEL.values(), names
        )
        for d in (derivative, tanks.MODEL.derivative)
    )
    assert np.allclose(one, other, atol=1e-6)
    assert np.allclose(by_one, by_other, rtol=1e-6, atol=1e-6 * np.abs(by_other).max())
    with pytest.raises(InputError, match="there is no function 'output'"):
        own.from_library(library, "output", parameters, rows=2)
    with pytest.raises(InputError, match="no library that can be loaded"):
        own.from_library(source, "derivative", parameters, rows=2)


# ---- what is refused ---------------------------------------------------------------------------------


def test_a_sensor_that_stands_still_is_a_data_fault() -> None:
    records = records_of_lag()
    signals = dict(records[0].signals) | {"y": np.full(400, 0.7)}
    answer = own.diagnose_model(LAG, [replace(records[0], signals=signals), *records[1:]], 2.0)
    assert answer.verdict == "data-fault"
    assert "run 0" in answer.sentence
    assert "never changes from 0.7 V" in answer.sentence


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"states": []}, "a model needs states"),
        ({"effects": [*LAG.effects, *LAG.effects]}, "'offset' is there twice"),
        ({"effects": [replace(LAG.effects[0], parameter="ofset")]}, "did you mean 'offset'"),
        ({"derivative": lambda p, x, u: [x[0], x[0]]}, "derivative returns 2 arrays; needed are 1"),
        ({"output": lambda p, x, u: [np.zeros((2, 2))]}, "element by element"),
        ({"parameters": [replace(LAG.parameters[0], value=20.0), *LAG.parameters[1:]]}, "check its bounds"),
        ({"states": [replace(LAG.states[0], scale=0.0)]}, "scale must be positive"),
    ],
)  # fmt: skip
def test_a_model_that_cannot_be_is_one_sentence(change: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said.replace("(", r"\(")):
        replace(LAG, **change)


def test_records_that_do_not_fit_are_one_sentence() -> None:
    records = records_of_lag()
    first = records[0]

    def refused(record: own.Record, said: str) -> None:
        with pytest.raises(InputError, match=said):
            own.diagnose_model(LAG, [record, *records[1:]], window=2.0)

    lost = {name: values for name, values in first.signals.items() if name != "u"}
    refused(replace(first, signals=lost), "there is no signal 'u'")
    uneven = dict(first.signals) | {"time": first.signals["time"] ** 1.1}
    refused(replace(first, signals=uneven), "time is not even")
    gap = dict(first.signals) | {"y": np.where(np.arange(400) == 7, np.nan, first.signals["y"])}
    refused(replace(first, signals=gap), "sample 7 is not finite")
    refused(replace(first, name="run 1"), "two records are named 'run 1'")
    refused(replace(first, conditions={"gian": 2.0}), "did you mean 'gain'")
    with pytest.raises(InputError, match="no record has the role validate"):
        own.diagnose_model(LAG, records[:2], window=2.0)
    with pytest.raises(InputError, match="take a shorter window"):
        own.diagnose_model(LAG, records, window=20.0)
    with pytest.raises(InputError, match="must be positive"):
        own.diagnose_model(LAG, records, window=0.0)


def test_a_record_comes_from_a_table_in_its_own_units(tmp_path: Path) -> None:
    file = tmp_path / "day one.csv"
    rows = "".join(f"{10 * k},{1000 * k},{k}\n" for k in range(12))
    file.write_text("time [ms],u [mV],y [V]\n" + rows)
    record = own.read_record(file, LAG, "identify")
    assert record.name == "day one"
    assert np.allclose(record.signals["time"], 0.01 * np.arange(12))
    assert np.allclose(record.signals["u"], np.arange(12))
    file.write_text("time [ms],u [mV],y [V]\n" + rows.replace("5000", "none"))
    with pytest.raises(InputError, match="line 7, u: 'none' is no number"):
        own.read_record(file, LAG, "identify")
    file.write_text("time [ms],u [K],y [V]\n" + rows)
    with pytest.raises(InputError, match="does not fit"):
        own.read_record(file, LAG, "identify")


def test_a_parameter_that_is_not_there_is_named() -> None:
    with pytest.raises(AttributeError, match="the model has no parameter 'gian'"):
        _ = LAG.values().gian
