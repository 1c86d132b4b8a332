"""`sms simulate`: what it writes, what it finds, what it refuses."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import sms
from sms.data import SCENARIOS, WAVES
from sms.io import InputError
from sms.report.scene import scene_of
from sms.report.simulation import simulation_html
from sms.scenario import command_of, findings_of, load_scenario, run_scenario
from sms.scenario.plant import INTERRUPTED, MISSED, why_it_stopped
from sms.scenario.schema import (
    EXCITATIONS,
    ControllerTable,
    DeckMotionTable,
    ModelTable,
    OutputTable,
    ScenarioTable,
    SeaTable,
    StartTable,
)
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command
from test_cli_mechanism import run

DOCS = Path(__file__).parents[2] / "docs/simulation.md"

DAMPED = """
[controller]
kind = "state_feedback"

[parameters]
position_gain = "30 V/m"
velocity_gain = "0 V s/m"
acceleration_gain = "0.3 V s^2/m"
"""
ROLL = """
[scenario]
title = "a roll"
duration = "4 s"

[excitation]
kind = "sine"
axis = "roll"
amplitude = "3 deg"
frequency = "0.25 Hz"
"""


def scenario(folder: Path, text: str = ROLL + DAMPED) -> Path:
    path = folder / "scenario.toml"
    path.write_text(text, encoding="utf-8")
    return path


# ---- a run ----


def test_a_run_leaves_a_record_findings_and_a_page(tmp_path: Path) -> None:
    scenario(tmp_path)
    printed = run("simulate", "scenario.toml", "--out", "out", "--json", cwd=tmp_path).stdout
    summary = json.loads(printed)
    assert summary == json.loads((tmp_path / "out/run.json").read_text(encoding="utf-8"))
    assert summary["complete"] and summary["parameters"]["position_gain"] == 30.0
    record = pd.read_csv(tmp_path / "out/run.csv")
    for name in ("time [s]", "extension_1 [m]", "setpoint_3 [m]", "chamber_pressure_lower_2 [Pa]"):
        assert name in record
    assert record["time [s]"].diff().dropna().to_numpy() == pytest.approx(0.01)
    error = np.abs(record["roll [rad]"] - record["roll_command [rad]"])[100:].max()
    assert summary["following"]["roll"]["largest_error"] == pytest.approx(error, rel=0.05)
    # The pose is the core's for these extensions.
    extension = record[[f"extension_{i} [m]" for i in (1, 2, 3)]].to_numpy()
    assert sms.forward_kinematics(extension).roll == pytest.approx(
        record["roll [rad]"].to_numpy(), abs=1e-9
    )
    page = (tmp_path / "out/report.html").read_text(encoding="utf-8")
    assert '"scene"' in page and "Plotly.addFrames" in page and "a roll" in page


def test_the_same_scenario_gives_the_same_bits_and_parquet_the_same_numbers(tmp_path: Path) -> None:
    path = scenario(tmp_path)
    one, two = (run_scenario(s, command_of(s)) for s in [load_scenario(path)] * 2)
    assert np.array_equal(one.extension, two.extension)
    scenario(tmp_path, ROLL + DAMPED + '\n[output]\nformat = "parquet"\nevery = "0.1 s"\n')
    run("simulate", "scenario.toml", "--out", "out", cwd=tmp_path)
    record = pd.read_parquet(tmp_path / "out/run.parquet")
    assert np.array_equal(record["extension_2 [m]"], one.extension[::100, 1])


def test_a_run_is_what_the_plant_gives(tmp_path: Path) -> None:
    asked = load_scenario(scenario(tmp_path))
    sent = command_of(asked)
    record = run_scenario(asked, sent)
    direct = sms.simulate_platform(
        sent.values, controller="state_feedback", params=asked.params, tolerance=1e-7
    )
    assert np.array_equal(record.extension, direct.legs("extension"))
    assert sent.pose is not None and sent.pose[:, 0].max() == pytest.approx(np.radians(3.0), 1e-3)


def test_volts_on_the_bench(tmp_path: Path) -> None:
    text = """
[scenario]
plant = "bench"
duration = "2 s"
[controller]
kind = "open_loop"
[excitation]
kind = "sine"
amplitude = "1 V"
frequency = "1 Hz"
"""
    asked = load_scenario(scenario(tmp_path, text))
    sent = command_of(asked)
    assert sent.unit == "V" and sent.values[250, 0] == pytest.approx(6.0)
    record = run_scenario(asked, sent)
    assert record.pose is None and record.extension.shape == (2001, 1)
    assert np.ptp(record.extension) > 0.01
    assert "setpoint_1 [V]" in record.columns()
    assert (
        "scene"
        not in simulation_html(asked, sent, record, findings_of(asked, sent, record))
        .partition("plot-data")[2]
        .partition("</script>")[0]
    )


FLOW_TEST = """
[scenario]
title = "a flow test"
plant = "tank"
duration = "6 s"

[excitation]
kind = "steps"
axis = "actuators"
amplitude = "2 V"
levels = [0, 1, -1]
hold = "2 s"

[parameters]
tank_volume = "2 l"
"""


def test_a_flow_test_charges_and_empties_the_tank(tmp_path: Path) -> None:
    path = scenario(tmp_path, FLOW_TEST)
    said = command("simulate", path.name, "--out", "out", cwd=tmp_path)
    assert said.returncode == 0, said.stderr
    table = pd.read_csv(tmp_path / "out" / "run.csv")
    summary = json.loads((tmp_path / "out" / "run.json").read_text())
    pressure, flow = table["tank_pressure [Pa]"], table["mass_flow [kg/s]"]
    assert pressure[0] == pytest.approx(86e3)
    assert pressure[:190].max() == pytest.approx(86e3)  # closed
    assert pressure.max() == pytest.approx(486e3, rel=1e-3)
    assert flow[210] > 0.0 > flow[410]
    # what has entered since is what is there, by the one ratio of heat that each way has
    entered = np.trapezoid(flow[:400], table["time [s]"][:400])
    assert entered * 1.4 * 288.0 * 293.0 / 2e-3 == pytest.approx(pressure[399] - 86e3, rel=1e-2)
    assert "has 0.860 bar to 4.86 bar, and ends at 0.860 bar" in said.stdout
    assert "out of the tank" in said.stdout
    assert summary["arrived_s"] is not None
    assert "Pressure in the tank" in (tmp_path / "out" / "report.html").read_text()


def test_a_step_that_cannot_meet_its_tolerance_is_said_with_the_tolerance(tmp_path: Path) -> None:
    asked = load_scenario(scenario(tmp_path))
    run = sms.simulate_bench(np.full(3, 5.0))
    stopped = sms.SimulationStoppedError("the run stops at 1 s", run, converged=False)
    assert why_it_stopped(asked, stopped) == f"{MISSED} of 1e-07 (the run stops at 1 s)"


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ('[controller]\nkind = "pid"', "has no controller"),
        ('[model]\nchamber_law = "cold"', "chamber_law"),
    ],
)
def test_a_flow_test_refuses_what_a_tank_has_not(tmp_path: Path, changed: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        load_scenario(scenario(tmp_path, f"{FLOW_TEST}\n{changed}\n"))


def test_a_loop_that_oscillates_on_its_own_is_called_so(tmp_path: Path) -> None:
    gains = '[controller]\nkind = "pid"\n[parameters]\nproportional_gain = "60 V/m"\n'
    asked = load_scenario(scenario(tmp_path, ROLL + gains))
    sent = command_of(asked)
    found = findings_of(asked, sent, run_scenario(asked, sent))
    assert found.limit == "stability"
    assert any("oscillates on its own" in sentence for sentence in found.sentences)


def test_a_rig_file_s_parameters_are_taken_over(tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(
        '[rig]\nkind = "cylinder"\n[parameters]\ncoulomb_force = { value = "50 N", fit = true }\n'
        'stroke = "390 mm"\n[[records]]\nfile = "gone.csv"\nrole = "identify"\n'
    )
    text = ROLL + DAMPED + '[rig]\nfile = "rig.toml"\n'
    asked = load_scenario(scenario(tmp_path, text), {"stroke": 0.38})
    assert asked.params.coulomb_force == 50.0 and asked.params.stroke == 0.38


def test_what_one_leg_has_is_simulated_in_that_leg(tmp_path: Path) -> None:
    """As the extended.toml of a platform says it: a leak of leg 2."""
    (tmp_path / "extended.toml").write_text(
        '[rig]\nkind = "platform"\n[parameters]\n"chamber_leakage_lower:2" = "1e-8 kg/(s Pa)"\n'
        '[[records]]\nfile = "gone.csv"\nrole = "identify"\n'
    )
    asked = load_scenario(scenario(tmp_path, ROLL + DAMPED + '[rig]\nfile = "extended.toml"\n'))
    sound = load_scenario(scenario(tmp_path, ROLL + DAMPED))
    leaking, well = (run_scenario(s, command_of(s)).chamber_pressure_lower for s in (asked, sound))
    fallen = np.sqrt(np.mean((leaking - well) ** 2, axis=0))
    assert fallen[1] > 10.0 * max(fallen[0], fallen[2])


def test_the_picture_is_the_mechanism(tmp_path: Path) -> None:
    asked = load_scenario(scenario(tmp_path))
    record = run_scenario(asked, command_of(asked))
    scene = scene_of(record, asked.params)
    assert scene is not None and len(scene["frames"]) == 41
    frame, row = scene["frames"][10], 1000
    assert frame["time"] == pytest.approx(record.time[row])
    assert record.pose is not None
    roll, pitch, height, yaw, x, y = record.pose[row]
    lengths = sms.six_leg_inverse(roll, pitch, height, yaw, x, y)
    links = np.array(frame["joints"]) - np.array(scene["base"])
    assert np.linalg.norm(links, axis=1) == pytest.approx(lengths, abs=2e-4)  # it is rounded
    assert frame["pressure"][2] == pytest.approx(1e-5 * record.chamber_pressure_lower[row, 2], 1e-3)


# ---- deck motions ----


def test_real_waves_are_followed_within_half_a_degree() -> None:
    asked = load_scenario(SCENARIOS["waves_3012"])
    assert asked.deck_motion is not None
    part = asked.deck_motion.model_copy(update={"first": "230 s", "last": "250 s"})
    asked = replace(asked, deck_motion=part)
    sent = command_of(asked)
    assert sent.motion is not None and not sent.motion.cuts
    found = findings_of(asked, sent, run_scenario(asked, sent))
    (roll, _) = found.following
    assert abs(roll.metrics.largest_error) < np.radians(0.5) and found.limit == ""


def test_waves_that_ask_for_too_much(tmp_path: Path) -> None:
    text = SCENARIOS["waves_3061"].read_text(encoding="utf-8")
    text = text.replace('file = "', f'file = "{WAVES}/')
    scenario(tmp_path, text.replace('beyond = "clip"', 'beyond = "refuse"'))
    result = command("simulate", "scenario.toml", "--out", "out", cwd=tmp_path)
    refused(result, "[deck_motion] roll: roll -9.5°", "32 to 368 mm is allowed", 'beyond = "clip"')
    assert not (tmp_path / "out").exists()
    cut = command_of(load_scenario(SCENARIOS["waves_3061"])).motion
    assert cut is not None and cut.cuts[0].limit == "stroke"
    assert "became roll -8.1°" in cut.cuts[0].sentence


def test_a_synthetic_sea_needs_no_record(tmp_path: Path) -> None:
    text = '[scenario]\nduration = "20 s"\n[sea]\nstate = 2.5\nseed = 3\n' + DAMPED
    sent = command_of(load_scenario(scenario(tmp_path, text)))
    assert sent.pose is not None and sent.motion is not None
    assert 0.0 < np.abs(sent.pose[:, 0]).max() < np.radians(8.0)
    assert "JONSWAP" in sent.words[0]


# ---- bad input ----

BAD: Mapping[str, tuple[str, str, tuple[str, ...]]] = {
    "unknown key": ("kind =", "kinds = 1\nkind =", ("[excitation]: the key 'kinds'", "amplitude")),
    "unknown table": ("[scenario]", "[scenrio]", ("[scenrio] is not known", "did you mean 'scenario'")),
    "unknown kind": ('"sine"', '"sinus"', ("'sinus' is not known", "did you mean 'sine'", "aprbs")),
    "unknown word": ('"state_feedback"', '"lqr"', ("[controller] kind: 'lqr'", "open_loop")),
    "missing": ('frequency = "0.25 Hz"', "", ("[excitation]: the key 'frequency' is missing",)),
    "no unit": ('"3 deg"', '"3"', ("[excitation] amplitude", "no unit")),
    "wrong unit": ('"3 deg"', '"3 V"', ("[excitation] amplitude", "'V' does not fit")),
    "outside the workspace": ('"3 deg"', '"12 deg"', ("[excitation] amplitude", "stroke, 0 to 400 mm")),
    "outside any pose": ('"3 deg"', '"34 deg"', ("[excitation] amplitude",)),
    "supply of 0 Pa": (
        '"30 V/m"', '"30 V/m"\nsupply_pressure = "0 Pa"',
        ("supply_pressure: 0 Pa", "50000 to 1.2e+06 Pa"),
    ),
    "stroke reversed": ('"30 V/m"', '"30 V/m"\nstroke = "-0.4 m"', ("stroke: -0.4 m", "0.001 to 5 m")),
    "unknown parameter": ("position_gain", "positon_gain", ("no such parameter", "'position_gain'")),
    "tolerance": (
        "[controller]", "[model]\ntolerance = 0.0\n[controller]",
        ("[model] tolerance: 0 ", "1e-12 to 0.01"),
    ),
    "height": ("[controller]", '[start]\nheight = "0.1 m"\n[controller]', ("[start] height: 0.1 m", "allowed range")),
    "of another plant": (
        "[controller]", '[start]\nload_force = "5 N"\n[controller]',
        ("[start] load_force: of a bench, and the plant is a platform",),
    ),
    "duration": ('"4 s"', '"-4 s"', ("[scenario] duration: -4 s", "above 0 to 86400 s")),
    "no motion": ("[excitation]", "[rig]\nfile = 'x'\n#", ()),
    "two motions": ("[controller]", "[sea]\nstate = 2.0\n[controller]", ("[excitation] and [sea] exclude",)),
    "text for a number": (
        "[controller]", '[model]\ntolerance = "tiny"\n[controller]',
        ("[model] tolerance: 'tiny' is given",),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_bad_input_names_key_value_and_what_is_allowed(tmp_path: Path, case: str) -> None:
    old, new, said = BAD[case]
    text = ROLL + DAMPED
    assert old in text
    path = scenario(tmp_path, text.replace(old, new, 1))
    with pytest.raises(InputError, match="scenario") as problem:
        command_of(load_scenario(path))
    for words in said:
        assert words in str(problem.value)


def test_at_the_prompt_bad_input_is_one_sentence_and_nothing_is_written(tmp_path: Path) -> None:
    scenario(tmp_path, ROLL.replace('"3 deg"', '"12 deg"') + DAMPED)
    result = command("simulate", "scenario.toml", "--out", "out", cwd=tmp_path)
    refused(result, "scenario.toml, [excitation] amplitude", "0 to 400 mm")
    refused(command("simulate", "gone.toml", cwd=tmp_path), "there is no such scenario file")
    refused(command("simulate", "waves_3013", cwd=tmp_path), "none is shipped under that name")
    scenario(tmp_path)
    result = command("simulate", "scenario.toml", "--scale", "40", cwd=tmp_path)
    refused(result, "no [deck_motion] to scale")
    assert [path.name for path in tmp_path.iterdir()] == ["scenario.toml"]


# ---- runs that end early ----


def test_a_run_that_cannot_go_on_is_kept_as_a_partial_one(tmp_path: Path) -> None:
    text = """
[scenario]
duration = "1 s"
[controller]
kind = "open_loop"
[excitation]
kind = "steps"
axis = "actuators"
amplitude = "4 V"
levels = [1.0]
hold = "1 s"
[parameters]
dead_volume_lower = "0 m^3"    # no room is left at the end of the stroke
dead_volume_upper = "0 m^3"
"""
    scenario(tmp_path, text)
    (tmp_path / "out").mkdir()
    (tmp_path / "out/run.csv").write_text("of an earlier run")
    result = command("simulate", "scenario.toml", "--out", "out", cwd=tmp_path)
    assert result.returncode == 2
    assert "[parameters]: the run stops at " in result.stderr
    assert "a chamber has no volume left; dead_volume_lower" in result.stderr
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["report.html", "run.partial.csv", "run.partial.json"]
    assert "Partial run" in (tmp_path / "out/report.html").read_text(encoding="utf-8")


def test_ctrl_c_keeps_what_was_computed(tmp_path: Path) -> None:
    asked = load_scenario(scenario(tmp_path))

    def press(share: float) -> None:
        if share > 0.5:
            raise KeyboardInterrupt

    record = run_scenario(asked, command_of(asked), press)
    whole = run_scenario(asked, command_of(asked))
    assert record.ended == INTERRUPTED and 1.9 < record.time[-1] < 2.6
    assert np.array_equal(record.extension, whole.extension[: record.time.size])


def hear_ctrl_c() -> None:
    """A background job ignores Ctrl-C, and so would its children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def interrupted_after(seconds: float, folder: Path) -> tuple[int, str]:
    """What `sms simulate` of the scenario in the folder ends with, and says, when Ctrl-C comes then."""
    program = [sys.executable, "-m", "sms.cli", "simulate", "scenario.toml", "--out", "out"]
    with subprocess.Popen(
        program,
        cwd=folder,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=hear_ctrl_c,  # noqa: PLW1509
    ) as running:
        time.sleep(seconds)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=300.0)
    return running.returncode, said


def test_ctrl_c_at_the_prompt(tmp_path: Path) -> None:
    """However far the command was: nothing is left or a whole set of partial files."""
    scenario(tmp_path, ROLL.replace('"4 s"', '"2000 s"') + DAMPED)
    for seconds in (3.0, 9.0, 27.0):
        code, said = interrupted_after(seconds, tmp_path)
        left = sorted(path.name for path in tmp_path.rglob("*") if path.is_file())
        # Before the command has begun, it is the interpreter that the signal ends: to a shell, 130 as well.
        assert code in (130, -signal.SIGINT), said
        if left != ["scenario.toml"]:
            break
    assert left == ["report.html", "run.partial.csv", "run.partial.json", "scenario.toml"]
    assert code == 130 and "run.partial.csv holds what was computed" in said


# ---- the documentation ----


def test_the_documented_examples_run_and_every_key_is_documented(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = DOCS.read_text(encoding="utf-8")
    example = text.partition("<!-- a test runs this example -->\n```toml\n")[2].partition("```")[0]
    scenario(tmp_path, example.replace('"20 s"', '"11 s"'))
    run("simulate", "scenario.toml", "--out", "run", cwd=tmp_path)
    assert (tmp_path / "run/run.csv").is_file()
    monkeypatch.chdir(tmp_path)
    exec(text.partition("```python\n")[2].partition("```")[0], {})
    assert "Roll follows its command" in capsys.readouterr().out
    tables = (ScenarioTable, ModelTable, ControllerTable, StartTable, OutputTable, SeaTable)
    for table in (*tables, DeckMotionTable, *EXCITATIONS.values()):
        for key in table.model_fields:
            if not key.endswith("_unit") and key not in ("delimiter", "beyond"):
                assert f"`{key}`" in text or f"`{key} =" in text, key
