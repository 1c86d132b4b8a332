"""Flow identification: truth recovered, bad records named, files read again."""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.signal import lfilter
from sms.estimation.coloured_noise import Colour, colour_of, coloured_meat
from sms.identification.estimate import Free, estimate
from sms.identification.flow import FlowFit, fit_record
from sms.identification.flow_map import valve_map
from sms.identification.flow_problem import COMPONENT
from sms.identification.flow_record import FlowRecord, look_at
from sms.identification.flow_result import load_valve_map
from sms.io import InputError, write_table
from sms.io.declarations import Declaration
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command

from validation.trials.identify_flow import declared, one_test, truth_of
from validation.twins.flow_runs import draw
from validation.twins.flow_test import Charging, true_component

SEED = 20
C, B, M = COMPONENT


@pytest.fixture
def rng() -> np.random.Generator:
    print(f"seed {SEED}")
    return np.random.default_rng(SEED)


def fitted(
    spool: float, charge: bool, supply: float, rng: np.random.Generator
) -> tuple[FlowFit, Charging]:
    record, test = one_test(spool, charge, supply, rng)
    return fit_record(record, declared), test


@pytest.mark.parametrize("charge", [True, False])
def test_the_truth_of_an_independent_simulator_comes_back(
    charge: bool, rng: np.random.Generator
) -> None:
    fit, test = fitted(0.6e-3, charge, 486e3, rng)
    truth = truth_of(test)
    assert fit.known[C].value == pytest.approx(truth[C], rel=0.01)
    assert fit.known[B].value == pytest.approx(truth[B], abs=0.03)
    assert fit.known[M].value == pytest.approx(truth[M], rel=0.1)
    assert all(fit.known[name].identifiable for name in COMPONENT)
    assert fit.mae < 0.5 * fit.mae_classic
    assert fit.mae < 2e3
    assert fit.found is not None
    assert fit.found.scale * fit.look.noise == pytest.approx(323.0, rel=0.05)
    assert (fit.look.floor is not None) == (not charge)


def test_a_charge_that_hardly_chokes_leaves_b_open_instead_of_printing_it(
    rng: np.random.Generator,
) -> None:
    record, test = one_test(1.8e-3, True, 286e3, rng)
    rough = replace(record, pressure=record.pressure + rng.normal(0.0, 2e3, record.pressure.size))
    fit = fit_record(rough, declared)
    assert not fit.known[B].identifiable
    assert "not identifiable" in fit.known[B].verdict
    assert fit.known[B].lower <= truth_of(test)[B] <= fit.known[B].upper


def test_the_budget_carries_the_volume_one_to_one(rng: np.random.Generator) -> None:
    record, _ = one_test(0.6e-3, True, 486e3, rng)

    def volume_only(name: str) -> object:
        known = declared(name)
        return replace(known, uncertainty=1e-4) if name == "tank_volume" else known

    fit = fit_record(record, volume_only, with_profiles=False)  # type: ignore[arg-type]
    lines = {line.name: line.uncertainty for line in fit.budget}
    expected = fit.known[C].value * 1e-4 / 5e-3 / np.sqrt(3.0)
    assert lines["tank_volume"] == pytest.approx(expected, rel=1e-3)


# ---- what a record prevents --------------------------------------------------------------------------


def test_a_record_that_does_not_move_says_so(rng: np.random.Generator) -> None:
    time = np.arange(2000) / 100.0
    still = FlowRecord(
        "still", time, 86e3 + 323.0 * rng.standard_normal(2000), None, None, 1e-3, 486e3, 86e3
    )
    fit = fit_record(still, declared)
    assert fit.found is None
    assert "does not move" in fit.notes[0]


def test_a_charge_that_never_fills_says_what_is_left(rng: np.random.Generator) -> None:
    record, test = one_test(0.3e-3, True, 486e3, rng)
    early = record.time < 1.8
    cut = replace(record, time=record.time[early], pressure=record.pressure[early])
    fit = fit_record(cut, declared)
    assert any("C can be identified" in note for note in fit.notes)
    assert not fit.known[B].identifiable
    assert not fit.known[M].identifiable
    assert fit.known[C].lower <= truth_of(test)[C] <= fit.known[C].upper


def test_a_clipped_sensor_is_modelled_and_said(rng: np.random.Generator) -> None:
    record, test = one_test(0.6e-3, True, 486e3, rng)
    clipped = replace(record, pressure=np.minimum(record.pressure, 400e3))
    fit = fit_record(clipped, declared)
    assert fit.look.ceiling == pytest.approx(400e3)
    assert any("clipped" in note for note in fit.notes)
    assert fit.known[C].value == pytest.approx(truth_of(test)[C], rel=0.02)


def test_without_spool_position_c_is_there_and_the_map_is_not(rng: np.random.Generator) -> None:
    record, test = one_test(0.6e-3, True, 486e3, rng)
    fit = fit_record(replace(record, spool=None), declared, with_profiles=False)
    assert any("spool position" in note for note in fit.notes)
    assert fit.classic is None
    assert fit.known[C].value == pytest.approx(truth_of(test)[C], rel=0.02)
    assert valve_map([fit]) == ()


def test_a_record_that_begins_with_the_opening_is_fitted_too(rng: np.random.Generator) -> None:
    record, test = one_test(0.6e-3, False, 486e3, rng)
    late = record.time > test.opening + 0.05
    fit = fit_record(
        replace(record, time=record.time[late], pressure=record.pressure[late]), declared
    )
    assert not fit.look.waits
    assert fit.known[C].value == pytest.approx(truth_of(test)[C], rel=0.01)


def test_the_opening_is_found_within_a_sample_or_two(rng: np.random.Generator) -> None:
    record, test = one_test(1.0e-3, True, 486e3, rng)
    assert look_at(record).opening == pytest.approx(test.opening, abs=0.03)


def test_wild_readings_are_survived_with_a_robust_loss(rng: np.random.Generator) -> None:
    record, test = one_test(0.6e-3, True, 486e3, rng)
    wild = record.pressure.copy()
    wild[rng.integers(0, wild.size, 60)] += 4e4
    spoiled = replace(record, pressure=wild, noise=323.0)
    errors = [
        abs(
            fit_record(spoiled, declared, huber=k, with_profiles=False).known[C].value
            / truth_of(test)[C]
            - 1
        )
        for k in (0.0, 2.0)
    ]
    assert errors[1] < 0.01
    assert errors[1] < errors[0]


# ---- heat ------------------------------------------------------------------------------------------------


def heated(rng: np.random.Generator) -> tuple[FlowRecord, Charging]:
    """A charge whose tank exchanges heat with its wall: mass and energy integrated apart from the core's equations."""
    test = Charging(true_component(0.6e-3, True), True, 486e3, duration=8.0)
    heat, gas, expansion = 60.0 * 0.17, 288.0, 288.0 / 0.4  # W/K, J/(kg K), J/(kg K)
    start = test.ambient * test.volume / (gas * test.temperature)

    def rate(clock: float, state: NDArray[np.float64]) -> list[float]:
        mass, energy = state
        warmth = energy / (mass * expansion)
        pressure = mass * gas * warmth / test.volume
        flow = test.component.mass_flow(test.supply, pressure, test.temperature)
        enthalpy = flow * (expansion + gas) * test.temperature
        return [flow, enthalpy + heat * (test.temperature - warmth)]

    time = np.arange(800) / 100.0
    after = time > test.opening
    span = (0.0, float(time[-1]) - test.opening)
    first = [start, start * expansion * test.temperature]
    found = solve_ivp(rate, span, first, "LSODA", time[after] - test.opening, rtol=1e-9, atol=1e-12)
    pressure = np.full(time.size, test.ambient)
    warmth = np.full(time.size, test.temperature)
    warmth[after] = found.y[1] / (found.y[0] * expansion)
    pressure[after] = found.y[0] * gas * warmth[after] / test.volume
    noisy = pressure + 323.0 * rng.standard_normal(time.size)
    read = warmth + 0.2 * rng.standard_normal(time.size)
    return FlowRecord("heated", time, noisy, None, read, 0.6e-3, test.supply, test.ambient), test


def test_a_measured_temperature_is_fitted_with_the_pressure(rng: np.random.Generator) -> None:
    record, test = heated(rng)

    def open_wall(name: str) -> Declaration:
        known = declared(name)
        return replace(known, fit=True) if name == "heat_transfer_coefficient" else known

    fit = fit_record(record, open_wall, heat="energy")
    alone = fit_record(replace(record, temperature=None), open_wall, heat="energy")
    assert fit.found is not None and alone.found is not None
    assert len(fit.found.colours) == 2  # each sensor has a noise of its own
    assert fit.known[C].value == pytest.approx(truth_of(test)[C], rel=0.01)
    assert fit.found.params.heat_transfer_coefficient == pytest.approx(60.0, rel=0.05)
    assert fit.found.sd("heat_transfer_coefficient") < alone.found.sd("heat_transfer_coefficient")
    assert fit.found.scale == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("chambers", ["polytropic", "energy"])
def test_the_command_fits_a_temperature_or_says_that_it_does_not(
    chambers: str, tmp_path: Path, rng: np.random.Generator
) -> None:
    record, _ = heated(rng)
    assert record.temperature is not None
    columns = {"time [s]": record.time, "p [Pa]": record.pressure, "warmth [K]": record.temperature}
    write_table(tmp_path / "charge.csv", columns)
    (tmp_path / "rig.toml").write_text(f"""
        rig.kind = "flow_test"
        rig.title = "heated"
        model.chambers = "{chambers}"
        signals = {{ time = "time", tank_pressure = "p", tank_temperature = "warmth" }}
        parameters.ambient_pressure = "86 kPa"
        parameters.supply_pressure = "486 kPa"
        parameters.heat_transfer_coefficient = {{ value = "30 W/(m^2 K)", fit = true }}
        [[records]]
        file = "charge.csv"
        role = "identify"
        conditions = {{ spool_position = "0.6 mm" }}
    """)
    result = command("identify", "flow", "rig.toml", "--out", "flow", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert ("tank_temperature is recorded and not used" in result.stdout) == (
        chambers == "polytropic"
    )
    answer = json.loads((tmp_path / "flow" / "flow.json").read_text())["records"][0]
    assert answer["fitted"]
    if chambers == "energy":
        assert answer["noise"] == pytest.approx(323.0, rel=0.1)
        assert answer["parameters"]["heat_transfer_coefficient"]["value"] == pytest.approx(
            60.0, rel=0.05
        )


# ---- coloured residuals --------------------------------------------------------------------------------


def test_the_memory_of_a_residual_is_found_and_widens_the_errors(rng: np.random.Generator) -> None:
    n, memory = 4000, 0.8
    white = rng.standard_normal(n)
    red = np.empty(n)
    red[0] = white[0]
    for i in range(1, n):
        red[i] = memory * red[i - 1] + np.sqrt(1 - memory**2) * white[i]
    assert colour_of(white, 0).coefficients.size == 0
    found = colour_of(red, 0)
    assert found.samples_as_one == pytest.approx((1 + memory) / (1 - memory), rel=0.25)
    ones = np.ones((n, 1))
    assert coloured_meat(ones, found)[0, 0] / n == pytest.approx(9.0, rel=0.3)
    plain = Colour(1.0, np.empty(0))
    assert coloured_meat(ones, plain)[0, 0] == pytest.approx(n)


def test_a_small_slow_part_of_the_noise_is_not_overlooked(rng: np.random.Generator) -> None:
    n, share, keep = 4000, 0.08, np.exp(-0.1)
    found = []
    for _ in range(20):
        slow = lfilter([np.sqrt(1.0 - keep**2)], [1.0, -keep], rng.standard_normal(n))
        noise = np.sqrt(share) * slow + np.sqrt(1.0 - share) * rng.standard_normal(n)
        found.append(colour_of(noise, 0).samples_as_one)
    assert np.mean(found) == pytest.approx(1.0 + 2.0 * share * keep / (1.0 - keep), rel=0.2)


def test_a_parameter_that_no_row_feels_is_refused_by_name(rng: np.random.Generator) -> None:
    from sms import _core  # noqa: PLC0415

    record, _ = one_test(0.6e-3, True, 486e3, rng)
    problem = _core.TankProblem(time=record.time, pressure=record.pressure, charge=True)
    weight = np.ones(record.time.size)
    with pytest.raises(ValueError, match="heat_transfer_coefficient"):
        estimate(problem, [_core.Params()], [Free.of("heat_transfer_coefficient")], weight)


# ---- the command -----------------------------------------------------------------------------------------


def small_matrix() -> list[tuple[float, Charging]]:
    return [
        (spool, Charging(true_component(spool, charge), charge, supply, duration=8.0))
        for supply in (286e3, 486e3)
        for spool in (0.6e-3, 0.8e-3, 1.0e-3)
        for charge in (True, False)
    ]


def test_the_command_writes_what_can_be_read_again(tmp_path: Path) -> None:
    rig = draw(tmp_path / "records", SEED, small_matrix())
    result = command("identify", "flow", str(rig), "--out", "flow", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "12 of 12 records" in result.stdout
    curves = load_valve_map(tmp_path / "flow" / "flow.toml")
    assert {(c.direction, c.supply_pressure) for c in curves} == {
        (way, supply) for way in ("charge", "discharge") for supply in (286e3, 486e3)
    }
    for curve in curves:
        assert np.all(np.diff(curve.conductance) >= 0.0)
        if curve.supply_pressure > 4e5:
            truth = true_component(0.8e-3, curve.direction == "charge").conductance
            assert curve.at(0.8e-3)[0] == pytest.approx(truth, rel=0.02)
    tables = tomllib.loads((tmp_path / "flow" / "flow.toml").read_text())
    assert len(tables["component"]) == 12
    answer = json.loads((tmp_path / "flow" / "flow.json").read_text())
    covariance = np.array(answer["records"][-1]["covariance"], dtype=float)
    assert covariance.shape[0] == covariance.shape[1] == len(answer["records"][-1]["parameters"])
    page = (tmp_path / "flow" / "report.html").read_text()
    for part in ("map", "fits", "profiles", "correlation", "budget"):
        assert f'id="{part}"' in page


def test_one_supply_and_another_kind_of_rig_are_named(tmp_path: Path) -> None:
    rig = draw(tmp_path / "records", SEED, small_matrix()[:2])
    result = command("identify", "flow", str(rig), cwd=tmp_path)
    assert "Only one supply pressure" in result.stdout
    other = rig.with_name("other.toml")
    text = rig.read_text().replace('"flow_test"', '"tank"')
    other.write_text(text.replace('time = "time"', 'time = "time"\nvalve_command = "command"'))
    refused(command("identify", "flow", str(other), cwd=tmp_path), "flow_test", "'tank'")
    with pytest.raises(InputError, match="no valve map"):
        load_valve_map(rig)
