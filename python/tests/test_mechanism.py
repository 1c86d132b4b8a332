"""Mechanisms given by data: the built-in platform as one, raw equations solved by scipy, what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sms
from numpy.typing import NDArray
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation
from sms import NotANumberError, OutOfWorkspaceError, StatusError
from sms.errors import InputError
from sms.mechanism import Leg, Mechanism
from sms.mechanism_file import load_mechanism, shipped

RPS = load_mechanism("three_rps")
DIETMAIER = load_mechanism("dietmaier_hexapod")


def random() -> np.random.Generator:
    seed = int(np.random.SeedSequence().generate_state(1)[0])
    print(f"seed {seed}")
    return np.random.default_rng(seed)


def built_in() -> Mechanism:
    """The platform of params.def, z down: three actuators, three rods."""
    p = sms.Params()
    reference = np.array([p.reference_point_x, p.reference_point_y, p.reference_point_z])

    def point(kind: str, i: int) -> NDArray[np.float64]:
        return np.array([p[f"{kind}_joint_{i}_{axis}"] for axis in "xyz"])

    legs = []
    for i in range(1, 7):
        base, platform = point("base", i), point("platform", i)
        rod = float(np.linalg.norm(platform - base)) if i > 3 else None
        legs.append(
            Leg(tuple(base), tuple(platform - reference), "actuated" if i <= 3 else "fixed", rod)
        )
    home = (*reference, 0.0, 0.0, 0.0)
    return Mechanism(tuple(legs), ("z", "roll", "pitch"), home)


def test_the_built_in_platform_by_data_is_the_built_in_platform() -> None:
    rng = random()
    mechanism = built_in()
    extension = rng.uniform(0.0, 0.4, (1000, 3))
    pose = sms.forward_kinematics(extension)
    level = sms.forward_kinematics([0.0, 0.0, 0.0])
    lengths = mechanism.inverse(mechanism.home).length[:3] + extension
    assert level.height == pytest.approx(-mechanism.home[2], abs=1e-14)
    found = mechanism.forward(lengths)
    expected = np.stack([pose.x, pose.y, -pose.height, pose.roll, pose.pitch, pose.yaw], axis=-1)
    assert np.abs(found.pose - expected).max() < 1e-12
    start = np.array(expected)
    start[:, [0, 1, 5]] = mechanism.home[0], mechanism.home[1], 0.0
    assert np.abs(mechanism.inverse(start).length[:, :3] - lengths).max() < 1e-12


def test_a_3_rps_solves_the_raw_equations_as_scipy_does() -> None:
    rng = random()

    def joints(pose: NDArray[np.float64]) -> NDArray[np.float64]:
        turn = Rotation.from_euler("ZYX", pose[[5, 4, 3]]).as_matrix()
        return np.array([pose[:3] + turn @ np.array(leg.platform) - leg.base for leg in RPS.legs])

    for _ in range(20):
        length = rng.uniform(0.95, 1.1, 3)  # further apart there may be no pose

        def wrong(
            pose: NDArray[np.float64], length: NDArray[np.float64] = length
        ) -> NDArray[np.float64]:
            links = joints(pose)
            planes = [
                link @ np.array(leg.normal) for link, leg in zip(links, RPS.legs, strict=True)
            ]
            return np.concatenate([np.linalg.norm(links, axis=1) - length, planes])

        expected = fsolve(wrong, RPS.home, xtol=1e-13)
        found = RPS.forward(length)
        assert np.abs(wrong(np.asarray(found.pose))).max() < 1e-13
        assert np.abs(found.pose - expected).max() < 1e-10


def test_a_pose_of_dietmaiers_hexapod_has_the_lengths_of_his_paper() -> None:
    printed = np.array([1.0, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071])
    found = DIETMAIER.forward(printed)
    assert np.abs(DIETMAIER.inverse(found.pose).length - printed).max() < 1e-14
    assert found.iterations <= 6


def test_shapes_broadcast_and_a_number_stands_alone() -> None:
    found = RPS.inverse(np.broadcast_to(RPS.home, (2, 5, 6)))
    assert found.pose.shape == (2, 5, 6) and found.length.shape == (2, 5, 3)
    assert RPS.jacobian(found.pose).shape == (2, 5, 6, 6)
    condition, determinant = RPS.conditioning(found.pose)
    assert condition.shape == determinant.shape == (2, 5)
    with pytest.raises(ValueError, match="its last axis must hold these 6"):
        RPS.inverse([1.0, 2.0])


def test_forces_hold_the_weight_and_give_the_motion_back() -> None:
    rng = random()
    pose = RPS.inverse([0.0, 0.0, 1.0, 0.1, -0.1, 0.0]).pose
    force = RPS.inverse_dynamics(pose)
    # A small virtual motion: the work of the legs is the rise of the weight.
    moved = np.array(pose)
    moved[2] += 1e-6
    other = RPS.inverse(moved)
    turn = [Rotation.from_euler("ZYX", p[[5, 4, 3]]).as_matrix() for p in (pose, other.pose)]
    assert RPS.body is not None
    rise = (other.pose[:3] + turn[1] @ RPS.body.cog - pose[:3] - turn[0] @ RPS.body.cog)[2]
    work = force[:3] @ (other.length - RPS.inverse(pose).length)
    assert work == pytest.approx(RPS.body.mass * 9.81 * rise, rel=1e-5)
    given = rng.uniform(0.0, 100.0, 3)
    acceleration = RPS.forward_dynamics(pose, np.zeros(6), given)
    assert RPS.inverse_dynamics(pose, np.zeros(6), acceleration)[:3] == pytest.approx(
        given, abs=1e-9
    )
    with pytest.raises(InputError, match="it has no body"):
        DIETMAIER.inverse_dynamics(DIETMAIER.home)


def test_a_singular_pose_on_a_path_is_found() -> None:
    poses = RPS.inverse([[0.0, 0.0, 1.0, 0.0, p, 0.0] for p in (0.0, 0.3, 1.2)]).pose
    (found,) = RPS.singularities(poses)
    assert found.row == 1 and 0.0 < found.fraction < 1.0
    at_home = abs(float(RPS.conditioning(RPS.home)[1]))
    assert abs(float(RPS.conditioning(found.pose)[1])) < 1e-8 * at_home
    assert RPS.singularities(poses[:2]) == []


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(NotANumberError, match="row 1: roll = nan"):
        RPS.inverse([RPS.home, (0.0, 0.0, 1.0, np.nan, 0.0, 0.0)])
    with pytest.raises(NotANumberError):
        RPS.conditioning((np.inf, *RPS.home[1:]))
    with pytest.raises(OutOfWorkspaceError, match="length 3 = -1 m"):
        RPS.forward([0.9, 0.9, -1.0])
    with pytest.raises(StatusError, match="assembly mode"):
        RPS.forward([0.9, 0.9, 5.0])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"z [m]"', '"zz [m]"', "did you mean 'z'"),
        ('"z [m]"', "z", "write '\"z [m]\"'"),
        ('"z [m]" = 1.0', '"z [kg]" = 1.0', "does not fit"),
        ("= [0.5, 0.0, 0.0]", "= [0.5, 0.0]", "leg 1, base: 3 numbers"),
        ("= [0.5, 0.0, 0.0]", '= ["0.5 m", 0.0, 0.0]', "the unit stands in the key"),
        ("= [0.5, 0.0, 0.0]", "= [nan, 0.0, 0.0]", "finite"),
        ('kind = "actuated"', 'kind = "actuate"', "none of actuated, fixed, free"),
        ('kind = "actuated"', 'kind = "fixed"', "a rod has none"),
        ("normal = [0.0, 1.0, 0.0]", "normal = [0.0, 0.0, 0.0]", "no direction"),
        ("normal = [0.0, 1.0, 0.0] # axis", "# axis", "are 5 equations; six"),
        ('driven = ["z", "roll", "pitch"]', 'driven = ["z", "roll"]', "as many coordinates"),
        ('driven = ["z", "roll", "pitch"]', 'driven = ["z", "rol", "x"]', "'rol' is none of"),
        ("[0.8, 1.3] # least", "[1.3, 0.8] # least", "least length comes first"),
        ("[mechanism]", "[mechanisms]", "did you mean 'mechanism'"),
        ("[0.0, 0.5, 0.0]", "[0.1, 0.5, 0.0]", "symmetric"),
        ("[mechanism]", "[mechanism", "not valid TOML"),
    ],
)
def test_a_wrong_file_is_refused_in_one_sentence(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    text = (Path(sms.__file__).parent / "mechanisms" / "three_rps.toml").read_text()
    assert old in text
    file = tmp_path / "m.toml"
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as refused:
        load_mechanism(file)
    assert said in str(refused.value) and str(file) in str(refused.value)


@pytest.mark.filterwarnings("error")
def test_a_normal_beyond_all_range_brings_no_warning(tmp_path: Path) -> None:
    """Seen: numpy warned of the overflow of its length beside the sentence."""
    text = (Path(sms.__file__).parent / "mechanisms" / "three_rps.toml").read_text()
    file = tmp_path / "m.toml"
    file.write_text(text.replace("normal = [0.0, 1.0, 0.0]", "normal = [0.0, 1e308, 0.0]", 1))
    assert load_mechanism(file).name == "3-RPS"  # at work it has no pose, which is said


def test_what_is_shipped_loads_and_can_stand_at_home() -> None:
    assert shipped() == ["dietmaier_hexapod", "three_rps"]
    for name in shipped():
        mechanism = load_mechanism(name)
        home = mechanism.inverse(mechanism.home)
        assert mechanism.outside_range(home.length[np.newaxis]) == []
    with pytest.raises(InputError, match="dietmaier_hexapod, three_rps"):
        load_mechanism("nothing.toml")
