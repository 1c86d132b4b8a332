"""Holds the project against reference values of single equations that were computed elsewhere.

    python -m validation.reference.check_components FOLDER

Each JSON file of the folder is one subject: its equation, a tolerance and cases of named inputs and
outputs. A subject that the project has not got yet is listed as such. Exit code 1 when a value is
off, 2 when the folder holds no such file.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from validation.reference.component_models import IMPLEMENTED


@dataclass(frozen=True)
class Comparison:
    """What came out for one reference file."""

    name: str
    equation: str
    cases: int
    implemented: bool
    difference: float = 0.0  #: largest absolute difference over all cases and outputs
    of_allowed: float = 0.0  #: largest difference over what the file allows; at most 1 is right

    @property
    def right(self) -> bool:
        """False for a value that is off; what is not implemented is not wrong."""
        return self.of_allowed <= 1.0


def read(folder: Path) -> dict[str, dict[str, Any]]:
    """The reference files of a folder by name. ValueError says what is wrong."""
    references = {}
    for path in sorted(folder.glob("*.json")):
        try:
            reference = json.loads(path.read_text())
        except json.JSONDecodeError as error:
            raise ValueError(f"{path} cannot be read: {error}") from error
        if not isinstance(reference, dict) or not {"cases", "rtol"} <= reference.keys():
            raise ValueError(f"{path} is no reference file: it has no 'cases' with their 'rtol'")
        references[path.stem] = reference
    if not references:
        raise ValueError(f"{folder} holds no reference file; give the folder with friction.json")
    return references


def compare(name: str, reference: Mapping[str, Any]) -> Comparison:
    """Computes every case of one subject, and compares."""
    subject = (name, str(reference.get("equation", "")), len(reference["cases"]))
    if name not in IMPLEMENTED:
        return Comparison(*subject, implemented=False)
    differences, shares = [0.0], [0.0]
    for case in reference["cases"]:
        computed = IMPLEMENTED[name](reference.get("parameters", {}) | case["in"])
        for output, expected in case["out"].items():
            want = np.asarray(expected, dtype=np.float64)
            off = np.abs(np.asarray(computed[output], dtype=np.float64) - want)
            allowed = reference.get("atol", 0.0) + reference["rtol"] * np.abs(want)
            share = off / np.maximum(allowed, sys.float_info.min)
            # A NaN must not pass for a small difference.
            differences.append(float(np.max(np.where(np.isfinite(off), off, np.inf))))
            shares.append(float(np.max(np.where(np.isfinite(share), share, np.inf))))
    return Comparison(*subject, True, max(differences), max(shares))


def table_of(comparisons: Sequence[Comparison]) -> Table:
    """The comparisons as a person reads them."""
    table = Table(title="held against reference values")
    for heading in ("subject", "equation", "cases", "largest difference", "of the allowed", ""):
        table.add_column(heading)
    for c in comparisons:
        if c.implemented:
            numbers = (f"{c.difference:.2e}", f"{c.of_allowed:.1e}")
            verdict = "[green]right[/]" if c.right else "[red]off[/]"
        else:
            numbers, verdict = ("", ""), "[dim]not implemented yet[/]"
        table.add_row(c.name, c.equation, str(c.cases), *numbers, verdict)
    return table


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.reference.check_components",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path, help="holds friction.json and its like")
    folder: Path = parser.parse_args().folder
    try:
        references = read(folder)
    except ValueError as error:
        parser.error(str(error))
    comparisons = [compare(name, reference) for name, reference in references.items()]
    Console(width=120).print(table_of(comparisons))
    sys.exit(not all(c.right for c in comparisons))


if __name__ == "__main__":
    main()
