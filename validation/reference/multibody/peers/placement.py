"""Where the bodies are at (roll, pitch, height), and how fast: geometry for codes without joint coordinates.

A code in absolute coordinates has to be told the place and the velocity of every body at the start.
The place follows from the joints; the velocity is the derivative of the place by time, taken by a
complex step (the imaginary part of f(q + i h q') / h, exact to rounding), so that it needs no
formula of its own. The code's joints then show whether both were right.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from validation.reference.multibody.peers.exchange import PLATFORM, Joint, Mechanism

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

STEP = 1e-40


@dataclass(frozen=True)
class Link:
    """Bodies in line from the ground joint to the platform joint; the second one slides."""

    bodies: list[str]
    base: Array
    axis: Array  #: of the universal joint, fixed to the ground
    top: Array  #: platform joint at rest


@dataclass(frozen=True)
class Place:
    """Of one body: position of its centre of gravity, rotation since rest, and their rates."""

    position: Array  #: m
    rotation: Array  #: 3x3
    velocity: Array  #: m/s
    angular_velocity: Array  #: rad/s, world axes


class Placement:
    """The places of all bodies of one mechanism."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.reference = np.array(mechanism["reference_point"])
        self.cog = {body["name"]: np.array(body["cog"]) for body in mechanism["bodies"]}
        self.links = [
            _link(joint, mechanism["joints"])
            for joint in mechanism["joints"]
            if joint["kind"] == "universal"
        ]

    def at(self, q: list[float], qdot: list[float]) -> dict[str, Place]:
        """Every body at q = (roll, pitch, height), moving at qdot."""
        places = self._places(np.array(q) + 1j * STEP * np.array(qdot))
        return {name: _place(*complex_place) for name, complex_place in places.items()}

    def _places(self, q: Complex) -> dict[str, tuple[Complex, Complex]]:
        """Position and rotation of every body."""
        parasitic = self._parasitic(q)
        turn, shift = self._platform(q, parasitic)
        places = {PLATFORM: (shift + turn @ (self.cog[PLATFORM] - self.reference), turn)}
        for link in self.links:
            top = shift + turn @ (link.top - self.reference)
            rotation = _axes(top - link.base, link.axis) @ _axes(link.top - link.base, link.axis).T
            hung = link.bodies[0]
            places[hung] = (link.base + rotation @ (self.cog[hung] - link.base), rotation)
            for body in link.bodies[1:]:
                places[body] = (top + rotation @ (self.cog[body] - link.top), rotation)
        return places

    def _platform(self, q: Complex, parasitic: Complex) -> tuple[Complex, Complex]:
        yaw, x, y = parasitic
        turn = _about(2, yaw) @ _about(1, q[1]) @ _about(0, q[0])
        return turn, np.array([x, y, -q[2]])

    def _parasitic(self, q: Complex) -> Complex:
        """(yaw, x, y) that leave the lengths of the links without a slide as they were at rest."""
        value = np.array([0.0, *self.reference[:2]], dtype=complex)
        for _ in range(8):  # the last ones only bring the imaginary part in
            slope = np.empty((3, 3))
            for k in range(3):
                stepped = value.real + 1j * STEP * np.eye(3)[k]
                slope[:, k] = self._misfit(q.real.astype(complex), stepped).imag / STEP
            value = value - np.linalg.solve(slope, self._misfit(q, value))
        return value

    def _misfit(self, q: Complex, parasitic: Complex) -> Complex:
        turn, shift = self._platform(q, parasitic)
        rods = [link for link in self.links if len(link.bodies) == 1]
        spans = [shift + turn @ (rod.top - self.reference) - rod.base for rod in rods]
        at_rest = [rod.top - rod.base for rod in rods]
        return np.array([s @ s - r @ r for s, r in zip(spans, at_rest, strict=True)])


def _link(universal: Joint, joints: list[Joint]) -> Link:
    bodies = [universal["bodies"][1]]
    while True:
        joint = next(j for j in joints if j["bodies"][0] == bodies[-1])
        if joint["kind"] == "spherical":
            base, axis = np.array(universal["point"]), np.array(universal["axes"][0])
            return Link(bodies, base, axis, np.array(joint["point"]))
        bodies.append(joint["bodies"][1])


def _axes(span: Complex | Array, axis: Array) -> Complex:
    """Axes of a link: along it, across it and the ground axis, and the third."""
    along = span / np.sqrt(span @ span)
    across = np.cross(along, axis)
    across = across / np.sqrt(across @ across)
    return np.column_stack([along, across, np.cross(along, across)]).astype(complex)


def _about(axis: int, angle: complex) -> Complex:
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3, dtype=complex)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i] = np.sin(angle)
    matrix[i, j] = -matrix[j, i]
    return matrix


def _place(position: Complex, rotation: Complex) -> Place:
    spin = (rotation.imag / STEP) @ rotation.real.T
    return Place(
        position=position.real,
        rotation=rotation.real,
        velocity=position.imag / STEP,
        angular_velocity=np.array([spin[2, 1], spin[0, 2], spin[1, 0]]),
    )
