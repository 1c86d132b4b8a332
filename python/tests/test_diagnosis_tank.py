"""The diagnosis of a tank: one class named on records of the core's own tank, and the menu of next experiments."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from plant_support import fitted_baseline
from sms import Params, _core, simulate_tank
from sms.diagnosis import diagnose
from sms.diagnosis.adequacy.systematic_error import ACCURACY
from sms.diagnosis.design.still_hidden import still_hidden
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.localisation.signal_functions import (
    hats,
    of_input,
    points,
    signals_of,
    through_plant,
)
from sms.diagnosis.preparation import make_data
from sms.diagnosis.selection.identifiability import identifiable
from sms.diagnosis.selection.stepwise import try_effects
from sms.estimation.discrepancy import KNOTS
from sms.io import write_record
from sms.io.records import load_record
from sms.io.rig import load_rig
from sms.rigs.kinds import KINDS

from validation.random_cases import draw

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")

EVERY = 5
"""Control periods of 1 ms in a sample."""
RIG = """
[rig]
kind = "tank"
title = "A tank"

[signals]
time = "time"
valve_command = "valve_command"
tank_pressure = { noise = "300 Pa" }

[parameters]
tank_volume = { value = "5 l", uncertainty = "0.02 l" }
valve_centre = { value = "5 V", uncertainty = "0.02 V" }
"""


def write_tank(folder: Path, seed: int, truth: dict[str, float]) -> Path:
    """Two records to identify with and two to validate with, of a tank with these parameters."""
    random = np.random.default_rng(seed)
    text = RIG
    time = 1e-3 * np.arange(4000)
    for number, role in enumerate(("identify", "identify", "validate", "validate")):
        opening = 1.7 * np.sin((2.0 + number) * time) + 0.8 * np.sin(7.0 * time + number)
        run = simulate_tank(5.0 + opening, params=Params(**truth))
        clean = run["tank_pressure"][::EVERY]
        signals = {"time": time[::EVERY], "valve_command": 5.0 + opening[::EVERY]}
        signals["tank_pressure"] = clean + random.normal(0.0, 300.0, clean.size)
        write_record(folder / f"run{number}.csv", signals)
        text += f'\n[[records]]\nfile = "run{number}.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text)
    return folder / "rig.toml"


@pytest.mark.parametrize("said", ["", '\n[model]\nvalve = "iso_0_4_mpa"\n'])
def test_a_record_follows_the_table_that_was_measured_at_its_supply(
    tmp_path: Path, said: str
) -> None:
    random = draw("a tank at another supply")
    time = 1e-3 * np.arange(4000)
    opening = 1.7 * np.sin(random.uniform(2.0, 4.0) * time) + 0.8 * np.sin(7.0 * time)
    machine = Params(supply_pressure=286e3, tank_initial_pressure=1.5e5)
    run = simulate_tank(5.0 + opening, params=machine, valve_law="iso_0_2_mpa")
    signals = {"time": time[::EVERY], "valve_command": 5.0 + opening[::EVERY]}
    pressure = run["tank_pressure"][::EVERY]
    signals["tank_pressure"] = pressure + random.normal(0.0, 300.0, pressure.size)
    records = ""
    for role in ("identify", "validate"):
        write_record(tmp_path / f"{role}.csv", signals)
        records += f'\n[[records]]\nfile = "{role}.csv"\nrole = "{role}"\n'
        records += 'conditions = { supply_pressure = "286 kPa" }\n'
    (tmp_path / "rig.toml").write_text(RIG + said + records)
    rig = load_rig(tmp_path / "rig.toml")
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    residual, _ = data.identify.problem.evaluate(rig.start())
    left = float(np.sqrt(np.mean(residual**2)))
    assert left > 3.0 if said else left < 1.1


def test_a_larger_tank_and_a_smaller_flow_are_one_class(tmp_path: Path) -> None:
    answer = diagnose(
        write_tank(tmp_path, 1, {"tank_volume": 6.5e-3, "tank_initial_pressure": 2e5})
    )
    assert answer.verdict == "class"
    (cause,) = answer.causes
    assert {"dead_volume", "flow_conductance"} <= set(cause.members)
    assert set(cause.members) <= {"dead_volume", "flow_conductance", "tube"}
    found = {cause.effect: cause.parameters[0].value} | {
        m.effect: m.parameters[0].value for m in cause.alternatives
    }
    assert found["dead_volume"] == pytest.approx(6.5e-3, rel=0.03)
    assert found["flow_conductance"] == pytest.approx(5.0 / 6.5 - 1.0, abs=0.03)
    assert cause.parameters[0].standard_error < 0.1 * abs(cause.parameters[0].value)
    assert answer.hidden is not None
    assert answer.hidden.equation == "flow of the tank"
    assert answer.next_experiment is not None
    assert {"dead_volume tank", "flow_conductance"} <= set(answer.next_experiment.separates)
    assert "standard errors" in answer.next_experiment.purpose


def test_a_flow_proportional_to_the_rate_is_another_volume(tmp_path: Path) -> None:
    """To what the sensitivity to a function of a signal is accurate to: so none of it is the function's own."""
    _, data = fitted_baseline(write_tank(tmp_path, 1, {"tank_initial_pressure": 2e5}))
    runs, params = data.identify, data.rig.start()
    _, volume = runs.problem.evaluate(params, ["tank_volume"])
    rate = signals_of(runs)["pressure rate [Pa/s]"]
    flow = of_input(runs.problem.hidden(params, KNOTS), 0)
    functions = through_plant(runs, flow, hats(rate, points(rate)))
    imitated = functions @ np.linalg.lstsq(functions, volume, rcond=None)[0]
    assert np.linalg.norm(volume - imitated) < ACCURACY * np.linalg.norm(volume)


@pytest.mark.parametrize(
    "truth",
    [{"dead_band_change": 0.1}, {"tank_inflow_heat_change": 0.1}, {"exhaust_flow_change": -0.1}],
)
def test_effects_that_are_one_equation_are_fitted_together(
    tmp_path: Path, truth: dict[str, float]
) -> None:
    """Whichever leads: a tank's volume and all its flow are told apart by what is declared of them alone."""
    rig = write_tank(tmp_path, 3, truth | {"tank_initial_pressure": 2e5})
    baseline, data = fitted_baseline(rig)
    pair = ("flow_conductance", "dead_volume")
    effects = [e for e in effects_of(data.rig) if e.id in (*pair, "exhaust_restriction", "tube")]
    effects += [e for e in effects_of(data.rig) if e.id in ("polytropic_index", "dead_band_width")]
    current, trials = try_effects(baseline, data, effects, np.random.default_rng(1), 0.5)
    fitted = [t.fitted is not current for t in trials if t.effect.id in pair]
    assert fitted == [True, True]


def test_every_run_of_the_menu_can_be_made(tmp_path: Path) -> None:
    rig = load_rig(write_tank(tmp_path, 2, {}))
    for experiment in KINDS["tank"].menu:
        run = experiment.simulated(rig, Params(), ("tank_pressure", "supply_pressure"))
        assert run is not None, experiment.title
        pressure = run.signals["tank_pressure"]
        assert pressure.shape == run.time.shape == run.signals["valve_command"].shape
        assert np.ptp(pressure) > 2e4, experiment.title
        assert pressure.min() > 8e4
        assert pressure.max() < 4.9e5


def test_what_is_not_named_has_an_estimate_all_the_same(tmp_path: Path) -> None:
    """Of a leak that is not practically significant, and of none."""
    leak = 1e-9
    for seed, truth in ((21, {}), (22, {"chamber_leakage_lower": leak})):
        folder = tmp_path / f"{seed}"
        folder.mkdir()
        fitted, data = fitted_baseline(write_tank(folder, seed, truth))
        able, _ = identifiable(fitted, data, effects_of(data.rig))
        found = {h.parameter: h for h in still_hidden(fitted, data, able)}
        assert found["tank_volume"].estimate is None  # fitted anyway, within what is declared
        shift = found["chamber_leakage_lower"]
        assert shift.estimate is not None and shift.standard_error is not None
        assert abs(shift.estimate - truth.get("chamber_leakage_lower", 0.0)) < (
            4.0 * shift.standard_error
        )
        assert shift.standard_error < shift.size / 2.0
        if truth:
            assert leak < shift.size and shift.estimate > 2.0 * shift.standard_error
