"""Sonic conductance and critical pressure ratio of a valve from charges of a tank, as ISO 6358 defines them.

The charges are simulated here with a pressure sensor that has noise and 12 bits, written as records with a rig file,
and identified from these files: what `sms identify flow rig.toml` does. The simulation's own numbers are printed
beside the estimates.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np
import sms
from sms.identification.flow import fit_records
from sms.identification.flow_problem import COMPONENT
from sms.identification.flow_rig import load_flow_test
from sms.io import write_table

UNIT = 1e8  # m^3/(s Pa) in dm^3/(s bar)

parser = argparse.ArgumentParser(description="C and b of a valve, from charges of a tank.")
parser.add_argument("--picture", help="file for the picture, which needs matplotlib")
parser.add_argument("--seed", type=int, default=1)
options = parser.parse_args()

RIG = """
[rig]
kind = "flow_test"

[signals]
time = "time"
tank_pressure = {{ column = "tank_pressure", noise = "300 Pa" }}

[parameters]
tank_volume = {{ value = "{volume} m^3", uncertainty = "{spread} m^3" }}
"""
RECORD = """
[[records]]
file = "{name}.csv"
role = "identify"
conditions = {{ spool_position = "{spool} m" }}
"""

params = sms.Params()
sensor = sms.Channel(noise=300.0, resolution=1e6 / 2**12)
runs: dict[str, sms.Run] = {}

with tempfile.TemporaryDirectory() as folder:
    text = RIG.format(volume=params.tank_volume, spread=0.004 * params.tank_volume)
    for volts in (5.9, 6.0, 6.2):
        closed, opened = np.full(1_000, params.valve_centre), np.full(19_000, volts)
        run = sms.simulate_tank(
            np.concatenate((closed, opened)),
            params=params,
            channels={"tank_pressure": sensor},
            seed=options.seed + len(runs),
        )
        name = f"charge at {volts:.1f} V"
        columns = {"time [s]": run.time, "tank_pressure [Pa]": run.reading("tank_pressure")}
        write_table(Path(folder) / f"{name}.csv", {n: v[::10] for n, v in columns.items()})
        spool = params.spool_linear_1 * volts + params.spool_linear_0
        text += RECORD.format(name=name, spool=spool)
        runs[name] = run
    (Path(folder) / "rig.toml").write_text(text)
    rig, records, _findings = load_flow_test(Path(folder) / "rig.toml")
    fits = fit_records(records, rig.declared, rig.model.chambers)

commands = np.array([float(name.split()[2]) for name in runs])
unit_flow = params.supply_pressure * params.reference_density
unit_flow *= np.sqrt(params.reference_temperature / params.air_temperature)
settled = round(1.1 / params.control_period)  # the spool has come to rest, and the flow is choked
simulated = [run["mass_flow"][settled] / unit_flow for run in runs.values()]
found = [[fit.known[name] for name in COMPONENT[:2]] for fit in fits]
for name, (c, b), truth in zip(runs, found, simulated, strict=True):
    print(
        f"{name}: C = {UNIT * c.value:.3f} ({UNIT * c.lower:.3f} to {UNIT * c.upper:.3f}) dm^3/(s bar), "
        f"simulated with {UNIT * truth:.3f}; b = {b.value:.2f} ({b.lower:.2f} to {b.upper:.2f})"
    )

if options.picture:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for name, run in runs.items():
        axes[0].plot(run.time, 1e-3 * run.reading("tank_pressure"), label=name)
    axes[0].set(xlabel="time [s]", ylabel="tank pressure [kPa absolute]")
    axes[0].legend()
    value = np.array([c.value for c, _ in found])
    interval = np.abs([[c.lower for c, _ in found], [c.upper for c, _ in found]] - value)
    axes[1].errorbar(
        commands, UNIT * value, UNIT * interval, fmt="o", capsize=4, label="identified"
    )
    axes[1].plot(commands, UNIT * np.array(simulated), "k_", markersize=16, label="simulated")
    axes[1].set(xlabel="valve command [V]", ylabel="C [dm^3/(s bar)]")
    axes[1].legend()
    figure.savefig(options.picture)
