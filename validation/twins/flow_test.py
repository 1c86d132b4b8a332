"""A tank that is charged or discharged through a valve: an independent simulator.

Written from the laws alone; it does not import, call or copy the core. What differs on purpose:

- the state is the mass of air in the tank, in kilograms (and its energy where heat is exchanged),
  not the pressure;
- the spool follows its command as a damped oscillator, so that it overshoots while it opens;
- the equations are integrated by LSODA (variable order, variable step) at a tolerance far below the
  noise;
- noise, resolution and the lower end of the sensor's range come on top.

The law of the component is that of reference/iso6358.py. SI units, pressures absolute.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, exp, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import odeint

from validation.reference import iso6358

Array = NDArray[np.float64]

R = 288.0  # J/(kg K)
ATMOSPHERE = (iso6358.DENSITY, iso6358.TEMPERATURE)


@dataclass(frozen=True)
class Component:
    """A component by ISO 6358."""

    conductance: float  # m3/(s Pa)
    ratio: float
    index: float

    def mass_flow(self, high: float, low: float, temperature: float) -> float:
        """kg/s from `high` to `low`."""
        if low >= high:
            return 0.0
        component = (self.conductance, self.ratio, self.index)
        return iso6358.mass_flow(component, high, temperature, low, ATMOSPHERE, 0.999)


@dataclass(frozen=True)
class Charging:
    """One charge or discharge, as it truly was."""

    component: Component
    charge: bool
    supply: float  # Pa
    ambient: float = 86e3  # Pa
    temperature: float = 293.0  # K, of all air that is not in the tank
    volume: float = 5e-3  # m3
    heat_ratio_in: float = 1.4
    heat_ratio_out: float = 1.0
    opening: float = 0.5  # s
    spool_frequency: float = 65.0  # Hz
    spool_damping: float = 0.7
    duration: float = 20.0  # s
    rate: float = 100.0  # samples a second


@dataclass(frozen=True)
class Sensor:
    """A pressure sensor with its converter."""

    noise: float = 323.0  # Pa, standard deviation
    colour: float = 0.0  # share of the noise that is remembered from one sample to the next
    step: float = 15.3  # Pa, 16 bits over 10 bar
    floor: float = 0.0  # Pa absolute


def simulate(test: Charging) -> tuple[Array, Array]:
    """Time and true pressure, both (n,)."""
    time = np.arange(round(test.duration * test.rate)) / test.rate
    start = test.ambient if test.charge else test.supply
    gauge = test.volume / (R * test.temperature)  # kg per Pa
    after = time[time > test.opening]
    grid = np.insert(after, 0, test.opening)

    def mass_rate(state: Array, clock: float) -> float:
        pressure = max(float(state[0]), 1e-12) / gauge
        share = _opened(test, clock - test.opening)
        if test.charge:
            flow = test.component.mass_flow(test.supply, pressure, test.temperature)
            return test.heat_ratio_in * share * flow
        flow = test.component.mass_flow(pressure, test.ambient, test.temperature)
        return -test.heat_ratio_out * share * flow

    mass = odeint(mass_rate, start * gauge, grid, rtol=1e-10, atol=1e-13, hmax=0.25, mxstep=5000)[
        :, 0
    ]
    pressure = np.full(time.size, start)
    pressure[time > test.opening] = mass[1:] / gauge
    return time, pressure


def _opened(test: Charging, since: float) -> float:
    """Share of the final opening: the step response of a damped oscillator."""
    if since <= 0.0:
        return 0.0
    omega = 2.0 * np.pi * test.spool_frequency
    zeta = test.spool_damping
    root = sqrt(1.0 - zeta**2)
    phase = omega * root * since
    return 1.0 - exp(-zeta * omega * since) * (cos(phase) + zeta / root * float(np.sin(phase)))


def read(pressure: Array, sensor: Sensor, rng: np.random.Generator) -> Array:
    """What the logger writes, (n,)."""
    white = rng.standard_normal(pressure.size)
    noise = white.copy()
    keep = sensor.colour
    for i in range(1, noise.size) if keep else ():
        noise[i] = keep * noise[i - 1] + sqrt(1.0 - keep**2) * white[i]
    reading = np.maximum(pressure, sensor.floor) + sensor.noise * noise
    return np.asarray(np.round(reading / sensor.step) * sensor.step)


# ---- the matrix of section 5.2.3 -----------------------------------------------------------------------

SPOOL = 1e-3 * np.concatenate(
    (
        [0.2, 0.25],
        np.arange(0.275, 0.41, 0.025),
        np.arange(0.45, 1.01, 0.05),
        np.arange(1.1, 1.81, 0.1),
    )
)
SUPPLIES = (286e3, 486e3)
FLOOR = 86e3 + 10e3


def true_component(spool: float, charge: bool) -> Component:
    """A valve of about the size of the source's: leakage at 0.2 mm, 2.9e-8 m3/(s Pa) when open."""
    open_share = 1.0 - exp(-(1e3 * spool - 0.185) / 0.55)
    conductance = 2.9e-8 * open_share if charge else 3.6e-8 * open_share
    ratio = 0.42 - 0.10 * open_share if charge else 0.36 - 0.08 * open_share
    index = 1.15 + 0.35 * open_share if charge else 1.30 + 0.30 * open_share
    return Component(conductance, ratio, index)


def duration_of(spool: float) -> float:
    """s; small openings were given longer, though not for ever."""
    return 60.0 if spool < 0.3e-3 else 40.0 if spool < 0.4e-3 else 20.0


def matrix() -> list[tuple[float, Charging]]:
    """(spool, test) of every run: 28 positions, two supplies, charge and discharge."""
    return [
        (
            float(spool),
            Charging(
                true_component(float(spool), charge), charge, supply, duration=duration_of(spool)
            ),
        )
        for supply in SUPPLIES
        for spool in SPOOL
        for charge in (True, False)
    ]


def sensor_of(test: Charging) -> Sensor:
    """The source's sensor: it reads nothing below 100 mbar gauge."""
    return Sensor(floor=FLOOR if not test.charge else 0.0)


def delayed(test: Charging, rng: np.random.Generator) -> Charging:
    """The same test with its opening somewhere between two samples."""
    return replace(test, opening=float(rng.uniform(0.4, 0.6)))
