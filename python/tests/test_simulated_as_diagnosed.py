"""A machine simulated with extended.toml is the one that the diagnosis calls extended, window by window."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from plant_support import EVERY, NOISE, write_bench
from sms import Params, _core, simulate_bench, simulate_tank
from sms.io import Declaration, load_record, load_rig, write_extended_rig
from sms.scenario import load_scenario
from sms.simulation import Run

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
Array = NDArray[np.float64]

PERIOD = 1e-3
STEP = EVERY * PERIOD
"""s between two samples of the records."""
RANGE = {"extension": 0.4, "chamber_pressure": 5e5, "tank_pressure": 5e5, "tank_temperature": 300.0}
SAME = 1e-9
"""Of the range."""

EXTENSIONS: dict[str, dict[str, float]] = {
    "presliding": {"presliding_share": 0.6, "bristle_stiffness": 2e5},
    "friction_lag": {"friction_lag": 0.05},
    "heat": {"heat_share": 0.8, "heat_transfer_coefficient": 60.0},
    "mount": {"frame_compliance": 5e-6},
    "gain and zero": {"sensor_gain_extension": 0.05, "sensor_offset_chamber_pressure_lower": 2e3},
    "lag": {"sensor_lag_extension": 0.02, "sensor_lag_chamber_pressure_upper": 4e-4},
    "clock": {"clock_skew_extension": 3.0 * STEP, "clock_skew_chamber_pressure": -STEP},
    "supply": {"supply_line_resistance": 1e6, "piston_leakage": 1e-9},
    "play": {"backlash": 2e-3},
    "everything": {
        "presliding_share": 0.3,
        "friction_lag": 0.02,
        "heat_share": 0.5,
        "frame_compliance": 2e-6,
        "sensor_gain_chamber_pressure_upper": 0.1,
        "sensor_lag_extension": 0.01,
        "mass_flow_gain": 1.4,
    },
}


def largest(readings: Array, predicted: Array, late: int) -> float:
    """The largest difference; a clock that is late by so many samples has each sample that much later."""
    n = len(predicted)
    first, last = max(0, -late), min(n, n - late)
    return float(np.max(np.abs(readings[first + late : last + late] - predicted[first:last])))


def predicted(
    problem: _core.BenchProblem, params: Params, record: dict[str, Array], window: int
) -> dict[str, Array]:
    """What the problem predicts of a window, as it says how far that is from the record at the best initial state."""
    w = problem.windows[window]
    rows = problem.evaluate(params)[0][w.row : w.row + w.rows].reshape(w.samples, -1)
    out = {}
    for k, (name, noise) in enumerate(NOISE.items()):
        late = late_samples(params, name)
        samples = w.first + np.arange(w.samples) + late
        inside = (samples >= 0) & (samples < len(record[name]))
        measured = np.where(
            inside, record[name][np.clip(samples, 0, len(record[name]) - 1)], np.nan
        )
        out[name] = rows[:, k] * noise + measured
    return out


def first_record(path: Path) -> dict[str, Array]:
    rig = load_rig(path)
    return dict(load_record(rig, rig.records[0]).signals)


def late_samples(params: Params, signal: str) -> int:
    clock = "extension" if signal == "extension" else "chamber_pressure"
    return round(params[f"clock_skew_{clock}"] / STEP)


@pytest.mark.parametrize("effect", list(EXTENSIONS))
def test_a_bench_simulated_with_extended_toml_is_what_the_diagnosis_calls_extended(
    effect: str, tmp_path: Path
) -> None:
    rig = write_bench(tmp_path, 1, {})
    found = {name: Declaration(value, 0.0) for name, value in EXTENSIONS[effect].items()}
    extended = tmp_path / "extended.toml"
    write_extended_rig(rig, extended, found, "as a diagnosis writes it")
    params = load_rig(extended).start()
    record = first_record(rig)

    problem = _core.BenchProblem(
        records=[
            _core.BenchRecord(
                step=STEP,
                command=record["valve_command"],
                extension=record["extension"],
                pressure_lower=record["chamber_pressure_lower"],
                pressure_upper=record["chamber_pressure_upper"],
                hold="previous",
            )
        ],
        noise=NOISE | {"supply_pressure": 1e3},
    )
    window = 1
    said = predicted(problem, params, record, window)
    w = problem.windows[window]
    command = np.repeat(record["valve_command"][w.first : w.first + w.samples], EVERY)
    run = simulate_bench(
        command, params=params, state=problem.state(params, window), step=PERIOD, stiff=True
    )
    begins = 0
    if "backlash" in EXTENSIONS[effect]:
        # Where the sensor rests in its play is not known where a simulation begins, until the rod has taken it along.
        travel = np.abs(run["extension"][::EVERY] - run["extension"][0])
        begins = int(np.argmax(travel > params.backlash)) + 1
    for name, values in said.items():
        off = largest(
            run.reading(name)[::EVERY][begins:], values[begins:], late_samples(params, name)
        )
        assert off < SAME * RANGE[name.removesuffix("_lower").removesuffix("_upper")], name


def test_a_tank_simulated_is_what_the_problem_predicts() -> None:
    truth = Params(
        heat_share=0.7,
        chamber_leakage_lower=2e-9,
        sensor_lag_tank_pressure=0.01,
        thermocouple_time_constant=0.3,
        sensor_gain_tank_temperature=0.1,
        supply_line_resistance=1e6,
        tank_initial_pressure=2e5,
        tank_pressure_floor=1.9e5,
    )
    n = 400
    command = 5.0 + 1.6 * np.sin(0.021 * np.arange(n)) * np.sin(0.009 * np.arange(n))
    first: Run = simulate_tank(np.repeat(command, EVERY), params=truth)
    record = {s: first.reading(s)[::EVERY] for s in ("tank_pressure", "tank_temperature")}
    noise = {"tank_pressure": 300.0, "tank_temperature": 0.1, "supply_pressure": 300.0}
    problem = _core.TankPlantProblem(
        records=[
            _core.TankPlantRecord(
                step=STEP,
                command=command,
                pressure=record["tank_pressure"],
                temperature=record["tank_temperature"],
                hold="previous",
            )
        ],
        noise=noise,
    )
    w = problem.windows[0]
    rows = problem.evaluate(truth)[0][w.row : w.row + w.rows].reshape(w.samples, -1)
    run = simulate_tank(
        np.repeat(command[w.first : w.first + w.samples], EVERY),
        params=truth,
        state=problem.state(truth, 0),
        step=PERIOD,
        stiff=True,
    )
    pressure = (
        rows[:, 0] * noise["tank_pressure"] + record["tank_pressure"][w.first : w.first + w.samples]
    )
    assert np.max(np.abs(run.reading("tank_pressure")[::EVERY] - pressure)) < SAME * 5e5
    assert np.max(np.abs(rows)) < 1.0  # and both are the record's own machine


def test_a_scenario_takes_the_parameters_of_extended_toml(tmp_path: Path) -> None:
    rig = write_bench(tmp_path, 1, {})
    found = {name: Declaration(value, 0.0) for name, value in EXTENSIONS["everything"].items()}
    write_extended_rig(rig, tmp_path / "extended.toml", found, "as a diagnosis writes it")
    scenario = tmp_path / "run.toml"
    scenario.write_text(
        '[scenario]\nplant = "bench"\nduration = "1 s"\n\n[rig]\nfile = "extended.toml"\n\n'
        '[controller]\nkind = "open_loop"\n\n'
        '[excitation]\nkind = "sine"\namplitude = "0.54 V"\nfrequency = "1 Hz"\n'
    )
    assert load_scenario(scenario).params == load_rig(tmp_path / "extended.toml").start()
