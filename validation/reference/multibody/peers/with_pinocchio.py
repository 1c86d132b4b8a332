"""The mechanism in Pinocchio: trees of joints, closed by point constraints.

The platform floats on six coordinates (x, y, z, yaw, pitch, roll), each link stands on two hinges
(the universal joint) and, an actuator, a slide. What closes the loops at the platform joints are
rigid constraints, which Pinocchio solves together with the accelerations:

    python -m validation.reference.multibody.peers.with_pinocchio REQUEST.json ANSWER.json
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

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

Array = NDArray[np.float64]

DRIVEN = [5, 4, 2]  # coordinates roll, pitch, z: what a question prescribes
POSE = [5, 4, 2, 3, 0, 1]  # roll, pitch, z, yaw, x, y
SIGN = np.array([1.0, 1.0, -1.0, 1.0, 1.0, 1.0])  # height is -z


class Machine:
    """The model of one mechanism, and the memory that Pinocchio computes in."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.model = pin.Model()
        self.model.gravity = pin.Motion(np.array(mechanism["gravity"]), np.zeros(3))
        self.last = {GROUND: 0, PLATFORM: 0}  # joint that carries a body
        self.origin = {GROUND: np.zeros(3), PLATFORM: np.array(mechanism["reference_point"])}
        self.slides: list[int] = []
        self.closures: list[tuple[int, int]] = []
        self.constraints = pin.StdVec_RigidConstraintModel()
        for hinge in (
            pin.JointModelTranslation,
            pin.JointModelRZ,
            pin.JointModelRY,
            pin.JointModelRX,
        ):
            self._append(PLATFORM, self.last[PLATFORM], hinge(), np.zeros(3))
        for joint in mechanism["joints"]:
            self._join(joint)
        for body in mechanism["bodies"]:
            lever = np.array(body["cog"]) - self.origin[body["name"]]
            inertia = pin.Inertia(body["mass"], lever, np.array(body["inertia"]))
            self.model.appendBodyToJoint(self.last[body["name"]], inertia, pin.SE3.Identity())
        self.data = self.model.createData()
        self.memory = pin.StdVec_RigidConstraintData()
        for constraint in self.constraints:
            self.memory.append(constraint.createData())
        pin.initConstraintDynamics(self.model, self.data, self.constraints, self.memory)
        self.solver = pin.ProximalSettings(1e-15, 1e-10, 20)
        self.free = [i for i in range(self.model.nv) if i not in DRIVEN]

    def _append(self, name: str, parent: int, kind: object, at: Array) -> int:
        """One more joint below `parent`, at a point of its frame; returns its coordinate."""
        placement = pin.SE3(np.eye(3), at)
        number = self.model.addJoint(parent, kind, placement, f"{name} {self.model.njoints}")
        self.last[name] = number
        return int(self.model.joints[number].idx_v)

    def _join(self, joint: Joint) -> None:
        first, second = joint["bodies"]
        point, axes = np.array(joint["point"]), [np.array(axis) for axis in joint["axes"]]
        if joint["kind"] == "universal":
            self.origin[second] = point
            at = point - self.origin[first]
            self._append(second, self.last[first], pin.JointModelRevoluteUnaligned(axes[0]), at)
            hinge = pin.JointModelRevoluteUnaligned(axes[1])
            self._append(second, self.last[second], hinge, np.zeros(3))
        elif joint["kind"] == "prismatic":
            self.origin[second] = self.origin[first]
            slide = pin.JointModelPrismaticUnaligned(axes[0])
            self.slides.append(self._append(second, self.last[first], slide, np.zeros(3)))
        else:
            self._close(first, second, point)

    def _close(self, first: str, second: str, point: Array) -> None:
        """A loop: the point of both bodies stays one."""
        ends = []
        for body in (first, second):
            place = pin.SE3(np.eye(3), point - self.origin[body])
            frame = pin.Frame(f"{first} {body}", self.last[body], 0, place, pin.FrameType.OP_FRAME)
            ends.append((self.last[body], place, self.model.addFrame(frame)))
        (joint_1, place_1, frame_1), (joint_2, place_2, frame_2) = ends
        self.closures.append((frame_1, frame_2))
        self.constraints.append(
            pin.RigidConstraintModel(
                pin.ContactType.CONTACT_3D, self.model, joint_1, place_1, joint_2, place_2
            )
        )

    def gaps(self, q: Array) -> tuple[Array, Array]:
        """How far the loops are open, m, and the derivatives by the coordinates."""
        pin.computeJointJacobians(self.model, self.data, q)
        pin.updateFramePlacements(self.model, self.data)
        gaps, slopes = [], []
        for pair in self.closures:
            points = [self.data.oMf[f].translation.copy() for f in pair]
            rows = [
                pin.getFrameJacobian(
                    self.model, self.data, f, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
                )[:3]
                for f in pair
            ]
            gaps.append(points[0] - points[1])
            slopes.append(rows[0] - rows[1])
        return np.concatenate(gaps), np.vstack(slopes)

    def closed(self, place: Array, rate: Array) -> tuple[Array, Array]:
        """Coordinates and their rates with all loops closed at (roll, pitch, height)."""
        q, v = np.zeros(self.model.nq), np.zeros(self.model.nv)
        q[:2] = self.origin[PLATFORM][:2]
        q[DRIVEN], v[DRIVEN] = SIGN[:3] * place, SIGN[:3] * rate
        for _ in range(12):
            gap, slope = self.gaps(q)
            q[self.free] -= np.linalg.solve(slope[:, self.free], gap)
        slope = self.gaps(q)[1]
        v[self.free] = -np.linalg.solve(slope[:, self.free], slope[:, DRIVEN] @ v[DRIVEN])
        return q, v

    def acceleration(self, q: Array, v: Array, force: Array, wrench: Array) -> Array:
        """Of all coordinates, under actuator forces and a wrench at the reference point."""
        tau = np.zeros(self.model.nv)
        tau[self.slides] = force
        if wrench.any():
            pin.computeJointJacobians(self.model, self.data, q)
            tau += (
                pin.getJointJacobian(
                    self.model,
                    self.data,
                    self.last[PLATFORM],
                    pin.ReferenceFrame.LOCAL_WORLD_ALIGNED,
                ).T
                @ wrench
            )
        answer = pin.constraintDynamics(
            self.model, self.data, q, v, tau, self.constraints, self.memory, self.solver
        )
        return np.array(answer)

    def seen(self, values: Array) -> list[float]:
        """Pose and extensions, or their derivatives, among the coordinates."""
        return [*(SIGN * values[POSE]).tolist(), *values[self.slides].tolist()]


def state_answer(machine: Machine, state: State) -> tuple[list[float], list[float]]:
    """Place and acceleration of one state."""
    q, v = machine.closed(np.array(state["q"]), np.array(state["qdot"]))
    a = machine.acceleration(q, v, np.array(state["force"]), np.array(state["wrench"]))
    return machine.seen(q), machine.seen(a)


def motion_answer(machine: Machine, motion: Motion) -> list[list[float]]:
    """Pose and extensions at the samples of one motion."""
    q, v = machine.closed(np.array(motion["q"]), np.array(motion["qdot"]))
    force, stiffness = np.array(motion["force"]), np.array(motion["stiffness"])
    start, n = q[machine.slides], q.size

    def derivative(_: float, state: Array) -> Array:
        push = force - stiffness * (state[:n][machine.slides] - start)
        acceleration = machine.acceleration(state[:n], state[n:], push, np.zeros(6))
        return np.concatenate([state[n:], acceleration])

    solution = solve_ivp(
        derivative,
        (0.0, motion["duration"]),
        np.concatenate([q, v]),
        method="DOP853",
        t_eval=np.linspace(0.0, motion["duration"], motion["samples"] + 1),
        rtol=1e-12,
        atol=1e-13,
    )
    return [machine.seen(row[:n]) for row in solution.y.T]


def answer(request: Request) -> Answer:
    """Everything that was asked about one machine."""
    machine = Machine(request["mechanism"])
    states = [state_answer(machine, state) for state in request["states"]]
    return Answer(
        software=f"pinocchio {pin.__version__}",
        place=[place for place, _ in states],
        acceleration=[acceleration for _, acceleration in states],
        motions=[motion_answer(machine, motion) for motion in request["motions"]],
    )


if __name__ == "__main__":
    serve(answer)
