"""Flow identified from published vessel discharges and fillings: conductance with its error, and which tank.

    python -m validation.measured.flow [--data FOLDER]

The curves were digitised by the HydDown project from the original papers (air and nitrogen; MIT). On
each, pressure alone identifies C of the orifice with the tank taken as

  adiabatic        the full energy equation without heat from the wall
  heat transfer    the same with the wall's heat, its coefficient fitted too
  polytropic       the source's own: constant temperature, ratios 1.4 in and 1.0 out

and each is judged on the curve it did not see: the gas temperature. A sharp orifice is nearly an
ideal nozzle of reduced area, so b = 0.528 and m is that of the ideal curve (fitted to it here); the
classic law then gives its discharge coefficient, to hold against HydDown's 0.84 and 0.80.
"""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from scipy.optimize import curve_fit
from sms import _core
from sms.identification.estimate import Estimate, Free, estimate, with_start

Array = NDArray[np.float64]

CURVES = ("Air_790kPa_21mm", "Air_3-7kPa_271mm", "N2_Exp_I1")
GAS = {"air": (287.05, 1.40), "N2": (296.8, 1.40)}  # J/(kg K), ratio of heat capacities
READING = 0.005
"""Share of the pressure range by which a digitised point may be off (a line's width)."""
MODELS = ("adiabatic", "heat transfer", "polytropic")


@dataclass(frozen=True)
class Curve:
    """One published curve, SI."""

    name: str
    charge: bool
    time: Array
    pressure: Array
    temperature_time: Array
    temperature: Array
    params: _core.Params
    orifice_area: float
    published_coefficient: float


def load(file: Path) -> Curve:
    """Read one of HydDown's files. Gas temperature: the mean, or of the sensors that are given."""
    data: dict[str, Any] = yaml.safe_load(file.read_text())
    vessel, valve = data["vessel"], data["valve"]
    bottom = np.pi / 4 * vessel["diameter"] ** 2
    gas, kappa = GAS[data["initial"]["fluid"]]
    charge = valve["flow"] == "filling"
    pressure = data["validation"]["pressure"]
    sensors = [v for k, v in data["validation"]["temperature"].items() if k.startswith("gas")]
    at = np.array(sensors[0]["time"], dtype=float)
    readings = [np.interp(at, s["time"], s["temp"]) for s in sensors]
    ambient = float(data["heat_transfer"]["temp_ambient"])
    params = _core.Params(
        tank_volume=bottom * vessel["length"],
        tank_wall_area=2 * bottom + np.pi * vessel["diameter"] * vessel["length"],
        gas_constant=gas,
        heat_capacity_ratio=kappa,
        reference_density=1e5 / (gas * 293.15),
        air_temperature=ambient,
        wall_temperature=float(data["initial"]["temperature"]),
        tank_initial_pressure=float(data["initial"]["pressure"]),
        ambient_pressure=min(float(valve["back_pressure"]), 1.2e5),
        supply_pressure=min(float(valve["back_pressure"]), 1.2e6),
        opening_duration=0.0,
    )
    order = np.argsort(at)
    return Curve(
        file.stem,
        charge,
        np.array(pressure["time"], dtype=float),
        1e5 * np.array(pressure["pres"], dtype=float),
        at[order],
        np.mean(readings, axis=0)[order],
        params,
        np.pi / 4 * float(valve["diameter"]) ** 2,
        float(valve["discharge_coef"]),
    )


def nozzle_index(params: _core.Params) -> float:
    """m with which the ISO law comes nearest to an ideal nozzle, b = 0.528."""
    ratio = np.linspace(0.53, 0.998, 200)
    flow = np.asarray(_core.classic_mass_flow(params, 1e-4, 1e6, 1e6 * ratio, 293.0))
    flow = flow / float(_core.classic_mass_flow(params, 1e-4, 1e6, 1e5, 293.0))

    def law(r: Array, m: float) -> Array:
        return np.asarray(np.sqrt(1.0 - ((r - 0.528) / 0.472) ** m))

    return float(curve_fit(law, ratio, flow, p0=[2.0])[0][0])


def fit(curve: Curve, model: str) -> Estimate:
    """C (and the wall's coefficient) from the pressures."""
    start = with_start(
        curve.params,
        component_critical_ratio=0.528,
        component_subsonic_index=nozzle_index(curve.params),
        component_conductance=float(_core.sonic_conductance(curve.params, curve.orifice_area)),
        opening_time=0.0,
    )
    free = [Free.of("component_conductance")]
    free.append(Free("tank_initial_pressure", 1.0, 1e9, 0.01 * curve.params.tank_initial_pressure))
    if curve.charge:
        free.append(Free("supply_pressure", 9e4, 1.1e5, 1e3))
    if model == "adiabatic":
        start = with_start(start, heat_transfer_coefficient=0.0)
    if model == "heat transfer":
        free.append(Free("heat_transfer_coefficient", 0.0, 500.0))
    heat = "polytropic" if model == "polytropic" else "energy"
    problem = _core.TankProblem(
        time=curve.time, pressure=curve.pressure, charge=curve.charge, heat=heat
    )
    noise = READING * float(np.ptp(curve.pressure))
    return estimate(problem, [start], free, np.full(curve.time.size, 1.0 / noise))


def unseen(curve: Curve, found: Estimate, model: str) -> float:
    """Root mean square error of the gas temperature, K: the curve that was not used."""
    heat = "polytropic" if model == "polytropic" else "energy"
    problem = _core.TankProblem(
        time=curve.temperature_time,
        pressure=np.interp(curve.temperature_time, curve.time, curve.pressure),
        temperature=curve.temperature,
        charge=curve.charge,
        heat=heat,
    )
    residual, _ = problem.evaluate(found.params)
    return float(np.sqrt(np.mean(residual[curve.temperature_time.size :] ** 2)))


def table(folder: Path) -> str:
    """The table in Markdown."""
    lines = [
        "| curve | tank | C [l/s per bar], ± 1 sd | C_d (HydDown's) | h [W/(m² K)] | pressure residual [% of range] "
        "| temperature residual, not fitted [K] |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in CURVES:
        curve = load(folder / f"{name}.yml")
        for model in MODELS:
            found = fit(curve, model)
            c, sd = found.params.component_conductance, found.sd("component_conductance")
            unit = with_start(curve.params, discharge_coefficient=1.0)
            coefficient = c / float(_core.sonic_conductance(unit, curve.orifice_area))
            h = "0" if model == "adiabatic" else ""
            if model == "heat transfer":
                value = found.params.heat_transfer_coefficient
                h = f"{value:.3g} ± {found.sd('heat_transfer_coefficient'):.2g}"
            left = 100 * float(np.sqrt(np.mean(found.residual**2))) / float(np.ptp(curve.pressure))
            lines.append(
                f"| {name} | {model} | {1e8 * c:.4g} ± {1e8 * sd:.2g} | {coefficient:.3f} "
                f"({curve.published_coefficient:g}) | {h} | {left:.2f} | {unseen(curve, found, model):.1f} |"
            )
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m validation.measured.flow")
    default = Path(os.environ.get("SMS_DATA", "../shared/data")) / "vessel_blowdown_hyddown"
    parser.add_argument("--data", type=Path, default=default)
    options = parser.parse_args()
    if not options.data.is_dir():
        sys.exit(f"{options.data}: not there; set SMS_DATA to the folder that holds the data")
    print(table(options.data))


if __name__ == "__main__":
    main()
