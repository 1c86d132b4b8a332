"""A lookup table in place of the solver: how many nodes are enough?

Tables of the extensions over roll and pitch at one height, interpolated linearly, against the solver at random poses.
The position sensors of the machine resolve 0.11 mm (12 bits over 450 mm). `ik_tables` writes such a table for a
controller and verifies it; `libsms/examples/04_table.c` reads one.
"""

import argparse

import numpy as np
import sms
from scipy.interpolate import RegularGridInterpolator

parser = argparse.ArgumentParser(description="Error of a lookup table by its size.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
parser.add_argument("--seed", type=int, default=1)
options = parser.parse_args()

HEIGHT, LIMIT, RESOLUTION = 0.5, 0.1, 0.45 / 2**12  # m, rad, m

poses = np.random.default_rng(options.seed).uniform(-LIMIT, LIMIT, (20_000, 2))
solved = sms.inverse_kinematics(poses[:, 0], poses[:, 1], HEIGHT).extension

nodes = np.array([3, 5, 11, 21, 51, 101])
errors = []
for count in nodes:
    axis = np.linspace(-LIMIT, LIMIT, count)
    roll, pitch = np.meshgrid(axis, axis, indexing="ij")
    table = sms.inverse_kinematics(roll, pitch, HEIGHT).extension
    interpolated = RegularGridInterpolator((axis, axis), table)(poses)
    errors.append(np.abs(interpolated - solved).max())
    bytes_ = 4 * table.size
    print(
        f"{count:3d} x {count:3d} nodes, {bytes_:6d} bytes in float: wrong by {1e6 * errors[-1]:8.3f} um"
    )

enough = nodes[np.array(errors) < RESOLUTION][0]
print(f"finer than the position sensor from {enough} x {enough} nodes on")

if options.picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
    axes.loglog(nodes, 1e6 * np.array(errors), "o-", label="bilinear table")
    axes.axhline(1e6 * RESOLUTION, color="0.5", linestyle="--", label="resolution of the sensor")
    axes.set(xlabel="nodes along each axis", ylabel="largest error [um]")
    axes.legend()
    figure.savefig(options.picture)
