"""What the tests of `ik_tables` run it with, and read its files by: numpy, scipy, a C compiler."""

from __future__ import annotations

import math
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.optimize
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sms import _core

Array = NDArray[Any]

AXES = ("roll", "pitch", "height")
STRINGS = ("version", "geometry_hash", "units")
PROGRAM = shutil.which("ik_tables") or str(Path(sys.executable).with_name("ik_tables"))


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the program in a folder, whatever comes of it."""
    return subprocess.run(
        [PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


def made(folder: Path, *arguments: str) -> str:
    """Run the program in a folder, which must succeed; what it printed."""
    done = run(folder, *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


# ---- an inverse kinematics that owes nothing to the core ------------------------------------------


def parameters(**changed: float) -> dict[str, float]:
    return {p.name: p.default for p in _core.parameter_table()} | changed


def point(values: dict[str, float], name: str) -> Array:
    return np.array([values[f"{name}_{axis}"] for axis in "xyz"])


def direct(roll: float, pitch: float, height: float, **changed: float) -> Array:
    """Extensions (3), m, by a general root finder on the lengths of the Panhard rods."""
    values = parameters(**changed)
    reference = point(values, "reference_point")
    base = np.array([point(values, f"base_joint_{i}") for i in range(1, 7)])
    rest = np.array([point(values, f"platform_joint_{i}") for i in range(1, 7)])
    length = np.linalg.norm(rest - base, axis=1)

    def legs(free: Array) -> Array:
        yaw, x, y = free
        turn = Rotation.from_euler("ZYX", [yaw, pitch, roll])
        moved = turn.apply(rest - reference) + np.array([x, y, -height])
        change: Array = np.linalg.norm(moved - base, axis=1) - length
        return change

    def rods(free: Array) -> Array:
        return legs(free)[3:]

    found = scipy.optimize.root(rods, [0.0, reference[0], reference[1]], tol=1e-15)
    assert np.max(np.abs(rods(found.x))) < 1e-13
    return legs(found.x)[:3]


# ---- every format, read by what it is meant for ----------------------------------------------------


@dataclass
class Read:
    """A table as it came out of a file."""

    roll: Array
    pitch: Array
    height: Array
    extension: Array
    version: str
    geometry_hash: str
    units: str


def described(lines: str, key: str) -> str:
    found = re.search(rf"(?:^|; |# | \* ){key}: +(.*?)(?:;|$)", lines, re.MULTILINE)
    assert found, key
    return found.group(1).strip()


def remarks(lines: str) -> dict[str, Any]:
    return {key: described(lines, key) for key in STRINGS}


def axis_of(lines: str, key: str, number: type) -> Array:
    """Nodes from "-0.1 to 0.1 rad, 201 nodes" or "0.5 m"."""
    numbers = [float(n) for n in re.findall(r"[-+.e\d]+(?= |$)", described(lines, key))]
    if len(numbers) == 1:
        return np.array(numbers, number)
    return np.linspace(number(numbers[0]), number(numbers[1]), int(numbers[2])).astype(number)


def read_npz(file: Path) -> Read:
    with np.load(file, allow_pickle=False) as data:
        fields: dict[str, Any] = dict(data)
    return Read(**fields | {key: str(fields[key]) for key in STRINGS})


def read_npy(file: Path) -> Read:
    extension = np.load(file, allow_pickle=False)
    with file.open("rb") as stream:
        header = stream.read(10)
        lines = stream.read(int.from_bytes(header[8:10], "little")).decode("ascii")
    assert np.load(file, mmap_mode="r").shape == extension.shape
    fields: dict[str, Any] = {key: axis_of(lines, key, extension.dtype.type) for key in AXES}
    return Read(**fields, extension=extension, **remarks(lines))


def read_mat(file: Path) -> Read:
    data = scipy.io.loadmat(file)
    fields: dict[str, Any] = {key: data[key].ravel() for key in AXES}
    fields |= {key: str(data[key][0]) for key in STRINGS}
    return Read(**fields, extension=data["extension"])


def read_csv(file: Path) -> Read:
    lines = file.read_text().splitlines()
    head = [line for line in lines if line.startswith("# ")]
    assert lines[len(head)] == (
        "roll [rad],pitch [rad],height [m],extension_1 [m],extension_2 [m],extension_3 [m]"
    )
    remark = "\n".join(head)
    number = {"float": np.float32, "double": np.float64}[described(remark, "precision")]
    rows = np.loadtxt(file, delimiter=",", skiprows=len(head) + 1, dtype=number)
    fields: dict[str, Any] = {key: np.unique(rows[:, i]) for i, key in enumerate(AXES)}
    shape = [len(axis) for axis in fields.values() if len(axis) > 1]
    return Read(**fields, extension=rows[:, 3:].reshape(*shape, 3), **remarks(remark))


def read_bin(file: Path) -> Read:
    content = file.read_bytes()
    assert content.startswith(b"sms_table 1\n")
    size = int(described(content[:64].decode("ascii"), "header_bytes"))
    head = content[:size].decode("ascii")
    assert size % 64 == 0 and described(head, "byte_order") == "little"
    kind = {"float": "<f4", "double": "<f8"}[described(head, "precision")]
    numbers = np.frombuffer(content, kind, offset=size)
    arrays: dict[str, Any] = {}
    start = 0
    for name, shape in re.findall(r"(\w+)((?:\[\d+\])+)", described(head, "data")):
        sides = [int(n) for n in re.findall(r"\d+", shape)]
        arrays[name] = numbers[start : start + math.prod(sides)].reshape(sides)
        start += math.prod(sides)
    assert start == len(numbers)
    return Read(**arrays, **remarks(head))


C_PROGRAM = """
#include <stdio.h>
#include "table.h"

static void print(const char *name, const TYPE *numbers, unsigned long count) {
  unsigned long i;
  printf("%s", name);
  for (i = 0; i < count; ++i) printf(" %.17g", (double)numbers[i]);
  printf("\\n");
}

int main(void) {
  printf("version %s\\ngeometry_hash %s\\nunits %s\\n", TABLE_VERSION, TABLE_GEOMETRY_HASH, TABLE_UNITS);
  print("roll", table_roll, TABLE_ROLL_COUNT);
  print("pitch", table_pitch, TABLE_PITCH_COUNT);
  print("height", table_height, TABLE_HEIGHT_COUNT);
  print("extension", table_extension, sizeof table_extension / sizeof table_extension[0]);
  return 0;
}
"""

STRICT_C = ("gcc", "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror")


def read_h(file: Path) -> Read:
    """What a C program prints that was compiled with the header, which is table.h."""
    is_float = "static const float" in file.read_text()
    source, program = file.with_name("print.c"), file.with_name("print_table")
    source.write_text(C_PROGRAM.replace("TYPE", "float" if is_float else "double"))
    subprocess.run([*STRICT_C, source, "-o", program], check=True)
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    found = dict(line.split(" ", 1) for line in printed.splitlines())
    fields: dict[str, Any] = {k: found.pop(k) for k in STRINGS}
    number = np.float32 if is_float else np.float64
    fields |= {key: np.array(text.split(), float).astype(number) for key, text in found.items()}
    shape = [len(fields[k]) for k in AXES if len(fields[k]) > 1]
    fields["extension"] = fields["extension"].reshape(*shape, 3)
    return Read(**fields)


READERS: dict[str, Callable[[Path], Read]] = {
    "npz": read_npz,
    "npy": read_npy,
    "mat": read_mat,
    "csv": read_csv,
    "h": read_h,
    "bin": read_bin,
}
