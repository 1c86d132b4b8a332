"""A loop of four FMUs in fmpy: the platform, and a position controller for each of its actuators.

In each period the controllers step first: they take the readings of the sample and give the commands for the valves;
then the platform steps with them. In this order the loop is that of `sms.simulate_platform`.
"""

import argparse
import tempfile
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import sms
from sms.fmi import Starts, export_fmu

parser = argparse.ArgumentParser(description="The platform follows a roll, as FMUs in fmpy.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
picture = parser.parse_args().picture


class Slave:
    """One instance of an FMU of FMI 3.0, by the names of its variables."""

    def __init__(self, file: Path) -> None:
        description = fmpy.read_model_description(str(file))
        self.place = {v.name: v.valueReference for v in description.modelVariables}
        self.fmu: Any = fmpy.instantiate_fmu(fmpy.extract(str(file)), description, "CoSimulation")
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def get(self, *names: str) -> list[float]:
        """Values of variables."""
        return list(self.fmu.getFloat64([self.place[name] for name in names]))

    def set(self, **values: float) -> None:
        """Inputs."""
        self.fmu.setFloat64([self.place[name] for name in values], list(values.values()))


gains = {"position_gain": 30.0, "velocity_gain": 0.0, "acceleration_gain": 0.3}
params = sms.Params(**gains)
period = params.control_period
time = np.arange(0.0, 4.0, period)
roll = np.radians(3.0) * np.sin(2.0 * np.pi * 0.5 * time)
setpoints = sms.extensions_of(roll, 0.0, 0.5)

with tempfile.TemporaryDirectory() as folder:
    files = {kind: Path(folder) / f"{kind}.fmu" for kind in ("platform", "controller")}
    export_fmu("platform", files["platform"], "3.0")
    state_feedback = Starts({"law": 2, **gains})  # as the enumeration counts
    export_fmu("controller", files["controller"], "3.0", state_feedback)
    platform = Slave(files["platform"])
    controllers = [Slave(files["controller"]) for _ in range(3)]

found = []
for now, wanted in zip(time, setpoints, strict=True):
    found.append(platform.get("roll"))
    measured = platform.get(*(f"measured_extension_{leg}" for leg in (1, 2, 3)))
    for leg, controller in enumerate(controllers):
        controller.set(setpoint=wanted[leg], measured_extension=measured[leg])
        controller.fmu.doStep(now, period)
        platform.set(**{f"valve_command_{leg + 1}": controller.get("valve_command")[0]})
    platform.fmu.doStep(now, period)

run = sms.simulate_platform(setpoints, controller="state_feedback", params=params, tolerance=1e-7)
error = np.degrees(np.array(found)[:, 0] - roll)
apart = np.degrees(np.abs(np.array(found)[:, 0] - run["roll"]).max())
print(f"roll of the FMUs is off by {np.sqrt(np.mean(error[time > 2.0] ** 2)):.3f} deg rms")
print(f"it is that of sms.simulate_platform to 1e-12 deg: {apart < 1e-12}")

if picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 1, figsize=(8, 5), sharex=True, layout="constrained")
    axes[0].plot(time, np.degrees(roll), "k--", label="asked for")
    axes[0].plot(time, np.degrees(run["roll"]), linewidth=4, alpha=0.4, label="sms")
    axes[0].plot(time, np.degrees(np.array(found)[:, 0]), label="four FMUs in fmpy")
    axes[0].set(ylabel="roll [deg]")
    axes[0].legend()
    axes[1].plot(time, error)
    axes[1].set(xlabel="time [s]", ylabel="FMUs less asked for [deg]")
    figure.savefig(picture)
