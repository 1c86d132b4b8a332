"""`python -m validation.fuzz`: spoilt inputs for every command, counted."""

from __future__ import annotations

import os
import secrets
import sys
from collections import Counter
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(add_completion=False)


@app.command(
    epilog="Example: **python -m validation.fuzz --count 2000 --keep failed**; "
    "**--seed 7 --first 42 --count 1 --keep failed** repeats one case."
)
def fuzz(
    count: Annotated[int, typer.Option(help="Cases to run.", min=1)] = 1000,
    seed: Annotated[int | None, typer.Option(help="Of the cases; drawn and printed.")] = None,
    first: Annotated[int, typer.Option(help="Number of the first case.", min=0)] = 0,
    keep: Annotated[Path | None, typer.Option(help="Folder for the files of what failed.")] = None,
    only: Annotated[str, typer.Option(help="Only commands that hold these words.")] = "",
    verbose: Annotated[bool, typer.Option("--verbose", help="A line a case.")] = False,
) -> None:
    """Spoil inputs and run the commands on them: each is answered or refused in one sentence, exit code 2.

    A failure is printed with its seed and number. Exit code 1 if there is any.
    """
    for name in (
        "OPENBLAS_NUM_THREADS",
        "SMS_THREADS",
        "OMP_NUM_THREADS",
    ):  # before numpy is loaded
        os.environ[name] = "1"
    os.environ |= {"COLUMNS": "100", "NO_COLOR": "1"}
    from validation.fuzz.run import GOOD, run  # noqa: PLC0415

    seed = secrets.randbits(32) if seed is None else seed
    print(f"seed {seed}", flush=True)
    counts = Counter(dict.fromkeys(GOOD, 0))
    for one in run(seed, range(first, first + count), keep, only):
        counts[one.verdict] += 1
        good = one.verdict in GOOD
        if verbose or not good:
            print(f"{seed}-{one.number}: {one.verdict}, {one.seconds:.1f} s: {one.case}")
            print("\n".join(f"    {line}" for line in one.said.splitlines()[-1 if good else -12 :]))
        if verbose or not good or counts.total() % 100 == 0:
            print(_words(counts), flush=True)
    print(f"seed {seed}: {_words(counts)}")
    sys.exit(any(name not in GOOD for name in counts))


def _words(counts: Counter[str]) -> str:
    return f"{counts.total()} inputs: " + ", ".join(f"{n} {name}" for name, n in counts.items())


if __name__ == "__main__":
    app()
