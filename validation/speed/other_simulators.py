"""One step of a simulation of the whole mechanism, beside a step of general-purpose simulators.

Everyone swings the same machine on the same three springs from the same start and has to arrive
where the core arrives. The simulators live in the environment of validation/reference/multibody, build/peers;
MuJoCo joins it here.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import sms
from sms.arrays import Array

from validation.reference.multibody.environment import (
    FOLDER,
    ROOT,
    PeersUnavailableError,
    peer_python,
)
from validation.reference.multibody.mechanism import mechanism_of
from validation.speed.simulators.exchange import Result, Task
from validation.speed.timing import Goal, Row, row

STEP, STEPS = 1e-3, 200  # s
FORCE, STIFFNESS = 8200.0, 36e3  # of each actuator at extension 0, N; N/m
START, RATE = np.array([0.03, -0.02, 0.5]), np.array([0.2, 0.1, -0.1])

# Goal for the ratio, and how far from the core, m and rad: MuJoCo's joints give way.
SIMULATORS = {"mujoco": (3.0, 2e-3), "exudyn": (40.0, 1e-5)}


def swung() -> Array:
    """(roll, pitch, height) where the core arrives, by the same steps as libsms/bench takes."""

    def derivative(state: Array) -> Array:
        extension = sms.inverse_kinematics(*state[:3]).extension
        force = FORCE - STIFFNESS * extension
        return np.concatenate([state[3:], sms.forward_dynamics(state[:3], state[3:], force)])

    state = np.concatenate([START, RATE])
    for _ in range(STEPS):
        k1 = derivative(state)
        k2 = derivative(state + STEP / 2.0 * k1)
        k3 = derivative(state + STEP / 2.0 * k2)
        k4 = derivative(state + STEP * k3)
        state = state + STEP / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return state[:3]


def simulation_rows(microseconds: float, install: bool) -> Iterator[Row]:
    """The core's step, which takes so long, beside each simulator's; one is empty where it is not installed.

    Args:
        microseconds: of the core's step, measured by libsms/bench.
        install: install what is missing (1.1 GB).
    """
    task = Task(
        mechanism=mechanism_of(sms.Params()),
        q=START.tolist(),
        qdot=RATE.tolist(),
        force=[FORCE] * 3,
        stiffness=STIFFNESS,
        step=STEP,
        steps=STEPS,
    )
    expected = swung()
    for name, (ratio, tolerance) in SIMULATORS.items():
        goal = Goal(ratio_at_least=ratio)
        python = python_with(name, install)
        if python is None:
            peer: tuple[str, float | None] = (f"{name} is not installed: --peers", None)
        else:
            result: Result = ask(python, name, task)
            difference = float(np.max(np.abs(np.array(result["q"]) - expected)))
            if not difference < tolerance:
                raise AssertionError(f"{name} arrives {difference:.1e} away from the core")
            peer = (f"{result['software']}, a step", result["microseconds"])
        yield row("simulation step of 1 ms, RK4", microseconds, "us", peer, goal)


def python_with(module: str, install: bool) -> Path | None:
    """The environment's Python when it has the module; installs it first when asked to."""
    python = FOLDER / "bin" / "python"
    if install:
        try:
            python = peer_python()
        except PeersUnavailableError as error:
            print(error)
            return None
    if not python.exists():
        return None
    if not _has(python, module) and install:
        pip: list[str | Path] = [
            python,
            "-m",
            "pip",
            "--disable-pip-version-check",
            "install",
            "--quiet",
        ]
        subprocess.run([*pip, "--only-binary", ":all:", f"{module}>=3"], check=False)
    return python if _has(python, module) else None


def _has(python: Path, module: str) -> bool:
    code = f"import importlib.util, sys; sys.exit(importlib.util.find_spec({module!r}) is None)"
    return subprocess.run([python, "-c", code], check=False).returncode == 0


def ask(python: Path, name: str, task: Mapping[str, object]) -> Any:
    """What validation/speed/simulators/with_NAME.py answers, run by the peers' Python."""
    asked = subprocess.run(
        [python, "-m", f"validation.speed.simulators.with_{name}"],
        input=json.dumps(task),
        check=True,
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    return json.loads(asked.stdout[asked.stdout.index("{") :])
