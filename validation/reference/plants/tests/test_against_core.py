"""The core's plants against the second writing of them, and against themselves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sms
from sms import Params, _core
from sms.simulation import Run

from validation import random_cases
from validation.reference.multibody.mechanism import mechanism_of
from validation.reference.plants import bench, platform, tank
from validation.reference.plants.actuator import Laws, valve_flows
from validation.reference.plants.flow import Array, valve_map
from validation.reference.plants.mechanism import equations
from validation.reference.plants.numbers import numbers_of

AGREEMENT = 1e-6
"""Of the range of a signal, over the whole run."""
TIGHT = 1e-9
"""Tolerance of the core at which its own error is out of the way."""
EVERYTHING = {
    "supply_line_resistance": 1e6,
    "supply_line_turbulence": 1e9,
    "piston_leakage": 1e-9,
    "piston_leakage_index": 0.7,
    "chamber_leakage_lower": 1e-10,
    "chamber_leakage_index_lower": 0.4,
    "chamber_leakage_upper": 2e-10,
    "valve_leakage": 3e-11,
    "leakage_critical_ratio": 0.1,
    "leakage_index": 1.3,
    "dead_band_change": 0.03,
    "exhaust_flow_change": -0.2,
    "tube_length": 1.0,
    "tube_loss_factor": 1.5,
    "cushion_damping": 300.0,
    "pressure_friction": 2e-5,
    "pressure_stiction": 1e-6,
    "direction_friction": 3.0,
    "position_friction": 0.5,
    "exponential_friction_force": 4.0,
    "coulomb_force_deceleration_change": -5.0,
    "viscous_friction_deceleration_change": 20.0,
}


@pytest.fixture(scope="module")
def rng() -> np.random.Generator:
    return random_cases.draw("plants")


def published_sine(duration: float, period: float) -> Array:
    """The command of section 7.2, V: 0.54 V at 0.328 Hz with a step over the dead band."""
    t = period * np.arange(round(duration / period) + 1)
    sine = 0.54 * np.sin(2.0 * np.pi * 0.328 * t)
    return np.asarray(5.0 + sine + 0.5 * np.sign(sine))


def off(run: Run, reference: Array, scale: Array) -> tuple[Array, Array]:
    """Largest and RMS difference of every state over its range, which counts as a twentieth of
    the state's magnitude at least."""
    span = np.maximum(np.ptp(reference, axis=0), 0.05 * scale)
    difference = (run.rows[:, : reference.shape[1]] - reference) / span
    return np.max(np.abs(difference), axis=0), np.sqrt(np.mean(difference**2, axis=0))


# The bench


def compare_bench(
    duration: float, laws: dict[str, Any], effects: dict[str, float], **how: Any
) -> tuple[Array, Array]:
    params = Params(control_period=0.01, **effects)
    run = sms.simulate_bench(published_sine(duration, 0.01), params=params, **laws, **how)
    reference = bench.simulate(params, run.rows[0, :12], run["valve_command"], **laws)
    return off(run, reference, bench.SCALE)


LAWS: list[tuple[dict[str, Any], dict[str, float]]] = [
    ({}, {}),
    ({"friction_law": "two_branch"}, {}),
    ({"friction_law": "lugre"}, {}),
    ({"friction_law": "dahl", "chamber_law": "energy"}, {}),
    ({"valve_law": "classic"}, {}),
    ({"valve_law": "iso_0_2_mpa"}, EVERYTHING),
    ({"friction_law": "lugre", "chamber_law": "energy"}, EVERYTHING),
]


@pytest.mark.parametrize(("laws", "effects"), LAWS)
def test_bench_moves_as_the_second_writing_says(
    laws: dict[str, Any], effects: dict[str, float]
) -> None:
    largest, _ = compare_bench(0.6, laws, effects, tolerance=TIGHT)
    assert np.all(largest < 2.0 * AGREEMENT)


@pytest.mark.full
@pytest.mark.parametrize(("laws", "effects"), LAWS)
def test_bench_over_ten_seconds(laws: dict[str, Any], effects: dict[str, float]) -> None:
    largest, _ = compare_bench(10.0, laws, effects, tolerance=TIGHT)
    assert np.all(largest < 2.0 * AGREEMENT)


@pytest.mark.parametrize("laws", [{}, {"friction_law": "lugre"}])
def test_bench_at_its_default_tolerance(laws: dict[str, Any]) -> None:
    largest, rms = compare_bench(3.0, laws, {})
    assert largest[0] < AGREEMENT
    assert np.all(rms[[0, 1, 2, 4]] < AGREEMENT)


@pytest.mark.full
@pytest.mark.parametrize("laws", [laws for laws, effects in LAWS if not effects])
def test_bench_at_its_default_tolerance_over_ten_seconds(laws: dict[str, Any]) -> None:
    largest, _ = compare_bench(10.0, laws, {})
    assert largest[0] < AGREEMENT
    assert np.all(largest[[1, 2, 4]] < 10.0 * AGREEMENT)


def test_default_tolerances_hold_for_every_law() -> None:
    """Against the core itself at a far smaller tolerance, over ten seconds."""
    for laws, _ in LAWS:
        params = Params(control_period=0.01)
        command = published_sine(10.0, 0.01)
        coarse = sms.simulate_bench(command, params=params, **laws)
        fine = sms.simulate_bench(command, params=params, tolerance=TIGHT, **laws)
        largest, _ = off(coarse, fine.rows[:, :12], bench.SCALE)
        assert largest[0] < AGREEMENT
        assert np.all(largest[[1, 2, 4]] < 10.0 * AGREEMENT)


@pytest.mark.full
def test_three_of_scipys_methods_agree() -> None:
    params = Params(control_period=0.01)
    command = published_sine(2.0, 0.01)
    start = sms.simulate_bench(command, params=params).rows[0, :12]
    found = {
        method: bench.simulate(params, start, command, method=method, friction_law="lugre")
        for method in ("LSODA", "DOP853", "Radau")
    }
    for states in found.values():
        assert np.max(np.abs(states - found["LSODA"]) / bench.SCALE) < 1e-6


@pytest.mark.parametrize("extension", [0.399, 0.001])
def test_bench_hits_its_ends_alike(extension: float) -> None:
    params = Params(control_period=0.01)
    command = np.full(61, 7.5 if extension > 0.2 else 2.5)
    run = sms.simulate_bench(command, params=params, extension=extension, tolerance=TIGHT)
    reference = bench.simulate(params, run.rows[0, :12], command)
    assert not 0.0 < reference[-1, 0] < 0.4
    assert np.all(off(run, reference, bench.SCALE)[0] < 20.0 * AGREEMENT)


# The platform


def test_mechanism_by_body_velocities(rng: np.random.Generator) -> None:
    params = Params()
    m = platform.mechanism_from(params)
    for _ in range(20):
        q = rng.uniform([-0.08, -0.08, 0.47], [0.08, 0.08, 0.53])
        rates, force = rng.normal(scale=0.3, size=3), rng.normal(scale=1e3, size=3)
        matrix, slope, (bias, x, x_bias) = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
        equations(m, q, rates, np.array([0.04, 0.0, 0.0]), matrix, bias, slope, x, x_bias)
        assert np.allclose(matrix, sms.dynamics.mass_matrix(q), rtol=1e-12, atol=1e-10)
        qddot = np.linalg.solve(matrix, slope.T @ force - bias)
        assert np.allclose(qddot, sms.dynamics.forward_dynamics(q, rates, force), atol=1e-12)
        assert np.allclose(x, sms.kinematics.inverse_kinematics(*q).extension, atol=1e-14)


def test_all_moving_bodies_are_there() -> None:
    bodies = mechanism_of(Params())["bodies"]
    assert sum(body["mass"] for body in bodies) == pytest.approx(353.7, abs=0.05)


def compare_platform(
    duration: float,
    laws: dict[str, Any],
    effects: dict[str, float],
    period: float = 0.01,
    **how: Any,
) -> tuple[Array, Array]:
    """Closed loop in the core; the second writing follows the commands that came of it."""
    params = Params(control_period=period, **effects)
    t = period * np.arange(round(duration / period) + 1)
    frequency, size = np.array([0.5, 0.4, 0.3]), np.array([0.06, 0.05, -0.05])
    setpoint = 0.2 + size * np.sin(2.0 * np.pi * frequency * t[:, None])
    run = sms.simulate_platform(setpoint, params=params, **laws, **how)
    commands = run.legs("valve_command")
    reference = platform.simulate(params, run.rows[0, :36], commands, **laws)
    return off(run, reference, platform.SCALE)


@pytest.mark.parametrize(
    ("duration", "laws", "effects"),
    [
        (0.1, {}, {}),
        (0.4, {"friction_law": "lugre"}, {}),
        (0.2, {"friction_law": "two_branch", "chamber_law": "energy"}, EVERYTHING),
    ],
)
def test_platform_moves_as_the_second_writing_says(
    duration: float, laws: dict[str, Any], effects: dict[str, float]
) -> None:
    largest, _ = compare_platform(duration, laws, effects, tolerance=TIGHT)
    assert np.all(largest < 2.0 * AGREEMENT)


@pytest.mark.full
@pytest.mark.parametrize("laws", [{}, {"friction_law": "lugre", "chamber_law": "energy"}])
def test_platform_over_ten_seconds(laws: dict[str, Any]) -> None:
    largest, _ = compare_platform(10.0, laws, {}, tolerance=TIGHT)
    assert np.all(largest < 2.0 * AGREEMENT)


@pytest.mark.parametrize("duration", [0.15, pytest.param(2.0, marks=pytest.mark.full)])
def test_platform_at_its_default_tolerance_under_its_controller(duration: float) -> None:
    """At 1 kHz, as the controller runs; a slower one lets the steps grow to 1e-5."""
    largest, _ = compare_platform(duration, {"friction_law": "lugre"}, {}, period=1e-3)
    assert np.all(largest[:6] < AGREEMENT)


@pytest.mark.full
@pytest.mark.parametrize("laws", [laws for laws, _ in LAWS])
def test_platform_at_its_default_tolerance_over_ten_seconds(laws: dict[str, Any]) -> None:
    """At 1 kHz, against the core itself at a far smaller tolerance."""
    t = 1e-3 * np.arange(10_001)
    frequency, size = np.array([0.5, 0.4, 0.3]), np.array([0.06, 0.05, -0.05])
    setpoint = 0.2 + size * np.sin(2.0 * np.pi * frequency * t[:, None])
    coarse = sms.simulate_platform(setpoint, **laws)
    fine = sms.simulate_platform(setpoint, tolerance=TIGHT, **laws)
    largest, _ = off(coarse, fine.rows[:, :36], platform.SCALE)
    assert np.all(largest[:3] < AGREEMENT)


# The tank


@pytest.mark.parametrize("law", ["iso_0_4_mpa", "iso_0_2_mpa"])
def test_tank_fills_and_empties_at_the_same_rate(law: str, rng: np.random.Generator) -> None:
    params = Params()
    p, laws, map_ = numbers_of(params), Laws(1, 0, 0), valve_map(law)
    for _ in range(200):
        spool, pressure = rng.uniform(0.0, 10.0), rng.uniform(8.6e4, 4.8e5)
        dy = np.empty(4)
        tank.tank_rate(p, laws, map_, np.array([pressure, 293.0, spool, 0.0]), 5.0, 4.86e5, dy)
        component = (_core.charge_flow if spool >= 5.0 else _core.discharge_flow)(
            params, abs(spool - 5.0), law
        )
        outside = 4.86e5 if spool >= 5.0 else 8.6e4
        rate = float(_core.tank_pressure_rate(params, *component, pressure, outside))
        assert dy[0] == pytest.approx(rate, rel=1e-12, abs=1e-6)


def test_tank_that_exchanges_no_heat_gets_warm_while_it_fills() -> None:
    """A vessel filled from nothing by an ideal gas at T ends at kappa T (first law)."""
    params = Params(
        control_period=0.1, heat_transfer_coefficient=0.0, valve_centre=5.0, supply_pressure=1e6
    )
    start = np.array([1e2, 293.0, 9.8, 0.0])
    states = tank.simulate(params, start, np.full(31, 9.8), chamber_law="energy")
    assert states[-1, 1] == pytest.approx(1.4 * 293.0, rel=1e-3)


@pytest.mark.parametrize(
    "laws",
    [{}, {"valve_law": "iso_0_2_mpa", "chamber_law": "energy"}, {"valve_law": "classic"}],
)
def test_tank_is_charged_and_emptied_as_the_second_writing_says(laws: dict[str, Any]) -> None:
    params = Params(control_period=0.01, heat_transfer_coefficient=40.0)
    volts = np.repeat([5.0, 7.0, 4.0, 2.0], 100)
    run = sms.simulate_tank(volts, params=params, **laws)
    start = np.array([params.tank_initial_pressure, params.air_temperature, 5.0, 0.0])
    reference = tank.simulate(params, start, volts, **laws)
    span = np.maximum(np.ptp(reference, axis=0), [1.0, 1.0, 1.0, 1.0])
    largest = np.max(np.abs(run.rows[:, :4] - reference) / span, axis=0)
    assert np.all(largest[:3] < 2.0 * AGREEMENT)
    assert np.ptp(run["tank_pressure"]) > 1e5


# What must hold whatever the reference


def smooth_machine(**values: float) -> Params:
    """Without dry friction and ends nothing in the motion is but smooth."""
    return Params(
        control_period=0.01, coulomb_force=0.0, stiction_force=0.0, stiction_velocity=1e-6, **values
    )


def left_alone(params: Params, **how: Any) -> Run:
    """The valve stays closed for a second; what leaks, moves the piston."""
    centre = np.full(101, float(params["valve_centre"]))
    return sms.simulate_bench(centre, params=params, **how)


def test_fixed_step_is_of_fourth_order() -> None:
    params = smooth_machine(viscous_friction=60.0, chamber_leakage_lower=8e-9)
    exact = left_alone(params, tolerance=1e-12)["extension"]
    assert np.ptp(exact) > 0.02
    steps = 0.01 / np.array([4.0, 8.0, 16.0, 32.0])
    error = [abs(left_alone(params, step=float(h))["extension"] - exact).max() for h in steps]
    order = np.log2(np.array(error[:-1]) / np.array(error[1:]))
    assert np.all((order > 3.7) & (order < 4.4)), (order, error)


def test_air_past_the_piston_stays_in_the_cylinder() -> None:
    params = smooth_machine(
        viscous_friction=60.0, heat_transfer_coefficient=40.0, piston_leakage=1e-8
    )
    run = left_alone(params, chamber_law="energy", tolerance=1e-13)
    lower, upper = (air_mass(params, run, side) for side in ("lower", "upper"))
    assert np.ptp(lower) > 1e-2 * lower[0]
    assert np.max(np.abs((lower + upper) / (lower[0] + upper[0]) - 1.0)) < 1e-12


def air_mass(params: Params, run: Run, side: str) -> Array:
    volume = volume_of(params, run, side)
    temperature = run[f"chamber_temperature_{side}"]
    return np.asarray(run[f"chamber_pressure_{side}"] * volume / (288.0 * temperature))


def volume_of(params: Params, run: Run, side: str) -> Array:
    bore, rod = (0.25 * np.pi * params[name] ** 2 for name in ("bore_diameter", "rod_diameter"))
    if side == "lower":
        return np.asarray(params["dead_volume_lower"] + bore * run["extension"])
    left = params["stroke"] - run["extension"]
    return np.asarray(params["dead_volume_upper"] + (bore - rod) * left)


def test_air_that_enters_is_air_that_is_there() -> None:
    """With the valve open: the mass in each chamber against the integral of what flows in."""
    params = Params(control_period=1e-4, piston_leakage=2e-9, heat_transfer_coefficient=40.0)
    command = 5.0 + 1.2 * np.sin(2.0 * np.pi * 2.0 * 1e-4 * np.arange(5001))
    run = sms.simulate_bench(command, params=params, chamber_law="energy", tolerance=1e-11)
    flows, _ = boundary_flows(params, run)
    for side in (0, 1):
        mass = air_mass(params, run, ("lower", "upper")[side])
        entered = simpson_total(flows[:, side], 1e-4)
        moved = float(np.ptp(mass))
        assert abs(mass[-1] - mass[0] - entered) < 1e-6 * moved


def test_energy_is_neither_made_nor_lost() -> None:
    """Air, motion and ends on one side; enthalpy, heat, friction and ambient on the other."""
    params = Params(control_period=1e-4, heat_transfer_coefficient=40.0)
    command = 5.0 + 1.2 * np.sin(2.0 * np.pi * 2.0 * 1e-4 * np.arange(5001))
    run = sms.simulate_bench(
        command, params=params, chamber_law="energy", tolerance=1e-11, friction_law="lugre"
    )
    _, power = boundary_flows(params, run)
    rod = 0.25 * np.pi * params["rod_diameter"] ** 2
    kappa = params["heat_capacity_ratio"]
    inside = 0.5 * params["moving_mass"] * run["velocity"] ** 2
    inside += params["ambient_pressure"] * rod * run["extension"]
    for side in ("lower", "upper"):
        inside += run[f"chamber_pressure_{side}"] * volume_of(params, run, side) / (kappa - 1.0)
    power -= run["friction"] * run["velocity"]
    exchanged = simpson_total(abs(power), 1e-4)
    assert abs(inside[-1] - inside[0] - simpson_total(power, 1e-4)) < 1e-6 * exchanged


def boundary_flows(params: Params, run: Run) -> tuple[Array, Array]:
    """Mass into lower and upper chamber, kg/s, (n, 2); power of air and walls into both, W."""
    p, map_ = numbers_of(params), valve_map("iso_0_4_mpa")
    laws, cp = Laws(1, 0, 1), p.heat_capacity_ratio * p.gas_constant / (p.heat_capacity_ratio - 1.0)
    bore, rod = 0.25 * np.pi * p.bore_diameter**2, 0.25 * np.pi * p.rod_diameter**2
    mass, power = np.zeros((len(run.rows), 2)), np.zeros(len(run.rows))
    for i, row in enumerate(run.rows):
        state = row[2:12].copy()
        sl, le, su, ue = valve_flows(p, laws, map_, state)
        past = p.piston_leakage * (state[0] - state[2])
        mass[i] = sl - le - past, su - ue + past
        tl, tu, ta = state[1], state[3], p.air_temperature
        for flow, inside in ((sl, tl), (-le, tl), (su, tu), (-ue, tu)):
            power[i] += cp * flow * (ta if flow > 0.0 else inside)
        left = p.stroke - row[0]
        ring = bore - rod
        walls = (
            2.0 * bore + np.pi * p.bore_diameter * row[0],
            2.0 * ring + np.pi * (p.bore_diameter + p.rod_diameter) * left,
        )
        for wall, t in zip(walls, (tl, tu), strict=True):
            power[i] += p.heat_transfer_coefficient * wall * (p.wall_temperature - t)
    return mass, power


def simpson_total(rate: Array, step: float) -> float:
    """Integral of an odd number of even samples."""
    return float(
        step / 3.0 * (rate[0] + rate[-1] + 4.0 * rate[1:-1:2].sum() + 2.0 * rate[2:-1:2].sum())
    )


def push_to_extremes(rng: np.random.Generator, periods: int) -> tuple[float, float]:
    """Lowest pressure and temperature under commands, loads and supplies at random."""
    lowest, coldest, done = np.inf, np.inf, 0
    while done < periods:
        n = min(2000, periods - done)
        held = rng.integers(1, 60)
        command = np.repeat(rng.uniform(0.0, 10.0, n), held)[:n]
        load = np.repeat(rng.uniform(-4e3, 4e3, n), held)[:n]
        params = Params(
            supply_pressure=float(rng.uniform(9e4, 1.2e6)),
            supply_line_resistance=float(rng.choice([0.0, 1e6])),
            dead_volume_lower=float(10.0 ** rng.uniform(-4.0, -3.0)),
            dead_volume_upper=float(10.0 ** rng.uniform(-4.0, -3.0)),
            mass_flow_gain=float(rng.uniform(0.5, 3.0)),
            valve_leakage=float(rng.choice([0.0, 1e-9])),
            moving_mass=float(rng.uniform(2.0, 100.0)),
        )
        run = sms.simulate_bench(
            command,
            params=params,
            load_force=load,
            extension=float(rng.uniform(0.0, 0.4)),
            friction_law=str(rng.choice(["acceleration_dependent", "lugre"])),
            chamber_law=str(rng.choice(["polytropic", "energy"])),
        )
        for side in ("lower", "upper"):
            lowest = min(lowest, float(np.min(run[f"chamber_pressure_{side}"])))
            coldest = min(coldest, float(np.min(run[f"chamber_temperature_{side}"])))
        done += n
    return lowest, coldest


def test_no_pressure_below_nothing(rng: np.random.Generator) -> None:
    lowest, coldest = push_to_extremes(rng, 20_000)
    assert lowest > 0.0
    assert coldest > 0.0


@pytest.mark.full
def test_no_pressure_below_nothing_in_a_million_periods(rng: np.random.Generator) -> None:
    lowest, coldest = push_to_extremes(rng, 1_000_000)
    assert lowest > 0.0
    assert coldest > 0.0
