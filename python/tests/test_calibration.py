"""Calibration of the mechanism from poses: derivatives, a drawn machine, what cannot be told, bad input."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
import sms
from sms.calibration.fit import calibrate_poses, problem_of, unknowns
from sms.calibration.proposal import END_MARGIN, propose
from sms.calibration.result import geometry_file
from sms.calibration.rig import PosesRig, load_poses
from sms.cli import app
from sms.cli.simulate import settings_in_si
from sms.errors import InputError
from sms.io.schema import ParameterTable
from sms.parameter_files import c_header, load_params
from sms.parameters import LEG_PARAMETERS
from typer.testing import CliRunner

from validation.trials.calibrate import Machine, draw

SEED = 20261


@pytest.fixture(scope="module")
def machine() -> Machine:
    print(f"seed {SEED}")
    return draw(np.random.default_rng(SEED), 30, tracker=False)


def _write(folder: Path, rig: PosesRig, change: str = "") -> Path:
    header = "extension_1 [mm],extension_2 [mm],extension_3 [mm],roll [deg],pitch [deg]"
    table = np.hstack([1e3 * rig.fitted.extension, np.degrees(rig.fitted.pose[:, :2])])
    rows = [",".join(f"{v:.9f}" for v in row) for row in table]
    (folder / "poses.csv").write_text("\n".join([header, *rows]) + "\n")
    file = folder / "rig.toml"
    file.write_text(
        '[rig]\nname = "drawn"\nkind = "poses"\nposes = "poses.csv"\n'
        f'[noise]\nextension = "0.1 mm"\nroll = "0.02 deg"\npitch = "0.02 deg"\n{change}'
    )
    return file


def test_derivatives_are_those_of_the_residual(machine: Machine) -> None:
    rig, start = machine.rig, machine.truth
    problem = problem_of(rig.fitted, rig, start)
    names = [u.name for u in unknowns(rig)]
    _, jacobian = problem.evaluate(start, names)
    for k, name in enumerate(names):
        step, low, high = 1e-5, start.copy(), start.copy()
        low[name] -= step
        high[name] += step
        slope = (problem.evaluate(high)[0] - problem.evaluate(low)[0]) / (2 * step)
        assert jacobian[:, k] == pytest.approx(
            slope, rel=1e-4, abs=1e-4 * (1 + np.abs(jacobian).max() * 1e-3)
        ), name


def test_attitude_of_a_drawn_machine(machine: Machine) -> None:
    found = calibrate_poses(machine.rig)
    before, after = found.validation.attitude
    assert found.converged
    assert after < 0.2 * before
    told = {k.words: k.told for k in found.combinations}
    assert not told["the scale: all joints, lengths and extensions by one factor"]
    assert not told["the ground's frame: all base joints turned about z"]
    assert found.covariance.shape == (len(found.found),) * 2


def test_a_wrong_reading_is_reported(machine: Machine) -> None:
    rig = machine.rig
    rig.fitted.pose[7, 0] += np.radians(1.0)
    try:
        found = calibrate_poses(rig)
    finally:
        rig.fitted.pose[7, 0] -= np.radians(1.0)
    assert [o.row for o in found.outliers] == [8]
    before, after = found.validation.attitude
    assert after < 0.2 * before


def test_proposed_poses_are_safe_and_tell_more(machine: Machine) -> None:
    found = calibrate_poses(machine.rig)
    proposals = propose(found, 3)
    for p in proposals:
        assert np.all(p.extension >= END_MARGIN)
        assert np.all(p.extension <= found.params.stroke - END_MARGIN)
        assert p.gain < 1.0


def test_geometry_file_is_what_load_params_reads(machine: Machine, tmp_path: Path) -> None:
    found = calibrate_poses(machine.rig)
    file = tmp_path / "geometry.toml"
    file.write_text(geometry_file(found, ["a sentence"]))
    params = load_params(file)
    for f in found.found:
        assert params[f.unknown.name] == pytest.approx(f.value, abs=1e-8)
    table = tomllib.loads(file.read_text())["parameters"]
    for name, entry in table.items():  # as [parameters] of a rig file has them
        assert name in LEG_PARAMETERS
        ParameterTable.model_validate(entry)
    pose = sms.forward_kinematics([0.1, 0.2, 0.15], params=params)
    assert pose.roll != sms.forward_kinematics([0.1, 0.2, 0.15]).roll
    assert f"p->base_joint_1_x = {params['base_joint_1_x']!r};" in c_header(params, "geometry.toml")


def test_command(machine: Machine, tmp_path: Path) -> None:
    rig = _write(tmp_path, machine.rig)
    result = CliRunner().invoke(
        app, ["calibrate", "geometry", str(rig), "--out", str(tmp_path / "out")]
    )
    assert result.exit_code == 0, result.output
    assert "validation poses" in result.output
    written = sorted(p.name for p in (tmp_path / "out").iterdir())
    assert written == ["calibration.json", "geometry.toml", "report.html"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ('[tolerances]\njoints = "5 mm"\n', "did you mean 'joint'"),
        ("[tolerances]\njoint = 5\n", "has no unit"),
        ('[tolerances]\njoint = "-5 mm"\n', "not above zero"),
    ],
)
def test_bad_input(machine: Machine, tmp_path: Path, change: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        load_poses(_write(tmp_path, machine.rig, change))


def test_unknown_column(machine: Machine, tmp_path: Path) -> None:
    rig = _write(tmp_path, machine.rig)
    poses = tmp_path / "poses.csv"
    poses.write_text(poses.read_text().replace("roll [deg]", "rol [deg]"))
    with pytest.raises(InputError, match="did you mean 'roll'"):
        load_poses(rig)


def test_a_simulation_takes_the_file_and_says_what_it_leaves_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "geometry.toml"
    file.write_text(
        '[parameters]\nbase_joint_1_x = "1370 mm"\npayload_mass = "250 kg"\n'
        '"sensor_gain_extension:2" = 0.004\n',
        encoding="utf-8",
    )
    found = settings_in_si(["payload_mass=280", str(file)])
    assert found == {"base_joint_1_x": 1.37, "payload_mass": 280.0}
    assert "sensor_gain_extension:2" in capsys.readouterr().err
    with pytest.raises(InputError, match=r"none\.toml: cannot be read"):
        settings_in_si([str(tmp_path / "none.toml")])


def test_tables_take_the_parameters_as_words(tmp_path: Path) -> None:
    file = tmp_path / "geometry.toml"
    file.write_text(
        '[parameters]\nbase_joint_1_x = "1.3701 m"\n"sensor_gain_extension:2" = 0.004\n',
        encoding="utf-8",
    )
    said = CliRunner().invoke(app, ["export", "table-params", str(file)])
    assert (said.exit_code, said.stdout.split()) == (0, ["base_joint_1_x=1.3701"])
