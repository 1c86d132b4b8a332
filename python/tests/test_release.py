"""What a release holds: the source archive builds without git, the bill of materials names what is inside."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path

import pytest
import sms

from tools import release

ROOT = Path(__file__).parents[2]


def test_the_version_of_the_citation_is_the_library_s() -> None:
    cited = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    assert cited is not None
    assert cited[1] == release.version() == sms.__version__


def test_the_changelog_knows_this_version() -> None:
    assert f"## [{release.version()}]" in (ROOT / "CHANGELOG.md").read_text()


def test_full_is_every_optional_part_of_a_user() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    of_a_user = extras.keys() - {"full", "docs", "test", "dev"}
    named = re.fullmatch(r"sms\[(.+)\]", extras["full"][0])
    assert named is not None and set(named[1].split(",")) == of_a_user


def test_the_bill_of_materials(tmp_path: Path) -> None:
    build = ROOT / "build" / "package"
    if not (build / "CMakeCache.txt").exists():
        pytest.skip("run ./dev build first")
    bill = release.sbom(build)
    assert json.loads(json.dumps(bill)) == bill
    assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.5")
    assert bill["metadata"]["component"]["version"] == release.version()
    by_name = {c["name"]: c for c in bill["components"]}
    assert by_name.keys() >= {
        "Eigen",
        "FMI headers",
        "pybind11",
        "numpy",
        "plotly",
        "distributed",
        "control",
    }
    if sms._core.has_estimation:
        assert "Ceres Solver" in by_name
    assert all(re.match(r"\d", c["version"]) for c in bill["components"])
    assert by_name["numpy"]["purl"].startswith("pkg:pypi/numpy@")
    refs = {c["bom-ref"] for c in bill["components"]} | {bill["metadata"]["component"]["bom-ref"]}
    for of in bill["dependencies"]:
        assert {of["ref"], *of["dependsOn"]} <= refs
    assert len(refs) == len(bill["components"]) + 1


@pytest.mark.full
def test_the_source_archive_builds_without_git(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tools.release", "sdist"],
        cwd=ROOT, check=True, capture_output=True, text=True,
    )  # fmt: skip
    archive = Path(done.stdout.splitlines()[-1].rpartition(": ")[0])
    with tarfile.open(archive) as opened:
        names = opened.getnames()
        opened.extractall(tmp_path, filter="data")
    assert not [n for n in names if "/.git/" in n or n.endswith(".so") or "/build/" in n]
    (source,) = tmp_path.iterdir()
    for needed in ("dev", "CHANGELOG.md", "docs/index.md", "libsms/include/sms/params.def"):
        assert (source / needed).exists(), needed
    build = [shutil.which("cmake") or "cmake", "-S", str(source), "-B", str(tmp_path / "cmake")]
    options = ["-DSMS_ESTIMATION=OFF", "-DSMS_TESTS=OFF", "-DSMS_IK_TABLES=ON"]
    subprocess.run([*build, *options], check=True, capture_output=True)
    subprocess.run(["cmake", "--build", str(tmp_path / "cmake")], check=True, capture_output=True)
    found = list((tmp_path / "cmake").rglob("ik_tables"))
    program = next(f for f in found if f.is_file())
    told = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
    assert release.version() in told
