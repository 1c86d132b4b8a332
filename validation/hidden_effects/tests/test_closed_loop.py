"""Blind proof in a closed loop: the controller is simulated, and told apart from the machine that it drives."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sms.diagnosis import Diagnosis, diagnose

from validation.hidden_effects.machines.closed_loop import Controller, draw_closed
from validation.random_cases import draw

LEAK = 2e-9  # kg/(s Pa)


def answer(
    folder: Path, seed: int, effect: str | None = None, size: float = 0.0, command: bool = True
) -> Diagnosis:
    draw_closed(seed, folder / "records", folder / "sealed" / "truth.json", effect, size, command)
    return diagnose(folder / "records" / "rig.toml")


def test_the_loop_follows_its_set_point_and_holds_its_command(tmp_path: Path) -> None:
    seed = int(draw("a loop").integers(10**6))
    draw_closed(seed, tmp_path / "records", tmp_path / "truth.json")
    for path in (tmp_path / "records").glob("*.csv"):
        head = path.read_text().partition("\n")[0].split(",")
        table = dict(zip(head, np.loadtxt(path, delimiter=",", skiprows=1).T, strict=True))
        error = table["setpoint [m]"] - table["extension [m]"]
        command = table["valve_command [V]"]
        assert np.std(error) < 0.95 * np.std(table["setpoint [m]"])  # a machine at rest: 1
        assert 0.0 < command.min() < 4.9 and 5.1 < command.max() < 10.0
        # Out of the dead band the sign of the command is that of what has to be made up for.
        far = np.abs(error) > 0.04
        assert np.all(np.sign(command - 5.0)[far] == np.sign(error)[far])


@pytest.mark.full
@pytest.mark.parametrize("command", [True, False])
def test_a_healthy_loop_gives_no_evidence(tmp_path: Path, command: bool) -> None:
    found = answer(tmp_path, 1, command=command)
    assert (found.verdict, found.causes) == ("no-evidence", ())


@pytest.mark.full
@pytest.mark.parametrize("command", [True, False])
def test_a_wrong_gain_is_named_with_its_value(tmp_path: Path, command: bool) -> None:
    share = 0.2
    found = answer(tmp_path, 1, "proportional_gain", share, command)
    assert found.verdict in ("cause", "class")
    (cause,) = found.causes
    assert (cause.effect, cause.signal) == ("controller_mismatch", "proportional_gain")
    value = cause.parameters[0]
    right = (1.0 + share) * Controller().proportional
    assert value.value == pytest.approx(right, abs=max(4.0 * value.standard_error, 0.01 * right))


@pytest.mark.full
@pytest.mark.parametrize("command", [True, False])
def test_a_leak_of_the_machine_is_not_blamed_on_the_controller(
    tmp_path: Path, command: bool
) -> None:
    found = answer(tmp_path, 2, "piston_leakage", LEAK, command)
    assert found.verdict in ("cause", "class")
    (cause,) = found.causes
    assert "piston_leakage" in cause.members
    assert "controller_mismatch" not in cause.members
