"""`python -m validation.fuzz`: spoilt inputs for every command, spoilt arguments for the compiled module; counted."""

from __future__ import annotations

import os
import secrets
import sys
from collections import Counter
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(add_completion=False)


@app.callback(
    invoke_without_command=True,
    epilog="Example: **python -m validation.fuzz --count 2000 --keep failed**; "
    "**--seed 7 --first 42 --count 1 --keep failed** repeats one case.",
)
def fuzz(
    context: typer.Context,
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
    if context.invoked_subcommand is not None:
        return
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


@app.command(
    epilog="Example: **python -m validation.fuzz bindings --count 20000**; "
    "**bindings --seed 7 --first 42 --count 1 --verbose** repeats one case."
)
def bindings(
    count: Annotated[int, typer.Option(help="Calls to make.", min=1)] = 2000,
    seed: Annotated[int | None, typer.Option(help="Of the calls; drawn and printed.")] = None,
    first: Annotated[int, typer.Option(help="Number of the first call.", min=0)] = 0,
    only: Annotated[str, typer.Option(help="Only functions that hold these words.")] = "",
    module: Annotated[
        Path | None, typer.Option(help="File of the module, e.g. one with sanitizers.")
    ] = None,
    verbose: Annotated[bool, typer.Option("--verbose", help="A line a call.")] = False,
) -> None:
    """Call all that sms._core offers with spoilt arguments: each gives a value, or an exception that says something.

    A failure is printed with its seed and number. Exit code 1 if there is any.
    """
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy is loaded
    from validation.fuzz.bindings import Tallies, load_core, run  # noqa: PLC0415
    from validation.fuzz.signatures import functions_of  # noqa: PLC0415

    try:
        core = load_core(module)
    except ImportError as problem:
        raise typer.BadParameter(
            f"{problem}; give the file that cmake --build --preset sanitize-module makes, _core*.so",
            param_hint="--module",
        ) from problem
    functions = functions_of(core)
    if not any(only in function.label for function in functions):
        raise typer.BadParameter(
            f"no function of the module holds '{only}'; without --only all are called",
            param_hint="--only",
        )
    seed = secrets.randbits(32) if seed is None else seed
    print(f"seed {seed}; {core.build_info}", flush=True)
    tallies = Tallies(functions)
    for one in run(core, seed, range(first, first + count), only):
        tallies.count(one)
        if verbose or one.failed:
            print(f"{seed}-{one.number}: {one.verdict}: {one.call}")
            print("\n".join(f"    {line}" for line in one.said.splitlines()[:60]), flush=True)
        if tallies.cases % 1000 == 0:
            print(tallies.line(), flush=True)
    print(tallies.table())
    print(f"seed {seed}: {tallies.line()}")
    if never := tallies.never_answered():
        print(f"never answered, so not tested: {', '.join(never)}")
    sys.exit(tallies.failures > 0)


def _words(counts: Counter[str]) -> str:
    return f"{counts.total()} inputs: " + ", ".join(f"{n} {name}" for name, n in counts.items())


if __name__ == "__main__":
    app()
