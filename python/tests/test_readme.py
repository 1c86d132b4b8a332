"""What the README shows works as it stands there."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def block(language: str) -> str:
    found = re.findall(rf"```{language}\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(found) == 1, f"one block of {language} is expected in the README"
    return str(found[0])


def test_the_python_example_names_both_causes() -> None:
    result = subprocess.run(
        [sys.executable, "-c", block("python")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert result.stdout.startswith("combination")
    assert "pressure_friction" in result.stdout
    assert "7 bar: 3.90 -> 1.22 N" in result.stdout


def test_the_c_example_compiles_links_and_runs(tmp_path: Path) -> None:
    archive = ROOT / "build" / "package" / "libsms" / "libsms.a"
    assert archive.is_file(), "run ./dev build first"
    (tmp_path / "readme.c").write_text(block("c"))
    flags = [
        "-std=c99",
        "-pedantic",
        "-Wall",
        "-Wextra",
        "-Werror",
        f"-I{ROOT / 'libsms' / 'include'}",
    ]
    command = ["cc", *flags, "readme.c", str(archive), "-lm", "-o", "readme"]
    subprocess.run(command, cwd=tmp_path, check=True)
    result = subprocess.run([tmp_path / "readme"], capture_output=True, text=True, check=True)
    force = float(result.stdout.split()[1])
    assert 38.0 < force < 38.0 + 53.0 + 39.27  # Coulomb, viscous, at most the whole Stribeck term
