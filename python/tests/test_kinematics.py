"""Kinematics from Python: reference values, there and back, arrays, errors; and C gives the same."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
import sms
from mechanism_support import ROOT, Array, column, difference, driven, random_poses, with_reference

from validation.random_cases import draw

LEVEL = (0.0, 0.0, 0.5)


def inverse(q: Array, params: sms.Params | None = None) -> sms.InverseKinematics:
    q = np.asarray(q)
    return sms.inverse_kinematics(q[..., 0], q[..., 1], q[..., 2], params=params)


# ---- values ----------------------------------------------------------------------------------


@with_reference
def test_inverse_kinematics_agrees_with_every_reference_case_to_1e_12() -> None:
    found = inverse(driven("inverse_kinematics"))
    assert difference(found.extension, column("inverse_kinematics", "ext")) < 1e-12
    for name in ("yaw", "x", "y"):
        assert difference(getattr(found, name), column("inverse_kinematics", name)) < 1e-12, name


@with_reference
def test_forward_kinematics_agrees_with_every_reference_case_to_1e_11() -> None:
    found = sms.forward_kinematics(column("forward_kinematics", "ext"))
    for name in ("roll", "pitch", "height", "yaw", "x", "y"):
        assert difference(getattr(found, name), column("forward_kinematics", name)) < 1e-11, name


@with_reference
def test_rates_and_the_jacobian_agree_with_every_reference_case() -> None:
    q, qdot = driven("dynamics"), column("dynamics", "qdot")
    motion = sms.inverse_motion(q, qdot)
    assert difference(motion.extension_rate, column("dynamics", "extdot")) < 1e-12
    parasitic = column("dynamics", "yawdot", "xdot", "ydot")
    assert difference(motion.parasitic_rate, parasitic) < 1e-12
    assert difference(sms.jacobian(q), column("dynamics", "dext_dq")) < 1e-12


def test_the_rest_pose_and_mid_stroke_are_where_the_source_has_them() -> None:
    retracted = sms.forward_kinematics([0.0, 0.0, 0.0])
    assert retracted.height == pytest.approx(0.297561, abs=1e-15)
    assert retracted.roll == pytest.approx(0.0, abs=1e-15)
    middle = sms.inverse_kinematics(*LEVEL)
    assert middle.extension == pytest.approx([0.20042] * 3, abs=1e-5)
    assert np.degrees(middle.yaw) == pytest.approx(2.3026, abs=1e-4)


# ---- identities ------------------------------------------------------------------------------


@pytest.mark.parametrize("tilt", [0.0, 1e-8, None], ids=["level", "nearly level", "random"])
def test_there_and_back(tilt: float | None) -> None:
    random = draw(f"there_and_back {tilt}")
    q = random_poses(random, 10_000)
    if tilt is not None:
        q[:, :2] = tilt * random.choice([-1.0, 1.0], (len(q), 2))
    there = inverse(q)
    back = sms.forward_kinematics(there.extension)
    found = np.stack([back.roll, back.pitch, back.height], axis=-1)
    assert difference(found, q) < 1e-14
    for name in ("yaw", "x", "y"):
        assert difference(getattr(back, name), getattr(there, name)) < 1e-14, name
    assert there.residual.max() < 1e-15 and there.iterations.max() <= 6
    assert back.residual.max() < 2e-15 and back.iterations.max() <= 8


def test_every_extension_within_the_stroke_has_a_pose() -> None:
    ends = np.linspace(0.0, sms.Params().stroke, 11)
    extension = np.stack(np.meshgrid(ends, ends, ends), axis=-1)
    pose = sms.forward_kinematics(extension)
    assert pose.roll.shape == (11, 11, 11)
    there = sms.inverse_kinematics(pose.roll, pose.pitch, pose.height)
    assert difference(there.extension, extension) < 1e-14


def test_rates_and_accelerations_are_derivatives_of_the_extensions() -> None:
    random = draw("rates")
    q = random_poses(random, 200)
    qdot, qddot = random.uniform(-0.5, 0.5, q.shape), random.uniform(-2.0, 2.0, q.shape)
    motion = sms.inverse_motion(q, qdot, qddot)
    h = 1e-4
    at = {t: inverse(q + t * qdot + 0.5 * t * t * qddot) for t in (-2 * h, -h, 0.0, h, 2 * h)}

    def first(values: dict[float, Array]) -> Array:
        return (8.0 * (values[h] - values[-h]) - (values[2 * h] - values[-2 * h])) / (12.0 * h)

    def second(values: dict[float, Array]) -> Array:
        near, far = values[h] + values[-h], values[2 * h] + values[-2 * h]
        return (16.0 * near - far - 30.0 * values[0.0]) / (12.0 * h * h)

    extension = {t: found.extension for t, found in at.items()}
    parasitic = {t: np.stack([f.yaw, f.x, f.y], axis=-1) for t, f in at.items()}
    assert difference(motion.extension_rate, first(extension)) < 1e-10
    assert difference(motion.extension_acceleration, second(extension)) < 1e-6
    assert difference(motion.parasitic_rate, first(parasitic)) < 1e-10
    assert difference(motion.parasitic_acceleration, second(parasitic)) < 1e-6


def test_motion_there_and_back() -> None:
    random = draw("motion_there_and_back")
    q = random_poses(random, 1000)
    qdot, qddot = random.uniform(-1.0, 1.0, q.shape), random.uniform(-5.0, 5.0, q.shape)
    there = sms.inverse_motion(q, qdot, qddot)
    extension = inverse(q).extension
    back = sms.forward_motion(extension, there.extension_rate, there.extension_acceleration)
    assert difference(back.qdot, qdot) < 1e-12
    assert difference(back.qddot, qddot) < 1e-11
    assert difference(back.parasitic_acceleration, there.parasitic_acceleration) < 1e-11


def test_both_jacobians_tell_the_same_rates() -> None:
    random = draw("jacobians")
    q = random_poses(random, 100)
    qdot = random.uniform(-1.0, 1.0, q.shape)
    motion = sms.inverse_motion(q, qdot)
    by_q = np.einsum("nij,nj->ni", sms.jacobian(q), qdot)
    everything = np.concatenate([qdot, motion.parasitic_rate], axis=-1)
    by_pose = np.einsum("nij,nj->ni", sms.pose_jacobian(q), everything)
    assert difference(by_q, motion.extension_rate) < 1e-14
    assert difference(by_pose, motion.extension_rate) < 1e-14


def test_six_legs_are_the_actuators_and_rods_where_the_rods_fit() -> None:
    q = random_poses(draw("six_legs"), 100)
    found = inverse(q)
    lengths = sms.six_leg_inverse(q[:, 0], q[:, 1], q[:, 2], found.yaw, found.x, found.y)
    assert difference(lengths[:, :3] - found.extension, np.full((100, 3), 0.7240001)) < 1e-6
    rods = np.tile([1.55486117, 1.55479908, 1.55486010], (100, 1))
    assert difference(lengths[:, 3:], rods) < 1e-8


def test_the_reference_point_is_a_parameter() -> None:
    params = sms.Params(reference_point_x=0.0, reference_point_y=0.0, reference_point_z=-0.8)
    default, moved = sms.inverse_kinematics(*LEVEL), sms.inverse_kinematics(*LEVEL, params=params)
    assert difference(default.extension, moved.extension) > 0.1
    lift = 0.8 - 0.297561
    same = sms.inverse_kinematics(0.0, 0.0, 0.5 + lift, params=params)
    assert difference(same.extension, default.extension) < 1e-15


# ---- arrays ----------------------------------------------------------------------------------


def test_inputs_broadcast_and_outputs_have_their_shape() -> None:
    roll, pitch = np.linspace(-0.05, 0.05, 4), np.linspace(-0.04, 0.04, 3)[:, None]
    found = sms.inverse_kinematics(roll, pitch, 0.5)
    assert found.extension.shape == (3, 4, 3)
    assert found.yaw.shape == found.x.shape == found.iterations.shape == (3, 4)
    one = sms.inverse_kinematics(roll[1], pitch[2, 0], 0.5)
    assert one.extension.shape == (3,) and np.ndim(one.yaw) == 0
    assert np.array_equal(one.extension, found.extension[2, 1]) and one.yaw == found.yaw[2, 1]
    assert f"{one.yaw:.3f}" == "0.040"
    assert sms.jacobian([[LEVEL, LEVEL]]).shape == (1, 2, 3, 3)
    assert sms.pose_jacobian(LEVEL).shape == (3, 6)
    motion = sms.inverse_motion(LEVEL, np.zeros((5, 3)))
    assert motion.extension_rate.shape == (5, 3)
    assert sms.forward_kinematics(np.zeros((0, 3))).roll.shape == (0,)


def test_many_rows_on_all_cores_are_what_one_row_is() -> None:
    q = random_poses(draw("many_rows"), 50_000)
    many, few = inverse(q), inverse(q[::1000])
    assert np.array_equal(many.extension[::1000], few.extension)
    assert np.array_equal(many.yaw[::1000], few.yaw)
    backwards = inverse(q[::-1])
    assert np.array_equal(backwards.extension[::-1], many.extension)


def archive() -> Path | None:
    """The libsms.a of `./dev build`."""
    file = ROOT / "build" / "package" / "libsms" / "libsms.a"
    return file if file.is_file() else None


C_LOOP = r"""
#include <stdio.h>
#include "sms/sms.h"
int main(void) {
  sms_params params; sms_geometry geometry; sms_pose pose; double q[3], extension[3];
  sms_params_default(&params);
  sms_geometry_from_params(&params, &geometry);
  while (fread(q, sizeof q, 1, stdin) == 1) {
    if (sms_inverse_kinematics(&geometry, q, NULL, &pose, extension, NULL) != SMS_OK) return 1;
    fwrite(&pose, sizeof pose, 1, stdout);
    fwrite(extension, sizeof extension, 1, stdout);
  }
  return 0;
}
"""


@pytest.mark.skipif(archive() is None, reason="no build/package here; run ./dev build")
def test_a_loop_in_c_gives_the_same_bits(tmp_path: Path) -> None:
    source, program = tmp_path / "loop.c", tmp_path / "loop"
    source.write_text(C_LOOP)
    include = ROOT / "libsms/include"
    subprocess.run(
        ["cc", "-std=c99", "-I", include, source, archive(), "-lm", "-o", program], check=True
    )
    q = random_poses(draw("c_loop"), 1000)
    run = subprocess.run([program], input=q.tobytes(), capture_output=True, check=True)
    rows = np.frombuffer(run.stdout).reshape(-1, 9)
    found = inverse(q)
    assert np.array_equal(rows[:, 6:], found.extension)
    assert np.array_equal(rows[:, 3:6], np.stack([found.yaw, found.x, found.y], axis=-1))


# ---- errors ----------------------------------------------------------------------------------


def test_a_pose_beyond_the_mechanism_names_its_row() -> None:
    with pytest.raises(
        sms.OutOfWorkspaceError,
        match=r"^row 2: roll = 0\.7 rad \(40\.11°\), pitch = 0 rad .*within ±0\.6 rad",
    ):
        sms.inverse_kinematics([0.0, 0.1, 0.7], 0.0, 0.5)
    with pytest.raises(sms.OutOfWorkspaceError, match=r"^row \(1, 0\): .* height = 3 m"):
        sms.inverse_kinematics([[0.0], [0.0]], 0.0, [[0.5], [3.0]])
    with pytest.raises(sms.OutOfWorkspaceError, match=r"^extension 1 = 5 m.* 0 to 0\.4 m$"):
        sms.forward_kinematics([5.0, 0.2, 0.2])
    with pytest.raises(sms.OutOfWorkspaceError, match=r"^row 1: roll"):
        sms.jacobian([LEVEL, (0.7, 0.0, 0.5)])


def test_the_first_bad_row_of_many_is_named() -> None:
    height = np.full(100_000, 0.5)
    height[[70_001, 99_999]] = 5.0
    with pytest.raises(sms.OutOfWorkspaceError, match="row 70001: "):
        sms.inverse_kinematics(0.0, 0.0, height)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_number_that_is_none_is_named(bad: float) -> None:
    with pytest.raises(sms.NotANumberError, match=r"^row 1: pitch = .* must be a finite number"):
        sms.inverse_kinematics(0.0, [0.0, bad], 0.5)
    with pytest.raises(sms.NotANumberError, match=r"^extension 3 = "):
        sms.forward_kinematics([0.2, 0.2, bad])
    with pytest.raises(sms.NotANumberError, match=r"^row 1: height rate = "):
        sms.inverse_motion(LEVEL, [(0.0, 0.0, 0.0), (0.0, 0.0, bad)])
    with pytest.raises(sms.NotANumberError, match=r"^extension acceleration 1 = "):
        sms.forward_motion([0.2] * 3, [0.0] * 3, [bad, 0.0, 0.0])
    with pytest.raises(sms.NotANumberError, match=r"^yaw = "):
        sms.six_leg_inverse(0.0, 0.0, 0.5, bad, 0.0, 0.0)


def test_shapes_that_do_not_fit_are_explained() -> None:
    with pytest.raises(ValueError, match=r"roll \(2,\), pitch \(3,\), height \(\)"):
        sms.inverse_kinematics([0.0, 0.0], [0.0, 0.0, 0.0], 0.5)
    with pytest.raises(ValueError, match=r"extension has shape \(2,\).*extension 1, extension 2"):
        sms.forward_kinematics([0.2, 0.2])
    with pytest.raises(ValueError, match="roll is not an array of numbers"):
        sms.inverse_kinematics("level", 0.0, 0.5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"q \(2,\), qdot \(3,\)"):
        sms.inverse_motion([LEVEL] * 2, [LEVEL] * 3)


def test_every_status_has_an_exception_and_all_are_value_errors() -> None:
    for error in (
        sms.NotANumberError,
        sms.OutOfRangeError,
        sms.OutOfWorkspaceError,
        sms.NotConvergedError,
    ):
        assert issubclass(error, sms.StatusError) and issubclass(error, ValueError)


def test_points_of_the_platform_are_carried_along() -> None:
    params = sms.Params()
    joints = np.array(
        [[params[f"platform_joint_{i}_{axis}"] for axis in "xyz"] for i in range(1, 7)]
    )
    base = np.array([[params[f"base_joint_{i}_{axis}"] for axis in "xyz"] for i in range(1, 7)])
    rest = sms.forward_kinematics([0.0, 0.0, 0.0])
    tilted = sms.inverse_kinematics(0.1, -0.05, 0.5)
    poses = np.array(
        [
            [rest.roll, rest.pitch, rest.height, rest.yaw, rest.x, rest.y],
            [0.1, -0.05, 0.5, tilted.yaw, tilted.x, tilted.y],
        ],
        dtype=np.float64,
    )
    carried = sms._core.carried_points(params, poses, joints).reshape(2, 6, 3)
    assert carried[0] == pytest.approx(joints, abs=1e-12)
    lengths = sms.six_leg_inverse(*poses[1])
    assert np.linalg.norm(carried[1] - base, axis=1) == pytest.approx(lengths, abs=1e-14)
