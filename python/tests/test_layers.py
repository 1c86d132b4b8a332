"""Which packages of `sms` may import which: the table of rooms in docs/architecture.md."""

from __future__ import annotations

import ast
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
import sms

ROOT = Path(sms.__file__).parent
FORBIDDEN = {
    "io": ("draft", "link", "estimation", "rigs", "identification", "diagnosis", "report", "cli"),
    "draft": ("link", "estimation", "rigs", "identification", "diagnosis", "report", "cli"),
    "estimation": ("rigs", "identification", "diagnosis", "report", "cli"),
    "rigs": ("identification", "diagnosis", "report", "cli"),
    "identification": ("diagnosis", "report", "cli"),
    "diagnosis": ("identification", "cli"),
    "scenario": ("report", "sweep", "validation", "cli"),
    "sweep": ("report", "cli"),
    "validation": ("report", "cli"),
    "history": ("report", "cli"),
    "watch": ("report", "cli"),
    "report": ("cli",),
    "demo": ("report", "cli"),
    "fmi": ("estimation", "rigs", "identification", "diagnosis", "report", "cli"),
    "data": ("io", "rigs", "diagnosis", "report", "cli"),
    "link": ("estimation", "rigs", "identification", "diagnosis", "report", "cli"),
}
"""Package -> packages that it must not import, not even inside a function."""


def imported(file: Path) -> set[str]:
    """The modules of `sms` that a file imports: "sms.io.rig", and "sms.io.rig.Rig" for a name of it."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module is not None:
            found |= {f"{node.module}.{a.name}" for a in node.names}
        elif isinstance(node, ast.Import):
            found |= {a.name for a in node.names}
    return {name for name in found if name.startswith("sms.")}


@pytest.mark.parametrize("package", sorted(FORBIDDEN))
def test_a_package_imports_only_what_stands_below_it(package: str) -> None:
    files = sorted((ROOT / package).rglob("*.py"))
    assert files
    wrong = [
        f"{file.relative_to(ROOT)} imports {name}"
        for file in files
        for name in sorted(imported(file))
        if name.split(".")[1] in FORBIDDEN[package]
    ]
    assert not wrong


def test_no_two_packages_import_each_other() -> None:
    """A model of one's own stands above all of `diagnosis`, in whose folder it is, and writes the page of `report`."""
    below: dict[str, set[str]] = {}
    for file in ROOT.rglob("*.py"):
        parts = file.relative_to(ROOT).parts
        package = "own" if parts[:2] == ("diagnosis", "own") else parts[0].removesuffix(".py")
        own = {name for name in imported(file) if name.startswith("sms.diagnosis.own")}
        others = {name.split(".")[1] for name in imported(file) - own} | ({"own"} if own else set())
        below.setdefault(package, set()).update(others - {package})
    while leaves := [p for p, needs in below.items() if not needs & below.keys()]:
        for package in leaves:
            del below[package]
    assert not below


def test_no_file_imports_itself_through_others() -> None:
    files = {
        ".".join(("sms", *file.relative_to(ROOT).with_suffix("").parts)): file
        for file in ROOT.rglob("*.py")
        if file.name != "__init__.py"
    }
    needs = {
        name: {n for of in imported(file) for n in (of, of.rpartition(".")[0]) if n in files}
        for name, file in files.items()
    }
    assert sum(map(len, needs.values())) > len(files)
    TopologicalSorter(needs).prepare()  # CycleError names them


def test_the_command_starts_without_what_takes_a_second() -> None:
    """--help and the commands of the mechanism need neither."""
    loaded = "import sys, sms.cli; print(*{'scipy', 'pandas', 'pint'} & set(sys.modules))"
    told = subprocess.run(
        [sys.executable, "-c", loaded], capture_output=True, text=True, check=True
    )
    assert not told.stdout.strip()
