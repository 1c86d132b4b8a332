"""The core's dynamics agree with two multibody codes that share no equation with it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from sms import Params

from validation.random_cases import SEED
from validation.reference.multibody.__main__ import table_of
from validation.reference.multibody.comparison import Difference, ask, core_answer, differences, run
from validation.reference.multibody.environment import ROOT, PeersUnavailableError, peer_python
from validation.reference.multibody.mechanism import mechanism_of
from validation.reference.multibody.questions import drawn_machine, questions

SHARED = Path(os.environ.get("SMS_SHARED", ROOT.parent / "shared"))
REFERENCE = SHARED / "reference" / "dynamics.json"
MOVING_MASS = 353.7  # kg, of all bodies of Table 3.1


@pytest.fixture(scope="module")
def python() -> Path:
    try:
        return peer_python()
    except PeersUnavailableError as error:
        pytest.skip(str(error))


@pytest.fixture
def seed() -> int:
    print(f"SMS_TEST_SEED={SEED}")
    return SEED


@pytest.mark.full
@pytest.mark.usefixtures("python")
def test_accelerations_and_motions_agree(seed: int) -> None:
    outcome = run(seed, reference=REFERENCE if REFERENCE.exists() else None)
    Console(width=120).print(table_of(outcome))
    assert outcome.states >= 100
    assert [d for d in outcome.differences if not d.agrees] == []


@pytest.mark.full
def test_a_thousandth_of_a_piston_s_inertia_is_seen(python: Path, seed: int) -> None:
    request = questions(Params(), np.random.default_rng(seed), count=10)
    own = core_answer(Params(), request)
    for body in request["mechanism"]["bodies"]:
        if body["name"].startswith("piston"):
            body["inertia"] = (1.001 * np.array(body["inertia"])).tolist()
    found = list(differences([own], {"pinocchio": ask(python, "pinocchio", [request])}))
    assert [d.agrees for d in found if d.subject == "place"] == [True] * 5
    assert not any(d.agrees for d in found if d.subject == "acceleration")


def test_the_bodies_are_those_of_the_table() -> None:
    mechanism = mechanism_of(Params())
    assert len(mechanism["bodies"]) == 10
    assert len(mechanism["joints"]) == 15
    assert sum(b["mass"] for b in mechanism["bodies"]) == pytest.approx(MOVING_MASS, abs=0.1)


def test_no_body_of_a_drawn_machine_is_impossible() -> None:
    for seed in range(50):
        for body in mechanism_of(drawn_machine(np.random.default_rng(seed)))["bodies"]:
            assert body["mass"] > 0.0
            assert np.linalg.eigvalsh(np.array(body["inertia"]))[0] > 0.0


def test_lengths_that_do_not_fit_the_rest_pose_are_refused() -> None:
    with pytest.raises(ValueError, match="panhard_length_offset_2 is not zero"):
        mechanism_of(Params(panhard_length_offset_2=1e-3))


@pytest.mark.parametrize(("difference", "agrees"), [(4e-8, True), (6e-8, False), (np.inf, False)])
def test_a_difference_beyond_the_allowed_is_seen(difference: float, agrees: bool) -> None:
    row = Difference("acceleration", "yaw", "rad/s^2", 1.0, {"exudyn": difference})
    assert row.agrees is agrees
