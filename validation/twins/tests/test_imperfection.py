"""Machines that are off from what can be declared: sizes, smoothness, streams of their own, and what level 0 leaves."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms.diagnosis.pipeline import read_and_check
from sms.estimation.run import make_run
from sms.io.rig import load_rig
from sms.parameters import PARAMETERS

from validation import random_cases
from validation.twins import imperfection
from validation.twins.air import GRID_POINTS, GRID_STEP, Array, edges, valve_map
from validation.twins.clock import holding
from validation.twins.declared import FLOW_MAP
from validation.twins.draw import RIGS, draw, draw_trial, open_truth, seeds_of
from validation.twins.imperfection import (
    OPENING,
    SPEED,
    bowed,
    draw_imperfection,
    draw_smooth,
    rms_over,
)
from validation.twins.instruments import CHANNELS, converted
from validation.twins.machine import Machine
from validation.twins.maps import exact, off_by
from validation.twins.seal import friction
from validation.twins.truth import Truth

KINDS = ["bench", "tank", pytest.param("platform", marks=pytest.mark.full)]


@pytest.fixture(scope="module")
def rng() -> np.random.Generator:
    return random_cases.draw("imperfection")


@pytest.mark.parametrize("kind", KINDS)
def test_level_0_is_the_machine_that_has_no_imperfection(kind: str, tmp_path: Path) -> None:
    """The plain rig, the plain maps, and the streams that everything was drawn from before there was one more."""
    for name, level in (("a", {}), ("b", {"imperfection": 0.0})):
        draw(kind, 2, tmp_path / name, tmp_path / f"{name}.json", "none", **level)
    one, other = ({p.name: p.read_bytes() for p in (tmp_path / n).iterdir()} for n in "ab")
    assert one == other
    assert "imperfection" not in open_truth(tmp_path / "b.json", tmp_path / "b")
    trial = draw_trial(kind, 2, "none", 3.0, 0.0)
    assert trial.rig is RIGS[kind] and trial.truth.maps is None
    before = np.random.SeedSequence(2).spawn(6)
    assert [s.spawn_key for s in seeds_of(2)[:6]] == [s.spawn_key for s in before]
    assert seeds_of(2)[6].spawn_key not in [s.spawn_key for s in before]


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_else_of_a_trial_depends_on_the_imperfection(kind: str, tmp_path: Path) -> None:
    plain, off = (draw_trial(kind, 3, "command_delay", 3.0, level) for level in (0.0, 2.0))
    assert plain.truth.imperfection is None
    assert replace(off.truth, imperfection=None) == plain.truth
    assert (off.hidden, off.runs, off.loudness) == (plain.hidden, plain.runs, plain.loudness)


def nothing(x: Array) -> Array:
    return np.zeros(x.shape)


def test_maps_that_are_off_by_nothing_are_the_exact_ones() -> None:
    maps = off_by(nothing, nothing, nothing)
    assert np.array_equal(maps.valve, exact().valve)
    assert np.array_equal(maps.friction, exact().friction)


def test_a_smooth_error_has_its_size_and_is_smooth(rng: np.random.Generator) -> None:
    for between in (OPENING, SPEED):
        low, high, length = between
        level = float(rng.uniform(0.002, 0.05))
        slopes = []
        for _ in range(20):
            function = draw_smooth(level, between, rng)
            assert rms_over(function, between) == pytest.approx(level, rel=1e-9)
            x = np.linspace(low, high, 2001)
            slopes.append(np.sqrt(np.mean(np.gradient(function(x), x) ** 2)))
        # A Gaussian process of this length has slopes of level / length. One that happens to be small between the ends
        # is scaled up with its slopes: hence the median.
        assert np.median(slopes) == pytest.approx(level / length, rel=0.4)


def test_every_edge_of_the_valve_is_off_by_its_own_error() -> None:
    """As the plant reads it: charge and discharge, above and below the centre."""
    off = draw_imperfection(2.0, 1, ("extension",), (0.005,), seeds_of(5)[6])
    p, (axis,) = Machine(), off.axes
    volts = np.arange(0.5, 2.5, 0.01)
    for sign in (1.0, -1.0):
        found, right = (
            np.array([edges(p, 0.0, valve, p.valve_centre + sign * u) for u in volts])
            for valve in (off.maps.valve, exact(axis.straight).valve)
        )
        for column, error in ((1, axis.charge), (4, axis.discharge)):
            ratio = found[:, column] / right[:, column] - 1.0
            assert np.allclose(ratio, error(sign * volts), atol=1e-5)
        assert np.array_equal(found[:, [2, 3, 5]], right[:, [2, 3, 5]])
    assert np.array_equal(exact().valve[0], valve_map())


def test_tables_are_read_straight_between_rows_or_by_a_curve_and_alike_at_the_rows() -> None:
    drawn = {
        draw_imperfection(1.0, 1, ("extension",), (0.005,), seeds_of(k)[6]).axes[0].straight
        for k in range(20)
    }
    assert drawn == {True, False}
    steps = GRID_STEP * np.arange(GRID_POINTS)
    rows = np.arange(56, 400)
    for column in (0, 3):
        curve, straight = (valve_map(s)[:, column] for s in (False, True))
        assert np.interp(0.930, steps, straight) == pytest.approx(np.interp(0.930, steps, curve))
        assert np.max(np.abs(straight[rows] / curve[rows] - 1.0)) > 0.03
    linear = np.interp(0.62, (0.559, 0.680), (0.413153e-9, 0.954101e-9))
    assert np.interp(0.62, steps, valve_map(True)[:, 0]) == pytest.approx(linear)


def test_sliding_friction_is_off_by_its_error() -> None:
    off = draw_imperfection(2.0, 1, ("extension",), (0.005,), seeds_of(6)[6])
    speeds = np.array([-0.25, -0.1, 0.05, 0.2])

    def force(over_speed: Array) -> Array:
        rest = (0.2, 2e5, 2e5, np.zeros(2), np.zeros(2))
        return np.array(
            [friction(Machine(), over_speed, 0.0, rest[0], v, *rest[1:]) for v in speeds]
        )

    ratio = force(off.maps.friction) / force(exact().friction) - 1.0
    assert np.allclose(ratio, off.axes[0].friction(speeds), atol=1e-6)


def test_a_bow_leaves_the_best_straight_line_by_its_size() -> None:
    reading = np.linspace(86e3, 486e3, 2001)
    deviation = bowed("chamber_pressure_lower_2", reading, 1e-3) - reading
    # Of all straight lines the one with the least largest deviation is the axis itself (Chebyshev).
    assert deviation.max() == pytest.approx(400.0) and deviation.min() == pytest.approx(-400.0)
    assert deviation[0] == pytest.approx(deviation[-1])
    for slope in (-1e-3, 1e-3):
        tilted = deviation - slope * (reading - 286e3)
        assert 0.5 * np.ptp(tilted) > 400.0


def test_a_converter_may_round_down() -> None:
    channel = CHANNELS["extension"]
    values = np.linspace(-0.1, 0.4, 5001)
    nearest, down = converted(channel, values), converted(channel, values, rounds_down=True)
    assert np.abs(nearest - values).max() <= 0.5001 * channel.step
    assert np.all(down <= values + 1e-12) and (values - down).max() <= 1.0001 * channel.step


def test_level_only_scales(rng: np.random.Generator) -> None:
    seed = int(rng.integers(10**6))
    one, two = (
        draw_imperfection(
            p, 1, ("extension", "roll", "supply_pressure"), (0.01, 0.005), seeds_of(seed)[6]
        )
        for p in (1.0, 2.0)
    )
    x = np.linspace(-2.0, 2.0, 41)
    assert np.allclose(2.0 * one.axes[0].charge(x), two.axes[0].charge(x))
    assert not np.allclose(one.axes[0].charge(x), one.axes[0].discharge(x))
    assert set(one.bows) == {"extension", "roll"}  # a supply's would be a zero that is off
    assert {s: 2.0 * b for s, b in one.bows.items()} == pytest.approx(two.bows)
    assert (one.log_step, one.control_period, one.rounds_down) == (
        two.log_step, two.control_period, two.rounds_down,
    )  # fmt: skip


@pytest.mark.parametrize("kind", ["bench", "tank"])
def test_a_finely_held_command_is_the_straight_one(kind: str) -> None:
    """Held for half a millisecond of a command that runs straight, against that command: the same motion."""
    plain = RIGS[kind]
    fine = type(plain)(holding(1e-3, 0.25e-3), plain.sample_step)  # type: ignore[call-arg]
    truth = Truth()
    name = "holds" if kind == "bench" else "strokes"
    found = []
    for rig in (plain, fine):
        plan = rig.plan(name, np.random.default_rng(4))
        quiet = np.zeros(round(rig.duration / rig.clock.period) + 1)
        found.append(rig.measure(truth, plan, dict.fromkeys(rig.signals, quiet)))
    first = plain.signals[0]
    a, b = (m.signals[first] for m in found)
    assert a.shape == b.shape
    # Half a millisecond late on average, at a quarter of a metre and at some bar a second.
    assert np.abs(a - b).max() < {"bench": 2e-3, "tank": 2e3}[kind]


@pytest.mark.parametrize("kind", KINDS)
def test_a_held_command_logged_slowly_is_read(kind: str, tmp_path: Path) -> None:
    """At 100 Hz, by a controller of 100 Hz and by one of 1 kHz: what the diagnosis' reader makes of it."""
    steps = RIGS[kind].log_steps
    drawn = {
        off.control_period: seed
        for seed in range(100)
        if (off := draw_imperfection(1.0, 1, ("a",), steps, seeds_of(seed)[6])).log_step == 0.01
    }
    assert set(drawn) == {0.01, 1e-3}
    for period, seed in drawn.items():
        out, sealed = tmp_path / str(seed), tmp_path / f"{seed}.json"
        draw(kind, seed, out, sealed, "none", imperfection=1.0)
        assert open_truth(sealed, out)["imperfection"]["control_period"] == period
        rig = load_rig(out / "rig.toml")
        records, findings = read_and_check(rig)
        assert not [f for f in findings if f.severity == "error"]
        runs = [make_run(rig, record) for record in records]
        assert [run.step for run in runs] == pytest.approx([0.01] * 4)
        assert {run.hold for run in runs} == {"previous" if period == 0.01 else "stepped"}


def test_the_folder_does_not_know_how_the_machine_is_off(tmp_path: Path) -> None:
    draw("tank", 15, tmp_path / "r", tmp_path / "t.json", "none", imperfection=2.0)
    text = (tmp_path / "r" / "rig.toml").read_text()
    for word in ("imperfect", "bow", "rounds", "level"):
        assert word not in text
    sealed = json.loads((tmp_path / "t.json").read_text())["imperfection"]
    assert sealed["level"] == pytest.approx(0.02)
    assert {abs(b) for b in sealed["bows"].values()} == {imperfection.BOW * 0.02}


def test_a_level_beyond_reason_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="imperfection is 40"):
        draw("tank", 1, tmp_path / "r", tmp_path / "t.json", "none", imperfection=40.0)


def test_a_trial_takes_the_valve_s_map_to_be_known_as_the_core_does() -> None:
    """It took it to be known to 3 % at every opening, and hid what 15 % near the first one imitate."""
    knots = [PARAMETERS[f"flow_map_feed_lower_{n}"] for n in range(1, len(FLOW_MAP) + 1)]
    at = [float(k.doc.rpartition("opening of ")[2].split()[0]) for k in knots]
    assert dict(zip(at, (k.uncertainty for k in knots), strict=True)) == FLOW_MAP
    opening = np.array([0.3, -0.675, 1.1, 5.0])
    modes = imperfection.map_modes(FLOW_MAP, 1)
    assert len(modes) == 4 * len(FLOW_MAP)
    together = sum(np.asarray(m.axes[0].charge(opening)) for m in modes)
    np.testing.assert_allclose(together, [0.15, 0.11, 0.04, 0.03])
