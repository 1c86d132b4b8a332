"""A wheel as its users have it: installed, without its sources. `./dev wheel` runs this; SMS_WHEEL names the wheel."""

from __future__ import annotations

import importlib
import json
import os
import platform
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from validation.twins.cylinder.draw import draw

WHEEL = Path(os.environ["SMS_WHEEL"])
LARGEST = 15e6  #: bytes
TWO_COPIES = platform.machine() in ("x86_64", "AMD64")
TOLERANCE = 1e-6  #: of the largest number of a case that searches for initial states
#: The law's jump at rest lets the last bit decide where a search ends: at nearly equal cost, with other derivatives.
JUMPS = {"estimation bench 0 stribeck energy", "estimation bench loop 0 stribeck energy"}
SHARE_OF_ERROR = 1e-3  #: of a standard error, by which a fitted size may differ
RUNS_AVX2 = TWO_COPIES and importlib.import_module("sms._cpu").runs_avx2()
needs_avx2 = pytest.mark.skipif(not RUNS_AVX2, reason="a processor without AVX2")


def python(
    code: str, *arguments: object, avx2: str | None = None
) -> subprocess.CompletedProcess[str]:
    """A process of its own, since each holds one copy of the core."""
    environment = {name: value for name, value in os.environ.items() if name != "SMS_AVX2"}
    if avx2 is not None:
        environment["SMS_AVX2"] = avx2
    command = [sys.executable, "-P", "-c", code, *map(str, arguments)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def test_size() -> None:
    assert WHEEL.stat().st_size <= LARGEST


@pytest.mark.skipif(sys.platform != "linux", reason="a tag of Linux")
def test_it_runs_on_many_linuxes() -> None:
    assert re.search(r"-manylinux_2_\d+_\w+\.whl$", WHEEL.name), WHEEL.name


def test_what_it_carries_has_its_licence() -> None:
    with zipfile.ZipFile(WHEEL) as wheel:
        folder = next(n for n in wheel.namelist() if n.endswith("licenses/third_party.md"))
        folder = folder.removesuffix("third_party.md")
        texts = {
            name.removeprefix(folder): wheel.read(name).decode()
            for name in wheel.namelist()
            if name.startswith(folder) and not name.endswith("/")
        }
    assert "sms" in texts["LICENSE"]
    assert "Google Inc." in texts["ceres-solver/LICENSE"]
    assert "Apache License" in texts["ceres-solver/LICENSE"]
    assert "Mozilla Public License Version 2.0" in texts["eigen/COPYING.MPL2"]
    assert "Wenzel Jakob" in texts["pybind11/LICENSE"]
    rows = re.findall(
        r"^\| ([\w ]+) \| \d[^|]+ \| .* \| `([\w-]+)/", texts["third_party.md"], re.MULTILINE
    )
    assert dict(rows) == {
        "Ceres Solver": "ceres-solver",
        "Eigen": "eigen",
        "pybind11": "pybind11",
    } | {"FMI headers": "fmi"}


def test_it_carries_nothing_else() -> None:
    """No library beside the module, and no function of SuiteSparse or the logging library within."""
    with zipfile.ZipFile(WHEEL) as wheel:
        modules = [name for name in wheel.namelist() if re.search(r"\.so(\.|$)", name)]
        expected = ["sms/_core", "sms/_core_avx2", "sms/_cpu"] if TWO_COPIES else ["sms/_core"]
        assert sorted(name.split(".")[0] for name in modules) == [*expected, "sms/fmu/sms_fmu"]
        for name in modules:
            inside = wheel.read(name)
            assert not re.search(
                rb"cholmod_|SuiteSparseQR_|cs_di_|N6google10LogMessageC", inside
            ), name


@needs_avx2
@pytest.mark.parametrize(
    ("wanted", "uses"), [(None, True), ("AUTO", True), ("on", True), ("OFF", False)]
)
def test_which_copy_is_loaded(wanted: str | None, uses: bool) -> None:
    done = python("from sms import _core; print(_core.uses_avx2(), _core.__file__)", avx2=wanted)
    assert done.returncode == 0, done.stderr
    said, file = done.stdout.split()
    assert said == str(uses)
    assert Path(file).name.startswith("_core_avx2." if uses else "_core.")


def test_a_word_that_is_no_choice() -> None:
    done = python("import sms", avx2="maybe")
    assert done.returncode != 0
    assert "SMS_AVX2 is one of AUTO, ON, OFF, not 'maybe'" in done.stderr


VALUES = """
import itertools, sys
import numpy as np
from tools.same_bits import estimation, simulation
cases = itertools.chain(simulation.simulations(), estimation.bench_cases(), estimation.platform_cases(),
                        estimation.tank_cases(), estimation.other_cases())
names, values = zip(*((name, np.ravel(run())) for name, run in cases))
np.savez(sys.argv[1], names=names, sizes=[v.size for v in values], values=np.concatenate(values))
"""


@needs_avx2
def test_both_copies_compute_the_same(tmp_path: Path) -> None:
    """Simulations and equations to the bit, what begins with a search for initial states to a tolerance."""
    found = {}
    for choice in ("OFF", "ON"):
        file = tmp_path / f"{choice}.npz"
        done = python(VALUES, file, avx2=choice)
        assert done.returncode == 0, done.stderr
        found[choice] = np.load(file)
    one, other = found["OFF"], found["ON"]
    assert list(one["names"]) == list(other["names"])
    assert len(one["names"]) > 100
    assert (one["sizes"] == other["sizes"]).all()
    assert set(one["names"]) >= JUMPS
    ends = np.cumsum(one["sizes"])[:-1]
    parts = zip(
        one["names"], np.split(one["values"], ends), np.split(other["values"], ends), strict=True
    )
    for name, a, b in parts:
        if not name.startswith("estimation"):
            np.testing.assert_array_equal(b, a, err_msg=name)
        elif name not in JUMPS:
            np.testing.assert_allclose(
                b, a, rtol=0.0, atol=TOLERANCE * np.abs(a).max(), err_msg=name
            )


DIAGNOSIS = """
import json, sys
from sms.diagnosis import diagnose
answer = diagnose(sys.argv[1], seed=1)
json.dump({
    "verdict": answer.verdict,
    "causes": [c.members for c in answer.causes],
    "sizes": [(p.value, p.standard_error) for c in answer.causes for p in c.parameters],
    "gain": [(g.baseline_rms, g.extended_rms) for g in answer.gain],
}, sys.stdout)
"""


@needs_avx2
def test_both_copies_give_the_same_diagnosis(tmp_path: Path) -> None:
    """Of a virtual cylinder with a hidden effect: fits, which amplify the last bits, end in the same answer."""
    draw(3, tmp_path / "records", tmp_path / "truth.json", "sensor_gain:rod_force")
    found = {}
    for choice in ("OFF", "ON"):
        done = python(DIAGNOSIS, tmp_path / "records" / "rig.toml", avx2=choice)
        assert done.returncode == 0, done.stderr
        found[choice] = json.loads(done.stdout)
    one, other = found["OFF"], found["ON"]
    assert one["causes"]
    assert (other["verdict"], other["causes"]) == (one["verdict"], one["causes"])
    for (a, error), (b, _) in zip(one["sizes"], other["sizes"], strict=True):
        assert abs(b - a) <= SHARE_OF_ERROR * error
    np.testing.assert_allclose(other["gain"], one["gain"], rtol=SHARE_OF_ERROR)
