"""What a plant of one's own is given: dead times, sensors with a range, guesses, jumps, columns of other loggers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sms import _core
from sms.diagnosis import own
from sms.diagnosis.own.as_rig import noise_of, problem_of, run_of
from sms.diagnosis.own.delayed import Delayed
from sms.diagnosis.own.integrate import Batch, simulate
from sms.errors import InputError
from test_own_model import LAG, Array, lag, records_of_lag

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
ROLES: tuple[own.Role, ...] = ("identify", "identify", "validate", "validate")

# ---- dead times ------------------------------------------------------------------------------------------


def late(held: bool, **declared: Any) -> own.Model:
    """The lag behind a dead time of up to 0.4 s."""
    dead_time = own.Parameter("dead_time", "s", 0.0, **({"value": 0.1, "upper": 0.4} | declared))
    effect = own.Effect(
        "dead_time", "dead_time", "another dead time", "A longer pipe.", equation="balance"
    )
    return replace(
        LAG,
        inputs=[own.Input("u", "V", held=held, delay="dead_time")],
        parameters=[*LAG.parameters, dead_time],
        effects=[*LAG.effects, effect],
    )


def response(u: Array, dead_time: float, held: bool) -> Array:
    """(samples,): the lag's exact answer at every 0.05 s to an input that is linear or held, and late."""
    fine, x = 200, np.empty(u.size)
    x[0], h = u[0], 0.05 / fine
    state, decay = u[0], np.exp(-h / 0.5)
    place = np.arange((u.size - 1) * fine) / fine + 0.5 / fine - dead_time / 0.05
    here = np.clip(np.floor(place).astype(int), 0, u.size - 1)
    felt = u[here] if held else np.interp(place, np.arange(u.size), u)
    for k, value in enumerate(felt):
        state = value + (state - value) * decay
        if (k + 1) % fine == 0:
            x[(k + 1) // fine] = state
    return x


def records_of_late(dead_time: float, held: bool) -> list[own.Record]:
    rng, out = np.random.default_rng(9), []
    for number, role in enumerate(ROLES):
        u = (
            np.repeat(rng.normal(0.0, 1.0, 40), 10)
            if held
            else np.cumsum(rng.normal(0.0, 0.2, 400))
        )
        y = response(u, dead_time, held) + rng.normal(0.0, 0.01, u.size)
        out.append(
            own.Record(f"run {number}", role, {"time": 0.05 * np.arange(400.0), "u": u, "y": y})
        )
    return out


@pytest.mark.parametrize("held", [False, True])
def test_a_dead_time_between_samples_is_found(held: bool) -> None:
    records = records_of_late(0.173, held)
    model = late(held, value=0.173)
    runs = [run_of(model, r) for r in records[:2]]
    problem = problem_of(replace(model, longest_step=0.0125), runs, noise_of(model, runs), 2.0)
    assert min(w.first for w in problem.windows) == 8  # 0.4 s: what acted before is not recorded
    residual, _ = problem.evaluate(model.values())
    assert np.mean(residual**2) < 1.1

    answer = own.diagnose_model(late(held), records, window=2.0)
    assert [c.members for c in answer.causes] == [("dead_time",)]
    found = answer.causes[0].parameters[0]
    assert found.value == pytest.approx(0.173, abs=4.0 * found.standard_error)
    assert found.standard_error < 0.005
    assert answer.extended is not None
    whole = own.simulate(answer.extended, records[3])
    assert len(whole.time) == 400 - 8
    assert whole.error["y"] < 0.012


@pytest.mark.parametrize("held", [False, True])
def test_the_derivative_by_a_dead_time_does_not_depend_on_its_step(held: bool) -> None:
    u = np.repeat(np.random.default_rng(2).normal(0.0, 1.0, 20), 5)
    delayed = Delayed.of(0, "dead_time", held, [u], np.zeros(1, np.int64), np.zeros(1, np.int64))
    batch = Batch(np.array([0.05]), u[:, None, None], u[:1, None], [delayed])
    model = replace(late(held, value=0.173), longest_step=0.05)

    def slope(step: float) -> Array:
        below, above = (
            simulate(model, model.with_values({"dead_time": 0.173 + s}).values(), batch)[:, 0, 0]
            for s in (-step, step)
        )
        return np.asarray((above - below) / (2.0 * step))

    small, large = slope(1e-7), slope(1e-3)
    assert np.linalg.norm(small) > 1.0
    assert np.linalg.norm(small - large) < 1e-6 * np.linalg.norm(small)


def test_a_delayed_input_is_interpolated_and_a_held_one_is_a_mean() -> None:
    recorded = np.array([0.0, 1.0, 3.0])
    one = np.zeros(1, dtype=np.int64)
    linear = Delayed.of(0, "d", False, [recorded], one, one)
    held = Delayed.of(0, "d", True, [recorded], one, one)
    for place, wanted in ((-0.5, 0.0), (0.25, 0.25), (1.5, 2.0), (7.0, 3.0)):
        assert linear.at(np.array([place]))[0] == pytest.approx(wanted)
    assert held.at(np.array([1.5]))[0] == 1.0
    assert held.mean(np.array([0.75]), 0.5)[0] == pytest.approx(0.5)
    assert held.mean(np.array([-3.0]), 0.5)[0] == 0.0


def test_a_dead_time_that_cannot_be_is_one_sentence() -> None:
    with pytest.raises(InputError, match="did you mean 'gain'"):
        replace(LAG, inputs=[own.Input("u", "V", delay="gian")])
    with pytest.raises(InputError, match="no input acts before it is there"):
        replace(LAG, inputs=[own.Input("u", "V", delay="offset")])
    with pytest.raises(InputError, match="lower the upper bound"):
        own.diagnose_model(late(False, upper=30.0), records_of_late(0.1, False), window=2.0)


# ---- readings at the end of their range ---------------------------------------------------------------------


def test_readings_at_the_end_of_a_range_are_compared_with_nothing() -> None:
    """A sensor that reads no more than 0.4 V: without its range, that is a wrong model; with it, none."""
    records = []
    for r in records_of_lag():
        signals = dict(r.signals) | {"y": np.minimum(r.signals["y"], 0.4)}
        records.append(replace(r, signals=signals))
    blunt = own.diagnose_model(LAG, records, window=2.0)
    assert blunt.verdict != "no-evidence"
    told = replace(LAG, outputs=[own.Output("y", "V", noise=0.01, range=(-20.0, 0.4))])
    answer = own.diagnose_model(told, records, window=2.0)
    assert answer.verdict == "no-evidence"
    said = [f for f in answer.findings if "at an end of the range" in f.message]
    assert said and all(f.severity == "warning" for f in said)
    over = [r for r in records if np.any(r.signals["y"] >= 0.4)]
    assert {f.file for f in said} == {r.name for r in over}
    whole = own.simulate(told, over[0])
    assert whole.error["y"] < 0.012 < own.simulate(LAG, over[0]).error["y"]
    with pytest.raises(InputError, match="write the lowest reading first"):
        replace(LAG, outputs=[own.Output("y", "V", range=(1.0, 0.0))])


# ---- guesses and jumps ------------------------------------------------------------------------------------


def test_a_guess_may_ask_for_parameters_and_time() -> None:
    asked: list[tuple[float, Array, set[str], set[str]]] = []

    def guess(
        p: own.Values, time: Array, outputs: Mapping[str, Array], inputs: Mapping[str, Array]
    ) -> Mapping[str, Array]:
        asked.append((p.gain, time, set(outputs), set(inputs)))
        return {"x": outputs["y"] - p.offset}

    def former(signals: Mapping[str, Array]) -> Mapping[str, Array]:
        return {"x": signals["y"]}

    record = records_of_lag()[0]
    later = replace(record, signals=dict(record.signals) | {"time": record.signals["time"] + 7.0})
    found = own.simulate(replace(LAG, guess=guess), later)
    gain, time, outputs, inputs = asked[0]
    assert (gain, time[0], outputs, inputs) == (1.0, 0.0, {"y"}, {"u"})
    before = own.simulate(replace(LAG, guess=former), later)
    assert np.allclose(found.outputs["y"], before.outputs["y"], atol=1e-3)


def test_a_state_jumps_where_its_owner_says_so() -> None:
    """A level that cannot rise above its rim."""
    rim = replace(LAG, jump=lambda p, x, u: [np.minimum(x[0], 0.5)])
    u = np.concatenate([np.full(40, 1.0), np.zeros(40)])
    found = simulate(rim, rim.values(), Batch(np.array([0.05]), u[:, None, None], np.zeros((1, 1))))
    y = found[:, 0, 0]
    assert y.max() == 0.5
    assert y[60] == pytest.approx(0.5 * np.exp(-(60 - 40) * 0.05 / 0.5), rel=0.01)
    with pytest.raises(
        InputError, match="jump returns 2 arrays; needed are 1, in the order of states"
    ):
        replace(LAG, jump=lambda p, x, u: [x[0], x[0]])


# ---- columns of other loggers --------------------------------------------------------------------------------


def test_columns_of_another_name_and_unit_are_told(tmp_path: Path) -> None:
    file = tmp_path / "log.csv"
    rows = "".join(f"{10 * k},{1000 * k},{k}\n" for k in range(12))
    file.write_text("t [ms],Drive,level [mV]\n" + rows)
    columns = {"time": "t", "u": "Drive [mV]", "y": "level [V]"}
    record = own.read_record(file, LAG, "identify", columns=columns)
    assert np.allclose(record.signals["time"], 0.01 * np.arange(12))
    assert np.allclose(record.signals["u"], np.arange(12))
    assert np.allclose(
        record.signals["y"], np.arange(12)
    )  # the unit that is told goes before the table's
    with pytest.raises(InputError, match="the model has no signal 'z'"):
        own.read_record(file, LAG, "identify", columns={"z": "t"})
    with pytest.raises(InputError, match="no column 'Drvie'; did you mean 'Drive'"):
        own.read_record(file, LAG, "identify", columns=columns | {"u": "Drvie"})
    with pytest.raises(InputError, match="say by columns="):
        own.read_record(file, LAG, "identify")


# ---- an unknown at rest -----------------------------------------------------------------------------------


def test_the_curve_of_an_unknown_is_worth_something_on_a_record_at_rest_too() -> None:
    """It was a KeyError: a test record that does not move the signal which the curve follows."""
    model = replace(LAG, effects=[replace(LAG.effects[0], plausible=(-0.001, 0.001))])

    def stiffer(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
        return [lag(p, x, u)[0] - 2.0 * np.maximum(x[0] - 1.0, 0.0)]

    rng, records = np.random.default_rng(4), []
    for number, role in enumerate((*ROLES, "test")):
        u = np.repeat(rng.uniform(-1.0, 4.0, 20), 20) if role != "test" else np.full(400, 0.3)
        batch = Batch(np.array([0.05]), u[:, None, None], np.array([[0.3]]))
        y = simulate(replace(model, derivative=stiffer, longest_step=0.01), model.values(), batch)
        signals = {
            "time": 0.05 * np.arange(400.0),
            "u": u,
            "y": y[:, 0, 0] + rng.normal(0.0, 0.01, 400),
        }
        records.append(own.Record(f"run {number}", role, signals))
    answer = own.diagnose_model(model, records, window=2.0, empirical=True)
    assert answer.verdict == "unknown"
    assert answer.empirical is not None
    at_rest = [g for g in answer.empirical.gain if g.record == "run 4"]
    assert [g.signal for g in at_rest] == ["y"]
    assert at_rest[0].extended_rms < 0.02
    assert {f.record for f in answer.free_run} == {"run 2", "run 3", "run 4"}
