"""A seal that rubs the more, the higher the pressure, is hidden in records of a cylinder; the diagnosis has to find it.

Rod force, position and pressure are recorded while the rod goes out and in at several pressures, as on the cylinder of
the README. The rig file declares what is known and no fault. The records come from the same equations that the
diagnosis uses, which a real machine does not do; how often it is right on machines that are not quite the model is
counted in blind trials.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np
import sms
from sms.diagnosis import diagnose
from sms.io import write_record
from sms.report.files import write_diagnosis

parser = argparse.ArgumentParser(description="Hide an effect, and let the diagnosis find it.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
parser.add_argument("--out", type=Path, help="folder for records, report.html and diagnosis.json")
parser.add_argument("--seed", type=int, default=1)
options = parser.parse_args()

HIDDEN = 1.0e-5  # N/Pa: 1 N of Coulomb friction for each bar
AMBIENT = 101.3e3  # Pa
PERIOD = 0.01  # s
RIG = """
[rig]
kind = "cylinder"
title = "a cylinder that hides something"

[data]
speed_above = "4 mm/s"

[signals]
time = "time"
extension = "extension"
chamber_pressure_lower = { column = "chamber_pressure_lower", noise = "200 Pa" }
rod_force = { column = "rod_force", noise = "0.3 N" }

[parameters]
bore_diameter = { value = "32 mm", uncertainty = "0.02 mm" }
rod_diameter = { value = "0 mm", uncertainty = "0 mm" }
stroke = { value = "200 mm", uncertainty = "5 mm" }
moving_mass = { value = "0.3 kg", uncertainty = "0.05 kg" }
ambient_pressure = { value = "101.3 kPa", uncertainty = "0.1 kPa" }
coulomb_force = { fit = true, value = "10 N" }
viscous_friction = { fit = true, value = "50 N s/m" }
stribeck_acceleration_factor = { value = "0 s^2/m", uncertainty = "0 s^2/m" }
stiction_velocity = "1 mm/s"
"""

machine = sms.Params(
    bore_diameter=0.032, rod_diameter=0.0, stroke=0.2, moving_mass=0.3, ambient_pressure=AMBIENT,
    coulomb_force=9.0, viscous_friction=60.0, pressure_friction=HIDDEN,
    stribeck_acceleration_factor=0.0, stiction_velocity=1e-3,
)  # fmt: skip
rng = np.random.default_rng(options.seed)


def measured(gauge: float, strokes: int = 12) -> dict[str, np.ndarray]:
    """The rod goes out and in between 40 and 160 mm, one chamber at a constant pressure."""
    rate = np.pi / 2.0  # rad/s: a stroke takes two seconds
    time = np.arange(0.0, np.pi * strokes / rate, PERIOD)
    extension = 0.1 - 0.06 * np.cos(rate * time)
    velocity, acceleration = 0.06 * rate * np.sin(rate * time), 0.06 * rate**2 * np.cos(rate * time)
    pressure = AMBIENT + gauge + 200.0 * rng.standard_normal(time.size)
    force = sms.rod_force(
        velocity, acceleration, extension, AMBIENT + gauge, AMBIENT, params=machine
    )
    return {
        "time": time,
        "extension": extension,
        "chamber_pressure_lower": pressure,
        "rod_force": force + 0.3 * rng.standard_normal(time.size),
    }


with tempfile.TemporaryDirectory() as temporary:
    folder = options.out or Path(temporary)
    folder.mkdir(parents=True, exist_ok=True)
    text = RIG
    for bar, role in ((1, "identify"), (5, "identify"), (3, "validate"), (7, "validate")):
        write_record(folder / f"{bar} bar.csv", measured(1e5 * bar))
        text += f'\n[[records]]\nfile = "{bar} bar.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text)
    answer = diagnose(folder / "rig.toml", options.seed)
    if options.out:
        write_diagnosis(answer, folder / "rig.toml", folder / "report")

print(f"{answer.verdict}: {answer.sentence}")
for cause in answer.causes:
    for p in cause.parameters:
        print(
            f"{p.name} = {p.value:.3g} +- {p.standard_error:.1g} {p.unit}; hidden was {HIDDEN:.3g}"
        )
for g in answer.gain:
    print(f"{g.record}, {g.signal}: {g.baseline_rms:.2f} -> {g.extended_rms:.2f} {g.unit}")

if options.picture:
    import matplotlib.pyplot as plt

    shown = [s for s in answer.series if s.role == "validate"]
    figure, axes = plt.subplots(len(shown), 1, figsize=(8, 5), sharex=True, layout="constrained")
    for axis, series in zip(axes, shown, strict=True):
        rows = series.time < 10.0
        for label, model in (("as declared", series.baseline), ("with the cause", series.extended)):
            axis.plot(series.time[rows], (series.measured - model)[rows], label=label)
        axis.set(ylabel=f"error of the force [{series.unit}]", title=f"{series.record}, not fitted")
    axes[0].legend()
    axes[-1].set(xlabel="time [s]")
    figure.savefig(options.picture)
