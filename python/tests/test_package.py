"""The package as it is installed: one version, types, generated files, the list of parameters."""

from __future__ import annotations

import importlib.metadata
import importlib.resources
import re
import subprocess
from pathlib import Path

import pytest
import sms
from sms import _core

from tools import generate

ROOT = Path(__file__).resolve().parents[2]


def test_one_version_everywhere(tmp_path: Path) -> None:
    header = (ROOT / "libsms/include/sms/version.h").read_text()
    version = re.findall(r'#define SMS_VERSION "(\d+\.\d+\.\d+)"', header)
    assert len(version) == 1
    options = ["-G", "Ninja", "-DSMS_TESTS=OFF", "-DSMS_ESTIMATION=OFF"]
    subprocess.run(["cmake", "-S", ROOT, "-B", tmp_path, *options], check=True, capture_output=True)
    cache = (tmp_path / "CMakeCache.txt").read_text()
    in_cmake = re.findall(r"^CMAKE_PROJECT_VERSION:STATIC=(.*)$", cache, re.MULTILINE)
    assert in_cmake == version
    assert [_core.__version__] == version
    assert [sms.__version__] == version
    assert [importlib.metadata.version("sms")] == version


def test_the_module_is_built_as_meant() -> None:
    text = f"libsms {_core.__version__} float+double c++201402L no-exceptions no-rtti"
    assert _core.build_info == text
    assert _core.has_estimation


def test_the_package_is_typed() -> None:
    assert importlib.resources.files("sms").joinpath("py.typed").is_file()


@pytest.mark.parametrize("name", generate.GENERATED)
def test_a_generated_file_is_current(name: str) -> None:
    made = generate.GENERATED[name]()
    assert (ROOT / name).read_text() == made, f"{name} is not current: ./dev docs regenerates it"


def test_a_parameter_is_described_whole() -> None:
    table = _core.parameter_table()
    assert len({p.name for p in table}) == len(table) > 0
    for p in table:
        assert p.unit and p.doc, p.name
        assert p.lower <= p.default <= p.upper, p.name
        assert p.uncertainty >= 0.0, p.name
        assert re.match(r"(published|derived|assumed)[,:] |neutral$", p.source), p.name


def test_params_refuse_what_cannot_be_and_keep_what_they_had() -> None:
    params = _core.Params(bore_diameter=0.05)
    with pytest.raises(
        _core.OutOfRangeError, match=r"bore_diameter = -1 m is outside 0\.001 to 1 m"
    ):
        params.bore_diameter = -1.0
    with pytest.raises(_core.NotANumberError, match="bore_diameter"):
        params["bore_diameter"] = float("nan")
    assert params.bore_diameter == 0.05
    with pytest.raises(KeyError, match="bore_diametre"):
        _core.Params(bore_diametre=0.05)
    assert params == params.copy() and params != _core.Params() and params != 0.05
