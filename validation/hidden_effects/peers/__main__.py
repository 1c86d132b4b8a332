"""The diagnosis and four things a user would do otherwise, on the same trials, in one table.

    python -m validation.hidden_effects.peers --rig cylinder --count 40 --seed 1

Makes the environment build/diagnosis_peers (PySINDy, scikit-learn) when it is missing.
"""

from __future__ import annotations

import argparse
import json
import secrets
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from rich.console import Console
from rich.progress import track

from validation.hidden_effects.peers import on_bench, on_cylinder
from validation.hidden_effects.peers.exchange import Question
from validation.hidden_effects.peers.scoring import SORTS, Said, table
from validation.multibody.environment import ROOT, PeersUnavailableError, peer_python

Ask = Callable[[int, str, float], tuple[list[Said], Question]]
RIGS: dict[str, tuple[Ask, Callable[[list[str]], tuple[tuple[str, ...], ...]]]] = {
    "cylinder": (on_cylinder.ask, on_cylinder.named_by_terms),
    "bench": (on_bench.ask, on_bench.named_by_terms),
}


def run(rig: str, first: int, count: int, multiple: float, workers: int) -> list[Said]:
    """`count` trials of each sort, by every method. PeersUnavailableError when the peers cannot be installed."""
    python = peer_python(
        ROOT / "build" / "diagnosis_peers",
        Path(__file__).with_name("requirements.txt"),
        "0.3 GB",
    )
    ask, named_by_terms = RIGS[rig]
    said: list[Said] = []
    with tempfile.TemporaryDirectory() as name, ProcessPoolExecutor(workers) as pool:
        folder = Path(name)
        jobs = [
            pool.submit(ask, first + SORTS.index(sort) * count + i, sort, multiple)
            for sort in SORTS
            for i in range(count)
        ]
        progress = Console(stderr=True)
        for job in track(
            as_completed(jobs), "hiding and finding", len(jobs), console=progress, transient=True
        ):
            by_us, question = job.result()
            question.save(folder / f"{by_us[0].trial}.npz")
            said += by_us
        said += _peers(python, folder, said, named_by_terms)
    return said


def _peers(
    python: Path,
    folder: Path,
    known: Sequence[Said],
    named_by_terms: Callable[[list[str]], tuple[tuple[str, ...], ...]],
) -> list[Said]:
    name = str(folder)
    command = [str(python), "-m", "validation.hidden_effects.peers.in_their_environment", name]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise PeersUnavailableError(f"the peers failed: {done.stderr.strip().splitlines()[-1]}")
    truth = {s.trial: s for s in known}
    return [
        Said(
            method,
            trial,
            truth[trial].sort,
            truth[trial].hidden,
            named_by_terms(answer["terms"]),
            answer["alarm"],
            answer["gain"],
        )
        for trial, methods in json.loads(done.stdout).items()
        for method, answer in methods.items()
    ]


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.hidden_effects.peers",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--rig", choices=sorted(RIGS), default="cylinder")
    parser.add_argument("--count", type=int, default=20, help="trials of each sort")
    parser.add_argument("--seed", type=int, help="of the first trial; fresh if left out")
    parser.add_argument("--multiple", type=float, default=3.0, help="of the detection limit")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    first = secrets.randbelow(10**6) if options.seed is None else options.seed
    try:
        said = run(options.rig, first, options.count, options.multiple, options.workers)
    except PeersUnavailableError as error:
        sys.exit(str(error))
    title = (
        f"{options.rig}, seeds {first} to {first + 3 * options.count - 1}, effects at "
        f"{options.multiple:g} times their detection limit"
    )
    Console(width=120).print(table(said, title))


if __name__ == "__main__":
    main()
