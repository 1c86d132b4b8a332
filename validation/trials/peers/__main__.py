"""The diagnosis and what a user would do otherwise, on the same trials, in one table.

    python -m validation.trials.peers --rig cylinder --count 20 --seed 1
    python -m validation.trials.peers --rig bench --count 40 --seed 300000 --out peers
    python -m validation.trials.peers --foreign ../shared/foreign --out peers

The first puts 20 trials of each sort, the second those of `./dev trials` with the same seeds, the third the data sets
of `./dev trials foreign`; what is in the folder of answers already is not done again. Makes the environment
build/diagnosis_peers (PySINDy, scikit-learn) when it is missing.
"""

from __future__ import annotations

import argparse
import json
import secrets
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
    track,
)
from sms.errors import InputError

from validation.reference.multibody.environment import ROOT, PeersUnavailableError, peer_python
from validation.trials.foreign import sets_of
from validation.trials.machines import tasks
from validation.trials.peers import on_cylinder, on_foreign, on_machines
from validation.trials.peers.machine_table import machine_table
from validation.trials.peers.peer_process import PeerProcess
from validation.trials.peers.scoring import SORTS, Said, table
from validation.trials.scoring import goal_table
from validation.twins import effects


def environment() -> Path:
    """The peers' Python. PeersUnavailableError when they cannot be installed."""
    requirements = Path(__file__).with_name("requirements.txt")
    return peer_python(ROOT / "build" / "diagnosis_peers", requirements, "0.3 GB")


# ---- bench, platform, tank ---------------------------------------------------------------


def run_machines(
    rig: str, first: int, count: int, multiple: float, out: Path
) -> list[on_machines.Round]:
    """The trials of `./dev trials` with these seeds, by every method, one after another."""
    wanted = tasks(rig, first, count, multiple)
    with PeerProcess(environment()) as peers, _progress(count) as each:
        return on_machines.play_all(wanted, out / f"{rig}.jsonl", peers.ask, each)


def run_foreign(folder: Path, out: Path) -> list[on_machines.Round]:
    """The data sets of another simulator, by every method, one after another."""
    with PeerProcess(environment()) as peers, _progress(len(sets_of(folder))) as each:
        return on_foreign.play_folder(folder, out / "foreign.jsonl", peers.ask, each)


@contextmanager
def _progress(count: int) -> Iterator[Callable[[], None]]:
    columns = (
        TextColumn("asking everyone"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=count)
        yield lambda: progress.advance(task)


# ---- cylinder ----------------------------------------------------------------------------


def run(first: int, count: int, multiple: float, workers: int) -> list[Said]:
    """`count` trials of each sort on the cylinder, by every method."""
    python = environment()
    said: list[Said] = []
    with tempfile.TemporaryDirectory() as name, ProcessPoolExecutor(workers) as pool:
        folder = Path(name)
        jobs = [
            pool.submit(on_cylinder.ask, first + SORTS.index(sort) * count + i, sort, multiple)
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
        said += _peers(python, folder, said, on_cylinder.named_by_terms)
    return said


def _peers(
    python: Path,
    folder: Path,
    known: Sequence[Said],
    named_by_terms: Callable[[list[str]], tuple[tuple[str, ...], ...]],
) -> list[Said]:
    name = str(folder)
    command = [str(python), "-m", "validation.trials.peers.in_their_environment", name]
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


# ---- command line ------------------------------------------------------------------------


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.trials.peers",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--rig", choices=("cylinder", *effects.RIGS), default="cylinder")
    parser.add_argument(
        "--foreign", type=Path, help="folder with setNN/ and keys/setNN.json, in place of a rig"
    )
    parser.add_argument(
        "--count", type=int, default=20, help="trials; on the cylinder: of each sort"
    )
    parser.add_argument("--seed", type=int, help="of the first trial; fresh if left out")
    parser.add_argument("--multiple", type=float, default=3.0, help="of the detection limit")
    parser.add_argument("--workers", type=int, default=2, help="processes, on the cylinder")
    parser.add_argument(
        "--out", type=Path, default=Path("peers"), help="folder of the answers, but on the cylinder"
    )
    options = parser.parse_args()
    first = secrets.randbelow(10**6) if options.seed is None else options.seed
    console = Console(width=140)
    title = f"effects at {options.multiple:g} times their detection limit"
    try:
        if options.foreign is not None:
            rounds = run_foreign(options.foreign, options.out)
            console.print(machine_table(rounds, f"{options.foreign}, {len(rounds)} sets", "gain"))
        elif options.rig == "cylinder":
            said = run(first, options.count, options.multiple, options.workers)
            last = first + 3 * options.count - 1
            console.print(table(said, f"cylinder, seeds {first} to {last}, {title}"))
        else:
            rounds = run_machines(options.rig, first, options.count, options.multiple, options.out)
            last = first + options.count - 1
            console.print(goal_table([r.outcome for r in rounds]))
            console.print(machine_table(rounds, f"{options.rig}, seeds {first} to {last}, {title}"))
    except (InputError, PeersUnavailableError) as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
