"""The gallery: each example is run, and its page holds the source, what it prints and the pictures it draws."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tools.site.prose import restructured, title

ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / "python" / "examples"
C = ROOT / "libsms" / "examples"


@dataclass(frozen=True)
class Example:
    """One entry: a program in Python and, where there is one, its companion in C."""

    name: str
    title: str
    arguments: tuple[str, ...] = ()
    c: str = ""
    also: str = ""  #: the page that goes on


EXAMPLES = (
    Example("pose", "Solve a pose", c="02_kinematics.c", also="simulation"),
    Example("table", "A lookup table", c="04_table.c", also="tables"),
    Example("bench", "Simulate the bench", c="05_plant.c", also="simulation"),
    Example("loop", "Close the loop", c="07_controller.c", also="simulation"),
    Example("valve", "Identify a valve", c="06_pneumatics.c", also="identification"),
    Example("calibrate", "Calibrate a platform", also="calibration"),
    Example("diagnosis", "Diagnose", also="diagnosis"),
    Example("two_tanks", "A plant of one's own", ("leak",), also="own_model"),
    Example("fmu", "A loop of FMUs", also="fmi"),
    Example("bus", "The rig on the bus", also="can_tutorial"),
)


def run(example: Example, out: Path) -> str:
    """What it prints; its pictures go to `out`. CalledProcessError when it fails."""
    out.mkdir(parents=True, exist_ok=True)
    script = PYTHON / f"{example.name}.py"
    environment = os.environ | {"MPLBACKEND": "Agg", "COLUMNS": "100", "SMS_THREADS": "2"}
    command = [
        sys.executable,
        str(script),
        *example.arguments,
        "--picture",
        str(out / f"{example.name}.svg"),
    ]
    done = subprocess.run(
        command, env=environment, cwd=out, check=False, capture_output=True, text=True
    )
    if done.returncode:
        raise RuntimeError(f"{script.name} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def run_c(example: Example, out: Path) -> str:
    """The same of the companion in C, linked with the archive of the build."""
    program = out / Path(example.c).stem
    archive = ROOT / "build" / "package" / "libsms" / "libsms.a"
    include = ROOT / "libsms" / "include"
    flags = ("-std=c99", "-O2", "-Wall", "-Werror", f"-I{include}")
    built = ["cc", *flags, str(C / example.c), str(archive), "-lm", "-o", str(program)]
    subprocess.run(built, check=True)
    return subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout


def pages(out: Path) -> Iterator[tuple[str, str]]:
    """(name, text) of every page; examples that are newer than their last run, or older than the package, run."""
    for example in EXAMPLES:
        folder = out / "pictures"
        printed = _kept(out / f"{example.name}.txt", example, folder)
        script = (PYTHON / f"{example.name}.py").read_text(encoding="utf-8")
        doc = (ast.get_docstring(ast.parse(script)) or "").split("\n")
        text = [*title(example.title), *restructured(doc), ""]
        for picture in sorted(folder.glob(f"{example.name}*.svg")):
            text += [
                f".. image:: pictures/{picture.name}",
                f"   :alt: what {example.name}.py draws",
                "",
            ]
        text += [
            f".. literalinclude:: /../python/examples/{example.name}.py",
            "   :language: python",
            "",
        ]
        text += ["It prints:", "", ".. code-block:: text", "", *_indent(printed)]
        if example.c:
            text += [
                *title("The same subject in C", "-"),
                f".. literalinclude:: /../libsms/examples/{example.c}",
            ]
            text += ["   :language: c", "", "It prints:", "", ".. code-block:: text", ""]
            text += _indent((out / f"{example.name}_c.txt").read_text(encoding="utf-8"))
        if example.also:
            text += ["", f"More: :doc:`/{example.also}`.", ""]
        yield f"gallery/{example.name}", "\n".join(text) + "\n"
    yield "gallery/index", "\n".join(_index(out)) + "\n"


def _kept(file: Path, example: Example, folder: Path) -> str:
    newest = max(f.stat().st_mtime for f in _behind(example))
    if not file.exists() or file.stat().st_mtime < newest:
        printed = run(example, folder)
        if example.c:
            (file.parent / f"{example.name}_c.txt").write_text(
                run_c(example, folder), encoding="utf-8"
            )
            (folder / Path(example.c).stem).unlink()
        file.write_text(printed, encoding="utf-8")
    return file.read_text(encoding="utf-8")


def _behind(example: Example) -> Iterator[Path]:
    """The files on which an example's output depends."""
    yield PYTHON / f"{example.name}.py"
    if example.c:
        yield C / example.c
    package = ROOT / "python" / "sms"
    yield from (f for f in package.rglob("*") if f.suffix in (".py", ".toml", ".so"))


def _indent(text: str) -> list[str]:
    return [*(f"   {line}".rstrip() for line in text.rstrip().split("\n")), ""]


def _index(out: Path) -> Iterator[str]:
    yield from title("Gallery")
    yield "Every example is a program of this repository (``python/examples``, ``libsms/examples``); its output and its"
    yield "pictures on these pages were made by running it while the page was built."
    yield from ("", ".. grid-of-pictures::", "")
    for example in EXAMPLES:
        yield f"   {example.name} | {example.title}"
    yield from ("", ".. toctree::", "   :hidden:", "")
    for example in EXAMPLES:
        yield f"   {example.name}"
