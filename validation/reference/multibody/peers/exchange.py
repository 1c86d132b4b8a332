"""What goes to a peer and what comes back, as JSON: numbers of a machine, none of its equations.

SI units, world axes (z down). A mechanism is described in its rest pose, where the axes of all
bodies are parallel to the world's. A pose is (roll, pitch, height, yaw, x, y) of the platform:
R = Rz(yaw) Ry(pitch) Rx(roll), and its reference point is at (x, y, -height).
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TypedDict

Vector = list[float]

GROUND = "ground"
PLATFORM = "platform"


class Body(TypedDict):
    """A rigid body at rest."""

    name: str
    mass: float  #: kg
    cog: Vector  #: centre of gravity, m
    inertia: list[Vector]  #: about the centre of gravity, 3x3, kg m^2


class Joint(TypedDict):
    """What holds two bodies together.

    kind      axes
    universal first fixed in bodies[0], second in bodies[1]; they stay perpendicular
    prismatic the direction in which bodies[1] slides on bodies[0] without turning
    spherical none
    """

    kind: str
    bodies: list[str]
    point: Vector  #: common point at rest, m
    axes: list[Vector]  #: unit vectors


class Mechanism(TypedDict):
    """A machine. The prismatic joints are its actuators, 1 to 3 in this order, at extension 0."""

    gravity: Vector  #: m/s^2
    reference_point: Vector  #: of the platform, m
    bodies: list[Body]
    joints: list[Joint]


class State(TypedDict):
    """Question: which acceleration?"""

    q: Vector  #: roll, pitch, height
    qdot: Vector
    force: Vector  #: of the actuators, N, positive pushing out
    wrench: Vector  #: on the platform: force at the reference point, N, and moment, N m


class Motion(TypedDict):
    """Question: where does it go from q, qdot under force - stiffness (extension - its start)?"""

    q: Vector
    qdot: Vector
    force: Vector  #: N
    stiffness: Vector  #: N/m
    duration: float  #: s
    samples: int  #: how many, evenly spaced, besides the start


class Request(TypedDict):
    """All questions about one machine."""

    mechanism: Mechanism
    states: list[State]
    motions: list[Motion]


class Answer(TypedDict):
    """The answers, in the order of the questions; each row is a pose and the three extensions."""

    software: str  #: name and version
    place: list[Vector]  #: of the states: pose and extensions, m, rad
    acceleration: list[Vector]  #: of the states: second derivatives of pose and extensions
    motions: list[list[Vector]]  #: pose and extensions at each sample, from the start on


def serve(answer: Callable[[Request], Answer]) -> None:
    """Read the request that the first argument names, write its answer to the second."""
    source, target = (Path(name) for name in sys.argv[1:])
    requests: list[Request] = json.loads(source.read_text())
    target.write_text(json.dumps([answer(request) for request in requests]))
