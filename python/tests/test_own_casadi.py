"""A plant of one's own written with CasADi: the same simulation, exact derivatives, stiff plants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sms import _core
from sms.diagnosis import own
from sms.diagnosis.own.as_rig import noise_of, problem_of, run_of
from sms.diagnosis.own.curve_term import with_curve
from sms.diagnosis.own.integrate import Batch, simulate, simulate_with_slopes
from sms.diagnosis.own.shooting import ShootingProblem
from sms.diagnosis.remainder import Shape
from sms.errors import InputError
from test_own_model import LAG, Array, records_of_lag, tanks

casadi = pytest.importorskip("casadi")
pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


def derivative(p: Any, x: Any, u: Any) -> Sequence[Any]:
    """The example's tanks, in CasADi's words."""
    upper, lower = (casadi.sqrt(2.0 * tanks.GRAVITY * casadi.fmax(level, 1e-6)) for level in x)
    pumped = p.pump_gain * casadi.fmax(u[0] - p.pump_dead_band, 0.0)
    passed = p.outlet_upper * upper
    return (
        (pumped - passed - p.leak_upper * upper) / tanks.CROSS_SECTION,
        (passed - p.outlet_lower * lower - p.leak_lower * lower) / tanks.CROSS_SECTION,
    )


def of_casadi(model: own.Model, function: Any, **other: Any) -> own.Model:
    parts = (
        "states",
        "inputs",
        "outputs",
        "parameters",
        "effects",
        "output",
        "title",
        "longest_step",
    )
    given = {name: getattr(model, name) for name in parts} | {"derivative": function} | other
    return own.Model.from_casadi(**given)


def problem_on(model: own.Model, records: Sequence[own.Record], window: float) -> ShootingProblem:
    runs = [run_of(model, r) for r in records]
    return problem_of(model, runs, noise_of(model, runs), window)


def test_the_simulation_is_the_same_and_its_derivatives_are_exact() -> None:
    """Against central differences of the same tanks in numpy, parameters and initial states."""
    plain = replace(tanks.MODEL, longest_step=0.25)
    exact = of_casadi(plain, derivative)
    records = tanks.measured("leak", 1)[:2]
    names = [p.name for p in plain.parameters if p.name != "pump_dead_band"]
    values = plain.with_values({"leak_upper": 1e-6, "pump_dead_band": 0.5}).values()
    one, other = (problem_on(m, records, 60.0) for m in (plain, exact))
    residual, jacobian = one.evaluate(values, names)
    same, slopes = other.evaluate(values, names)
    assert np.allclose(residual, same, atol=1e-4)
    for k, name in enumerate(names):
        off = np.linalg.norm(jacobian[:, k] - slopes[:, k])
        assert off < 1e-3 * np.linalg.norm(slopes[:, k]), name
    hidden, of_exact = one.hidden(values, 5), other.hidden(values, 5)
    assert np.linalg.norm(hidden - of_exact) < 1e-3 * np.linalg.norm(hidden)


def test_it_is_diagnosed_as_the_plant_in_numpy_is() -> None:
    def lag(p: Any, x: Any, u: Any) -> Sequence[Any]:
        return [(p.gain * u[0] - x[0]) / p.time_constant]

    model = of_casadi(LAG, lag)
    answers = [own.diagnose_model(m, records_of_lag(offset=0.1), window=2.0) for m in (LAG, model)]
    assert [a.verdict for a in answers] == ["cause", "cause"]
    one, other = (a.causes[0].parameters[0] for a in answers)
    assert other.value == pytest.approx(one.value, abs=0.05 * one.standard_error)
    extended = answers[1].extended
    assert extended is not None and extended.exact is not None
    assert own.simulate(extended, records_of_lag(offset=0.1)[3]).error["y"] < 0.012
    shape = Shape("balance", "y [V]", (0.0, 1.0), (0.0, 2.0), (0.1, 0.1), "V/s", 0.9)
    carried = with_curve(model, shape)
    assert carried is not None and carried.exact is None
    x, u = np.array([[0.5, 2.0]]), np.zeros((1, 2))
    more = np.asarray(carried.derivative(LAG.values(), x, u)) - model.derivative(LAG.values(), x, u)
    assert np.allclose(more, [[1.0, 2.0]])


def stiff(p: Any, x: Any, u: Any) -> Sequence[Any]:
    """The lag behind an actuator of a tenth of a millisecond."""
    return [(p.gain * x[1] - x[0]) / p.time_constant, (u[0] - x[1]) / 1e-4]


@pytest.mark.parametrize("integrator", ["cvodes", "idas", "collocation"])
def test_a_stiff_plant_runs_at_the_step_of_its_samples(integrator: str) -> None:
    states = [*LAG.states, own.State("valve", "V", scale=0.1)]
    model = of_casadi(
        replace(LAG, states=[*LAG.states]), stiff, states=states, integrator=integrator
    )
    record = records_of_lag()[0]
    u = record.signals["u"]
    batch = Batch(np.array([0.05]), u[:40, None, None], np.array([[u[0]], [u[0]]]))
    found = simulate(model, model.values(), batch)[:, 0, 0]
    exact = simulate(
        replace(LAG, longest_step=0.01), LAG.values(), replace(batch, start=batch.start[:1])
    )
    assert np.abs(found - exact[:, 0, 0]).max() < 2e-3
    slopes = simulate_with_slopes(model, model.values(), batch, by_parameters=True)
    assert np.allclose(slopes.out[:, 0, 0], found, atol=1e-6)
    for by, below, above in (
        (slopes.by_parameter[:, 0, 0, 0], {"gain": 0.999}, {"gain": 1.001}),
        (slopes.by_parameter[:, 0, 1, 0], {"time_constant": 0.499}, {"time_constant": 0.501}),
    ):
        low, high = (
            simulate(model, model.with_values(v).values(), batch)[:, 0, 0] for v in (below, above)
        )
        assert np.linalg.norm(by - (high - low) / 0.002) < 2e-3 * np.linalg.norm(by)
    decay = np.exp(-0.05 * np.arange(40) / 0.5)
    assert np.allclose(slopes.by_start[:, 0, 0, 0], decay, atol=1e-4)


def test_a_run_that_an_integrator_cannot_go_on_with_is_not_finite_and_the_others_are() -> None:
    """x' = x^2 from 1 ends at 1 s, from -1 never."""
    model = of_casadi(LAG, lambda p, x, u: [x[0] ** 2], integrator="cvodes")
    batch = Batch(np.full(2, 0.5), np.zeros((5, 1, 2)), np.array([[1.0, -1.0]]))
    found = simulate(model, model.values(), batch)[:, 0]
    assert not np.all(np.abs(found[:, 0]) < 1e6)
    assert found[:, 1] == pytest.approx(-1.0 / (1.0 + 0.5 * np.arange(5)), rel=1e-4)


def test_what_casadi_cannot_take_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputError, match="no integrator 'euler'; choose one of rk, cvodes"):
        of_casadi(LAG, stiff, integrator="euler")
    with pytest.raises(InputError, match="derivative returns 2 expressions; needed are 1"):
        of_casadi(LAG, lambda p, x, u: [x[0], x[0]])
    with pytest.raises(InputError, match="cannot be made of CasADi's expressions"):
        of_casadi(LAG, lambda p, x, u: [np.ones((2, 2)) @ [x[0], x[0]] + "no"])

    model = of_casadi(LAG, lambda p, x, u: [x[0]])
    with pytest.raises(
        InputError, match="no other derivative or output than its own; make it anew"
    ):
        replace(model, derivative=LAG.derivative)

    def missing(name: str) -> Array:
        raise ImportError(name)

    monkeypatch.setattr("sms.diagnosis.own.casadi_model.importlib.import_module", missing)
    with pytest.raises(InputError, match=r'pip install "sms\[casadi\]"'):
        of_casadi(LAG, lambda p, x, u: [x[0]])
