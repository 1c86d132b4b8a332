"""What a diagnosis says of a plant of one's own beside its verdict: a model that runs, free runs, what is not known."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms import _core
from sms.diagnosis import own
from sms.diagnosis.own.curve_term import with_curve
from sms.diagnosis.own.integrate import Batch, trajectory
from sms.diagnosis.own.wording import where_it_acts
from sms.diagnosis.remainder import Hidden, Shape
from sms.diagnosis.wording_simulated import sentence
from sms.errors import InputError
from test_own_model import LAG, Array, records_of_lag

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
ROLES: tuple[own.Role, ...] = ("identify", "identify", "validate", "validate")


def run(
    model: own.Model, values: Mapping[str, float], u: Array, step: float, start: Sequence[float]
) -> dict[str, Array]:
    """Outputs and states of one simulation; u (samples,)."""
    batch = Batch(np.array([step]), u[:, None, None], np.array(start)[:, None])
    fine = replace(model, longest_step=0.1 * step)
    out, states = trajectory(fine, fine.with_values(values).values(), batch)
    found = {s.name: states[:, i, 0] for i, s in enumerate(model.states)}
    return found | {o.name: out[:, j, 0] for j, o in enumerate(model.outputs)}


def steps(rng: np.random.Generator, samples: int, hold: int, low: float, high: float) -> Array:
    """(samples,): another level every `hold` samples."""
    return np.repeat(rng.uniform(low, high, samples // hold + 1), hold)[:samples]


# ---- the extended model -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def with_offset() -> own.Answer:
    return own.diagnose_model(LAG, records_of_lag(offset=0.1), window=2.0)


def test_the_extended_model_runs_and_is_accepted_again(
    with_offset: own.Answer, tmp_path: Path
) -> None:
    assert with_offset.verdict == "cause"
    extended = with_offset.extended
    assert extended is not None
    found = with_offset.causes[0].parameters[0]
    assert extended.parameter("offset").value == found.value
    beside = {p.name: p for p in with_offset.refitted}
    assert set(beside) == {"gain", "time_constant"}
    assert beside["gain"].old_value == 1.0
    assert 0.0 < beside["gain"].standard_error < 0.02
    assert extended.parameter("gain").value == beside["gain"].value
    assert extended.parameter("gain").uncertainty == LAG.parameter("gain").uncertainty
    records = records_of_lag(offset=0.1)
    assert own.diagnose_model(extended, records, window=2.0).verdict == "no-evidence"
    _, data = own.write_diagnosis(with_offset, tmp_path)
    told = json.loads(data.read_text())
    assert {p["name"] for p in told["refitted"]} == set(beside)
    assert "extended" not in told
    read = own.read_parameters(tmp_path / "extended.toml", LAG)
    assert list(read.parameters) == list(extended.parameters)
    page = (tmp_path / "report.html").read_text()
    assert "Parameters fitted beside the causes" in page
    assert "free run" in page.lower()


def test_a_free_run_over_a_whole_record_is_simulate(with_offset: own.Answer) -> None:
    """Both models, both unseen records; and the exact answer of the plant is as near as the noise."""
    records = {r.name: r for r in records_of_lag(offset=0.1)}
    assert with_offset.extended is not None and with_offset.model is not None
    assert [(f.record, f.signal) for f in with_offset.free_run] == [("run 2", "y"), ("run 3", "y")]
    baseline = with_offset.model.with_values({p.name: p.value for p in with_offset.baseline})
    for found in with_offset.free_run:
        before = own.simulate(baseline, records[found.record])
        after = own.simulate(with_offset.extended, records[found.record])
        assert before.error["y"] == pytest.approx(found.baseline_rms, rel=1e-3)
        assert after.error["y"] == pytest.approx(found.extended_rms, rel=1e-3)
        assert found.extended_rms < 0.012
        assert found.baseline_rms > 0.05


def test_a_run_from_a_given_state_needs_no_measured_outputs() -> None:
    record = records_of_lag()[0]
    blind = replace(record, signals={n: v for n, v in record.signals.items() if n != "y"})
    found = own.simulate(LAG, blind, start={"x": float(record.signals["u"][0])})
    assert np.abs(found.outputs["y"] - record.signals["y"]).max() < 0.06
    assert found.states["x"].shape == found.time.shape
    assert found.error == {}
    with pytest.raises(InputError, match="there is no signal 'y'"):
        own.simulate(LAG, blind)
    with pytest.raises(InputError, match="no state 'z'"):
        own.simulate(LAG, blind, start={"z": 0.0})


def test_values_from_a_file_that_is_none_are_one_sentence(tmp_path: Path) -> None:
    file = tmp_path / "extended.toml"
    for text, said in (
        ("[parameters\n", "cannot be read as TOML"),
        ("[other]\n", r"no table \[parameters\]"),
        ("[parameters]\ngain = 2\n", "gain: this has no value"),
        ("[parameters]\ngian = { value = 2.0 }\n", "did you mean 'gain'"),
    ):
        file.write_text(text)
        with pytest.raises(InputError, match=said):
            own.read_parameters(file, LAG)


# ---- an unknown over a state that is not measured --------------------------------------------------------


def chain(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """Two lags in a row; only the second one's state is measured. What spills above a rim is no effect of the model."""
    spilled = p.spill * np.maximum(x[0] - 9.8, 0.0)
    return [(u[0] - x[0]) / p.first - spilled, (x[0] - x[1]) / p.second]


CHAIN = own.Model(
    title="chain",
    states=[
        own.State("upper_level", "V", scale=0.1, equation="upper balance"),
        own.State("level", "V", scale=0.1, equation="lower balance"),
    ],
    inputs=[own.Input("u", "V", held=True)],
    outputs=[own.Output("level", "V", noise=0.02)],
    parameters=[
        own.Parameter("first", "s", 0.2, 1.0, 5.0, uncertainty=0.01),
        own.Parameter("second", "s", 0.2, 2.0, 5.0, uncertainty=0.02),
        own.Parameter("spill", "1/s", 0.0, 0.0, 9.0),
        own.Parameter("offset", "V", -1.0, 0.0, 1.0),
    ],
    derivative=chain,
    output=lambda p, x, u: [x[1] + p.offset],
    effects=[own.Effect("offset", "offset", "a zero that is off", "The amplifier drifts.")],
)


def records_of_chain(spill: float) -> list[own.Record]:
    rng, out = np.random.default_rng(11), []
    for number, role in enumerate(ROLES):
        u = steps(rng, 800, 40, 3.0, 16.0)
        level = run(CHAIN, {"spill": spill}, u, 0.1, (u[0], u[0]))["level"]
        signals = {
            "time": 0.1 * np.arange(float(u.size)),
            "u": u,
            "level": level + rng.normal(0.0, 0.02, u.size),
        }
        out.append(own.Record(f"run {number}", role, signals))
    return out


def test_a_missing_term_follows_a_state_that_is_not_measured() -> None:
    answer = own.diagnose_model(CHAIN, records_of_chain(2.0), window=4.0, empirical=True)
    assert answer.verdict == "unknown"
    assert answer.hidden is not None and answer.empirical is not None
    assert answer.hidden.equation == "upper balance"
    assert answer.hidden.shape.signal == "upper_level [V]"
    said = [line for line in answer.conclusion if "acts where upper level is above" in line]
    assert len(said) == 1, answer.conclusion
    rim = float(said[0].split("above ")[1].split(" V")[0])
    assert 8.0 < rim < 11.0
    assert {(g.record, g.role) for g in answer.gain} == {
        ("run 2", "validate"),
        ("run 3", "validate"),
    }
    assert all(g.reduction > 0.5 for g in answer.empirical.gain)
    extended = answer.extended
    assert extended is not None
    record = records_of_chain(2.0)[3]
    before, after = own.simulate(CHAIN, record), own.simulate(extended, record)
    assert after.error["level"] < 0.5 * before.error["level"]
    assert len(answer.free_run) == 2
    assert answer.free_run[1].baseline_rms == pytest.approx(before.error["level"], rel=0.2)


def test_a_curve_is_carried_where_it_can_be() -> None:
    shape = Shape("balance", "y [V]", (0.0, 1.0), (0.0, 2.0), (0.1, 0.1), "V/s", 0.9, confirmed=0.5)
    x, u = np.array([[0.5, 3.0]]), np.array([[0.0, 0.0]])
    carried = with_curve(LAG, shape)
    assert carried is not None
    plain = np.asarray(LAG.derivative(LAG.values(), x, u))
    there = np.asarray(carried.derivative(LAG.values(), x, u))
    assert np.allclose(there - plain, [[0.5, 1.0]])
    reading = with_curve(LAG, replace(shape, equation="reading of y", signal="u [V]"))
    assert reading is not None
    assert np.allclose(np.asarray(reading.output(LAG.values(), x, u + 1.0)), x + 1.0)
    assert with_curve(LAG, replace(shape, equation="reading of y")) is None
    assert with_curve(LAG, replace(shape, signal="time [s]")) is None


# ---- what the records cannot tell ------------------------------------------------------------------------


def balloon(resistance: own.Parameter, compliance: own.Parameter) -> own.Model:
    """Only the pressure in the balloon is measured, so that resistance and compliance appear in their product alone."""
    return own.Model(
        title="balloon",
        states=[own.State("inside", "kPa", scale=0.1, equation="flow")],
        inputs=[own.Input("pressure", "kPa", held=True)],
        outputs=[own.Output("inside", "kPa", noise=0.005)],
        parameters=[
            resistance,
            compliance,
            own.Parameter("zero", "kPa", -0.5, 0.0, 0.5),
        ],
        derivative=lambda p, x, u: [(u[0] - x[0]) / (p.resistance * p.compliance)],
        output=lambda p, x, u: [x[0] + p.zero],
        effects=[own.Effect("zero", "zero", "a zero that is off", "It drifts.")],
    )


def records_of_balloon(model: own.Model, values: Mapping[str, float]) -> list[own.Record]:
    rng, out = np.random.default_rng(5), []
    for number, role in enumerate(ROLES):
        pressure = steps(rng, 500, 50, 0.2, 2.0)
        inside = run(model, values, pressure, 0.02, (0.5,))["inside"]
        signals = {
            "time": 0.02 * np.arange(500.0),
            "pressure": pressure,
            "inside": inside + rng.normal(0.0, 0.005, 500),
        }
        out.append(own.Record(f"run {number}", role, signals))
    return out


RESISTANCE = own.Parameter("resistance", "kPa s/l", 0.05, 2.0, 20.0, fit=True)
COMPLIANCE = own.Parameter("compliance", "l/kPa", 0.01, 0.2, 2.0, fit=True)
TRUE = {"resistance": 1.0, "compliance": 0.3}


def test_of_two_that_appear_in_their_product_only_that_is_known() -> None:
    model = balloon(RESISTANCE, COMPLIANCE)
    answer = own.diagnose_model(model, records_of_balloon(model, TRUE), window=1.0)
    assert answer.verdict == "no-evidence"
    (open_,) = answer.undetermined
    assert set(open_.parameters) == {"resistance", "compliance"}
    assert open_.known == "the product resistance x compliance"
    assert any("Only the product resistance x compliance is known" in c for c in answer.conclusion)
    assert answer.baseline == ()
    assert json.loads(json.dumps(answer.to_dict()))["undetermined"][0]["known"] == open_.known


def test_with_one_of_them_declared_the_other_is_an_estimate() -> None:
    model = balloon(replace(RESISTANCE, value=1.0, uncertainty=0.01, fit=False), COMPLIANCE)
    answer = own.diagnose_model(model, records_of_balloon(model, TRUE), window=1.0)
    assert answer.undetermined == ()
    found = {p.name: p for p in answer.baseline}["compliance"]
    assert found.value == pytest.approx(0.3, abs=4.0 * found.standard_error)
    assert 0.0 < found.standard_error < 0.02


def test_a_fit_that_ends_at_a_bound_and_one_without_a_trace_are_said() -> None:
    narrow = replace(COMPLIANCE, value=0.1, upper=0.2)
    model = balloon(replace(RESISTANCE, value=1.0, uncertainty=0.01, fit=False), narrow)
    answer = own.diagnose_model(
        model, records_of_balloon(balloon(RESISTANCE, COMPLIANCE), TRUE), 1.0
    )
    said = [f.message for f in answer.findings if f.severity == "warning"]
    assert any("compliance ends at its upper bound" in text for text in said), answer.findings
    idle = replace(
        balloon(replace(RESISTANCE, value=1.0, uncertainty=0.01, fit=False), COMPLIANCE),
        parameters=[
            replace(RESISTANCE, value=1.0, uncertainty=0.01, fit=False),
            COMPLIANCE,
            own.Parameter("zero", "kPa", -0.5, 0.0, 0.5),
            own.Parameter("idle", "1", 0.0, 0.4, 1.0, fit=True),
        ],
    )
    answer = own.diagnose_model(
        idle, records_of_balloon(balloon(RESISTANCE, COMPLIANCE), TRUE), 1.0
    )
    assert [u.parameters for u in answer.undetermined] == [("idle",)]
    assert "leaves no trace" in answer.undetermined[0].sentence


def test_a_curve_of_another_equation_is_said_as_such() -> None:
    """It was "balance of the lower tank ... (reading of level)" in one breath."""
    curve = Shape("reading of level", "u [V]", (0.0, 1.0), (0.0, 1.0), (0.1, 0.1), "m", 0.6)
    shares = {"balance of the lower tank": (0.7, 0.6, 0.8), "reading of level": (0.6, 0.5, 0.7)}
    hidden = Hidden(shares, {}, curve)
    said = sentence("unknown", (), hidden)
    assert "It arises in the balance of the lower tank; of all functions of one signal" in said
    assert "one in the reading of level over u explains most, 60 %" in said
    assert "(reading of level)" not in said


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ((0.0, 0.01, 0.0, 0.5, 1.0), "above 2 V"),
        ((-1.0, -0.5, 0.01, 0.0, 0.0), "below 2 V"),
        ((1.0, 1.0, 1.0, 1.0, 1.0), ""),
        ((0.0, 1.0, 0.0, 1.0, 0.0), ""),
    ],
)
def test_where_a_missing_term_acts(value: tuple[float, ...], said: str) -> None:
    at = (0.0, 1.0, 2.0, 3.0, 4.0)
    found = where_it_acts(Shape("flow", "upper_level [V]", at, value, 5 * (0.1,), "V/s", 0.9))
    assert bool(found) == bool(said)
    if said:
        assert f"acts where upper level is {said}" in found[0].replace("2.00 V", "2 V")
