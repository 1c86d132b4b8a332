"""The command."""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import sys
from pathlib import Path

import numpy as np

from tools.same_bits.estimation import bench_cases, other_cases, platform_cases, tank_cases
from tools.same_bits.simulation import simulations


def hashes() -> dict[str, str]:
    """Of every case, by its name."""
    cases = itertools.chain(
        simulations(), bench_cases(), platform_cases(), tank_cases(), other_cases()
    )
    found = {}
    for name, run in cases:
        values = np.ascontiguousarray(run(), dtype=np.float64)
        found[name] = f"{values.size} {hashlib.sha256(values.tobytes()).hexdigest()}"
    return found


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.same_bits")
    parser.add_argument("action", choices=("record", "compare"))
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    if options.action == "compare" and not options.file.is_file():
        parser.error(
            f"there is no {options.file}; make it with the other build: record {options.file}"
        )
    now = hashes()
    if options.action == "record":
        options.file.write_text(json.dumps(now, indent=1) + "\n")
        print(f"{len(now)} runs recorded")
        return 0
    before = json.loads(options.file.read_text())
    different = [name for name in before if now.get(name) != before[name]]
    for name in different:
        print(f"differs: {name}")
    print(f"{len(before) - len(different)} of {len(before)} runs have the same bits")
    return 1 if different or set(now) != set(before) else 0


if __name__ == "__main__":
    sys.exit(main())
