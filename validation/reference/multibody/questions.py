"""What is asked: other machines, random states and motions of them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import sms
from sms import Params
from sms.parameters import PARAMETERS

from validation.reference.multibody.mechanism import mechanism_of
from validation.reference.multibody.peers.exchange import Motion, Request, State

VARIED = ("base_joint", "platform_joint", "top_frame", "payload", "cylinder_", "piston_", "panhard")
OF_UNCERTAINTY = 0.2  # so far may a drawn machine be from the default; keeps inertias possible


def drawn_machine(rng: np.random.Generator) -> Params:
    """Another machine: every joint, mass, centre of gravity and inertia a little off."""
    values = {}
    for name, row in PARAMETERS.items():
        known = name.startswith(VARIED) and "offset" not in name
        if known and ("joint" in name or "mass" in name or "cog" in name or "inertia" in name):
            value = row.default + OF_UNCERTAINTY * row.uncertainty * rng.uniform(-1.0, 1.0)
            values[name] = min(max(value, row.lower), row.upper)
    return Params(**values)


def questions(params: Params, rng: np.random.Generator, count: int) -> Request:
    """Random states all over the stroke, and two motions about its middle, on springs.

    The springs make up for air: without them the payload topples. They keep the motions in the stroke.
    """
    pose = sms.forward_kinematics(rng.uniform(0.0, params.stroke, (count, 3)), params=params)
    places = np.column_stack([pose.roll, pose.pitch, pose.height])
    hold = sms.holding_force(places, params=params)
    states = [
        State(
            q=place.tolist(),
            qdot=rng.uniform(-0.5, 0.5, 3).tolist(),
            force=(force + rng.uniform(-500.0, 500.0, 3)).tolist(),
            wrench=rng.uniform(-300.0, 300.0, 6).tolist(),
        )
        for place, force in zip(places, hold, strict=True)
    ]
    middle = np.array([0.0, 0.0, 0.5])
    motions = [
        Motion(
            q=(middle + rng.uniform(-0.03, 0.03, 3)).tolist(),
            qdot=rng.uniform(-0.25, 0.25, 3).tolist(),
            force=(sms.holding_force(middle, params=params) + rng.uniform(-100, 100, 3)).tolist(),
            stiffness=[20e3] * 3,
            duration=2.0,
            samples=200,
        )
        for _ in range(2)
    ]
    return Request(mechanism=mechanism_of(params), states=states, motions=motions)


def reference_states(reference: Path) -> list[State]:
    """The states of dynamics.json: `cases`, each with roll, pitch, height, qdot and F."""
    return [
        State(
            q=[case["roll"], case["pitch"], case["height"]],
            qdot=case["qdot"],
            force=case["F"],
            wrench=[0.0] * 6,
        )
        for case in json.loads(reference.read_text())["cases"]
    ]
