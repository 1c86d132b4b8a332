"""`sms export fmu`: its files are what FMI asks for, start values of rig files, refusals, and the page about it."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from cli_support import sms
from fmi_support import (
    PERIOD,
    RANGES,
    SAME,
    TIME,
    TOLERANCE,
    same,
    simulated,
    unit_of,
)
from fmpy.validation import validate_fmu
from lxml import etree
from plant_support import write_bench
from sms import Params, simulate_bench, simulate_platform, simulate_tank
from sms.fmi import KINDS, Starts, export_fmu, starts_of_rig, variables_of
from sms.io import Declaration, write_extended_rig
from sms.parameters import PARAMETERS
from sms.scenario import command_of, load_scenario, run_scenario

BOTH = pytest.mark.parametrize("version", ("2.0", "3.0"))
ALL = pytest.mark.parametrize("kind", KINDS)


# ---- the file ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "version"),
    [
        # The largest; with parameters of its own it is looked at below.
        pytest.param(k, v, marks=[pytest.mark.full] if (k, v) == ("platform", "3.0") else [])
        for k in KINDS
        for v in ("2.0", "3.0")
    ],
)
def test_fmpy_finds_nothing_to_complain_of(exported: Any, kind: str, version: str) -> None:
    assert validate_fmu(str(exported(kind, version))) == []


@BOTH
@ALL
def test_the_rules_of_the_standard_hold(exported: Any, kind: str, version: str) -> None:
    """What the FMI checker looks at, looked at here, in the XML itself."""
    with zipfile.ZipFile(exported(kind, version)) as archive:
        root = etree.fromstring(archive.read("modelDescription.xml"))
        names = set(archive.namelist())
    variables = root.findall("ModelVariables/*")
    references = [int(v.get("valueReference")) for v in variables]
    assert references == list(range(len(variables)))  # unique, and value references are places
    assert len({v.get("name") for v in variables}) == len(variables)
    outputs = [i for i, v in enumerate(variables) if v.get("causality") == "output"]
    assert outputs
    key, shift = ("index", 1) if version == "2.0" else ("valueReference", 0)
    path = "ModelStructure/Outputs/Unknown" if version == "2.0" else "ModelStructure/Output"
    assert [int(u.get(key)) - shift for u in root.findall(path)] == outputs
    path = (
        "ModelStructure/InitialUnknowns/Unknown"
        if version == "2.0"
        else "ModelStructure/InitialUnknown"
    )
    assert [int(u.get(key)) - shift for u in root.findall(path)] == outputs
    defined = {u.get("name") for u in root.findall("UnitDefinitions/Unit")}
    typed = {t.get("name") for t in root.findall("TypeDefinitions/*")}
    for v in variables:
        inner = v[0] if version == "2.0" else v
        causality, variability, initial = (
            v.get(a) for a in ("causality", "variability", "initial")
        )
        assert (causality, variability, initial) in {
            ("independent", "continuous", None),
            ("parameter", "fixed", None),
            ("input", "continuous", None),
            ("output", "continuous", "calculated"),
            ("output", "discrete", "calculated"),
            ("local", "continuous", "calculated"),
        }
        assert (inner.get("start") is not None) == (causality in ("parameter", "input"))
        assert inner.get("unit") is None or inner.get("unit") in defined
        assert inner.get("declaredType") is None or inner.get("declaredType") in typed
        if inner.get("min") is not None and inner.get("start") is not None:
            assert float(inner.get("min")) <= float(inner.get("start")) <= float(inner.get("max"))
    place = "linux64" if version == "2.0" else "x86_64-linux"
    assert any(name.startswith(f"binaries/{place}/sms_{kind}.") for name in names)
    path = "CoSimulation/SourceFiles/File" if version == "2.0" else ""
    sources = [f.get("name") for f in root.findall(path)] if path else ["buildDescription.xml"]
    assert sources
    assert {f"sources/{name}" for name in sources} <= names
    assert {"documentation/licenses/license.txt", "sources/LICENSE_FMI"} <= names


@ALL
def test_parameters_are_those_of_params_def(kind: str) -> None:
    for v in variables_of(kind):
        row = PARAMETERS.get(v.name)
        if v.causality == "parameter" and row is not None:
            assert (v.unit, v.lower, v.start, v.upper, v.doc) == (
                row.unit,
                row.lower,
                row.default,
                row.upper,
                row.doc,
            )


def test_what_a_plant_reads_is_among_its_parameters() -> None:
    """A parameter that is left out changes no bit of a run, moved as far as it goes."""
    volts = 5.0 + 1.5 * np.sign(np.sin(40.0 * TIME[:120]))
    plants = {
        "bench": lambda p: simulate_bench(volts, params=p, extension=0.2).rows[:, :19],
        "tank": lambda p: simulate_tank(volts, params=p).rows,
        "platform": lambda p: simulate_platform(
            np.column_stack([volts] * 3), controller="open_loop", params=p
        ).rows[:, :51],
    }
    for kind, run in plants.items():
        healthy = run(Params())
        has = {v.name for v in variables_of(kind)}
        for name, row in PARAMETERS.items():
            if name not in has and not name.startswith("clock_skew"):
                moved = Params(**{name: row.default + 0.3 * (row.upper - row.default)})
                assert np.array_equal(run(moved), healthy), (kind, name)


def test_the_same_model_is_the_same_file(tmp_path: Path) -> None:
    files = [tmp_path / "a.fmu", tmp_path / "b.fmu"]
    for file in files:
        export_fmu("tank", file, "3.0")
    assert files[0].read_bytes() == files[1].read_bytes()


# ---- rig files and the command -------------------------------------------------------------------------------


@BOTH
def test_an_extended_rig_file_is_the_machine_that_was_found(tmp_path: Path, version: str) -> None:
    rig = write_bench(tmp_path, 1, {})
    extended = tmp_path / "extended.toml"
    found = {"piston_leakage": 3e-9, "backlash": 1e-3, "clock_skew_extension": 0.01}
    write_extended_rig(rig, extended, {n: Declaration(v, 0.0) for n, v in found.items()}, "found")
    out = tmp_path / "bench.fmu"
    said = sms(
        "export", "fmu", "bench", str(extended), "--fmi", version, "-o", str(out), cwd=tmp_path
    )
    assert said.returncode == 0, said.stderr
    assert "clock_skew_extension = 0.01" in said.stdout  # a late clock is of a record
    assert validate_fmu(str(out)) == []
    starts = {
        v.name: v.start for v in fmpy.read_model_description(str(out)).modelVariables if v.start
    }
    assert float(starts["piston_leakage"]) == 3e-9
    assert float(starts["backlash"]) == 1e-3
    scenario = tmp_path / "scenario.toml"
    scenario.write_text(
        '[scenario]\nplant = "bench"\nduration = "1 s"\n[rig]\nfile = "extended.toml"\n'
        '[controller]\nkind = "open_loop"\n[excitation]\nkind = "sine"\nfrequency = "2 Hz"\namplitude = "1.5 V"\n'
        'axis = "actuators"\n'
    )
    asked = load_scenario(scenario)  # as `sms simulate` runs it
    record = run_scenario(asked, command_of(asked))
    inputs = {"valve_command": record.valve_command[:, 0]}
    found = simulated(out, PERIOD, inputs, ["extension", "chamber_pressure_lower"])
    assert np.ptp(record.extension) > 0.02
    for name, values in found.items():
        off = np.abs(values - getattr(record, name)[:, 0]).max()
        assert off <= SAME * RANGES[unit_of(name, "bench")], name


def test_one_leg_of_a_platform_has_what_the_rig_file_says(tmp_path: Path) -> None:
    rig = tmp_path / "rig.toml"
    rig.write_text(
        '[rig]\nkind = "platform"\n[signals]\n[parameters]\n"coulomb_force:2" = "9 N"\nvalve_centre = "4.9 V"\n'
        '[model]\nfriction = "lugre"\n[[records]]\nfile = "none.csv"\nrole = "identify"\n'
    )
    starts = starts_of_rig("platform", rig)
    assert starts.values["actuator_2.coulomb_force"] == 9.0
    assert starts.values["valve_command_3"] == 4.9
    assert starts.values["friction_law"] == 5.0
    out = tmp_path / "platform.fmu"
    export_fmu("platform", out, "3.0", starts)
    assert validate_fmu(str(out)) == []
    legs = [Params(valve_centre=4.9, coulomb_force=f) for f in (38.0, 47.0, 38.0)]
    command = 4.9 + np.column_stack([1.2 * np.sin(w * TIME[:300]) for w in (7.0, 11.0, 5.0)])
    run = simulate_platform(
        command, controller="open_loop", params=legs, friction_law="lugre", tolerance=TOLERANCE
    )
    inputs = {f"valve_command_{leg}": command[:, leg - 1] for leg in (1, 2, 3)}
    names = ["roll", "pitch", "height", "extension_2", "chamber_pressure_lower_2"]
    same(simulated(out, PERIOD, inputs, names), run, "platform")


def test_the_command_prints_the_table_and_writes_the_file(tmp_path: Path) -> None:
    said = sms("export", "fmu", "tank", cwd=tmp_path)
    assert said.returncode == 0, said.stderr
    assert "mass_flow" in said.stdout
    assert "written: tank.fmu, FMI 2.0" in said.stdout
    assert validate_fmu(str(tmp_path / "tank.fmu")) == []


CYLINDER = '[rig]\nkind = "cylinder"\n[signals]\n[[records]]\nfile = "a.csv"\nrole = "identify"\n'
REFUSED = {
    "unknown kind": (["bunch"], "did you mean 'bench'?"),
    "no such rig": (["bench", "none.toml"], "none.toml"),
    "no TOML": (["bench", "words.toml"], "words.toml"),
    "a cylinder": (["bench", "cylinder.toml"], "rig file of a cylinder"),
    "another kind": (["platform", "bench.toml"], "sms export fmu bench bench.toml"),
    "out of bounds": (["bench", "far.toml"], "outside the allowed range"),
    "unknown parameter": (["bench", "unknown.toml"], "did you mean 'coulomb_force'?"),
    "a missing folder": (["bench", "-o", "nowhere/x.fmu"], "there is no folder 'nowhere'"),
    "a folder": (["bench", "-o", "."], "this is a folder"),
    "another standard": (["bench", "--fmi", "1.0"], "--fmi 1.0: allowed are 2.0 and 3.0"),
}


@pytest.mark.parametrize("case", list(REFUSED))
def test_bad_input_is_one_sentence(tmp_path: Path, case: str) -> None:
    arguments, expected = REFUSED[case]
    bench = CYLINDER.replace("cylinder", "bench")
    texts = {"words": "what = is this", "cylinder": CYLINDER, "bench": bench}
    texts["far"] = bench + '[parameters]\nsupply_pressure = "90 bar"\n'
    texts["unknown"] = bench + '[parameters]\ncoulomb_forze = "9 N"\n'
    for name, text in texts.items():
        (tmp_path / f"{name}.toml").write_text(text)
    before = set(tmp_path.iterdir())
    said = sms("export", "fmu", *arguments, cwd=tmp_path)
    assert said.returncode == 2
    assert expected in said.stderr
    assert said.stderr.count("\n") == 1
    assert set(tmp_path.iterdir()) == before


# ---- the page ------------------------------------------------------------------------------------------------

PAGE = (Path(__file__).parents[2] / "docs" / "fmi.md").read_text(encoding="utf-8")


def test_the_table_of_the_page_is_what_the_command_prints(tmp_path: Path) -> None:
    printed = sms("export", "fmu", "bench", cwd=tmp_path).stdout
    kept = PAGE.partition("```text\n")[2].partition("```")[0]
    assert [line.rstrip() for line in printed.splitlines()] == kept.splitlines()


def test_the_example_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    code = PAGE.partition("```python\n")[2].partition("```")[0]
    names: dict[str, Any] = {}
    exec(code, names)
    assert names["result"]["extension"][-1] > 0.25


def test_the_closed_loop_of_the_page_runs(tmp_path: Path) -> None:
    example = Path(__file__).parents[1] / "examples" / "fmu.py"
    done = subprocess.run(
        [sys.executable, str(example)], cwd=tmp_path, check=False, capture_output=True, text=True
    )
    assert "to 1e-12 deg: True" in done.stdout, done.stderr


# ---- the sources ---------------------------------------------------------------------------------------------


@BOTH
def test_the_sources_compile(exported: Any, tmp_path: Path, version: str) -> None:
    """One file of each kind: all of them are what the package itself was compiled from."""
    eigen = next((p for p in (Path("/usr/include/eigen3"),) if p.is_dir()), None)
    if shutil.which("g++") is None or eigen is None:
        pytest.skip("needs g++ and the headers of Eigen")
    with zipfile.ZipFile(exported("controller", version)) as archive:
        archive.extractall(tmp_path)
    for name in (f"fmi{version[0]}.cpp", "instance.cpp", "tank_model.cpp", "info.cpp"):
        done = subprocess.run(
            ["g++", "-std=c++14", "-fsyntax-only", "-I.", "-isystem", str(eigen), name],
            cwd=tmp_path / "sources",
            check=False,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr


def test_no_rig_file_is_the_published_machine() -> None:
    assert Starts().values == {}
