"""The mechanism, timed against what one would write with numpy and scipy.

The equations of the three Panhard rods are written here a second time, from the source (section
3.2.2: each rod keeps its length), so that the peers owe nothing to the core. Before anything is
timed core and peer have to agree.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import scipy.optimize
import sms
from sms.arrays import Array

from validation.speed.callgrind import count
from validation.speed.timing import Goal, Row, fastest, row

AGREE = 1e-11  # m and rad, between core and peer
BATCH = 1_000_000
ANGLES = np.linspace(-0.1, 0.1, 201)  # of the table, rad
HEIGHT = 0.5  # of the table, m
COUNTED = (  # by callgrind, of what libsms/bench measures
    "inverse kinematics, warm",
    "inverse kinematics, from rest",
    "forward kinematics, warm",
    "forward dynamics",
    "simulation step",
)


class Rods:
    """Joints of the machine, and the lengths of its links, in world axes at rest; SI."""

    def __init__(self) -> None:
        p = sms.Params()

        def points(name: str) -> Array:
            return np.array([[p[f"{name}_{i}_{axis}"] for axis in "xyz"] for i in range(1, 7)])

        self.reference = np.array([p[f"reference_point_{axis}"] for axis in "xyz"])
        self.base, top = points("base_joint"), points("platform_joint")
        self.arm = top - self.reference
        self.length = np.linalg.norm(top - self.base, axis=1)

    def tilted(self, roll: Array, pitch: Array) -> Array:
        """Ry(pitch) Rx(roll) of all six platform joints, (..., 6, 3)."""
        x, y, z = self.arm.T
        sr, cr, sp, cp = (f(a)[..., None] for a in (roll, pitch) for f in (np.sin, np.cos))
        across = sr * y + cr * z
        return np.stack([cp * x + sp * across, cr * y - sr * z, cp * across - sp * x], axis=-1)


def misfit(rods: Rods, tilted: Array, height: np.float64, x_y_yaw: Array) -> Array:
    """How much too long the three rods are for one pose, m."""
    x, y, yaw = x_y_yaw
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0, 0, 1]])
    link = tilted[3:] @ turn.T + np.array([x, y, -height]) - rods.base[3:]
    error: Array = np.sqrt((link * link).sum(axis=1)) - rods.length[3:]
    return error


def root_by_scipy(rods: Rods, q: Array, start: Array) -> Array:
    """(x, y, yaw) of one pose, as one would ask scipy for it."""
    tilted = rods.tilted(q[0], q[1])

    def rods_misfit(x_y_yaw: Array) -> Array:
        return misfit(rods, tilted, q[2], x_y_yaw)

    found = scipy.optimize.root(rods_misfit, start, tol=1e-13)
    x_y_yaw: Array = found.x
    return x_y_yaw


def table_by_numpy(rods: Rods) -> Array:
    """The table of section 3.5, (201, 201, 3): Newton's method on all its nodes at once."""
    roll, pitch = (a.ravel() for a in np.meshgrid(ANGLES, ANGLES, indexing="ij"))
    s = rods.tilted(roll, pitch)
    rise = s[..., 2] - HEIGHT - rods.base[:, 2]
    s_x, s_y = s[:, 3:, 0], s[:, 3:, 1]
    reach = rods.length[3:] ** 2 - rise[:, 3:] ** 2
    yaw, x, y = np.zeros_like(roll), *np.outer(rods.reference[:2], np.ones_like(roll))
    while True:
        cosine, sine = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
        arm_x, arm_y = cosine * s_x - sine * s_y, sine * s_x + cosine * s_y
        a = arm_x + x[:, None] - rods.base[3:, 0]
        b = arm_y + y[:, None] - rods.base[3:, 1]
        c = arm_x * b - arm_y * a
        e = 0.5 * (a * a + b * b - reach)
        # Cramer's rule on [a b c] step = e, for all nodes: three times as fast as numpy.linalg.solve
        (a1, a2, a3), (b1, b2, b3), (c1, c2, c3), (e1, e2, e3) = a.T, b.T, c.T, e.T
        bc1, bc2, bc3 = b2 * c3 - b3 * c2, b3 * c1 - b1 * c3, b1 * c2 - b2 * c1
        determinant = a1 * bc1 + a2 * bc2 + a3 * bc3
        dx = (e1 * bc1 + e2 * bc2 + e3 * bc3) / determinant
        ca1, ca2, ca3 = c2 * a3 - c3 * a2, c3 * a1 - c1 * a3, c1 * a2 - c2 * a1
        dy = (e1 * ca1 + e2 * ca2 + e3 * ca3) / determinant
        dyaw = (e1 * (a2 * b3 - a3 * b2) + e2 * (a3 * b1 - a1 * b3) + e3 * (a1 * b2 - a2 * b1)) / (
            determinant
        )
        x, y, yaw = x - dx, y - dy, yaw - dyaw
        if max(np.abs(dx).max(), np.abs(dy).max(), np.abs(dyaw).max()) < 1e-7:  # squares to 1e-14
            break
    cosine, sine = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    s_x, s_y = s[:, :3, 0], s[:, :3, 1]
    leg_x = cosine * s_x - sine * s_y + x[:, None] - rods.base[:3, 0]
    leg_y = sine * s_x + cosine * s_y + y[:, None] - rods.base[:3, 1]
    extension = np.sqrt(leg_x**2 + leg_y**2 + rise[:, :3] ** 2) - rods.length[:3]
    table: Array = extension.reshape(ANGLES.size, ANGLES.size, 3)
    return table


def _ship_motion(n: int) -> Array:
    """(n, 3) roll, pitch, height at 1 kHz, as in libsms/bench/mechanism.cpp."""
    phase = np.outer(1e-3 * np.arange(n), [2.9, 2.3, 3.4])
    motion: Array = np.array([0.0, 0.0, 0.5]) + np.array([0.07, 0.05, 0.1]) * np.sin(phase)
    return motion


def _agree(what: str, core: Array, peer: Array) -> None:
    difference = np.max(np.abs(core - peer))
    if not difference < AGREE:
        raise AssertionError(f"{what}: core and peer differ by {difference:.1e}")


def inverse_rows(compiled: Mapping[str, float]) -> Iterator[Row]:
    """One pose beside scipy's root, and the whole table beside numpy; `compiled` in ns."""
    rods, motion = Rods(), _ship_motion(200)
    core = sms.inverse_kinematics(*motion.T)
    expected = np.column_stack([core.x, core.y, core.yaw])
    at_rest = np.array([*rods.reference[:2], 0.0])

    def follow_motion() -> Array:
        poses = [at_rest]
        for q in motion:
            poses.append(root_by_scipy(rods, q, poses[-1]))
        return np.array(poses[1:])

    _agree("inverse kinematics", expected, follow_motion())
    scipy_root = ("scipy.optimize.root, warm", fastest(follow_motion) / len(motion) * 1e9)
    warm = compiled["inverse kinematics, warm"]
    goal = Goal(at_most=250.0, ratio_at_least=600.0)
    yield row("inverse kinematics, a pose, warm", warm, "ns", scipy_root, goal)
    rest = compiled["inverse kinematics, from rest"]
    yield row("inverse kinematics, a pose, from rest", rest, "ns", scipy_root)
    single = compiled["inverse kinematics, warm, float"]
    yield row("inverse kinematics, warm, float", single, "ns", scipy_root)

    grid = sms.inverse_kinematics(ANGLES[:, None], ANGLES, HEIGHT).extension
    _agree("table", grid, table_by_numpy(rods))
    numpy = ("numpy, Newton on all nodes", fastest(lambda: table_by_numpy(rods), rounds=10) * 1e3)
    goal = Goal(at_most=1.5, ratio_at_least=4.0)
    yield row("table 201 x 201 x 3, one core", compiled["table"] * 1e-6, "ms", numpy, goal)


def motion_rows(compiled: Mapping[str, float]) -> Iterator[Row]:
    """Forward kinematics and forward dynamics; `compiled` in ns."""
    forward = compiled["forward kinematics, warm"]
    yield row("forward kinematics, warm", forward, "ns", goal=Goal(at_most=500.0))
    by_data = compiled["forward kinematics by data, warm"]
    own = ("of the built-in platform", forward)
    goal = Goal(ratio_at_least=1.0 / 3.0)
    yield row("forward kinematics of the same platform by data, warm", by_data, "ns", own, goal)
    single = compiled["forward kinematics, warm, float"]
    yield row("forward kinematics, warm, float", single, "ns")
    dynamics = compiled["forward dynamics"]
    yield row("forward dynamics, whole mechanism", dynamics, "ns", goal=Goal(at_most=1000.0))


def batch_rows(compiled: Mapping[str, float]) -> Iterator[Row]:
    """A million unrelated poses in one call: in C beside a pose a call, from Python beside C, on one core and all."""
    rng = np.random.default_rng(3)
    roll, pitch = rng.uniform(-0.1, 0.1, (2, BATCH))
    height = rng.uniform(0.4, 0.6, BATCH)
    extension = sms.inverse_kinematics(roll, pitch, height).extension
    calls = {
        "inverse": (lambda: sms.inverse_kinematics(roll, pitch, height), 40.0),
        "forward": (lambda: sms.forward_kinematics(extension), 80.0),
    }
    for direction, (call, at_most) in calls.items():
        what = f"{direction} kinematics, 1e6 poses"
        in_c = compiled[f"{direction} kinematics, batch"]
        alone = ("a pose a call, warm", compiled[f"{direction} kinematics, warm"])
        yield row(f"{what} in C, one core", in_c, "ns", alone, Goal(at_most=at_most))
        one, all_cores = [], []
        for _ in range(12):  # by turns: what else runs on the machine meets both
            with one_core():
                one.append(fastest(call, rounds=1) / BATCH * 1e9)
            all_cores.append(fastest(call, rounds=1) / BATCH * 1e9)
        goal = Goal(at_most=at_most)
        yield row(f"{what} from Python, one core", min(one), "ns", ("in C", in_c), goal)
        name = f"{what} from Python, {len(os.sched_getaffinity(0))} cores"
        yield row(name, min(all_cores), "ns", ("from Python, one core", min(one)))


@contextmanager
def one_core() -> Iterator[None]:
    """This process, and the threads it starts, on one core alone."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def instruction_rows(program: Path, names: tuple[str, ...]) -> Iterator[Row]:
    """Instructions of one call, which no other work on the machine disturbs; none without valgrind.

    Args:
        program: sms_bench; callgrind counts in one round of one of its measurements.
        names: of the measurements.
    """
    if not shutil.which("valgrind"):
        return
    for name in names:
        counted = count(program, name)
        yield row(f"{name}: instructions", counted.instructions / counted.calls, "")
