"""The method, step by step, on records whose truth is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sms import _core
from sms.diagnosis import diagnose
from sms.diagnosis.effects.catalogue import catalogue
from sms.diagnosis.selection.excitation import CHECKS
from sms.errors import InputError
from sms.io.write import write_record
from sms.parameters import PARAMETERS
from sms.report.diagnosis import report_html
from sms.report.files import write_diagnosis
from sms.rigs.cylinder import derive_motion, number_strokes

from validation.random_cases import draw

RIG = """
[rig]
kind = "cylinder"
title = "made by the core itself"
[data]
speed_above = "2 mm/s"
[parameters]
bore_diameter = {{ value = "25 mm", uncertainty = "{bore_uncertainty}" }}
rod_diameter = {{ value = "0 mm", uncertainty = "0 mm" }}
stroke = {{ value = "60 mm", uncertainty = "0 mm" }}
moving_mass = {{ value = "0.1 kg", uncertainty = "0 kg" }}
ambient_pressure = {{ value = "100 kPa", uncertainty = "0 Pa" }}
coulomb_force = {{ fit = true, value = "5 N" }}
viscous_friction = {{ value = "0 N s/m", uncertainty = "0 N s/m" }}
stribeck_acceleration_factor = {{ value = "0 s^2/m", uncertainty = "0 s^2/m" }}
"""
RECORDS = (
    ("1_bar", 1e5, "identify"),
    ("5_bar", 5e5, "identify"),
    ("3_bar", 3e5, "validate"),
    ("7_bar", 7e5, "validate"),
)


def make_rig(
    folder: Path, bore_uncertainty: str = "0.001 mm", extra_force: float = 0.0, **truth: float
) -> Path:
    """Records of slow strokes whose forces come from the core with the parameters `truth`; noise 0.2 N."""
    rng = draw("method")
    known = {
        "bore_diameter": 0.025,
        "rod_diameter": 0.0,
        "stroke": 0.06,
        "moving_mass": 0.1,
        "ambient_pressure": 1e5,
        "coulomb_force": 6.0,
        "viscous_friction": 0.0,
        "stribeck_acceleration_factor": 0.0,
    }
    params = _core.Params(**(known | truth))
    text = RIG.format(bore_uncertainty=bore_uncertainty)
    time = np.arange(0.0, 40.0, 0.01)
    phase = time / 4.0 + 0.003
    extension = 0.03 + 0.02 * (2.0 / np.pi) * np.arcsin(np.sin(2.0 * np.pi * phase))
    velocity, acceleration = derive_motion(time, extension)
    for name, gauge, role in RECORDS:
        pressure = np.full(len(time), gauge + 1e5)
        force = _core.rod_force(params, extension, velocity, acceleration, pressure, 1e5)
        force = (
            force
            + rng.normal(0.0, 0.2, len(time))
            + extra_force * np.sin(2.0 * np.pi * extension / 0.003)
        )
        write_record(
            folder / f"{name}.csv",
            {
                "time": time,
                "extension": extension + rng.normal(0.0, 2e-6, len(time)),
                "chamber_pressure_lower": pressure + rng.normal(0.0, 100.0, len(time)),
                "rod_force": force,
            },
        )
        text += f'\n[[records]]\nfile = "{name}.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text)
    return folder / "rig.toml"


def test_healthy_records_give_no_evidence(tmp_path: Path) -> None:
    answer = diagnose(make_rig(tmp_path))
    assert (answer.verdict, answer.causes) == ("no-evidence", ())
    assert answer.noise_floor["stroke"] == pytest.approx(0.2, rel=0.1)


def test_same_seed_same_answer(tmp_path: Path) -> None:
    rig = make_rig(tmp_path, pressure_friction=1e-6)
    assert diagnose(rig, 5).to_dict() == diagnose(rig, 5).to_dict()


def test_a_test_record_decides_nothing_and_its_gain_is_reported(tmp_path: Path) -> None:
    """The whole answer but for gains, curves and records is that without it."""
    rig = make_rig(tmp_path, pressure_friction=2e-6)
    whole = rig.read_text()
    tables = whole.split("[[records]]")
    kept_out = next(t for t in tables if "3_bar" in t)
    rig.write_text("[[records]]".join(t for t in tables if t is not kept_out))
    without = diagnose(rig)
    rig.write_text(whole.replace(kept_out, kept_out.replace("validate", "test")))
    answer = diagnose(rig)
    assert answer.causes == without.causes
    assert answer.candidates == without.candidates
    assert [g.role for g in answer.gain] == ["validate"] * len(without.gain) + ["test"]
    assert answer.gain[-1].record == "3_bar"
    assert "took no part in any choice" in report_html(answer)


def test_an_empirical_term_is_refused_where_nothing_is_simulated(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="leave --empirical out"):
        diagnose(make_rig(tmp_path), empirical=True)


@pytest.mark.parametrize(
    "parameter, value, effect",
    [
        ("pressure_friction", 2e-6, "pressure_dependent_friction"),
        ("position_friction", 4.0, "position_dependent_friction"),
        ("direction_friction", 0.3, "direction_dependent_friction"),
    ],
)
def test_a_missing_term_is_named_with_its_size(
    tmp_path: Path, parameter: str, value: float, effect: str
) -> None:
    answer = diagnose(make_rig(tmp_path, **{parameter: value}))
    assert len(answer.causes) == 1
    assert effect in answer.causes[0].members
    found = {p.name: p for p in answer.causes[0].parameters}
    for member in answer.causes[0].alternatives:
        found |= {p.name: p for p in member.parameters}
    assert abs(found[parameter].value - value) < 4.0 * found[parameter].standard_error + 0.02 * abs(
        value
    )
    assert all(g.reduction_low > 0.0 for g in answer.gain if g.baseline_rms > 1.1 * g.noise_floor)


def test_a_shift_beyond_the_declared_uncertainty_is_a_cause_and_one_within_is_not(
    tmp_path: Path,
) -> None:
    beyond, within = tmp_path / "beyond", tmp_path / "within"
    beyond.mkdir()
    within.mkdir()
    answer = diagnose(make_rig(beyond, bore_diameter=0.0251))
    assert answer.verdict == "class"
    assert "bore_diameter" in answer.causes[0].members
    shift = next(
        p for a in answer.causes[0].alternatives for p in a.parameters if p.name == "bore_diameter"
    )
    assert shift.old_value == 0.025
    assert shift.value == pytest.approx(0.0251, rel=1e-4)
    assert diagnose(make_rig(within, "0.2 mm", bore_diameter=0.0251)).verdict == "no-evidence"


def test_two_effects_are_a_combination(tmp_path: Path) -> None:
    answer = diagnose(make_rig(tmp_path, pressure_friction=3e-6, position_friction=6.0))
    assert answer.verdict == "combination"
    assert {c.effect for c in answer.causes} == {
        "pressure_dependent_friction",
        "position_dependent_friction",
    }


def test_what_the_catalogue_does_not_know_is_unknown(tmp_path: Path) -> None:
    answer = diagnose(make_rig(tmp_path, extra_force=0.4))
    assert (answer.verdict, answer.causes) == ("unknown", ())
    assert answer.remainder is not None
    assert (
        max(
            answer.remainder.shares,
            key=lambda k: answer.remainder.shares[k] if k != "does not repeat" else 0.0,
        )
        == "extension"
    )
    assert answer.next_experiment is not None


def test_the_extended_model_leaves_nothing_to_find(tmp_path: Path) -> None:
    rig = make_rig(tmp_path, pressure_friction=3e-6)
    first = diagnose(rig)
    write_diagnosis(first, rig, tmp_path / "out")
    again = diagnose(tmp_path / "out" / "extended.toml")
    assert first.verdict == "cause"
    assert again.verdict == "no-evidence"
    assert again.gain[0].baseline_rms == pytest.approx(first.gain[0].extended_rms, rel=0.01)


def test_slow_strokes_say_nothing_of_viscous_friction(tmp_path: Path) -> None:
    blind = {n.effect: n.reason for n in diagnose(make_rig(tmp_path)).not_testable}
    assert "a decade is needed" in blind["viscous_friction"]
    assert "upper is not measured" in next(
        n.reason
        for n in diagnose(tmp_path / "rig.toml").not_testable
        if n.signal == "chamber_pressure_upper"
    )


def test_a_stuck_channel_is_a_data_fault(tmp_path: Path) -> None:
    rig = make_rig(tmp_path)
    lines = (tmp_path / "5_bar.csv").read_text().splitlines()
    force = lines[0].split(",").index("rod_force [N]")
    for i in range(1000, 3000):
        cells = lines[i].split(",")
        cells[force] = "250.0"
        lines[i] = ",".join(cells)
    (tmp_path / "5_bar.csv").write_text("\n".join(lines) + "\n")
    answer = diagnose(rig)
    assert (answer.verdict, answer.causes) == ("data-fault", ())
    assert "5_bar.csv" in answer.sentence
    assert "rod_force" in answer.sentence


def test_one_record_only_is_refused(tmp_path: Path) -> None:
    rig = make_rig(tmp_path)
    rig.write_text(
        rig.read_text().split("[[records]]")[0]
        + '[[records]]\nfile = "1_bar.csv"\nrole = "identify"\n'
    )
    with pytest.raises(InputError, match="nothing to judge on"):
        diagnose(rig)


# ---- the parts ----------------------------------------------------------------------------------------------------


def test_every_effect_of_the_catalogue_stands_on_the_parameter_list() -> None:
    for effect in catalogue():
        assert set(effect.needs) <= set(CHECKS)
        for name in effect.parameters:
            if effect.kind == "missing":
                assert PARAMETERS[name].default == 0.0
        low, high = effect.plausible
        assert low < high
    keys = [e.key for e in catalogue()]
    assert len(keys) == len(set(keys))


def test_motion_of_a_parabola_is_exact() -> None:
    time = np.arange(200) * 0.01
    velocity, acceleration = derive_motion(time, 0.1 + 0.3 * time - 0.2 * time**2)
    assert velocity == pytest.approx(0.3 - 0.4 * time, abs=1e-9)
    assert acceleration == pytest.approx(np.full(200, -0.4), abs=1e-8)


def test_strokes_are_runs_in_one_direction() -> None:
    moving = np.ones(60, dtype=bool)
    moving[25:30] = False
    direction = np.concatenate((np.ones(40), -np.ones(20)))
    direction[55:] = 1.0  # five samples: a jerk, not a stroke
    stroke = number_strokes(moving, direction)
    assert list(stroke[[0, 24, 27, 30, 39, 40, 54, 57]]) == [0, 0, -1, 1, 1, 2, 2, -1]


def test_a_screw_pitch_is_found_in_what_is_left_and_none_where_there_is_none(
    tmp_path: Path,
) -> None:
    with_screw, without = tmp_path / "with", tmp_path / "without"
    with_screw.mkdir()
    without.mkdir()
    left = diagnose(make_rig(with_screw, extra_force=0.4)).remainder
    assert left is not None
    assert left.ripple is not None
    assert left.ripple.period == pytest.approx(0.003, rel=0.02)
    assert left.ripple.amplitude == pytest.approx(0.4, rel=0.2)
    healthy = diagnose(make_rig(without)).remainder
    assert healthy is not None
    assert healthy.ripple is None


def test_a_time_that_jumps_by_weeks_is_refused() -> None:
    """Seen: the even grid on which a velocity is derived took all of the memory."""
    time = np.arange(0.0, 10.0, 0.01)
    time[500:] += 1e6
    with pytest.raises(InputError, match=r"gap behind 4\.99 s; split the record"):
        derive_motion(time, np.zeros(1000))
    time[500:] -= 1e6 - 5.0
    assert np.isfinite(derive_motion(time, np.zeros(1000))[0]).all()
