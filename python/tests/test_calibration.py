"""Calibration of the mechanism from poses: derivatives, a drawn machine, what cannot be told, bad input."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sms
from plant_support import write_bench, write_platform
from sms._core import LegParams, PoseProblem
from sms.arrays import Array
from sms.calibration.fit import calibrate_poses, problem_of, unknowns
from sms.calibration.proposal import END_MARGIN, propose
from sms.calibration.result import geometry_file
from sms.calibration.rig import Distance, Poses, PosesRig, load_poses
from sms.cli import app
from sms.cli.simulate import settings_in_si
from sms.errors import InputError
from sms.io import Declaration, load_rig, write_extended_rig
from sms.io.schema import ParameterTable
from sms.kinematics import height_range
from sms.parameter_files import c_header, load_params
from sms.parameters import LEG_PARAMETERS
from sms.report.calibration import calibration_html
from sms.scenario.load import load_scenario
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
        assert jacobian[:, k] == pytest.approx(
            _slope(problem, start, name, 1e-5),
            rel=1e-4,
            abs=1e-4 * (1 + np.abs(jacobian).max() * 1e-3),
        ), name


def _slope(problem: PoseProblem, start: LegParams, name: str, step: float) -> Array:
    """Central difference of the residual."""
    low, high = start.copy(), start.copy()
    low[name] -= step
    high[name] += step
    return (problem.evaluate(high)[0] - problem.evaluate(low)[0]) / (2 * step)


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


def test_the_page_has_every_pose_in_space(machine: Machine) -> None:
    found = calibrate_poses(machine.rig)
    data = re.search(r'id="plot-data"[^>]*>(.*?)</script>', calibration_html(found, []), re.S)
    assert data is not None
    space, plane = json.loads(data[1])["plane"]
    assert space["titles"] == ["roll [deg]", "pitch [deg]", "height [m]"]
    poses, *arrows = space["traces"]
    low, high = height_range(found.params)
    assert len(poses["z"]) == len(machine.rig.fitted.pose)
    assert all(low - 0.05 < z < high + 0.05 for z in poses["z"])
    assert [t["name"] for t in arrows] == ["before", "before", "after", "after"]
    assert len(arrows[0]["x"]) == len(arrows[0]["z"]) == 3 * len(poses["z"])
    assert plane["panels"]


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


MARKS = [
    Distance("laser", np.array([2.0, 0.5, 0.0]), np.array([0.4, 0.3, -1.3]), 2e-4),
    Distance("wire", np.array([-1.0, 2.0, -0.2]), np.array([-0.3, 0.2, -1.3]), 2e-4),
]


def _with_distances(machine: Machine, rng: np.random.Generator) -> PosesRig:
    """The machine's own poses, with tapes to two marks beside its inclinometer."""
    rig = replace(machine.rig, distances=tuple(MARKS))
    rig = replace(rig, pose_noise=np.append(rig.pose_noise, [d.noise for d in MARKS]))

    def read(poses: Poses, noise: float) -> Poses:
        asked = np.hstack([poses.pose, np.zeros((len(poses), len(MARKS)))])
        exact = problem_of(replace(poses, pose=asked), rig, machine.truth).predict(machine.truth)
        behind = exact[:, 6:] + noise * rng.standard_normal((len(poses), len(MARKS)))
        return replace(poses, pose=np.hstack([poses.pose, behind]))

    return replace(rig, fitted=read(rig.fitted, 2e-4), validation=read(rig.validation, 0.0))


def test_a_distance_is_between_its_marks_at_rest(machine: Machine) -> None:
    rig = _with_distances(machine, np.random.default_rng(SEED))
    nominal = LegParams(sms.Params())
    pose = np.zeros((1, 8))
    rest = Poses(np.zeros((1, 3)), pose, np.ones(1, dtype=np.int64))
    said = problem_of(rest, rig, nominal).predict(nominal)[0, 6:]
    assert said == pytest.approx([np.linalg.norm(d.platform - d.ground) for d in MARKS], abs=1e-9)


def test_distances_have_the_derivatives_of_their_residual(machine: Machine) -> None:
    rig, start = _with_distances(machine, np.random.default_rng(SEED)), machine.truth
    problem = problem_of(rig.fitted, rig, start)
    names = [u.name for u in unknowns(rig)]
    _, jacobian = problem.evaluate(start, names)
    for k, name in enumerate(names):
        assert jacobian[:, k] == pytest.approx(
            _slope(problem, start, name, 1e-6), rel=1e-4, abs=1e-5 * np.abs(jacobian).max()
        ), name


def test_distances_tell_the_scale(machine: Machine) -> None:
    """Which an inclinometer alone does not; and where the ground's joints are against the marks."""
    rng = np.random.default_rng(SEED)
    rig = _with_distances(machine, rng)
    found, alone = calibrate_poses(rig), calibrate_poses(machine.rig)
    told, told_alone = ({k.words: k.information for k in c.combinations} for c in (found, alone))
    scale = "the scale: all joints, lengths and extensions by one factor"
    assert told[scale] > 1.0 > told_alone[scale]
    before, after = found.validation.distance
    assert after < 0.2 * before
    assert found.validation.attitude[1] < 0.2 * found.validation.attitude[0]
    assert np.isnan(alone.validation.distance).all()
    off = [abs(f.value - machine.truth[f.unknown.name]) / f.deviation for f in found.found]
    assert np.mean(np.array(off) < 1.96) > 0.8  # one machine: 50 parameters that go together
    page = calibration_html(found, [])
    assert "distances [mm]" in page


def test_distances_in_the_file(machine: Machine, tmp_path: Path) -> None:
    tables = "".join(
        f"[distances.{d.name}]\nground = {[f'{v} m' for v in d.ground]}\n"
        f"platform = {[f'{v} m' for v in d.platform]}\nnoise = '0.2 mm'\n"
        for d in MARKS
    )
    rig = _with_distances(machine, np.random.default_rng(SEED))
    file = _write(tmp_path, rig, tables)
    lines = (tmp_path / "poses.csv").read_text().splitlines()
    lines[0] += ",distance_laser [mm],distance_wire [m]"
    for k, row in enumerate(rig.fitted.pose):
        lines[k + 1] += f",{1e3 * row[6]:.6f}," + ("" if k == 3 else f"{row[7]:.9f}")
    (tmp_path / "poses.csv").write_text("\n".join(lines) + "\n")
    loaded = load_poses(file)
    assert loaded.channels[6:] == ("distance_laser", "distance_wire")
    assert loaded.fitted.pose[:3, 6:] == pytest.approx(rig.fitted.pose[:3, 6:], abs=1e-8)
    assert np.isnan(loaded.fitted.pose[3, 7])
    assert loaded.pose_noise[6:] == pytest.approx([2e-4, 2e-4])
    result = CliRunner().invoke(
        app, ["calibrate", "geometry", str(file), "--out", str(tmp_path / "out")]
    )
    assert result.exit_code == 0, result.output
    assert "distances on " in result.output
    file.write_text(file.read_text().replace("[distances.laser]", "[distances.lasr]"))
    with pytest.raises(InputError, match=r"declare its marks in \[distances\.laser\]"):
        load_poses(file)
    file.write_text(file.read_text().replace("'2.0 m', ", "", 1))
    with pytest.raises(InputError, match=r"\[distances\] lasr\.ground: must be x, y and z"):
        load_poses(file)


def test_unknown_column(machine: Machine, tmp_path: Path) -> None:
    rig = _write(tmp_path, machine.rig)
    poses = tmp_path / "poses.csv"
    poses.write_text(poses.read_text().replace("roll [deg]", "rol [deg]"))
    with pytest.raises(InputError, match="did you mean 'roll'"):
        load_poses(rig)


def test_a_simulation_takes_the_file_each_leg_by_itself(tmp_path: Path) -> None:
    file = tmp_path / "geometry.toml"
    file.write_text(
        '[parameters]\nbase_joint_1_x = "1370 mm"\npayload_mass = "250 kg"\n'
        '"sensor_gain_extension:2" = 0.004\n',
        encoding="utf-8",
    )
    found = settings_in_si(["payload_mass=280", str(file)])
    assert found == {
        "base_joint_1_x": 1.37,
        "payload_mass": 280.0,
        "sensor_gain_extension:2": 0.004,
    }
    with pytest.raises(InputError, match=r"none\.toml: there is no such parameter file"):
        settings_in_si([str(tmp_path / "none.toml")])
    scenario = tmp_path / "scenario.toml"
    for plant in ("platform", "bench"):
        scenario.write_text(
            f'[scenario]\nplant = "{plant}"\nduration = "1 s"\n[rig]\nfile = "geometry.toml"\n'
            '[excitation]\nkind = "sine"\namplitude = "20 mm"\nfrequency = "0.5 Hz"\n',
            encoding="utf-8",
        )
        if plant == "bench":
            with pytest.raises(InputError, match="of one leg of a platform, and this is a bench"):
                load_scenario(scenario)
            continue
        params = load_scenario(scenario).params
        assert isinstance(params, LegParams)
        gains = [leg["sensor_gain_extension"] for leg in params.legs]
        assert gains == [0.0, 0.004, 0.0]
        said = CliRunner().invoke(app, ["simulate", str(scenario), "--out", str(tmp_path / "run")])
        assert said.exit_code == 0, said.output
        assert "parameter sensor gain extension:2" in (tmp_path / "run" / "report.html").read_text()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            '[parameters]\nstroke = { uncertainty = "1 mm" }\n',
            'stroke: no value; write { value = "1.2 m" }',
        ),
        ("[parameters]\n", r"the table [parameters] is missing"),
        ('[parameters]\nstrok = "1 m"\n', "did you mean 'stroke'"),
        ('[parameters]\nstroke = "40 kg"\n', "stroke"),
        ('[parameters]\nstroke = "40 m"\n', "outside the allowed range"),
    ],
)
def test_a_parameter_file_that_cannot_be_used_is_one_sentence(
    text: str, said: str, tmp_path: Path
) -> None:
    file = tmp_path / "geometry.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=re.escape(said)) as caught:
        load_params(file)
    assert str(file) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_rig_file_takes_the_mechanism_as_calibrated(tmp_path: Path) -> None:
    """Its values; and the smaller of two half widths, as poses know parameters together."""
    rig = write_platform(tmp_path, 5, {}, 1.2)
    (tmp_path / "geometry.toml").write_text(
        '[parameters]\nbase_joint_1_x = { value = "1370 mm", uncertainty = "4 mm" }\npayload_mass = "250 kg"\n'
        '"sensor_gain_extension:2" = { value = 0.004, uncertainty = 1e-5 }\n',
        encoding="utf-8",
    )
    text = rig.read_text()
    rig.write_text(text.replace("[rig]\n", '[rig]\ngeometry = "geometry.toml"\n', 1))
    known = load_rig(rig)
    assert known.declared("base_joint_1_x") == Declaration(1.37, 0.001)
    assert known.declared("sensor_gain_extension:2") == Declaration(0.004, 0.0)
    assert known.start().legs[1]["sensor_gain_extension"] == 0.004
    assert known.geometry in known.files
    # its [parameters] go before the file's, and an extended rig file elsewhere still finds it
    extended = tmp_path / "report" / "extended.toml"
    update = {"payload_mass": Declaration(260.0, 1.0)}
    write_extended_rig(rig, extended, update, "extended")
    again = load_rig(extended)
    assert again.declared("payload_mass") == Declaration(260.0, 1.0)
    assert again.declared("base_joint_1_x") == Declaration(1.37, 0.001)


def test_geometry_of_a_rig_without_a_mechanism_is_refused(tmp_path: Path) -> None:
    rig = write_bench(tmp_path, 6, {})
    rig.write_text(rig.read_text().replace("[rig]\n", '[rig]\ngeometry = "geometry.toml"\n', 1))
    with pytest.raises(InputError, match="a bench has no mechanism"):
        load_rig(rig)
    rig = write_platform(tmp_path, 6, {}, 1.2)
    rig.write_text(rig.read_text().replace("[rig]\n", '[rig]\ngeometry = "geometri.toml"\n', 1))
    with pytest.raises(InputError, match=r"\[rig\] geometry: there is no parameter file"):
        load_rig(rig)


def test_tables_take_the_parameters_as_words(tmp_path: Path) -> None:
    file = tmp_path / "geometry.toml"
    file.write_text(
        '[parameters]\nbase_joint_1_x = "1.3701 m"\n"sensor_gain_extension:2" = 0.004\n',
        encoding="utf-8",
    )
    said = CliRunner().invoke(app, ["export", "table-params", str(file)])
    assert (said.exit_code, said.stdout.split()) == (0, ["base_joint_1_x=1.3701"])


def test_a_mark_out_of_all_range_is_one_sentence(
    machine: Machine, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Without what the solver would say of it."""
    mark = '[distances.tape]\nground = ["0.1 m", "0 m", "0 m"]\nplatform = ["0.1 m", "-1e308 m", "0 m"]\n'
    rig = _write(tmp_path, machine.rig, mark + 'noise = "1 mm"\n')
    text = (tmp_path / "poses.csv").read_text().splitlines()
    lines = [text[0] + ",distance_tape [m]", *(line + ",2.0" for line in text[1:])]
    (tmp_path / "poses.csv").write_text("\n".join(lines) + "\n")
    with pytest.raises(ValueError, match="out of all range"):
        calibrate_poses(load_poses(rig))
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(("cell", "refused"), [("1e308", True), ("1001", True), ("999", False)])
def test_a_distance_out_of_all_range(
    machine: Machine, tmp_path: Path, cell: str, refused: bool
) -> None:
    """Seen: a tape's column of 1e308 m ended in warnings of overflow beside an answer."""
    mark = (
        '[distances.tape]\nground = ["0.1 m", "0 m", "0 m"]\nplatform = ["0.1 m", "0 m", "0 m"]\n'
    )
    rig = _write(tmp_path, machine.rig, mark + 'noise = "1 m"\n')
    text = (tmp_path / "poses.csv").read_text().splitlines()
    lines = [text[0] + ",distance_tape [m]", *(f"{line},{cell}" for line in text[1:])]
    (tmp_path / "poses.csv").write_text("\n".join(lines) + "\n")
    if not refused:
        load_poses(rig)
        return
    with pytest.raises(InputError, match=r"pose 1, column 'distance_tape .m.': .* more than any"):
        load_poses(rig)


def test_more_poses_than_anybody_measures_are_refused(machine: Machine, tmp_path: Path) -> None:
    """Seen: 60,000 took minutes."""
    rig = _write(tmp_path, machine.rig, "")
    head, *lines = (tmp_path / "poses.csv").read_text().splitlines()
    many = lines * (20_001 // len(lines) + 1)
    (tmp_path / "poses.csv").write_text("\n".join([head, *many]) + "\n")
    with pytest.raises(InputError, match="poses are more than are calibrated at once"):
        load_poses(rig)
