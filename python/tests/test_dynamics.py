"""Dynamics from Python: reference values, identities of the equation of motion, arrays, errors."""

from __future__ import annotations

import numpy as np
import pytest
import sms
from mechanism_support import (
    Array,
    cases,
    column,
    difference,
    driven,
    random_poses,
    relative_difference,
    with_reference,
)

from validation.random_cases import draw

LEVEL = (0.0, 0.0, 0.5)
REST = (0.0, 0.0, 0.0)
MASSES = ("corrected", "table", "platform", "lumped")
SPRING = 36.0e3  # N/m, about what both chambers have at mid-stroke


def random_motion(name: str, count: int = 200) -> tuple[Array, Array, Array]:
    """q, qdot and actuator forces."""
    random = draw(name)
    q = random_poses(random, count)
    return q, random.uniform(-0.5, 0.5, q.shape), random.uniform(300.0, 1800.0, q.shape)


# ---- values ----------------------------------------------------------------------------------


@with_reference
@pytest.mark.parametrize("masses", ["corrected", "table", "platform"])
def test_every_reference_case_to_1e_9(masses: str) -> None:
    q, qdot, force = driven("dynamics"), column("dynamics", "qdot"), column("dynamics", "F")

    def wanted(key: str) -> Array:
        return np.array([case["models"][masses][key] for case in cases("dynamics")])

    qddot = sms.forward_dynamics(q, qdot, force, masses)
    assert relative_difference(qddot, wanted("qddot")) < 1e-9
    assert relative_difference(sms.mass_matrix(q, masses), wanted("M")) < 1e-9
    assert relative_difference(sms.bias_force(q, qdot, masses), wanted("bias")) < 1e-9
    assert relative_difference(sms.gravity_force(q, masses), wanted("grav")) < 1e-9
    energies = sms.energies(q, qdot, masses)
    assert difference(energies.kinetic / wanted("T"), np.ones(len(q))) < 1e-9
    assert difference(energies.potential / wanted("U"), np.ones(len(q))) < 1e-9
    extension = sms.inverse_motion(q, qdot, qddot).extension_acceleration
    assert relative_difference(extension, wanted("extddot")) < 1e-9
    assert relative_difference(sms.inverse_dynamics(q, qdot, qddot, masses), force) < 1e-9


def test_known_figures_of_the_machine() -> None:
    assert sms.holding_force(LEVEL) == pytest.approx([1042.5] * 3, abs=1.0)
    assert np.diag(sms.mass_matrix(LEVEL)) == pytest.approx([602.6, 623.6, 329.0], abs=0.05)
    modes = sms.eigenfrequencies(LEVEL, 36.7e3)
    assert modes.eigenfrequency == pytest.approx([1.97, 2.01, 2.92], abs=0.01)
    assert np.array_equal(modes.growth_rate, REST)
    toppling = sms.eigenfrequencies(LEVEL, 0.0)
    assert toppling.growth_rate == pytest.approx([2.4, 2.3, 1.4], abs=0.05)
    assert np.array_equal(toppling.eigenfrequency, REST)


def test_the_lumped_model_errs_as_stated() -> None:
    q, qdot, force = random_motion("lumped")
    whole, lumped = (sms.forward_dynamics(q, qdot, force, m) for m in ("corrected", "lumped"))
    assert np.abs(whole - lumped)[:, 2].max() < 0.1
    level = sms.forward_dynamics(LEVEL, REST, [1042.5] * 3, "lumped")
    assert abs(level[2]) < 0.02


# ---- identities ------------------------------------------------------------------------------


@pytest.mark.parametrize("masses", MASSES)
@pytest.mark.parametrize("tilt", [0.0, 1e-8, None], ids=["level", "nearly level", "random"])
def test_the_equation_of_motion_holds(masses: str, tilt: float | None) -> None:
    q, qdot, force = random_motion(f"equation {masses} {tilt}")
    if tilt is not None:
        q[:, :2] = tilt
    qddot = sms.forward_dynamics(q, qdot, force, masses)
    mass = sms.mass_matrix(q, masses)
    left = np.einsum("nij,nj->ni", mass, qddot) + sms.bias_force(q, qdot, masses)
    right = np.einsum("nji,nj->ni", sms.jacobian(q), force)
    assert relative_difference(left, right) < 1e-12
    assert relative_difference(sms.inverse_dynamics(q, qdot, qddot, masses), force) < 1e-12
    assert difference(mass, np.swapaxes(mass, 1, 2)) < 1e-10
    assert np.linalg.eigvalsh(mass).min() > 100.0


@pytest.mark.parametrize("masses", MASSES)
def test_power_in_is_the_growth_of_energy(masses: str) -> None:
    q, qdot, force = random_motion(f"power {masses}")
    qddot = sms.forward_dynamics(q, qdot, force, masses)
    h = 1e-4

    def energy(t: float) -> Array:
        e = sms.energies(q + t * qdot + 0.5 * t * t * qddot, qdot + t * qddot, masses)
        return e.kinetic + e.potential

    growth = (8.0 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12.0 * h)
    power = (sms.inverse_motion(q, qdot).extension_rate * force).sum(axis=1)
    assert difference(growth, power) < 1e-6 * np.abs(power).max()


def test_gravity_is_the_gradient_of_the_potential_energy() -> None:
    q, _, _ = random_motion("gravity")
    h = 1e-4
    for k in range(3):
        step = h * np.eye(3)[k]
        two, one, minus_one, minus_two = (
            sms.energies(q + s * step, REST).potential for s in (2, 1, -1, -2)
        )
        slope = (8.0 * (one - minus_one) - (two - minus_two)) / (12.0 * h)
        assert difference(slope, sms.gravity_force(q)[:, k]) < 1e-6
    assert np.array_equal(sms.bias_force(q, REST), sms.gravity_force(q))


def test_what_holds_holds_and_a_wrench_is_carried() -> None:
    q, _, _ = random_motion("holding")
    assert difference(sms.forward_dynamics(q, REST, sms.holding_force(q)), 0.0 * q) < 1e-11
    load = {"external_force": (30.0, -20.0, 500.0), "external_moment": (40.0, 50.0, 60.0)}
    held = sms.holding_force(q, **load)
    assert difference(sms.forward_dynamics(q, REST, held, **load), 0.0 * q) < 1e-11
    # 500 N down at the reference point, level: the actuators carry them and nothing else changes.
    down = sms.holding_force(LEVEL, external_force=(0.0, 0.0, 500.0)) - sms.holding_force(LEVEL)
    heave = sms.jacobian(LEVEL)[:, 2] @ down
    assert heave == pytest.approx(500.0, abs=1e-9)


def test_the_linear_model_is_the_derivative_of_the_dynamics() -> None:
    q = random_poses(draw("linear"), 1)[0]
    force = sms.holding_force(q)
    model = sms.linearise(q, SPRING, 400.0)
    h = 1e-5
    length = sms.inverse_kinematics(*q).extension

    def answer(dq: Array, dqdot: Array, push: Array) -> Array:
        extension = sms.inverse_kinematics(*(q + dq)).extension
        rate = sms.inverse_motion(q + dq, dqdot).extension_rate
        given = force - SPRING * (extension - length) - 400.0 * rate + push
        return sms.forward_dynamics(q + dq, dqdot, given)

    zero, unit = np.zeros(3), h * np.eye(3)
    by_q = [(answer(u, zero, zero) - answer(-u, zero, zero)) / (2 * h) for u in unit]
    by_rate = [(answer(zero, u, zero) - answer(zero, -u, zero)) / (2 * h) for u in unit]
    by_force = [(answer(zero, zero, u) - answer(zero, zero, -u)) / (2 * h) for u in unit]
    a, b = model.a, model.b
    assert difference(a[3:, :3].T, np.array(by_q)) < 1e-5
    assert difference(a[3:, 3:].T, np.array(by_rate)) < 1e-7
    assert difference(b[3:].T, np.array(by_force)) < 1e-6
    assert np.array_equal(a[:3], np.hstack([np.zeros((3, 3)), np.eye(3)]))
    assert np.array_equal(b[:3], np.zeros((3, 3)))


def test_modes_solve_the_eigenproblem() -> None:
    q = random_poses(draw("modes"), 50)
    model, modes = sms.linearise(q, SPRING), sms.eigenfrequencies(q, SPRING)
    omega2 = (2.0 * np.pi * modes.eigenfrequency) ** 2 - modes.growth_rate**2
    left = model.stiffness @ modes.shape
    right = model.mass_matrix @ modes.shape * omega2[:, None, :]
    assert relative_difference(left, right) < 1e-12
    norm = np.swapaxes(modes.shape, 1, 2) @ model.mass_matrix @ modes.shape
    assert difference(norm, np.tile(np.eye(3), (50, 1, 1))) < 1e-12


# ---- parameters, arrays, errors --------------------------------------------------------------


def test_payload_and_gravity_are_parameters() -> None:
    params = sms.Params(payload_mass=100.0, payload_cog_x=0.1)
    lighter, tilted = sms.holding_force(LEVEL), sms.holding_force(LEVEL, params=params)
    assert tilted.sum() < lighter.sum() - 1000.0
    assert tilted[0] - tilted[1] > 20.0  # over actuator 1


def test_arrays_broadcast_and_many_rows_are_what_one_row_is() -> None:
    q, qdot, force = random_motion("broadcast", 30_000)
    many = sms.forward_dynamics(q, qdot, force)
    assert np.array_equal(many[::500], sms.forward_dynamics(q[::500], qdot[::500], force[::500]))
    assert np.array_equal(many[7], sms.forward_dynamics(q[7], qdot[7], force[7]))
    grid = sms.forward_dynamics(q[:4, None], qdot[:3], (1000.0, 1000.0, 1000.0))
    assert grid.shape == (4, 3, 3)
    assert sms.mass_matrix(q[:6].reshape(2, 3, 3)).shape == (2, 3, 3, 3)
    assert sms.linearise(q[:5], SPRING).a.shape == (5, 6, 6)
    assert np.ndim(sms.energies(LEVEL, REST).potential) == 0


def test_errors_name_the_row_and_what_is_wrong() -> None:
    force = (1000.0, 1000.0, 1000.0)
    with pytest.raises(sms.OutOfWorkspaceError, match=r"^row 1: roll = 0 rad .* pitch = 0\.8 rad"):
        sms.forward_dynamics([LEVEL, (0.0, 0.8, 0.5)], REST, force)
    with pytest.raises(sms.NotANumberError, match=r"^force 2 = nan N: it must be a finite"):
        sms.forward_dynamics(LEVEL, REST, (1000.0, np.nan, 1000.0))
    with pytest.raises(sms.NotANumberError, match=r"^external moment z = inf N m"):
        sms.holding_force(LEVEL, external_moment=(0.0, 0.0, np.inf))
    with pytest.raises(sms.NotANumberError, match=r"^row 1: stiffness 3 = nan"):
        sms.linearise(LEVEL, [[1.0, 1.0, 1.0], [1.0, 1.0, np.nan]])
    with pytest.raises(ValueError, match=r"'printed'.*corrected, table, platform, lumped"):
        sms.mass_matrix(LEVEL, "printed")
    with pytest.raises(ValueError, match=r"qdot has shape \(2,\)"):
        sms.bias_force(LEVEL, (0.0, 0.0))
