"""Instructions of a measurement of libsms/bench, which no other work on the machine disturbs."""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Count:
    """What callgrind counts in one round of a measurement."""

    calls: int
    instructions: int  #: of all calls
    by_function: Counter[str]  #: instructions of each function, without those that it calls


def count(program: Path, name: str) -> Count:
    """Let callgrind count what happens inside one round.

    Args:
        program: sms_bench.
        name: of the measurement.

    Raises:
        RuntimeError: callgrind counted nothing.
    """
    with tempfile.NamedTemporaryFile() as file:
        valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={file.name}"]
        command = [*valgrind, "--toggle-collect=*counted_round*", str(program), "1", name]
        run = subprocess.run(command, check=True, capture_output=True, text=True)
        collected = re.search(r"Collected : (\d+)", run.stderr)
        if not collected:
            raise RuntimeError(f"callgrind counted nothing of {name}: {run.stderr[-300:]}")
        annotate = ["callgrind_annotate", "--threshold=100", "--auto=no", file.name]
        listed = subprocess.run(annotate, check=True, capture_output=True, text=True).stdout
    return Count(int(run.stdout.split("\t")[2]), int(collected[1]), by_function(listed))


def by_function(listed: str) -> Counter[str]:
    """Instructions by the short name of a function: its namespaces, arguments and library left out."""
    counts: Counter[str] = Counter()
    for line in listed.splitlines():
        found = re.match(r"\s*([\d,]+) \(\s*[\d.]+%\)\s+(.*?):(.*)", line)
        if found:
            counts[short_name(found[3])] += int(found[1].replace(",", ""))
    return counts


def short_name(signature: str) -> str:
    """`derivative` of `sms_status sms::derivative<double>(sms::Platform<double> const&, ...) [file]`."""
    name = re.sub(r" \[.*", "", signature).replace("(anonymous namespace)::", "")
    while re.search(r"<[^<>]*>", name):
        name = re.sub(r"<[^<>]*>", "", name)
    name = re.sub(r"\(.*", "", name.replace("operator()", "operator"))
    return name.split(" ")[-1].split("::")[-1].split("@")[0]
