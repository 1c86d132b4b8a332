"""Questions to the core and to both peers, and how far the answers are apart."""

from __future__ import annotations

import json
import math
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import sms
from scipy.integrate import solve_ivp
from sms import Params
from sms.arrays import Array

from validation.reference.multibody.environment import ROOT, peer_python
from validation.reference.multibody.peers.exchange import Answer, Motion, Request
from validation.reference.multibody.questions import drawn_machine, questions, reference_states

PEERS = ("exudyn", "pinocchio")

# Columns of an answer's row, by what they are; angles in rad, the rest in m.
QUANTITIES = {
    "roll, pitch": [0, 1],
    "height": [2],
    "yaw": [3],
    "x, y": [4, 5],
    "extension": [6, 7, 8],
}
ANGLES = ("roll, pitch", "yaw")

# What each comparison allows, absolute; why: README.md.
ALLOWED = {
    "place": {"exudyn": 1e-14, "pinocchio": 1e-14},
    "acceleration": {"exudyn": 5e-8, "pinocchio": 1e-11},
    "motion": {"exudyn": 5e-9, "pinocchio": 1e-11},
}
UNIT = {"place": "", "acceleration": "/s^2", "motion": ""}


@dataclass(frozen=True)
class Difference:
    """One quantity, as the core and the peers see it."""

    subject: str  #: place, acceleration, motion
    quantity: str
    unit: str
    largest: float  #: absolute value that the core found
    differences: dict[str, float]  #: largest, by peer; inf where one of the two is no number

    @property
    def agrees(self) -> bool:
        """No peer is further off than allowed."""
        return all(d <= ALLOWED[self.subject][peer] for peer, d in self.differences.items())


@dataclass(frozen=True)
class Outcome:
    """All differences, and what they come from."""

    software: dict[str, str]
    states: int
    motions: int
    differences: list[Difference]


def run(seed: int, count: int = 50, reference: Path | None = None) -> Outcome:
    """Ask core and peers about two machines, `count` random states and two motions of each.

    The first machine is the default one and gets the states of `reference` too (a file with
    `cases`, each with roll, pitch, height, qdot and F); the second has other bodies and joints.

    Raises: PeersUnavailableError when the peers cannot be installed.
    """
    python = peer_python()
    rng = np.random.default_rng(seed)
    machines = [Params(), drawn_machine(rng)]
    requests = [questions(params, rng, count) for params in machines]
    if reference:
        requests[0]["states"] += reference_states(reference)
    own = [core_answer(p, r) for p, r in zip(machines, requests, strict=True)]
    answers = {peer: ask(python, peer, requests) for peer in PEERS}
    return Outcome(
        software={peer: answer[0]["software"] for peer, answer in answers.items()},
        states=sum(len(r["states"]) for r in requests),
        motions=sum(len(r["motions"]) for r in requests),
        differences=list(differences(own, answers)),
    )


def core_answer(params: Params, request: Request) -> Answer:
    """What the core says."""
    states = request["states"]
    q, qdot, force, wrench = (
        np.array([state[key] for state in states]) for key in ("q", "qdot", "force", "wrench")
    )
    qddot = sms.forward_dynamics(
        q,
        qdot,
        force,
        external_force=wrench[:, :3],
        external_moment=wrench[:, 3:],
        params=params,
    )
    motion = sms.inverse_motion(q, qdot, qddot, params=params)
    acceleration = np.hstack([qddot, motion.parasitic_acceleration, motion.extension_acceleration])
    return Answer(
        software="",
        place=_place(params, q).tolist(),
        acceleration=acceleration.tolist(),
        motions=[_core_motion(params, m).tolist() for m in request["motions"]],
    )


def _place(params: Params, q: Array) -> Array:
    found = sms.inverse_kinematics(*q.T, params=params)
    return np.column_stack([q, found.yaw, found.x, found.y, found.extension])


def _core_motion(params: Params, motion: Motion) -> Array:
    force, stiffness = np.array(motion["force"]), np.array(motion["stiffness"])

    def extension(q: Array) -> Array:
        return sms.inverse_kinematics(*q, params=params).extension

    start = extension(np.array(motion["q"]))

    def derivative(_: float, state: Array) -> Array:
        push = force - stiffness * (extension(state[:3]) - start)
        return np.concatenate(
            [state[3:], sms.forward_dynamics(state[:3], state[3:], push, params=params)]
        )

    solution = solve_ivp(
        derivative,
        (0.0, motion["duration"]),
        [*motion["q"], *motion["qdot"]],
        method="DOP853",
        t_eval=np.linspace(0.0, motion["duration"], motion["samples"] + 1),
        rtol=1e-12,
        atol=1e-13,
    )
    seen = _place(params, solution.y[:3].T)
    if not ((seen[:, 6:] > 0.0) & (seen[:, 6:] < params.stroke)).all():
        raise ValueError(f"a motion leaves the stroke: {motion}")
    return seen


def ask(python: Path, peer: str, requests: Sequence[Request]) -> list[Answer]:
    """What a peer says, in its own environment."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "request.json"), Path(folder, "answer.json")
        source.write_text(json.dumps(requests))
        module = f"validation.reference.multibody.peers.with_{peer}"
        subprocess.run([python, "-m", module, source, target], check=True, cwd=ROOT)
        answers: list[Answer] = json.loads(target.read_text())
        return answers


def differences(own: list[Answer], answers: dict[str, list[Answer]]) -> Iterable[Difference]:
    """Each quantity of each subject, the largest over all machines; answers by peer."""
    for subject in ALLOWED:
        mine = _rows(own, subject)
        others = {peer: _rows(theirs, subject) for peer, theirs in answers.items()}
        for quantity, columns in QUANTITIES.items():
            yield Difference(
                subject=subject,
                quantity=quantity,
                unit=("rad" if quantity in ANGLES else "m") + UNIT[subject],
                largest=float(np.max(np.abs(mine[:, columns]))),
                differences={
                    peer: _largest(theirs[:, columns] - mine[:, columns])
                    for peer, theirs in others.items()
                },
            )


def _rows(answers: list[Answer], subject: str) -> Array:
    """All rows (n, 9) of one subject, over the machines."""
    if subject == "motion":
        return np.concatenate([np.array(m) for answer in answers for m in answer["motions"]])
    if subject == "place":
        return np.concatenate([np.array(answer["place"]) for answer in answers])
    return np.concatenate([np.array(answer["acceleration"]) for answer in answers])


def _largest(difference: Array) -> float:
    """Infinity where a NaN would hide."""
    largest = float(np.max(np.abs(difference)))
    return largest if math.isfinite(largest) else math.inf
