"""The extensions of the three actuators for a roll, a pitch and a height, and the pose computed back from them.

Yaw, x and y are not free: the three Panhard rods decide them, and the solution has them too. Inputs are arrays that
broadcast, so a whole motion is one call.
"""

import argparse

import numpy as np
import sms

parser = argparse.ArgumentParser(description="Inverse and forward kinematics.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
picture = parser.parse_args().picture

# ---- one pose there and back ----
roll, pitch, height = np.radians(5.0), np.radians(-3.0), 0.5
pose = sms.inverse_kinematics(roll, pitch, height)
back = sms.forward_kinematics(pose.extension)
print(f"extensions {np.round(1e3 * pose.extension, 3)} mm, {pose.iterations} Newton steps")
print(f"yaw {np.degrees(pose.yaw):.4f} deg, x {1e3 * pose.x:.3f} mm, y {1e3 * pose.y:.3f} mm")
print(
    f"back: roll is off by {abs(back.roll - roll):.1e} rad, height by {abs(back.height - height):.1e} m"
)

# ---- a roll from -8 to 8 degrees in one call ----
rolls = np.radians(np.linspace(-8.0, 8.0, 161))
swept = sms.inverse_kinematics(rolls, 0.0, height)
stroke = sms.Params().stroke
inside = ((swept.extension > 0.0) & (swept.extension < stroke)).all(axis=1)
print(f"within the stroke of {1e3 * stroke:.0f} mm: {inside.sum()} of {rolls.size} poses")

if picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    axes[0].plot(
        np.degrees(rolls), 1e3 * swept.extension, label=["actuator 1", "actuator 2", "actuator 3"]
    )
    axes[0].set(xlabel="roll [deg]", ylabel="extension [mm]")
    axes[0].legend()
    axes[1].plot(np.degrees(rolls), np.degrees(swept.yaw))
    axes[1].set(xlabel="roll [deg]", ylabel="yaw that the rods impose [deg]")
    figure.savefig(picture)
