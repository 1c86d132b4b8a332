"""Deck motions, seas and excitations: identities, limits, and what a person gets told."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sms
from numpy.typing import NDArray
from scipy.signal import welch
from sms.io import InputError, write_table
from sms.motion import (
    SEA_STATES,
    DeckMotion,
    Ship,
    aprbs,
    band_limited,
    chirp,
    demand_of,
    faded,
    fitted,
    froude_scaled,
    jonswap,
    limits_of,
    part,
    read_deck_motion,
    resampled,
    sine,
    speed_limits,
    steady_motion,
    steps,
    synthetic_deck_motion,
)
from sms.motion.sea import response
from sms.workspace_survey import DEGREE

from validation.random_cases import draw

CHIRP = Path(__file__).parents[2] / "../shared/reference/components/chirp.json"


def rolling(degrees: float, frequency: float = 0.15, duration: float = 40.0) -> DeckMotion:
    time: NDArray[np.float64] = 0.02 * np.arange(duration / 0.02 + 1.0)
    roll = degrees * DEGREE * np.sin(2.0 * np.pi * frequency * time)
    rest = np.zeros(time.size)
    return faded(DeckMotion(time, roll, rest, rest, "a sine"), 4.0)


# ---- records ----


def test_units_and_names_of_columns(tmp_path: Path) -> None:
    time = np.linspace(0.0, 10.0, 101)
    roll, pitch, heave = np.sin(time), 0.5 * np.cos(time), 0.2 * time
    columns = {"Zeit [ms]": 1e3 * time, "Roll angle [deg]": roll, "p": pitch, "z [mm]": heave}
    write_table(tmp_path / "deck.csv", columns)
    motion = read_deck_motion(
        tmp_path / "deck.csv",
        {"time": "Zeit", "roll": "Roll angle [deg]", "pitch": "p", "heave": "z"},
        {"pitch": "rad"},
    )
    assert motion.time == pytest.approx(time)
    assert motion.roll == pytest.approx(roll * DEGREE)
    assert motion.pitch == pytest.approx(pitch) and motion.heave == pytest.approx(1e-3 * heave)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"time": "time", "roll": "rool"}, "did you mean 'roll'"),
        ({"time": "time", "roll": "bare"}, 'roll_unit = "rad"'),
        ({"time": "time", "roll": "text"}, "line 4, roll: 'oops' is not a number"),
        ({"time": "back", "roll": "roll"}, "time must rise"),
        ({"time": "time", "roll": "length"}, "does not fit"),
        ({"roll": "roll"}, "the column of the time is missing"),
    ],
)
def test_a_bad_record_is_named(tmp_path: Path, columns: dict[str, str], said: str) -> None:
    rows = "\n".join(f"{0.1 * i},{0.01 * i},{i},{9 - i},{i}" for i in range(12))
    header = "time [s],roll [deg],bare,back [s],length [m],text [deg]\n"
    cells = [f"{line},{'oops' if i == 2 else i}" for i, line in enumerate(rows.splitlines())]
    (tmp_path / "deck.csv").write_text(header + "\n".join(cells) + "\n")
    with pytest.raises(InputError, match="deck") as problem:
        read_deck_motion(tmp_path / "deck.csv", columns)
    assert said in str(problem.value)


def test_froude_keeps_angles_and_scales_time_and_lengths() -> None:
    motion = replace(rolling(5.0), heave=np.ones(2001))
    big = froude_scaled(motion, 40.0)
    assert big.roll is motion.roll and big.heave[3] == 40.0
    assert big.duration == pytest.approx(np.sqrt(40.0) * motion.duration)
    # Rates fall by sqrt(scale), linear accelerations stay: that is Froude's law.
    assert big.rates(1)[:, 0] == pytest.approx(motion.rates(1)[:, 0] / np.sqrt(40.0), abs=1e-9)


def test_the_band_keeps_what_is_in_it() -> None:
    time: NDArray[np.float64] = 0.01 * np.arange(20001.0)
    slow, fast = np.sin(2.0 * np.pi * 0.2 * time), np.sin(2.0 * np.pi * 5.0 * time)
    rest = np.zeros(time.size)
    limited = band_limited(DeckMotion(time, slow + fast, slow, rest, "two sines"), 0.0, 1.0)
    middle = slice(2000, -2000)
    assert limited.roll[middle] == pytest.approx(slow[middle], abs=2e-3)
    high = band_limited(DeckMotion(time, slow + fast, rest, rest, "two sines"), 1.0, np.inf)
    assert high.roll[middle] == pytest.approx(fast[middle], abs=2e-3)


def test_a_fade_over_no_time_to_speak_of_leaves_the_motion() -> None:
    time = 0.01 * np.arange(2000)
    motion = DeckMotion(time, np.sin(time), np.cos(time), 0.0 * time, "a sine and a cosine")
    with np.errstate(over="raise"):
        led = faded(motion, 1e-308)
    assert np.array_equal(led.pitch[1:-1], motion.pitch[1:-1])
    assert led.pitch[0] == led.pitch[-1] == 0.0


@pytest.mark.parametrize(("low", "high"), [(1e-308, 1.0), (0.0, 1e-300), (1e-9, np.inf)])
def test_an_edge_far_below_the_sampling_rate_is_refused(low: float, high: float) -> None:
    time = 0.01 * np.arange(2000)
    with pytest.raises(InputError, match="too low for a filter"):
        band_limited(DeckMotion(time, 0.0 * time, 0.0 * time, 0.0 * time, "rest"), low, high)


def test_resampling_and_taking_a_part() -> None:
    motion = rolling(5.0)
    again = resampled(resampled(motion, 0.005), 0.02)
    assert again.roll == pytest.approx(motion.roll, abs=1e-12)
    taken = part(motion, 10.0, 20.0)
    assert taken.duration == pytest.approx(10.0) and taken.roll[0] == motion.roll[500]
    with pytest.raises(InputError, match="less than 8 samples"):
        part(motion, 100.0, 110.0)


# ---- what the platform can do ----


def test_a_steady_speed_balances_the_core_s_own_equations() -> None:
    params = sms.Params()
    found = steady_motion(7.0, 1042.5, params=params)
    held = sms.rod_force(
        found.velocity, 0.0, None, found.chamber_pressure_lower, found.chamber_pressure_upper
    )
    assert held == pytest.approx(1042.5, abs=1e-3) and found.mass_flow > 0.0
    limits = speed_limits(1042.5)
    # Published: 0.1 m/s per V at 5 V (section 8.1); downwards the weight helps.
    assert 0.09 < limits.up / 5.0 < 0.13 and limits.down > limits.up


def test_no_steady_speed_against_too_much_load() -> None:
    with pytest.raises(ValueError, match="no steady speed"):
        steady_motion(10.0, 4000.0)


def test_what_fits_is_left_alone() -> None:
    limits = limits_of(sms.Params(), 0.5)
    motion = rolling(5.0)
    for beyond in ("refuse", "clip", "scale"):
        same = fitted(motion, limits, beyond, "here")  # type: ignore[arg-type]
        assert same.motion is motion and not same.cuts


def test_too_much_roll_is_refused_clipped_or_scaled() -> None:
    limits = limits_of(sms.Params(), 0.5)
    motion = rolling(9.5)
    with pytest.raises(InputError, match=r"\[deck_motion\] roll: roll -?9.5°.*mm is allowed"):
        fitted(motion, limits, "refuse", "[deck_motion] roll")
    clipped, scaled = (fitted(motion, limits, beyond, "") for beyond in ("clip", "scale"))  # type: ignore[arg-type]
    for feasible in (clipped, scaled):
        assert feasible.demand.stroke_excess(limits).max() < 1e-6
        assert feasible.cuts[0].limit == "stroke" and "9.5°" in feasible.cuts[0].sentence
    # Clipping leaves what is inside; scaling makes all of it smaller by one factor.
    inside = np.abs(motion.roll) < 6.0 * DEGREE
    assert np.array_equal(clipped.motion.roll[inside], motion.roll[inside])
    moving = np.abs(motion.roll) > 1e-3
    ratio = scaled.motion.roll[moving] / motion.roll[moving]
    assert np.ptp(ratio) < 1e-9 and 0.8 < ratio[0] < 0.95
    assert any("specified for" in note for note in clipped.notes)


def test_too_fast_a_roll_is_slowed_by_the_flow() -> None:
    limits = limits_of(sms.Params(), 0.5)
    slowed = fitted(rolling(5.0, frequency=1.3, duration=12.0), limits, "clip", "")
    assert slowed.cuts[-1].limit == "speed" and "faster than" in slowed.cuts[-1].sentence
    assert slowed.demand.speed_share(limits).max() < 1.02


def test_any_motion_ends_up_within_the_stroke() -> None:
    random = draw("any motion")
    limits = limits_of(sms.Params(), 0.5)
    time: NDArray[np.float64] = 0.05 * np.arange(400.0)
    for _ in range(5):
        axes = random.normal(0.0, [[0.2], [0.2], [0.1]], (3, 400)).cumsum(axis=1) / 20.0
        motion = DeckMotion(time, *(axes - axes[:, :1]), "a random walk")  # type: ignore[misc]
        motion = replace(
            motion, roll=motion.roll.clip(-0.3, 0.3), pitch=motion.pitch.clip(-0.3, 0.3)
        )
        allowed = fitted(motion, limits, "clip", "").motion
        assert demand_of(allowed, limits).stroke_excess(limits).max() < 1e-6


def test_limits_that_cannot_be() -> None:
    with pytest.raises(InputError, match="clearance = 250 mm"):
        limits_of(sms.Params(), 0.5, 0.25)
    with pytest.raises(InputError, match="level, the actuators would be"):
        limits_of(sms.Params(), 0.3)
    with pytest.raises(InputError, match="it cannot lift the platform"):
        limits_of(sms.Params(supply_pressure=1e5), 0.5)


# ---- seas ----


@pytest.mark.parametrize("state", [1, 2, 3, 4])
def test_the_spectrum_has_the_significant_height(state: int) -> None:
    sea = SEA_STATES[state]
    frequency = np.linspace(1e-3, 5.0, 50001)
    spectrum = jonswap(frequency, sea.height, sea.period)
    assert 4.0 * np.sqrt(np.trapezoid(spectrum, frequency)) == pytest.approx(sea.height, rel=1e-3)
    assert frequency[np.argmax(spectrum)] == pytest.approx(1.0 / sea.period, rel=1e-2)


def test_a_sea_is_reproducible_and_has_its_spectrum() -> None:
    one, same, other = (synthetic_deck_motion(3, 3000.0, seed) for seed in (1, 1, 2))
    assert np.array_equal(one.roll, same.roll) and not np.array_equal(one.roll, other.roll)
    frequency, density = welch(one.roll, 1.0 / one.period, nperseg=4096)
    band = (frequency > 0.05) & (frequency < 0.4)
    sea, gravity = SEA_STATES[3], 9.81
    slope = (
        jonswap(frequency[band], sea.height, sea.period)
        * ((2.0 * np.pi * frequency[band]) ** 2 / gravity) ** 2
    )
    wanted = np.trapezoid(slope * np.abs(response(frequency[band], Ship().roll)) ** 2)
    assert np.trapezoid(density[band]) == pytest.approx(wanted, rel=0.15)
    assert not synthetic_deck_motion(0, 100.0, 1).roll.any()
    with pytest.raises(InputError, match="sea state 7: 0 to 4"):
        synthetic_deck_motion(7, 100.0, 1)


# ---- excitations ----


@pytest.mark.skipif(not CHIRP.is_file(), reason="needs ../shared/reference")
def test_the_chirp_of_the_source() -> None:
    for case in json.loads(CHIRP.read_text())["cases"]:
        given = case["in"]
        values = chirp(
            np.array([given["t"]]), given["A"], given["f1"], given["f2"], given["t_target"]
        )
        assert values[0] == pytest.approx(case["out"]["x"], rel=1e-11, abs=1e-13)


def test_sine_steps_and_aprbs() -> None:
    time: NDArray[np.float64] = 0.01 * np.arange(1001.0)
    wave = 0.2 * np.sin(2.0 * np.pi * 0.7 * time) + 0.1
    assert sine(time, 0.2, 0.7, 0.1) == pytest.approx(wave, abs=1e-12)
    assert list(steps(np.array([0.0, 0.99, 1.0, 5.0]), [1.0, -1.0], 1.0)) == [1.0, 1.0, -1.0, -1.0]
    signal = aprbs(time, 0.1, 0.5, 1.5, seed=3)
    assert np.array_equal(signal, aprbs(time, 0.1, 0.5, 1.5, seed=3))
    assert np.abs(signal).max() <= 0.1
    jumps = time[1:][np.diff(signal) != 0.0]
    assert np.diff(jumps).min() >= 0.49 and np.diff(jumps).max() <= 1.51
