"""What the repository holds but nobody writes: two tables of its documentation, the frames of the bus, a stub, and
the schemas.

`./dev docs` regenerates them; `python -m tools.generate --check` says whether that is due.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

from sms import _core, schemas

from tools.generate_frames import frames

ROOT = Path(__file__).resolve().parent.parent
HEADERS = ROOT / "libsms" / "include" / "sms"

PARAMETERS_HEAD = """\
# Parameters

Made by `./dev docs` from `libsms/include/sms/params.def`, the one place where a parameter stands.

- Values are in the unit given, SI; `1` is dimensionless.
- *allowed*: a value outside is refused.
- *uncertainty*: the half width within which the default is believed. A fit may move it that far
  unasked; a shift beyond it is a finding.
- *source*: equation, section and table numbers are the dissertation's ([source.md](source.md)).
  *neutral* is an effect that is absent, to the bit, until data switches it on.

| parameter | unit | default | allowed | uncertainty | meaning | source |
|---|---|---|---|---|---|---|
"""


def parameter_table() -> str:
    """docs/parameters.md."""
    lines = []
    for p in _core.parameter_table():
        cells = (
            f"`{p.name}`",
            p.unit,
            f"{p.default:.10g}",
            f"{p.lower:.10g} to {p.upper:.10g}",
            f"{p.uncertainty:.10g}" if p.uncertainty > 0.0 else "",
            p.doc,
            p.source,
        )
        lines.append("| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |\n")
    return PARAMETERS_HEAD + "".join(lines)


EQUATIONS_HEAD = """\
# Which equation stands in which header

Made by `./dev docs` from the headers in `libsms/include/sms/`: each opens with its subject and says where its equations
come from. The numbers are the dissertation's ([source.md](source.md)). Headers that cite nothing are not listed.

| header | subject | in the dissertation |
|---|---|---|
"""
NUMBER = r"[0-9A-E](?:\.?[0-9])*"
CITATION = re.compile(
    rf"\b(?:eq\.|chapters?|sections?|[Tt]ables?|appendix|figure) {NUMBER}(?:(?:,| to| and) {NUMBER})*"
)


def equation_table() -> str:
    """docs/equations.md."""
    lines = []
    for header in sorted(HEADERS.glob("*.hpp")):
        text = " ".join(re.findall(r"^// ?(.*)$", header.read_text(), re.MULTILINE))
        citations = ", ".join(dict.fromkeys(CITATION.findall(text)))
        subject = re.sub(r" \(dissertation[^)]*\)", "", text).split(". ")[0].rstrip(".")
        if citations:
            lines.append(f"| `{header.name}` | {subject} | {citations} |\n")
    return EQUATIONS_HEAD + "".join(lines)


def stub() -> str:
    """python/sms/_core.pyi."""
    with tempfile.TemporaryDirectory() as folder:
        options = ["--exit-code", "--enum-class-locations", r"\w+:sms._core", "-o", folder]
        stubgen = subprocess.run(
            [sys.executable, "-m", "pybind11_stubgen", "sms._core", *options],
            check=False,
            capture_output=True,
            text=True,
        )
        if stubgen.returncode != 0:
            raise RuntimeError(f"pybind11-stubgen cannot describe the module:\n{stubgen.stderr}")
        return (Path(folder) / "sms" / "_core.pyi").read_text()


GENERATED: Mapping[str, Callable[[], str]] = {
    "docs/parameters.md": parameter_table,
    "docs/equations.md": equation_table,
    "libsms/include/sms/frames.def": frames,
    "python/sms/_core.pyi": stub,
    "python/sms/schemas/rig.schema.json": lambda: schemas.made("rig"),
    "python/sms/schemas/scenario.schema.json": lambda: schemas.made("scenario"),
    "python/sms/schemas/poses.schema.json": lambda: schemas.made("poses"),
}


def stale() -> list[str]:
    """The generated files that are not what the core of today makes of them."""
    return [
        name
        for name, make in GENERATED.items()
        if not (ROOT / name).exists() or (ROOT / name).read_text() != make()
    ]


def main() -> None:
    """Write the files that are not current, or only name them."""
    parser = argparse.ArgumentParser(prog="python -m tools.generate", description=__doc__)
    parser.add_argument("--check", action="store_true", help="change nothing; exit 1 if one is old")
    options = parser.parse_args()
    names = stale()
    for name in GENERATED:
        if name not in names:
            print(f"{name}: current")
        elif options.check:
            print(f"{name}: not current; ./dev docs regenerates it")
        else:
            (ROOT / name).parent.mkdir(exist_ok=True)
            (ROOT / name).write_text(GENERATED[name]())
            print(f"{name}: written")
    sys.exit(bool(names) and options.check)


if __name__ == "__main__":
    main()
