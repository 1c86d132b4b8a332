"""How large should a table be, and does it pay? Measures, then writes docs/tables.md and its picture.

    python -m validation.speed.table_advice

Errors come from `ik_tables`, which holds every table against the solver; instructions from
callgrind, which counts them exactly. Needs the package sms installed, g++, Eigen and valgrind
(apt-get install g++ libeigen3-dev valgrind). Takes a minute.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from validation.speed.table_page import Accuracy, Cost, page, picture

ROOT = Path(__file__).resolve().parents[2]
PAGE, PICTURE = ROOT / "docs" / "tables.md", ROOT / "docs" / "tables.svg"

SEED = 1
POINTS = 100_000
NODES = (5, 6, 9, 11, 17, 21, 41, 81, 101, 201, 401)
HEIGHTS = ((6, 3), (6, 5), (11, 5), (11, 9), (21, 9))  # nodes of roll and pitch, of height
WORKS = ("bilinear", "bicubic", "trilinear", "tricubic", "warm", "cold")
FLAGS = ("-std=c++17", "-O2", "-fno-tree-vectorize", "-ffp-contract=off", "-fno-math-errno")


def needed(program: str) -> str:
    """Path of a program, beside this Python or on PATH."""
    beside = Path(sys.executable).with_name(program)
    found = str(beside) if beside.exists() else shutil.which(program)
    if found is None:
        raise SystemExit(f"{program} is not installed; the head of {Path(__file__).name} says how")
    return found


def accuracy(*asked: str) -> Accuracy:
    """What `ik_tables` finds when it verifies the table asked for."""
    fixed = ("--max-error", "1", "--seed", str(SEED), "--points", str(POINTS), "--json")
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [needed("ik_tables"), *asked, *fixed, "--output", f"{folder}/table.bin"],
            check=True,
            capture_output=True,
            text=True,
        )
    found: dict[str, Any] = json.loads(done.stdout)
    numbers = 1
    for n in found["shape"]:
        numbers *= n
    cubic = found["cubic"] and found["cubic"]["extension_m"]["largest"]
    return Accuracy(numbers, found["linear"]["extension_m"]["largest"], cubic)


def flat(nodes: int, precision: str) -> Accuracy:
    """A table at 0.5 m over -0.1 to 0.1 rad, as in section 3.5."""
    step = repr(0.2 / (nodes - 1))
    return accuracy("--height", "0.5", "--range", "0.1", "--step", step, "--precision", precision)


def deep(nodes: int, heights: int) -> Accuracy:
    """A table in float over 0.45 to 0.55 m and -0.1 to 0.1 rad."""
    step, height_step = repr(0.2 / (nodes - 1)), repr(0.1 / (heights - 1))
    where = ("--height", f"0.45:0.55:{height_step}", "--range", "0.1", "--step", step)
    return accuracy(*where, "--precision", "float")


def costs() -> Mapping[tuple[str, str], Cost]:
    """Every lookup and solve by (work, scalar), counted by callgrind."""
    eigen = subprocess.run(
        [needed("pkg-config"), "--cflags", "eigen3"], check=True, capture_output=True, text=True
    ).stdout.split()
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        program, counts = Path(folder) / "program", Path(folder) / "counts"
        compiler = [needed("g++"), *FLAGS, "-DEIGEN_DONT_VECTORIZE", "-DNDEBUG", *eigen]
        source = ROOT / "validation" / "speed" / "table_instructions.cpp"
        include = f"-I{ROOT / 'libsms' / 'include'}"
        subprocess.run([*compiler, include, source, "-o", program], check=True)
        valgrind = [
            needed("valgrind"),
            "--quiet",
            "--tool=callgrind",
            "--toggle-collect=*measured*",
        ]
        for scalar in ("float", "double"):
            for work in WORKS:
                told = subprocess.run(
                    [*valgrind, f"--callgrind-out-file={counts}", program, work, scalar],
                    check=True,
                    capture_output=True,
                    text=True,
                ).stdout
                calls, steps, error = (float(word) for word in told.split())
                total = re.search(r"^totals: (\d+)", counts.read_text(), re.MULTILINE)
                if total is None:
                    raise SystemExit("callgrind wrote no total")
                found[work, scalar] = Cost(int(total.group(1)) / calls, steps, error)
    return found


def main() -> None:
    """Measure everything, write both files."""
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    cost = costs()
    floats, doubles = ({n: flat(n, p) for n in NODES} for p in ("float", "double"))
    heights = {(n, h): deep(n, h) for n, h in HEIGHTS}
    version = subprocess.run(
        [needed("g++"), "-dumpfullversion"], check=True, capture_output=True, text=True
    ).stdout.strip()
    PAGE.write_text(
        page(floats, doubles, heights, cost, POINTS, f"g++ {version}", " ".join(FLAGS[1:]))
    )
    PICTURE.write_text(picture(floats, doubles, cost["warm", "float"]).svg())
    print(f"{PAGE.relative_to(ROOT)} and {PICTURE.relative_to(ROOT)}: written")


if __name__ == "__main__":
    main()
