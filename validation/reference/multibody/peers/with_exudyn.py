"""The mechanism in Exudyn: ten rigid bodies in absolute coordinates, held together by 15 joints.

Each body has a position and four Euler parameters; the joints are algebraic equations beside the
equations of motion. Accelerations are those that Exudyn computes for the start of a motion; a motion
is integrated by its generalised-alpha method with the joints at the level of position (index 3):

    python -m validation.reference.multibody.peers.with_exudyn REQUEST.json ANSWER.json
"""

from __future__ import annotations

from dataclasses import dataclass

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadForceVector,
    LoadTorqueVector,
    MarkerBodyRigid,
    ObjectConnectorSpringDamper,
    ObjectJointGeneric,
    ObjectJointPrismaticX,
    ObjectJointSpherical,
    SensorBody,
    SensorObject,
)
from exudyn.utilities import RigidBodyInertia
from numpy.typing import NDArray

from validation.reference.multibody.peers.exchange import (
    GROUND,
    PLATFORM,
    Answer,
    Joint,
    Mechanism,
    Motion,
    Request,
    State,
    serve,
)
from validation.reference.multibody.peers.placement import Placement

Array = NDArray[np.float64]
Output = exu.OutputVariableType

STEPS_PER_SECOND = 1000  # and twice as many: the method's error falls with the square of the step
NEWTON_TOLERANCE = 1e-10
# For the accelerations at the start, Exudyn differentiates the joints' equations by differences of
# this size. That is what limits their accuracy: larger ones cut off, smaller ones (its default is
# 1e-7) round off.
DIFFERENCE = 2e-6


@dataclass(frozen=True)
class Actuator:
    """Where an actuator pushes."""

    piston: str
    base: Array  #: ground joint, m
    top: Array  #: platform joint, from the piston's centre of gravity, piston axes, m
    retracted: float  #: distance of the two at extension 0, m
    markers: list[int]  #: on base and top


class Machine:
    """One mechanism as Exudyn has it, about to move from one state."""

    def __init__(self, mechanism: Mechanism, q: list[float], qdot: list[float]) -> None:
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.item = {GROUND: self.system.CreateGround()}
        self.cog = {GROUND: np.zeros(3)}
        self.ground_joint: dict[str, tuple[Array, int]] = {}  # point and marker, by the body on it
        self.actuators: list[Actuator] = []
        self.places = Placement(mechanism).at(q, qdot)
        for body in mechanism["bodies"]:
            name, place = body["name"], self.places[body["name"]]
            self.cog[name] = np.array(body["cog"])
            # The place now, not that at rest, is the reference: with an initial rotation on top of
            # the reference, Exudyn 1.13.6 starts with another angular velocity than it is given.
            self.item[name] = self.system.CreateRigidBody(
                referencePosition=place.position,
                referenceRotationMatrix=place.rotation,
                initialVelocity=place.velocity,
                initialAngularVelocity=place.angular_velocity,
                inertia=RigidBodyInertia(body["mass"], np.array(body["inertia"])),
                gravity=mechanism["gravity"],
            )
        self.arm = np.array(mechanism["reference_point"]) - self.cog[PLATFORM]
        for joint in mechanism["joints"]:
            self._join(joint)

    def _join(self, joint: Joint) -> None:
        first, second = joint["bodies"]
        point, axes = np.array(joint["point"]), [np.array(axis) for axis in joint["axes"]]
        if joint["kind"] == "universal":
            # Locking x keeps y of the first frame and z of the second perpendicular.
            frame = np.column_stack([np.cross(axes[0], axes[1]), axes[0], axes[1]])
            markers = self._markers(joint, frame)
            self.ground_joint[second] = point, markers[0]
            item = ObjectJointGeneric(markerNumbers=markers, constrainedAxes=[1, 1, 1, 1, 0, 0])
        elif joint["kind"] == "prismatic":  # slides along x
            markers = self._markers(joint, _frame_along(axes[0]))
            item = ObjectJointPrismaticX(markerNumbers=markers)
            base, on_ground = self.ground_joint[first]
            length = float(np.linalg.norm(point - base))
            self.actuators.append(
                Actuator(second, base, point - self.cog[second], length, [on_ground, markers[1]])
            )
        else:
            item = ObjectJointSpherical(markerNumbers=self._markers(joint, np.eye(3)))
        self.system.AddObject(item)

    def _markers(self, joint: Joint, frame: Array) -> list[int]:
        """The joint's point and axes on both bodies, as they are at rest."""
        markers = []
        for body in joint["bodies"]:
            place = exu.HT(rotation=frame, translation=np.array(joint["point"]) - self.cog[body])
            markers.append(MarkerBodyRigid(bodyNumber=self.item[body], localHT=place))
        return [self.system.AddMarker(marker) for marker in markers]

    def drive(self, force: list[float], stiffness: list[float], wrench: list[float]) -> list[int]:
        """Actuator forces that fall with the extension from now on, and a wrench; the actuators."""
        marker = self.system.AddMarker(
            MarkerBodyRigid(bodyNumber=self.item[PLATFORM], localPosition=self.arm)
        )
        self.system.AddLoad(LoadForceVector(markerNumber=marker, loadVector=wrench[:3]))
        self.system.AddLoad(LoadTorqueVector(markerNumber=marker, loadVector=wrench[3:]))
        springs = []
        for actuator, push, rate in zip(self.actuators, force, stiffness, strict=True):
            piston = self.places[actuator.piston]
            link = piston.position + piston.rotation @ actuator.top - actuator.base
            springs.append(
                ObjectConnectorSpringDamper(
                    markerNumbers=actuator.markers,
                    referenceLength=float(np.linalg.norm(link)),
                    stiffness=rate,
                    force=-push,  # Exudyn's is positive pulling
                )
            )
        return [self.system.AddObject(spring) for spring in springs]

    def of_point(self, kind: object, body: str, point: Array) -> Array:
        """Position, velocity or acceleration of a point of a body, which is given in its axes."""
        return np.array(self.system.GetObjectOutputBody(self.item[body], kind, point.tolist()))


def state_answer(mechanism: Mechanism, state: State) -> tuple[list[float], list[float]]:
    """Place and acceleration of one state."""
    machine = Machine(mechanism, state["q"], state["qdot"])
    machine.drive(state["force"], [0.0, 0.0, 0.0], state["wrench"])
    machine.system.Assemble()
    solver = exu.MainSolverImplicitSecondOrder()
    solver.InitializeSolver(machine.system, _settings(1.0, 1))  # computes accelerations

    def platform(kind: object) -> Array:
        return machine.of_point(kind, PLATFORM, machine.arm)

    pose = _pose(platform(Output.Position), platform(Output.RotationMatrix).reshape(3, 3))
    turning = _angle_accelerations(
        pose, platform(Output.AngularVelocity), platform(Output.AngularAcceleration)
    )
    x, y, z = platform(Output.Acceleration)
    extension, bend = [], []
    for actuator in machine.actuators:
        link, velocity, acceleration = (
            machine.of_point(kind, actuator.piston, actuator.top)
            for kind in (Output.Position, Output.Velocity, Output.Acceleration)
        )
        link -= actuator.base
        length = np.linalg.norm(link)
        rate = link @ velocity / length
        extension.append(length - actuator.retracted)
        bend.append((link @ acceleration + velocity @ velocity - rate**2) / length)
    roll, pitch, yaw = turning
    return [*pose.tolist(), *extension], [roll, pitch, -z, yaw, x, y, *bend]


def motion_answer(mechanism: Mechanism, motion: Motion) -> list[list[float]]:
    """Pose and extensions at the samples, the step's error taken away to its next order."""
    steps = round(STEPS_PER_SECOND * motion["duration"])
    coarse, fine = (_integrated(mechanism, motion, count) for count in (steps, 2 * steps))
    best: list[list[float]] = (fine + (fine - coarse) / 3.0).tolist()
    return best


def _integrated(mechanism: Mechanism, motion: Motion, steps: int) -> Array:
    machine = Machine(mechanism, motion["q"], motion["qdot"])
    springs = machine.drive(motion["force"], motion["stiffness"], [0.0] * 6)
    system, platform = machine.system, machine.item[PLATFORM]
    arm = machine.arm.tolist()
    kept = {"localPosition": arm, "bodyNumber": platform, "storeInternal": True}
    position = system.AddSensor(SensorBody(outputVariableType=Output.Position, **kept))
    rotation = system.AddSensor(SensorBody(outputVariableType=Output.RotationMatrix, **kept))
    lengths = [
        system.AddSensor(
            SensorObject(
                objectNumber=spring, outputVariableType=Output.Distance, storeInternal=True
            )
        )
        for spring in springs
    ]
    system.Assemble()
    settings = _settings(motion["duration"], steps)
    settings.solution.sensors.writePeriod = motion["duration"] / motion["samples"]
    system.SolveDynamic(settings)  # generalised alpha

    def stored(sensor: int) -> Array:
        return np.array(system.GetSensorStoredData(sensor))[:, 1:]

    poses = [
        _pose(p, r.reshape(3, 3)) for p, r in zip(stored(position), stored(rotation), strict=True)
    ]
    retracted = [actuator.retracted for actuator in machine.actuators]
    return np.column_stack([poses, np.hstack([stored(i) for i in lengths]) - retracted])


def _settings(duration: float, steps: int) -> exu.SimulationSettings:
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.newton.relativeTolerance = NEWTON_TOLERANCE
    settings.timeIntegration.newton.absoluteTolerance = NEWTON_TOLERANCE
    settings.timeIntegration.newton.numericalDifferentiation.relativeEpsilon = DIFFERENCE
    settings.solution.file.write = False
    return settings


def _frame_along(axis: Array) -> Array:
    """Axes of which x is the given one, the other two across it."""
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across /= np.linalg.norm(across)
    return np.column_stack([axis, across, np.cross(axis, across)])


def _pose(position: Array, rotation: Array) -> Array:
    """(roll, pitch, height, yaw, x, y) of R = Rz(yaw) Ry(pitch) Rx(roll)."""
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
    return np.array([roll, -np.arcsin(rotation[2, 0]), -position[2], yaw, position[0], position[1]])


def _angle_accelerations(pose: Array, omega: Array, alpha: Array) -> Array:
    """Second derivatives of (roll, pitch, yaw), whose axes are carried along by the later angles."""
    pitch, yaw = pose[1], pose[3]
    roll_axis = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), -np.sin(pitch)])
    pitch_axis = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
    yaw_axis = np.array([0.0, 0.0, 1.0])
    axes = np.column_stack([roll_axis, pitch_axis, yaw_axis])
    roll_rate, pitch_rate, yaw_rate = np.linalg.solve(axes, omega)
    carried = roll_rate * np.cross(yaw_rate * yaw_axis + pitch_rate * pitch_axis, roll_axis)
    carried += pitch_rate * np.cross(yaw_rate * yaw_axis, pitch_axis)
    return np.linalg.solve(axes, alpha - carried)


def answer(request: Request) -> Answer:
    """Everything that was asked about one machine."""
    mechanism = request["mechanism"]
    states = [state_answer(mechanism, state) for state in request["states"]]
    return Answer(
        software=f"exudyn {exu.__version__}",
        place=[place for place, _ in states],
        acceleration=[acceleration for _, acceleration in states],
        motions=[motion_answer(mechanism, motion) for motion in request["motions"]],
    )


if __name__ == "__main__":
    serve(answer)
