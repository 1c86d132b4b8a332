"""The core's dynamics against Exudyn and Pinocchio, in one table.

Makes the environment build/peers when it is missing. Ends with status 1 if one of them disagrees.
"""

from __future__ import annotations

import argparse
import secrets
import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table

from validation.reference.multibody.comparison import ALLOWED, PEERS, Outcome, run
from validation.reference.multibody.environment import PeersUnavailableError


def table_of(outcome: Outcome) -> Table:
    """The differences as a person reads them."""
    table = Table(
        title=f"libsms against two multibody codes: {outcome.states} states, {outcome.motions} motions of 2 s"
    )
    table.add_column("largest difference of")
    table.add_column("unit")
    table.add_column("values up to", justify="right")
    for peer in PEERS:
        table.add_column(outcome.software[peer], justify="right")
        table.add_column("allowed", justify="right")
    for d in outcome.differences:
        cells = []
        for peer in PEERS:
            allowed = ALLOWED[d.subject][peer]
            colour = "green" if d.differences[peer] <= allowed else "red"
            cells += [f"[{colour}]{d.differences[peer]:.1e}[/]", f"{allowed:.0e}"]
        table.add_row(f"{d.subject}: {d.quantity}", d.unit, f"{d.largest:.2g}", *cells)
    return table


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.reference.multibody",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--seed", type=int, help="of the random machine, states and motions")
    parser.add_argument("--count", type=int, default=50, help="random states of each machine")
    parser.add_argument(
        "--reference", type=Path, metavar="FILE", help="dynamics.json, whose states are added"
    )
    options = parser.parse_args()
    if options.reference and not options.reference.is_file():
        parser.error(f"there is no file {options.reference}")
    seed = secrets.randbits(32) if options.seed is None else options.seed
    print(f"seed {seed}", flush=True)
    try:
        outcome = run(seed, options.count, options.reference)
    except PeersUnavailableError as error:
        sys.exit(str(error))
    Console(width=120).print(table_of(outcome))
    sys.exit(not all(d.agrees for d in outcome.differences))


if __name__ == "__main__":
    main()
