"""One actuator on the bench in motion: the equations of reference/plants, integrated here, read as a logger reads.

Those equations were written a second time from the source (eq. 6.5 with its algebraic loop closed by another method,
the valve's map read by another routine). The classical Runge-Kutta method at 0.05 ms carries them. A slow position
loop sees the sensor and acts a sample later; between two samples the command runs straight.
"""

from __future__ import annotations

import numpy as np
from sms import Params

from validation.reference.compiled import compiled
from validation.reference.plants.actuator import CHAMBER_LAWS as CHAMBERS
from validation.reference.plants.actuator import FRICTION_LAWS, VALVE_LAWS, Laws
from validation.reference.plants.bench import bench_rate
from validation.reference.plants.flow import Array, valve_map
from validation.reference.plants.numbers import Numbers, numbers_of
from validation.twins.bench import Plan

STATES = 12
STEP = 5e-5  # s
MEAN_PRESSURE = 2.8e5  # Pa, of the two chambers at the beginning


@compiled
def run(
    p: Numbers,
    laws: Laws,
    map_: Array,
    y: Array,
    ahead: Array,
    setpoint: Array,
    gain: float,
    error: Array,
    sample: float,
    commands: Array,
    states: Array,
) -> None:
    """Fill commands (n,) and states (n, STATES) at the samples; y is where the run starts."""
    steps = round(sample / STEP)
    dt = sample / steps
    k1, k2, k3, k4 = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    states[0] = y
    commands[0] = min(10.0, max(0.0, 5.0 + ahead[0]))
    for k in range(commands.size - 1):
        wanted = 5.0 + ahead[k + 1] + gain * (setpoint[k] - y[0] - error[k])
        commands[k + 1] = min(10.0, max(0.0, wanted))
        slope = (commands[k + 1] - commands[k]) / steps
        for i in range(steps):
            u = commands[k] + slope * i
            bench_rate(p, laws, map_, y, u, 0.0, k1)
            bench_rate(p, laws, map_, y + 0.5 * dt * k1, u + 0.5 * slope, 0.0, k2)
            bench_rate(p, laws, map_, y + 0.5 * dt * k2, u + 0.5 * slope, 0.0, k3)
            bench_rate(p, laws, map_, y + dt * k3, u + slope, 0.0, k4)
            y += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states[k + 1] = y


def at_rest(p: Numbers, extension: float) -> Array:
    """The two chambers hold each other."""
    bore, ring = p.bore_diameter**2, p.bore_diameter**2 - p.rod_diameter**2
    lower = p.ambient_pressure + (MEAN_PRESSURE - p.ambient_pressure) * ring / bore
    y = np.zeros(STATES)
    y[0], y[2], y[4] = extension, lower, MEAN_PRESSURE
    y[3] = y[5] = p.air_temperature
    y[6] = y[8] = p.valve_centre
    y[11] = p.supply_pressure
    return y


def move(
    params: Params, plan: Plan, sample: float, reading_noise: Array
) -> tuple[Array, dict[str, Array]]:
    """Commands (n,) and the true signals (n,) of one run, sampled every `sample` seconds."""
    numbers = numbers_of(params)
    laws = Laws(
        VALVE_LAWS["iso_0_4_mpa"], FRICTION_LAWS["acceleration_dependent"], CHAMBERS["polytropic"]
    )
    n = plan.setpoint.size
    commands, states = np.zeros(n), np.zeros((n, STATES))
    run(
        numbers, laws, valve_map("iso_0_4_mpa"), at_rest(numbers, plan.start), plan.feedforward,
        plan.setpoint, plan.gain, reading_noise, sample, commands, states,
    )  # fmt: skip
    return commands, {
        "extension": states[:, 0],
        "chamber_pressure_lower": states[:, 2],
        "chamber_pressure_upper": states[:, 4],
        "supply_pressure": np.full(n, params.supply_pressure),
    }
