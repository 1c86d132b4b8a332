"""One law, one number: a law that is right keeps its size in every half and beside a play, another one does not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from sms import _core
from sms.arrays import Array
from sms.diagnosis.adequacy.hysteresis import after_play, hysteresis
from sms.diagnosis.adequacy.parameter_constancy import Sizes, inconstancy
from sms.diagnosis.adequacy.residual_energy import Left
from sms.diagnosis.adequacy.subset_estimates import column_of, linear, record_by_record
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.fitting import fit, without_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.localisation.activity import activity, own_signals
from sms.diagnosis.pipeline import read_and_check
from sms.diagnosis.preparation import make_data
from sms.diagnosis.simulated import investigate
from sms.estimation.discrepancy import KNOTS
from sms.estimation.windows import Runs
from sms.io.rig import load_rig

from validation.random_cases import SEED
from validation.random_cases import draw as random_draw
from validation.twins.draw import draw

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


def fitted_to(
    folder: Path,
    kind: str,
    hidden: str,
    seed: int,
    cause: str,
    multiple: float = 3.0,
    imperfection: float = 0.0,
) -> tuple[Data, Fitted]:
    """The core with a cause, fitted to records in which `hidden` is hidden."""
    draw(kind, seed, folder / "rig", folder / "truth.json", hidden, multiple, imperfection)
    rig = load_rig(folder / "rig" / "rig.toml")
    read, _ = read_and_check(rig)
    data, effects = make_data(rig, read), effects_of(rig)
    effect = next(e for e in effects if e.key == cause)
    baseline = fit(baseline_hypothesis(data, effects), data.identify)
    return data, fit(baseline.hypothesis.with_effect(effect), data.identify, baseline.params)


# ---- halves --------------------------------------------------------------------------------------


@pytest.mark.full
def test_a_leak_that_opens_at_a_pressure_is_another_law(tmp_path: Path) -> None:
    leak = "fitting_leakage of lower"
    data, fitted = fitted_to(tmp_path, "bench", "check_valve_leak", 5, leak, multiple=2.0)
    law = inconstancy(fitted, fitted.hypothesis.causes[0], data)
    assert law is not None
    assert law.signal.startswith("chamber_pressure")
    assert law.high[0] > 1.2 * law.low[0] > 0.0


@pytest.mark.full
def test_on_a_machine_whose_flow_is_off_a_leak_of_another_size_in_each_half_keeps_its_law(
    tmp_path: Path,
) -> None:
    """About every other machine drawn is off where its records show it: drawn until one is."""
    leak, excess = "fitting_leakage of lower", 0.0
    for seed in range(SEED, SEED + 20):
        print(f"seed {seed}")
        hidden = "bench", "fitting_leakage:lower"
        data, fitted = fitted_to(tmp_path / str(seed), *hidden, seed, leak, imperfection=2.0)
        assert inconstancy(fitted, fitted.hypothesis.causes[0], data) is None
        excess = Left.by(fitted, data).excess("identify")
        if excess > 0.1:
            break
    assert excess > 0.1


@pytest.mark.full
def test_of_three_legs_each_counts_by_its_own_pressure(tmp_path: Path) -> None:
    leak = "fitting_leakage of lower"
    data, fitted = fitted_to(tmp_path, "platform", "check_valve_leak", 710_003, leak, multiple=10.0)
    law = inconstancy(fitted, fitted.hypothesis.causes[0], data)
    assert law is not None
    assert law.signal == "chamber_pressure_lower [Pa]"
    assert law.high[0] > law.low[0] > 0.0


def test_what_own_sizes_take_is_what_a_regression_with_them_takes() -> None:
    """Against numpy's least squares: one size for all rows, and one for each of four parts."""
    random = random_draw("own_sizes")
    rows = 200
    part = random.integers(0, 4, rows)
    columns = random.standard_normal(rows)[:, None] * (part[:, None] == np.arange(4))
    residual = -columns @ random.uniform(0.5, 2.0, 4) + random.standard_normal(rows)
    stacked = np.column_stack([columns, residual])
    found = linear(stacked.T @ stacked, rows)
    assert found is not None

    def left(design: Array) -> float:
        return float(np.linalg.lstsq(design, residual, rcond=None)[1][0])

    taken = 1.0 - left(columns) / left(columns.sum(axis=1, keepdims=True))
    assert Sizes(*found).takes(rows) == pytest.approx(taken, rel=1e-9)


# ---- when a cause acts ---------------------------------------------------------------------------


def test_a_sensitivity_is_that_of_unknown_inputs_and_its_parts_add_up(tmp_path: Path) -> None:
    print(f"seed {SEED}")
    leak = "fitting_leakage of lower"
    data, fitted = fitted_to(tmp_path, "tank", "fitting_leakage", SEED % 10_000, leak)
    runs = data.identify
    column = column_of(runs, fitted, fitted.hypothesis.causes[0])
    found = activity(runs, fitted.params, column)
    assert found is not None
    everywhere = np.ones(found.size.shape, dtype=np.bool_)
    assert np.linalg.norm(found.where(everywhere) - column) < 1e-3 * np.linalg.norm(column)
    half = own_signals(runs, runs.inputs)["time [s]"] < 2.0
    assert 0 < half.sum() < half.size
    parts = found.where(half), found.where(~half)
    np.testing.assert_allclose(
        sum(parts), found.where(everywhere), atol=1e-9 * np.abs(column).max()
    )
    late = np.array([w.first * runs.motions[w.record].step > 2.0 for w in runs.problem.windows])
    assert not np.any(parts[0][late[runs.block]])


def test_what_jumps_from_sample_to_sample_acts_on_no_equation(tmp_path: Path) -> None:
    delay = "command_delay"
    data, fitted = fitted_to(tmp_path, "tank", "command_delay", 3, delay)
    runs = data.identify
    assert activity(runs, fitted.params, np.where(runs.sample % 2 == 0, 1.0, -1.0)) is None
    late = fitted.hypothesis.causes[0]
    assert activity(runs, fitted.params, column_of(runs, fitted, late)) is None
    assert inconstancy(fitted, late, data) is None


def test_beside_an_input_of_a_leg_stands_the_signal_of_that_leg() -> None:
    samples = 2 * KNOTS
    window = SimpleNamespace(row=0, rows=samples, samples=samples)
    inputs = {f"force of leg {leg}": "N" for leg in (1, 2, 3)}
    runs = cast(
        Runs,
        SimpleNamespace(
            problem=SimpleNamespace(windows=[window]),
            channels=("extension_1",),
            kind=SimpleNamespace(hidden=inputs),
        ),
    )
    signals = {f"velocity_{leg} [m/s]": np.full(samples, float(leg)) for leg in (1, 2, 3)}
    found = own_signals(runs, signals | {"roll [rad]": np.full(samples, 7.0)})
    assert set(found) == {"velocity [m/s]", "roll [rad]"}
    np.testing.assert_array_equal(found["velocity [m/s]"], [np.repeat([1.0, 2.0, 3.0], KNOTS)])
    np.testing.assert_array_equal(found["roll [rad]"], [np.full(3 * KNOTS, 7.0)])


# ---- memory --------------------------------------------------------------------------------------


def test_what_follows_with_a_play_stays_where_the_command_turns() -> None:
    command = np.array([5.0, 5.5, 6.0, 5.9, 5.5, 5.0, 5.05])
    np.testing.assert_allclose(after_play(command, 0.2), [5.0, 5.3, 5.8, 5.8, 5.7, 5.2, 5.2])
    np.testing.assert_array_equal(after_play(command, 0.0), command)


def test_spools_that_stick_are_no_wider_dead_bands(tmp_path: Path) -> None:
    print(f"seed {SEED}")
    left, play = [], []
    for draw_number in range(7):  # of one in thirty more than 0.6 is left
        seed = (SEED + draw_number) % 10_000
        folder = tmp_path / str(draw_number)
        folder.mkdir()
        data, fitted = fitted_to(folder, "tank", "sticky_spool", seed, "dead_band_width")
        found = hysteresis(fitted, fitted.hypothesis.causes[0], data)
        left.append(1.0 if found is None else abs(found.beside[0]) / found.alone)
        play.append(0.0 if found is None else found.play[0] / found.alone)
    assert np.median(left) < 0.6
    assert np.median(play) > 0.4


def test_a_wider_dead_band_has_no_memory_and_one_width(tmp_path: Path) -> None:
    print(f"seed {SEED}")
    data, fitted = fitted_to(tmp_path, "tank", "dead_band_width", SEED % 10_000, "dead_band_width")
    effect = fitted.hypothesis.causes[0]
    assert hysteresis(fitted, effect, data) is None
    assert inconstancy(fitted, effect, data) is None


def test_records_of_a_spool_that_sticks_are_unknown_and_do_not_contradict_each_other(
    tmp_path: Path,
) -> None:
    draw("tank", 720_083, tmp_path / "rig", tmp_path / "truth.json", "sticky_spool", 3.0)
    rig = load_rig(tmp_path / "rig" / "rig.toml")
    read, _ = read_and_check(rig)
    data, rng = make_data(rig, read), np.random.default_rng(0)
    case = investigate(data, effects_of(rig), rng, lambda text, done: None)
    assert case.verdict == "unknown"
    assert case.inconsistency is None
    assert case.inconstancy is not None


def test_a_model_that_has_forgotten_its_sensitivities_gives_the_same_sizes(tmp_path: Path) -> None:
    leak = "fitting_leakage of lower"
    data, fitted = fitted_to(tmp_path, "tank", "fitting_leakage", 3, leak)
    effect = fitted.hypothesis.causes[0]
    forgotten = without_sensitivities(fitted)
    assert forgotten.slopes == {}
    # Each with its own first fit of the validation records: a second one begins at the slopes of the first.
    sizes, again = (
        record_by_record(f, effect, replace(data, refitted_of={})) for f in (fitted, forgotten)
    )
    assert list(sizes) == list(again)
    for record, size in sizes.items():
        np.testing.assert_allclose(again[record], size, rtol=1e-3)
