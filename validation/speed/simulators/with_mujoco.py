"""The mechanism in MuJoCo: trees of joints, closed by nine equations of its constraint solver.

The platform floats, each link stands on two hinges and, an actuator, slides; `connect` holds the
links to the platform. Integrator, solver and everything else are MuJoCo's defaults, except that
the constraints are as stiff as its time step allows:

    python -m validation.speed.simulators.with_mujoco < TASK.json > RESULT.json
"""

from __future__ import annotations

import xml.etree.ElementTree as Xml
from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from validation.reference.multibody.peers.exchange import PLATFORM, Body, Mechanism
from validation.reference.multibody.peers.placement import Place, Placement
from validation.speed.simulators.exchange import Result, Task, fastest, serve

Array = NDArray[np.float64]


def _text(*numbers: float) -> str:
    return " ".join(repr(float(n)) for n in numbers)


class Description:
    """The MJCF of one mechanism; every body's frame is parallel to the world's at rest."""

    def __init__(self, task: Task) -> None:
        mechanism = task["mechanism"]
        self.bodies = {body["name"]: body for body in mechanism["bodies"]}
        self.origin = {PLATFORM: np.array(self.bodies[PLATFORM]["cog"])}
        self.root = Xml.Element("mujoco")
        option = Xml.SubElement(self.root, "option", timestep=_text(task["step"]))
        option.set("gravity", _text(*mechanism["gravity"]))
        self.world = Xml.SubElement(self.root, "worldbody")
        self.equality = Xml.SubElement(self.root, "equality")
        self.element: dict[str, Xml.Element] = {}
        Xml.SubElement(self._body(self.world, PLATFORM, np.zeros(3)), "freejoint")
        for joint in mechanism["joints"]:
            first, second = joint["bodies"]
            point = np.array(joint["point"])
            if joint["kind"] == "universal":
                self.origin[second] = point
                element = self._body(self.world, second, np.zeros(3))
                for axis in joint["axes"]:
                    Xml.SubElement(element, "joint", type="hinge", axis=_text(*axis))
            elif joint["kind"] == "prismatic":
                self.origin[second] = self.origin[first]
                element = self._body(self.element[first], second, self.origin[first])
                slide = Xml.SubElement(element, "joint", type="slide")
                slide.set("axis", _text(*joint["axes"][0]))
                slide.set("stiffness", _text(task["stiffness"]))
                slide.set("springref", _text(task["force"][0] / task["stiffness"]))
            else:
                connect = Xml.SubElement(self.equality, "connect", body1=first, body2=second)
                connect.set("anchor", _text(*(point - self.origin[first])))
                connect.set("solref", _text(2.0 * task["step"], 1.0))
                connect.set("solimp", "0.999 0.9999 0.001 0.5 2")

    def _body(self, parent: Xml.Element, name: str, parent_origin: Array) -> Xml.Element:
        body: Body = self.bodies[name]
        origin = self.origin[name]
        element = Xml.SubElement(parent, "body", name=name, pos=_text(*(origin - parent_origin)))
        inertia = np.array(body["inertia"])
        full = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        inertial = Xml.SubElement(element, "inertial", mass=_text(body["mass"]))
        inertial.set("pos", _text(*(np.array(body["cog"]) - origin)))
        inertial.set("fullinertia", _text(*full))
        self.element[name] = element
        return element

    def model(self) -> mujoco.MjModel:
        """What MuJoCo makes of it."""
        return mujoco.MjModel.from_xml_string(Xml.tostring(self.root, encoding="unicode"))


def start_of(task: Task, places: dict[str, Place]) -> tuple[Array, Array]:
    """MuJoCo's coordinates and velocities, in the order in which the description names joints."""
    platform = places[PLATFORM]
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, platform.rotation.ravel())
    q: list[float] = [*platform.position, *quaternion]
    v: list[float] = [*platform.velocity, *(platform.rotation.T @ platform.angular_velocity)]
    cog = {body["name"]: np.array(body["cog"]) for body in task["mechanism"]["bodies"]}
    base = np.zeros(3)
    for joint in task["mechanism"]["joints"]:
        body = joint["bodies"][1]
        place, axes = places[body], [np.array(axis) for axis in joint["axes"]]
        if joint["kind"] == "universal":  # the second axis is carried by the first hinge
            base, (first, second) = np.array(joint["point"]), axes
            carried = place.rotation @ second
            seen = place.rotation.T @ first
            q.append(np.arctan2(np.cross(second, carried) @ first, second @ carried))
            q.append(-np.arctan2(np.cross(first, seen) @ second, first @ seen))
            v += [place.angular_velocity @ first, place.angular_velocity @ carried]
        elif joint["kind"] == "prismatic":
            arm, along = place.position - base, place.rotation @ axes[0]
            q.append(along @ (arm - place.rotation @ (cog[body] - base)))
            v.append(along @ (place.velocity - np.cross(place.angular_velocity, arm)))
    return np.array(q), np.array(v)


def _driven(mechanism: Mechanism, data: mujoco.MjData) -> list[float]:
    """(roll, pitch, height) of the platform."""
    cog = np.array(next(b["cog"] for b in mechanism["bodies"] if b["name"] == PLATFORM))
    rotation = np.array(data.body(PLATFORM).xmat).reshape(3, 3)
    point = data.body(PLATFORM).xpos + rotation @ (np.array(mechanism["reference_point"]) - cog)
    return [
        float(np.arctan2(rotation[2, 1], rotation[2, 2])),
        float(-np.arcsin(rotation[2, 0])),
        float(-point[2]),
    ]


def answer(task: Task) -> Result:
    """Where it swings, and how fast a step is when C calls it."""
    model = Description(task).model()
    data = mujoco.MjData(model)
    q, v = start_of(task, Placement(task["mechanism"]).at(task["q"], task["qdot"]))

    def prepare() -> Callable[[], object]:
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(model, data)
        return lambda: mujoco.mj_step(model, data, task["steps"])

    seconds = fastest(prepare)
    mujoco.mj_forward(model, data)
    return Result(
        software=f"mujoco {mujoco.__version__}",
        q=_driven(task["mechanism"], data),
        microseconds=seconds / task["steps"] * 1e6,
    )


if __name__ == "__main__":
    serve(answer)
