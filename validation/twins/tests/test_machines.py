"""The generator for bench, platform and tank: seals, sizes, independence, and honest health."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from validation import random_cases
from validation.trials import scoring
from validation.trials.scoring import Outcome
from validation.twins import effects, limits
from validation.twins.__main__ import main
from validation.twins.air import Array
from validation.twins.declared import as_declared, half_width
from validation.twins.draw import (
    PAIRS,
    RIGS,
    draw,
    draw_effect,
    draw_trial,
    drawable,
    open_truth,
    pair_key,
)
from validation.twins.instruments import Channel, SensorError, disturbed, noise
from validation.twins.truth import Truth

QUICK = ["bench", "tank"]
EVERY_RIG = [*QUICK, pytest.param("platform", marks=pytest.mark.full)]


@pytest.fixture(scope="module")
def rng() -> np.random.Generator:
    return random_cases.draw("machines")


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


# The draw and its seal


@pytest.mark.parametrize("kind", EVERY_RIG)
def test_same_seed_same_bytes_and_another_effect_same_noise(kind: str, tmp_path: Path) -> None:
    for name, effect in (("a", "none"), ("b", "none"), ("c", "command_delay")):
        draw(kind, 12, tmp_path / name, tmp_path / f"{name}.json", effect)
    assert files(tmp_path / "a") == files(tmp_path / "b")
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert files(tmp_path / "a")["rig.toml"] == files(tmp_path / "c")["rig.toml"]
    assert files(tmp_path / "a")["truth.sha256"] != files(tmp_path / "c")["truth.sha256"]
    one, other = (
        np.loadtxt(next((tmp_path / name).glob("identify_1*.csv")), delimiter=",", skiprows=1)
        for name in "ac"
    )
    assert one.shape == other.shape
    assert not np.array_equal(one, other)


@pytest.mark.parametrize("kind", EVERY_RIG)
def test_records_folder_does_not_know_the_truth(kind: str, tmp_path: Path) -> None:
    out, sealed = tmp_path / "records", tmp_path / "sealed" / "truth.json"
    draw(kind, 15, out, sealed, "valve_leakage")
    text = b"".join(files(out).values()).decode()
    for word in ("seed", "salt", "leak", "hidden", "effect", str(sealed)):
        assert word not in text
    assert open_truth(sealed, out)["effects"][0]["key"] == "valve_leakage"
    sealed.write_text(sealed.read_text().replace("valve_leakage", "piston_leakage", 1))
    with pytest.raises(ValueError, match="not the truth"):
        open_truth(sealed, out)


@pytest.mark.parametrize("kind", EVERY_RIG)
def test_rig_file_describes_the_records(kind: str, tmp_path: Path) -> None:
    draw(kind, 16, tmp_path / "r", tmp_path / "t.json", "none")
    rig = tomllib.loads((tmp_path / "r" / "rig.toml").read_text())
    assert rig["rig"]["kind"] == kind
    assert [record["role"] for record in rig["records"]] == ["identify"] * 2 + ["validate"] * 2
    for record in rig["records"]:
        path = tmp_path / "r" / record["file"]
        header = path.read_text().splitlines()[0]
        names = [column.split(" [")[0] for column in header.split(",")]
        assert set(rig["signals"]) <= set(names)
        assert np.all(np.isfinite(np.loadtxt(path, delimiter=",", skiprows=1)))


def test_nothing_is_exactly_neutral_when_nothing_is_hidden() -> None:
    trial = draw_trial("bench", 11, "none", 3.0)
    assert not trial.hidden
    terms = {
        name
        for effect in effects.on("bench", (*effects.CATALOGUE, *effects.OUT_OF_CATALOGUE))
        if not effect.shifts
        for name in effect.names
    }
    assert {trial.truth.value(name) for name in terms} == {0.0}


def test_nuisances_lie_within_what_is_declared() -> None:
    for seed in range(20):
        trial = draw_trial("bench", seed, "none", 3.0)
        for entry in trial.rig.declared:
            if entry.name is not None:
                off = abs(trial.truth.value(entry.name) - entry.value)
                assert off <= entry.half_width * (1.0 + 1e-12)


def test_a_shift_lies_three_limits_beyond_the_half_width() -> None:
    for seed in range(12):
        trial = draw_trial("bench", seed, "viscous_friction", 3.0)
        (hidden,) = trial.hidden
        assert hidden.limit is not None
        beyond = abs(hidden.value) - half_width(trial.rig.declared, hidden.effect)
        assert beyond == pytest.approx(3.0 * hidden.limit)
        assert trial.truth.value("viscous_friction") == pytest.approx(530.0 + hidden.value)


@pytest.mark.parametrize("kind", sorted(RIGS))
def test_default_draw_covers_what_the_records_can_show(kind: str) -> None:
    for pair in PAIRS[kind]:
        key = pair_key(pair)
        drawn = {draw_effect(kind, key, None, np.random.default_rng(s))[0] for s in range(600)}
        assert drawn <= {effects.NONE, *drawable(kind, key)}
        assert {e.id for e in drawn} == {"none"} | {e.id for e in drawable(kind, key)}


def test_two_effects_can_be_hidden(tmp_path: Path) -> None:
    pair = ["valve_leakage", "command_delay"]
    draw("bench", 5, tmp_path / "r", tmp_path / "t.json", pair)
    truth = open_truth(tmp_path / "t.json", tmp_path / "r")
    assert [row["key"] for row in truth["effects"]] == pair


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--effect", "leak"], "has no effect 'leak'"),
        (["--multiple", "0"], "multiple is 0.0"),
        (["--seed", "-1"], "seed is -1"),
    ],
)
def test_command_says_what_was_wrong(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = ["--out", str(tmp_path / "records"), "--truth", str(tmp_path / "truth.json")]
    assert main(["draw", "bench", "--seed", "1", *paths, *arguments]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "records").exists()


def test_truth_inside_the_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="outside"):
        draw("bench", 1, tmp_path, tmp_path / "deep" / "truth.json")


def test_generator_does_not_touch_the_core() -> None:
    program = (
        "import sys, validation.twins.__main__; "
        "sys.exit(any(name.split('.')[0] in ('sms', '_sms') for name in sys.modules))"
    )
    root = Path(__file__).resolve().parents[3]
    assert subprocess.run([sys.executable, "-c", program], cwd=root, check=False).returncode == 0


# Physics


@pytest.mark.parametrize("excited_by", ["multisine", "holds", "triangle"])
def test_healthy_bench_is_what_the_source_says(excited_by: str) -> None:
    """Over stretches of a second, within a third of the noise of the second writing of the plant."""
    from sms import Params  # noqa: PLC0415  the generator itself does without

    from validation.reference.plants import bench as plant  # noqa: PLC0415

    rig = RIGS["bench"]
    truth = draw_trial("bench", 21, "none", 3.0).truth
    plan = rig.plan(excited_by, np.random.default_rng(3))
    quiet = {signal: np.zeros(plan.feedforward.size) for signal in rig.signals}
    measured = rig.measure(truth, plan, quiet)
    same = {d.parameter: truth.value(d.name) for d in rig.declared if d.name is not None}
    params = Params(
        control_period=1e-3,
        stiction_velocity=0.5 * np.pi * truth.machine.creep_velocity,
        stribeck_acceleration_factor=0.0,
        exponential_friction_force=0.0,
        **same,
    )
    for first in (200, 1000):
        s = measured.states[first]
        air = truth.machine.air_temperature
        start = np.array(
            [s[0], s[1], s[2], air, s[3], air, s[7], s[8], 5.0, 0.0, 0.0, same["supply_pressure"]]
        )
        times = rig.sample_step * first + 1e-3 * (np.arange(1001) + 0.5)
        knots = rig.sample_step * np.arange(plan.feedforward.size)
        commands = np.interp(times, knots, measured.commands["valve_command"])
        states = plant.simulate(params, start, commands, tolerance=1e-7)[::5]
        twin = measured.states[first : first + 201]
        for column, own, deviation in ((0, 0, 71e-6), (2, 2, 280.0), (4, 3, 280.0)):
            off = np.sqrt(np.mean((states[:, column] - twin[:, own]) ** 2))
            assert off < 0.35 * deviation


@pytest.mark.full
def test_healthy_platform_is_what_the_source_says() -> None:
    from sms import Params  # noqa: PLC0415

    from validation.reference.plants import platform as plant  # noqa: PLC0415

    trial = draw_trial("platform", 21, "none", 3.0)
    rig, truth = trial.rig, trial.truth
    plan = rig.plan("multisine", np.random.default_rng(3))
    quiet = {signal: np.zeros(len(plan.feedforward)) for signal in rig.signals}
    measured = rig.measure(truth, plan, quiet)
    same = {d.parameter: truth.value(d.name) for d in rig.declared if d.name is not None}
    params = Params(
        control_period=1e-3,
        stiction_velocity=0.5 * np.pi * truth.machine.creep_velocity,
        stribeck_acceleration_factor=0.0,
        exponential_friction_force=0.0,
        **same,
    )
    first, air = 400, truth.machine.air_temperature
    state = measured.states[first]
    start = [*state[:6]]
    for i in range(3):
        lower, upper, _, _, _, spool, rate, _, _ = state[6 + 9 * i : 15 + 9 * i]
        start += [lower, air, upper, air, spool, rate, 5.0, 0.0, 0.0, same["supply_pressure"]]
    times = rig.sample_step * first + 1e-3 * (np.arange(1001) + 0.5)
    knots = rig.sample_step * np.arange(len(plan.feedforward))
    commands = np.column_stack(
        [np.interp(times, knots, measured.commands[name]) for name in rig.commands]
    )
    states = plant.simulate(params, np.array(start), commands, tolerance=1e-7)[::5]
    twin = measured.states[first : first + 201]
    columns = [(0, 0, 160e-6), (1, 1, 160e-6), (6, 6, 280.0), (18, 16, 280.0), (28, 25, 280.0)]
    for column, own, deviation in columns:
        off = np.sqrt(np.mean((states[:, column] - twin[:, own]) ** 2))
        assert off < 0.35 * deviation


def at_its_ends(truth: Truth) -> Array:
    """What the sensors of a bench read between its ends, without noise; a column for each."""
    rig = RIGS["bench"]
    plan = rig.plan("ends", np.random.default_rng(1))
    quiet = {signal: np.zeros(plan.feedforward.size) for signal in rig.signals}
    return np.column_stack([*rig.measure(truth, plan, quiet).signals.values()])


@pytest.fixture(scope="module")
def healthy() -> Array:
    return at_its_ends(as_declared(Truth(), RIGS["bench"].declared))


@pytest.mark.parametrize("key", [e.key for e in effects.on("bench") if e is not effects.NONE])
def test_every_effect_changes_the_records_and_its_neutral_value_nothing(
    key: str, healthy: Array
) -> None:
    (effect,) = [e for e in effects.on("bench") if e.key == key]
    truth = as_declared(Truth(), RIGS["bench"].declared)
    size = effect.drawn_from[0] if effect.drawn_from else 3.0 * effect.first_step
    assert not np.array_equal(healthy, at_its_ends(effect.hidden_in(truth, effect.sense * size)))
    if not effect.shifts:
        assert np.array_equal(healthy, at_its_ends(effect.hidden_in(truth, 0.0)))


# Instruments


def test_lag_and_skew_are_what_they_are_called() -> None:
    time = 1e-3 * np.arange(20_001)
    wave = np.sin(2.0 * np.pi * 2.0 * time)
    late = disturbed(wave, 1e-3, 5, SensorError(skew=0.03))
    assert np.allclose(late[100:], np.sin(2.0 * np.pi * 2.0 * (time[::5][100:] - 0.03)), atol=1e-4)
    lagging = disturbed(wave, 1e-3, 5, SensorError(lag=0.02))
    answer = 1.0 / (1.0 + 2j * np.pi * 2.0 * 0.02)
    expected = np.imag(answer * np.exp(2j * np.pi * 2.0 * time[::5]))
    assert np.allclose(lagging[400:], expected[400:], atol=1e-4)
    constant = disturbed(np.full(101, 7.0), 1e-3, 5, SensorError(lag=0.02))
    assert np.allclose(constant, 7.0, rtol=1e-12)


def test_noise_has_the_size_it_declares(rng: np.random.Generator) -> None:
    channel = Channel("Pa", 250.0, 100.0, 0.05, 244.0)
    values = noise(channel, 200_000, 5e-3, rng)
    assert np.std(values) == pytest.approx(np.hypot(250.0, 100.0), rel=0.03)


def test_limit_is_where_the_effect_is_seen() -> None:
    rig = RIGS["tank"]
    found = limits.Limits(rig, [rig.plan("strokes", np.random.default_rng(1))], every=3)
    (offset,) = effects.find("tank", "valve_leakage")
    limit = found.limit(offset)
    assert limit is not None
    assert found.seen(offset, limit) == pytest.approx(1.0, rel=0.3)
    assert found.seen(offset, 2.0 * limit) == pytest.approx(2.0, rel=0.4)


@pytest.mark.parametrize("kind", sorted(RIGS))
def test_tables_of_limits_know_every_effect(kind: str) -> None:
    for pair in PAIRS[kind]:
        rows = limits.read(kind)[pair_key(pair)]
        every = effects.on(kind, (*effects.CATALOGUE, *effects.OUT_OF_CATALOGUE, *effects.GEOMETRY))
        assert set(rows) == {effect.key for effect in every if effect.drawn_from is None}


# Scores


def outcome(hidden: tuple[str, ...], verdict: str, *named: tuple[str, ...]) -> Outcome:
    outside = {effect.key for effect in effects.OUT_OF_CATALOGUE}
    sort = "catalogue" if hidden else "healthy"
    sort = "outside" if set(hidden) & outside else "pair" if len(hidden) > 1 else sort
    values = [1.0] * len(hidden)
    return Outcome("bench", 1, sort, 3.0, list(hidden), values, verdict, [list(n) for n in named])


@pytest.mark.parametrize(
    ("hidden", "verdict", "named", "right", "wrong_name"),
    [
        ((), "no-evidence", [], True, False),
        ((), "cause", [("tube",)], False, True),
        (("tube",), "cause", [("tube",)], True, False),
        (("tube",), "class", [("supply_droop", "tube")], True, False),
        (("tube",), "class", [("a", "b", "c", "tube")], False, False),
        (("tube",), "cause", [("supply_droop",)], False, True),
        (("tube",), "unknown", [], False, False),
        (("bent_rod",), "unknown", [], True, False),
        (("bent_rod",), "cause", [("tube",)], False, True),
        (("tube", "valve_leakage"), "cause", [("tube",)], True, False),
        (("tube", "valve_leakage"), "combination", [("tube",), ("spool_lag",)], False, True),
    ],
)
def test_scores(
    hidden: tuple[str, ...],
    verdict: str,
    named: list[tuple[str, ...]],
    right: bool,
    wrong_name: bool,
) -> None:
    scored = outcome(hidden, verdict, *named)
    assert scored.right is right
    assert scored.wrong_name is wrong_name


def test_an_interrupted_series_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "outcomes.jsonl"
    done = [outcome(("tube",), "cause", ("tube",)), outcome((), "no-evidence")]
    lines = [json.dumps(asdict(one)) for one in done]
    path.write_text("\n".join([*lines, lines[0][:-3]]))
    assert scoring.load(path) == done
    (right, *_rest) = scoring.goals(done)
    assert right.share == 1.0
