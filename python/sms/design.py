"""Linear design: the simplified plant of section 8.1 and the platform at a pose, for python-control.

Needs the extra `sms[control]`. The coefficients are the core's (simplified_plant.hpp,
linear_dynamics.hpp); python-control draws root loci and frequency responses from them.

The published numbers contradict each other, so that every model here says which reading it is: see
READINGS. SI units: gains in V/m, V s/m, V s^2/m, poles in rad/s.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.dynamics import holding_force, linearise
from sms.errors import InputError
from sms.motion.speed import steady_motion

MEAN_PRESSURE = 333.5e3
"""Pa, half the sum of the published chamber pressures, 281 and 386 kPa; Table D.1 prints the sum."""
_STEP = 0.1  # m, section 8.2
_SETTLED = 20.0  # time constants of the slowest pole


@dataclass(frozen=True)
class SimplifiedPlant:
    """G(s) = C_0 w_s^2 / (s (s^2 + 2 zeta w_s s + w_s^2)), eq. 8.1 with k_m = 1, and where from."""

    reading: str
    velocity_gain: float  #: C_0, m/s per V
    natural_frequency: float  #: w_s, rad/s
    damping_ratio: float  #: zeta


@dataclass(frozen=True)
class Design:
    """State-feedback gains on a simplified plant, and the loop they give."""

    name: str
    plant: SimplifiedPlant
    position: float  #: K_p, V/m
    velocity: float  #: K_v, V s/m
    acceleration: float  #: K_a, V s^2/m; positive damps
    poles: tuple[complex, ...]  #: rad/s
    stable: bool
    rise_time: float  #: of a step, 10 to 90 %, s; NaN when not stable
    overshoot: float  #: of the step, relative
    bandwidth: float  #: -3 dB, Hz; NaN when not stable

    @property
    def gains(self) -> tuple[float, float, float]:
        """K_p, K_v, K_a."""
        return self.position, self.velocity, self.acceleration


def readings(params: Params | None = None) -> tuple[SimplifiedPlant, ...]:
    """The simplified plant as it is computed here, as printed, and as behind the printed gains."""
    params = params or Params()
    mass = (params.top_frame_mass + params.payload_mass) / 3.0 + params.piston_mass
    natural, damping = _core.simplified_plant(params, MEAN_PRESSURE, mass)
    load = float(holding_force((0.0, 0.0, 0.5), params=params).max())
    command = float(_core.valve_command(params, 1.0))
    gain = steady_motion(command, load, params=params).velocity
    return (
        SimplifiedPlant(
            f"computed: mean pressure {1e-3 * MEAN_PRESSURE:g} kPa, {mass:.1f} kg a leg, C_0 the "
            "steady speed at 1 V over the dead band",
            gain,
            natural,
            damping,
        ),
        SimplifiedPlant("as printed in Table E.1 and section 8.1", 0.85, 15.139, 0.1641),
        SimplifiedPlant(
            "behind the printed gains: they follow from these numbers only", 0.7, 26.221, 0.0947
        ),
    )


PUBLISHED: Mapping[str, tuple[float, float, float]] = {
    "published, Šitum": (15.8031, 1.3393, 0.1123),
    "published, specification based": (3.9128, -0.4780, 0.0666),
    "published, found by trial": (40.0, 1.0, -0.005),
}
"""Table E.1: K_p, K_v, K_a."""


def designs(plant: SimplifiedPlant, situm: float = 1.5, specified: float = 0.8157) -> list[Design]:
    """Both design methods on a plant, and the published gains on it.

    `situm` and `specified` are the ratio w_c / w_s of each method (eq. 8.8 to 8.10, 8.13 to 8.15).
    """
    model = plant.velocity_gain, plant.natural_frequency, plant.damping_ratio
    found = {
        "Šitum": _core.gains_situm(*model, situm),
        "Šitum, with the misprint of eq. 8.9": _core.gains_situm(*model, situm, True),
        "specification based": _core.gains_specification_based(*model, specified),
        **PUBLISHED,
    }
    return [design_of(name, plant, gains) for name, gains in found.items()]


def design_of(name: str, plant: SimplifiedPlant, gains: tuple[float, float, float]) -> Design:
    """What gains (K_p, K_v, K_a) do on a plant."""
    loop = _loop(plant, *gains)
    stable = bool(_core.is_stable(*loop))
    poles = tuple(complex(pole) for pole in _core.poles(*loop))
    rise, overshoot = _step_numbers(loop, poles) if stable else (math.nan, math.nan)
    bandwidth = _bandwidth(loop) if stable else math.nan
    return Design(name, plant, *gains, poles, stable, rise, overshoot, bandwidth)


def transfer_function(plant: SimplifiedPlant) -> Any:
    """G of eq. 8.1 as a `control.TransferFunction`, extension in m over volts."""
    square, linear, _ = _loop(plant, 0.0, 0.0, 0.0)
    _, _, drive = _loop(plant, 1.0, 0.0, 0.0)
    return _control().tf([drive], [1.0, square, linear, 0.0], inputs="u", outputs="x")


def closed_loop(design: Design) -> Any:
    """T of eq. 8.5 as a `control.TransferFunction`, extension over set-point."""
    square, linear, constant = _loop(design.plant, *design.gains)
    denominator = [1.0, square, linear, constant]
    return _control().tf([constant], denominator, inputs="r", outputs="x")


def open_loop(design: Design) -> Any:
    """What a loop gain K_c multiplies: G (K_p + K_v s + K_a s^2), for root locus and margins."""
    feedback = _control().tf([design.acceleration, design.velocity, design.position], [1.0])
    return transfer_function(design.plant) * feedback


def root_locus(design: Design, loop_gains: ArrayLike) -> Array:
    """Poles (rad/s, complex, (n, 3)) over loop gains K_c (n,)."""
    wanted = np.asarray(loop_gains, dtype=np.float64)
    loci = _control().root_locus_map(open_loop(design), gains=wanted).loci
    return np.asarray(loci)


def bode(system: Any, frequency: ArrayLike) -> tuple[Array, Array]:
    """Amplitude ratio and phase (rad, unwrapped) of a `control` system over frequencies in Hz."""
    omega = 2.0 * math.pi * np.asarray(frequency, dtype=np.float64)
    values = np.asarray(system(1j * omega)).reshape(-1)
    return np.abs(values), np.unwrap(np.angle(values))


def platform_state_space(
    q: ArrayLike = (0.0, 0.0, 0.5),
    stiffness: ArrayLike | None = None,
    damping: ArrayLike | None = None,
    masses: str = "corrected",
    *,
    params: Params | None = None,
) -> Any:
    """The platform about a pose at rest as a `control.StateSpace`.

    Args:
        q: (roll, pitch, height), rad, rad, m.
        stiffness: of each actuator, N/m; by default its air spring at MEAN_PRESSURE.
        damping: of each actuator, N s/m; by default the viscous friction.
        masses: reading of the mass table.
        params: the machine.

    States are (roll, pitch, height) and their rates, inputs the three actuators' forces (N) beyond
    those that hold the pose, outputs roll, pitch and height. Equation: linear_dynamics.hpp.
    """
    params = params or Params()
    if stiffness is None:
        stiffness = float(_core.air_spring(params, MEAN_PRESSURE))
    if damping is None:
        damping = params.viscous_friction
    model = linearise(q, stiffness, damping, masses, params=params)
    return _control().ss(
        model.a,
        model.b,
        np.eye(3, 6),
        np.zeros((3, 3)),
        inputs=["force_1", "force_2", "force_3"],
        outputs=["roll", "pitch", "height"],
        states=["roll", "pitch", "height", "roll_rate", "pitch_rate", "height_rate"],
    )


def step_response(design: Design, time: Array) -> Array:
    """Extension (m, (n,)) after a set-point step of 0.1 m at time 0."""
    answer = _control().step_response(closed_loop(design), time)
    return _STEP * np.asarray(answer.outputs).reshape(-1)


def _loop(
    plant: SimplifiedPlant, position: float, velocity: float, acceleration: float
) -> tuple[float, float, float]:
    """Coefficients of the loop's denominator s^3 + a s^2 + b s + c; c is the numerator too."""
    model = plant.velocity_gain, plant.natural_frequency, plant.damping_ratio
    square, linear, constant = _core.closed_loop(*model, position, velocity, acceleration)
    return float(square), float(linear), float(constant)


def _step_numbers(
    loop: tuple[float, float, float], poles: tuple[complex, ...]
) -> tuple[float, float]:
    control = _control()
    slowest = min(-pole.real for pole in poles)
    time = np.linspace(0.0, _SETTLED / slowest, 20001)
    square, linear, constant = loop
    system = control.tf([constant], [1.0, square, linear, constant])
    info = control.step_info(system, T=time, RiseTimeLimits=(0.1, 0.9))
    return float(info["RiseTime"]), float(info["Overshoot"]) / 100.0


def _bandwidth(loop: tuple[float, float, float]) -> float:
    frequency = np.geomspace(1e-2, 1e2, 40001)
    amplitude, _ = _core.frequency_response(*loop, frequency)
    below = np.flatnonzero(np.asarray(amplitude) < math.sqrt(0.5))
    return float(frequency[below[0]]) if below.size else math.nan


def _control() -> Any:
    """python-control, which is an extra."""
    try:
        import control  # noqa: PLC0415 (an extra, and it takes a second)
    except ImportError:
        raise InputError(
            'design needs one more package: pip install "sms[control]" (python-control)'
        ) from None
    return control
