"""The diagnosis of a platform: parameters of one leg, hidden inputs of legs, one hidden leak, a healthy machine."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from plant_support import write_platform
from sms import _core
from sms.diagnosis import diagnose
from sms.diagnosis.effects.catalogue import catalogue, effects_of
from sms.diagnosis.fitting import fit, nuisance_of
from sms.diagnosis.hypothesis import baseline_hypothesis
from sms.diagnosis.localisation import unknown_inputs
from sms.diagnosis.localisation.signal_functions import (
    alike,
    alike_signals,
    belong_together,
    signals_of,
)
from sms.diagnosis.localisation.unknown_inputs import bases_of, with_curve, with_terms
from sms.diagnosis.preparation import make_data
from sms.diagnosis.remainder import Shape
from sms.estimation.least_squares import changed
from sms.io.records import load_record
from sms.io.rig import load_rig
from sms.parameters import GEOMETRY, LEG_PARAMETERS, PARAMETERS

from validation.random_cases import draw

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


# ---- legs ------------------------------------------------------------------------------------------


def test_parameters_of_one_leg_are_what_it_has_more() -> None:
    params = _core.LegParams(_core.Params(valve_centre=5.1))
    assert params["valve_centre"] == 5.1 and params["valve_centre:2"] == 0.0
    params["valve_centre:2"] = -0.2
    assert [leg["valve_centre"] for leg in params.legs] == pytest.approx([5.1, 4.9, 5.1])
    twin = params.copy()
    twin["valve_centre:2"] = 0.0
    assert params["valve_centre:2"] == -0.2
    with pytest.raises(KeyError, match="valve_center"):
        params["valve_center:1"]
    with pytest.raises(KeyError, match=":1, :2 and :3"):
        params["valve_centre:4"]


def test_bounds_of_one_leg_keep_its_value_within_those_of_all() -> None:
    for name, row in PARAMETERS.items():
        leg = LEG_PARAMETERS[f"{name}:3"]
        assert leg.lower + row.default == pytest.approx(row.lower)
        assert leg.upper + row.default == pytest.approx(row.upper)
        assert leg.default == 0.0


def test_effects_of_all_legs_of_one_and_of_its_sensors() -> None:
    found = {e.key: e for e in catalogue("platform")}
    assert found["fitting_leakage of lower"].parameters == (
        "chamber_leakage_lower",
        "chamber_leakage_index_lower",
    )
    leg = found["fitting_leakage of lower, leg 2"]
    assert leg.parameters == ("chamber_leakage_lower:2", "chamber_leakage_index_lower:2")
    assert leg.sizes == 1 and "leg 2" in leg.title
    sensor = found["sensor_offset of extension_3"]
    assert sensor.parameters == ("sensor_offset_extension:3",)
    assert "position of leg 3" in sensor.title
    assert found["moving_mass"].parameters == ("payload_mass",)
    assert "centre_of_gravity of x, leg 1" not in found
    # A shift of one leg is relative to what all have: as far as the value itself may move.
    low, high = found["coulomb_friction of leg 1"].plausible_range(38.0)
    assert (low, high) == (-38.0, 5.0 * 38.0)


def test_a_term_of_one_leg_follows_that_leg_and_what_has_none() -> None:
    assert belong_together("force of leg 2", "velocity_2 [m/s]")
    assert belong_together("force of leg 2", "time [s]")
    assert not belong_together("force of leg 2", "velocity_1 [m/s]")
    assert not belong_together("chamber_pressure_lower_3", "extension_1 [m]")
    assert alike(("force of leg 1", "force of leg 2", "flow")) == {"force": [0, 1]}
    one, other = np.zeros(2), np.ones(2)
    found = alike_signals({"velocity_1 [m/s]": one, "velocity_2 [m/s]": other, "time [s]": one})
    assert [v is one for v in found["velocity [m/s]"]] == [True, False]
    assert len(found["time [s]"]) == 3


def test_a_curve_of_all_legs_acts_in_each_over_its_own_signal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where one leg rests, and its signal says nothing of where a term may lie."""
    rig = load_rig(write_platform(tmp_path, 4, {}, 2.2))
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    runs = data.identify
    fitted = fit(baseline_hypothesis(data, effects_of(rig)), runs, most_steps=1)
    nuisance, at = nuisance_of(fitted), (-0.1, 0.0, 0.1)
    shape = Shape("force", "velocity [m/s]", at, (-5.0, 0.0, 5.0), (0.0,) * 3, "N", 0.5, 0.8)
    values = 0.8 * np.array(shape.value)
    terms = {
        f"force of leg {leg}": np.interp(runs.inputs[f"velocity_{leg} [m/s]"], at, values)
        for leg in (1, 2, 3)
    }
    carried = with_curve(runs, nuisance, fitted.params, shape)
    assert np.linalg.norm(carried) > 1.0
    wanted = with_terms(runs, nuisance, fitted.params, terms)
    np.testing.assert_allclose(carried, wanted, atol=1e-6 * np.abs(wanted).max())
    moving = {name: v for name, v in signals_of(runs).items() if name != "velocity_1 [m/s]"}
    monkeypatch.setattr(unknown_inputs, "signals_of", lambda runs: moving)
    named = {(b.equation, b.signal) for b in bases_of(runs, nuisance, fitted.params)}
    assert ("force", "velocity [m/s]") in named
    assert ("force of leg 1", "velocity_1 [m/s]") not in named


# ---- the whole method ------------------------------------------------------------------------------


def test_a_fast_spool_does_not_run_to_its_stops(tmp_path: Path) -> None:
    """At 2.5 ms a step a spool of 200 Hz is unstable: noise on its command opened the valve altogether."""
    random = draw("spool of a platform")
    fast = float(random.uniform(180.0, 280.0))
    file = write_platform(tmp_path, 3, {"valve_frequency": fast}, 2.2)
    for record in tmp_path.glob("*.csv"):
        table = pd.read_csv(record)
        for column in (c for c in table if c.startswith("valve_command")):
            table[column] += random.normal(0.0, 0.01, len(table))
        table.to_csv(record, index=False)
    said = f'valve_frequency = {{ value = "{fast:.0f} Hz", uncertainty = "20 Hz" }}'
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("[[records]]", f"[parameters]\n{said}\n\n[[records]]", 1))
    rig = load_rig(file)
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    residual, jacobian = data.identify.problem.evaluate(rig.start(), ["valve_centre"])
    assert float(np.sqrt(np.mean(residual**2))) < 5.0
    assert float(np.linalg.norm(jacobian)) > 1e3


def test_a_healthy_platform_gives_no_evidence(tmp_path: Path) -> None:
    answer = diagnose(write_platform(tmp_path, 1, {}, 2.2))
    assert (answer.verdict, answer.causes) == ("no-evidence", ())
    # Two seconds leave open what each leg has of its own: values that are held predict worse than those of the form.
    assert all(g.baseline_refitted_rms < 1.3 * g.noise_floor for g in answer.gain)
    assert all(g.baseline_rms < 2.0 * g.noise_floor for g in answer.gain)


def test_a_leak_of_one_leg_is_named_with_its_size(tmp_path: Path) -> None:
    leak = 3e-9  # kg/(s Pa)
    answer = diagnose(write_platform(tmp_path, 2, {"chamber_leakage_lower:2": leak}, 2.2))
    assert answer.verdict == "cause"
    (cause,) = answer.causes
    assert (cause.effect, cause.signal) == ("fitting_leakage", "lower, leg 2")
    found, _ = cause.parameters
    assert found.value == pytest.approx(leak, abs=max(3.0 * found.standard_error, 0.05 * leak))
    assert answer.hidden is not None
    assert answer.hidden.equation.startswith("flow of the lower chamber")
    assert "leg 2" in answer.sentence


@pytest.mark.full
def test_a_rod_of_another_length_is_named_with_its_size(tmp_path: Path) -> None:
    """By roll and pitch, which disagree with the extensions."""
    longer = 0.012  # m
    truth = {"panhard_length_offset_2": longer}
    answer = diagnose(write_platform(tmp_path, 3, truth, 2.2, attitude=True))
    assert answer.verdict == "cause"
    (cause,) = answer.causes
    assert (cause.effect, cause.signal) == ("link_length", "panhard_length_offset_2")
    (found,) = cause.parameters
    assert found.value == pytest.approx(longer, abs=3.0 * found.standard_error)
    assert "Panhard rod 2" in answer.sentence


def test_joints_move_in_a_baseline_only_where_the_rig_file_declares_them(tmp_path: Path) -> None:
    file = write_platform(tmp_path, 3, {}, 2.2, attitude=True)

    def free() -> set[str]:
        rig = load_rig(file)
        data = make_data(rig, [load_record(rig, source) for source in rig.records])
        return set(baseline_hypothesis(data, effects_of(rig)).free)

    assert not free() & set(GEOMETRY)
    said = 'base_joint_2_y = { value = "-1.182264 m", uncertainty = "5 mm" }'
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("[[records]]", f"[parameters]\n{said}\n\n[[records]]", 1))
    assert free() & set(GEOMETRY) == {"base_joint_2_y"}


def test_what_is_plausible_of_a_joint_counts_from_where_it_is_declared() -> None:
    joint = {e.key: e for e in catalogue("platform")}["joint_position of base_joint_2_y"]
    assert joint.plausible_change(-1.18) == (-0.03, 0.03)
    assert joint.plausible_range(-1.18) == pytest.approx((-1.21, -1.15))
    assert "base joint of actuator 2 (y)" in joint.title


def test_a_second_parameter_that_records_hardly_feel_stays_within_its_range(tmp_path: Path) -> None:
    """Without Stribeck friction nothing is sensitive to its growth with pressure: it ended at its bound, and the
    friction with pressure, which fitted best, was refused for that."""
    rig = load_rig(write_platform(tmp_path, 4, {}, 2.2))
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    effects = {e.key: e for e in effects_of(rig)}
    effect = effects["pressure_dependent_friction"]
    baseline = baseline_hypothesis(data, list(effects.values()))
    first, second = effect.parameters
    assert first not in baseline.with_effect(effect).known
    assert baseline.with_effect(effect).known[second] == pytest.approx(5e-5)
    without = {"stribeck_acceleration_factor": 0.0}
    start = changed(baseline.start, list(without), np.array(list(without.values())))
    fitted = fit(replace(baseline, start=start).with_effect(effect), data.identify, start)
    assert second in fitted.movable


def test_a_mechanism_without_an_inclinometer_is_not_asked_for() -> None:
    joint = {e.key: e for e in catalogue("platform")}["joint_position of base_joint_2_y"]
    extensions = {f"extension_{leg}": None for leg in (1, 2, 3)}
    assert "seen from roll and pitch" in joint.not_measured(extensions)
    assert joint.not_measured(extensions | {"pitch": None}) == ""
