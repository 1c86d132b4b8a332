"""The search for what is missing: its candidates, its tables, and (full) what it found."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from sms import Params
from sms.parameters import PARAMETERS
from sms.validation.chirps import gain_and_phase
from sms.validation.figures import FIGURES
from sms.validation.findings import ACTUATOR, FEEDBACK, scaled
from sms.validation.runs import run
from sms.validation.steps import DESIGNED, farthest, feedback

from validation.published import actuator, state_feedback, what_is_missing
from validation.published.candidates import ACTUATOR as ACTUATOR_CANDIDATES
from validation.published.candidates import STATE_FEEDBACK, Candidate
from validation.published.state_feedback import Outcome
from validation.random_cases import draw


@pytest.mark.parametrize("candidate", [*STATE_FEEDBACK, *ACTUATOR_CANDIDATES], ids=lambda c: c.name)
def test_a_candidate_stays_within_the_bounds_of_its_parameters(candidate: Candidate) -> None:
    params = Params()
    grid = candidate.grid(5)
    assert np.all(np.diff(grid) > 0.0)
    assert grid[1] < candidate.between(grid[1], grid[2]) < grid[2]
    for value in (candidate.low, candidate.high):
        for name, number in candidate.settings(float(value)).items():
            assert PARAMETERS[name].lower <= number <= PARAMETERS[name].upper
            params[name] = number


def test_search_finds_the_best_value_of_a_candidate(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a made-up outcome that is perfect at one K_v."""
    best = float(draw("search").uniform(0.5, 20.0))

    def outcome(settings: Mapping[str, float], complete: bool = True) -> Outcome:
        off = abs(np.log(settings["velocity_gain"] / best))
        return Outcome(dict(settings), 0.5672 * (1.0 + off), 0.0, (0.0,) * (2 + complete), 1.0)

    monkeypatch.setattr(state_feedback, "outcome_of", outcome)
    candidate = next(c for c in STATE_FEEDBACK if c.parameters == ("velocity_gain",))
    found = state_feedback.best_of((candidate, {"loop_gain": 1.0}))
    assert abs(np.log(found.value / best)) < 0.2  # an eighth of the grid's spacing
    assert found.outcome.settings["loop_gain"] == 1.0
    assert len(found.outcome.motion) == 3


def test_departures_are_in_bands() -> None:
    perfect = Outcome({}, 0.5672, 0.0, (0.0, 0.0, 0.0), 1.0)
    assert perfect.met == 6 and perfect.misfit == 0.0
    assert Outcome({}, 0.60, 0.0, (0.0, 0.0, 0.0), 1.0).met == 5
    assert Outcome({}, float("nan"), 0.2, (0.1, 0.1, 0.1), float("nan")).met == 0
    assert np.isfinite(Outcome({}, float("nan"), 0.2, (0.1, 0.1, 0.1), 1.0).misfit)


def test_blocks_of_the_page_are_renewed_and_missing_ones_named() -> None:
    page = "a\n<!-- x -->\nold\n<!-- end x -->\nb\n"
    new = what_is_missing.replaced(page, {"x": r"\1 new"})
    assert new == "a\n<!-- x -->\n\\1 new\n<!-- end x -->\nb\n"
    with pytest.raises(ValueError, match="named y"):
        what_is_missing.replaced(page, {"y": ""})


def test_page_has_the_blocks_that_the_command_renews() -> None:
    page = what_is_missing.PAGE.read_text(encoding="utf-8")
    for name in ("experiments", "state feedback", "actuator"):
        assert page.count(f"<!-- {name} -->") == page.count(f"<!-- end {name} -->") == 1
    assert all(figure.quantity in page for figure in FIGURES.values())


@pytest.mark.full
def test_a_sine_gives_what_the_chirp_gives_where_it_is_read() -> None:
    for settings in ({}, ACTUATOR):
        chirp = gain_and_phase(run("chirp_heave", settings))
        sine = actuator.sine_response(settings)
        assert sine[0] == pytest.approx(chirp[0], abs=0.5)
        assert sine[1] == pytest.approx(chirp[1], abs=5.0)


@pytest.mark.full
def test_the_actuator_found_meets_what_one_mass_flow_gain_cannot() -> None:
    found = actuator.outcome_of(ACTUATOR, "peak to peak")
    assert found.met >= 4
    alone = actuator.best_of((None, {}))
    assert max(one.outcome.met for one in alone) < found.met


@pytest.mark.full
def test_the_feedback_found_does_what_is_published_and_the_printed_one_does_not() -> None:
    assert state_feedback.outcome_of(FEEDBACK).met == 6
    assert state_feedback.outcome_of({**ACTUATOR, **FEEDBACK}).met == 6
    assert state_feedback.outcome_of({}).met <= 2
    assert state_feedback.without_acceleration(FEEDBACK) > 2e-3


@pytest.mark.full
@pytest.mark.parametrize("gains", DESIGNED.values(), ids=list(DESIGNED))
def test_the_same_reading_sends_the_designed_gains_to_the_end(
    gains: tuple[float, float, float],
) -> None:
    """Which they were not fitted to; as printed they do not get there."""
    for plant in ({}, ACTUATOR):
        assert farthest(feedback({**plant, **scaled(gains)})) > 0.09
    named = dict(zip(("position_gain", "velocity_gain", "acceleration_gain"), gains, strict=True))
    assert farthest(feedback(named)) < 0.02


@pytest.mark.full
def test_the_feedback_found_has_the_commands_of_figure_8_6() -> None:
    """Never saturated at a loop gain of 0.5, for most of the way at 15, and then full of reversals."""
    saturated, reversals = [], []
    for gain in (0.5, 15.0):
        record = run("step_state_feedback", {**FEEDBACK, "loop_gain": gain})
        command = record.valve_command[:, 1]
        way = command[(record.time > 3.0) & (record.time < 3.8)]
        rest = command[(record.time > 4.5) & (record.time < 6.0)]
        saturated.append(float(np.mean((way > 9.99) | (way < 0.01))))
        reversals.append(int(np.count_nonzero(np.diff(np.sign(rest - 5.0)))))
    assert saturated[0] == 0.0 and saturated[1] > 0.5
    assert reversals[1] > 10 * max(reversals[0], 1)
