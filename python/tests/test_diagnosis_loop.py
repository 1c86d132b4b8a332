"""A bench and a platform whose controller is simulated: what its rig file says, what the diagnosis makes of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from plant_support import write_bench, write_platform
from rich.console import Console
from sms import _core
from sms.diagnosis import Diagnosis, diagnose
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.preparation import make_data
from sms.diagnosis.wording import of_command
from sms.estimation.run import Run
from sms.io import InputError, load_rig
from sms.io.records import load_record
from sms.io.signals import of_legs
from sms.report.console import print_diagnosis
from sms.report.diagnosis import report_html
from sms.rigs.bench import MENU
from sms.rigs.kinds import kind_of
from sms.rigs.platform import MENU as PLATFORM_MENU
from sms.rigs.platform import PLATFORM
from sms.rigs.platform_loop import COMMANDS, PLATFORM_LOOP, PLATFORM_LOOP_BLIND

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


def printed(answer: Diagnosis) -> str:
    console = Console(width=400)
    with console.capture() as text:
        print_diagnosis(answer, console)
    return text.get()


def changed(path: Path, *replacements: tuple[str, str]) -> Path:
    text = path.read_text()
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


# ---- rig files -----------------------------------------------------------------------------------


def test_what_a_simulated_controller_needs_is_asked_for(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 1, {}, in_loop=True)
    changed(path, ('setpoint = "setpoint"\n', ""))
    with pytest.raises(InputError, match="'setpoint' is needed but not listed"):
        diagnose(path)
    changed(path, ('loop = "closed"', 'loop = "open"'))
    with pytest.raises(InputError, match="in an open loop there is no controller to be simulated"):
        diagnose(path)


def test_a_tank_takes_its_command_from_the_record(tmp_path: Path) -> None:
    rig = load_rig(write_bench(tmp_path, 1, {}, in_loop=True))
    with pytest.raises(
        InputError, match=r"on a bench or a platform, not on a tank.*record the command"
    ):
        kind_of(replace(rig, kind="tank"))


def test_of_three_commands_all_are_recorded_or_none(tmp_path: Path) -> None:
    path = write_platform(tmp_path, 1, {}, 1.0, in_loop=True)
    assert kind_of(load_rig(path)) is PLATFORM_LOOP
    changed(path, ("valve_command_2 = {}\n", ""))
    with pytest.raises(InputError, match="only valve_command_1, valve_command_3; list all of them"):
        kind_of(load_rig(path))
    changed(path, ("valve_command_1 = {}\n", ""), ("valve_command_3 = {}\n", ""))
    assert kind_of(load_rig(path)) is PLATFORM_LOOP_BLIND


def test_of_the_attitude_both_angles_are_recorded_or_none(tmp_path: Path) -> None:
    path = write_platform(tmp_path, 1, {}, 1.0)
    assert kind_of(load_rig(path)) is PLATFORM
    changed(path, ("[signals]\n", '[signals]\nroll = { noise = "0.01 deg" }\n'))
    with pytest.raises(InputError, match="of the attitude there is only roll; list all of them"):
        kind_of(load_rig(path))


@pytest.mark.parametrize("kind", ["bench", "platform"])
def test_the_effects_of_the_controller_are_those_of_its_law(tmp_path: Path, kind: str) -> None:
    path = (
        write_bench(tmp_path, 1, {}, in_loop=True)
        if kind == "bench"
        else write_platform(tmp_path, 1, {}, 1.0, in_loop=True)
    )

    def mismatches() -> set[str | None]:
        return {e.signal for e in effects_of(load_rig(path)) if e.id == "controller_mismatch"}

    pid = {"proportional_gain", "integral_gain", "derivative_gain", "dead_band_step"}
    assert mismatches() == pid
    changed(path, ('controller = "simulated"', 'controller = "simulated"\nlaw = "state_feedback"'))
    assert mismatches() == {"position_gain", "velocity_gain", "acceleration_gain", "dead_band_step"}
    changed(path, ('controller = "simulated"', 'controller = "recorded"'))
    assert mismatches() == {None}


def test_the_menu_runs_in_the_loop_of_the_rigs_own_controller(tmp_path: Path) -> None:
    rig = load_rig(write_bench(tmp_path, 1, {}, in_loop=True))
    run = MENU[1].simulated(rig, rig.start(), ("supply_pressure",))
    assert run is not None
    s = run.signals
    assert run.step == pytest.approx(0.005)
    assert set(s) >= {"setpoint", "valve_command", "supply_pressure"}
    assert np.ptp(s["extension"]) > 0.05
    eager = rig.start()
    eager["proportional_gain"] = 16.0
    closer = MENU[1].simulated(rig, eager, ())
    assert closer is not None

    def far(run: Run) -> float:
        return float(np.abs(run.signals["setpoint"] - run.signals["extension"]).max())

    assert far(closer) < 0.8 * far(run)


def test_a_platforms_menu_runs_in_the_loop_of_its_own_controllers(tmp_path: Path) -> None:
    rig = load_rig(write_platform(tmp_path, 1, {}, 1.0, in_loop=True))
    run = PLATFORM_MENU[1].simulated(rig, rig.start(), ("roll",))
    assert run is not None
    assert set(run.signals) >= {*of_legs("setpoint", "valve_command"), "roll"}
    assert run.step == pytest.approx(0.005)
    # A slow triangle is followed, and never exactly.
    off = run.signals["setpoint_2"] - run.signals["extension_2"]
    assert 1e-4 < np.std(off) < 0.3 * np.std(run.signals["setpoint_2"])


@pytest.mark.parametrize("command", [True, False])
def test_a_platforms_records_ask_for_the_gain_they_were_made_with(
    tmp_path: Path, command: bool
) -> None:
    gain, free = 9.6, ["proportional_gain"]
    rig = load_rig(
        write_platform(tmp_path, 4, dict.fromkeys(free, gain), 1.2, in_loop=True, command=command)
    )
    runs = make_data(rig, [load_record(rig, source) for source in rig.records]).identify
    assert [c for c in runs.channels if c.startswith("valve")] == list(COMMANDS if command else ())
    machine = rig.start()
    assert machine["proportional_gain"] == 8.0
    at_first, _ = runs.problem.evaluate(machine)
    for _ in range(3):
        residual, slope = runs.problem.evaluate(machine, free)
        step = -float(slope[:, 0] @ residual / (slope[:, 0] @ slope[:, 0]))
        machine["proportional_gain"] = machine["proportional_gain"] + step
    error = 1.0 / np.linalg.norm(slope)
    assert machine["proportional_gain"] == pytest.approx(gain, abs=5.0 * error + 0.01 * gain)
    assert np.mean(residual**2) < 2.0
    assert np.mean(at_first**2) > 20.0


@pytest.mark.parametrize("kind", ["bench", "platform"])
@pytest.mark.parametrize("law", ["pid", "state_feedback"])
def test_no_gain_of_the_controller_makes_a_window_count_as_diverged(
    tmp_path: Path, kind: str, law: str
) -> None:
    path = (
        write_bench(tmp_path, 3, {}, in_loop=True)
        if kind == "bench"
        else write_platform(tmp_path, 3, {}, 2.2, in_loop=True)
    )
    changed(path, ('controller = "simulated"', f'controller = "simulated"\nlaw = "{law}"'))
    rig = load_rig(path)
    runs = make_data(rig, [load_record(rig, source) for source in rig.records]).identify
    gains = [e.parameters[0] for e in effects_of(rig) if e.id == "controller_mismatch"]
    _, slope = runs.problem.evaluate(rig.start(), [*gains, "viscous_friction"])
    for w in runs.problem.windows:
        assert np.all(np.any(slope[w.row : w.row + w.rows] != 0.0, axis=0))


# ---- the whole method ----------------------------------------------------------------------------


def test_a_loop_without_a_recorded_command_is_healthy(tmp_path: Path) -> None:
    answer = diagnose(write_bench(tmp_path, 2, {}, in_loop=True, command=False))
    assert (answer.verdict, answer.causes, answer.fed) == ("no-evidence", (), None)
    assert "simulated: it computes the valve's command" in answer.command
    assert "compared with" not in answer.command


def names_the_gain(answer: Diagnosis, gain: float) -> str:
    """The one cause is the proportional gain, of its true size; returns the equation that is off."""
    assert answer.verdict == "cause"
    (cause,) = answer.causes
    assert (cause.effect, cause.signal) == ("controller_mismatch", "proportional_gain")
    found = cause.parameters[0]
    assert found.old_value == 8.0
    assert found.value == pytest.approx(gain, abs=max(4.0 * found.standard_error, 0.01 * gain))
    assert answer.hidden is not None
    return answer.hidden.equation


@pytest.mark.full
def test_a_gain_that_is_not_as_said_is_named_with_its_value(tmp_path: Path) -> None:
    gain = 9.6
    answer = diagnose(write_bench(tmp_path, 3, {"proportional_gain": gain}, in_loop=True))
    equation = names_the_gain(answer, gain)
    assert equation == "command"
    for page in (printed(answer), report_html(answer)):
        assert "Closed loop, its controller (PID) simulated" in page
        assert "the recorded command is compared with" in page


@pytest.mark.full
def test_a_gain_of_a_platform_that_is_not_as_said_is_named_with_its_value(tmp_path: Path) -> None:
    gain = 9.6
    answer = diagnose(write_platform(tmp_path, 3, {"proportional_gain": gain}, 2.2, in_loop=True))
    equation = names_the_gain(answer, gain)
    assert equation.startswith("command")
    assert "the controller of each leg (PID) simulated" in printed(answer)


def test_the_way_taken_is_said_for_a_recorded_command_too(tmp_path: Path) -> None:
    path = changed(
        write_bench(tmp_path, 1, {}, in_loop=True),
        ('controller = "simulated"', 'controller = "recorded"'),
    )
    said = of_command(load_rig(path))
    assert "its controller not simulated: the valve's command is taken from the records" in said
    assert of_command(load_rig(write_bench(tmp_path, 1, {}))).startswith("Open loop")
