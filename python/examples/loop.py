"""The platform under its controller: a roll of three degrees as a sine, with and without dead-band compensation.

State feedback works at 1 kHz on the actuators' extensions; its set-points come from the inverse kinematics. Without the
compensation every reversal waits until the command has crossed the valve's dead band.
"""

import argparse

import numpy as np
import sms

parser = argparse.ArgumentParser(description="The platform follows a roll.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
picture = parser.parse_args().picture

params = sms.Params(position_gain=30.0, velocity_gain=0.0, acceleration_gain=0.3)
time = np.arange(0.0, 8.0, params.control_period)
roll = np.radians(3.0) * np.sin(2.0 * np.pi * 0.25 * time)
setpoints = sms.extensions_of(roll, 0.0, 0.5)

runs = {}
for words, compensated in (("compensated", True), ("not compensated", False)):
    run = sms.simulate_platform(
        setpoints, controller="state_feedback", compensated=compensated, params=params
    )
    runs[words] = run
    settled = run.time > 2.0
    error = np.degrees(run["roll"] - roll)[settled]
    print(f"dead band {words}: roll is off by {np.sqrt(np.mean(error**2)):.3f} deg rms")

if picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 1, figsize=(8, 5), sharex=True, layout="constrained")
    axes[0].plot(time, np.degrees(roll), "k--", label="asked for")
    for words, run in runs.items():
        axes[0].plot(run.time, np.degrees(run["roll"]), label=words)
        axes[1].plot(run.time, np.degrees(run["roll"] - roll), label=words)
    axes[0].set(ylabel="roll [deg]")
    axes[0].legend()
    axes[1].set(xlabel="time [s]", ylabel="error [deg]")
    figure.savefig(picture)
