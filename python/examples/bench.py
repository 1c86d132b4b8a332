"""One actuator on the bench: the valve opens by a volt to one side and the other, the piston follows.

Around its centre the valve passes little: 0.3 V beside it the piston creeps. The run is a table with the
truth, and beside it what the sensors say.
"""

import argparse

import numpy as np
import sms

parser = argparse.ArgumentParser(description="An open-loop run of the bench.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
picture = parser.parse_args().picture

params = sms.Params()
time = np.arange(0.0, 6.0, params.control_period)
command = params.valve_centre + np.select(
    [time < 1.0, time < 2.0, time < 4.0], [0.3, 1.0, -1.0], default=0.0
)
channels = {
    "extension": sms.Channel(noise=0.04e-3, resolution=0.11e-3),
    "chamber_pressure_lower": sms.Channel(noise=300.0),
}
run = sms.simulate_bench(command, params=params, channels=channels, seed=1)

moved = np.abs(run["extension"] - run["extension"][0])
print(f"0.3 V beside the centre: moves {1e3 * moved[time < 1.0].max():.1f} mm in the first second")
print(f"1 V beside it: reaches {1e3 * np.abs(run['velocity']).max():.0f} mm/s")
print(f"{run.steps} steps of the integrator for {time[-1]:.0f} s, {run.evaluations} evaluations")
noise = run.reading("chamber_pressure_lower") - run["chamber_pressure_lower"]
print(f"noise of the pressure sensor: {noise.std():.0f} Pa")

if picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(3, 1, figsize=(8, 6), sharex=True, layout="constrained")
    axes[0].plot(run.time, command)
    axes[0].set(ylabel="valve command [V]")
    axes[1].plot(run.time, 1e3 * run["extension"])
    axes[1].set(ylabel="extension [mm]")
    for chamber in ("lower", "upper"):
        axes[2].plot(
            run.time, 1e-3 * run[f"chamber_pressure_{chamber}"], label=f"{chamber} chamber"
        )
    axes[2].set(xlabel="time [s]", ylabel="pressure [kPa absolute]")
    axes[2].legend()
    figure.savefig(picture)
