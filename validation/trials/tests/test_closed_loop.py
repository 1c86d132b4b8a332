"""Blind proof in a closed loop: the controller is simulated, and told apart from the machine that it drives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sms.diagnosis import Diagnosis, diagnose

from validation.random_cases import draw
from validation.twins.air import Array
from validation.twins.closed_loop import draw_closed
from validation.twins.controller import PLATFORM_CONTROLLER, Controller

LEAK = 2e-8  # kg/(s Pa): three of the detection limits of such a bench without its command (`still_hidden`: 6e-9)
CONTROLLERS = {"bench": Controller(), "platform": PLATFORM_CONTROLLER}


def answer(
    folder: Path,
    seed: int,
    effect: str | None = None,
    size: float = 0.0,
    command: bool = True,
    kind: str = "bench",
) -> Diagnosis:
    sealed = folder / "sealed" / "truth.json"
    draw_closed(seed, folder / "records", sealed, effect, size, command, kind)
    return diagnose(folder / "records" / "rig.toml")


@pytest.mark.parametrize("kind", ["bench", pytest.param("platform", marks=pytest.mark.full)])
def test_the_loop_follows_its_set_point_and_holds_its_command(tmp_path: Path, kind: str) -> None:
    seed = int(draw("a loop").integers(10**6))
    draw_closed(seed, tmp_path / "records", tmp_path / "truth.json", kind=kind)
    for path in (tmp_path / "records").glob("*.csv"):
        head = path.read_text().partition("\n")[0].split(",")
        table = dict(zip(head, np.loadtxt(path, delimiter=",", skiprows=1).T, strict=True))
        for leg in ("",) if kind == "bench" else ("_1", "_2", "_3"):
            extension, command = table[f"extension{leg} [m]"], table[f"valve_command{leg} [V]"]
            error = table[f"setpoint{leg} [m]"] - extension
            assert follows(error, extension) > 0.6
            assert 0.0 < command.min() < 4.9 and 5.1 < command.max() < 10.0
            # Out of the dead band the sign of the command is that of what has to be made up for.
            far = np.abs(error) > 0.04
            assert np.all(np.sign(command - 5.0)[far] == np.sign(error)[far])


def follows(error: Array, extension: Array) -> float:
    """How the speed goes with the error, up to 0.1 s before, as a correlation: 0 if it goes its own way."""
    speed = np.convolve(np.gradient(extension), np.ones(9) / 9.0, "same")
    late = [speed[k:] for k in (0, 5, 10, 20)]
    return max(float(np.corrcoef(error[: len(s)], s)[0, 1]) for s in late)


LOOPS = [(kind, command) for kind in ("bench", "platform") for command in (True, False)]


@pytest.mark.full
@pytest.mark.parametrize(("kind", "command"), LOOPS)
def test_a_healthy_loop_gives_no_evidence(tmp_path: Path, kind: str, command: bool) -> None:
    found = answer(tmp_path, 1, command=command, kind=kind)
    assert (found.verdict, found.causes) == ("no-evidence", ())


@pytest.mark.full
@pytest.mark.parametrize(("kind", "command"), LOOPS)
def test_a_wrong_gain_is_named_with_its_value(tmp_path: Path, kind: str, command: bool) -> None:
    share = 0.2
    found = answer(tmp_path, 1, "proportional_gain", share, command, kind)
    assert found.verdict in ("cause", "class")
    (cause,) = found.causes
    assert (cause.effect, cause.signal) == ("controller_mismatch", "proportional_gain")
    value = cause.parameters[0]
    right = (1.0 + share) * CONTROLLERS[kind].proportional
    assert value.value == pytest.approx(right, abs=max(4.0 * value.standard_error, 0.01 * right))


@pytest.mark.full
@pytest.mark.parametrize(("kind", "command"), LOOPS)
def test_a_leak_of_the_machine_is_not_blamed_on_the_controller(
    tmp_path: Path, kind: str, command: bool
) -> None:
    found = answer(tmp_path, 2, "piston_leakage", LEAK, command, kind)
    assert found.verdict in ("cause", "class")
    (cause,) = found.causes
    assert "piston_leakage" in cause.members
    assert "controller_mismatch" not in cause.members
