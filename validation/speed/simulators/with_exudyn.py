"""The mechanism in Exudyn, as validation/reference/multibody describes it to it, with Exudyn's own settings.

python -m validation.speed.simulators.with_exudyn < TASK.json > RESULT.json
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn as exu
import numpy as np

from validation.reference.multibody.peers.exchange import PLATFORM
from validation.reference.multibody.peers.with_exudyn import Machine
from validation.speed.simulators.exchange import Result, Task, fastest, serve


def assembled(task: Task) -> Machine:
    """The machine at the start of its motion."""
    machine = Machine(task["mechanism"], task["q"], task["qdot"])
    force = []
    for actuator, at_rest in zip(machine.actuators, task["force"], strict=True):
        piston = machine.places[actuator.piston]
        link = piston.position + piston.rotation @ actuator.top - actuator.base
        extension = float(np.linalg.norm(link)) - actuator.retracted
        force.append(at_rest - task["stiffness"] * extension)
    machine.drive(force, [task["stiffness"]] * 3, [0.0] * 6)
    machine.system.Assemble()
    return machine


def answer(task: Task) -> Result:
    """Where it swings, and how fast a step is."""
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = task["steps"]
    settings.timeIntegration.endTime = task["steps"] * task["step"]
    settings.solutionSettings.writeSolutionToFile = False
    last = assembled(task)

    def prepare() -> Callable[[], object]:
        nonlocal last
        last = assembled(task)
        return lambda: last.system.SolveDynamic(settings)

    seconds = fastest(prepare)
    kinds = exu.OutputVariableType
    rotation = last.of_point(kinds.RotationMatrix, PLATFORM, last.arm).reshape(3, 3)
    point = last.of_point(kinds.Position, PLATFORM, last.arm)
    return Result(
        software=f"exudyn {exu.__version__}",
        q=[
            float(np.arctan2(rotation[2, 1], rotation[2, 2])),
            float(-np.arcsin(rotation[2, 0])),
            float(-point[2]),
        ],
        microseconds=seconds / task["steps"] * 1e6,
    )


if __name__ == "__main__":
    serve(answer)
