"""The recipes under packaging/ say what pyproject.toml and the headers say."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import yaml
from sms import __version__

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
CONDA: dict[str, Any] = yaml.safe_load((ROOT / "packaging/conda-forge/recipe.yaml").read_text())
PORT = ROOT / "packaging/vcpkg/ports/sms"


def test_one_version() -> None:
    assert CONDA["context"]["version"] == __version__
    assert json.loads((PORT / "vcpkg.json").read_text())["version"] == __version__


def test_conda_asks_for_what_pip_asks_for() -> None:
    run = [entry.replace(" ", "") for entry in CONDA["requirements"]["run"]]
    assert sorted(run) == sorted([*PROJECT["project"]["dependencies"], "python"])
    host = " ".join(CONDA["requirements"]["host"])
    for requirement in PROJECT["build-system"]["requires"]:
        assert re.match(r"[\w-]+", requirement)[0] in host  # type: ignore[index]


def test_options_exist() -> None:
    """A flag that the build does not read would change nothing, and nobody would know."""
    sources = [ROOT / "CMakeLists.txt", *(ROOT / "libsms/cmake").glob("*.cmake")]
    known = set(re.findall(r"(?:set|option)\((SMS_\w+) ", "".join(f.read_text() for f in sources)))
    users = [
        ROOT / "dev",
        ROOT / "pyproject.toml",
        ROOT / "packaging/conda-forge/recipe.yaml",
        PORT / "portfile.cmake",
    ]
    for user in users:
        asked = set(re.findall(r"(?:cmake\.define\.|-D)(SMS_\w+)", user.read_text()))
        assert asked, user
        assert asked <= known, user


def test_the_workflow_names_what_is_there() -> None:
    ours = PROJECT["tool"]["cibuildwheel"]
    named = re.findall(
        r"\{package\}/(packaging/[\w/.]+\.\w+)", ours["before-all"] + ours["test-command"]
    )
    assert len(named) == 2
    for name in named:
        assert (ROOT / name).is_file(), name
    workflow = yaml.safe_load((ROOT / ".github/workflows/wheels.yml").read_text())
    assert set(workflow["jobs"]) == {"wheels", "bare", "publish"}
    assert set(workflow["jobs"]["publish"]["needs"]) == {"wheels", "bare"}, "published untested"
