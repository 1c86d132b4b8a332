"""Deck motions: read with units, sampled without overshoot, refused beyond the workspace."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sms.io import InputError
from sms.link.motion import MID_HEIGHT, check_motion, read_motion

from validation.random_cases import draw

CSV = "time [s],Roll [deg],pitch [rad],heave [mm]\n5,0,0,0\n6,1,0.01,10\n7,2,0.02,-20\n"


def write(folder: Path, text: str) -> Path:
    path = folder / "motion.csv"
    path.write_text(text)
    return path


def test_units_and_heave(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, CSV))
    assert motion.duration == 2.0
    np.testing.assert_allclose(motion.time, [0.0, 1.0, 2.0])
    np.testing.assert_allclose(motion.roll, np.radians([0.0, 1.0, 2.0]))
    np.testing.assert_allclose(motion.pitch, [0.0, 0.01, 0.02])
    np.testing.assert_allclose(motion.height, MID_HEIGHT + np.array([0.0, 0.01, -0.02]))


def test_height_and_columns_that_lack(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, "time [s],height [cm]\n0,49\n1,51\n"))
    np.testing.assert_allclose(motion.height, [0.49, 0.51])
    assert not motion.roll.any()
    assert not motion.pitch.any()


@pytest.mark.parametrize(("text", "said"), [
    (CSV.replace("time", "clock"), "no column 'time"),
    (CSV.replace("7,", "6,"), "time must grow"),
    (CSV.replace("[mm]", ""), "the unit is missing; name it 'heave"),
    (CSV.replace("-20", "-"), "line 4, heave: '-' is not a number"),
    (CSV.replace("pitch [rad]", "height [m]"), "both heave and height"),
    ("time [s],rol [deg]\n0,1\n1,1\n", "did you mean 'roll'"),
    (CSV.replace("[rad]", "[kg]"), "does not fit"),
])  # fmt: skip
def test_what_is_no_motion_is_said(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError, match=r"motion\.csv") as caught:
        read_motion(write(tmp_path, text))
    assert said in str(caught.value)


def test_between_samples_a_motion_stays_between_them(tmp_path: Path) -> None:
    random = draw("test_between_samples_a_motion_stays_between_them")
    rolls = random.uniform(-5.0, 5.0, 30)
    lines = [f"{0.2 * i},{r}" for i, r in enumerate(rolls)]
    motion = read_motion(write(tmp_path, "\n".join(["time [s],roll [deg]", *lines]) + "\n"))
    fine = motion.at(0.01 * np.arange(20 * 29))[:, 0]
    np.testing.assert_allclose(fine[::20], motion.roll[:-1], atol=1e-12)
    for i in range(29):
        low, high = sorted(np.radians(rolls[i : i + 2]))
        inside = fine[20 * i : 20 * i + 20]
        assert np.all((inside >= low - 1e-12) & (inside <= high + 1e-12))
    outside = motion.at(np.array([-1.0, motion.duration + 1.0]))[:, 0]
    np.testing.assert_allclose(outside, motion.roll[[0, -1]], atol=1e-12)


def test_a_motion_beyond_the_stroke_is_refused_with_a_scale_that_fits(tmp_path: Path) -> None:
    text = "time [s],roll [deg],heave [m]\n0,0,0\n1,9,0.05\n2,12,0\n"
    motion = read_motion(write(tmp_path, text))
    with pytest.raises(
        InputError, match=r"leaves the workspace at [12]\.00 s: extension \d"
    ) as caught:
        check_motion(motion)
    scale = float(str(caught.value).split("--scale ")[1].split(" ")[0])
    check_motion(motion.scaled(scale))
    with pytest.raises(InputError):
        check_motion(motion.scaled(scale + 0.01))


def test_a_motion_that_fits_at_no_scale(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, "time [s],roll [deg]\n0,0\n1,80\n"))
    with pytest.raises(InputError, match="so far that the rods cannot follow"):
        check_motion(motion)
