"""The quick demonstration of a clone: an effect that the diagnosis does not know is hidden in records of a cylinder.

./dev demo            records made by the independent simulator in validation/twins, diagnosed in seconds

`sms demo` shows the same on a bench actuator simulated by the package itself, in half a minute (./dev demo --bench).
"""

from __future__ import annotations

import argparse
import secrets
import shutil
import sys
import tempfile
from pathlib import Path

from rich.console import Console
from sms.cli.demo import diagnosed, told, verdict_of
from sms.demo.hidden import key_of
from sms.errors import InputError
from sms.io.write import check_output_folder
from sms.progress import progress_bar

from validation.twins.cylinder import effects
from validation.twins.cylinder.draw import draw, open_truth


def hidden_effect(out: Path, seed: int, console: Console) -> None:
    """Hide, seal, diagnose, then open the truth and print it next to the verdict."""
    with tempfile.TemporaryDirectory() as folder:
        truth_file = Path(folder) / "truth.json"
        records = out / "records"
        if records.exists():
            shutil.rmtree(records)
        with console.status("measuring a virtual cylinder that hides one effect"):
            draw(seed, records, truth_file, _one_of_the_catalogue(seed))
        console.print(f"Records of a virtual cylinder (seed {seed}): {records}", soft_wrap=True)
        console.print(
            f"What is hidden in them is sealed: sha256 {(records / 'truth.sha256').read_text().strip()}\n",
            soft_wrap=True,
        )
        with progress_bar("reading records") as tell:
            answer = diagnosed(records / "rig.toml", out, tell)
        told(answer, out, console)
        truth = open_truth(truth_file, records)
    hidden = key_of(truth["effect"], truth["signal"])
    unit = "" if truth["unit"] == "1" else f" {truth['unit']}"
    console.print(f"\nverdict: [bold]{verdict_of(answer)}[/bold]", soft_wrap=True)
    console.print(f"truth:   [bold]{hidden}[/bold] = {truth['value']:.4g}{unit}", soft_wrap=True)


def _one_of_the_catalogue(seed: int) -> str:
    keys = [effect.key for effect in effects.CATALOGUE]
    return keys[seed % len(keys)]


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="./dev demo", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seed", type=int, default=None, help="of the virtual cylinder; fresh if left out"
    )
    parser.add_argument(
        "--out", type=Path, default=Path("out/demo"), help="folder for records and report"
    )
    arguments = parser.parse_args()
    console = Console()
    try:
        check_output_folder(arguments.out)
        seed = secrets.randbelow(10**6) if arguments.seed is None else arguments.seed
        hidden_effect(arguments.out, seed, console)
    except InputError as problem:
        print(f"demo: {problem}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
