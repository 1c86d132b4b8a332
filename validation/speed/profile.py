"""Where the instructions go: `python -m validation.speed.profile [NAME=PROGRAM ...]`.

Prints the tables of docs/speed.md. A column is one build of the timing programs: `now=` what `./dev bench` has built,
if none is named. Instructions are counted by callgrind; how many of them a nanosecond takes says how much of what the
processor can do at once it does.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

from validation.speed.callgrind import Count, count

NOW = "now=build/bench/libsms/bench/sms_bench"
BY_FUNCTION = (
    "closed-loop platform",
    "derivative of the platform",
    "inverse kinematics, batch",
    "forward kinematics, batch",
    "friction",
)
SHOWN = 0.03  # share of all instructions from which a function has a line of its own


def markdown(lines: list[list[str]]) -> str:
    """A table, the first line its head."""
    head, *rest = lines
    rule = ["---"] + ["---:"] * (len(head) - 1)
    return "".join("| " + " | ".join(line) + " |\n" for line in (head, rule, *rest))


def nanoseconds(program: Path) -> dict[str, float]:
    """Of one call of every measurement, the fastest round."""
    run = subprocess.run([program], check=True, capture_output=True, text=True)
    return {name: float(time) for name, time, _ in (s.split("\t") for s in run.stdout.splitlines())}


def rate_table(times: Mapping[str, float], counts: Mapping[str, Count]) -> str:
    """Time and instructions of one call, and how many of these a nanosecond takes."""
    lines = [["", "ns", "instructions", "of them in a ns"]]
    for name, time in times.items():
        instructions = counts[name].instructions / counts[name].calls
        lines.append([name, f"{time:,.4g}", f"{instructions:,.0f}", f"{instructions / time:.1f}"])
    return markdown(lines)


def function_table(counts: Mapping[str, Count]) -> str:
    """Instructions of one call by function, build by build."""
    share: dict[str, float] = {}
    for c in counts.values():
        for function, instructions in c.by_function.items():
            share[function] = max(share.get(function, 0.0), instructions / c.instructions)
    shown = sorted((f for f, part in share.items() if part >= SHOWN), key=lambda f: -share[f])
    rows = {f"`{f}`": [c.by_function[f] for c in counts.values()] for f in shown}
    rows["others"] = [
        c.instructions - sum(c.by_function[f] for f in shown) for c in counts.values()
    ]
    rows["all"] = [c.instructions for c in counts.values()]
    lines = [["function", *counts]]
    for name, cells in rows.items():
        per_call = zip(cells, counts.values(), strict=True)
        lines.append([name, *(f"{instructions / c.calls:,.0f}" for instructions, c in per_call)])
    return markdown(lines)


def main() -> None:
    """Count, time, print."""
    parser = argparse.ArgumentParser(prog="python -m validation.speed.profile", description=__doc__)
    parser.add_argument("builds", nargs="*", default=[NOW], metavar="NAME=PROGRAM")
    builds = {}
    for said in parser.parse_args().builds:
        name, _, program = said.partition("=")
        if not program:
            parser.error(f"'{said}' is no NAME=PROGRAM, such as {NOW}")
        if not Path(program).is_file():
            parser.error(f"{program}: there is no such program; ./dev bench builds it")
        builds[name] = Path(program)
    if not shutil.which("valgrind"):
        parser.error("valgrind is missing: apt-get install valgrind")
    for name in BY_FUNCTION:
        counts = {build: count(program, name) for build, program in builds.items()}
        print(f"### {name}\n\n{function_table(counts)}", flush=True)
    last, program = list(builds.items())[-1]
    times = nanoseconds(program)
    print(f"### {last}\n\n{rate_table(times, {name: count(program, name) for name in times})}")


if __name__ == "__main__":
    main()
