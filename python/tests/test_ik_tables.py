"""`ik_tables` as a user runs it: every format read back by the tools it is meant for, every refusal."""

from __future__ import annotations

import json
import math
import re
import shlex
import subprocess
from pathlib import Path

import numpy as np
import pytest
import scipy.interpolate
import scipy.io
from ik_tables_support import READERS, STRICT_C, direct, made, parameters, read_npz, run
from sms import _core

from validation.random_cases import draw

ROOT = Path(__file__).resolve().parents[2]
ENDINGS = tuple(READERS)
ONE_HEIGHT = ("--height", "0.5", "--range", "0.1", "--step", "0.01")
SEVERAL = (
    *("--height", "0.49:0.51:0.005", "--roll-range", "-5:3", "--pitch-range", "4"),
    *("--step", "0.5", "--deg"),
)


@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("asked", [ONE_HEIGHT, SEVERAL], ids=["one_height", "several"])
@pytest.mark.parametrize("ending", ENDINGS)
def test_a_format_is_read_back(
    ending: str, asked: tuple[str, ...], precision: str, tmp_path: Path
) -> None:
    for name in (f"table.{ending}", "reference.npz"):
        made(tmp_path, *asked, "-o", name, "--precision", precision)
    table = READERS[ending](tmp_path / f"table.{ending}")
    reference = read_npz(tmp_path / "reference.npz")

    number = np.float32 if precision == "float" else np.float64
    assert table.extension.dtype == table.roll.dtype == number
    assert np.array_equal(table.extension, reference.extension)
    rounding = 0.2 * float(np.finfo(number).eps) if ending == "npy" else 0.0  # has only the range
    np.testing.assert_allclose(table.roll, reference.roll, rtol=0.0, atol=rounding)
    np.testing.assert_allclose(table.pitch, reference.pitch, rtol=0.0, atol=rounding)
    np.testing.assert_allclose(table.height, reference.height, rtol=0.0, atol=rounding)

    assert table.version == _core.__version__
    assert table.geometry_hash == reference.geometry_hash
    assert re.fullmatch("[0-9a-f]{16}", table.geometry_hash)
    assert table.units == "roll rad, pitch rad, height m, extension m"


@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("asked", [ONE_HEIGHT, SEVERAL], ids=["one_height", "several"])
def test_the_values_are_those_of_an_independent_solve(
    asked: tuple[str, ...], precision: str, tmp_path: Path
) -> None:
    made(tmp_path, *asked, "-o", "table.npz", "--precision", precision)
    table = read_npz(tmp_path / "table.npz")
    extension = table.extension.reshape(
        len(table.roll), len(table.pitch), len(table.height), 3
    ).astype(float)
    tolerance = 1.5e-8 if precision == "float" else 1e-12  # half a unit in the last place
    rng = draw("independent solve")
    corners = [(0, 0, 0), (-1, -1, -1), (0, -1, 0)]
    places = rng.integers(0, extension.shape[:3], (20, 3)).tolist()
    for i, k, m in [*corners, *places]:
        expected = direct(float(table.roll[i]), float(table.pitch[k]), float(table.height[m]))
        np.testing.assert_allclose(extension[i, k, m], expected, rtol=0.0, atol=tolerance)


def test_the_table_of_section_3_5(tmp_path: Path) -> None:
    asked = ("--height", "0.5", "--range", "0.1", "--step", "0.001", "--max-error", "7.5e-8")
    printed = made(tmp_path, *asked, "-o", "table.npz")
    table = read_npz(tmp_path / "table.npz")
    assert table.extension.shape == (201, 201, 3)
    np.testing.assert_allclose(table.roll, np.linspace(-0.1, 0.1, 201), rtol=0.0, atol=1e-16)
    assert table.roll[0] == -0.1 and table.roll[100] == 0.0 and table.roll[200] == 0.1
    assert np.array_equal(table.pitch, table.roll) and table.height.tolist() == [0.5]
    np.testing.assert_allclose(table.extension[100, 100], 0.20042, rtol=0.0, atol=1e-5)
    assert "201 x 201 x 3 double" in printed and table.geometry_hash in printed
    assert re.search(r"--seed \d+", printed) and "forward kinematics back to roll" in printed


def test_scipy_interpolates_it_as_it_stands(tmp_path: Path) -> None:
    made(tmp_path, *SEVERAL, "-o", "table.npz")
    table = read_npz(tmp_path / "table.npz")
    assert table.extension.shape == (17, 17, 5, 3)
    interpolate = scipy.interpolate.RegularGridInterpolator(
        (table.roll, table.pitch, table.height), table.extension
    )
    pose = (0.0123, -0.0345, 0.5012)
    np.testing.assert_allclose(interpolate([pose])[0], direct(*pose), rtol=0.0, atol=2e-5)


@pytest.mark.parametrize("precision", ["float", "double"])
@pytest.mark.parametrize("asked", [ONE_HEIGHT, SEVERAL], ids=["one_height", "several"])
def test_the_header_has_the_struct_of_the_lookup(
    asked: tuple[str, ...], precision: str, tmp_path: Path
) -> None:
    made(tmp_path, *asked, "-o", "table.h", "--precision", precision)
    f = "f" if precision == "float" else ""
    flat = asked is ONE_HEIGHT
    lookup = "sms_table_bicubic" if flat else "sms_table_tricubic"
    height = "" if flat else " table_height[1],"
    (tmp_path / "look_up.c").write_text(
        '#include "sms/sms.h"\n#include "table.h"\n'
        f"sms_status look_up({precision} extension[3]) {{\n"
        f"  return {lookup}{f}(&table, table_roll[1], table_pitch[2],{height} extension);\n}}\n"
    )
    include = f"-I{ROOT / 'libsms/include'}"
    subprocess.run([*STRICT_C, include, "-c", "look_up.c"], cwd=tmp_path, check=True)


# ---- what the options do ---------------------------------------------------------------------------


def test_degrees_are_radians_in_the_end(tmp_path: Path) -> None:
    made(tmp_path, "--height", "0.5", "--range", "5", "--step", "1", "--deg", "-o", "deg.npz")
    table = read_npz(tmp_path / "deg.npz")
    assert table.roll[-1] == math.radians(5.0)
    np.testing.assert_allclose(table.roll, np.radians(np.arange(-5.0, 6.0)), atol=1e-16)


@pytest.mark.parametrize(
    "words", [("0.49", "0.5", "0.51"), ("0.49,0.5,0.51",), ("0.49:0.51:0.01",)]
)
def test_several_heights_in_three_spellings(words: tuple[str, ...], tmp_path: Path) -> None:
    made(tmp_path, "--height", *words, "--range", "0.1", "--step", "0.02", "-o", "table.npz")
    table = read_npz(tmp_path / "table.npz")
    assert table.extension.shape == (11, 11, 3, 3)
    np.testing.assert_allclose(table.height, [0.49, 0.5, 0.51], rtol=1e-15)


def fnv(text: str) -> str:
    value = 0xCBF29CE484222325
    for byte in text.encode():
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return f"{value:016x}"


def test_the_hash_is_that_of_the_geometry(tmp_path: Path) -> None:
    def hash_with(*assignments: str) -> str:
        extra = ("--params", *assignments) if assignments else ()
        made(tmp_path, *ONE_HEIGHT, "-o", "table.npz", *extra)
        return read_npz(tmp_path / "table.npz").geometry_hash

    shape = re.compile(r"(base|platform)_joint_\d_|reference_point_|_length_offset_\d|stroke$")
    lines = [f"{k}={v!r}\n" for k, v in parameters().items() if shape.search(k)]
    expected = fnv("".join(sorted(line.replace(".0\n", "\n") for line in lines)))
    assert hash_with() == expected
    assert hash_with("coulomb_force=40", "payload_mass=200") == expected
    assert hash_with("platform_joint_1_z=-0.853819") != expected


def test_changed_parameters_change_the_table(tmp_path: Path) -> None:
    made(tmp_path, *ONE_HEIGHT, "-o", "t.npz", "--params", "platform_joint_4_x=1.03")
    table = read_npz(tmp_path / "t.npz")
    expected = direct(table.roll[3], table.pitch[17], 0.5, platform_joint_4_x=1.03)
    np.testing.assert_allclose(table.extension[3, 17], expected, rtol=0.0, atol=1e-12)
    assert np.max(np.abs(expected - direct(table.roll[3], table.pitch[17], 0.5))) > 1e-5


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_bytes_depend_on_nothing_else(ending: str, tmp_path: Path) -> None:
    for folder, threads in (("a", "1"), ("b", "2"), ("c", "5")):
        (tmp_path / folder).mkdir()
        made(tmp_path / folder, *SEVERAL, "-o", f"t.{ending}", "--threads", threads)
    contents = {(tmp_path / folder / f"t.{ending}").read_bytes() for folder in "abc"}
    assert len(contents) == 1


def test_json_and_a_seed_that_repeats(tmp_path: Path) -> None:
    asked = (*ONE_HEIGHT, "-o", "t.h", "--json")
    first = json.loads(made(tmp_path, *asked))
    again = json.loads(made(tmp_path, *asked, "--seed", str(first["seed"])))
    other = json.loads(made(tmp_path, *asked, "--seed", "1"))
    assert again | {"solving_s": 0} == first | {"solving_s": 0}
    assert other["linear"] != first["linear"]
    assert first["precision"] == "float" and first["format"] == "header"
    assert first["shape"] == [21, 21, 3] and first["nodes_beyond_stroke"] == 0
    assert first["nodes_m"]["largest"] < 1.6e-8
    assert 5e-6 < first["linear"]["extension_m"]["largest"] == first["error"] < 8e-6
    assert first["cubic"]["extension_m"]["largest"] < 3e-7
    assert first["bytes"] == (tmp_path / "t.h").stat().st_size


def test_help_teaches_by_examples_that_work(tmp_path: Path) -> None:
    text = made(tmp_path, "--help")
    examples = re.findall(r"^  ik_tables (.*)$", text, re.MULTILINE)
    assert len(examples) == 3
    for example in examples:
        made(tmp_path, *shlex.split(example))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["ik_table.h", "table.mat", "table.npz"]
    assert scipy.io.loadmat(tmp_path / "table.mat")["extension"].shape == (41, 33, 5, 3)
    assert made(tmp_path, "--version").startswith(f"ik_tables, libsms {_core.__version__} ")
    assert made(tmp_path) == text


def test_nodes_beyond_the_stroke_are_told(tmp_path: Path) -> None:
    done = run(
        tmp_path, "--height", "0.45", "--range", "0.1", "--step", "0.01", "-o", "t.csv", "-q"
    )
    assert done.returncode == 0 and done.stdout == ""
    assert re.fullmatch(
        r"ik_tables: warning: \d+ of 441 nodes need an extension beyond the stroke\n", done.stderr
    )


# ---- refusals --------------------------------------------------------------------------------------

BAD = {
    "--step 0": "larger than 0",
    "--step -0.01": "larger than 0",
    "--step 0.03": "does not divide",
    "--step x": "'x' is not a number",
    "--step nan": "not a number",
    "--step 1e-5": "choose a larger step",
    "--step 1e-12": "choose a larger step",
    "--range 0.1:-0.1": "larger than the first",
    "--range -0.1": "larger than the first",
    "--range 0.1:0.1": "larger than the first",
    "--range 0:1:2": "write R for -R to R",
    "--range 1": "outside the workspace",
    "--height 2": "outside the workspace",
    "--height 0.9": "beyond the stroke of 0 to 0.4 m",
    "--height inf": "not a number",
    "--height 0.5 0.51 0.53": "ascend in equal steps",
    "--height 0.51 0.5": "ascend in equal steps",
    "--height 0.4:0.6:0.03": "does not divide",
    "--height 0.6:0.5:0.1": "first:last:step",
    "--output no/such/folder/table.npz": "cannot be written: No such file or directory",
    "--output . --format csv": "not a file that could be replaced",
    "--output table.xyz": "the ending is none of",
    "--output table": "the ending is none of",
    "--output": "needs a value",
    "--format xls": "must be npz, npy, mat, csv, header or raw",
    "--precision half": "must be double or float",
    "--name 2table": "not a name in C",
    "--params stroek=0.3": "did you mean stroke?",
    "--params stroke=9": "must be within 0.001 to 5 m",
    "--params stroke=": "not a number",
    "--params stroke": "write NAME=VALUE",
    "--interpolation spline": "must be linear or cubic",
    "--interpolation cubic --step 0.1": "needs four nodes",
    "--max-error 0": "larger than 0",
    "--points 0": "must be a whole number",
    "--seed -1": "must be a whole number",
    "--threads 0": "must be a whole number",
    "--heigth 0.5": "did you mean --height?",
    "--quiet=yes": "takes no value",
    "stray": "does not belong to an option",
}


@pytest.mark.parametrize("words", BAD)
def test_bad_input_is_refused_in_one_sentence(words: str, tmp_path: Path) -> None:
    given = dict(zip(ONE_HEIGHT[::2], ONE_HEIGHT[1::2], strict=True)) | {"--output": "table.npz"}
    bad = words.split()
    kept = [
        word for option, value in given.items() if option not in bad for word in (option, value)
    ]
    done = run(tmp_path, *kept, *bad)
    assert done.returncode == 2, done.stdout
    assert done.stdout == ""
    assert done.stderr.startswith("ik_tables: ") and done.stderr.count("\n") == 1
    assert BAD[words] in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("missing", ["--height", "--range", "--step", "--output"])
def test_what_is_missing_is_named(missing: str, tmp_path: Path) -> None:
    given = dict(zip(ONE_HEIGHT[::2], ONE_HEIGHT[1::2], strict=True)) | {"--output": "table.npz"}
    del given[missing]
    done = run(tmp_path, *(word for pair in given.items() for word in pair))
    assert done.returncode == 2 and done.stderr.startswith(f"ik_tables: {missing} is missing")
    assert list(tmp_path.iterdir()) == []


def test_a_table_that_is_not_accurate_is_never_put_in_place(tmp_path: Path) -> None:
    (tmp_path / "table.npz").write_text("the old one")
    done = run(tmp_path, *ONE_HEIGHT, "-o", "table.npz", "--max-error", "1e-6")
    assert done.returncode == 1
    assert "bilinear, extension" in done.stdout
    assert re.search(r"table.npz is not written: its bilinear error of [67]\S*e-06 ", done.stderr)
    assert [p.name for p in tmp_path.iterdir()] == ["table.npz"]
    assert (tmp_path / "table.npz").read_text() == "the old one"
    made(
        tmp_path, *ONE_HEIGHT, "-o", "table.npz", "--max-error", "1e-6", "--interpolation", "cubic"
    )
    assert read_npz(tmp_path / "table.npz").extension.shape == (21, 21, 3)
