"""The virtual cylinder obeys mechanics, its limits obey statistics, its truth stays sealed."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from validation import random_cases
from validation.twins.cylinder import detection, effects
from validation.twins.cylinder.detection import Uncertainty, detection_limit, weigh
from validation.twins.cylinder.draw import (
    _draw_effect,
    draw,
    main,
    move,
    open_truth,
    take_reading,
    take_samples,
)
from validation.twins.cylinder.motion import (
    Array,
    Cylinder,
    ExtraFriction,
    Motion,
    StrokePlan,
    simulate,
)
from validation.twins.cylinder.rig import Rig, draw_rig
from validation.twins.cylinder.sensors import (
    Samples,
    SensorErrors,
    Sensors,
    coloured_noise,
    time_stamps,
)

PLAN = StrokePlan((0.014, 0.013), (0.010, 0.011))
EVERY = (*effects.CATALOGUE, *effects.OUT_OF_CATALOGUE)
KEYS = [effect.key for effect in EVERY]
KNOWN_EXACTLY = Uncertainty(0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def rng() -> np.random.Generator:
    return random_cases.draw("twin")


@pytest.fixture(scope="module")
def rig(rng: np.random.Generator) -> Rig:
    drawn = draw_rig(rng)
    short = [
        replace(run.plan, speeds_out=run.plan.speeds_out[:2], speeds_in=run.plan.speeds_in[:2])
        for run in drawn.runs
    ]
    runs = tuple(replace(run, plan=plan) for run, plan in zip(drawn.runs, short, strict=True))
    return replace(drawn, runs=runs)


@pytest.fixture(scope="module")
def records(rig: Rig) -> list[Samples]:
    runs = [run for run in rig.runs if run.role == "identify"]
    return [take_samples(run, move(rig, run, rig.shape)) for run in runs]


@pytest.fixture(scope="module")
def motion() -> Motion:
    return simulate(Cylinder(), PLAN, 3e5)


def limit(effect: effects.Effect, rig: Rig, records: list[Samples], known: Uncertainty) -> float:
    return detection_limit(
        effect, records, rig.cylinder, rig.sensors, shape=rig.shape, uncertainty=known
    )


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


# Mechanics


@pytest.mark.parametrize("bend", [-0.5, 0.0, 0.5])
def test_at_rest_the_cell_carries_pressure_less_the_bent_seal(bend: float) -> None:
    cylinder = Cylinder()
    motion = simulate(cylinder, replace(PLAN, rest=2.0), 5e5, bristle_at_rest=bend)
    rest = motion.time < 1.9
    expected = 5e5 * cylinder.piston_area - bend * cylinder.coulomb_force
    assert np.allclose(motion.rod_force[rest], expected, atol=1e-3)
    assert np.allclose(motion.friction[rest], bend * cylinder.coulomb_force, atol=1e-3)
    assert np.max(np.abs(motion.velocity[rest])) < 1e-7
    assert np.ptp(motion.gauge_pressure[rest]) < 0.1


def test_energy_that_goes_in_is_the_heat_of_friction(motion: Motion) -> None:
    cylinder = Cylinder()

    def work(force: Array) -> float:
        return float(np.trapezoid(force * motion.velocity, motion.time))

    gas, drive = work(motion.gauge_pressure * cylinder.piston_area), work(-motion.rod_force)
    heat = work(motion.friction)
    path = float(np.trapezoid(np.abs(motion.velocity), motion.time))
    assert gas + drive == pytest.approx(heat, abs=1e-4 * heat)
    assert heat == pytest.approx(cylinder.coulomb_force * path, rel=0.05)


def test_sliding_friction_is_coulomb_plus_viscous(motion: Motion) -> None:
    cylinder = Cylinder()
    fast = np.abs(motion.velocity) > detection.SPEED_ABOVE
    steady = fast & (np.abs(motion.extension - 0.5 * cylinder.stroke) < 10e-3)
    v = motion.velocity[steady]
    expected = np.sign(v) * cylinder.coulomb_force + cylinder.viscous_friction * v
    assert np.allclose(motion.friction[steady], expected, atol=5e-3)
    balance = motion.gauge_pressure * cylinder.piston_area - motion.friction - motion.rod_force
    assert np.allclose(balance, cylinder.moving_mass * motion.acceleration, atol=1e-9)


def test_without_a_regulator_the_gas_is_polytropic() -> None:
    cylinder = Cylinder(regulator_conductance=0.0)
    motion = simulate(cylinder, PLAN, 3e5)
    volume = cylinder.line_volume + cylinder.piston_area * motion.extension
    absolute = motion.gauge_pressure + cylinder.ambient_pressure
    constant = absolute * volume**cylinder.gas_exponent
    assert np.ptp(constant) < 1e-4 * constant[0]
    assert np.ptp(absolute) > 0.1 * absolute[0]


def test_strokes_stay_inside_the_cylinder(rig: Rig, records: list[Samples]) -> None:
    for samples in records:
        assert 0.0 < np.min(samples.extension) < 4e-3
        assert 34e-3 < np.max(samples.extension) < rig.cylinder.stroke


def test_impossible_plan_is_refused() -> None:
    with pytest.raises(ValueError, match="no room"):
        simulate(Cylinder(), StrokePlan((0.2,), (0.2,), turning_time=1.0), 1e5)


# Effects and their detection limits


@pytest.mark.parametrize("key", KEYS)
def test_sensitivity_is_what_the_simulation_does(
    key: str, rig: Rig, records: list[Samples]
) -> None:
    (effect,) = effects.find(key)
    value = limit(effect, rig, records, rig.uncertainty)
    quiet = Sensors(0.0, 0.0, 1.0, 1e-9, 0.0, 1e-9, 0.0, 1e-12, 0.0, 0.0)
    silent = replace(rig, sensors=quiet)
    area = rig.cylinder.piston_area
    runs = [run for run in rig.runs if run.role == "identify"]
    extra, errors = effects.hidden(effect, value, rig.shape)
    for run, before in zip(runs, records, strict=True):
        after = before if effect.signal else take_samples(run, move(rig, run, extra))
        old = take_reading(silent, run, before, SensorErrors())
        new = take_reading(silent, run, after, errors)
        change = (new.rod_force - area * new.gauge_pressure) - (
            old.rod_force - area * old.gauge_pressure
        )
        moving = np.abs(before.velocity) > detection.SPEED_ABOVE
        expected = value * effects.sensitivity(effect, before, rig.cylinder, rig.shape)
        size = np.sqrt(np.mean(expected[moving] ** 2))
        error = np.sqrt(np.mean((change - expected)[moving] ** 2))
        assert error < 0.1 * size


@pytest.mark.parametrize("key", KEYS)
def test_limit_halves_with_the_noise(key: str, rig: Rig, records: list[Samples]) -> None:
    (effect,) = effects.find(key)
    levels = asdict(rig.sensors)
    kept = ("force_correlation_time", "spike_rate")
    half = Sensors(**{k: v if k in kept else 0.5 * v for k, v in levels.items()})
    loud = limit(effect, rig, records, KNOWN_EXACTLY)
    low = limit(effect, replace(rig, sensors=half), records, KNOWN_EXACTLY)
    assert low == pytest.approx(0.5 * loud, rel=1e-9)
    declared = limit(effect, rig, records, rig.uncertainty)
    assert declared >= loud * (1.0 - 1e-9)


def test_gain_cannot_be_told_from_a_bore_within_its_uncertainty(
    rig: Rig, records: list[Samples]
) -> None:
    (gain,) = effects.find("sensor_gain:chamber_pressure_lower")
    by_bore = 2.0 * rig.uncertainty.bore_diameter / rig.cylinder.bore_diameter
    assert limit(gain, rig, records, rig.uncertainty) > detection.SIGMAS * by_bore
    assert limit(gain, rig, records, KNOWN_EXACTLY) < 0.5 * detection.SIGMAS * by_bore


def test_weighing_is_the_inverse_of_the_noise_covariance(rng: np.random.Generator) -> None:
    time = np.cumsum(rng.uniform(0.01, 0.05, 60))
    time[30:] += 3.0
    columns = rng.standard_normal((60, 2))
    white, coloured, tau = 0.01, 0.04, 0.1
    covariance = coloured * np.exp(-np.abs(time[:, None] - time) / tau) + white * np.eye(60)
    weighed = weigh(columns, time, white, coloured, tau)
    assert np.allclose(weighed, np.linalg.solve(covariance, columns), rtol=1e-9)
    assert np.allclose(weigh(columns, time, white, 0.0, tau), columns / white)


def test_limit_is_five_times_the_scatter_of_an_estimate(
    rig: Rig, records: list[Samples], rng: np.random.Generator
) -> None:
    (offset,) = effects.find("sensor_offset:rod_force")
    sensors = replace(rig.sensors, pressure_noise=0.0, pressure_step=1e-6, force_step=1e-6)
    quiet = replace(rig, sensors=sensors)
    tau, white = sensors.force_correlation_time, sensors.force_white**2
    moving = [np.abs(samples.velocity) > detection.SPEED_ABOVE for samples in records]
    estimates = []
    for _ in range(400):
        left, right = np.zeros((2, 2)), np.zeros(2)
        for samples, fast in zip(records, moving, strict=True):
            noise = coloured_noise(samples.time, sensors.force_coloured, tau, rng)
            noise += sensors.force_white * rng.standard_normal(noise.size)
            design = np.column_stack((np.ones(noise.size), np.sign(samples.velocity)))[fast]
            weighed = weigh(design, samples.time[fast], white, sensors.force_coloured**2, tau)
            left += design.T @ weighed
            right += weighed.T @ noise[fast]
        estimates.append(np.linalg.solve(left, right)[0])
    expected = detection.SIGMAS * np.std(estimates)
    assert limit(offset, quiet, records, KNOWN_EXACTLY) == pytest.approx(expected, rel=0.2)


# Sensors


def test_noise_has_the_declared_size_and_memory(rng: np.random.Generator) -> None:
    time = np.linspace(0.0, 2000.0, 200_001)
    noise = coloured_noise(time, 0.2, 0.1, rng)
    assert np.std(noise) == pytest.approx(0.2, rel=0.05)
    assert np.mean(noise[10:] * noise[:-10]) / np.var(noise) == pytest.approx(
        np.exp(-1.0), abs=0.05
    )


def test_clock_ticks_in_milliseconds_and_runs_forward(rng: np.random.Generator) -> None:
    stamp, time = time_stamps(60.0, rng)
    steps = np.round(np.diff(stamp) * 1e3)
    assert np.min(steps) == 10.0
    assert np.max(steps) <= 17.0
    assert 0.8 < np.mean(steps < 10.5) < 0.92
    assert np.all(np.diff(time) > 0.0)
    assert np.all((time - stamp >= 0.0) & (time - stamp < 1.001e-3))


# The draw and its seal


def test_none_is_exactly_neutral(tmp_path: Path) -> None:
    draw(11, tmp_path / "records", tmp_path / "truth.json", "none")
    truth = open_truth(tmp_path / "truth.json", tmp_path / "records")
    assert truth["effect"] == "none"
    assert truth["detection_limit"] is None
    assert truth["value"] == 0.0
    assert set(truth["sensor_errors"].values()) == {0.0}
    switched = {effect.field for effect in EVERY if effect.signal is None}
    assert {truth["extra_friction"][name] for name in switched} == {0.0}
    assert ExtraFriction(**truth["extra_friction"]).bore_scratch == 0.0


def test_same_seed_same_bytes_and_same_noise_under_another_effect(tmp_path: Path) -> None:
    for name, effect in (("a", "none"), ("b", "none"), ("c", "sensor_offset:rod_force")):
        draw(12, tmp_path / name, tmp_path / f"{name}.json", effect)
    draw(13, tmp_path / "d", tmp_path / "d.json", "none")
    assert files(tmp_path / "a") == files(tmp_path / "b")
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert files(tmp_path / "a")["3_bar.csv"] != files(tmp_path / "d")["3_bar.csv"]
    assert files(tmp_path / "a")["rig.toml"] == files(tmp_path / "c")["rig.toml"]

    plain, moved = (
        np.loadtxt(tmp_path / name / "3_bar.csv", delimiter=",", skiprows=1) for name in "ac"
    )
    value = open_truth(tmp_path / "c.json", tmp_path / "c")["value"]
    assert np.array_equal(plain[:, :3], moved[:, :3])
    assert np.max(np.abs(moved[:, 3] - plain[:, 3] - value)) < 0.0155


def test_size_is_the_multiple_of_the_limit(tmp_path: Path) -> None:
    truths = []
    for multiple in (3.0, 6.0):
        draw(14, tmp_path / "r", tmp_path / "t.json", "direction_dependent_friction", multiple)
        truths.append(open_truth(tmp_path / "t.json", tmp_path / "r"))
    assert truths[1]["value"] == pytest.approx(2.0 * truths[0]["value"], rel=1e-12)
    assert abs(truths[0]["value"]) == pytest.approx(3.0 * truths[0]["detection_limit"])


def test_default_draw_covers_the_catalogue_and_nothing_else(tmp_path: Path) -> None:
    drawn = [_draw_effect(np.random.default_rng(seed), None) for seed in range(400)]
    assert {effect.key for effect, _ in drawn} == {
        "none",
        *(effect.key for effect in effects.CATALOGUE),
    }
    assert all(effect.signed or sign > 0.0 for effect, sign in drawn)
    assert {sign for effect, sign in drawn if effect.signed} == {-1.0, 1.0}


def test_records_folder_does_not_know_the_truth(tmp_path: Path) -> None:
    out, truth_path = tmp_path / "records", tmp_path / "sealed" / "truth.json"
    draw(15, out, truth_path, "position_dependent_friction")
    assert set(files(out)) == {
        "rig.toml",
        "truth.sha256",
        *(f"{bar}_bar.csv" for bar in (1, 3, 5, 7)),
    }
    text = b"".join(files(out).values()).decode()
    for word in (*(effect.id for effect in EVERY), "seed", "salt", str(truth_path)):
        assert word not in text
    truth_path.write_text(truth_path.read_text().replace("position", "pressure", 1))
    with pytest.raises(ValueError, match="not the truth"):
        open_truth(truth_path, out)


def test_truth_inside_the_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="outside"):
        draw(1, tmp_path, tmp_path / "deep" / "truth.json")
    assert not files(tmp_path)


def test_rig_file_describes_the_records(tmp_path: Path) -> None:
    draw(16, tmp_path / "records", tmp_path / "truth.json", "none")
    rig = tomllib.loads((tmp_path / "records" / "rig.toml").read_text())
    truth = open_truth(tmp_path / "truth.json", tmp_path / "records")
    roles = {record["name"]: record["role"] for record in rig["records"]}
    assert roles == {
        "1 bar": "identify",
        "3 bar": "validate",
        "5 bar": "identify",
        "7 bar": "validate",
    }
    for record in rig["records"]:
        path = tmp_path / "records" / record["file"]
        with path.open() as lines:
            header = lines.readline().strip()
        assert header == "time [s],extension [m],chamber_pressure_lower [Pa],rod_force [N]"
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        set_pressure = truth["records"][record["name"]]["pressure"]
        assert np.all(np.isfinite(table))
        assert 30.0 < table[-1, 0] < 60.0
        assert np.mean(table[:, 2]) == pytest.approx(set_pressure, abs=8e3)
    start = float(rig["parameters"]["coulomb_force"]["value"].split()[0])
    ratio = start / truth["cylinder"]["coulomb_force"]
    assert min(abs(ratio - 0.7), abs(ratio - 1.3)) < 0.01


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--effect", "leak"], "there is no effect 'leak'"),
        (["--multiple", "0"], "multiple is 0.0"),
        (["--multiple", "nan"], "multiple is nan"),
        (["--seed", "-1"], "seed is -1"),
    ],
)
def test_command_says_what_was_wrong(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = ["--out", str(tmp_path / "records"), "--truth", str(tmp_path / "truth.json")]
    assert main(["--seed", "1", *paths, *arguments]) == 2
    assert message in capsys.readouterr().err
    assert not files(tmp_path)


def test_generator_does_not_touch_the_core() -> None:
    program = (
        "import sys, validation.twins.cylinder.draw as d; "
        "sys.exit(any(name.split('.')[0] in ('sms', '_sms') for name in sys.modules))"
    )
    root = Path(__file__).resolve().parents[3]
    assert subprocess.run([sys.executable, "-c", program], cwd=root, check=False).returncode == 0
