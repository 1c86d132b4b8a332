"""The diagnosis of a simulated rig: windows, screening, one named effect, and a healthy bench."""

from __future__ import annotations

import dataclasses
import json
import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from plant_support import LEAK, fitted_baseline, write_bench
from sms import _core
from sms.diagnosis import Diagnosis, diagnose
from sms.diagnosis.adequacy.residual_energy import Left, energies, excess, small, tolerated
from sms.diagnosis.effects.catalogue import Effect, catalogue
from sms.diagnosis.localisation.signal_functions import hats
from sms.diagnosis.localisation.unknown_inputs import confirmed
from sms.diagnosis.other_records import unseen
from sms.diagnosis.selection.score_test import score_tests
from sms.estimation.least_squares import Free, fit_windows
from sms.estimation.nuisance import Nuisance, project
from sms.parameters import FLOW_MAP, FRICTION_MAP, LINEARITY

from validation.random_cases import draw
from validation.twins.draw import draw as draw_machine

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
Array = NDArray[np.float64]

OF_BENCH = tuple(
    f"sensor_linearity_{s}"
    for s in ("extension", "chamber_pressure_lower", "chamber_pressure_upper")
)
IDS = (
    *("presliding", "valve_leakage", "piston_leakage", "fitting_leakage"),
    *("spool_lag", "command_delay", "dead_band_width", "valve_centre_offset"),
    *("flow_conductance", "exhaust_restriction", "supply_droop", "supply_setpoint"),
    *("dead_volume", "tube", "polytropic_index", "heat_transfer"),
    *(
        "pressure_dependent_friction",
        "direction_dependent_friction",
        "friction_lag",
        "position_dependent_friction",
    ),
    *("viscous_friction", "coulomb_friction", "exponential_friction", "end_cushioning"),
    *("moving_mass", "centre_of_gravity", "panhard_friction", "backlash"),
    *("frame_compliance", "sensor_gain", "sensor_offset", "sensor_lag"),
    *("clock_skew", "ambient_pressure", "controller_mismatch"),
)


# ---- catalogue -----------------------------------------------------------------------------------


def test_the_catalogue_has_every_effect_with_all_its_words() -> None:
    effects = [e for kind in ("tank", "bench", "platform") for e in catalogue(kind)]
    assert {e.id for e in effects} >= set(IDS)
    for effect in effects:
        assert all((effect.title, effect.cause, effect.separated_by, effect.needs))
        assert "{" not in effect.title + effect.cause + effect.separated_by
        said, shown = effect.cause.split(" In the records: ")
        assert said.rstrip(")").endswith(".") and shown.endswith(".") and shown[0].islower()


def test_every_key_of_an_entry_is_read() -> None:
    fields = {f.name for f in dataclasses.fields(Effect)} - {"signal", "of_sensor"}
    read = fields | {"kinds", "signals", "parts", "signature"}
    for file in files("sms.diagnosis.effects").iterdir():
        if file.name.endswith(".toml"):
            for entry in tomllib.loads(file.read_text(encoding="utf-8"))["effect"]:
                assert entry.keys() <= read, (file.name, entry["id"], entry.keys() - read)


def test_missing_terms_are_neutral_by_default() -> None:
    params = _core.LegParams()
    for kind in ("tank", "bench", "platform"):
        for effect in catalogue(kind):
            if effect.kind == "missing":
                # The first switches the term on; others only shape it.
                assert params[effect.parameters[0]] == 0.0, effect.key


def test_a_zero_error_has_a_size_beyond_which_it_is_none() -> None:
    of_signal = {"extension": 0.05, "roll": 0.2, "pitch": 0.2, "tank_temperature": 20.0}
    for kind in ("tank", "bench", "platform"):
        for effect in catalogue(kind):
            if effect.id == "sensor_offset":
                signal = effect.parameters[0].removeprefix("sensor_offset_").partition(":")[0]
                largest = of_signal.get(signal, 5e4)
                assert effect.plausible_range(0.0) == (-largest, largest), effect.key


# ---- numerics ------------------------------------------------------------------------------------


class Line:
    """A linear problem with known answer, as the core's problems look."""

    def __init__(self, columns: Array, target: Array) -> None:
        self.columns, self.target = columns, target
        self.asked: list[str] = []

    def evaluate(self, params: _core.Params, names: list[str] | None = None) -> tuple[Array, Array]:
        value = np.array([params["coulomb_force"], params["viscous_friction"]])
        order = {"coulomb_force": 0, "viscous_friction": 1}
        chosen = [order[n] for n in names or []]
        self.asked += names or []
        return self.columns @ value - self.target, self.columns[:, chosen]


def test_a_fit_within_bounds_and_pulls_is_the_known_least_squares() -> None:
    random = draw("fit_windows")
    columns = random.normal(size=(200, 2)) * [0.1, 0.01]
    target = columns @ [45.0, 700.0] + random.normal(size=200)
    start = _core.Params(coulomb_force=38.0, viscous_friction=530.0)
    free = [
        Free("coulomb_force", 30.0, 60.0, 0.25, 38.0),
        Free("viscous_friction", 480.0, 580.0, 0.0, 530.0),
    ]
    found = fit_windows(Line(columns, target), start, free)  # type: ignore[arg-type]
    held = 580.0  # the free optimum lies beyond the bound
    a, b = columns[:, 0], target - columns[:, 1] * held
    expected = (a @ b + 0.25**2 * 38.0) / (a @ a + 0.25**2)
    assert found.params["viscous_friction"] == pytest.approx(held)
    assert found.params["coulomb_force"] == pytest.approx(expected, rel=1e-6)
    assert found.at_bound == [False, True]


def test_a_fit_from_an_old_jacobian_ends_where_an_exact_one_does() -> None:
    random = draw("secants")
    columns = random.normal(size=(200, 2)) * [0.1, 0.01]
    target = columns @ [41.0, 560.0] + random.normal(size=200)
    start = _core.Params(coulomb_force=38.0, viscous_friction=530.0)
    free = [
        Free("coulomb_force", 30.0, 60.0, 0.25, 38.0),
        Free("viscous_friction", 480.0, 880.0, 0.001, 530.0),
    ]
    line = Line(columns, target)
    exact = fit_windows(line, start, free)  # type: ignore[arg-type]
    old = columns * random.uniform(0.7, 1.4, size=2)
    both = dict(zip(("coulomb_force", "viscous_friction"), old.T, strict=True))
    found = fit_windows(line, start, free, nearby=both)  # type: ignore[arg-type]
    assert found.converged
    assert found.jacobian == pytest.approx(columns)
    for name in ("coulomb_force", "viscous_friction"):
        assert found.params[name] == pytest.approx(exact.params[name], rel=0.02)
    line.asked.clear()
    one = {"viscous_friction": old[:, 1]}
    found = fit_windows(line, start, free, nearby=one, kept=one)  # type: ignore[arg-type]
    assert "coulomb_force" in line.asked and "viscous_friction" not in line.asked
    assert found.jacobian[:, 0] == pytest.approx(columns[:, 0])
    assert found.params["coulomb_force"] == pytest.approx(exact.params["coulomb_force"], rel=0.02)


def test_screening_finds_the_column_that_is_there_and_none_where_there_is_none() -> None:
    random = draw("screening")
    n, blocks = 2000, np.repeat(np.arange(20), 100)
    columns = random.normal(size=(n, 30))
    free = Nuisance(["a", "b"], random.normal(size=(n, 2)), np.zeros((2, 2)), np.zeros(2))
    sensitivity = project(free, columns, [f"c{k}" for k in range(30)])
    basis = free.basis()
    allowed = np.ones((30, 2), dtype=np.bool_)
    alarms = 0
    for _ in range(20):
        noise = random.normal(size=n)
        noise -= (basis @ (basis.T @ np.concatenate([noise, np.zeros(2)])))[:n]
        quiet = score_tests(sensitivity, free, noise, blocks, allowed, random)
        alarms += int(quiet.p_value.min() <= 0.05)
    assert alarms <= 8  # one is expected; nine or more come once in five million runs
    loud = score_tests(sensitivity, free, noise - 0.5 * sensitivity[:n, 7], blocks, allowed, random)
    assert int(np.argmax(loud.gain)) == 7
    assert loud.p_value[7] <= 0.002
    assert loud.estimate[7] == pytest.approx(0.5, abs=5.0 * loud.error[7])
    allowed[7] = [True, False]
    assert (
        score_tests(
            sensitivity, free, noise - 0.5 * sensitivity[:n, 7], blocks, allowed, random
        ).p_value[7]
        == 1.0
    )


def test_a_known_parameter_is_no_rival_beyond_its_uncertainty() -> None:
    column = np.sin(np.linspace(0.0, 9.0, 500))[:, None]
    same = column.copy()
    for pull, left in ((0.0, 0.0), (1e6, 1.0)):
        rest = project(Nuisance(["a"], same, np.array([[pull]]), np.zeros(1)), column, ["b"])
        assert np.linalg.norm(rest) / np.linalg.norm(column) == pytest.approx(left, abs=1e-3)


def test_hats_are_a_partition_of_one() -> None:
    functions = hats(np.linspace(-1.0, 2.0, 50), np.linspace(-1.0, 2.0, 5))
    assert functions.sum(axis=1) == pytest.approx(np.ones(50))
    assert functions.min() >= 0.0


def test_a_curve_is_carried_as_far_as_one_record_confirms_it_of_another() -> None:
    random = draw("confirmed curve")
    columns, parts = random.normal(size=(4000, 7)), np.repeat([0, 1, -1], [2000, 1998, 2])
    noise, curve = random.normal(size=4000), random.normal(size=7)
    there = confirmed(columns, noise - columns @ curve, parts)
    assert there.part == pytest.approx(1.0, abs=0.1)
    assert there.taken == pytest.approx(float(np.sum((columns @ curve) ** 2)), rel=0.2)
    # One record's own curve, which the other has the other way round, and noise alone.
    opposed = np.where(parts == 0, 1.0, -1.0) * (columns @ curve)
    assert confirmed(columns, noise - opposed, parts).part == 0.0
    assert confirmed(columns, noise, parts).taken < 40.0


# ---- the whole method ------------------------------------------------------------------------------


def test_a_healthy_bench_gives_no_evidence(tmp_path: Path) -> None:
    answer = diagnose(write_bench(tmp_path, 1, {}))
    assert (answer.verdict, answer.causes) == ("no-evidence", ())
    assert all(g.baseline_rms < 1.3 * g.noise_floor for g in answer.gain)


def test_a_flow_map_may_be_off_as_far_as_the_rig_file_says(tmp_path: Path) -> None:
    path = write_bench(
        tmp_path, 5, {n: 0.12 * np.sin(1.3 * k + 1.0) for k, n in enumerate(FLOW_MAP)}
    )
    text = path.read_text()
    path.write_text(text + '\n[model]\nflow_map_uncertainty = "0 %"\n')
    exact, data = fitted_baseline(path)
    assert not small(Left.by(exact, data), tolerated(exact, data))
    assert not set(FLOW_MAP) & set(exact.hypothesis.free)
    path.write_text(text + '\n[model]\nflow_map_uncertainty = "12 %"\n')
    wide = diagnose(path)
    assert wide.verdict == "no-evidence"
    assert {p.name for p in wide.baseline} >= set(FLOW_MAP[:5])  # a wider opening does not occur
    assert all(g.baseline_rms < 1.3 * g.noise_floor for g in wide.gain)


def test_friction_and_sensors_may_be_off_as_far_as_the_rig_file_says(tmp_path: Path) -> None:
    off = {n: 0.12 * np.sin(1.7 * k + 1.0) for k, n in enumerate(FRICTION_MAP)}
    off |= {n: 0.008 * (-1.0) ** k for k, n in enumerate(OF_BENCH)}
    path = write_bench(tmp_path, 6, off)
    text = path.read_text()

    def declare(friction: str, line: str) -> None:
        path.write_text(
            f'{text}\n[model]\nfriction_map_uncertainty = "{friction}"\nsensor_linearity = "{line}"\n'
        )

    declare("0 %", "0 %")
    exact, data = fitted_baseline(path)
    assert not small(Left.by(exact, data), tolerated(exact, data))
    assert not {*FRICTION_MAP, *LINEARITY} & set(exact.hypothesis.free)
    declare("12 %", "1 %")
    wide = diagnose(path)
    assert wide.verdict == "no-evidence"
    assert {p.name for p in wide.baseline} >= {*FRICTION_MAP, *OF_BENCH}
    told, again = fitted_baseline(path)  # with all that was fitted held
    beyond = excess(energies(again.validate, unseen(told, again)))
    assert beyond < 0.1 * excess(energies(data.validate, unseen(exact, data)))


def test_a_leak_past_the_piston_is_named_with_its_size(leaking_bench: Diagnosis) -> None:
    answer, leak = leaking_bench, LEAK
    assert answer.verdict in ("cause", "class")
    (cause,) = answer.causes
    assert "piston_leakage" in cause.members and len(cause.members) <= 3
    every = {cause.effect: cause.parameters[0]} | {
        a.effect: a.parameters[0] for a in cause.alternatives
    }
    found = every["piston_leakage"]
    assert found.value == pytest.approx(leak, abs=max(3.0 * found.standard_error, 0.05 * leak))
    assert answer.hidden is not None
    assert all(g.extended_rms < 1.3 * g.noise_floor for g in answer.gain)
    assert 0.9 < cause.support <= 1.0  # chosen again on resampled windows


def test_an_estimate_beyond_all_reason_promises_what_it_takes_within() -> None:
    """Two sensitivities, the second weak: alone its linear step would take all, by a size nobody believes."""
    rng = np.random.default_rng(5)
    block = np.repeat(np.arange(20), 30)
    wave = np.sin(np.arange(600) / 7.0)
    residual = -wave + rng.normal(0.0, 0.01, 600)
    sensitivity = np.column_stack([wave + 0.3 * np.cos(np.arange(600) / 3.0), 1e-3 * wave])
    none = Nuisance([], np.empty((600, 0)), np.empty((0, 0)), np.empty(0))
    allowed = np.ones((2, 2), dtype=np.bool_)
    found = score_tests(sensitivity, none, residual, block, allowed, rng, draws=99)
    assert found.gain[1] > found.gain[0]
    promise = found.promise(np.array([-10.0, -10.0]), np.array([10.0, 10.0]))
    assert promise[0] == pytest.approx(found.gain[0])
    step = 10.0 * 1e-3 * wave
    assert promise[1] == pytest.approx(
        residual @ residual - np.sum((residual + step) ** 2), rel=0.01
    )
    assert promise[0] > promise[1]


def test_a_dead_channel_is_a_data_fault(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 4, {})
    file = tmp_path / "run0.csv"
    head, *rows = file.read_text().splitlines()
    column = head.split(",").index("chamber_pressure_upper [Pa]")
    cells = [row.split(",") for row in rows]
    for row in cells[100:]:
        row[column] = cells[100][column]
    file.write_text("\n".join([head, *(",".join(row) for row in cells)]) + "\n")
    answer = diagnose(path)
    assert (answer.verdict, answer.causes) == ("data-fault", ())


@pytest.mark.full
def test_a_film_that_is_late_has_its_lag(tmp_path: Path) -> None:
    """What the piston did before a window counts: without it, this lag came out a quarter too long."""
    sealed = tmp_path / "truth.json"
    draw_machine("bench", 970014, tmp_path / "records", sealed, "friction_lag")
    (hidden,) = json.loads(sealed.read_text(encoding="utf-8"))["effects"]
    (cause,) = diagnose(tmp_path / "records" / "rig.toml").causes
    assert cause.effect == "friction_lag"
    (found,) = cause.parameters
    assert found.value == pytest.approx(hidden["value"], rel=0.08)
