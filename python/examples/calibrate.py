"""A platform that is not quite as drawn: measured in 30 poses and calibrated.

Joints, the links' lengths, and gain and zero of each sensor are off by what
nobody knows. An inclinometer reads roll and pitch, position sensors the
extensions; from these `sms calibrate geometry` works out the machine as built. In
poses that were not measured its attitude is held against that of the hidden
machine, and so is the drawing's.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import sms

parser = argparse.ArgumentParser(description="Calibrate a platform that is not as drawn.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
picture = parser.parse_args().picture

RIG = """
[rig]
name = "a platform that is not as drawn"
kind = "poses"
poses = "poses.csv"

[noise]
extension = "0.1 mm"
roll = "0.02 deg"
pitch = "0.02 deg"
"""
random = np.random.default_rng(4)
drawing, hidden = sms.LegParams(), sms.LegParams()
for name in (n for n in dir(hidden) if "_joint_" in n or "length_offset" in n):
    hidden[name] += random.normal(0.0, 2.5e-3)  # m, half the drawing's tolerance of 5 mm
for angle in ("roll", "pitch"):
    hidden[f"sensor_offset_{angle}"] = random.normal(0.0, 1e-3)  # rad
for leg in (1, 2, 3):
    hidden[f"sensor_gain_extension:{leg}"] = random.normal(0.0, 2.5e-3)
    hidden[f"sensor_offset_extension:{leg}"] = random.normal(0.0, 0.5e-3)  # m


def of_sensors(machine: sms.LegParams, what: str) -> np.ndarray:
    """Gain, or offset in m, of the three position sensors."""
    return np.array([leg[f"sensor_{what}_extension"] for leg in machine.legs])


def attitude(machine: sms.LegParams, read: np.ndarray) -> np.ndarray:
    """What an exact inclinometer reads, (n, 2) deg, of extensions read, (n, 3) m."""
    extension = (read - of_sensors(machine, "offset")) / (1.0 + of_sensors(machine, "gain"))
    pose = sms.forward_kinematics(extension, params=machine)
    zero = machine["sensor_offset_roll"], machine["sensor_offset_pitch"]
    return np.degrees(np.stack([pose.roll, pose.pitch], axis=-1) + zero)


def extensions(count: int) -> np.ndarray:
    """Of poses drawn evenly over tilt and height, within the stroke: (count, 3) m."""
    roll, pitch = random.uniform(-0.12, 0.12, (2, 20 * count))
    height = 0.5 + random.uniform(-0.12, 0.12, 20 * count)
    found = sms.inverse_kinematics(roll, pitch, height, params=drawing).extension
    inside = np.all((found > 0.02) & (found < drawing.stroke - 0.02), axis=1)
    return found[inside][:count]


measured = extensions(30)
read = attitude(hidden, measured) + random.normal(0.0, 0.02, (30, 2))
rows = np.hstack([1e3 * measured + random.normal(0.0, 0.1, measured.shape), read])
header = "extension_1 [mm],extension_2 [mm],extension_3 [mm],roll [deg],pitch [deg]"

with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    (folder / "rig.toml").write_text(RIG)
    np.savetxt(folder / "poses.csv", rows, "%.4f", delimiter=",", header=header, comments="")
    command = ["calibrate", "geometry", str(folder / "rig.toml"), "--out", str(folder / "geometry")]
    subprocess.run([sys.executable, "-m", "sms.cli", *command], check=True, capture_output=True)
    calibrated = sms.load_params(folder / "geometry" / "geometry.toml")

unseen = extensions(200)
truth = attitude(hidden, unseen)
off = {
    "drawing": attitude(drawing, unseen) - truth,
    "calibrated": attitude(calibrated, unseen) - truth,
}
for machine, error in off.items():
    usual, worst = np.sqrt(np.mean(error**2)), np.abs(error).max()
    print(f"{machine}: {usual:.4f} deg off in 200 unseen poses, {worst:.3f} at most")

if picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
    for machine, error in off.items():
        axes.quiver(*truth.T, *error.T, angles="xy", scale_units="xy", scale=0.1, width=0.003,
                    color={"drawing": "C1", "calibrated": "C0"}[machine], label=machine)  # fmt: skip
    axes.margins(0.15)
    axes.set(
        xlabel="roll [deg]", ylabel="pitch [deg]", title="errors of attitude, 10 times enlarged"
    )
    axes.legend()
    figure.savefig(picture)
