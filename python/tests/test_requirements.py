"""Table 2.1: known facts about the machine, and that every number follows the parameters."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import sms
from sms import inverse_dynamics, inverse_motion
from sms.requirements import SPECIFIED, Compliance, Row, best_height, compliance
from sms.workspace_survey import DEGREE
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command
from test_cli_mechanism import run

DAMPED = {"position_gain": 30.0, "velocity_gain": 0.0, "acceleration_gain": 0.3}


@pytest.fixture(scope="module")
def damped() -> Compliance:
    return compliance(sms.Params(**DAMPED))


def row(found: Compliance, criterion: str, axis: str) -> Row:
    return next(r for r in found.rows if r.criterion == criterion and r.axis == axis)


def test_the_ranges_are_those_of_the_workspace(damped: Compliance) -> None:
    assert row(damped, "range", "roll").computed / DEGREE == pytest.approx(9.7, abs=0.1)
    assert row(damped, "range", "pitch").computed / DEGREE == pytest.approx(8.5, abs=0.1)
    both = row(damped, "range", "roll with pitch, required")
    # SPEC: +-8 with +-4 degrees fits at no height.
    assert not both.meets(both.required) and both.limit == "stroke"
    box = row(damped, "range", "roll with pitch, specified")
    assert box.meets(box.required)
    assert best_height(damped.params, SPECIFIED) == pytest.approx(0.499, abs=0.002)


def test_at_the_computed_rate_the_fastest_actuator_is_at_its_limit(damped: Compliance) -> None:
    computed = row(damped, "rate", "roll").computed
    shares = []
    for roll in np.linspace(-1, 1, 5) * SPECIFIED.roll:
        for pitch in np.linspace(-1, 1, 5) * SPECIFIED.pitch:
            for sign in (-1.0, 1.0):
                q = (roll, pitch, damped.height)
                rate = inverse_motion(q, (sign * computed, 0.0, 0.0)).extension_rate
                shares.append(max(rate.max() / damped.speed.up, -rate.min() / damped.speed.down))
    assert max(shares) == pytest.approx(1.0, abs=1e-9)


def test_the_acceleration_takes_all_of_the_force(damped: Compliance) -> None:
    computed = row(damped, "acceleration", "roll").computed
    q = np.array(
        [
            [i * SPECIFIED.roll, j * SPECIFIED.pitch, damped.height]
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
        ]
    )
    push, pull = sms._core.force_range(damped.params)
    for factor, fits in ((0.95, True), (1.1, False)):
        forces = [
            inverse_dynamics(q, (0, 0, 0), (sign * factor * computed, 0, 0)) for sign in (-1, 1)
        ]
        most = (
            max(force.max() / push for force in forces),
            max(-force.min() / pull for force in forces),
        )
        assert (max(most) < 1.0) == fits or not fits


def test_the_load_follows_the_supply(damped: Compliance) -> None:
    weaker = compliance(sms.Params(**DAMPED, supply_pressure=386e3))
    ratio = row(weaker, "load", "payload").computed / row(damped, "load", "payload").computed
    assert 0.5 < ratio < 0.8  # three quarters of the pressure, less friction and frame
    assert row(damped, "load", "payload").limit == "force"


def test_damped_gains_are_accurate_and_the_published_ones_oscillate(damped: Compliance) -> None:
    accuracy = row(damped, "accuracy", "roll and pitch")
    assert accuracy.smaller_is_better and accuracy.meets(0.5 * DEGREE)
    assert row(damped, "bandwidth", "roll, small").computed > 0.5
    published = compliance(sms.Params())
    assert row(published, "accuracy", "roll and pitch").limit == "stability"
    assert row(published, "bandwidth", "roll, small").computed == 0.0


def test_the_command_prints_a_table_and_json(tmp_path: Path) -> None:
    gains = [word for name, value in DAMPED.items() for word in ("--set", f"{name}={value}")]
    printed = json.loads(run("requirements", *gains, "--json", cwd=tmp_path).stdout)
    assert printed == json.loads((tmp_path / "requirements/requirements.json").read_text())
    criteria = {entry["criterion"] for entry in printed["rows"]}
    assert criteria == {"range", "rate", "acceleration", "accuracy", "load", "bandwidth"}
    assert all(entry["limit"] for entry in printed["rows"])
    page = (tmp_path / "requirements/requirements.html").read_text(encoding="utf-8")
    assert "Table 2.1, computed" in page
    refused(command("requirements", "--controller", "lqr", cwd=tmp_path), "state_feedback, pid")
    weak = command("requirements", "--set", "supply_pressure=120e3", cwd=tmp_path)
    refused(weak, "no steady speed")
